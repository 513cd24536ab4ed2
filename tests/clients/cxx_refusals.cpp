// contact_normal.hpp: a refused call throws `error`; one whose name ends with `_into` returns a status. A refused result holds nothing. Prints one line per
// check that fails, and the number of checks.
#include "cxx_expect.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <type_traits>
#include <vector>

namespace cn = contact_normal;

static const cn::grid GRID{32, 24, 0.1, 0.1}, TOO_LARGE{2000000000, 2000000000, 0.1, 0.1};
static const cn::body STEEL{82000.0, 0.28};

static std::vector<double> ball()
{
    std::vector<double> h;
    for (int iy = 0; iy < GRID.my; iy++) {
        for (int ix = 0; ix < GRID.mx; ix++) h.push_back(1e-4 * ((ix - 15.5) * (ix - 15.5) + (iy - 11.5) * (iy - 11.5)));
    }
    return h;
}

/// The call throws `error` with INVALID_ARGUMENT and a message that contains `said`.
template <class Call> static void refuses(Call call, const std::string &said, const char *what)
{
    bool is_refused = false;
    try {
        call();
    } catch (const cn::error &refused) {
        is_refused = refused.status() == CONTACT_NORMAL_INVALID_ARGUMENT && std::string(refused.what()).find(said) != std::string::npos;
    } catch (const std::exception &other) {
        std::printf("another exception: %s\n", other.what());
    }
    expect(is_refused, what);
}

/// A result that was refused before the library saw it: it holds nothing, and its report is a new one.
static bool is_bare(const cn::result &found)
{
    return found.status == CONTACT_NORMAL_INVALID_ARGUMENT && !found.message.empty() && !found.holds(cn::fields::pressure) && found.ledger.empty() &&
           found.report.ledger == nullptr && found.report.ledger_capacity == 0 && found.report.normal.contact_count == 0;
}

static void results()
{
    const std::vector<double> h = ball();
    const cn::scene scene = cn::scene(GRID, STEEL).undeformed_distance(h).force(500.0);
    cn::options from_here;
    from_here.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_GIVEN;
    cn::result found(cn::fields::pressure | cn::fields::ledger);
    expect(cn::solve_into(scene, found) == CONTACT_NORMAL_OK && found.holds(found.asked) && found.report.normal.contact_count > 0, "a solve");
    found.pressure.pop_back();
    expect(cn::solve_into(scene, found, from_here) == CONTACT_NORMAL_INVALID_ARGUMENT, "a start of another size");
    expect(is_bare(found), "leaves nothing in the result");
    expect(found.pressure.size() == h.size() - 1, "but the start itself");
}

static void batches()
{
    const std::vector<double> h = ball();
    std::vector<cn::scene> scenes;
    for (int k = 0; k < 3; k++) scenes.push_back(cn::scene(GRID, STEEL).undeformed_distance(h).force(100.0 * (k + 1)));
    cn::solver solver(scenes[0]);
    cn::batch found;
    found.results.assign(3, cn::result(cn::fields::all));
    const auto all_are_bare = [&] {
        bool all = true;
        for (const cn::result &each : found.results) all = all && is_bare(each);
        return all;
    };
    expect(solver.solve_batch_into(scenes, found) == CONTACT_NORMAL_OK && found.results[2].holds(cn::fields::ledger | cn::fields::pressure), "a batch");

    cn::options wrong;
    wrong.tolerance = -1.0;
    expect(solver.solve_batch_into(scenes, found, wrong) == CONTACT_NORMAL_INVALID_ARGUMENT, "a batch that is refused as a whole");
    expect(found.status == CONTACT_NORMAL_INVALID_ARGUMENT && found.message.find("tolerance is -1") != std::string::npos, "says why");
    expect(all_are_bare(), "and leaves nothing in the results");
    refuses([&] { solver.solve_batch(scenes, wrong); }, "tolerance is -1", "the same is thrown");

    expect(static_cast<bool>(solver.solve_batch(scenes)) && solver.solve_batch_into(scenes, found) == CONTACT_NORMAL_OK, "the next is solved");
    cn::options from_here;
    from_here.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_GIVEN;
    found.results[1].pressure.pop_back();
    expect(solver.solve_batch_into(scenes, found, from_here) == CONTACT_NORMAL_INVALID_ARGUMENT && found.message.find("problem 1: found.pressure") == 0,
           "a start of another size");
    expect(all_are_bare(), "leaves nothing, either");
    expect(solver.solve_batch_into({}, found) == CONTACT_NORMAL_INVALID_ARGUMENT && found.message.find("3 values; it must have 0") != std::string::npos,
           "a result for each");
    refuses([&] { solver.solve_batch(scenes, from_here); }, "problem 0: found.pressure", "a start that is not there");
}

