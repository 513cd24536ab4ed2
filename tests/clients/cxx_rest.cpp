// contact_normal.hpp: the other functions of C, each called once and compared. Prints one line per check that fails, and the number of checks.
#include "cxx_expect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace cn = contact_normal;

static constexpr cn::fields of_adhesion = cn::fields::contact_pressure | cn::fields::attraction;
static constexpr cn::fields of_effects = of_adhesion | cn::fields::traction | cn::fields::slip | cn::fields::stick_slip
    | cn::fields::friction_coefficient | cn::fields::yield_limit;
static const cn::grid GRID{32, 24, 0.1, 0.1};
static const cn::body STEEL{82000.0, 0.28}, RUBBER{1.0, 0.49};

static std::vector<double> ball(const cn::grid &of, double curvature)
{
    std::vector<double> h;
    for (int iy = 0; iy < of.my; iy++) {
        for (int ix = 0; ix < of.mx; ix++) {
            const double x = (ix + 0.5 - 0.5 * of.mx) * of.dx, y = (iy + 0.5 - 0.5 * of.my) * of.dy;
            h.push_back(curvature * (x * x + y * y));
        }
    }
    return h;
}

template <class Call> static contact_normal_status thrown_by(Call call, const char *named)
{
    try {
        call();
    } catch (const cn::error &refused) {
        return std::string(refused.what()).find(named) == std::string::npos ? 1000 : refused.status();
    }
    return CONTACT_NORMAL_OK;
}

static void fields_of_a_result()
{
    const std::vector<double> h = ball(GRID, 0.01);
    const cn::scene scene = cn::scene(GRID, STEEL).undeformed_distance(h).force(500.0);
    const cn::result all = cn::solve(scene);
    expect(all.holds(cn::fields::all - of_effects), "a solve holds all");
    expect(!all.holds(cn::fields::traction) && all.traction[0].empty() && all.stick_slip.empty(), "but no tractions without friction");

    cn::solver solver(scene);
    cn::result few(cn::fields::pressure);
    expect(!few.holds(cn::fields::pressure), "nothing before a solve");
    solver.solve_into(scene, few);
    expect(few.holds(cn::fields::pressure) && few.pressure == all.pressure && !few.holds(cn::fields::contact), "what was asked for");
    expect(few.contact.empty() && few.displacement.empty() && few.ledger.empty() && few.report.ledger == nullptr, "and no more");
    cn::result usual;
    solver.solve_into(scene, usual);
    expect(usual.holds(cn::fields::displacement | cn::fields::contact) && !usual.holds(cn::fields::ledger), "the defaults leave the ledger out");
    expect(solver.last().displacement == all.displacement && solver.last().ledger.empty(), "the last result of a handle");

    // A start is read, whichever fields are wanted.
    cn::options from_here;
    from_here.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_GIVEN;
    few.pressure = all.pressure;
    expect(solver.solve_into(scene, few, from_here) == CONTACT_NORMAL_OK && few.report.statistics.cycles <= 2, "a start from pressures alone");
    few.pressure.pop_back();
    expect(solver.solve_into(scene, few, from_here) == CONTACT_NORMAL_INVALID_ARGUMENT && few.message.find("767 values; it must have 768") != std::string::npos,
           "a start of another size");
    cn::options fixed;
    fixed.active_set = CONTACT_NORMAL_ACTIVE_SET_FIXED;
    cn::result inner(cn::fields::pressure);
    inner.contact = all.contact;
    expect(solver.solve_into(scene, inner, fixed) == CONTACT_NORMAL_OK && std::abs(inner.report.normal.force - 500.0) < 1e-9 * 500.0, "a fixed contact area");
    inner.contact.clear();
    expect(solver.solve_into(scene, inner, fixed) == CONTACT_NORMAL_INVALID_ARGUMENT, "needs one");
}

