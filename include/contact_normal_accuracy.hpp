// contact_normal.hpp: an accuracy instead of a grid, and what it costs.
#ifndef CONTACT_NORMAL_ACCURACY_HPP
#define CONTACT_NORMAL_ACCURACY_HPP

#include <contact_normal_options.hpp>
#include <contact_normal_result.hpp>
#include <contact_normal_scene.hpp>
#include <contact_normal_solver.hpp>

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
    if (handle) all.found = all.solver->last(of.has_friction() ? asked : asked - detail::of_friction);
    report.ledger = nullptr, report.ledger_capacity = 0;
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

} // namespace contact_normal

#endif // CONTACT_NORMAL_ACCURACY_HPP