static void sizes()
{
    const std::vector<double> h = ball(), few(3);
    const double both[2] = {1.0, 1.0};
    refuses([&] { cn::flash_temperature(4, 4, 0.1, 0.1, h, both, both, both); }, "heat_flux has 768 values; it must have 16", "a flux of another size");
    const std::array<std::vector<double>, 2> whole = {h, h}, half = {h, few};
    refuses([&] { cn::frictional_wear(32, 24, 0.1, 0.1, half, whole, 1e-4); }, "traction has 3 values; it must have 768", "tractions of another size");
    refuses([&] { cn::frictional_wear(32, 24, 0.1, 0.1, whole, half, 1e-4); }, "slip has 3 values", "slip of another size");
    refuses([&] { cn::frictional_wear(32, 24, 0.1, 0.1, whole, whole, 1e-4, 1.0, 1.0, 0.0, few); }, "pressure has 3 values", "pressures of another size");
    refuses([&] { cn::frictional_wear(32, 24, 0.1, 0.1, whole, whole, 1e-4, 1.0, 1.0, 0.0, {}, few); }, "coefficients has 3 values",
            "coefficients of another size");
}

/// Whether a literal 0 is taken for a pointer.
template <class B, class = void> struct takes_zero : std::false_type {};
template <class B> struct takes_zero<B, std::void_t<decltype(B(0, std::size_t(1)))>> : std::true_type {};

/// The library refuses sizes beyond all memory by name, before the header allocates.
static void too_large()
{
    const std::vector<double> h = ball();
    const std::vector<std::int32_t> force{CONTACT_NORMAL_QUANTITY_FORCE};
    const cn::scene scene = cn::scene(GRID, STEEL).undeformed_distance(h).force(500.0), vast = cn::scene(TOO_LARGE, STEEL).force(1.0);
    refuses([&] { cn::quantities(scene, force, 2000000000); }, "coarser is 2000000000; it must lie in 0..12", "so many coarser grids");
    refuses([&] { cn::quantities(scene, force, -3); }, "coarser is -3", "fewer than none");
    // The first of these is 0. The pair must not count as a null pointer and a length.
    const auto of_both = cn::quantities(scene, {CONTACT_NORMAL_QUANTITY_FORCE, CONTACT_NORMAL_QUANTITY_MAX_PRESSURE}, 0);
    expect(of_both.rows.size() == 2, "quantities in braces");
    static_assert(!takes_zero<cn::borrowed<double>>::value, "no pointer");
    refuses([&] { cn::solve(vast); }, "a grid has at most", "a grid");
    refuses([&] { cn::solver handle(vast); }, "a grid has at most", "a handle for it");
    refuses([&] { cn::subsurface_stress(vast, 1, {cn::borrowed<double>(nullptr, 0)}, std::vector<double>{1.0}); }, "a grid has at most", "its stresses");
    const std::int32_t m = TOO_LARGE.mx;
    refuses([&] { cn::influence_half_space(m, m, 0.1, 0.1, STEEL, STEEL); }, "no influence table is that large", "a table");
    refuses([&] { cn::influence_rolling(m, m, 0.1, 0.1, STEEL, STEEL, cn::visco(), 1.0); }, "no influence table is that large", "one of rolling");
    refuses([&] { cn::influence_rolling_tangential(m, m, 0.1, 0.1, STEEL, STEEL, cn::visco(), 1.0); }, "no influence table is that large",
            "tangential ones");
}

int main()
{
    results();
    batches();
    sizes();
    too_large();
    std::printf("%d of %d checks failed\n", failed, checked);
    return failed != 0;
}
