/* The test problem of the paper: two steel bodies with h = A x^2 + B y^2 are pressed together by a given approach. The result is compared with the
   exact solution of Hertz.

   hertz [m [file]]: m x m elements (default 128); the solution is written to the file. */
#include "example.h"

static const double curvature_x = 0.0016681, curvature_y = 0.0030671; /* 1/mm */

static void print_row(const char *name, double found, double exact)
{
    printf("%-22s %12.6g %12.6g %9.3f %%\n", name, found, exact, 100.0 * (found - exact) / exact);
}

int main(int argc, char **argv)
{
    const int m = argc > 1 ? atoi(argv[1]) : 128;
    const char *path = argc > 2 ? argv[2] : NULL;
    contact_normal_scene scene;
    contact_normal_fields fields;
    contact_normal_options options;
    contact_normal_report report;
    contact_normal_hertz_solution exact;
    double *h, *p;
    int32_t *contact;
    int ix, iy, ok;

    if (m < 1 || m > 4096) {
        fprintf(stderr, "m must lie in 1..4096\n");
        return EXIT_FAILURE;
    }
    h = doubles(m * m);
    p = doubles(m * m);
    contact = flags(m * m);

    /* The scene. Units are mm and N here; any consistent units can be used. */
    contact_normal_scene_init(&scene);
    scene.mx = m;
    scene.my = m;
    scene.dx = 20.0 / m;
    scene.dy = 12.0 / m;
    for (iy = 0; iy < m; iy++) {
        for (ix = 0; ix < m; ix++) {
            /* The coordinates of the centre of the element. */
            const double x = (ix + 0.5) * scene.dx - 10.0, y = (iy + 0.5) * scene.dy - 6.0;
            h[iy * m + ix] = curvature_x * x * x + curvature_y * y * y;
        }
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.approach = 0.1091;

    /* The options. The defaults suit most problems; the digits that are printed here need a smaller tolerance. */
    contact_normal_options_init(&options);
    options.tolerance = 1e-9;

    /* The arrays of the result that are wanted. */
    contact_normal_fields_init(&fields);
    fields.pressure = p;
    fields.contact = contact;
    contact_normal_report_init(&report);
    contact_normal_hertz_solution_init(&exact);

    ok = solved(contact_normal_solve(&scene, &options, &fields, &report), "contact_normal_solve")
         && solved(contact_normal_hertz(curvature_x, curvature_y, scene.shear_modulus, scene.poisson_ratio,
                                        CONTACT_NORMAL_PRESCRIBED_APPROACH, scene.approach, &exact),
                   "contact_normal_hertz");
    if (ok) {
        printf("Hertz contact, %d x %d elements\n", m, m);
        printf("%-22s %12s %12s %11s\n", "", "found", "exact", "difference");
        print_row("approach [mm]", report.normal.approach, exact.approach);
        print_row("force [N]", report.normal.force, exact.force);
        print_row("max pressure [N/mm2]", report.normal.max_pressure, exact.max_pressure);
        print_row("contact area [mm2]", report.normal.contact_area, exact.area);
        ok = write_solution(path, &scene, report.normal.approach, p, contact);
    }
    free(h);
    free(p);
    free(contact);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
