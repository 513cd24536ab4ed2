/* A host with threads of its own: host_threads own_handles | openmp | first_calls | at_the_end | signals. Built with -Ofast, which flushes denormals to zero. Prints nothing
 * but what goes wrong. */
#define _POSIX_C_SOURCE 200809L
#include <omp.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "contact_normal.h"

/* So many elements that workers share each pass, also on the window around C. */
enum { M = 280, N = M * M, THREADS = 8, ROUNDS = 20 };

static double h[THREADS][N], expected[THREADS][N];

static int fail(const char *what)
{
    fprintf(stderr, "%s (last error: %s)\n", what, contact_normal_last_error());
    return EXIT_FAILURE;
}

/* Problem k: an ellipsoid of its own. */
static contact_normal_scene scene(int k)
{
    contact_normal_scene scene;
    int i;

    contact_normal_scene_init(&scene);
    scene.mx = scene.my = M;
    scene.dx = 20.0 / M;
    scene.dy = 12.0 / M;
    for (i = 0; i < N; i++) {
        const double x = (i % M + 0.5) * scene.dx - 10.0, y = (i / M + 0.5) * scene.dy - 6.0;
        h[k][i] = 0.0016681 * x * x + 0.0002 * (k + 10) * y * y;
    }
    scene.undeformed_distance = h[k];
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    scene.approach = 0.1091;
    return scene;
}

/* Many solves on a handle of one's own; each has the expected bits. */
static int rounds(const contact_normal_scene *scene, int threads, const double *bits)
{
    contact_normal_options options;
    contact_normal_fields fields;
    contact_normal_solver *solver = NULL;
    double *p = malloc(N * sizeof *p);
    int round, good = p != NULL;

    contact_normal_options_init(&options);
    options.threads = threads;
    contact_normal_fields_init(&fields);
    fields.pressure = p;
    if (contact_normal_solver_new(scene, &options, &solver) != CONTACT_NORMAL_OK) good = 0;
    for (round = 0; round < ROUNDS && good; round++) {
        memset(p, 0, N * sizeof *p);
        good = contact_normal_solver_solve(solver, scene, &options, &fields, NULL) == CONTACT_NORMAL_OK
            && memcmp(p, bits, N * sizeof *p) == 0;
    }
    contact_normal_solver_free(solver);
    free(p);
    return good;
}

static contact_normal_scene scenes[THREADS];

static void *run(void *argument)
{
    const int k = (int)((contact_normal_scene *)argument - scenes);
    return rounds(&scenes[k], 1 + k % 2, expected[k]) ? argument : NULL;
}

static int own_handles(void)
{
    pthread_t threads[THREADS];
    int k, good = 1;

    for (k = 0; k < THREADS; k++)
        if (pthread_create(&threads[k], NULL, run, &scenes[k]) != 0) return fail("pthread_create");
    for (k = 0; k < THREADS; k++) {
        void *returned = NULL;
        pthread_join(threads[k], &returned);
        good = good && returned == &scenes[k];
    }
    return good ? EXIT_SUCCESS : fail("a thread's solve failed, or differs from the one before");
}

/* OpenMP's threads wait actively (OMP_WAIT_POLICY) while one of them solves, and then all solve at once. */
static int openmp(void)
{
    int k, good = 1;

#pragma omp parallel num_threads(4)
    {
#pragma omp single
        if (!rounds(&scenes[0], 2, expected[0])) good = 0;
    }
#pragma omp parallel for num_threads(4) reduction(&& : good)
    for (k = 0; k < THREADS; k++) good = good && rounds(&scenes[k], 1, expected[k]);
    return good ? EXIT_SUCCESS : fail("a solve beside OpenMP failed, or differs from the one before");
}

static void *call(void *argument)
{
    contact_normal_solve(NULL, NULL, NULL, NULL);
    return argument;
}

/* 0, or what a child of a process returns that is forked while a thread makes the very first call. */
static int first_call(void)
{
    int status = 0;
    pthread_t thread;
    pid_t child;

    if (pthread_create(&thread, NULL, call, NULL) != 0) return 1;
    child = fork();
    if (child == 0) {
        alarm(5);
        _exit(contact_normal_solve(NULL, NULL, NULL, NULL) != CONTACT_NORMAL_NULL_POINTER);
    }
    if (child < 0 || waitpid(child, &status, 0) != child) return 1;
    pthread_join(thread, NULL);
    return status != 0;
}

/* Each time in a process that has made no call. */
static int first_calls(void)
{
    int k, status, bad = 0;

    for (k = 0; k < 120; k++) {
        const pid_t child = fork();
        if (child == 0) _exit(first_call());
        if (child < 0 || waitpid(child, &status, 0) != child || status != 0) bad++;
    }
    return bad == 0 ? EXIT_SUCCESS : fail("a child that was forked beside a first call hangs or fails");
}

static void hear(int32_t level, const char *message, void *user)
{
    (void)level;
    (void)message;
    ++*(int *)user;
}

/* After main has returned: the data of the thread are gone. */
static void last_step(void)
{
    static int heard = 0;

    contact_normal_set_log(hear, CONTACT_NORMAL_LOG_INFO, &heard);
    if (contact_normal_solve(&scenes[0], NULL, NULL, NULL) != CONTACT_NORMAL_OK) {
        fail("a solve at the end of the process");
        _exit(EXIT_FAILURE);
    }
    if (heard == 0) {
        fail("no message was logged at the end of the process");
        _exit(EXIT_FAILURE);
    }
    contact_normal_solve(NULL, NULL, NULL, NULL);
    if (strstr(contact_normal_last_error(), "scene") == NULL) {
        fail("a refusal at the end of the process");
        _exit(EXIT_FAILURE);
    }
}

/* A host that waits for a signal blocks it in its threads: it must not end an idle thread of the library, and the process with it. */
static int signals(void)
{
    const struct timespec patience = {10, 0};
    contact_normal_options options;
    sigset_t ends;

    contact_normal_options_init(&options);
    options.threads = 2;
    if (contact_normal_solve(&scenes[0], &options, NULL, NULL) != CONTACT_NORMAL_OK) return fail("a solve by two threads");
    sigemptyset(&ends);
    sigaddset(&ends, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &ends, NULL);
    kill(getpid(), SIGTERM);
    return sigtimedwait(&ends, NULL, &patience) == SIGTERM ? EXIT_SUCCESS : fail("no signal came");
}

int main(int argc, char **argv)
{
    contact_normal_fields fields;
    int k;

    if (argc == 2 && strcmp(argv[1], "first_calls") == 0) return first_calls();
    if (argc == 2 && strcmp(argv[1], "at_the_end") == 0 && atexit(last_step) != 0) return fail("atexit");
    contact_normal_fields_init(&fields);
    for (k = 0; k < THREADS; k++) {
        scenes[k] = scene(k);
        fields.pressure = expected[k];
        if (contact_normal_solve(&scenes[k], NULL, &fields, NULL) != CONTACT_NORMAL_OK) return fail("the first solve");
    }
    if (argc == 2 && strcmp(argv[1], "own_handles") == 0) return own_handles();
    if (argc == 2 && strcmp(argv[1], "openmp") == 0) return openmp();
    if (argc == 2 && strcmp(argv[1], "at_the_end") == 0) return EXIT_SUCCESS;
    if (argc == 2 && strcmp(argv[1], "signals") == 0) return signals();
    return fail("usage: host_threads own_handles | openmp | first_calls | at_the_end | signals");
}
