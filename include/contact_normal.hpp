// contact-normal 0.2.0: the elastic normal contact problem by full multigrid, for C++17. Header-only, on contact_normal.h.
//
// #include <contact_normal.hpp>
// namespace cn = contact_normal;
// cn::scene scene({mx, my, dx, dy}, {82000.0, 0.28});               // both bodies; or two of them
// scene.undeformed_distance(h).force(1000.0);                       // h: a std::vector<double> of my * mx, x fastest
// cn::result found = cn::solve(scene);                              // throws cn::error if the scene is refused
// if (!found) std::cerr << found.message;                           // stopped early: found.status > 0
// found.pressure, found.contact, found.report.normal.approach, found.ledger
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
#include <limits>
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

/// Friction between the bodies: `contact_normal_friction`. Each member function returns the friction; directions are 0 for x, 1 for y.
class friction {
public:
    /// One coefficient, or one per element.
    explicit friction(double coefficient) { contact_normal_friction_init(&friction_), friction_.coefficient = coefficient; }
    explicit friction(view<double> coefficients) : friction(0.0) { coefficients_ = coefficients; }

    /// CONTACT_NORMAL_MOTION_..., and of rolling the length of the step (0: dx) and the direction (radians from the x axis).
    friction &motion(std::int32_t kind, double rolling_distance = 0.0, double rolling_direction = 0.0)
    {
        friction_.motion = kind;
        friction_.rolling_distance = rolling_distance, friction_.rolling_direction = rolling_direction;
        return *this;
    }
    /// The creepage in a direction is given, or the force is.
    friction &creepage(std::size_t direction, double value)
    {
        friction_.prescribed[checked(direction)] = CONTACT_NORMAL_PRESCRIBED_CREEPAGE, friction_.creepage[direction] = value;
        return *this;
    }
    friction &force(std::size_t direction, double value)
    {
        friction_.prescribed[checked(direction)] = CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE, friction_.force[direction] = value;
        return *this;
    }
    /// The spin, about a place counted from the middle of the grid.
    friction &spin(double value, double centre_x = 0.0, double centre_y = 0.0)
    {
        friction_.spin = value, friction_.spin_centre[0] = centre_x, friction_.spin_centre[1] = centre_y;
        return *this;
    }
    /// The tractions before, in x and y; or those that the solver found last.
    friction &previous_traction(view<double> x, view<double> y)
    {
        previous_[0] = x, previous_[1] = y;
        return *this;
    }
    friction &continues()
    {
        friction_.continues = 1;
        return *this;
    }
    /// A rigid slip in addition, in x and y.
    friction &rigid_slip(view<double> x, view<double> y)
    {
        slip_[0] = x, slip_[1] = y;
        return *this;
    }

    /// That of the C ABI, for a grid of so many elements; `sized(name, values)` checks the arrays.
    template <class Sized> contact_normal_friction get(Sized sized) const
    {
        contact_normal_friction named = friction_;
        if (coefficients_) named.coefficients = sized("friction's coefficients", *coefficients_);
        for (std::size_t k : {0u, 1u}) {
            if (previous_[k]) named.previous_traction[k] = sized("friction's previous_traction", *previous_[k]);
            if (slip_[k]) named.rigid_slip[k] = sized("friction's rigid_slip", *slip_[k]);
        }
        return named;
    }

private:
    static std::size_t checked(std::size_t direction)
    {
        if (direction < 2) return direction;
        throw error(CONTACT_NORMAL_INVALID_ARGUMENT, "direction is " + std::to_string(direction) + "; it must be 0 for x or 1 for y");
    }

