// A time loop with a handle, each step from the solution before, by contact_normal.hpp or by contact_normal.h. Usage: cxx|c steps
#include <contact_normal.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace cn = contact_normal;

int main(int argc, char **argv)
{
    if (argc != 3) return 2;
    const bool is_cxx = argv[1] == std::string("cxx");
    const int steps = std::atoi(argv[2]), m = 32;
    const double d = 1.6 / m;
    std::vector<double> h, p(m * m);
    for (int iy = 0; iy < m; iy++) {
        for (int ix = 0; ix < m; ix++) {
            const double x = (ix + 0.5 - 0.5 * m) * d, y = (iy + 0.5 - 0.5 * m) * d;
            h.push_back((x * x + y * y) / 100);
        }
    }
    cn::scene scene({m, m, d, d}, {82000.0, 0.28});
    scene.undeformed_distance(h).approach(0.01);
    cn::options how;
    how.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
    cn::solver solver(scene);
    cn::result found;
    contact_normal_scene named = scene.get();
    contact_normal_fields fields;
    contact_normal_fields_init(&fields);
    fields.pressure = p.data();
    contact_normal_report report;
    contact_normal_report_init(&report);
    double sum = 0.0;
    for (int step = 0; step < steps; step++) {
        const double approach = 0.01 * (1.0 + 1e-3 * std::sin(0.01 * step));
        contact_normal_status status;
        if (is_cxx) {
            status = solver.solve_into(scene.approach(approach), found, how);
            sum += found.report.normal.force;
        } else {
            named.approach = approach;
            status = contact_normal_solver_solve(solver.get(), &named, &how, &fields, &report);
            sum += report.normal.force;
        }
        if (status != CONTACT_NORMAL_OK) return 1;
    }
    std::printf("%g\n", sum / steps);
    return 0;
}
