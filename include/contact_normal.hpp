// contact-normal 0.2.0: the elastic normal contact problem by full multigrid, for C++17. Header-only, on contact_normal.h.
//
// #include <contact_normal.hpp>
// namespace cn = contact_normal;
// cn::scene scene({mx, my, dx, dy}, {82000.0, 0.28});               // both bodies; or two of them
// scene.undeformed_distance(h).force(1000.0);                       // h: a std::vector<double> of my * mx, x fastest
// cn::result found = cn::solve(scene);                              // throws cn::error if the scene is refused
// if (!found) std::cerr << found.message;                           // stopped early: found.status > 0
// found.pressure, found.contact, found.report.approach, found.ledger
//
// A scene does not copy arrays: they must live until the solve is over. contact_normal.h says what each member and each status
// means. `solver` is a handle for many solves on one grid; one thread at a time may use it.
#ifndef CONTACT_NORMAL_HPP
#define CONTACT_NORMAL_HPP

#include <contact_normal.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace contact_normal {

/// What is thrown for a negative status: `what()` names the argument, its value and the rule.
class error : public std::runtime_error {
public:
    error(contact_normal_status status, const std::string &message) : std::runtime_error(message), status_(status) {}
    contact_normal_status status() const noexcept { return status_; }

private:
    contact_normal_status status_;
};

/// Throws `error` if `status` is negative.
inline contact_normal_status check(contact_normal_status status)
{
    if (status < 0) throw error(status, contact_normal_last_error());
    return status;
}

/// Contiguous values of the caller's, read only: a std::vector, std::array, std::span, C array, or a pointer and a count.
template <class T> class view {
public:
    view(const T *data, std::size_t size) : data_(data), size_(size) {}
    template <class C, class = std::enable_if_t<std::is_convertible_v<decltype(std::data(std::declval<const C &>())), const T *>>>
    view(const C &container) : data_(std::data(container)), size_(std::size(container))
    {
    }
    const T *data() const noexcept { return data_; }
    std::size_t size() const noexcept { return size_; }

private:
    const T *data_;
    std::size_t size_;
};

/// Elements in x and y, and their sizes.
struct grid {
    std::int32_t mx, my;
    double dx, dy;
};

/// Shear modulus (a pressure; infinity: rigid) and Poisson's ratio of a body.
struct body {
    double shear_modulus, poisson_ratio;
};

/// What is simulated. Members of the same name as those of `contact_normal_scene`; each returns the scene.
class scene {
public:
    scene(const grid &of, const body &both) : scene(of, both, both) {}
    scene(const grid &of, const body &one, const body &other)
    {
        contact_normal_scene_init(&scene_);
        scene_.mx = of.mx, scene_.my = of.my, scene_.dx = of.dx, scene_.dy = of.dy;
        scene_.shear_modulus[0] = one.shear_modulus, scene_.shear_modulus[1] = other.shear_modulus;
        scene_.poisson_ratio[0] = one.poisson_ratio, scene_.poisson_ratio[1] = other.poisson_ratio;
    }

    /// h, my * mx values, x fastest.
    scene &undeformed_distance(view<double> h)
    {
        scene_.undeformed_distance = per_element("undeformed_distance", h);
        return *this;
    }
    scene &approach(double value)
    {
        scene_.load = CONTACT_NORMAL_PRESCRIBED_APPROACH, scene_.approach = value;
        return *this;
    }
    scene &force(double value)
    {
        scene_.load = CONTACT_NORMAL_PRESCRIBED_FORCE, scene_.force = value;
        return *this;
    }

