/* Effect `friction` with influence coefficients that the program computes, as programs in the tradition of CONTACT do: five tables for a steel ball
   on a softer body. They are Kalker's formulas for half-spaces, so the library's built-in coefficients must give the same result. */
#include <math.h>

#include "example.h"

enum { M = 24, C = 2 * M };

static const double PI = 3.14159265358979323846, D = 0.09;

/* The primitive of a coefficient. The coefficient is a sum over the corners of an element, with signs. */
static double corner(int table, double x, double y, double nu)
{
    const double r = sqrt(x * x + y * y), a = x * asinh(y / fabs(x)), b = y * asinh(x / fabs(y));
    switch (table) {
    case 0: return (1.0 - nu) * a + b;
    case 1: return a + (1.0 - nu) * b;
    case 2: return -nu * r;
    case 3: return -(y * log(r) + x * atan(y / x));
    default: return -(x * log(r) + y * atan(x / y));
    }
}

int main(void)
{
    static double h[M * M], traction[2][2][M * M], tables[5][C * C];
    contact_normal_scene scene;
    contact_normal_friction friction;
    contact_normal_influence influence[5]; /* xx, yy, xy; and for bodies with different constants xz, yz */
    contact_normal_fields fields;
    contact_normal_report report;
    double g, nu, k, difference = 0.0, largest = 0.0;
    int i, own, table;

    contact_normal_scene_init(&scene);
    contact_normal_friction_init(&friction);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    scene.mx = scene.my = M;
    scene.dx = scene.dy = D;
    for (i = 0; i < M * M; i++) {
        const double x = (i % M - 0.5 * (M - 1)) * D, y = (i / M - 0.5 * (M - 1)) * D;
        h[i] = (x * x + y * y) / 100.0;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = 82000.0;
    scene.poisson_ratio[0] = 0.28;
    scene.shear_modulus[1] = 20000.0;
    scene.poisson_ratio[1] = 0.2;
    scene.force = 500.0;
    friction.coefficient = 0.3;
    friction.creepage[0] = -1.2e-3;
    scene.friction = &friction;

    /* G, nu and K of both bodies together. 1/G and nu/G are the means of those of the bodies. */
    g = 2.0 / (1.0 / scene.shear_modulus[0] + 1.0 / scene.shear_modulus[1]);
    nu = 0.5 * g * (scene.poisson_ratio[0] / scene.shear_modulus[0] + scene.poisson_ratio[1] / scene.shear_modulus[1]);
    k = 0.25 * g * ((1.0 - 2.0 * scene.poisson_ratio[0]) / scene.shear_modulus[0] -
                    (1.0 - 2.0 * scene.poisson_ratio[1]) / scene.shear_modulus[1]);
    /* The coefficients times G at the offsets -M..M-1 in both directions, x fastest. */
    for (table = 0; table < 5; table++) {
        for (i = 0; i < C * C; i++) {
            const double x = (i % C - M) * D, y = (i / C - M) * D, e = 0.5 * D;
            const double sum = corner(table, x + e, y + e, nu) - corner(table, x - e, y + e, nu) -
                               corner(table, x + e, y - e, nu) + corner(table, x - e, y - e, nu);
            tables[table][i] = (table < 3 ? 1.0 : k) * sum / PI;
        }
    }

    for (own = 0; own < 2; own++) {
        if (own) {
            for (table = 0; table < 5; table++) {
                contact_normal_influence_init(&influence[table]);
                influence[table].cx = influence[table].cy = M;
                influence[table].coefficients = tables[table];
                influence[table].scale = 1.0 / g;
            }
            for (table = 0; table < 3; table++) friction.influence[table] = &influence[table];
            friction.influence_cross[0] = &influence[3];
            friction.influence_cross[1] = &influence[4];
        }
        fields.traction[0] = traction[own][0];
        fields.traction[1] = traction[own][1];
        if (!solved(contact_normal_solve(&scene, NULL, &fields, &report), "contact_normal_solve")) return EXIT_FAILURE;
        printf("%s: Fx/(mu N) %.4f, %ld elements stick, %ld slip\n", own ? "own tables  " : "half-space  ",
               report.tangential.force[0] / (0.3 * report.normal.force), (long)report.tangential.stick_count, (long)report.tangential.slip_count);
    }
    for (i = 0; i < M * M; i++) {
        const double qx = traction[0][0][i], qy = traction[0][1][i];
        largest = fmax(largest, hypot(qx, qy));
        difference = fmax(difference, hypot(traction[1][0][i] - qx, traction[1][1][i] - qy));
    }
    printf("tractions differ by less than 1e-5 of the largest: %s\n", difference < 1e-5 * largest ? "yes" : "no");
    return EXIT_SUCCESS;
}
