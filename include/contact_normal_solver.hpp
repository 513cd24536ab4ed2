// contact_normal.hpp: solves, handles and batches.
#ifndef CONTACT_NORMAL_SOLVER_HPP
#define CONTACT_NORMAL_SOLVER_HPP

#include <contact_normal_options.hpp>
#include <contact_normal_result.hpp>
#include <contact_normal_scene.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace contact_normal {

namespace detail {

// No status has this value.
constexpr contact_normal_status untouched = -12345;

/// `call(scene, options, fields, report)` with the arrays of `found`.
template <class Call>
contact_normal_status run(const scene &of, result &found, const contact_normal_options &how, const progress &told, Call call)
{
    outputs to;
    try {
        const std::string wrong = to.begin(of, found, how);
        if (!wrong.empty()) {
            outputs::refuse(found, CONTACT_NORMAL_INVALID_ARGUMENT, wrong);
            return found.status;
        }
    } catch (const std::bad_alloc &) {
        outputs::refuse(found, CONTACT_NORMAL_OUT_OF_MEMORY, "there is no memory for the results");
        return found.status;
    }
    watched_options options(how, told);
    const contact_normal_scene scene = of.get();
    to.end(found, call(&scene, options.get(), &to.written, &found.report));
    options.rethrow();
    return found.status;
}

inline result or_throw(result found)
{
    if (found.status < 0) throw error(found.status, found.message);
    return found;
}

/// The tangential problem of a scene with pressures of one's own, with a handle or without.
inline result tangential(contact_normal_solver *handle, const scene &of, view<double> pressure, const options &how, const progress &told)
{
    const std::size_t elements = of.size();
    const double *const p = sized("pressure", pressure, elements);
    result found(of.has_friction() ? of_friction : fields::none);
    outputs to;
    to.writes = found.asked;
    to.point(found, to.writes, elements);
    std::vector<double> traction(2 * elements), slip(2 * elements);
    contact_normal_friction_results results;
    contact_normal_friction_results_init(&results);
    results.traction = traction.data(), results.slip = slip.data(), results.stick_slip = to.written.stick_slip;
    results.friction_coefficient = to.written.friction_coefficient, results.yield_limit = to.written.yield_limit;
    watched_options options(how, told);
    const contact_normal_scene scene = of.get();
    to.end(found, contact_normal_solve_tangential(handle, &scene, p, options.get(), 1, nullptr, &results, &found.report));
    options.rethrow();
    for (std::size_t k = 0; k < 2 && found.holds(of_friction); k++) {
        std::copy_n(traction.data() + k * elements, elements, found.traction[k].data());
        std::copy_n(slip.data() + k * elements, elements, found.slip[k].data());
    }
    return or_throw(std::move(found));
}

} // namespace detail

/// Solves one scene into `found`, and returns the status: negative if it is refused, and nothing is thrown. Written is what
/// `found.asked` names. What `found` holds of pressures and contact area is the start where `how.initial_guess` is GIVEN, or
/// `how.active_set` FIXED.
inline contact_normal_status solve_into(const scene &of, result &found, const options &how = {}, const progress &told = {})
{
    return detail::run(of, found, how, told, contact_normal_solve);
}

/// Solves one scene; throws `error` if it is refused.
inline result solve(const scene &of, const options &how = {}, const progress &told = {}, fields asked = fields::all)
{
    result found(asked);
    solve_into(of, found, how, told);
    return detail::or_throw(std::move(found));
}

/// The state of the least force of a scene with adhesion: `contact_normal_pull_off`. Throws `error` if the scene is refused.
inline result pull_off(const scene &of, const options &how = {}, const progress &told = {}, fields asked = fields::all - fields::ledger)
{
    result found(asked);
    detail::run(of, found, how, told, contact_normal_pull_off);
    return detail::or_throw(std::move(found));
}

