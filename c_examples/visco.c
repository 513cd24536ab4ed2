/* Effect `visco`: a rigid ball of radius 10 mm on a polymer plate of two branches. First its approach is held, and the force relaxes as the
   modulus does; then a force is held, and the approach creeps as the compliance does to the power 2/3. mm, N, s. */
#include <math.h>

#include "example.h"

enum { M = 64, STEPS = 8 };

static const double G = 8.0, MODULI[2] = {4.0, 3.0}, TIMES[2] = {0.3, 3.0};

/* G(t), which is 8 N/mm2 at once and 1 in the end. */
static double modulus(double t)
{
    return G + MODULI[0] * expm1(-t / TIMES[0]) + MODULI[1] * expm1(-t / TIMES[1]);
}

/* Steps of 0.25 s after a jump of the load, which is then held. */
static int held(contact_normal_scene *scene, contact_normal_visco *visco)
{
    contact_normal_solver *solver = NULL;
    contact_normal_report report;
    double first = 0.0;
    int k;

    contact_normal_report_init(&report);
    if (!solved(contact_normal_solver_new(scene, NULL, &solver), "contact_normal_solver_new")) return 0;
    for (k = 0; k <= STEPS; k++) {
        visco->continues = k > 0;
        visco->time_step = k > 0 ? 0.25 : 0.0;
        if (!solved(contact_normal_solver_solve(solver, scene, NULL, NULL, &report), "contact_normal_solver_solve")) return 0;
        if (k == 0) first = report.normal.force;
        if (scene->load == CONTACT_NORMAL_PRESCRIBED_APPROACH)
            printf("%6.2f %9.4f %9.4f %10.5f %10.5f\n", report.visco.time, report.normal.approach, report.normal.force,
                   report.normal.force / first, modulus(report.visco.time) / G);
        else
            printf("%6.2f %9.4f %9.4f %10.4f\n", report.visco.time, report.normal.approach, report.normal.force,
                   report.normal.max_pressure);
    }
    contact_normal_solver_free(solver);
    return 1;
}

int main(void)
{
    const double d = 0.1;
    static double h[M * M];
    contact_normal_scene scene;
    contact_normal_visco visco;
    int i;

    for (i = 0; i < M * M; i++) {
        const double x = (i % M - 0.5 * (M - 1)) * d, y = (i / M - 0.5 * (M - 1)) * d;
        h[i] = (x * x + y * y) / 20.0;
    }
    contact_normal_scene_init(&scene);
    contact_normal_visco_init(&visco);
    scene.mx = scene.my = M;
    scene.dx = scene.dy = d;
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = (double)INFINITY;
    scene.shear_modulus[1] = G;
    scene.poisson_ratio[1] = 0.5;
    visco.branches[1] = 2;
    visco.modulus[1] = MODULI;
    visco.time[1] = TIMES;
    scene.visco = &visco;

    printf("  time  approach     force   relative      exact\n");
    scene.load = CONTACT_NORMAL_PRESCRIBED_APPROACH;
    scene.approach = 0.2;
    if (!held(&scene, &visco)) return EXIT_FAILURE;
    printf("  time  approach     force   pressure\n");
    scene.load = CONTACT_NORMAL_PRESCRIBED_FORCE;
    scene.force = 3.0;
    if (!held(&scene, &visco)) return EXIT_FAILURE;
    return EXIT_SUCCESS;
}
