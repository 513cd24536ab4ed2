// Friction that falls with the slip velocity, over a third body that yields: the creep curve of a steel wheel on a rail at 10 m/s. With a law the
// force has a maximum; with one coefficient it has none. mm, N, s.
#include <contact_normal.hpp>

#include <cstdio>
#include <vector>

namespace cn = contact_normal;

int main()
{
    const cn::grid grid{48, 44, 0.289, 0.6304};
    std::vector<double> h;
    for (int iy = 0; iy < grid.my; iy++) {
        for (int ix = 0; ix < grid.mx; ix++) {
            const double x = (ix - 0.5 * (grid.mx - 1)) * grid.dx, y = (iy - 0.5 * (grid.my - 1)) * grid.dy;
            h.push_back(8e-4 * x * x + 2.8142e-4 * y * y);
        }
    }
    try {
        cn::scene scene(grid, {82000.0, 0.28});
        scene.undeformed_distance(h).force(106700.0);
        std::printf("creepage   force/(.33 N)    sticks, as one coefficient, as a law, and with a layer that yields at 100 N/mm2\n");
        for (double creepage : {0.001, 0.004, 0.008, 0.016, 0.03, 0.1}) {
            // At rest; a third body of 1.25 mm between.
            cn::friction friction(0.33);
            friction.motion(CONTACT_NORMAL_MOTION_STEADY_ROLLING).creepage(0, -creepage).compliance(1.25 / 8200.0);
            std::printf("%8.3f", creepage);
            for (int with = 0; with < 3; with++) {
                if (with == 1) friction.law(CONTACT_NORMAL_FRICTION_LAW_EXPONENTIAL, 0.14, 0.19, 1250.0, 10000.0).memory(0.003, 1.0);
                if (with == 2) friction.layer(100.0);
                const cn::result found = cn::solve(scene.friction(friction));
                if (!found) return 1;
                const contact_normal_report &report = found.report;
                std::printf("  %7.4f %4ld", report.tangential.force[0] / (0.33 * report.normal.force), static_cast<long>(report.tangential.stick_count));
            }
            std::printf("\n");
        }
    } catch (const cn::error &refused) {
        std::fprintf(stderr, "%s\n", refused.what());
        return 1;
    }
    return 0;
}
