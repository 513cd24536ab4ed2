/* A simulation in time: two bodies roll on each other, and each step changes the undeformed distance and the force a little. A solver handle is set
   up once. Each solve may start from the last result of the handle.

   time_steps [file]: the last solution is written to the file. */
#include <math.h>

#include "example.h"

enum { M = 64, STEPS = 100 };

struct totals {
    double cycles, work_units;
};

/* Sets the scene of a step. The point of contact moves along an ellipse, and the force oscillates by 10 %. */
static void set_step(contact_normal_scene *scene, double *h, int step)
{
    const double phase = 2.0 * 3.141592653589793 * step / STEPS;
    const double centre_x = 1.5 * cos(phase), centre_y = 0.5 * sin(phase);
    int ix, iy;

    for (iy = 0; iy < M; iy++) {
        for (ix = 0; ix < M; ix++) {
            const double x = (ix + 0.5) * scene->dx - 10.0 - centre_x, y = (iy + 0.5) * scene->dy - 6.0 - centre_y;
            h[iy * M + ix] = 0.0016681 * x * x + 0.0030671 * y * y;
        }
    }
    scene->force = 80000.0 * (1.0 + 0.1 * sin(phase));
}

/* Solves all steps. Each starts as `initial_guess` says. */
static int simulate(contact_normal_scene *scene, double *h, int32_t initial_guess, contact_normal_fields *fields,
                    contact_normal_report *report, struct totals *totals)
{
    contact_normal_solver *solver = NULL;
    contact_normal_options options;
    int step, ok;

    contact_normal_options_init(&options);
    options.initial_guess = initial_guess;
    options.tolerance = 1e-9;
    set_step(scene, h, 0);
    ok = solved(contact_normal_solver_new(scene, &options, &solver), "contact_normal_solver_new");
    for (step = 0; ok && step < STEPS; step++) {
        set_step(scene, h, step);
        ok = solved(contact_normal_solver_solve(solver, scene, &options, fields, report), "contact_normal_solver_solve");
        totals->cycles += (double)report->statistics.cycles;
        totals->work_units += report->statistics.work_units;
    }
    contact_normal_solver_free(solver);
    return ok;
}

int main(int argc, char **argv)
{
    double *h = doubles(M * M), *p = doubles(M * M), *p_cold = doubles(M * M);
    int32_t *contact = flags(M * M);
    struct totals cold_totals = {0.0, 0.0}, warm_totals = {0.0, 0.0};
    contact_normal_scene scene;
    contact_normal_fields fields;
    contact_normal_report cold, warm;
    double difference = 0.0;
    int i, ok;

    contact_normal_scene_init(&scene);
    scene.mx = scene.my = M;
    scene.dx = 20.0 / M;
    scene.dy = 12.0 / M;
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&cold);
    contact_normal_report_init(&warm);

    fields.pressure = p_cold;
    ok = simulate(&scene, h, CONTACT_NORMAL_INITIAL_GUESS_NONE, &fields, &cold, &cold_totals);
    fields.pressure = p;
    fields.contact = contact;
    ok = ok && simulate(&scene, h, CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS, &fields, &warm, &warm_totals);
    if (ok) {
        for (i = 0; i < M * M; i++) difference = fmax(difference, fabs(p[i] - p_cold[i]));
        printf("%d time steps, %d x %d elements\n", STEPS, M, M);
        printf("%-30s %12s %12s\n", "initial guess", "none", "previous");
        printf("%-30s %12.0f %12.0f\n", "cycles per step", cold_totals.cycles / STEPS, warm_totals.cycles / STEPS);
        printf("%-30s %12.0f %12.0f\n", "work units per step", cold_totals.work_units / STEPS,
               warm_totals.work_units / STEPS);
        printf("last step:\n");
        printf("%-30s %12.6f %12.6f\n", "approach [mm]", cold.normal.approach, warm.normal.approach);
        printf("%-30s %12.1f %12.1f\n", "force [N]", cold.normal.force, warm.normal.force);
        printf("%-30s %12.2f %12.2f\n", "max pressure [N/mm2]", cold.normal.max_pressure, warm.normal.max_pressure);
        printf("%-30s %12d %12d\n", "elements in contact", (int)cold.normal.contact_count, (int)warm.normal.contact_count);
        printf("pressures differ by less than 1e-6 of the maximum: %s\n", difference < 1e-6 * warm.normal.max_pressure ? "yes" : "no");
        ok = write_solution(argc > 1 ? argv[1] : NULL, &scene, warm.normal.approach, p, contact);
    }
    free(h);
    free(p);
    free(p_cold);
    free(contact);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
