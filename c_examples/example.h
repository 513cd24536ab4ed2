/* Functions that the examples share: they report a failure, and write the solution to a file. */
#ifndef EXAMPLE_H
#define EXAMPLE_H

#include <stdio.h>
#include <stdlib.h>

#include "contact_normal.h"

/* Returns 1 if a call has solved its problem. Otherwise it writes the reason to stderr and returns 0. With a status > 0 the arrays are usable, but
   the tolerance is not reached; the examples treat this as a failure. */
static inline int solved(contact_normal_status status, const char *call)
{
    if (status == CONTACT_NORMAL_OK) return 1;
    fprintf(stderr, "%s: %s: %s\n", call, contact_normal_status_text(status), contact_normal_last_error());
    return 0;
}

/* Allocates memory for `count` doubles. Without memory it ends the program. */
static inline double *doubles(int count)
{
    double *values = calloc((size_t)count, sizeof *values);
    if (values == NULL) {
        fprintf(stderr, "out of memory\n");
        exit(EXIT_FAILURE);
    }
    return values;
}

/* Allocates memory for the contact area. Without memory it ends the program. */
static inline int32_t *flags(int count)
{
    int32_t *values = calloc((size_t)count, sizeof *values);
    if (values == NULL) {
        fprintf(stderr, "out of memory\n");
        exit(EXIT_FAILURE);
    }
    return values;
}

/* Writes "mx my dx dy approach", then "h p contact" per element, x fastest, with all digits. Returns 1, or 0 after a message on stderr. If `path`
   is NULL, it writes nothing. */
static inline int write_solution(const char *path, const contact_normal_scene *scene, double approach,
                                 const double *p, const int32_t *contact)
{
    const double *h = scene->undeformed_distance;
    FILE *file;
    int i;

    if (path == NULL) return 1;
    file = fopen(path, "w");
    if (file == NULL) {
        perror(path);
        return 0;
    }
    fprintf(file, "%d %d %.17g %.17g %.17g\n", (int)scene->mx, (int)scene->my, scene->dx, scene->dy, approach);
    for (i = 0; i < scene->mx * scene->my; i++) fprintf(file, "%.17g %.17g %d\n", h[i], p[i], (int)contact[i]);
    if (fclose(file) != 0) {
        perror(path);
        return 0;
    }
    return 1;
}

#endif