static void batches()
{
    const std::vector<double> h = ball(GRID, 0.01);
    cn::options how;
    how.threads = 2;
    std::vector<cn::scene> scenes;
    for (int k = 0; k < 5; k++) scenes.push_back(cn::scene(GRID, STEEL).undeformed_distance(h).force(100.0 * (k + 1)));
    cn::solver solver(scenes[0], how);
    const cn::batch found = solver.solve_batch(scenes, how);
    expect(static_cast<bool>(found) && found.results.size() == 5, "a batch");
    expect(found.results[3].pressure == solver.solve(scenes[3], how).pressure && found.results[3].holds(cn::fields::ledger), "has the bits of a single solve");
    scenes[2].force(-1.0);
    cn::batch second;
    second.results.assign(5, cn::result(cn::fields::pressure));
    expect(solver.solve_batch_into(scenes, second, how) == CONTACT_NORMAL_INVALID_ARGUMENT && second.message.find("problem 2: force is -1") == 0, "one is refused");
    expect(second.results[2].status == CONTACT_NORMAL_INVALID_ARGUMENT && second.results[2].message.find("force is -1") == 0 &&
               !second.results[2].holds(cn::fields::pressure),
           "and says why");
    expect(second.results[4] && second.results[4].message.empty() && second.results[4].pressure == found.results[4].pressure, "the others are solved");
    // One contact reaches the border, one is a single element, and one has no warning.
    std::vector<double> alone(h.size(), 1.0);
    alone[static_cast<std::size_t>(std::min_element(h.begin(), h.end()) - h.begin())] = 0.0;
    scenes = {cn::scene(GRID, STEEL).undeformed_distance(h).force(1e6), cn::scene(GRID, STEEL).undeformed_distance(alone).force(1e-3),
              cn::scene(GRID, STEEL).undeformed_distance(h).force(100.0)};
    const cn::batch warned = solver.solve_batch(scenes, how);
    const std::string border = "contact reaches the border", single = "one element is in contact";
    expect(static_cast<bool>(warned) && warned.message.find(border) == 0 && warned.message.find(single) != std::string::npos, "a batch that is OK warns");
    expect(warned.results[0].message.find(border) == 0 && warned.results[1].message.find(single) == 0 && warned.results[2].message.empty() &&
               warned.results[0].message == solver.solve(scenes[0], how).message && warned.results[1].message == solver.solve(scenes[1], how).message,
           "and each problem as it does alone");
    const std::array<double, 3> entry = {1e-4, 0.0, 0.0};
    cn::friction falling(0.3);
    falling.motion(CONTACT_NORMAL_MOTION_STEADY_ROLLING).law(CONTACT_NORMAL_FRICTION_LAW_LINEAR, 0.1, 0.2, 1e-6, 1.0).memory(1e-9, 1e-9);
    const cn::friction_table table = cn::friction_batch(cn::scene(scenes[2]).friction(falling), cn::view<std::array<double, 3>>(&entry, 1));
    expect(table.status == CONTACT_NORMAL_OK && table.report.warnings == CONTACT_NORMAL_WARNING_LAW && table.message.find("friction falls so steeply") == 0,
           "a table of friction that is OK warns");
    how.progress = [](const contact_normal_progress *, void *) -> std::int32_t { return 0; };
    expect(thrown_by([&] { solver.solve_batch(scenes, how); }, "progress") == CONTACT_NORMAL_UNSUPPORTED, "a batch that is refused as a whole");
}

