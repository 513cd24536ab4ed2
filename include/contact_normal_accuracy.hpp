// contact_normal.hpp: an accuracy instead of a grid, and what it costs.
#ifndef CONTACT_NORMAL_ACCURACY_HPP
#define CONTACT_NORMAL_ACCURACY_HPP

#include <contact_normal_options.hpp>
#include <contact_normal_result.hpp>
#include <contact_normal_scene.hpp>
#include <contact_normal_solver.hpp>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace contact_normal {

/// The accuracy that is asked for and what it may cost: `contact_normal_accuracy`, filled with the defaults.
struct accuracy : contact_normal_accuracy {
    accuracy() { contact_normal_accuracy_init(this); }
    explicit accuracy(double of) : accuracy() { target = of; }
};

/// Writes the undeformed distance, my * mx values, of a grid over the rectangle of the scene; true cancels. What it throws cancels
/// too, and comes through.
using surface = std::function<bool(const grid &, double *)>;

namespace detail {

inline std::int32_t on_surface(std::int32_t mx, std::int32_t my, double dx, double dy, double *h, void *user) noexcept
{
    return static_cast<watched<surface> *>(user)->run(grid{mx, my, dx, dy}, h);
}

/// An accuracy whose surface is `from`, if it is one.
class watched_accuracy {
public:
    watched_accuracy(const contact_normal_accuracy &wanted, const surface &from) : accuracy_(wanted), watched_{from, nullptr}
    {
        if (from) accuracy_.surface = on_surface, accuracy_.user = &watched_;
    }
    watched_accuracy(const watched_accuracy &) = delete;
    watched_accuracy &operator=(const watched_accuracy &) = delete;

    contact_normal_accuracy *get() noexcept { return &accuracy_; }
    void rethrow() const { watched_.rethrow(); }

private:
    contact_normal_accuracy accuracy_;
    watched<surface> watched_;
};

} // namespace detail

/// What `solve_to_accuracy` found.
struct refined {
    contact_normal::accuracy accuracy;            // the grid that it took, and what was reached
    result found;                                 // on that grid; it holds nothing if cancelled before a grid was solved
    std::optional<contact_normal::solver> solver; // a handle with this result

    /// True if the targets are met.
    explicit operator bool() const noexcept { return found.status == CONTACT_NORMAL_OK; }
};

/// Solves on finer and finer grids over the rectangle of a scene until the estimated errors are what is wanted:
/// `contact_normal_solve_to_accuracy`. `from`: where the undeformed distance of each grid comes from; none: that of the scene is
/// refined. Throws `error` if it is refused.
inline refined solve_to_accuracy(const scene &of, const accuracy &wanted, const surface &from = {}, const options &how = {},
                                 const progress &told = {}, fields asked = fields::all)
{
    detail::watched_options options(how, told);
    detail::watched_accuracy accuracy(wanted, from);
    const contact_normal_scene scene = of.get();
    contact_normal_solver *handle = nullptr;
    contact_normal_report report;
    contact_normal_report_init(&report);
    std::vector<contact_normal_ledger_row> ledger(detail::ledger_room);
    contact_normal_ledger_row_init(ledger.data());
    report.ledger = ledger.data(), report.ledger_capacity = static_cast<std::int64_t>(ledger.size());
    const contact_normal_status status =
        contact_normal_solve_to_accuracy(&scene, options.get(), accuracy.get(), &handle, &report);
    const bool is_silent = status == CONTACT_NORMAL_OK && report.warnings == 0;
    const std::string message = is_silent ? "" : contact_normal_last_error();
    refined all;
    if (handle) all.solver.emplace(handle);
    options.rethrow(), accuracy.rethrow();
    if (status < 0) throw error(status, message);
    static_cast<contact_normal_accuracy &>(all.accuracy) = *accuracy.get();
    all.accuracy.surface = wanted.surface, all.accuracy.user = wanted.user;
    if (handle) all.found = all.solver->last(detail::outputs::had_by(of, asked));
    detail::outputs::without_ledger(report);
    all.found.status = status, all.found.message = message, all.found.report = report;
    if (handle) detail::outputs::add_ledger(all.found, asked, ledger);
    return all;
}

/// What each of some relative errors costs.
struct price_list {
    contact_normal_status status = CONTACT_NORMAL_OK;
    std::string message;                      // why, if it was cancelled
    std::vector<contact_normal_price> prices; // one for each target

