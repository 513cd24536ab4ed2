// Bodies that relax: a rigid ball of radius 10 mm on a polymer plate of two branches, held by its approach, then by its force. Last, two balls roll on
// each other at one speed, by coefficients of their own: relaxed material is behind, so pressures are ahead of the middle. mm, N, s.
#include <contact_normal.hpp>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <vector>

namespace cn = contact_normal;

namespace {

/// (x^2 + y^2)/diameter.
std::vector<double> ball(const cn::grid &grid, double diameter)
{
    std::vector<double> h;
    for (int iy = 0; iy < grid.my; iy++) {
        for (int ix = 0; ix < grid.mx; ix++) {
            const double x = (ix - 0.5 * (grid.mx - 1)) * grid.dx, y = (iy - 0.5 * (grid.my - 1)) * grid.dy;
            h.push_back((x * x + y * y) / diameter);
        }
    }
    return h;
}

/// Steps of 0.25 s after a jump of the load, which is then held.
void held(cn::scene &scene, cn::visco relaxing, bool by_approach)
{
    cn::solver solver(scene.visco(relaxing.time_step(0.0)));
    double first = 0.0;
    for (int k = 0; k <= 8; k++) {
        scene.visco(relaxing.time_step(k > 0 ? 0.25 : 0.0).continues(k > 0));
        const cn::result found = solver.solve(scene);
        if (!found) throw std::runtime_error(found.message);
        const double time = found.report.visco.time, force = found.report.normal.force;
        if (k == 0) first = force;
        // G(t) over that at once.
        const double modulus = 1.0 + (4.0 * std::expm1(-time / 0.3) + 3.0 * std::expm1(-time / 3.0)) / 8.0;
        std::printf("%6.2f %9.4f %9.4f", time, found.report.normal.approach, force);
        if (by_approach) std::printf(" %10.5f %10.5f\n", force / first, modulus);
        else std::printf(" %10.4f\n", found.report.normal.max_pressure);
    }
}

/// Balls of radius 50 mm that give way to half their modulus in 4 ms, pressed by 100 N, roll to the right or to the left.
void rolls(double speed)
{
    const cn::grid grid{32, 32, 0.4, 0.4};
    const cn::body rubber{8.0, 0.4};
    const std::vector<double> half{4.0}, time{0.004}, h = ball(grid, 50.0);
    const cn::visco relaxing = cn::visco().branches(1, half, time).branches(2, half, time);
    const std::vector<double> normal = cn::influence_rolling(32, 32, 0.4, 0.4, rubber, rubber, relaxing, speed);
    // One element farther, for the step.
    const std::vector<double> own = cn::influence_rolling_tangential(33, 33, 0.4, 0.4, rubber, rubber, relaxing, speed);
    const std::ptrdiff_t each = 4 * 33 * 33;
    const std::vector<double> xx(own.begin(), own.begin() + each), yy(own.begin() + each, own.begin() + 2 * each), xy(own.begin() + 2 * each, own.end());
    cn::friction friction(0.3);
    friction.motion(CONTACT_NORMAL_MOTION_STEADY_ROLLING, 0.0, speed > 0.0 ? 0.0 : std::acos(-1.0));
    friction.creepage(0, speed > 0.0 ? -0.01 : 0.01).influence(33, 33, xx, yy, xy);
    cn::scene scene(grid, rubber);
    scene.undeformed_distance(h).force(100.0).influence(32, 32, normal).friction(friction);
    const cn::result found = cn::solve(scene);
    if (!found) throw std::runtime_error(found.message);
    double moment = 0.0;
    for (std::size_t i = 0; i < found.pressure.size(); i++) moment += found.pressure[i] * (static_cast<double>(i % 32) - 15.5) * 0.4 * 0.4 * 0.4;
    std::printf("at %6.0f mm/s: %7.4f mm ahead, creep force %7.3f N\n", speed, moment / found.report.normal.force, found.report.tangential.force[0]);
}

} // namespace

int main()
{
    const cn::grid grid{64, 64, 0.1, 0.1};
    const std::vector<double> moduli{4.0, 3.0}, times{0.3, 3.0}, h = ball(grid, 20.0);
    try {
        cn::scene scene(grid, {std::numeric_limits<double>::infinity(), 0.0}, {8.0, 0.5});
        scene.undeformed_distance(h);
        const cn::visco relaxing = cn::visco().branches(2, moduli, times);
        std::printf("  time  approach     force   relative      exact\n");
        held(scene.approach(0.2), relaxing, true);
        std::printf("  time  approach     force   pressure\n");
        held(scene.force(3.0), relaxing, false);
        for (double speed : {1000.0, -1000.0, 10.0}) rolls(speed);
    } catch (const std::runtime_error &refused) {
        std::fprintf(stderr, "%s\n", refused.what());
        return 1;
    }
    return 0;
}