static void accuracies()
{
    const std::vector<double> h = ball(GRID, 0.01);
    const cn::scene scene = cn::scene(GRID, STEEL).undeformed_distance(h).force(500.0);
    const cn::refined coarse = cn::solve_to_accuracy(scene, cn::accuracy(0.01));
    expect(static_cast<bool>(coarse) && coarse.accuracy.reached <= 0.01 && coarse.accuracy.mx >= 32, "an accuracy is reached");
    expect(coarse.found.pressure.size() == static_cast<std::size_t>(coarse.accuracy.mx * coarse.accuracy.my), "pressures of the grid that it took");
    expect(!coarse.found.ledger.empty() && coarse.found.ledger.back().mx == coarse.accuracy.mx && coarse.found.holds(cn::fields::ledger), "its ledger");
    expect(coarse.found.holds(cn::fields::all - of_effects) && !coarse.found.holds(cn::fields::contact_pressure) &&
               coarse.found.contact_pressure.empty() && coarse.found.attraction.empty(),
           "no attraction without adhesion");
    expect(coarse.solver && coarse.solver->query().mx == coarse.accuracy.mx && coarse.solver->query().has_result == 1, "its handle");
    int grids = 0;
    const cn::surface exact = [&](const cn::grid &of, double *to) {
        grids++;
        const std::vector<double> values = ball(of, 0.01);
        std::copy(values.begin(), values.end(), to);
        return false;
    };
    const cn::scene bare = cn::scene(GRID, STEEL).force(500.0);
    const double by_surface = cn::solve_to_accuracy(bare, cn::accuracy(0.01), exact).found.report.normal.approach;
    expect(grids > 0 && std::abs(by_surface / coarse.found.report.normal.approach - 1.0) < 0.02, "a surface by a function");
    const cn::refined none = cn::solve_to_accuracy(bare, cn::accuracy(0.01), [](const cn::grid &, double *) { return true; });
    expect(none.found.status == CONTACT_NORMAL_CANCELLED && !none.solver && !none.found.holds(cn::fields::pressure), "a surface that cancels");
    bool came_through = false;
    try {
        cn::solve_to_accuracy(bare, cn::accuracy(0.01), [](const cn::grid &, double *) -> bool { throw std::runtime_error("mine"); });
    } catch (const std::runtime_error &mine) {
        came_through = std::string(mine.what()) == "mine";
    }
    expect(came_through, "what it throws comes through");
    expect(thrown_by([&] { cn::solve_to_accuracy(scene, cn::accuracy(2.0)); }, "target is 2") == CONTACT_NORMAL_INVALID_ARGUMENT, "a target that is refused");

    const std::array<double, 2> targets{0.02, 1e-5};
    const cn::price_list prices = cn::cost_of_accuracy(scene, targets, CONTACT_NORMAL_QUANTITY_FORCE);
    expect(static_cast<bool>(prices) && prices.prices.size() == 2 && prices.prices[1].target == 1e-5, "a price for each target");
    expect(prices.prices[0].mx > 0 && prices.prices[1].mx > prices.prices[0].mx, "more accuracy takes a finer grid");
    expect(cn::cost_of_accuracy(bare, targets, CONTACT_NORMAL_QUANTITY_MAX_PRESSURE, {}, exact).prices[0].mx > 0, "prices of a surface");
    expect(thrown_by([&] { cn::cost_of_accuracy(scene, std::vector<double>{}); }, "n is 0") == CONTACT_NORMAL_INVALID_ARGUMENT, "no targets");
}

static void adhesions()
{
    const cn::grid grid{32, 32, 6.0 / 32, 6.0 / 32};
    std::vector<double> h;
    for (int i = 0; i < 32 * 32; i++) {
        const double x = (i % 32 - 15.5) * grid.dx, y = (i / 32 - 15.5) * grid.dy;
        h.push_back(0.5 * (x * x + y * y));
    }
    cn::scene scene(grid, {0.375, 0.0}, {std::numeric_limits<double>::infinity(), 0.0});
    scene.undeformed_distance(h);
    const cn::adhesion sticky = cn::adhesion(0.3183).range(0.5648).law(CONTACT_NORMAL_LAW_EXPONENTIAL).start(CONTACT_NORMAL_START_AUTO).stiffness();
    const cn::result found = cn::solve(cn::scene(scene).adhesion(sticky).force(-1.0));
    expect(found && found.holds(of_adhesion) && found.report.adhesion.stiffness > 0.0, "a pull is held");
    double off = 0.0;
    for (std::size_t i = 0; i < h.size(); i++)
        if (found.contact[i]) off = std::max(off, std::abs(found.contact_pressure[i] - found.attraction[i] - found.pressure[i]));
    expect(off < 1e-12, "contact pressure less attraction is pressure");
    const std::vector<double> works(h.size(), 0.3183);
    const cn::result least = cn::pull_off(cn::scene(scene).adhesion(cn::adhesion(works).range(0.5648)).force(0.0));
    expect(least.report.normal.force < -1.6 && least.report.normal.force > -2.0, "the pull-off is between JKR and DMT");
    expect(thrown_by([&] { cn::solve(cn::scene(scene).adhesion(sticky).force(-2.5)); }, "pull-off") == CONTACT_NORMAL_INFEASIBLE, "no more than that");
}

static void relaxing()
{
    const cn::grid grid{32, 32, 0.02, 0.02};
    std::vector<double> h;
    for (int i = 0; i < 32 * 32; i++) {
        const double x = (i % 32 - 15.5) * grid.dx, y = (i / 32 - 15.5) * grid.dy;
        h.push_back(0.5 * (x * x + y * y));
    }
    const std::vector<double> moduli{4.0, 3.0}, times{0.3, 3.0};
    cn::visco step = cn::visco(0.0).branches(2, moduli, times).form(CONTACT_NORMAL_FORM_AUTO);
    cn::scene scene(grid, {std::numeric_limits<double>::infinity(), 0.0}, {8.0, 0.5});
    scene.undeformed_distance(h).approach(0.02).visco(step);
    cn::solver solver(scene);
    const double first = solver.solve(scene).report.normal.force;
    const cn::result found = solver.solve(cn::scene(scene).visco(step.time_step(0.4).continues()));
    double left = 1.0;
    for (std::size_t k = 0; k < 2; k++) left -= moduli[k] / 8.0 * (1.0 - std::exp(-0.4 / times[k]));
    expect(std::abs(found.report.normal.force / first / left - 1.0) < 1e-5 && found.report.visco.time == 0.4, "a held approach relaxes");
    expect(thrown_by([&] { cn::visco().branches(3, moduli, times); }, "body is 3") == CONTACT_NORMAL_INVALID_ARGUMENT, "there are two bodies");
}

