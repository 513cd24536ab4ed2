/* Effect `row_tables`: a steel roller is pressed into a groove by 20 kN. y runs along the section of the groove, a part of a circle, so that the
   normal rotates with y. The displacement along the normal of another row is that on a plane times the cosine of the angle between the normals. */
#include "example.h"

#include <math.h>

enum { M = 64 };

int main(void)
{
    static const double curvatures[] = {0.0, 0.05, 0.1};
    static double h[M * M], plane[2 * M][2 * M], tables[M][M][2 * M];
    contact_normal_scene scene;
    contact_normal_row_tables row_tables;
    contact_normal_fields fields;
    contact_normal_report report;
    int i, iy, jy, k;

    contact_normal_scene_init(&scene);
    contact_normal_row_tables_init(&row_tables);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    scene.mx = scene.my = M;
    scene.dx = 0.2;
    scene.dy = 0.32;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M - 0.5 * (M - 1)) * scene.dx, y = (i / M - 0.5 * (M - 1)) * scene.dy;
        h[i] = 0.002 * x * x + 0.0003 * y * y;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.force = 20000.0;
    if (!solved(contact_normal_influence_half_space(M, M, scene.dx, scene.dy, scene.shear_modulus, scene.poisson_ratio,
                                                    &plane[0][0]),
                "contact_normal_influence_half_space"))
        return EXIT_FAILURE;
    row_tables.cx = row_tables.rows = M;
    row_tables.coefficients = &tables[0][0][0];
    scene.row_tables = &row_tables;
    printf("curvature  approach  max pressure  contact area\n");
    for (i = 0; i < 3; i++) {
        for (jy = 0; jy < M; jy++)
            for (iy = 0; iy < M; iy++)
                for (k = 0; k < 2 * M; k++)
                    tables[jy][iy][k] = cos((iy - jy) * scene.dy * curvatures[i]) * plane[iy - jy + M][k];
        if (!solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")) return EXIT_FAILURE;
        printf("%9.2f %9.6f %13.1f %13.2f\n", curvatures[i], report.normal.approach, report.normal.max_pressure, report.normal.contact_area);
    }
    return EXIT_SUCCESS;
}
