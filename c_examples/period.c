/* Effect `period`: a wavy surface d cos(2 pi x/L) cos(2 pi y/L), periodic in x and y. Contact is full if the mean pressure is at least
   p* = sqrt(2) pi E* d/L (Johnson, Contact Mechanics, section 13.3). */
#include <math.h>

#include "example.h"

enum { M = 64 };

int main(void)
{
    static const double shares[] = {0.01, 0.1, 0.5, 0.9, 1.1};
    static double h[M * M];
    const double pi = acos(-1.0), length = 1.0, d = 0.001;
    contact_normal_scene scene;
    contact_normal_period period;
    contact_normal_fields fields;
    contact_normal_report report;
    double full;
    int i;

    contact_normal_scene_init(&scene);
    contact_normal_period_init(&period);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    scene.mx = scene.my = M; /* the grid is one period */
    scene.dx = scene.dy = length / M;
    for (i = 0; i < M * M; i++) {
        h[i] = d * (1.0 - cos(2.0 * pi * (i % M + 0.5) / M) * cos(2.0 * pi * (i / M + 0.5) / M));
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    period.x = period.y = 1;
    scene.period = &period;
    full = sqrt(2.0) * pi * (82000.0 / (1.0 - 0.28)) * d / length;
    printf("mean pressure/p*  part in contact  approach/d\n");
    for (i = 0; i < 5; i++) {
        scene.force = shares[i] * full * length * length;
        if (!solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")) return EXIT_FAILURE;
        printf("%16.2f %16.4f %11.4f\n", shares[i], report.normal.contact_area / (length * length), report.normal.approach / d);
    }
    return EXIT_SUCCESS;
}
