// A sphere that sticks to a plane: its force on the way closer and back beside that of Johnson, Kendall and Roberts, and the pull-off; then a
// rough surface that repeats itself, from weak to sticky. Units of the sphere: R = 1, w = 1/pi, E* = 3/4, in which forces are in pi w R, and JKR
// pulls off at -1.5.
#include <contact_normal.hpp>

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace cn = contact_normal;

static const double infinite = std::numeric_limits<double>::infinity();

// The force of JKR at an approach a^2 - 2/3 sqrt(6 a): a^3 - sqrt(6 a^3), by halving the radius of contact a from its least on.
static double jkr(double approach)
{
    double low = std::cbrt(1.0 / 6.0), high = 3.0;
    while (high - low > 1e-12) {
        const double a = 0.5 * (low + high);
        (a * a - 2.0 / 3.0 * std::sqrt(6.0 * a) < approach ? low : high) = a;
    }
    return low * low * low - std::sqrt(6.0 * low * low * low);
}

// Closer in steps of 0.2 and back again: a handle follows the state before.
static void loop(cn::scene &scene)
{
    const int steps = 12;
    std::vector<double> closer, back(steps);
    cn::solver solver(scene.approach(0.0));
    cn::options options;
    for (int k = 0; k < 2 * steps - 1; k++) {
        const int at = k < steps ? k : 2 * steps - 2 - k;
        const cn::result found = solver.solve(scene.approach(0.2 * (at - 6)), options);
        if (k < steps) closer.push_back(found.report.normal.force);
        back[at] = found.report.normal.force;
        options.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
    }
    std::printf("approach   closer     back      JKR\n");
    for (int at = steps - 1; at >= 0; at--) {
        std::printf("%8.2f %8.3f %8.3f", 0.2 * (at - 6), closer[at], back[at]);
        if (at > 1) std::printf(" %8.3f", jkr(0.2 * (at - 6)));
        std::printf("\n");
    }
}

// The contact area, a part of the whole, by the mean pressure, for works of adhesion from none to sticky. E* = 1, the grid is one period.
static void weak_to_sticky()
{
    const int n = 32, waves[6][2] = {{2, 1}, {1, -2}, {3, 2}, {-2, 4}, {5, 1}, {4, -5}};
    const double pi = std::acos(-1.0);
    std::vector<double> h;
    for (int i = 0; i < n * n; i++) {
        const double x = (i % n + 0.5) / n, y = (i / n + 0.5) / n;
        double distance = 0.1;
        for (int k = 0; k < 6; k++)
            distance += 0.01 / (k + 1) * std::cos(2.0 * pi * (waves[k][0] * x + waves[k][1] * y) + k * k);
        h.push_back(distance);
    }
    cn::scene scene({n, n, 1.0 / n, 1.0 / n}, {0.5, 0.0}, {infinite, 0.0});
    scene.undeformed_distance(h).period(true, true);
    std::printf("mean pressure   area without, weak and sticky\n");
    for (const double mean : {0.005, 0.01, 0.02}) {
        std::printf("%13.3f ", mean);
        for (const double work : {0.0, 1e-5, 1e-4})
            std::printf(" %8.3f", cn::solve(scene.force(mean).adhesion(cn::adhesion(work))).report.normal.contact_area);
        std::printf("\n");
    }
}

int main()
{
    const int m = 48;
    const double half_width = 2.2, d = 2.0 * half_width / m;
    std::vector<double> h;
    for (int i = 0; i < m * m; i++) {
        const double x = (i % m + 0.5) * d - half_width, y = (i / m + 0.5) * d - half_width;
        h.push_back(0.5 * (x * x + y * y));
    }
    try {
        // 1/E* = (1 - nu)/(2 G) of the first body; the other one is rigid. Tabor's parameter is 1.9.
        cn::scene scene({m, m, d, d}, {0.375, 0.0}, {infinite, 0.0});
        scene.undeformed_distance(h).adhesion(cn::adhesion(0.3183098861837907).range(0.3).start(CONTACT_NORMAL_START_FROM_APART));
        loop(scene);
        const contact_normal_report report = cn::pull_off(scene.force(0.0)).report;
        std::printf("pull-off: force %.2f, contact %.2f, attraction %.2f\n", report.normal.force, report.adhesion.repulsive_force,
                    report.adhesion.adhesive_force);
        weak_to_sticky();
    } catch (const cn::error &refused) {
        std::fprintf(stderr, "%s\n", refused.what());
        return 1;
    }
    return 0;
}
