/* Makes one cold call for a scene without effects, an ellipse on 128 x 128 elements, and prints the bytes of its solver. */
#include <contact_normal.h>
#include <stdio.h>

enum { M = 128 };
static double undeformed_distance[M * M];

int main(void)
{
    contact_normal_scene scene;
    contact_normal_report report;
    contact_normal_scene_init(&scene);
    contact_normal_report_init(&report);
    for (int i = 0; i < M * M; i++) {
        const double x = (i % M - 63.5) * 6.0 / M, y = (i / M - 63.5) * 6.0 / M;
        undeformed_distance[i] = 0.01 * x * x + 0.02 * y * y;
    }
    scene.mx = M, scene.my = M, scene.dx = 6.0 / M, scene.dy = 6.0 / M;
    scene.undeformed_distance = undeformed_distance;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.load = CONTACT_NORMAL_PRESCRIBED_APPROACH, scene.approach = 0.03;
    if (contact_normal_solve(&scene, NULL, NULL, &report) != CONTACT_NORMAL_OK) return 1;
    printf("%lld\n", (long long)report.statistics.bytes);
    return 0;
}