static void frictions()
{
    const std::vector<double> h = ball(GRID, 0.01);
    cn::scene scene(GRID, STEEL);
    scene.undeformed_distance(h).force(500.0);
    const cn::friction moved = cn::friction(0.3).creepage(0, -1e-4);
    const cn::result found = cn::solve(cn::scene(scene).friction(moved));
    expect(found.holds(cn::fields::all - of_adhesion) && found.traction[0].size() == h.size(), "with friction all is held");
    const cn::result alone = cn::solve_tangential(cn::scene(GRID, STEEL).friction(moved), found.pressure);
    expect(alone.holds(cn::fields::traction | cn::fields::slip | cn::fields::stick_slip) && alone.pressure.empty(), "the tangential problem alone");
    expect(std::abs(alone.report.tangential.force[0] / found.report.tangential.force[0] - 1.0) < 1e-4, "has the same force");
    expect(thrown_by([&] { cn::solve_tangential(scene, std::vector<double>(3)); }, "pressure has 3 values") == CONTACT_NORMAL_INVALID_ARGUMENT, "pressures of another size");

    const cn::result derived = cn::solve(cn::scene(scene).friction(cn::friction(moved).sensitivities()));
    expect(derived.report.tangential.sensitivities[0] < 0.0 && found.report.tangential.sensitivities[0] == 0.0, "sensitivities");
    const auto rolled_by = [&](double offset) {
        const cn::friction rolling = cn::friction(0.3).motion(CONTACT_NORMAL_MOTION_STEADY_ROLLING).spin(1e-3).spin_offset(offset);
        return cn::solve(cn::scene(scene).friction(rolling)).report.tangential.force[1];
    };
    expect(rolled_by(1.0 / 6.0) != rolled_by(0.5), "the offset of spin");

    // Own tables with the half-space's normal coefficients: xx = yy = A is not elastic, but symmetric as required.
    const std::vector<double> table = cn::influence_half_space(32, 24, 0.1, 0.1, STEEL, STEEL), none(table.size(), 0.0);
    const cn::friction own = cn::friction(0.3).creepage(0, -1e-4).influence(32, 24, table, table, none);
    const cn::scene with_own = cn::scene(scene).friction(own);
    const cn::scene copy = with_own;
    const cn::result by_tables = cn::solve(copy);
    expect(static_cast<bool>(by_tables) && by_tables.report.tangential.force[0] != found.report.tangential.force[0], "own tangential coefficients");
    const cn::result crossed = cn::solve(cn::scene(scene).friction(cn::friction(own).influence_cross(none, none)));
    expect(std::abs(crossed.report.tangential.force[0] / by_tables.report.tangential.force[0] - 1.0) < 1e-4, "cross tables of zeros change nothing");
    expect(thrown_by([&] { cn::friction(0.3).influence_cross(none, none); }, "call influence first") == CONTACT_NORMAL_INVALID_ARGUMENT, "cross tables alone");
    expect(thrown_by([&] { cn::friction(0.3).influence(32, 24, table, h, none); }, "768 values; it must have 3072") == CONTACT_NORMAL_INVALID_ARGUMENT, "a table of another size");

    // The same coefficients, for each pair of rows.
    std::vector<double> of_rows, no_rows(24 * 24 * 64, 0.0);
    for (std::size_t k = 0; k < 24 * 24; k++) {
        const auto row = table.begin() + static_cast<std::ptrdiff_t>((24 + k % 24 - k / 24) * 64);
        of_rows.insert(of_rows.end(), row, row + 64);
    }
    const cn::friction rows = cn::friction(0.3).creepage(0, -1e-4).row_tables(32, 24, of_rows, of_rows, no_rows);
    const cn::result by_rows = cn::solve(cn::scene(scene).friction(rows));
    expect(std::abs(by_rows.report.tangential.force[0] / by_tables.report.tangential.force[0] - 1.0) < 1e-4, "tangential tables per row");
    // The friction of a scene need not outlive the call. A copy of the scene outlives the scene.
    const cn::scene outlives = cn::scene(cn::scene(scene).friction(cn::friction(0.3).creepage(0, -1e-4).row_tables(32, 24, of_rows, of_rows, no_rows)));
    expect(cn::solve(outlives).traction == by_rows.traction, "tables of a temporary friction");
    expect(thrown_by([&] { cn::friction(0.3).row_tables(32, 24, of_rows, h, no_rows); }, "768 values; it must have 36864") == CONTACT_NORMAL_INVALID_ARGUMENT, "tangential row tables of another size");

    const std::vector<std::array<double, 3>> entries{{-1e-4, 0.0, 0.0}, {-2e-4, 0.0, 0.0}};
    const cn::friction_table many =
        cn::friction_batch(cn::scene(scene).friction(moved), entries, {}, {}, found.pressure, cn::fields::traction | cn::fields::stick_slip);
    expect(static_cast<bool>(many) && many.traction.size() == 4 * h.size() && many.slip.empty() && many.stick_slip.size() == 2 * h.size(), "tractions of a table");
    expect(many.stick_count[0] == found.report.tangential.stick_count && many.slip_count[0] == found.report.tangential.slip_count && many.gap[0] < 1e-5, "its counts");
    expect(many.friction_coefficient.empty() && many.yield_limit.empty(), "and no more");

    // The state of particles after each entry is that of the entry alone.
    const cn::friction falling = cn::friction(0.4).creepage(0, -2e-4).law(CONTACT_NORMAL_FRICTION_LAW_EXPONENTIAL, 0.2, 0.2, 1e-4, 1.0).layer(20.0, 1e5);
    const cn::scene worn = cn::scene(scene).friction(falling);
    const cn::friction_table carried =
        cn::friction_batch(worn, entries, {}, {}, found.pressure, cn::fields::friction_coefficient | cn::fields::yield_limit);
    const cn::result last = cn::solve_tangential(worn, found.pressure);
    const auto is_last = [&](const std::vector<double> &of_all, const std::vector<double> &of_one) {
        double off = of_all.size() == 2 * h.size() && of_one.size() == h.size() ? 0.0 : 1.0;
        for (std::size_t i = 0; i < h.size() && off < 1.0; i++) off = std::max(off, std::abs(of_all[h.size() + i] / of_one[i] - 1.0));
        return off < 1e-4;
    };
    expect(is_last(carried.friction_coefficient, last.friction_coefficient), "coefficients of a table");
    expect(is_last(carried.yield_limit, last.yield_limit) && carried.traction.empty(), "yield limits of a table");
}

