/* Effect `pressure_limit`: a steel ball of radius 50 mm is pressed into a surface with a hardness of 1200 N/mm2. Where this limit is reached, the
   surface yields. The dent is the plastic penetration. */
#include "example.h"

enum { M = 64 };

int main(void)
{
    static const double forces[] = {500.0, 2000.0, 4000.0};
    static double h[M * M], e[M * M];
    static int32_t contact[M * M];
    contact_normal_scene scene;
    contact_normal_pressure_limit limit;
    contact_normal_fields fields;
    contact_normal_report report;
    int i, k;

    contact_normal_scene_init(&scene);
    contact_normal_pressure_limit_init(&limit);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    scene.mx = scene.my = M;
    scene.dx = scene.dy = 0.05;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M - 0.5 * (M - 1)) * scene.dx, y = (i / M - 0.5 * (M - 1)) * scene.dy;
        h[i] = (x * x + y * y) / 100.0;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    limit.limit = 1200.0;
    scene.pressure_limit = &limit;
    fields.deformed_distance = e;
    fields.contact = contact;
    printf("   force  max pressure  contact area  at the limit      dent\n");
    for (k = 0; k < 3; k++) {
        double dent = 0.0, area = 0.0;
        scene.force = forces[k];
        if (!solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")) return EXIT_FAILURE;
        for (i = 0; i < M * M; i++) {
            if (contact[i] == 2) area += scene.dx * scene.dy;
            if (contact[i] == 2 && -e[i] > dent) dent = -e[i];
        }
        printf("%8.0f %13.2f %13.4f %13.4f %9.5f\n", scene.force, report.normal.max_pressure, report.normal.contact_area, area, dent);
    }
    return EXIT_SUCCESS;
}