    /// Own influence coefficients, 2 cy * 2 cx values.
    scene &influence(std::int32_t cx, std::int32_t cy, view<double> coefficients, double scale = 1.0)
    {
        influence_.emplace();
        contact_normal_influence_init(&*influence_);
        influence_->cx = cx, influence_->cy = cy, influence_->scale = scale;
        influence_->coefficients = sized("influence", coefficients, 4 * count(cx) * count(cy));
        return *this;
    }
    /// Own coefficients of each loaded row, my * my * 2 cx values.
    scene &row_tables(std::int32_t cx, view<double> coefficients, double scale = 1.0)
    {
        row_tables_.emplace();
        contact_normal_row_tables_init(&*row_tables_);
        row_tables_->cx = cx, row_tables_->rows = scene_.my, row_tables_->scale = scale;
        row_tables_->coefficients = sized("row_tables", coefficients, 2 * count(cx) * count(scene_.my) * count(scene_.my));
        return *this;
    }
    /// A thin compliant layer: of one compliance, or of one per element.
    scene &layer(double compliance)
    {
        contact_normal_layer_init(&layer_.emplace());
        layer_->compliance = compliance;
        return *this;
    }
    scene &layer(view<double> compliances)
    {
        contact_normal_layer_init(&layer_.emplace());
        layer_->compliances = per_element("layer", compliances);
        return *this;
    }
    /// A coating on body 0 or 1 of the scene: an elastic layer of this thickness and material, bonded to the body.
    scene &coating(std::size_t body, double thickness, const contact_normal::body &material)
    {
        std::optional<contact_normal_coating> &coating = coating_.at(body);
        contact_normal_coating_init(&coating.emplace());
        coating->thickness = thickness, coating->shear_modulus = material.shear_modulus;
        coating->poisson_ratio = material.poisson_ratio;
        return *this;
    }
    /// No pressure is larger: one limit, or one per element.
    scene &pressure_limit(double limit)
    {
        contact_normal_pressure_limit_init(&pressure_limit_.emplace());
        pressure_limit_->limit = limit;
        return *this;
    }
    scene &pressure_limit(view<double> limits)
    {
        contact_normal_pressure_limit_init(&pressure_limit_.emplace());
        pressure_limit_->limits = per_element("pressure_limit", limits);
        return *this;
    }
    /// The grid is one period in x, in y, or in both.
    scene &period(bool x, bool y)
    {
        contact_normal_period_init(&period_.emplace());
        period_->x = x, period_->y = y;
        return *this;
    }
    /// The patch of each element, 0 to patches - 1, and the patches * patches factors of their interaction.
    scene &patches(std::int32_t patches, view<std::int32_t> patch, view<double> factors)
    {
        contact_normal_patches_init(&patches_.emplace());
        patches_->count = patches, patches_->patch = per_element("patches", patch);
        patches_->factors = sized("patches' factors", factors, count(patches) * count(patches));
        return *this;
    }

    /// The scene of the C ABI, valid as long as this one and the arrays.
    contact_normal_scene get() const
    {
        contact_normal_scene named = scene_;
        named.influence = influence_ ? &*influence_ : nullptr;
        named.layer = layer_ ? &*layer_ : nullptr;
        named.pressure_limit = pressure_limit_ ? &*pressure_limit_ : nullptr;
        named.period = period_ ? &*period_ : nullptr;
        named.patches = patches_ ? &*patches_ : nullptr;
        named.row_tables = row_tables_ ? &*row_tables_ : nullptr;
        for (std::size_t body : {0u, 1u}) named.coating[body] = coating_[body] ? &*coating_[body] : nullptr;
        return named;
    }
    /// Elements of the grid.
    std::size_t size() const noexcept { return count(scene_.mx) * count(scene_.my); }

private:
    static std::size_t count(std::int32_t m) noexcept { return m > 0 ? static_cast<std::size_t>(m) : 0; }
    template <class T> static const T *sized(const char *name, view<T> values, std::size_t size)
    {
        if (values.size() == size) return values.data();
        throw error(CONTACT_NORMAL_INVALID_ARGUMENT, std::string(name) + " has " + std::to_string(values.size()) +
                                                         " values; it must have " + std::to_string(size));
    }
    template <class T> const T *per_element(const char *name, view<T> values) const { return sized(name, values, size()); }

    contact_normal_scene scene_;
    std::optional<contact_normal_influence> influence_;
    std::optional<contact_normal_layer> layer_;
    std::optional<contact_normal_pressure_limit> pressure_limit_;
    std::optional<contact_normal_period> period_;
    std::optional<contact_normal_patches> patches_;
    std::optional<contact_normal_row_tables> row_tables_;
    std::array<std::optional<contact_normal_coating>, 2> coating_;
};

/// How a scene is solved: `contact_normal_options`, filled with the defaults.
struct options : contact_normal_options {
    options() { contact_normal_options_init(this); }
};

/// Called after each cycle; true cancels. What it throws cancels too, and comes through.
using progress = std::function<bool(const contact_normal_progress &)>;

/// What a solve found. The arrays have my * mx values, x fastest.
struct result {
    contact_normal_status status = CONTACT_NORMAL_OK;
    std::string message; // why, if the status is not OK
    std::vector<double> pressure, deformed_distance, displacement;
    std::vector<std::int32_t> contact; // 0: exterior, 1: contact, 2: at the pressure limit
    contact_normal_report report;
    std::vector<contact_normal_ledger_row> ledger; // coarsest grid first

    result() { contact_normal_report_init(&report); }
    /// True if the contact conditions hold to the tolerance.
    explicit operator bool() const noexcept { return status == CONTACT_NORMAL_OK; }
};

