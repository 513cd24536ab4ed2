/* Effect `friction`: a steel ball on a steel plate is pushed sideways. As in the theory of Cattaneo and Mindlin the contact sticks in a disc that
   shrinks with the force, and slips in the ring around it. The ball slides when the force is mu times the normal force. */
#include "example.h"

enum { M = 64 };

int main(void)
{
    static const double parts[] = {0.1, 0.5, 0.875, 0.99};
    static double h[M * M], traction[2][M * M], slip[2][M * M];
    static int32_t stick_slip[M * M];
    contact_normal_scene scene;
    contact_normal_friction friction;
    contact_normal_fields fields;
    contact_normal_report report;
    int i, k;

    contact_normal_scene_init(&scene);
    contact_normal_friction_init(&friction);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    scene.mx = scene.my = M;
    scene.dx = scene.dy = 0.03;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M - 0.5 * (M - 1)) * scene.dx, y = (i / M - 0.5 * (M - 1)) * scene.dy;
        h[i] = (x * x + y * y) / 100.0;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.force = 1000.0;
    friction.coefficient = 0.3;
    friction.prescribed[0] = friction.prescribed[1] = CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE;
    scene.friction = &friction;
    for (k = 0; k < 2; k++) {
        fields.traction[k] = traction[k];
        fields.slip[k] = slip[k];
    }
    fields.stick_slip = stick_slip;
    printf("force/(mu N)  shift in um  stick  slip  traction, slip at the rim\n");
    for (i = 0; i < 4; i++) {
        const int rim = M / 2 * M + 9;
        friction.force[0] = parts[i] * 0.3 * scene.force;
        if (!solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")) return EXIT_FAILURE;
        printf("%12.3f %12.4f %6ld %5ld %9.1f %.2e\n", report.tangential.force[0] / (0.3 * report.normal.force),
               1000.0 * report.tangential.creepage[0], (long)report.tangential.stick_count, (long)report.tangential.slip_count, traction[0][rim], slip[0][rim]);
    }
    return EXIT_SUCCESS;
}
