// contact_normal.hpp: the library itself, its log and its memory; closed forms and tables of coefficients.
#ifndef CONTACT_NORMAL_LIBRARY_HPP
#define CONTACT_NORMAL_LIBRARY_HPP

#include <contact_normal_arrays.hpp>
#include <contact_normal_visco.hpp>

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace contact_normal {

/// The version of the library, as "0.2.0".
inline std::string version() { return contact_normal_version(); }

/// That of its ABI: at least CONTACT_NORMAL_ABI_VERSION of the header.
inline std::int32_t abi_version() noexcept { return contact_normal_abi_version(); }

/// Whether the library has what is called so; see `contact_normal_has`.
inline bool has(const std::string &name) { return contact_normal_has(name.c_str()) != 0; }

/// A short text for a status.
inline std::string status_text(contact_normal_status status) { return contact_normal_status_text(status); }

/// Gives back to the system what the library keeps for later calls.
inline void release() { check(contact_normal_release()); }

/// How many bytes of solves that are over are kept at most, in the process.
inline void keep(std::int64_t bytes) { check(contact_normal_keep(bytes)); }

/// What is kept now.
struct memory {
    std::int64_t bytes;
    std::int32_t threads;
};
inline memory kept()
{
    memory found{};
    check(contact_normal_kept(&found.bytes, &found.threads));
    return found;
}

/// Called with a level, CONTACT_NORMAL_LOG_..., and a message, on the thread that called the library. What it throws is dropped.
using log_callback = std::function<void(std::int32_t, const std::string &)>;

/// Sends log messages up to a level to a callback as long as it lives; then there are none. For the whole process, so one at a time,
/// which no other thread that is inside the library outlives.
class [[nodiscard]] log {
public:
    log(std::int32_t level, log_callback callback) : callback_(std::move(callback))
    {
        check(contact_normal_set_log(on_message, level, this));
    }
    ~log() { contact_normal_set_log(nullptr, CONTACT_NORMAL_LOG_OFF, nullptr); }
    // The library has its address.
    log(const log &) = delete;
    log &operator=(const log &) = delete;

private:
    static void on_message(std::int32_t level, const char *message, void *user) noexcept
    {
        try {
            static_cast<log *>(user)->callback_(level, message);
        } catch (...) {
            // No exception may pass through the library.
        }
    }

    log_callback callback_;
};

namespace detail {

/// Two bodies as the C ABI takes them.
struct pair_of_bodies {
    double shear_modulus[2], poisson_ratio[2];

    pair_of_bodies(const body &one, const body &other)
        : shear_modulus{one.shear_modulus, other.shear_modulus}, poisson_ratio{one.poisson_ratio, other.poisson_ratio}
    {
    }
};

} // namespace detail

/// The value of the constant that is called so, with or without CONTACT_NORMAL_.
inline std::int32_t constant(const std::string &name)
{
    std::int32_t value = 0;
    check(contact_normal_constant(name.c_str(), &value));
    return value;
}

/// The exact contact of h = curvature_x x^2 + curvature_y y^2 for a prescribed approach or force (`load`).
inline contact_normal_hertz_solution hertz(double curvature_x, double curvature_y, const body &one, const body &other,
                                           std::int32_t load, double amount)
{
    const detail::pair_of_bodies both(one, other);
    contact_normal_hertz_solution exact;
    contact_normal_hertz_solution_init(&exact);
    check(contact_normal_hertz(curvature_x, curvature_y, both.shear_modulus, both.poisson_ratio, load, amount, &exact));
    return exact;
}

/// The influence coefficients of the half-space for elements dx by dy over offsets -cx..cx-1 by -cy..cy-1: 2 cy * 2 cx values, as
/// `scene::influence` takes them.
inline std::vector<double> influence_half_space(std::int32_t cx, std::int32_t cy, double dx, double dy, const body &one, const body &other)
{
    const detail::pair_of_bodies both(one, other);
    std::vector<double> coefficients(detail::table_size(cx, cy));
    check(contact_normal_influence_half_space(cx, cy, dx, dy, both.shear_modulus, both.poisson_ratio, coefficients.data()));
    return coefficients;
}

/// The same of bodies that relax and roll towards +x at `speed`: see `contact_normal_influence_rolling`.
inline std::vector<double> influence_rolling(std::int32_t cx, std::int32_t cy, double dx, double dy, const body &one, const body &other,
                                             const visco &relaxing, double speed)
{
    const detail::pair_of_bodies both(one, other);
    const contact_normal_visco named = relaxing.named();
    std::vector<double> coefficients(detail::table_size(cx, cy));
    check(contact_normal_influence_rolling(cx, cy, dx, dy, both.shear_modulus, both.poisson_ratio, &named, speed, coefficients.data()));
    return coefficients;
}

/// The tangential ones, one after the other: xx, yy and xy, as `friction::influence` takes each. See `contact_normal_influence_rolling_tangential`.
inline std::vector<double> influence_rolling_tangential(std::int32_t cx, std::int32_t cy, double dx, double dy, const body &one,
                                                        const body &other, const visco &relaxing, double speed)
{
    const detail::pair_of_bodies both(one, other);
    const contact_normal_visco named = relaxing.named();
    std::vector<double> coefficients(3 * detail::table_size(cx, cy));
    check(contact_normal_influence_rolling_tangential(cx, cy, dx, dy, both.shear_modulus, both.poisson_ratio, &named, speed, coefficients.data()));
    return coefficients;
}

/// What a body with a coating of this thickness and material gives way to a pressure wave: see `contact_normal_coating_compliance`.
inline double coating_compliance(double thickness, const body &material, const body &below, double wave_number)
{
    contact_normal_coating coating;
    contact_normal_coating_init(&coating);
    coating.thickness = thickness, coating.shear_modulus = material.shear_modulus, coating.poisson_ratio = material.poisson_ratio;
    double compliance = 0.0;
    check(contact_normal_coating_compliance(&coating, below.shear_modulus, below.poisson_ratio, wave_number, &compliance));
    return compliance;
}

/// Flash temperatures of two bodies: see `contact_normal_flash_temperature`.
struct flash_temperatures {
    /// [2][my][mx]: of body 1, then of body 2.
    std::vector<double> rise;
    /// The largest ones, where they are, and the part of the heat that goes into body 1.
    contact_normal_flash largest;
};

/// A flux of heat, [my][mx], through elements dx by dy; `conductivity`, `diffusivity` and `speed` of both bodies; `share` < 0: found.
inline flash_temperatures flash_temperature(std::int32_t mx, std::int32_t my, double dx, double dy, const std::vector<double> &heat_flux,
                                            const double (&conductivity)[2], const double (&diffusivity)[2], const double (&speed)[2],
                                            double share = -1.0, std::int32_t threads = 1)
{
    const std::size_t size = detail::count(mx) * detail::count(my);
    contact_normal_heat heat;
    contact_normal_heat_init(&heat);
    heat.mx = mx, heat.my = my, heat.dx = dx, heat.dy = dy, heat.heat_flux = detail::sized("heat_flux", heat_flux, size);
    for (int b = 0; b < 2; b++)
        heat.conductivity[b] = conductivity[b], heat.diffusivity[b] = diffusivity[b], heat.speed[b] = speed[b];
    heat.share = share, heat.threads = threads;
    flash_temperatures found{std::vector<double>(2 * size), {}};
    contact_normal_flash_init(&found.largest);
    check(contact_normal_flash_temperature(&heat, found.rise.data(), &found.largest));
    return found;
}

/// Frictional work and wear: see `contact_normal_frictional_wear`.
struct frictional_work {
    /// An energy per area and a length of each element, [my][mx].
    std::vector<double> work, depth;
    /// What a point loses in a passage, [my]; empty without a rolling distance.
    std::vector<double> passage;
    /// The sums, the largest depth and where it is.
    contact_normal_worn total;
};

/// Tractions and slips as a solve returned them, [my][mx] each. `coefficient` is K and `hardness` H; with `coefficients` K of each element, with
/// `pressure` the depth is K/H p |s|; of both, an empty one is not given.
inline frictional_work frictional_wear(std::int32_t mx, std::int32_t my, double dx, double dy,
                                       const std::array<std::vector<double>, 2> &traction,
                                       const std::array<std::vector<double>, 2> &slip, double coefficient, double hardness = 1.0, double steps = 1.0,
                                       double rolling_distance = 0.0, const std::vector<double> &pressure = {},
                                       const std::vector<double> &coefficients = {})
{
    const std::size_t size = detail::count(mx) * detail::count(my);
    contact_normal_wear wear;
    contact_normal_wear_init(&wear);
    for (int k = 0; k < 2; k++) {
        wear.traction[k] = detail::sized("traction", traction[k], size), wear.slip[k] = detail::sized("slip", slip[k], size);
    }
    wear.mx = mx, wear.my = my, wear.dx = dx, wear.dy = dy;
    wear.pressure = detail::sized_or_none("pressure", pressure, size), wear.coefficients = detail::sized_or_none("coefficients", coefficients, size);
    wear.coefficient = coefficient, wear.hardness = hardness, wear.steps = steps, wear.rolling_distance = rolling_distance;
    frictional_work found{std::vector<double>(size), std::vector<double>(size), {}, {}};
    if (rolling_distance > 0.0) found.passage.resize(detail::count(my));
    contact_normal_worn_init(&found.total);
    check(contact_normal_frictional_wear(&wear, found.work.data(), found.depth.data(), found.passage.empty() ? nullptr : found.passage.data(),
                                         &found.total));
    return found;
}

} // namespace contact_normal

#endif // CONTACT_NORMAL_LIBRARY_HPP
