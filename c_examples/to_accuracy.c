/* An accuracy instead of a grid: the paper's ellipse is pressed by a given force, and refined from 16 x 16 elements until the estimated error of the
   approach is 0.1 %. The exact solution of Hertz shows the true error. Then the same is solved from 16 x 16 values of the undeformed distance
   alone, without the callback.

   to_accuracy [file]: the solution is written to the file. */
#include <math.h>

#include "example.h"

static const double curvature_x = 0.0016681, curvature_y = 0.0030671; /* 1/mm */

/* The callback of the library: writes the undeformed distance of any grid over [-10, 10] x [-6, 6] mm. */
static int32_t surface(int32_t mx, int32_t my, double dx, double dy, double *h, void *user)
{
    int32_t ix, iy;

    (void)user;
    for (iy = 0; iy < my; iy++) {
        for (ix = 0; ix < mx; ix++) {
            const double x = (ix + 0.5) * dx - 10.0, y = (iy + 0.5) * dy - 6.0;
            h[(size_t)iy * (size_t)mx + (size_t)ix] = curvature_x * x * x + curvature_y * y * y;
        }
    }
    return 0;
}

/* Prints the elements, the results and the estimated error, none of which depends on the machine. */
static void print_result(const char *from, const contact_normal_accuracy *accuracy, double approach, double exact)
{
    const double error = fabs(approach / exact - 1.0);

    printf("%-22s %4d x %-4d %11.6f %16s %12s\n", from, (int)accuracy->mx, (int)accuracy->my, approach,
           accuracy->reached <= accuracy->target ? "yes" : "no", error <= accuracy->target ? "yes" : "no");
}

int main(int argc, char **argv)
{
    const char *path = argc > 1 ? argv[1] : NULL;
    contact_normal_scene scene;
    contact_normal_options options;
    contact_normal_accuracy accuracy;
    contact_normal_report report;
    contact_normal_ledger_row rows[16];
    contact_normal_fields fields;
    contact_normal_hertz_solution exact;
    contact_normal_solver *solver = NULL;
    double h[16 * 16], *fine, *p;
    int32_t *contact;
    int i, n, ok;

    /* The grid of the scene is the first one. Its undeformed distance comes from the callback. */
    contact_normal_scene_init(&scene);
    scene.mx = scene.my = 16;
    scene.dx = 20.0 / 16;
    scene.dy = 12.0 / 16;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.force = 82000.0;

    contact_normal_options_init(&options);
    options.tolerance = 1e-9;
    contact_normal_accuracy_init(&accuracy);
    accuracy.target = 1e-3;
    accuracy.max_elements = 1024 * 1024;
    accuracy.surface = surface;
    contact_normal_report_init(&report);
    contact_normal_ledger_row_init(rows); /* the first row tells the library the size of a row */
    report.ledger = rows;
    report.ledger_capacity = 16;
    contact_normal_hertz_solution_init(&exact);
    if (!solved(contact_normal_hertz(curvature_x, curvature_y, scene.shear_modulus, scene.poisson_ratio,
                                     CONTACT_NORMAL_PRESCRIBED_FORCE, scene.force, &exact),
                "contact_normal_hertz")
        || !solved(contact_normal_solve_to_accuracy(&scene, &options, &accuracy, &solver, &report),
                   "contact_normal_solve_to_accuracy"))
        return EXIT_FAILURE;

    printf("Hertz contact, the approach to be good to %g\n", accuracy.target);
    printf("%-22s %11s %11s %16s %12s\n", "undeformed distance", "elements", "approach", "met by estimate", "met in fact");
    print_result("from a callback", &accuracy, report.normal.approach, exact.approach);

    /* The arrays of the last grid, whose size is known only now. */
    n = accuracy.mx * accuracy.my;
    fine = doubles(n);
    p = doubles(n);
    contact = flags(n);
    surface(accuracy.mx, accuracy.my, accuracy.dx, accuracy.dy, fine, NULL);
    contact_normal_fields_init(&fields);
    fields.pressure = p;
    fields.contact = contact;
    ok = solved(contact_normal_solver_fields(solver, &fields), "contact_normal_solver_fields");
    contact_normal_solver_free(solver);
    if (ok) {
        contact_normal_scene last = scene;
        last.mx = accuracy.mx;
        last.my = accuracy.my;
        last.dx = accuracy.dx;
        last.dy = accuracy.dy;
        last.undeformed_distance = fine;
        ok = write_solution(path, &last, report.normal.approach, p, contact);
    }
    free(fine);
    free(p);
    free(contact);
    if (!ok) return EXIT_FAILURE;

    /* The same search from an array, from which the library interpolates finer grids by cubics. Here no handle is wanted. */
    surface(scene.mx, scene.my, scene.dx, scene.dy, h, NULL);
    scene.undeformed_distance = h;
    accuracy.surface = NULL;
    if (!solved(contact_normal_solve_to_accuracy(&scene, &options, &accuracy, NULL, &report),
                "contact_normal_solve_to_accuracy"))
        return EXIT_FAILURE;
    print_result("from 16 x 16 values", &accuracy, report.normal.approach, exact.approach);

    /* The results of the last solve on each grid, one row per grid, the coarsest first. */
    printf("\n%-11s %11s %17s\n", "grid", "approach", "estimated error");
    for (i = 0; i < (int)report.ledger_rows && i < 16; i++) {
        printf("%4d x %-4d %11.6f", (int)rows[i].mx, (int)rows[i].my, rows[i].approach);
        if (rows[i].error_force >= 0.0)
            printf(" %17.1e\n", rows[i].error_force);
        else
            printf(" %17s\n", "not known");
    }
    return EXIT_SUCCESS;
}