    contact_normal_friction friction_;
    std::optional<view<double>> coefficients_;
    std::array<std::optional<view<double>>, 2> previous_, slip_;
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
    /// A coating on body 1 or 2 of the scene: an elastic layer of this thickness and material, bonded to the body.
    scene &coating(std::size_t body, double thickness, const contact_normal::body &material)
    {
        if (body < 1 || body > 2) {
            throw error(CONTACT_NORMAL_INVALID_ARGUMENT, "body is " + std::to_string(body) + "; it must be 1 or 2");
        }
        std::optional<contact_normal_coating> &coating = coating_[body - 1];
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
    /// Friction between the bodies.
    scene &friction(const contact_normal::friction &of)
    {
        friction_ = of.get([this](const char *name, view<double> values) { return per_element(name, values); });
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
        named.friction = friction_ ? &*friction_ : nullptr;
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
    std::optional<contact_normal_friction> friction_;
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
    std::string message; // why, if the status is not OK, and what report.warnings mean
    std::vector<double> pressure, deformed_distance, displacement;
    std::vector<std::int32_t> contact; // 0: exterior, 1: contact, 2: at the pressure limit
    std::array<std::vector<double>, 2> traction, slip; // in x and y; zeros without friction
    std::vector<std::int32_t> stick_slip;                // 0: exterior, 1: stick, 2: slip
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
    for (std::size_t k : {0u, 1u}) {
        found.traction[k].resize(size), found.slip[k].resize(size);
        fields.traction[k] = found.traction[k].data(), fields.slip[k] = found.slip[k].data();
    }
    found.stick_slip.resize(size);
    fields.stick_slip = found.stick_slip.data();
    contact_normal_report_init(&found.report);
    contact_normal_ledger_row_init(found.ledger.data());
    found.report.ledger = found.ledger.data(), found.report.ledger_capacity = ledger_room;
    found.status = call(&how, &fields, &found.report);
    const bool is_silent = found.status == CONTACT_NORMAL_OK && found.report.warnings == 0;
    found.message = is_silent ? "" : contact_normal_last_error();
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

/// What a table of tangential forces found: of each entry its numbers.
struct friction_table {
    contact_normal_status status = CONTACT_NORMAL_OK;
    std::string message; // a line for each entry that is not OK
    std::vector<contact_normal_status> statuses;
    std::vector<std::array<double, 2>> force, creepage;
    std::vector<double> moment, residual, products;
    contact_normal_report report; // of the normal problem

    /// True if all entries are solved to the tolerance.
    explicit operator bool() const noexcept { return status == CONTACT_NORMAL_OK; }
};

/// Solves the tangential problem of a scene with friction for each of the entries: the creepage (or force) in x and in y, and the spin.
/// `pressure`: my * mx values, or none: those of the normal problem. See `contact_normal_solve_tangential`; throws `error` if the call itself is
/// refused, but not for an entry.
inline friction_table friction_batch(const scene &of, view<std::array<double, 3>> entries, const options &given = {},
                                     const progress &told = {}, std::optional<view<double>> pressure = {})
{
    // No status has this value.
    constexpr contact_normal_status untouched = -12345;
    if (pressure && pressure->size() != of.size()) {
        throw error(CONTACT_NORMAL_INVALID_ARGUMENT, "pressure has " + std::to_string(pressure->size()) + " values; it must have " +
                                                         std::to_string(of.size()));
    }
    friction_table found;
    const std::size_t count = entries.size();
    found.statuses.assign(count, untouched), found.force.resize(count), found.creepage.resize(count);
    for (auto *values : {&found.moment, &found.residual, &found.products}) values->resize(count);
    contact_normal_friction_results results;
    contact_normal_friction_results_init(&results);
    results.status = found.statuses.data();
    results.force = found.force.empty() ? nullptr : found.force.front().data();
    results.creepage = found.creepage.empty() ? nullptr : found.creepage.front().data();
    results.moment = found.moment.data(), results.residual = found.residual.data(), results.products = found.products.data();
    contact_normal_report_init(&found.report);
    options how = given;
    detail::watched watch{told, nullptr};
    if (told) how.progress = detail::on_progress, how.user = &watch;
    const contact_normal_scene scene = of.get();
    found.status = contact_normal_solve_tangential(nullptr, &scene, pressure ? pressure->data() : nullptr, &how, static_cast<std::int32_t>(count),
                                                 count == 0 ? nullptr : entries.data()->data(), &results, &found.report);
    found.message = found.status == CONTACT_NORMAL_OK ? "" : contact_normal_last_error();
    if (watch.thrown) std::rethrow_exception(watch.thrown);
    const bool is_refused = count == 0 || found.statuses.front() == untouched;
    if (found.status < 0 && is_refused) throw error(found.status, found.message);
    return found;
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

/// What acts on the elements of a body, my * mx values each; a view of no values: nothing. Tractions are those on this body.
struct loads {
    view<double> pressure;
    view<double> traction_x{nullptr, 0}, traction_y{nullptr, 0};
};

/// Stresses below the centres of the elements, positive in tension: n * my * mx values for n depths, x fastest.
struct stresses {
    std::array<std::vector<double>, 6> components; // xx, yy, zz, xy, xz, yz
    std::vector<double> von_mises, maximum_shear;
    contact_normal_stress_maximum largest_von_mises, largest_shear;

    stresses() { contact_normal_stress_maximum_init(&largest_von_mises), contact_normal_stress_maximum_init(&largest_shear); }
};

namespace detail {

inline const double *load(const scene &of, const char *name, view<double> values)
{
    if (values.size() == 0) return nullptr;
    if (values.size() == of.size()) return values.data();
    throw error(CONTACT_NORMAL_INVALID_ARGUMENT, std::string(name) + " has " + std::to_string(values.size()) +
                                                     " values; it must have " + std::to_string(of.size()));
}

inline std::int32_t points_of(std::size_t n)
{
    if (n <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) return static_cast<std::int32_t>(n);
    throw error(CONTACT_NORMAL_INVALID_ARGUMENT, "there are more than 2^31 - 1 depths or points");
}

} // namespace detail

/// The stresses in body 1 or 2 of a scene at these depths below its elements; of the scene, grid, Poisson's ratio and period matter.
inline stresses subsurface_stress(const scene &of, std::int32_t body, const loads &on, view<double> depths, const options &how = {})
{
    stresses found;
    const contact_normal_scene scene = of.get();
    const std::int32_t n = detail::points_of(depths.size());
    contact_normal_stress_outputs outputs;
    contact_normal_stress_outputs_init(&outputs);
    for (std::size_t c = 0; c < 6; c++) {
        found.components[c].resize(depths.size() * of.size());
        outputs.stress[c] = found.components[c].data();
    }
    for (auto *values : {&found.von_mises, &found.maximum_shear}) values->resize(depths.size() * of.size());
    outputs.von_mises = found.von_mises.data(), outputs.maximum_shear = found.maximum_shear.data();
    outputs.largest_von_mises = &found.largest_von_mises, outputs.largest_shear = &found.largest_shear;
    const double *const p = detail::load(of, "pressure", on.pressure);
    const double *const qx = detail::load(of, "traction_x", on.traction_x), *const qy = detail::load(of, "traction_y", on.traction_y);
    const contact_normal_status status =
        check(contact_normal_subsurface_stress(&scene, body, p, qx, qy, depths.data(), n, &how, &outputs));
    if (status > 0) throw error(status, contact_normal_last_error());
    return found;
}

/// The six components at points (x, y, z), x and y from the middle of the grid.
inline std::vector<std::array<double, 6>> stress_at_points(const scene &of, std::int32_t body, const loads &on,
                                                           view<std::array<double, 3>> points, const options &how = {})
{
    std::vector<std::array<double, 6>> found(points.size());
    if (found.empty()) return found;
    const contact_normal_scene scene = of.get();
    const double *const p = detail::load(of, "pressure", on.pressure);
    const double *const qx = detail::load(of, "traction_x", on.traction_x), *const qy = detail::load(of, "traction_y", on.traction_y);
    check(contact_normal_stress_at_points(&scene, body, p, qx, qy, points.data()->data(), detail::points_of(points.size()), &how,
                                          found.data()->data()));
    return found;
}

/// The exact contact of h = curvature_x x^2 + curvature_y y^2 for a prescribed approach or force (`load`).
inline contact_normal_hertz_solution hertz(double curvature_x, double curvature_y, const body &one, const body &other,
                                           std::int32_t load, double amount)
{
    const double shear_modulus[2] = {one.shear_modulus, other.shear_modulus};
    const double poisson_ratio[2] = {one.poisson_ratio, other.poisson_ratio};
    contact_normal_hertz_solution exact;
    contact_normal_hertz_solution_init(&exact);
    check(contact_normal_hertz(curvature_x, curvature_y, shear_modulus, poisson_ratio, load, amount, &exact));
    return exact;
}

} // namespace contact_normal

#endif // CONTACT_NORMAL_HPP
