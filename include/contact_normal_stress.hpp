// contact_normal.hpp: stresses below the surface.
#ifndef CONTACT_NORMAL_STRESS_HPP
#define CONTACT_NORMAL_STRESS_HPP

#include <contact_normal_options.hpp>
#include <contact_normal_scene.hpp>

#include <array>
#include <string>
#include <vector>

namespace contact_normal {

/// What acts on the elements of a body, my * mx values each; no values: nothing. Tractions are those on this body.
struct loads {
    borrowed<double> pressure;
    borrowed<double> traction_x{nullptr, 0}, traction_y{nullptr, 0};
};

/// Arrays of `stresses`.
enum class stress_fields : std::uint32_t { none = 0, components = 1, von_mises = 2, maximum_shear = 4, principal = 8, directions = 16, all = 31 };
constexpr stress_fields operator|(stress_fields a, stress_fields b) noexcept
{
    return static_cast<stress_fields>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

/// Stresses below the centres of the elements, positive in tension: n * my * mx values for n depths, x fastest. What was not asked for
/// is empty.
struct stresses {
    contact_normal_status status = CONTACT_NORMAL_OK; // CANCELLED: only the first depths are written
    std::string message;                              // why, if the status is not OK
    std::array<std::vector<double>, 6> components;    // xx, yy, zz, xy, xz, yz
    std::vector<double> von_mises, maximum_shear;
    std::array<std::vector<double>, 3> principal;  // the largest first
    std::array<std::vector<double>, 3> directions; // of them: unit vectors, three values for each place
    // The largest shear stress belongs to maximum_shear, principal, directions and none; otherwise it is not computed, and 0.
    contact_normal_stress_maximum largest_von_mises, largest_shear;

    stresses() { contact_normal_stress_maximum_init(&largest_von_mises), contact_normal_stress_maximum_init(&largest_shear); }
    /// True if it was not cancelled.
    explicit operator bool() const noexcept { return status == CONTACT_NORMAL_OK; }
};

namespace detail {

/// Pressures and tractions, NULL where there are none.
inline std::array<const double *, 3> arrays(const scene &of, const loads &on)
{
    return {sized_or_none("pressure", on.pressure, of.size()), sized_or_none("traction_x", on.traction_x, of.size()),
            sized_or_none("traction_y", on.traction_y, of.size())};
}

/// Room for what is asked for, and where it is.
inline contact_normal_stress_outputs room_of(stresses &found, stress_fields asked, std::size_t size)
{
    contact_normal_stress_outputs outputs;
    contact_normal_stress_outputs_init(&outputs);
    const auto asks = [&](stress_fields which) { return (static_cast<std::uint32_t>(asked) & static_cast<std::uint32_t>(which)) != 0; };
    const auto room = [&](std::vector<double> &values, stress_fields which, std::size_t n) -> double * {
        if (!asks(which)) return nullptr;
        values.resize(n);
        return values.data();
    };
    for (std::size_t c = 0; c < 6; c++) outputs.stress[c] = room(found.components[c], stress_fields::components, size);
    outputs.von_mises = room(found.von_mises, stress_fields::von_mises, size);
    outputs.maximum_shear = room(found.maximum_shear, stress_fields::maximum_shear, size);
    for (std::size_t k = 0; k < 3; k++) {
        outputs.principal[k] = room(found.principal[k], stress_fields::principal, size);
        outputs.directions[k] = room(found.directions[k], stress_fields::directions, 3 * size);
    }
    outputs.largest_von_mises = &found.largest_von_mises;
    // Principal stresses, which it needs, take longer than all the rest.
    if (asked == stress_fields::none || asks(stress_fields::maximum_shear | stress_fields::principal | stress_fields::directions)) outputs.largest_shear = &found.largest_shear;
    return outputs;
}

} // namespace detail

/// The stresses in body 1 or 2 of a scene at these depths below its elements; of the scene, grid, Poisson's ratio, patches and period
/// matter. Throws `error` if it is refused.
inline stresses subsurface_stress(const scene &of, std::int32_t body, const loads &on, view<double> depths, const options &how = {},
                                  stress_fields asked = stress_fields::components | stress_fields::von_mises | stress_fields::maximum_shear,
                                  const progress &told = {})
{
    stresses found;
    const std::int32_t n = detail::narrow("depths", depths.size());
    const std::array<const double *, 3> on_body = detail::arrays(of, on);
    contact_normal_stress_outputs outputs = detail::room_of(found, asked, depths.size() * detail::room_of(of));
    detail::watched_options options(how, told);
    const contact_normal_scene scene = of.get();
    found.status = contact_normal_subsurface_stress(&scene, body, on_body[0], on_body[1], on_body[2], depths.data(), n, options.get(),
                                                    &outputs);
    found.message = found.status == CONTACT_NORMAL_OK ? "" : contact_normal_last_error();
    options.rethrow();
    if (found.status < 0) throw error(found.status, found.message);
    return found;
}

/// The six components at points (x, y, z), x and y from the middle of the grid. Throws `error` if it is refused or cancelled.
inline std::vector<std::array<double, 6>> stress_at_points(const scene &of, std::int32_t body, const loads &on,
                                                           view<std::array<double, 3>> points, const options &how = {})
{
    std::vector<std::array<double, 6>> found(points.size());
    if (found.empty()) return found;
    const std::array<const double *, 3> on_body = detail::arrays(of, on);
    const contact_normal_scene scene = of.get();
    const contact_normal_status status =
        contact_normal_stress_at_points(&scene, body, on_body[0], on_body[1], on_body[2], points.data()->data(),
                                        detail::narrow("points", points.size()), &how, found.data()->data());
    if (status != CONTACT_NORMAL_OK) throw error(status, contact_normal_last_error());
    return found;
}

} // namespace contact_normal

#endif // CONTACT_NORMAL_STRESS_HPP
