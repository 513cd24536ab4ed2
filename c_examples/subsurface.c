/* Stresses below the surface: on the axis of a ball (Hertz), compared with the exact ones. Then the ball slides, and the largest von Mises stress
   is elsewhere (at x = 0.27 a, z = 0.44 a for a friction coefficient of 0.25, Hamilton 1983). */
#include <math.h>

#include "example.h"

enum { N = 32, M = 2 * N + 1, DEPTHS = 101 };

int main(void)
{
    static double p[M * M], q[M * M], depths[DEPTHS];
    static double zz[DEPTHS * M * M], shear[DEPTHS * M * M];
    const double d = 1.0 / N, nu = 0.3; /* a = 1, p0 = 1 */
    contact_normal_scene scene;
    contact_normal_stress_outputs outputs;
    contact_normal_stress_maximum largest;
    int i;

    contact_normal_scene_init(&scene);
    contact_normal_stress_outputs_init(&outputs);
    scene.mx = scene.my = M;
    scene.dx = scene.dy = d;
    scene.poisson_ratio[0] = nu;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M - N) * d, y = (i / M - N) * d;
        p[i] = sqrt(fmax(0.0, 1 - x * x - y * y));
        q[i] = 0.25 * p[i];
    }
    for (i = 0; i < DEPTHS; i++) depths[i] = 0.02 * i;
    outputs.stress[2] = zz; /* components that are not asked for are not computed */
    outputs.maximum_shear = shear;
    contact_normal_stress_maximum_init(&largest);
    outputs.largest_shear = &largest;
    if (!solved(contact_normal_subsurface_stress(&scene, 1, p, NULL, NULL, depths, DEPTHS, NULL, &outputs), "subsurface_stress")) {
        return EXIT_FAILURE;
    }
    printf("Under the middle of a ball:\n  z/a      szz/p0     exact    shear/p0     exact\n");
    for (i = 0; i < DEPTHS; i += 12) {
        const double z = depths[i], exact = -1 / (1 + z * z);
        const double radial = -(1 + nu) * (1 - z * (z > 0 ? atan(1 / z) : 0)) - exact / 2;
        const size_t axis = (size_t)i * M * M + M * M / 2;
        printf("%5.2f %11.4f %9.4f %11.4f %9.4f\n", z, zz[axis], exact, shear[axis], fabs(exact - radial) / 2);
    }
    printf("largest shear %.4f p0 at z = %.2f a\n\n", largest.value, largest.z);

    contact_normal_stress_outputs_init(&outputs);
    outputs.largest_von_mises = &largest;
    if (!solved(contact_normal_subsurface_stress(&scene, 1, p, q, NULL, depths, DEPTHS, NULL, &outputs), "subsurface_stress")) {
        return EXIT_FAILURE;
    }
    printf("Sliding in x with friction .25:\nlargest von Mises stress %.4f p0 at x = %.2f a, z = %.2f a\n", largest.value,
           largest.x, largest.z);
    return EXIT_SUCCESS;
}
