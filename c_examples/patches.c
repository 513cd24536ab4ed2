/* Effect `patches`: two steel balls are pressed side by side onto a plate by 1000 N in total. With the factor 0 each ball has a plate of its own.
   With the factor 1 both are on one half-space, where each ball also displaces the surface below the other one. */
#include "example.h"

enum { M = 64 };

int main(void)
{
    static const double factors[] = {0.0, 0.5, 1.0};
    static double h[M * M];
    static int32_t patch[M * M];
    double matrix[4] = {1.0, 0.0, 0.0, 1.0};
    contact_normal_scene scene;
    contact_normal_patches patches;
    contact_normal_fields fields;
    contact_normal_report report;
    int i;

    contact_normal_scene_init(&scene);
    contact_normal_patches_init(&patches);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    scene.mx = scene.my = M;
    scene.dx = scene.dy = 0.1;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M - 0.5 * (M - 1)) * scene.dx, y = (i / M - 0.5 * (M - 1)) * scene.dy;
        const double from_axis = x < 0.0 ? x + 1.2 : x - 1.2;
        h[i] = (from_axis * from_axis + y * y) / 1000.0;
        patch[i] = x < 0.0 ? 0 : 1;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.force = 1000.0;
    patches.count = 2;
    patches.patch = patch;
    patches.factors = matrix;
    scene.patches = &patches;
    printf("factor  approach  max pressure  contact area\n");
    for (i = 0; i < 3; i++) {
        matrix[1] = matrix[2] = factors[i];
        if (!solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")) return EXIT_FAILURE;
        printf("%6.1f %9.6f %13.2f %13.2f\n", factors[i], report.normal.approach, report.normal.max_pressure, report.normal.contact_area);
    }
    return EXIT_SUCCESS;
}
