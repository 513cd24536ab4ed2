/* A table of contacts for several approaches, as vehicle simulations compute it in advance: many problems on one grid are solved by one call on all
   cores.

   batch [file]: the last solution goes to the file. */
#include "example.h"

enum { M = 64, COUNT = 200 };

int main(int argc, char **argv)
{
    const double curvature_x = 0.0016681, curvature_y = 0.0030671; /* 1/mm */
    double *h = doubles(M * M), *p = doubles(COUNT * M * M);
    int32_t *contact = flags(M * M);
    /* The arrays are static because they are too large for some stacks. */
    static contact_normal_scene scenes[COUNT];
    static contact_normal_fields fields[COUNT];
    static contact_normal_report reports[COUNT];
    static contact_normal_status statuses[COUNT];
    contact_normal_options options;
    contact_normal_solver *solver = NULL;
    int i, ok;

    contact_normal_options_init(&options);
    options.tolerance = 1e-9;
    options.threads = 0; /* all cores; results have the same bits for any number of threads */

    for (i = 0; i < COUNT; i++) {
        contact_normal_scene_init(&scenes[i]);
        scenes[i].mx = M;
        scenes[i].my = M;
        scenes[i].dx = 20.0 / M;
        scenes[i].dy = 12.0 / M;
        scenes[i].undeformed_distance = h; /* it is only read, so all problems can share it */
        scenes[i].shear_modulus[0] = scenes[i].shear_modulus[1] = 82000.0;
        scenes[i].poisson_ratio[0] = scenes[i].poisson_ratio[1] = 0.28;
        scenes[i].approach = 0.1 * (i + 1) / COUNT;
        contact_normal_fields_init(&fields[i]);
        fields[i].pressure = p + i * M * M; /* it is written, so each problem has its own */
        contact_normal_report_init(&reports[i]);
    }
    fields[COUNT - 1].contact = contact;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M + 0.5) * scenes[0].dx - 10.0, y = (i / M + 0.5) * scenes[0].dy - 6.0;
        h[i] = curvature_x * x * x + curvature_y * y * y;
    }

    ok = solved(contact_normal_solver_new(&scenes[0], &options, &solver), "contact_normal_solver_new")
         && solved(contact_normal_solver_solve_batch(solver, COUNT, scenes, &options, fields, reports, statuses),
                   "contact_normal_solver_solve_batch");
    if (ok) {
        printf("%d problems of %d x %d elements\n", COUNT, M, M);
        printf("%14s %14s %14s %22s\n", "approach [mm]", "force [N]", "exact [N]", "max pressure [N/mm2]");
        for (i = COUNT / 5 - 1; ok && i < COUNT; i += COUNT / 5) {
            contact_normal_hertz_solution exact;
            contact_normal_hertz_solution_init(&exact);
            ok = statuses[i] == CONTACT_NORMAL_OK
                 && solved(contact_normal_hertz(curvature_x, curvature_y, scenes[i].shear_modulus, scenes[i].poisson_ratio,
                                                CONTACT_NORMAL_PRESCRIBED_APPROACH, scenes[i].approach, &exact),
                           "contact_normal_hertz");
            printf("%14.3f %14.1f %14.1f %22.2f\n", scenes[i].approach, reports[i].normal.force, exact.force,
                   reports[i].normal.max_pressure);
        }
        i = COUNT - 1;
        ok = ok && write_solution(argc > 1 ? argv[1] : NULL, &scenes[i], reports[i].normal.approach, p + i * M * M, contact);
    }
    contact_normal_solver_free(solver);
    free(h);
    free(p);
    free(contact);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
