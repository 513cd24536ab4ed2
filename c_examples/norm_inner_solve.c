/* A program with Kalker's NORM keeps its active set, and replaces its inner solver: `norm` is called once with the program's conjugate gradients,
   and once with V-cycles of the library, for the program's table of influence coefficients.

   norm_inner_solve [file]: the solution by V-cycles is written to the file. */
#include <math.h>
#include <string.h>

#include "example.h"

enum { MX = 48, MY = 48, N = MX * MY };

/* A_ij = table[iy - jy + MY][ix - jx + MX] */
static double table[2 * MY][2 * MX];
static const double tolerance = 1e-9; /* the tolerance of the inner solves, relative to ||h - approach|| */
static contact_normal_influence influence;
static contact_normal_scene scene;
static contact_normal_solver *solver;

struct solution {
    double p[N];
    int32_t contact[N];
    int steps, iterations;
};

/* Computes u = A p on every element, by direct summation over the elements with a pressure. */
static void displace(const double *p, double *u)
{
    int i, j;
    memset(u, 0, N * sizeof *u);
    for (j = 0; j < N; j++) {
        if (p[j] == 0.0) continue;
        for (i = 0; i < N; i++) u[i] += table[i / MX - j / MX + MY][i % MX - j % MX + MX] * p[j];
    }
}

static double dot(const double *a, const double *b)
{
    double sum = 0.0;
    int i;
    for (i = 0; i < N; i++) sum += a[i] * b[i];
    return sum;
}

/* Solves h - approach + A p = 0 in the contact area by conjugate gradients, from the given p. */
static int by_conjugate_gradients(const double *h, double approach, struct solution *s)
{
    static double r[N], d[N], u[N];
    double r2, before, size = 0.0;
    int i;

    displace(s->p, u);
    for (i = 0; i < N; i++) {
        r[i] = s->contact[i] ? approach - h[i] - u[i] : 0.0;
        if (s->contact[i]) size += (h[i] - approach) * (h[i] - approach);
        d[i] = r[i];
    }
    for (r2 = dot(r, r); r2 > tolerance * tolerance * size; s->iterations++) {
        double step;
        if (s->iterations == 10000) return 0;
        displace(d, u);
        step = r2 / dot(d, u);
        for (i = 0; i < N; i++) {
            s->p[i] += step * d[i];
            if (s->contact[i]) r[i] -= step * u[i];
        }
        before = r2;
        r2 = dot(r, r);
        for (i = 0; i < N; i++) d[i] = r[i] + r2 / before * d[i];
    }
    return 1;
}

/* Solves the same equations by the library, with active_set FIXED, from the given p. The resulting pressures may be negative. */
static int by_v_cycles(const double *h, double approach, struct solution *s)
{
    contact_normal_options options;
    contact_normal_fields fields;
    contact_normal_report report;

    contact_normal_options_init(&options);
    options.method = CONTACT_NORMAL_METHOD_MULTIGRID;
    options.active_set = CONTACT_NORMAL_ACTIVE_SET_FIXED;
    options.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_GIVEN;
    options.tolerance = tolerance;
    contact_normal_fields_init(&fields);
    fields.pressure = s->p;
    fields.contact = s->contact;
    contact_normal_report_init(&report);
    scene.undeformed_distance = h;
    scene.approach = approach;
    if (!solved(contact_normal_solver_solve(solver, &scene, &options, &fields, &report), "contact_normal_solver_solve"))
        return 0;
    s->iterations += (int)report.statistics.cycles;
    return 1;
}

/* Kalker's NORM: elements with p < 0 leave the contact area until there are none; then elements with e < 0 enter it, until none does. */
static int norm(int (*inner)(const double *, double, struct solution *), const double *h, double approach,
                struct solution *s)
{
    static double u[N];
    int i, changes = 1;

    memset(s, 0, sizeof *s);
    for (i = 0; i < N; i++) s->contact[i] = h[i] < approach;
    while (changes > 0 && s->steps++ < 100) {
        if (!inner(h, approach, s)) return 0;
        changes = 0;
        for (i = 0; i < N; i++) {
            if (s->contact[i] && s->p[i] < 0.0) {
                s->contact[i] = 0;
                s->p[i] = 0.0;
                changes++;
            }
        }
        if (changes > 0) continue;
        displace(s->p, u);
        for (i = 0; i < N; i++) {
            if (!s->contact[i] && h[i] - approach + u[i] < 0.0) {
                s->contact[i] = 1;
                changes++;
            }
        }
    }
    if (changes > 0) fprintf(stderr, "NORM does not come to an end\n");
    return changes == 0;
}

int main(int argc, char **argv)
{
    static struct solution gradients, cycles;
    static double h[N];
    const double approach = 0.1091;
    double force[2] = {0.0, 0.0}, largest = 0.0, difference = 0.0;
    int i, ok;

    contact_normal_scene_init(&scene);
    scene.mx = MX;
    scene.my = MY;
    scene.dx = 20.0 / MX;
    scene.dy = 12.0 / MY;
    for (i = 0; i < N; i++) {
        const double x = (i % MX + 0.5) * scene.dx - 10.0, y = (i / MX + 0.5) * scene.dy - 6.0;
        h[i] = 0.0016681 * x * x + 0.0030671 * y * y;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;

    /* An existing program has its own table. Here the library computes the table. */
    contact_normal_influence_init(&influence);
    influence.cx = MX;
    influence.cy = MY;
    influence.coefficients = &table[0][0];
    ok = solved(contact_normal_influence_half_space(MX, MY, scene.dx, scene.dy, scene.shear_modulus,
                                                    scene.poisson_ratio, &table[0][0]),
                "contact_normal_influence_half_space");
    scene.influence = &influence;
    ok = ok && solved(contact_normal_solver_new(&scene, NULL, &solver), "contact_normal_solver_new");
    ok = ok && norm(by_conjugate_gradients, h, approach, &gradients) && norm(by_v_cycles, h, approach, &cycles);
    if (ok) {
        for (i = 0; i < N; i++) {
            force[0] += gradients.p[i] * scene.dx * scene.dy;
            force[1] += cycles.p[i] * scene.dx * scene.dy;
            largest = fmax(largest, gradients.p[i]);
            difference = fmax(difference, fabs(gradients.p[i] - cycles.p[i]));
        }
        printf("NORM, %d x %d elements\n", MX, MY);
        printf("%-22s %12s %12s\n", "inner solver", "CG", "V-cycles");
        printf("%-22s %12d %12d\n", "active-set steps", gradients.steps, cycles.steps);
        printf("%-22s %12d %12d\n", "iterations", gradients.iterations, cycles.iterations);
        printf("%-22s %12.3f %12.3f\n", "force [N]", force[0], force[1]);
        /* Two inner solutions with residuals of 1e-9 differ by 1e-9 times the condition of A, which is some tens. */
        printf("pressures differ by less than 1e-6 of the maximum: %s\n", difference < 1e-6 * largest ? "yes" : "no");
        ok = difference < 1e-6 * largest
             && write_solution(argc > 1 ? argv[1] : NULL, &scene, approach, cycles.p, cycles.contact);
    }
    contact_normal_solver_free(solver);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
