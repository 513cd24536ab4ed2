// The paper's problem: an ellipse of steel on steel, pressed by 0.1091 mm. Prints the force.
#include <contact_normal.hpp>
#include <cstdio>
#include <vector>

int main()
{
    const contact_normal::grid grid{128, 128, 20.0 / 128, 12.0 / 128};
    std::vector<double> h;
    for (int iy = 0; iy < grid.my; iy++) {
        for (int ix = 0; ix < grid.mx; ix++) {
            const double x = (ix + 0.5) * grid.dx - 10.0, y = (iy + 0.5) * grid.dy - 6.0;
            h.push_back(0.0016681 * x * x + 0.0030671 * y * y);
        }
    }
    contact_normal::scene scene(grid, {82000.0, 0.28});
    const contact_normal::result found = contact_normal::solve(scene.undeformed_distance(h).approach(0.1091));
    if (!found) return 1;
    std::printf("force %.0f N\n", found.report.normal.force);
}