    /// True unless it was cancelled.
    explicit operator bool() const noexcept { return status == CONTACT_NORMAL_OK; }
};

/// Predicts what each of these relative errors of a quantity (CONTACT_NORMAL_QUANTITY_...) costs: `contact_normal_cost_of_accuracy`. Of
/// `limits` the target is not read. Throws `error` if it is refused.
inline price_list cost_of_accuracy(const scene &of, view<double> targets, std::int32_t quantity = CONTACT_NORMAL_QUANTITY_FORCE,
                                   const accuracy &limits = {}, const surface &from = {}, const options &how = {})
{
    detail::watched_accuracy accuracy(limits, from);
    const contact_normal_scene scene = of.get();
    price_list list;
    list.prices.resize(targets.size());
    contact_normal_price_init(list.prices.data());
    list.status = contact_normal_cost_of_accuracy(&scene, &how, accuracy.get(), quantity, detail::narrow("targets", targets.size()),
                                                  targets.data(), list.prices.data());
    list.message = list.status == CONTACT_NORMAL_OK ? "" : contact_normal_last_error();
    accuracy.rethrow();
    if (list.status < 0) throw error(list.status, list.message);
    return list;
}

/// The quantities of a scene, grid by grid.
struct quantity_rows {
    contact_normal_status status = CONTACT_NORMAL_OK;
    std::string message;                            // why, if it was not solved
    std::vector<contact_normal_quantity_row> rows;  // for each grid, coarsest first, one for each quantity

    /// True if the scene's own grid was solved.
    explicit operator bool() const noexcept { return status == CONTACT_NORMAL_OK; }
};

/// Values and errors of these quantities (CONTACT_NORMAL_QUANTITY_...) on the scene's grid and on `coarser` grids with half the elements
/// each: `contact_normal_quantities`. Throws `error` if it is refused.
inline quantity_rows quantities(const scene &of, view<std::int32_t> wanted, std::int32_t coarser = 2, const options &how = {})
{
    const contact_normal_scene scene = of.get();
    quantity_rows all;
    const std::int32_t most = 12; // of `coarser`: the library refuses more
    const std::size_t grids = static_cast<std::size_t>(std::clamp(coarser, 0, most)) + 1;
    all.rows.resize(wanted.size() * grids + 1);
    contact_normal_quantity_row_init(all.rows.data());
    std::int32_t written = 0;
    all.status = contact_normal_quantities(&scene, &how, detail::narrow("quantities", wanted.size()), wanted.data(), coarser,
                                           all.rows.data(), &written);
    all.message = all.status == CONTACT_NORMAL_OK ? "" : contact_normal_last_error();
    if (all.status < 0) throw error(all.status, all.message);
    all.rows.resize(static_cast<std::size_t>(written));
    return all;
}

/// What effects a scene calls for.
struct bill {
    contact_normal_status status = CONTACT_NORMAL_OK;
    std::string message;                          // why, if it was ended early
    std::vector<contact_normal_effects_row> rows; // for each effect, then for each pair, one for each quantity

    /// True unless it was ended early.
    explicit operator bool() const noexcept { return status == CONTACT_NORMAL_OK; }
};

/// How much each of these quantities (CONTACT_NORMAL_QUANTITY_...) changes where an effect, or a pair of them, is left out, what that saves,
/// and whether the relative accuracy `target` calls for it: `contact_normal_effects_bill`. Throws `error` if it is refused.
inline bill effects_bill(const scene &of, double target, view<std::int32_t> wanted, bool pairs = true, const options &how = {})
{
    const contact_normal_scene scene = of.get();
    bill all;
    std::int32_t count = 0;
    const std::int32_t n = detail::narrow("quantities", wanted.size());
    const auto ask = [&](std::int32_t capacity, contact_normal_effects_row *rows) {
        all.status = contact_normal_effects_bill(&scene, &how, target, pairs ? 1 : 0, n, wanted.data(), capacity, rows, &count);
        all.message = all.status == CONTACT_NORMAL_OK ? "" : contact_normal_last_error();
        if (all.status < 0) throw error(all.status, all.message);
    };
    ask(0, nullptr);
    all.rows.resize(static_cast<std::size_t>(count) + 1);
    contact_normal_effects_row_init(all.rows.data());
    ask(count, all.rows.data());
    all.rows.resize(static_cast<std::size_t>(count));
    return all;
}

} // namespace contact_normal

#endif // CONTACT_NORMAL_ACCURACY_HPP