/// What a batch found: a result of each problem.
struct batch {
    contact_normal_status status = CONTACT_NORMAL_OK; // of all; see `contact_normal_solver_solve_batch`
    std::string message; // a line "problem 3: ..." for each problem that is not OK, counted from 0; if all are, what they warn of
    std::vector<result> results;

    /// True if all problems are solved to the tolerance.
    explicit operator bool() const noexcept { return status == CONTACT_NORMAL_OK; }
};

/// A handle for many solves on the grid, the bodies and the effects of a scene; it frees itself.
class solver {
public:
    explicit solver(const scene &of, const options &how = {})
    {
        // The set-up checks the undeformed distance but does not read it otherwise.
        const std::vector<double> flat(detail::room_of(of));
        contact_normal_scene scene = of.get();
        if (!scene.undeformed_distance) scene.undeformed_distance = flat.data();
        contact_normal_solver *handle = nullptr;
        check(contact_normal_solver_new(&scene, &how, &handle));
        handle_.reset(handle);
    }
    /// Takes over a handle of the C ABI.
    explicit solver(contact_normal_solver *handle) : handle_(handle) {}

    /// As the functions of the same names; `how.initial_guess` may be PREVIOUS. A later solve into the same result takes no new memory for its arrays.
    contact_normal_status solve_into(const scene &of, result &found, const options &how = {}, const progress &told = {})
    {
        return detail::run(of, found, how, told, [this](auto *scene, auto *options, auto *fields, auto *report) {
            return contact_normal_solver_solve(handle_.get(), scene, options, fields, report);
        });
    }
    result solve(const scene &of, const options &how = {}, const progress &told = {}, fields asked = fields::all)
    {
        result found(asked);
        solve_into(of, found, how, told);
        return detail::or_throw(std::move(found));
    }

    /// Solves many problems, as many at a time as the solver was set up with threads. A problem that is refused does not keep the
    /// others from being solved. Throws `error` if the call itself is refused.
    batch solve_batch(const std::vector<scene> &scenes, const options &how = {}, fields asked = fields::all)
    {
        batch found;
        found.results.assign(scenes.size(), result(asked));
        solve_all(scenes, found, how);
        return found;
    }
    /// The same into results that are there, one for each scene: what they hold is the start where `how.initial_guess` is GIVEN. Returns the
    /// status: negative if the call itself is refused, too, and then no result holds anything.
    contact_normal_status solve_batch_into(const std::vector<scene> &scenes, batch &found, const options &how = {});

    /// From here on the solver uses these influence coefficients, 2 cy * 2 cx values, which it copies.
    void set_influence(std::int32_t cx, std::int32_t cy, view<double> coefficients, double scale = 1.0)
    {
        const contact_normal_influence own = detail::table("influence", cx, cy, coefficients, scale);
        check(contact_normal_solver_set_influence(handle_.get(), &own, nullptr));
    }
    /// And these tangential ones: those of `friction::influence` and `influence_cross`, or of `row_tables`.
    void set_influence(const friction &of)
    {
        const contact_normal_friction own = of.tables_alone();
        check(contact_normal_solver_set_influence(handle_.get(), nullptr, &own));
    }

    /// The tangential problem of a scene's friction with pressures of one's own, my * mx values: `contact_normal_solve_tangential` with
    /// what this solver keeps. The result holds tractions, slip and `stick_slip`; throws `error` if it is refused.
    result solve_tangential(const scene &of, view<double> pressure, const options &how = {}, const progress &told = {})
    {
        return detail::tangential(handle_.get(), of, pressure, how, told);
    }

    /// u = A p, my * mx values: `contact_normal_solver_product`.
    std::vector<double> product(view<double> pressure) const
    {
        const contact_normal_solver_info info = query();
        const std::size_t elements = detail::count(info.mx) * detail::count(info.my);
        std::vector<double> displacement(elements);
        const double *const p = detail::sized("pressure", pressure, elements);
        check(contact_normal_solver_product(handle_.get(), p, displacement.data()));
        return displacement;
    }
    /// dF/d approach of the last result, and the residual that it was found with.
    double stiffness(double *residual = nullptr) const
    {
        double found = 0.0;
        check(contact_normal_solver_stiffness(handle_.get(), &found, residual));
        return found;
    }

