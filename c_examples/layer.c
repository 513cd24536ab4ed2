/* Effect `layer`: a steel ball of radius 500 mm is pressed by 1000 N onto a steel plate with a thin layer. The more compliant the layer is, the
   larger is the contact area. */
#include "example.h"

enum { M = 64 };

int main(void)
{
    static const double compliances[] = {0.0, 1e-6, 1e-5, 1e-4}; /* in mm per N/mm2: the thickness over the modulus of the layer */
    static double h[M * M];
    contact_normal_scene scene;
    contact_normal_layer layer;
    contact_normal_fields fields;
    contact_normal_report report;
    int i;

    contact_normal_scene_init(&scene);
    contact_normal_layer_init(&layer);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    scene.mx = scene.my = M;
    scene.dx = scene.dy = 0.1;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M - 0.5 * (M - 1)) * scene.dx, y = (i / M - 0.5 * (M - 1)) * scene.dy;
        h[i] = (x * x + y * y) / 1000.0;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.force = 1000.0;
    scene.layer = &layer;
    printf("compliance   approach  max pressure  contact area\n");
    for (i = 0; i < 4; i++) {
        layer.compliance = compliances[i];
        if (!solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")) return EXIT_FAILURE;
        printf("%10.0e %10.6f %13.2f %13.2f\n", layer.compliance, report.normal.approach, report.normal.max_pressure, report.normal.contact_area);
    }
    return EXIT_SUCCESS;
}
