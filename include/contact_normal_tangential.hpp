// contact_normal.hpp: tangential problems of pressures that are known, and tables of tangential forces.
#ifndef CONTACT_NORMAL_TANGENTIAL_HPP
#define CONTACT_NORMAL_TANGENTIAL_HPP

#include <contact_normal_options.hpp>
#include <contact_normal_result.hpp>
#include <contact_normal_scene.hpp>
#include <contact_normal_solver.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace contact_normal {

/// Solves the tangential problem of a scene with friction for pressures of one's own, my * mx values: `contact_normal_solve_tangential`.
/// The result holds tractions, slip and `stick_slip`. Throws `error` if it is refused.
inline result solve_tangential(const scene &of, view<double> pressure, const options &how = {}, const progress &told = {})
{
    return detail::tangential(nullptr, of, pressure, how, told);
}

/// What a table of tangential forces found: of each entry its numbers.
struct friction_table {
    contact_normal_status status = CONTACT_NORMAL_OK;
    std::string message; // a line for each entry that is not OK; if all are, what report.warnings mean
    std::vector<contact_normal_status> statuses;
    std::vector<std::array<double, 2>> force, creepage;
    std::vector<double> moment, residual, gap, products;
    std::vector<std::int64_t> stick_count, slip_count;
    // If they are asked for: [n][2][my][mx] tractions and slip, [n][my][mx] the others.
    std::vector<double> traction, slip;
    std::vector<std::int32_t> stick_slip;
    std::vector<double> friction_coefficient, yield_limit; // what particles of the interface carry
    contact_normal_report report; // of the normal problem

    /// True if all entries are solved to the tolerance.
    explicit operator bool() const noexcept { return status == CONTACT_NORMAL_OK; }
};

namespace detail {

/// Room for n entries on so many elements, and where it is.
inline contact_normal_friction_results room_of(friction_table &found, std::size_t n, std::size_t elements, fields asked)
{
    found.statuses.assign(n, untouched), found.force.resize(n), found.creepage.resize(n);
    for (auto *values : {&found.moment, &found.residual, &found.gap, &found.products}) values->resize(n);
    for (auto *counts : {&found.stick_count, &found.slip_count}) counts->resize(n);
    const auto is_asked = [&](fields which) { return (asked & which) != fields::none; };
    if (is_asked(fields::traction)) found.traction.resize(2 * n * elements);
    if (is_asked(fields::slip)) found.slip.resize(2 * n * elements);
    if (is_asked(fields::stick_slip)) found.stick_slip.resize(n * elements);
    if (is_asked(fields::friction_coefficient)) found.friction_coefficient.resize(n * elements);
    if (is_asked(fields::yield_limit)) found.yield_limit.resize(n * elements);
    contact_normal_friction_results results;
    contact_normal_friction_results_init(&results);
    const auto place = [](auto &values) { return values.empty() ? nullptr : values.data(); };
    results.force = n == 0 ? nullptr : found.force.front().data();
    results.creepage = n == 0 ? nullptr : found.creepage.front().data();
    results.moment = place(found.moment), results.residual = place(found.residual), results.gap = place(found.gap);
    results.products = place(found.products), results.status = place(found.statuses);
    results.stick_count = place(found.stick_count), results.slip_count = place(found.slip_count);
    results.traction = place(found.traction), results.slip = place(found.slip), results.stick_slip = place(found.stick_slip);
    results.friction_coefficient = place(found.friction_coefficient), results.yield_limit = place(found.yield_limit);
    return results;
}

} // namespace detail

namespace detail {

/// A table of entries, with a handle or without.
inline friction_table table_of(contact_normal_solver *handle, const scene &of, view<std::array<double, 3>> entries, const options &how,
                               const progress &told, std::optional<view<double>> pressure, fields asked)
{
    const double *const p = pressure ? sized("pressure", *pressure, of.size()) : nullptr;
    friction_table found;
    const std::int32_t n = narrow("entries", entries.size());
    contact_normal_friction_results results = room_of(found, entries.size(), of.size(), asked);
    contact_normal_report_init(&found.report);
    watched_options options(how, told);
    const contact_normal_scene scene = of.get();
    const double *const first = n == 0 ? nullptr : entries.data()->data();
    found.status = contact_normal_solve_tangential(handle, &scene, p, options.get(), n, first, &results, &found.report);
    found.message = found.status == CONTACT_NORMAL_OK && found.report.warnings == 0 ? "" : contact_normal_last_error();
    options.rethrow();
    const bool is_refused = n == 0 || found.statuses.front() == untouched;
    if (found.status < 0 && is_refused) throw error(found.status, found.message);
    return found;
}

} // namespace detail

/// Solves the tangential problem of a scene with friction for each of the entries: the creepage (or force) in x and in y, and the spin.
/// `pressure`: my * mx values, or none: those of the normal problem. `asked`: which fields of friction are wanted of all entries; others
/// are not written. See `contact_normal_solve_tangential`; throws `error` if the call itself is refused, but not for an entry.
inline friction_table friction_batch(const scene &of, view<std::array<double, 3>> entries, const options &how = {},
                                     const progress &told = {}, std::optional<view<double>> pressure = {}, fields asked = fields::none)
{
    return detail::table_of(nullptr, of, entries, how, told, pressure, asked);
}

/// The same for pressures of one's own, with the coefficients and operators that a solver keeps.
inline friction_table friction_batch(const solver &kept, const scene &of, view<std::array<double, 3>> entries, view<double> pressure,
                                     const options &how = {}, const progress &told = {}, fields asked = fields::none)
{
    return detail::table_of(kept.get(), of, entries, how, told, pressure, asked);
}

} // namespace contact_normal

#endif // CONTACT_NORMAL_TANGENTIAL_HPP