static void stops()
{
    const std::vector<double> h = ball(GRID, 0.01);
    const cn::scene scene = cn::scene(GRID, STEEL).undeformed_distance(h).force(500.0);
    cn::stop_flag stop;
    cn::options how;
    how.stop_by(stop).tolerance = 1e-12;
    // Another thread sets the flag while this one is in its first cycle.
    const cn::result stopped = cn::solve(scene, how, [&](const contact_normal_progress &) {
        std::thread([&] { stop.set(); }).join();
        return false;
    });
    expect(stopped.status == CONTACT_NORMAL_CANCELLED && stop.is_set() && !stopped, "a flag stops");
    stop.clear();
    expect(static_cast<bool>(cn::solve(scene, how)), "a flag that is clear does not");
    cn::options brief;
    brief.max_seconds = 1e-9;
    expect(cn::solve(scene, brief).status == CONTACT_NORMAL_ITERATION_LIMIT, "seconds at most");
    cn::cycle slow;
    slow.smoother = CONTACT_NORMAL_SMOOTHER_RED_BLACK;
    cn::options paper;
    paper.use_cycle(slow).method = CONTACT_NORMAL_METHOD_MULTIGRID;
    expect(static_cast<bool>(cn::solve(scene, paper)), "a cycle");

    // Contact on the border.
    const std::vector<double> flat(h.size(), 0.0);
    const cn::result border = cn::solve(cn::scene(GRID, STEEL).undeformed_distance(flat).force(500.0));
    expect((border.report.warnings & CONTACT_NORMAL_WARNING_BORDER) != 0 && border.message.find("border") != std::string::npos, "warnings");
}