namespace detail {

// One row per grid, each with half the elements in a direction: mx and my are 32-bit.
constexpr std::size_t ledger_room = 32;

struct watched {
    const contact_normal::progress &call;
    std::exception_ptr thrown;
};

inline std::int32_t on_progress(const contact_normal_progress *told, void *user) noexcept
{
    auto *self = static_cast<watched *>(user);
    try {
        return self->call(*told) ? 1 : 0;
    } catch (...) {
        self->thrown = std::current_exception();
        return 1;
    }
}

/// `call(options, fields, report)` with the arrays of `found`, whose pressure and contact are the initial guess.
template <class Call>
contact_normal_status run(std::size_t size, result &found, options how, const contact_normal::progress &told, Call call)
{
    watched watch{told, nullptr};
    if (told) how.progress = on_progress, how.user = &watch;
    if (found.contact.size() != size) {
        found.contact.clear();
        for (double p : found.pressure) found.contact.push_back(p > 0.0);
    }
    for (auto *values : {&found.pressure, &found.deformed_distance, &found.displacement}) values->resize(size);
    found.contact.resize(size);
    found.ledger.resize(ledger_room);
    contact_normal_fields fields;
    contact_normal_fields_init(&fields);
    fields.pressure = found.pressure.data(), fields.deformed_distance = found.deformed_distance.data();
    fields.displacement = found.displacement.data(), fields.contact = found.contact.data();
    contact_normal_report_init(&found.report);
    found.report.ledger = found.ledger.data(), found.report.ledger_capacity = ledger_room;
    found.status = call(&how, &fields, &found.report);
    found.message = found.status == CONTACT_NORMAL_OK ? "" : contact_normal_last_error();
    found.ledger.resize(found.status < 0 ? 0 : static_cast<std::size_t>(found.report.ledger_rows));
    found.report.ledger = nullptr, found.report.ledger_capacity = 0;
    if (watch.thrown) std::rethrow_exception(watch.thrown);
    return found.status;
}

inline result or_throw(result found)
{
    if (found.status < 0) throw error(found.status, found.message);
    return found;
}

} // namespace detail

/// Solves one scene into `found`, and returns the status: negative if it is refused, and nothing is thrown. What `found` holds of
/// pressures and contact area is the start where `how.initial_guess` is GIVEN, or `how.active_set` FIXED.
inline contact_normal_status solve_into(const scene &of, result &found, const options &how = {}, const progress &told = {})
{
    const contact_normal_scene scene = of.get();
    return detail::run(of.size(), found, how, told,
                       [&](auto *options, auto *fields, auto *report) { return contact_normal_solve(&scene, options, fields, report); });
}

/// Solves one scene; throws `error` if it is refused.
inline result solve(const scene &of, const options &how = {}, const progress &told = {})
{
    result found;
    solve_into(of, found, how, told);
    return detail::or_throw(std::move(found));
}

/// A handle for many solves on the grid, the bodies and the effects of a scene; it frees itself.
class solver {
public:
    explicit solver(const scene &of, const options &how = {})
    {
        // The set-up checks the undeformed distance but does not read it otherwise.
        const std::vector<double> flat(of.size());
        contact_normal_scene scene = of.get();
        if (!scene.undeformed_distance) scene.undeformed_distance = flat.data();
        contact_normal_solver *handle = nullptr;
        check(contact_normal_solver_new(&scene, &how, &handle));
        handle_.reset(handle);
    }

    /// As the functions of the same names; `how.initial_guess` may be PREVIOUS.
    contact_normal_status solve_into(const scene &of, result &found, const options &how = {}, const progress &told = {})
    {
        const contact_normal_scene scene = of.get();
        return detail::run(of.size(), found, how, told, [&](auto *options, auto *fields, auto *report) {
            return contact_normal_solver_solve(handle_.get(), &scene, options, fields, report);
        });
    }
    result solve(const scene &of, const options &how = {}, const progress &told = {})
    {
        result found;
        solve_into(of, found, how, told);
        return detail::or_throw(std::move(found));
    }

    /// The handle of the C ABI, for its other calls: batches, set_influence.
    contact_normal_solver *get() const noexcept { return handle_.get(); }

private:
    struct free {
        void operator()(contact_normal_solver *handle) const noexcept { contact_normal_solver_free(handle); }
    };
    std::unique_ptr<contact_normal_solver, free> handle_;
};

/// The exact contact of h = curvature_x x^2 + curvature_y y^2 for a prescribed approach or force (`load`).
inline contact_normal_hertz_solution hertz(double curvature_x, double curvature_y, const body &one, const body &other,
                                           std::int32_t load, double amount)
{
    const double shear_modulus[2] = {one.shear_modulus, other.shear_modulus};
    const double poisson_ratio[2] = {one.poisson_ratio, other.poisson_ratio};
    contact_normal_hertz_solution exact;
    check(contact_normal_hertz(curvature_x, curvature_y, shear_modulus, poisson_ratio, load, amount, &exact));
    return exact;
}

} // namespace contact_normal

#endif // CONTACT_NORMAL_HPP
