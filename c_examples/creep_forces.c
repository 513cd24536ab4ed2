/* A table of creep forces: an elliptic contact of steel on steel in steady rolling. The normal problem is solved once, and then the tangential
   problem for each creepage and spin, on all cores. */
#include "example.h"

enum { MX = 48, MY = 36, CREEPAGES = 7, SPINS = 2, N = CREEPAGES * SPINS };

int main(void)
{
    static const double creepages[CREEPAGES] = {-1e-4, -2e-4, -5e-4, -1e-3, -2e-3, -4e-3, -8e-3}, spins[SPINS] = {5e-5, 2e-4};
    static double h[MX * MY], entries[N][3], force[N][2], moment[N];
    static int64_t slip_count[N];
    contact_normal_scene scene;
    contact_normal_friction friction;
    contact_normal_options options;
    contact_normal_friction_results results;
    contact_normal_report report;
    int i, k;

    contact_normal_scene_init(&scene);
    contact_normal_friction_init(&friction);
    contact_normal_options_init(&options);
    contact_normal_friction_results_init(&results);
    contact_normal_report_init(&report);
    scene.mx = MX;
    scene.my = MY;
    scene.dx = scene.dy = 0.3;
    for (i = 0; i < MX * MY; i++) {
        const double x = (i % MX - 0.5 * (MX - 1)) * scene.dx, y = (i / MX - 0.5 * (MY - 1)) * scene.dy;
        h[i] = x * x / 920.0 + y * y / 600.0;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.force = 82000.0;
    scene.friction = &friction;
    friction.coefficient = 0.3;
    friction.motion = CONTACT_NORMAL_MOTION_STEADY_ROLLING;
    options.threads = 0;
    /* Entries that follow each other have similar motions, because each solve starts from the tractions of the entry before. */
    for (k = 0; k < SPINS; k++) {
        for (i = 0; i < CREEPAGES; i++) {
            entries[k * CREEPAGES + i][0] = creepages[i];
            entries[k * CREEPAGES + i][1] = 0.0;
            entries[k * CREEPAGES + i][2] = spins[k];
        }
    }
    results.force = force[0];
    results.moment = moment;
    results.slip_count = slip_count;
    if (!solved(contact_normal_solve_tangential(NULL, &scene, NULL, &options, N, entries[0], &results, &report), "contact_normal_solve_tangential"))
        return EXIT_FAILURE;
    printf("%ld elements in contact\ncreepage in 1e-3  spin in 1/m  Fx/(mu N)  Fy/(mu N)  Mz in Nm   slip\n", (long)report.normal.contact_count);
    for (i = 0; i < N; i++) {
        const double bound = 0.3 * report.normal.force;
        printf("%16.1f %12.2f %10.3f %10.3f %9.2f %6ld\n", 1e3 * entries[i][0], 1e3 * entries[i][2], force[i][0] / bound,
               force[i][1] / bound, 1e-3 * moment[i], (long)slip_count[i]);
    }
    return EXIT_SUCCESS;
}
