// The paper's problem through contact_normal.hpp: an ellipse of 12 x 8 mm, once by the approach, then by the force with a handle.
#include <contact_normal.hpp>

#include <cstdio>
#include <vector>

namespace cn = contact_normal;

int main()
{
    const cn::grid grid{128, 128, 20.0 / 128, 12.0 / 128};
    const cn::body steel{82000.0, 0.28}; // N/mm2
    const double curvature_x = 0.0016681, curvature_y = 0.0030671, approach = 0.1091;
    std::vector<double> h;
    for (int iy = 0; iy < grid.my; iy++) {
        for (int ix = 0; ix < grid.mx; ix++) {
            const double x = (ix + 0.5) * grid.dx - 10.0, y = (iy + 0.5) * grid.dy - 6.0;
            h.push_back(curvature_x * x * x + curvature_y * y * y);
        }
    }
    try {
        const auto exact = cn::hertz(curvature_x, curvature_y, steel, steel, CONTACT_NORMAL_PRESCRIBED_APPROACH, approach);
        cn::scene scene(grid, steel);
        const cn::result found = cn::solve(scene.undeformed_distance(h).approach(approach));
        if (!found) {
            std::fprintf(stderr, "stopped early: %s\n", found.message.c_str());
            return 1;
        }
        std::printf("force          %8.0f N, exact %.0f\n", found.report.normal.force, exact.force);
        std::printf("largest p      %8.1f N/mm2, exact %.1f\n", found.report.normal.max_pressure, exact.max_pressure);

        cn::solver solver(scene);
        for (double force : {40000.0, 80000.0}) {
            const cn::result step = solver.solve(scene.force(force));
            if (!step) return 1;
            std::printf("force %8.0f N: approach %.4f mm, %lld elements in contact\n", force, step.report.normal.approach,
                        static_cast<long long>(step.report.normal.contact_count));
        }
    } catch (const cn::error &refused) {
        std::fprintf(stderr, "%s\n", refused.what());
        return 1;
    }
    return 0;
}
