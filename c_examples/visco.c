/* Effect `visco`: a rigid ball of radius 10 mm on a polymer plate, whose modulus has two branches. First the approach is held, and the force relaxes
   as the modulus does. Then a force is held, and the approach creeps as the compliance to the power 2/3. At last two viscoelastic balls roll on each
   other at the same speed, with influence coefficients of steady rolling: the material behind the contact is relaxed, so the pressures are ahead of
   the middle. Units are mm, N and s. */
#include <math.h>

#include "example.h"

enum { M = 64, STEPS = 8, ROLLED = 32, REACH = ROLLED + 1 };

static const double G = 8.0, MODULI[2] = {4.0, 3.0}, TIMES[2] = {0.3, 3.0};

/* The relaxation modulus G(t), 8 N/mm2 at t = 0 and 1 N/mm2 in the end. */
static double modulus(double t)
{
    return G + MODULI[0] * expm1(-t / TIMES[0]) + MODULI[1] * expm1(-t / TIMES[1]);
}

/* Solves steps of 0.25 s after a jump of the load, which is then held. */
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

/* Computes the influence coefficients of both balls, whose modulus relaxes to one half with a time of 4 ms. Those of tractions reach one element
   farther than those of pressures, because of the step of rolling. */
static int made(double d, double speed, double *normal, double *own)
{
    const double half[1] = {4.0}, time[1] = {0.004}, shear_modulus[2] = {8.0, 8.0}, poisson_ratio[2] = {0.4, 0.4};
    contact_normal_visco visco;
    int b;

    contact_normal_visco_init(&visco);
    for (b = 0; b < 2; b++) {
        visco.branches[b] = 1;
        visco.modulus[b] = half;
        visco.time[b] = time;
    }
    return solved(contact_normal_influence_rolling(ROLLED, ROLLED, d, d, shear_modulus, poisson_ratio, &visco, speed, normal),
                  "contact_normal_influence_rolling")
        && solved(contact_normal_influence_rolling_tangential(REACH, REACH, d, d, shear_modulus, poisson_ratio, &visco, speed, own),
                  "contact_normal_influence_rolling_tangential");
}

/* Rolls balls of radius 50 mm under 100 N to the right, or to the left. Prints how far the pressures are ahead, and the creep force. */
static int rolls(double speed)
{
    static double h[ROLLED * ROLLED], p[ROLLED * ROLLED], normal[4 * ROLLED * ROLLED], own[12 * REACH * REACH];
    const double d = 0.4, pi = 3.14159265358979323846;
    contact_normal_scene scene;
    contact_normal_friction friction;
    contact_normal_influence tables[4];
    contact_normal_fields fields;
    contact_normal_report report;
    double moment = 0.0;
    int i;

    if (!made(d, speed, normal, own)) return 0;
    contact_normal_scene_init(&scene);
    contact_normal_friction_init(&friction);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    for (i = 0; i < 4; i++) {
        contact_normal_influence_init(&tables[i]);
        tables[i].cx = tables[i].cy = i < 3 ? REACH : ROLLED;
        tables[i].coefficients = i < 3 ? own + i * 4 * REACH * REACH : normal;
        if (i < 3) friction.influence[i] = &tables[i];
    }
    for (i = 0; i < ROLLED * ROLLED; i++) {
        const double x = (i % ROLLED - 0.5 * (ROLLED - 1)) * d, y = (i / ROLLED - 0.5 * (ROLLED - 1)) * d;
        h[i] = (x * x + y * y) / 50.0;
    }
    scene.mx = scene.my = ROLLED;
    scene.dx = scene.dy = d;
    scene.undeformed_distance = h;
    scene.force = 100.0;
    scene.influence = &tables[3];
    scene.friction = &friction;
    friction.coefficient = 0.3;
    friction.motion = CONTACT_NORMAL_MOTION_STEADY_ROLLING;
    friction.rolling_direction = speed > 0.0 ? 0.0 : pi;
    friction.creepage[0] = speed > 0.0 ? -0.01 : 0.01;
    fields.pressure = p;
    if (!solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")) return 0;
    for (i = 0; i < ROLLED * ROLLED; i++) moment += p[i] * (i % ROLLED - 0.5 * (ROLLED - 1)) * d * d * d;
    printf("at %6.0f mm/s: %7.4f mm ahead, creep force %7.3f N\n", speed, moment / report.normal.force, report.tangential.force[0]);
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
    if (!rolls(1000.0) || !rolls(-1000.0) || !rolls(10.0)) return EXIT_FAILURE;
    return EXIT_SUCCESS;
}
