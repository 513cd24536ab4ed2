/* How wrong is the answer, and what would a better one cost? The ledger of the paper's problem on m x m elements (default 256), with the estimated
   errors and the true ones, which the exact solution of Hertz shows.

   ledger [m [file]]: the solution is written to the file. */
#include <math.h>

#include "example.h"

static const double curvature_x = 0.0016681, curvature_y = 0.0030671; /* 1/mm */

int main(int argc, char **argv)
{
    const int m = argc > 1 ? atoi(argv[1]) : 256;
    const char *path = argc > 2 ? argv[2] : NULL;
    contact_normal_scene scene;
    contact_normal_fields fields;
    contact_normal_report report;
    contact_normal_ledger_row ledger[32]; /* one row per grid; each grid has half the elements of the next in a direction */
    contact_normal_hertz_solution exact;
    double *h, *p;
    int32_t *contact;
    int ix, iy, i, ok;

    if (m < 1 || m > 4096) {
        fprintf(stderr, "m must lie in 1..4096\n");
        return EXIT_FAILURE;
    }
    h = doubles(m * m);
    p = doubles(m * m);
    contact = flags(m * m);
    contact_normal_scene_init(&scene);
    scene.mx = scene.my = m;
    scene.dx = 20.0 / m;
    scene.dy = 12.0 / m;
    for (iy = 0; iy < m; iy++) {
        for (ix = 0; ix < m; ix++) {
            const double x = (ix + 0.5) * scene.dx - 10.0, y = (iy + 0.5) * scene.dy - 6.0;
            h[iy * m + ix] = curvature_x * x * x + curvature_y * y * y;
        }
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.approach = 0.1091;

    contact_normal_fields_init(&fields);
    fields.pressure = p;
    fields.contact = contact;
    contact_normal_report_init(&report);
    contact_normal_ledger_row_init(ledger); /* the first row tells the library the size of a row */
    report.ledger = ledger;
    report.ledger_capacity = sizeof ledger / sizeof *ledger;

    contact_normal_hertz_solution_init(&exact);
    ok = solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")
         && solved(contact_normal_hertz(curvature_x, curvature_y, scene.shear_modulus, scene.poisson_ratio,
                                        CONTACT_NORMAL_PRESCRIBED_APPROACH, scene.approach, &exact),
                   "contact_normal_hertz");
    if (ok) {
        printf("Hertz contact: what was known on each grid, estimated errors, true errors\n");
        printf("%9s %6s %9s %11s %8s %8s %8s %8s %8s %8s\n", "grid", "work", "residual", "force [N]", "estimate", "true",
               "p max", "estimate", "true", "area");
        for (i = 0; i < (int)report.ledger_rows; i++) {
            const contact_normal_ledger_row *row = &ledger[i];
            printf("%4d x%4d %6.2f %9.0e %11.2f %8.0e %8.0e %8.2f %8.0e %8.0e %8.3f\n", (int)row->mx, (int)row->my,
                   row->work_units, row->residual, row->force, row->error_force, fabs(row->force - exact.force),
                   row->max_pressure, row->error_max_pressure, fabs(row->max_pressure - exact.max_pressure),
                   row->corrected_area);
        }
        printf("limited by the grid: %s\n", report.accuracy.limited_by == CONTACT_NORMAL_LIMITED_BY_GRID ? "yes" : "no");
        printf("elements of half the size would bring the error of the force from %.0e to %.0e N\n", report.accuracy.error_force,
               report.accuracy.halved_error_force);
        printf("time: %.2g s so far; that would take about %.2g s\n", report.statistics.setup_seconds + report.statistics.solve_seconds,
               report.accuracy.halved_seconds);
        ok = write_solution(path, &scene, report.normal.approach, p, contact);
    }
    free(h);
    free(p);
    free(contact);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