    /// What the solver is: its grid, threads, bytes, and whether it has a result.
    contact_normal_solver_info query() const
    {
        contact_normal_solver_info info;
        contact_normal_solver_info_init(&info);
        check(contact_normal_solver_query(handle_.get(), &info));
        return info;
    }

    /// The arrays of its last result: of the result's members these alone, and no ledger. Without friction its arrays are zeros.
    result last(fields asked = fields::all - fields::ledger) const
    {
        const contact_normal_solver_info info = query();
        result found(asked);
        detail::outputs to;
        to.writes = asked - fields::ledger;
        to.point(found, to.writes, detail::count(info.mx) * detail::count(info.my));
        to.end(found, check(contact_normal_solver_fields(handle_.get(), &to.written)));
        return found;
    }

    /// The handle of the C ABI; this solver frees it, so a temporary has none to give.
    contact_normal_solver *get() const & noexcept { return handle_.get(); }
    contact_normal_solver *get() const && = delete;

private:
    void solve_all(const std::vector<scene> &scenes, batch &found, const options &how);

    struct free {
        void operator()(contact_normal_solver *handle) const noexcept { contact_normal_solver_free(handle); }
    };
    std::unique_ptr<contact_normal_solver, free> handle_;
};

// Solves a batch; throws `error` if the call itself is refused.
inline void solver::solve_all(const std::vector<scene> &scenes, batch &found, const options &how)
{
    const std::size_t count = scenes.size();
    if (found.results.size() != count) detail::refuse(detail::wrong_size("found.results", found.results.size(), count));
    std::vector<detail::outputs> to(count);
    std::vector<contact_normal_scene> named;
    std::vector<contact_normal_fields> fields;
    std::vector<contact_normal_report> reports;
    named.reserve(count), fields.reserve(count), reports.reserve(count);
    for (std::size_t i = 0; i < count; i++) {
        const std::string wrong = to[i].begin(scenes[i], found.results[i], how);
        if (!wrong.empty()) detail::refuse("problem " + std::to_string(i) + ": " + wrong);
        named.push_back(scenes[i].get()), fields.push_back(to[i].written), reports.push_back(found.results[i].report);
        detail::outputs::without_ledger(found.results[i].report); // its rows end with this call
    }
    std::vector<contact_normal_status> statuses(count, detail::untouched);
    found.status = contact_normal_solver_solve_batch(handle_.get(), detail::narrow("problems", count), named.data(), &how, fields.data(),
                                                     reports.data(), statuses.data());
    const bool warns = std::any_of(reports.begin(), reports.end(), [](const contact_normal_report &each) { return each.warnings != 0; });
    found.message = found.status == CONTACT_NORMAL_OK && !warns ? "" : contact_normal_last_error();
    if (found.status < 0 && (count == 0 || statuses.front() == detail::untouched)) throw error(found.status, found.message);
    for (std::size_t i = 0; i < count; i++) {
        found.results[i].report = reports[i];
        to[i].end(found.results[i], statuses[i], "");
    }
    const auto share = found.status == CONTACT_NORMAL_OK ? detail::share_warnings : detail::share_message;
    share(found.message, found.results);
}

inline contact_normal_status solver::solve_batch_into(const std::vector<scene> &scenes, batch &found, const options &how)
{
    const auto refuse = [&](contact_normal_status status, const char *why) {
        found.status = status, found.message = why;
        for (result &each : found.results) detail::outputs::refuse(each, status, why);
    };
    try {
        solve_all(scenes, found, how);
    } catch (const error &refused) {
        refuse(refused.status(), refused.what());
    } catch (const std::bad_alloc &) {
        refuse(CONTACT_NORMAL_OUT_OF_MEMORY, "there is no memory for the results");
    }
    return found.status;
}

} // namespace contact_normal

#endif // CONTACT_NORMAL_SOLVER_HPP
