/* Effect `adhesion`: a sphere that sticks to a plane, its force at some approaches, and the pull-off. Units: R = 1, w = 1/pi, E* = 3/4, in
   which forces are in pi w R, and JKR pulls off at -1.5. */
#include <math.h>

#include "example.h"

enum { M = 64 };

int main(void)
{
    const double half_width = 3.0, d = 2.0 * half_width / M, modulus = 0.75;
    static double h[M * M];
    contact_normal_adhesion adhesion;
    contact_normal_scene scene;
    contact_normal_report report;
    int i, k;

    for (i = 0; i < M * M; i++) {
        const double x = (i % M + 0.5) * d - half_width, y = (i / M + 0.5) * d - half_width;
        h[i] = 0.5 * (x * x + y * y);
    }
    contact_normal_adhesion_init(&adhesion);
    adhesion.work_of_adhesion = 0.3183098861837907;
    adhesion.range = 0.5647539;
    contact_normal_scene_init(&scene);
    scene.mx = scene.my = M;
    scene.dx = scene.dy = d;
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = 0.5 * modulus; /* 1/E* = (1 - nu)/(2 G) of this body; the other one is rigid */
    scene.shear_modulus[1] = (double)INFINITY;
    scene.adhesion = &adhesion;
    contact_normal_report_init(&report);
    printf("approach    force  contact attraction\n");
    scene.load = CONTACT_NORMAL_PRESCRIBED_APPROACH;
    for (k = 2; k >= -1; k--) {
        scene.approach = 0.5 * k;
        if (!solved(contact_normal_solve(&scene, NULL, NULL, &report), "contact_normal_solve")) return EXIT_FAILURE;
        printf("%8.2f %8.3f %8.3f %10.3f\n", report.normal.approach, report.normal.force, report.adhesion.repulsive_force,
               report.adhesion.adhesive_force);
    }
    scene.load = CONTACT_NORMAL_PRESCRIBED_FORCE;
    scene.force = 0.0;
    if (!solved(contact_normal_pull_off(&scene, NULL, NULL, &report), "contact_normal_pull_off")) return EXIT_FAILURE;
    printf("pull-off: force %.2f\n", report.normal.force);
    return EXIT_SUCCESS;
}