static void the_library()
{
    expect(cn::version() == contact_normal_version() && cn::abi_version() >= CONTACT_NORMAL_ABI_VERSION, "versions");
    expect(cn::has("friction") && !cn::has("magic") && !cn::status_text(CONTACT_NORMAL_OK).empty(), "what there is");
    const std::vector<double> h = ball(GRID, 0.01);
    const cn::scene scene = cn::scene(GRID, STEEL).undeformed_distance(h).force(500.0);
    std::string told;
    {
        cn::log log(CONTACT_NORMAL_LOG_INFO, [&](std::int32_t, const std::string &message) { told += message; });
        cn::solve(scene);
    }
    const std::string before = told;
    cn::solve(scene);
    expect(!before.empty() && told == before, "a log as long as it lives");
    {
        cn::log log(CONTACT_NORMAL_LOG_INFO, [](std::int32_t, const std::string &) { throw std::runtime_error("mine"); });
        expect(static_cast<bool>(cn::solve(scene)), "what it throws is dropped");
    }
    cn::release();
    expect(cn::kept().bytes == 0, "nothing is kept after a release");
    cn::solve(scene);
    const std::int64_t kept = cn::kept().bytes;
    cn::keep(0);
    cn::solve(scene);
    expect(kept > 0 && cn::kept().bytes == 0, "what may be kept");
    cn::keep(std::int64_t{512} << 20);

    // (1 - nu)/(G k) for one material. With a thick coating it is that of the coating.
    const double steel = (1.0 - 0.28) / (82000.0 * 2.0), rubber = (1.0 - 0.49) / (1.0 * 2.0);
    expect(std::abs(cn::coating_compliance(1.0, STEEL, STEEL, 2.0) / steel - 1.0) < 1e-12, "a coating of the body's own material");
    expect(std::abs(cn::coating_compliance(100.0, RUBBER, {100.0, 0.3}, 2.0) / rubber - 1.0) < 1e-12, "a thick coating");

    const std::vector<double> table = cn::influence_half_space(32, 24, 0.1, 0.1, STEEL, STEEL);
    const cn::scene own = cn::scene(scene).influence(32, 24, table);
    cn::solver solver(own);
    const double first = solver.solve(scene).report.normal.approach;
    solver.set_influence(32, 24, table, 2.0);
    expect(std::abs(solver.solve(scene).report.normal.approach / first - 2.0) < 1.0 && solver.solve(scene).report.normal.approach > 1.1 * first, "other coefficients");
    expect(solver.query().bytes > 0 && solver.query().mx == 32 && solver.query().my == 24, "what a solver is");
    std::vector<double> rows;
    for (int jy = 0; jy < 24; jy++) {
        for (int iy = 0; iy < 24; iy++) rows.insert(rows.end(), table.begin() + (iy - jy + 24) * 64, table.begin() + (iy - jy + 25) * 64);
    }
    expect(std::abs(cn::solve(cn::scene(scene).row_tables(32, rows)).report.normal.approach / first - 1.0) < 1e-5, "tables per row");
    const std::vector<double> limits(h.size(), 400.0);
    expect(cn::solve(cn::scene(scene).pressure_limit(limits)).report.normal.max_pressure == 400.0, "a limit per element");

    const cn::result found = cn::solve(scene);
    const cn::stresses below = cn::subsurface_stress(scene, 1, {found.pressure}, std::vector<double>{0.2}, {}, cn::stress_fields::all);
    const std::size_t middle = 12 * 32 + 16;
    const double difference = below.principal[0][middle] - below.principal[2][middle];
    expect(std::abs(0.5 * difference - below.maximum_shear[middle]) <= 1e-12 * difference, "principal stresses");
    double length = 0.0;
    for (std::size_t k = 0; k < 3; k++) length += std::pow(below.directions[0][3 * middle + k], 2);
    expect(std::abs(length - 1.0) < 1e-12, "their directions");
    const cn::stresses few = cn::subsurface_stress(scene, 1, {found.pressure}, std::vector<double>{0.2}, {}, cn::stress_fields::von_mises);
    expect(few.von_mises == below.von_mises && few.components[0].empty() && few.principal[0].empty(), "what was asked for");
    const cn::stresses cancelled = cn::subsurface_stress(scene, 1, {found.pressure}, std::vector<double>{0.2, 0.3}, {}, cn::stress_fields::von_mises,
                                                         [](const contact_normal_progress &) { return true; });
    expect(cancelled.status == CONTACT_NORMAL_CANCELLED && !cancelled.message.empty(), "stresses that are cancelled");
}

int main()
{
    fields_of_a_result();
    batches();
    accuracies();
    adhesions();
    relaxing();
    frictions();
    stops();
    the_library();
    std::printf("%d of %d checks failed\n", failed, checked);
    return failed != 0;
}
