/* A real wheel-rail contact with a given force. The result is compared with that of the program CONTACT (NORM).

   wheel_rail data/wheel_rail/y4_82kN.txt [file]: the solution is written to the file. */
#include <math.h>
#include <string.h>

#include "example.h"

struct wheel_rail {
    contact_normal_scene scene;
    double approach; /* that of the reference */
    double *h, *p;
    int32_t *contact;
};

/* Reads a data file: three comment lines, a line "mx my dx dy approach force shear_modulus poisson_ratio", and a line "h p contact" per element. */
static int read_case(const char *path, struct wheel_rail *reference)
{
    contact_normal_scene *scene = &reference->scene;
    char line[512];
    double shear_modulus, poisson_ratio;
    int mx, my, inside, i, ok = 0;
    FILE *file = fopen(path, "r");

    if (file == NULL) {
        perror(path);
        return 0;
    }
    for (i = 0; i < 3; i++) {
        if (fgets(line, sizeof line, file) == NULL || strncmp(line, "#", 1) != 0) goto done;
    }
    contact_normal_scene_init(scene);
    if (fscanf(file, "%d %d %lf %lf %lf %lf %lf %lf", &mx, &my, &scene->dx, &scene->dy, &reference->approach,
               &scene->force, &shear_modulus, &poisson_ratio) != 8
        || mx < 1 || my < 1 || mx > 4096 || my > 4096) {
        goto done;
    }
    reference->h = doubles(mx * my);
    reference->p = doubles(mx * my);
    reference->contact = flags(mx * my);
    for (i = 0; i < mx * my; i++) {
        if (fscanf(file, "%lf %lf %d", &reference->h[i], &reference->p[i], &inside) != 3) goto done;
        reference->contact[i] = inside;
    }
    scene->mx = mx;
    scene->my = my;
    scene->undeformed_distance = reference->h;
    scene->shear_modulus[0] = scene->shear_modulus[1] = shear_modulus;
    scene->poisson_ratio[0] = scene->poisson_ratio[1] = poisson_ratio;
    ok = 1;
done:
    if (!ok) fprintf(stderr, "%s: not a wheel-rail case\n", path);
    fclose(file);
    return ok;
}

static void print_comparison(const struct wheel_rail *reference, const double *p, const contact_normal_report *report)
{
    const contact_normal_scene *scene = &reference->scene;
    double force = 0.0, largest = 0.0, difference = 0.0;
    int i, count = 0;

    for (i = 0; i < scene->mx * scene->my; i++) {
        force += reference->p[i] * scene->dx * scene->dy;
        largest = fmax(largest, reference->p[i]);
        difference = fmax(difference, fabs(p[i] - reference->p[i]));
        count += reference->contact[i] != 0;
    }
    printf("wheel-rail contact, %d x %d elements, force prescribed\n", (int)scene->mx, (int)scene->my);
    printf("%-22s %12s %12s\n", "", "found", "CONTACT");
    printf("%-22s %12.6f %12.6f\n", "approach [mm]", report->normal.approach, reference->approach);
    printf("%-22s %12.1f %12.1f\n", "force [N]", report->normal.force, force);
    printf("%-22s %12.2f %12.2f\n", "max pressure [N/mm2]", report->normal.max_pressure, largest);
    printf("%-22s %12d %12d\n", "elements in contact", (int)report->normal.contact_count, count);
    printf("pressures differ by less than 2e-7 of the maximum: %s\n", difference < 2e-7 * largest ? "yes" : "no");
}

int main(int argc, char **argv)
{
    struct wheel_rail reference;
    contact_normal_options options;
    contact_normal_fields fields;
    contact_normal_report report;
    double *p = NULL;
    int32_t *contact = NULL;
    int ok;

    if (argc < 2) {
        fprintf(stderr, "usage: %s data/wheel_rail/y4_82kN.txt [file]\n", argv[0]);
        return EXIT_FAILURE;
    }
    memset(&reference, 0, sizeof reference);
    ok = read_case(argv[1], &reference);
    if (ok) {
        const contact_normal_scene *scene = &reference.scene;
        p = doubles(scene->mx * scene->my);
        contact = flags(scene->mx * scene->my);
        contact_normal_options_init(&options);
    options.tolerance = 1e-9; /* the result of CONTACT has a tolerance of 1e-7 */
    contact_normal_fields_init(&fields);
        fields.pressure = p;
        fields.contact = contact;
        contact_normal_report_init(&report);
        ok = solved(contact_normal_solve(scene, &options, &fields, &report), "contact_normal_solve");
    }
    if (ok) {
        print_comparison(&reference, p, &report);
        ok = write_solution(argc > 2 ? argv[2] : NULL, &reference.scene, report.normal.approach, p, contact);
    }
    free(p);
    free(contact);
    free(reference.h);
    free(reference.p);
    free(reference.contact);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
