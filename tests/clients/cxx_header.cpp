// contact_normal.hpp: the promises of its classes. Prints one line per check that fails, and the number of checks.
#include "cxx_expect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace cn = contact_normal;

static const cn::grid GRID{32, 24, 0.1, 0.1};
static const cn::body STEEL{82000.0, 0.28};

static std::vector<double> ball(double curvature)
{
    std::vector<double> h;
    for (int iy = 0; iy < GRID.my; iy++) {
        for (int ix = 0; ix < GRID.mx; ix++) {
            const double x = (ix - 15.5) * GRID.dx, y = (iy - 11.5) * GRID.dy;
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

static void scenes()
{
    const std::vector<double> h = ball(0.01);
    cn::scene scene(GRID, STEEL);
    scene.undeformed_distance(h).force(500.0);
    const cn::result found = cn::solve(scene);
    expect(static_cast<bool>(found) && found.message.empty(), "a plain solve is OK");
    expect(std::abs(found.report.normal.force - 500.0) < 1e-9 * 500.0, "the prescribed force");
    double sum = 0.0;
    for (double p : found.pressure) sum += p * GRID.dx * GRID.dy;
    expect(std::abs(sum - 500.0) < 1e-9 * 500.0, "the pressures add up to the force");
    expect(!found.ledger.empty() && found.ledger.back().mx == GRID.mx, "the ledger ends with the grid of the scene");

    // The plain C call gives the same bits.
    std::vector<double> p(h.size());
    contact_normal_scene plain = scene.get();
    contact_normal_fields fields;
    contact_normal_fields_init(&fields);
    fields.pressure = p.data();
    expect(contact_normal_solve(&plain, nullptr, &fields, nullptr) == CONTACT_NORMAL_OK && p == found.pressure, "as in C");

    // A copy has its own effects.
    cn::scene limited = scene;
    limited.pressure_limit(0.5 * found.report.normal.max_pressure);
    cn::scene copy = limited;
    const cn::result at_limit = cn::solve(copy);
    expect(at_limit.report.normal.max_pressure == 0.5 * found.report.normal.max_pressure, "a copy keeps the limit");
    expect(cn::solve(scene).pressure == found.pressure, "the original has none");

    const std::vector<double> compliances(h.size(), 1e-5);
    const double one = cn::solve(cn::scene(scene).layer(1e-5)).report.normal.approach;
    const double many = cn::solve(cn::scene(scene).layer(compliances)).report.normal.approach;
    // The tolerance of the residual is 1e-6. Without the layer the approach is 40 percent less.
    expect(std::abs(many / one - 1.0) < 1e-5 && one > 1.1 * found.report.normal.approach, "a layer of one number or of many");
    // A coating of the body's own material changes nothing, a soft one does; a copy keeps it.
    const cn::result same = cn::solve(cn::scene(scene).coating(1, 0.1, STEEL));
    const cn::result soft = cn::solve(cn::scene(scene).coating(2, 0.1, {8200.0, 0.28}));
    expect(std::abs(same.report.normal.approach / found.report.normal.approach - 1.0) < 1e-4, "a coating of the same material");
    expect(soft.report.normal.approach > 1.05 * found.report.normal.approach, "a soft coating");
    const std::vector<std::int32_t> patch(h.size(), 0);
    const std::array<double, 1> factors{1.0};
    expect(std::abs(cn::solve(cn::scene(scene).patches(1, patch, factors)).report.normal.approach / found.report.normal.approach - 1.0) < 1e-5,
           "one patch changes nothing");
    expect(cn::solve(cn::scene(scene).period(true, false)).report.normal.approach != found.report.normal.approach, "a period");
    const cn::body rigid{std::numeric_limits<double>::infinity(), 0.0};
    expect(cn::solve(cn::scene(GRID, STEEL, rigid).undeformed_distance(h).force(500.0)).report.normal.max_pressure > found.report.normal.max_pressure,
           "a rigid body");

    const double modulus[2] = {82000.0, 82000.0}, ratio[2] = {0.28, 0.28};
    std::vector<double> table(4 * 32 * 24);
    cn::check(contact_normal_influence_half_space(32, 24, 0.1, 0.1, modulus, ratio, table.data()));
    const cn::result own = cn::solve(cn::scene(scene).influence(32, 24, table));
    expect(std::abs(own.report.normal.approach / found.report.normal.approach - 1.0) < 1e-5, "own coefficients, those of the half-space");
}

static void loads()
{
    const std::vector<double> h = ball(0.01);
    cn::scene scene(GRID, STEEL);
    scene.undeformed_distance(h);
    expect(thrown_by([&] { cn::solve(scene); }, "no load: set") == CONTACT_NORMAL_INVALID_ARGUMENT, "a scene needs a load");
    cn::result found;
    expect(cn::solve_into(scene, found) == CONTACT_NORMAL_INVALID_ARGUMENT && found.pressure == std::vector<double>(h.size()), "without exceptions, too");
    cn::solver solver(scene); // a handle needs no load
    expect(solver.solve_into(scene, found) == CONTACT_NORMAL_INVALID_ARGUMENT, "nor does a handle guess it");
    const double force = solver.solve(scene.approach(0.01)).report.normal.force;
    const double approach = solver.solve(scene.force(force)).report.normal.approach;
    expect(std::abs(approach / 0.01 - 1.0) < 1e-5, "the one that is set last");
}

static void refusals()
{
    const std::vector<double> h = ball(0.01), half(h.begin(), h.begin() + 100);
    cn::scene scene(GRID, STEEL);
    expect(thrown_by([&] { scene.undeformed_distance(half); }, "undeformed_distance has 100 values; it must have 768") ==
               CONTACT_NORMAL_INVALID_ARGUMENT,
           "a wrong size");
    scene.undeformed_distance(h).force(-1.0);
    expect(thrown_by([&] { cn::solve(scene); }, "force is -1") == CONTACT_NORMAL_INVALID_ARGUMENT, "a refused force");
    cn::result found;
    expect(cn::solve_into(scene, found) == CONTACT_NORMAL_INVALID_ARGUMENT && found.status < 0 &&
               found.message.find("force is -1") == 0 && found.ledger.empty(),
           "the same without an exception");
    cn::options one_cycle;
    one_cycle.max_cycles = 1, one_cycle.tolerance = 1e-14, one_cycle.method = CONTACT_NORMAL_METHOD_NORM;
    const cn::result early = cn::solve(scene.force(500.0), one_cycle);
    expect(!early && early.status == CONTACT_NORMAL_ITERATION_LIMIT && !early.message.empty(), "stopped early, and why");
    expect(thrown_by([&] { scene.coating(0, 0.1, STEEL); }, "body is 0") == CONTACT_NORMAL_INVALID_ARGUMENT, "bodies are 1 and 2");
    expect(thrown_by([] { cn::hertz(-1.0, 1.0, STEEL, STEEL, CONTACT_NORMAL_PRESCRIBED_FORCE, 1.0); }, "curvature_x is -1") ==
               CONTACT_NORMAL_INVALID_ARGUMENT,
           "hertz");
}

static void handles()
{
    const std::vector<double> h = ball(0.01);
    cn::scene scene(GRID, STEEL);
    scene.force(500.0);
    cn::solver first(scene);
    cn::solver solver = std::move(first);
    scene.undeformed_distance(h);
    cn::result found = solver.solve(scene);
    expect(found.pressure == cn::solve(scene).pressure, "a handle has the bits of a single call");
    cn::options from_here;
    from_here.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_GIVEN;
    found.contact.clear(); // it follows from the pressures
    expect(solver.solve_into(scene, found, from_here) == CONTACT_NORMAL_OK, "a start from a result");

    int calls = 0;
    const cn::result cancelled = solver.solve(scene, {}, [&](const contact_normal_progress &told) {
        calls++;
        return told.mx > 0;
    });
    expect(calls == 1 && cancelled.status == CONTACT_NORMAL_CANCELLED, "progress cancels");
    bool came_through = false;
    try {
        solver.solve(scene, {}, [](const contact_normal_progress &) -> bool { throw std::runtime_error("mine"); });
    } catch (const std::runtime_error &mine) {
        came_through = std::string(mine.what()) == "mine";
    }
    expect(came_through, "what progress throws comes through");
}

static void frictions()
{
    const std::vector<double> h = ball(0.01);
    cn::scene scene(GRID, STEEL);
    scene.undeformed_distance(h).force(500.0);
    expect(!cn::solve(scene).holds(cn::fields::stick_slip), "no friction: nothing adheres or slips");

    const double creepage[2] = {-1e-3, 2e-4}, spin = 1e-4;
    const cn::friction moved = cn::friction(0.3).motion(CONTACT_NORMAL_MOTION_STEADY_ROLLING).creepage(0, creepage[0]).creepage(1, creepage[1]).spin(spin);
    const cn::result rolled = cn::solve(cn::scene(scene).friction(moved));
    expect(static_cast<bool>(rolled) && rolled.report.tangential.force[0] > 0.0, "a negative creepage has a positive force");
    double sum = 0.0;
    std::int64_t slips = 0;
    bool bounded = true;
    for (std::size_t i = 0; i < h.size(); i++) {
        sum += rolled.traction[0][i] * GRID.dx * GRID.dy, slips += rolled.stick_slip[i] == CONTACT_NORMAL_STICK_SLIP_SLIP;
        // The lengths are rounded here, but not in the library.
        bounded = bounded && std::hypot(rolled.traction[0][i], rolled.traction[1][i]) <= 0.3 * rolled.pressure[i] * (1 + 1e-15);
    }
    expect(bounded, "|q| <= mu p");
    expect(std::abs(sum - rolled.report.tangential.force[0]) < 1e-9 * 150.0 && slips == rolled.report.tangential.slip_count, "the report's force and slip");

    // Coefficients per element; given forces.
    const std::vector<double> coefficients(h.size(), 0.3);
    const cn::result pushed = cn::solve(cn::scene(scene).friction(cn::friction(coefficients).force(0, 50.0).creepage(1, 0.0)));
    expect(std::abs(pushed.report.tangential.force[0] - 50.0) < 1e-4 * 150.0, "the force given");
    const std::vector<double> few(3, 0.3);
    expect(thrown_by([&] { cn::scene(scene).friction(cn::friction(few)); }, "coefficients has 3 values") == CONTACT_NORMAL_INVALID_ARGUMENT,
           "too few coefficients");
    expect(thrown_by([&] { cn::friction(0.3).force(2, 1.0); }, "direction is 2") == CONTACT_NORMAL_INVALID_ARGUMENT, "a third direction");

    // The entries of a table equal single solves. A refused entry is named.
    std::vector<std::array<double, 3>> entries;
    for (int k = 0; k < 20; k++) entries.push_back({creepage[0] * 0.1 * k, creepage[1], spin});
    const cn::scene rolling = cn::scene(scene).friction(moved);
    const cn::friction_table table = cn::friction_batch(rolling, entries);
    expect(static_cast<bool>(table) && table.message.empty() && std::abs(table.report.normal.force - 500.0) < 1e-9 * 500.0, "a table");
    // With a residual of 1e-6 the error is some 1e-7 of mu N.
    expect(std::abs(table.force[10][0] - rolled.report.tangential.force[0]) < 1e-5 * 150.0, "an entry");
    expect(table.creepage[7][0] == entries[7][0] && table.residual[7] <= 1e-6 && table.products[7] > 0.0, "its numbers");
    const cn::friction_table given = cn::friction_batch(rolling, entries, {}, {}, cn::view<double>(rolled.pressure));
    expect(given.force == table.force, "pressures that are given");
    cn::solver kept(rolling);
    expect(cn::friction_batch(kept, rolling, entries, rolled.pressure).force == table.force, "with a handle");
    const cn::result alone = cn::solve_tangential(rolling, rolled.pressure), one = kept.solve_tangential(rolling, rolled.pressure);
    expect(alone.holds(cn::fields::traction | cn::fields::slip | cn::fields::stick_slip) && alone.traction == one.traction &&
               alone.slip == one.slip && alone.report.tangential.force[0] == one.report.tangential.force[0],
           "one problem, with a handle and without");
    entries[3][2] = std::numeric_limits<double>::quiet_NaN();
    const cn::friction_table broken = cn::friction_batch(rolling, entries);
    expect(broken.status == CONTACT_NORMAL_NOT_FINITE && broken.statuses[3] == CONTACT_NORMAL_NOT_FINITE && broken.statuses[4] == CONTACT_NORMAL_OK &&
               broken.message.rfind("entry 3: ", 0) == 0,
           "an entry that is refused");
    expect(thrown_by([&] { cn::friction_batch(scene, entries); }, "friction is not given") == CONTACT_NORMAL_INVALID_ARGUMENT, "no friction");
    int calls = 0;
    const cn::friction_table cancelled = cn::friction_batch(rolling, entries, {}, [&](const contact_normal_progress &told) {
        calls++;
        return told.cycles >= 2;
    }, cn::view<double>(rolled.pressure));
    expect(cancelled.statuses[2] == CONTACT_NORMAL_CANCELLED && cancelled.statuses[1] == CONTACT_NORMAL_OK && calls == 2, "a table cancelled");
}

static void stresses_below_the_surface()
{
    const std::vector<double> h = ball(0.01), depths{0.0, 0.3};
    cn::scene scene(GRID, STEEL);
    const cn::result found = cn::solve(scene.undeformed_distance(h).force(500.0));
    std::vector<double> q;
    for (double p : found.pressure) q.push_back(0.2 * p);
    const cn::stresses below = cn::subsurface_stress(scene, 1, {found.pressure, q}, depths);
    const std::size_t n = scene.size(), middle = 12 * 32 + 16;
    expect(below.components[5].size() == 2 * n && below.von_mises.size() == 2 * n, "a value per element and depth");
    const double p = found.pressure[middle];
    expect(std::abs(below.components[2][middle] + p) <= 1e-13 * p, "szz = -p at the surface");
    expect(std::abs(below.components[4][middle] + q[middle]) <= 1e-13 * p, "sxz = -qx at the surface");
    double largest = 0.0;
    for (double value : below.von_mises) largest = std::max(largest, value);
    expect(below.largest_von_mises.value == largest, "the largest is that of the array");
    const std::vector<std::array<double, 3>> points{{{0.5 * GRID.dx, 0.5 * GRID.dy, 0.3}}};
    const auto at = cn::stress_at_points(scene, 1, {found.pressure, q}, points);
    expect(at.size() == 1 && std::abs(at[0][2] - below.components[2][n + middle]) <= 1e-12 * p, "a point below an element");
    expect(cn::stress_at_points(scene, 1, {found.pressure}, std::vector<std::array<double, 3>>{}).empty(), "no points");
    const std::vector<double> few(5);
    const auto short_traction = [&] { cn::subsurface_stress(scene, 1, {found.pressure, few}, depths); };
    expect(thrown_by(short_traction, "traction_x has 5 values") == CONTACT_NORMAL_INVALID_ARGUMENT, "tractions of another size");
    const auto body_3 = [&] { cn::subsurface_stress(scene, 3, {found.pressure}, depths); };
    expect(thrown_by(body_3, "body is 3") == CONTACT_NORMAL_INVALID_ARGUMENT, "no third body");
}

int main()
{
    scenes();
    loads();
    frictions();
    refusals();
    handles();
    stresses_below_the_surface();
    std::printf("%d of %d checks failed\n", failed, checked);
    return failed != 0;
}
