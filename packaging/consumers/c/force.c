/* The paper's problem: an ellipse of steel on steel, pressed by 0.1091 mm. Prints the force. */
#include <contact_normal.h>
#include <stdio.h>

enum { M = 128 };

int main(void)
{
    static double h[M * M];
    const double dx = 20.0 / M, dy = 12.0 / M;
    contact_normal_scene scene;
    contact_normal_report report;
    contact_normal_status status;
    int ix, iy;

    for (iy = 0; iy < M; iy++) {
        for (ix = 0; ix < M; ix++) {
            double x = (ix + 0.5) * dx - 10.0, y = (iy + 0.5) * dy - 6.0;
            h[iy * M + ix] = 0.0016681 * x * x + 0.0030671 * y * y;
        }
    }
    contact_normal_scene_init(&scene);
    contact_normal_report_init(&report);
    scene.mx = scene.my = M;
    scene.dx = dx, scene.dy = dy;
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.approach = 0.1091;
    status = contact_normal_solve(&scene, NULL, NULL, &report);
    if (status != CONTACT_NORMAL_OK) {
        fprintf(stderr, "%s\n", contact_normal_last_error());
        return 1;
    }
    printf("force %.0f N\n", report.normal.force);
    return 0;
}
