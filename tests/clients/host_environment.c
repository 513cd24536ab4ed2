/* A host with an environment of its own: host_environment rounding | fork | silent. Prints nothing but what goes wrong. */
#define _POSIX_C_SOURCE 200809L
#include <fenv.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#include "contact_normal.h"

/* A prime, so that rounding matters everywhere, and so many elements that workers share each pass, also on the window around C. */
enum { M = 281, N = M * M };

static double h[N];

/* Bits of MXCSR. */
#define FLUSH_TO_ZERO 0x8000u
#define DENORMALS_ARE_ZERO 0x0040u

static unsigned control_register(void)
{
#if defined(__x86_64__)
    return _mm_getcsr();
#elif defined(__aarch64__)
    unsigned long long value;
    __asm__ volatile("mrs %0, fpcr" : "=r"(value));
    return (unsigned)value;
#else
    return 0;
#endif
}

static void flush_denormals(void)
{
#if defined(__x86_64__)
    _mm_setcsr(_mm_getcsr() | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
#elif defined(__aarch64__)
    unsigned long long value;
    __asm__ volatile("mrs %0, fpcr" : "=r"(value));
    value |= 1ull << 24;
    __asm__ volatile("msr fpcr, %0" : : "r"(value));
#endif
}

static int fail(const char *what)
{
    fprintf(stderr, "%s (last error: %s)\n", what, contact_normal_last_error());
    return EXIT_FAILURE;
}

static contact_normal_scene scene(void)
{
    contact_normal_scene scene;
    int i;

    contact_normal_scene_init(&scene);
    scene.mx = scene.my = M;
    scene.dx = 20.0 / M;
    scene.dy = 12.0 / M;
    for (i = 0; i < N; i++) {
        const double x = (i % M + 0.5) * scene.dx - 10.0, y = (i / M + 0.5) * scene.dy - 6.0;
        h[i] = 0.0016681 * x * x + 0.0030671 * y * y;
    }
    scene.undeformed_distance = h;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.approach = 0.1091;
    return scene;
}

static contact_normal_status solve(const contact_normal_scene *scene, int threads, double *p)
{
    contact_normal_options options;
    contact_normal_fields fields;

    contact_normal_options_init(&options);
    options.threads = threads;
    contact_normal_fields_init(&fields);
    fields.pressure = p;
    return contact_normal_solve(scene, &options, &fields, NULL);
}

/* The same bits whatever the host's rounding, and the host's rounding afterwards. */
static int rounding(void)
{
    static double plain[N], strange[N];
    const contact_normal_scene problem = scene();
    int threads;

    if (solve(&problem, 1, plain) != CONTACT_NORMAL_OK) return fail("the plain solve");
    for (threads = 1; threads <= 2; threads++) {
        unsigned before, after;
        contact_normal_status status;
        volatile double tiny = 1e-310, one = 1.0, third;

        flush_denormals();
        fesetround(FE_UPWARD);
        before = control_register();
        status = solve(&problem, threads, strange);
        after = control_register();
        third = one / 3.0;
        if (status != CONTACT_NORMAL_OK) return fail("the solve in a strange environment");
        if (before != after) return fail("the control register is not the host's any more");
        if (fegetround() != FE_UPWARD) return fail("the rounding mode is not the host's any more");
        if (third * 3.0 < 1.0 || tiny * one != 0.0) return fail("the host's arithmetic is not its own any more");
        if (memcmp(plain, strange, sizeof plain) != 0) return fail("the host's environment changed the result");
        memset(strange, 0, sizeof strange);
    }
    return EXIT_SUCCESS;
}

/* A child of a process whose worker threads it does not have. */
static int forked(void)
{
    static double parent[N], child[N];
    const contact_normal_scene problem = scene();
    pid_t pid;
    int status;

    if (solve(&problem, 2, parent) != CONTACT_NORMAL_OK) return fail("the parent's solve");
    pid = fork();
    if (pid == -1) return fail("fork");
    if (pid == 0) {
        /* A hang ends here, by a signal. It is no time limit: the solve takes milliseconds. */
        alarm(60);
        if (solve(&problem, 2, child) != CONTACT_NORMAL_OK) _exit(2);
        _exit(memcmp(parent, child, sizeof parent) != 0 ? 3 : 0);
    }
    if (waitpid(pid, &status, 0) != pid) return fail("waitpid");
    if (WIFSIGNALED(status)) return fail("the child hung or crashed");
    if (WEXITSTATUS(status) != 0) return fail("the child's solve failed, or differs from the parent's");
    /* The parent still has its threads. */
    memset(child, 0, sizeof child);
    if (solve(&problem, 2, child) != CONTACT_NORMAL_OK) return fail("the parent's second solve");
    return memcmp(parent, child, sizeof parent) != 0 ? fail("the parent's second solve differs") : EXIT_SUCCESS;
}

/* Refusals and early stops of many kinds. */
static int silent(void)
{
    static double p[N];
    contact_normal_scene problem = scene();
    contact_normal_options options;
    contact_normal_fields fields;

    contact_normal_options_init(&options);
    contact_normal_fields_init(&fields);
    fields.pressure = p;
    options.max_cycles = 1;
    if (contact_normal_solve(&problem, &options, &fields, NULL) != CONTACT_NORMAL_ITERATION_LIMIT) return fail("the limit");
    if (contact_normal_solve(NULL, NULL, NULL, NULL) != CONTACT_NORMAL_NULL_POINTER) return fail("a null pointer");
    problem.dx = -1.0;
    if (solve(&problem, 1, p) != CONTACT_NORMAL_INVALID_ARGUMENT) return fail("a negative element");
    problem = scene();
    h[7] = NAN;
    if (solve(&problem, 2, p) != CONTACT_NORMAL_NOT_FINITE) return fail("a NaN");
    problem = scene();
    problem.struct_size = 1;
    if (solve(&problem, 1, p) != CONTACT_NORMAL_STRUCT_SIZE) return fail("a struct size");
    contact_normal_release();
    return EXIT_SUCCESS;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "rounding") == 0) return rounding();
    if (argc == 2 && strcmp(argv[1], "fork") == 0) return forked();
    if (argc == 2 && strcmp(argv[1], "silent") == 0) return silent();
    return fail("usage: host_environment rounding | fork | silent");
}
