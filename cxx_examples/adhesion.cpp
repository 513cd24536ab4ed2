// A sphere that sticks to a plane: the force at some approaches, and the pull-off. Units: R = 1, w = 1/pi, E* = 3/4, in which forces are in
// pi w R, and JKR pulls off at -1.5.
#include <contact_normal.hpp>

#include <cstdio>
#include <limits>
#include <vector>

namespace cn = contact_normal;

int main()
{
    const double half_width = 3.0, d = 2.0 * half_width / 64;
    const cn::grid grid{64, 64, d, d};
    std::vector<double> h;
    for (int iy = 0; iy < grid.my; iy++) {
        for (int ix = 0; ix < grid.mx; ix++) {
            const double x = (ix + 0.5) * d - half_width, y = (iy + 0.5) * d - half_width;
            h.push_back(0.5 * (x * x + y * y));
        }
    }
    try {
        // 1/E* = (1 - nu)/(2 G) of the first body; the other one is rigid.
        cn::scene scene(grid, {0.375, 0.0}, {std::numeric_limits<double>::infinity(), 0.0});
        scene.undeformed_distance(h).adhesion(cn::adhesion(0.3183098861837907).range(0.5647539));
        std::printf("approach    force  contact attraction\n");
        for (int k = 2; k >= -1; k--) {
            const cn::result found = cn::solve(scene.approach(0.5 * k));
            if (!found) return 1;
            std::printf("%8.2f %8.3f %8.3f %10.3f\n", found.report.normal.approach, found.report.normal.force,
                        found.report.adhesion.repulsive_force, found.report.adhesion.adhesive_force);
        }
        std::printf("pull-off: force %.2f\n", cn::pull_off(scene.force(0.0)).report.normal.force);
    } catch (const cn::error &refused) {
        std::fprintf(stderr, "%s\n", refused.what());
        return 1;
    }
    return 0;
}
