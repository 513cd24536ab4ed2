/* Effect `coating`: a steel ball of radius 10 mm is pressed by 100 N onto a steel plate with an elastic coating of 0.05 mm, from soft to stiff
   coatings. Where its compliance is positive, a thin layer, which is exact to first order in the thickness, is solved for comparison. */
#include "example.h"

enum { M = 96 };

static const double G = 80000.0, NU = 0.3, THICKNESS = 0.05;

/* The compliance of a thin layer that stands for the coating: the displacement by a unit pressure beyond that of the plate alone. See
   docs/effects.md. */
static double first_order(double shear_modulus)
{
    return THICKNESS * ((1 - 2 * NU) / (2 * shear_modulus * (1 - NU)) - NU * (1 - 2 * NU) / ((1 - NU) * G) -
                        shear_modulus * (1 - 2 * NU) * (1 - 2 * NU) / (2 * (1 - NU) * G * G));
}

int main(void)
{
    static const double moduli[] = {4000.0, 20000.0, 80000.0, 200000.0, 400000.0};
    static double h[M * M];
    contact_normal_scene scene;
    contact_normal_coating coating;
    contact_normal_layer layer;
    contact_normal_fields fields;
    contact_normal_report report;
    int i;

    contact_normal_scene_init(&scene);
    contact_normal_coating_init(&coating);
    contact_normal_layer_init(&layer);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    scene.mx = scene.my = M;
    scene.dx = scene.dy = 0.008;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M - 0.5 * (M - 1)) * scene.dx, y = (i / M - 0.5 * (M - 1)) * scene.dy;
        h[i] = (x * x + y * y) / 20.0;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = G;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = NU;
    scene.force = 100.0;
    coating.thickness = THICKNESS;
    coating.poisson_ratio = NU;
    printf("G of coating   approach  max pressure  contact area   compliance at 1/mm   max pressure of a layer\n");
    for (i = 0; i < 5; i++) {
        double compliance;
        coating.shear_modulus = moduli[i];
        scene.coating[1] = &coating;
        scene.layer = NULL;
        if (!solved(contact_normal_coating_compliance(&coating, G, NU, 1.0, &compliance), "contact_normal_coating_compliance") ||
            !solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")) {
            return EXIT_FAILURE;
        }
        printf("%12.0f %10.6f %13.1f %13.5f %20.4e", moduli[i], report.normal.approach, report.normal.max_pressure, report.normal.contact_area, compliance);
        layer.compliance = first_order(moduli[i]);
        if (layer.compliance < 0) {
            printf("%26s\n", "none");
            continue;
        }
        scene.coating[1] = NULL;
        scene.layer = &layer;
        if (!solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")) return EXIT_FAILURE;
        printf("%26.1f\n", report.normal.max_pressure);
    }
    return EXIT_SUCCESS;
}
