/* Solves a gap that the Python package made from measured heights, or from the profiles of a wheel and a rail, and wrote by `Gap.write`.

   gap ../data/gaps/ground.txt 1.2288 [file]: presses the surfaces of steel bodies together by a force. Lengths are in mm, forces in N. The solution
   is written to the file. */
#include <string.h>

#include "example.h"

/* Reads a file of a gap: lines that begin with "#", a line "mx my dx dy", and one undeformed distance per element, x fastest; "inf": no surface. */
static double *read_gap(const char *path, contact_normal_scene *scene)
{
    char line[512];
    double *h = NULL;
    long start = 0;
    int mx = 0, my = 0, i = 0, ok = 0;
    FILE *file = fopen(path, "rb"); /* binary, because on Windows positions in a text file are no numbers of bytes */

    if (file == NULL) {
        perror(path);
        return NULL;
    }
    while (fgets(line, sizeof line, file) != NULL && line[0] == '#') start = ftell(file);
    if (fseek(file, start, SEEK_SET) == 0 && fscanf(file, "%d %d %lf %lf", &mx, &my, &scene->dx, &scene->dy) == 4 && mx > 0 && my > 0
        && mx <= 4096 && my <= 4096) {
        h = doubles(mx * my);
        while (i < mx * my && fscanf(file, "%lf", &h[i]) == 1) i++;
        ok = i == mx * my;
    }
    fclose(file);
    if (!ok) {
        fprintf(stderr, "%s: no file of a gap\n", path);
        free(h);
        return NULL;
    }
    scene->mx = mx, scene->my = my;
    scene->undeformed_distance = h;
    return h;
}

int main(int argc, char **argv)
{
    contact_normal_scene scene;
    contact_normal_options options;
    contact_normal_fields fields;
    contact_normal_report report;
    double *h, *p, force;
    int32_t *contact;
    char *end = NULL;
    int i, count, holes = 0, ok;

    force = argc > 2 ? strtod(argv[2], &end) : 0.0;
    if (argc < 3 || end == argv[2] || *end != '\0') {
        fprintf(stderr, "usage: %s gap.txt force [file]\nforce is a number, in N\n", argv[0]);
        return EXIT_FAILURE;
    }
    contact_normal_scene_init(&scene);
    contact_normal_options_init(&options);
    contact_normal_fields_init(&fields);
    contact_normal_report_init(&report);
    h = read_gap(argv[1], &scene);
    if (h == NULL) return EXIT_FAILURE;
    count = (int)(scene.mx * scene.my);
    for (i = 0; i < count; i++) holes += h[i] > 1e300;
    scene.force = force;
    scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
    scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
    options.tolerance = 1e-9;
    p = doubles(count);
    contact = flags(count);
    fields.pressure = p;
    fields.contact = contact;
    ok = solved(contact_normal_solve(&scene, &options, &fields, &report), "contact_normal_solve");
    if (ok) {
        printf("%d x %d elements of %g mm x %g mm, %d without a surface\n", (int)scene.mx, (int)scene.my, scene.dx, scene.dy, holes);
        printf("force %.4f N, approach %.6f mm\n", report.normal.force, report.normal.approach);
        printf("largest pressure %.1f N/mm2, contact on %.2f %% of the grid\n", report.normal.max_pressure,
               100.0 * (double)report.normal.contact_count / count);
        ok = write_solution(argc > 3 ? argv[3] : NULL, &scene, report.normal.approach, p, contact);
    }
    free(p);
    free(contact);
    free(h);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
