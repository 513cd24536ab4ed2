// Wear: a steel ball of radius 5 mm, held still on a steel disc that slides past it, 50 N, in 100 steps of 0.5 mm. After each step the depth of wear,
// K/H p |s|, comes off the ball: it is added to the undeformed distance. m, N, Pa.
#include <contact_normal.hpp>

#include <cstddef>
#include <cstdio>
#include <vector>

namespace cn = contact_normal;

int main()
{
    const double slide = 5e-4, force = 50.0, coefficient = 1e-4, hardness = 6e9;
    const cn::grid grid{64, 64, 6.25e-6, 6.25e-6};
    std::vector<double> h;
    for (int iy = 0; iy < grid.my; iy++) {
        for (int ix = 0; ix < grid.mx; ix++) {
            const double x = (ix - 0.5 * (grid.mx - 1)) * grid.dx, y = (iy - 0.5 * (grid.my - 1)) * grid.dy;
            h.push_back((x * x + y * y) / 0.01);
        }
    }
    try {
        // The scene borrows the distances: what is worn off them is seen by the next step.
        cn::scene scene(grid, {80e9, 0.3});
        cn::friction friction(0.5);
        scene.undeformed_distance(h).force(force).friction(friction.creepage(0, -slide));
        cn::solver solver(scene);
        double volume = 0.0, work = 0.0;
        std::printf("  slid  elements  largest p  deepest  volume  K F L/H    work  mu F L\n");
        std::printf("    mm                  MPa   um/step    um^3     um^3      mJ      mJ\n");
        for (int step = 1; step <= 100; step++) {
            if (step == 2) scene.friction(friction.continues());
            const cn::result found = solver.solve(scene);
            if (!found) return 1;
            const cn::frictional_work worn =
                cn::frictional_wear(grid.mx, grid.my, grid.dx, grid.dy, found.traction, found.slip, coefficient, hardness, 1.0, 0.0, found.pressure);
            for (std::size_t i = 0; i < h.size(); i++) h[i] += worn.depth[i];
            volume += worn.total.volume, work += worn.total.work;
            if (step != 1 && step % 20 != 0) continue;
            std::printf("%6.1f %9.0f %10.0f %9.4f %7.0f %8.0f %7.2f %7.2f\n", 1e3 * step * slide, static_cast<double>(found.report.normal.contact_count),
                        1e-6 * found.report.normal.max_pressure, 1e6 * worn.total.largest_depth, 1e18 * volume,
                        1e18 * coefficient * force * step * slide / hardness, 1e3 * work, 1e3 * 0.5 * force * step * slide);
        }
    } catch (const cn::error &refused) {
        std::fprintf(stderr, "%s\n", refused.what());
        return 1;
    }
    return 0;
}
