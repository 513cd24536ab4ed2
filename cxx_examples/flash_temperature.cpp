// Flash temperature: a steel ball of radius 5 mm, held still, on a steel disc that slides past it at 2 and 20 m/s; 50 N, a friction coefficient of
// 0.1. The heat of each element is mu p v. In m, N, s, W and K.
#include <contact_normal.hpp>

#include <cstddef>
#include <cstdio>
#include <vector>

namespace cn = contact_normal;

int main()
{
    const double mu = 0.1;
    const cn::grid grid{80, 80, 5e-6, 5e-6};
    std::vector<double> h;
    for (int iy = 0; iy < grid.my; iy++) {
        for (int ix = 0; ix < grid.mx; ix++) {
            const double x = (ix - 0.5 * (grid.mx - 1)) * grid.dx, y = (iy - 0.5 * (grid.my - 1)) * grid.dy;
            h.push_back((x * x + y * y) / 0.01);
        }
    }
    try {
        cn::scene scene(grid, {80e9, 0.3});
        scene.undeformed_distance(h).force(50.0);
        const cn::result found = cn::solve(scene);
        if (!found) return 1;
        std::vector<double> flux(h.size());
        std::printf("speed  heat into the ball  flash temperature  where\n");
        for (const double speed : {2.0, 20.0}) {
            for (std::size_t i = 0; i < h.size(); i++) flux[i] = mu * found.pressure[i] * speed;
            const cn::flash_temperatures rise =
                cn::flash_temperature(grid.mx, grid.my, grid.dx, grid.dy, flux, {46.0, 46.0}, {1.2e-5, 1.2e-5}, {0.0, speed});
            const contact_normal_flash &flash = rise.largest;
            std::printf("%5.0f %19.3f %18.1f  x = %.1f um on the disc\n", speed, flash.share, flash.largest[0], 1e6 * flash.x[1]);
        }
    } catch (const cn::error &refused) {
        std::fprintf(stderr, "%s\n", refused.what());
        return 1;
    }
    return 0;
}
