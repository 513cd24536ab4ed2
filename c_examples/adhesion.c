/* Effect `adhesion`: a sphere that adheres to a plane comes closer and goes back. Its forces are compared with those of Johnson, Kendall and
   Roberts (JKR), and its pull-off force is found. Then a periodic rough surface is solved with weak to strong adhesion. With R = 1, w = 1/pi and
   E* = 3/4 of the sphere forces are in pi w R, and the pull-off force of JKR is -1.5. */
#include <math.h>

#include "example.h"

enum { M = 48, N = 32, STEPS = 12, WAVES = 6 };

/* The force of JKR at a given approach. With the contact radius a the approach is a^2 - 2/3 sqrt(6 a), and the force a^3 - sqrt(6 a^3). a is
   found by bisection, from the radius of least approach on. */
static double jkr(double approach)
{
    double low = pow(6.0, -1.0 / 3.0), high = 3.0;
    while (high - low > 1e-12) {
        const double a = 0.5 * (low + high);
        if (a * a - 2.0 / 3.0 * sqrt(6.0 * a) < approach) low = a;
        else high = a;
    }
    return low * low * low - sqrt(6.0 * low * low * low);
}

/* Moves the sphere closer in steps of 0.2, and back again. Each solve of the handle starts from the state of the step before. */
static int loop(contact_normal_scene *scene)
{
    contact_normal_solver *solver = NULL;
    contact_normal_options options;
    contact_normal_report report;
    double closer[STEPS];
    int k;

    contact_normal_options_init(&options);
    contact_normal_report_init(&report);
    if (!solved(contact_normal_solver_new(scene, &options, &solver), "contact_normal_solver_new")) return 0;
    scene->load = CONTACT_NORMAL_PRESCRIBED_APPROACH;
    printf("approach   closer     back      JKR\n");
    for (k = 0; k < 2 * STEPS - 1; k++) {
        const int at = k < STEPS ? k : 2 * STEPS - 2 - k;
        scene->approach = 0.2 * (at - 6);
        options.initial_guess = k ? CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS : CONTACT_NORMAL_INITIAL_GUESS_NONE;
        if (!solved(contact_normal_solver_solve(solver, scene, &options, NULL, &report), "contact_normal_solver_solve")) break;
        if (k < STEPS) closer[k] = report.normal.force;
        if (k < STEPS - 1) continue;
        printf("%8.2f %8.3f %8.3f", scene->approach, closer[at], report.normal.force);
        if (at > 1) printf(" %8.3f", jkr(scene->approach));
        printf("\n");
    }
    contact_normal_solver_free(solver);
    return k == 2 * STEPS - 1;
}

/* Prints the part of the area that is in contact, for several mean pressures, and for works of adhesion from none to strong. E* = 1, and the grid
   is one period. */
static int weak_to_sticky(void)
{
    static const int waves[WAVES][2] = {{2, 1}, {1, -2}, {3, 2}, {-2, 4}, {5, 1}, {4, -5}};
    static const double works[3] = {0.0, 1e-5, 1e-4};
    const double pi = acos(-1.0);
    static double h[N * N];
    contact_normal_scene scene;
    contact_normal_period period;
    contact_normal_adhesion adhesion;
    contact_normal_report report;
    int i, k;

    for (i = 0; i < N * N; i++) {
        const double x = (i % N + 0.5) / N, y = (i / N + 0.5) / N;
        h[i] = 0.1;
        for (k = 0; k < WAVES; k++)
            h[i] += 0.01 / (k + 1) * cos(2.0 * pi * (waves[k][0] * x + waves[k][1] * y) + k * k);
    }
    contact_normal_scene_init(&scene);
    scene.mx = scene.my = N;
    scene.dx = scene.dy = 1.0 / N;
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = 0.5;
    scene.shear_modulus[1] = (double)INFINITY;
    contact_normal_period_init(&period);
    period.x = period.y = 1;
    scene.period = &period;
    contact_normal_adhesion_init(&adhesion);
    scene.adhesion = &adhesion;
    scene.load = CONTACT_NORMAL_PRESCRIBED_FORCE;
    contact_normal_report_init(&report);
    printf("mean pressure   area without, weak and sticky\n");
    for (i = 0; i < 3; i++) {
        scene.force = 0.005 * (1 << i);
        printf("%13.3f ", scene.force);
        for (k = 0; k < 3; k++) {
            adhesion.work_of_adhesion = works[k];
            if (!solved(contact_normal_solve(&scene, NULL, NULL, &report), "contact_normal_solve")) return 0;
            printf(" %8.3f", report.normal.contact_area);
        }
        printf("\n");
    }
    return 1;
}

int main(void)
{
    const double half_width = 2.2, d = 2.0 * half_width / M, modulus = 0.75;
    static double h[M * M];
    contact_normal_adhesion adhesion;
    contact_normal_scene scene;
    contact_normal_report report;
    int i;

    for (i = 0; i < M * M; i++) {
        const double x = (i % M + 0.5) * d - half_width, y = (i / M + 0.5) * d - half_width;
        h[i] = 0.5 * (x * x + y * y);
    }
    contact_normal_adhesion_init(&adhesion);
    adhesion.work_of_adhesion = 0.3183098861837907;
    adhesion.range = 0.3; /* Tabor's parameter is 1.9 */
    adhesion.start = CONTACT_NORMAL_START_FROM_APART;
    contact_normal_scene_init(&scene);
    scene.mx = scene.my = M;
    scene.dx = scene.dy = d;
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = 0.5 * modulus; /* 1/E* is (1 - nu)/(2 G) of this body, because the other one is rigid */
    scene.shear_modulus[1] = (double)INFINITY;
    scene.adhesion = &adhesion;
    contact_normal_report_init(&report);
    if (!loop(&scene)) return EXIT_FAILURE;
    scene.load = CONTACT_NORMAL_PRESCRIBED_FORCE;
    scene.force = 0.0;
    if (!solved(contact_normal_pull_off(&scene, NULL, NULL, &report), "contact_normal_pull_off")) return EXIT_FAILURE;
    printf("pull-off: force %.2f, contact %.2f, attraction %.2f\n", report.normal.force, report.adhesion.repulsive_force,
           report.adhesion.adhesive_force);
    return weak_to_sticky() ? EXIT_SUCCESS : EXIT_FAILURE;
}
