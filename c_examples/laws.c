/* Friction that falls with the slip velocity: creep curves of a steel wheel on a rail at 10 m/s with an elastic third body, for a constant
   coefficient, for a law, and for a third body that yields. With the law the force has a maximum; with a constant coefficient it has none. */
#include "example.h"

enum { MX = 48, MY = 44 };

int main(void)
{
    static const double creepages[] = {0.001, 0.004, 0.008, 0.016, 0.03, 0.1};
    static double h[MX * MY];
    contact_normal_scene scene;
    contact_normal_friction friction;
    contact_normal_report report;
    int i, with;

    contact_normal_scene_init(&scene);
    contact_normal_friction_init(&friction);
    contact_normal_report_init(&report);
    scene.mx = MX;
    scene.my = MY;
    scene.dx = 0.289; /* mm */
    scene.dy = 0.6304;
    for (i = 0; i < MX * MY; i++) {
        const double x = (i % MX - 0.5 * (MX - 1)) * scene.dx, y = (i / MX - 0.5 * (MY - 1)) * scene.dy;
        h[i] = 8e-4 * x * x + 2.8142e-4 * y * y;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0; /* N/mm2 */
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.force = 106700.0; /* N */
    friction.coefficient = 0.33; /* mu at rest */
    friction.motion = CONTACT_NORMAL_MOTION_STEADY_ROLLING;
    friction.compliance = 1.25 / 8200.0; /* mm per N/mm2: a third body of 1.25 mm */
    friction.kinetic = 0.14;
    friction.falling[0] = 0.19;
    friction.half_speed[0] = 1250.0; /* mm/s */
    friction.speed = 10000.0;
    friction.memory_distance = 0.003; /* mm */
    friction.memory_speed = 1.0;
    scene.friction = &friction;
    printf("creepage   force/(.33 N)    sticks, as one coefficient, as a law, and with a layer that yields at 100 N/mm2\n");
    for (i = 0; i < 6; i++) {
        friction.creepage[0] = -creepages[i];
        printf("%8.3f", creepages[i]);
        for (with = 0; with < 3; with++) {
            friction.law = with == 0 ? CONTACT_NORMAL_FRICTION_LAW_COULOMB : CONTACT_NORMAL_FRICTION_LAW_EXPONENTIAL;
            friction.yield_limit = with == 2 ? 100.0 : 0.0;
            if (!solved(contact_normal_solve(&scene, NULL, NULL, &report), "contact_normal_solve")) return EXIT_FAILURE;
            printf("  %7.4f %4ld", report.tangential.force[0] / (0.33 * report.normal.force), (long)report.tangential.stick_count);
        }
        printf("\n");
    }
    return EXIT_SUCCESS;
}
