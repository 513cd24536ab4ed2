/* Wear: a steel ball of radius 5 mm does not move, and is pressed by 50 N onto a steel disc that slides past it in 100 steps of 0.5 mm. After each
   step the depth of wear of the ball, K/H p |s|, is added to the undeformed distance. The contact area grows, and the pressures decrease. Units
   are m, N and Pa. */
#include "example.h"

enum { M = 64, STEPS = 100 };

int main(void)
{
    static const double slide = 5e-4, force = 50.0, wear_coefficient = 1e-4, hardness = 6e9;
    static double h[M * M], pressure[M * M], q[2][M * M], s[2][M * M], depth[M * M];
    contact_normal_scene scene;
    contact_normal_friction friction;
    contact_normal_fields fields;
    contact_normal_report report;
    contact_normal_solver *solver = NULL;
    contact_normal_wear wear;
    contact_normal_worn worn;
    double volume = 0.0, work = 0.0;
    int i, k, step;

    contact_normal_scene_init(&scene);
    contact_normal_friction_init(&friction);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    contact_normal_wear_init(&wear);
    contact_normal_worn_init(&worn);
    scene.mx = scene.my = wear.mx = wear.my = M;
    scene.dx = scene.dy = wear.dx = wear.dy = 6.25e-6;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M - 0.5 * (M - 1)) * scene.dx, y = (i / M - 0.5 * (M - 1)) * scene.dy;
        h[i] = (x * x + y * y) / 0.01;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 80e9;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.3;
    scene.force = force;
    scene.friction = &friction;
    friction.coefficient = 0.5;
    friction.creepage[0] = -slide;
    wear.pressure = fields.pressure = pressure;
    for (k = 0; k < 2; k++) {
        wear.traction[k] = fields.traction[k] = q[k];
        wear.slip[k] = fields.slip[k] = s[k];
    }
    wear.coefficient = wear_coefficient;
    wear.hardness = hardness;
    if (!solved(contact_normal_solver_new(&scene, NULL, &solver), "contact_normal_solver_new")) return EXIT_FAILURE;
    printf("  slid  elements  largest p  deepest  volume  K F L/H    work  mu F L\n");
    printf("    mm                  MPa   um/step    um^3     um^3      mJ      mJ\n");
    for (step = 1; step <= STEPS; step++) {
        friction.continues = step > 1;
        if (!solved(contact_normal_solver_solve(solver, &scene, NULL, &fields, &report), "contact_normal_solver_solve")) return EXIT_FAILURE;
        if (!solved(contact_normal_frictional_wear(&wear, NULL, depth, NULL, &worn), "contact_normal_frictional_wear")) return EXIT_FAILURE;
        for (i = 0; i < M * M; i++) h[i] += depth[i];
        volume += worn.volume;
        work += worn.work;
        if (step == 1 || step % 20 == 0)
            printf("%6.1f %9.0f %10.0f %9.4f %7.0f %8.0f %7.2f %7.2f\n", 1e3 * step * slide, (double)report.normal.contact_count,
                   1e-6 * report.normal.max_pressure, 1e6 * worn.largest_depth, 1e18 * volume,
                   1e18 * wear_coefficient * force * step * slide / hardness, 1e3 * work, 1e3 * 0.5 * force * step * slide);
    }
    contact_normal_solver_free(solver);
    return EXIT_SUCCESS;
}
