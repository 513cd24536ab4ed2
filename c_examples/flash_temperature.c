/* Flash temperature: a steel ball of radius 5 mm does not move, and is pressed by 50 N onto a steel disc that slides past it at 2 and 20 m/s. The
   friction coefficient mu is 0.1, and the heat flux into each element mu p v. Units are m, N, s, W and K. */
#include "example.h"

enum { M = 80 };

int main(void)
{
    static const double speeds[] = {2.0, 20.0}, mu = 0.1;
    static double h[M * M], pressure[M * M], flux[M * M];
    contact_normal_scene scene;
    contact_normal_fields fields;
    contact_normal_heat heat;
    contact_normal_flash flash;
    int i, k;

    contact_normal_scene_init(&scene);
    contact_normal_fields_init(&fields);
    contact_normal_heat_init(&heat);
    contact_normal_flash_init(&flash);
    scene.mx = scene.my = heat.mx = heat.my = M;
    scene.dx = scene.dy = heat.dx = heat.dy = 5e-6;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M - 0.5 * (M - 1)) * scene.dx, y = (i / M - 0.5 * (M - 1)) * scene.dy;
        h[i] = (x * x + y * y) / 0.01;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 80e9;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.3;
    scene.force = 50.0;
    fields.pressure = pressure;
    if (!solved(contact_normal_solve(&scene, NULL, &fields, NULL), "contact_normal_solve")) return EXIT_FAILURE;
    heat.heat_flux = flux;
    heat.conductivity[0] = heat.conductivity[1] = 46.0;
    heat.diffusivity[0] = heat.diffusivity[1] = 1.2e-5;
    printf("speed  heat into the ball  flash temperature  where\n");
    for (k = 0; k < 2; k++) {
        for (i = 0; i < M * M; i++) flux[i] = mu * pressure[i] * speeds[k];
        heat.speed[1] = speeds[k];
        if (!solved(contact_normal_flash_temperature(&heat, NULL, &flash), "contact_normal_flash_temperature")) return EXIT_FAILURE;
        printf("%5.0f %19.3f %18.1f  x = %.1f um on the disc\n", speeds[k], flash.share, flash.largest[0], 1e6 * flash.x[1]);
    }
    return EXIT_SUCCESS;
}
