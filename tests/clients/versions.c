/* A program of another version of the header: it uses every struct, each with bytes behind it that nobody may write. With LATER the header
   has members that the library does not know. Prints what went wrong, or "all as expected". */
#include <contact_normal.h>
#include <stdio.h>
#include <string.h>

enum { M = 12, N = M * M, ROOM = 1024 };

static int failures;

static void check(int holds, const char *what)
{
    if (!holds) {
        printf("%s: %s\n", what, contact_normal_last_error());
        failures++;
    }
}

static int is_untouched(const unsigned char *guard)
{
    for (int i = 0; i < ROOM; i++) {
        if (guard[i] != 0xAB) return 0;
    }
    return 1;
}

/* A struct with a guard behind it, as its _init fills it. */
#define GUARDED(kind, name)                                      \
    static struct {                                              \
        contact_normal_##kind it;                                \
        unsigned char guard[ROOM];                               \
    } name;                                                      \
    memset(&name, 0xAB, sizeof name);                            \
    contact_normal_##kind##_init(&name.it);                      \
    check(is_untouched(name.guard), #kind "_init");              \
    check(name.it.struct_size == (int64_t)sizeof name.it, #kind " has the size of its header")

static double h[N], p[N], e[N], u[N], q[2][N], slip[2][N], each[N], factors[4] = {1.0, 0.5, 0.5, 1.0};
static double table[4 * N], row_tables[2 * M * N];
static int32_t contact[N], stick_slip[N], patch[N];

static int32_t flat(int32_t mx, int32_t my, double dx, double dy, double *to, void *user)
{
    (void)user;
    for (int32_t j = 0; j < my; j++) {
        for (int32_t i = 0; i < mx; i++) {
            const double x = (i + 0.5 - 0.5 * mx) * dx, y = (j + 0.5 - 0.5 * my) * dy;
            to[j * mx + i] = 0.02 * (x * x + y * y);
        }
    }
    return 0;
}

int main(void)
{
    GUARDED(scene, scene);
    GUARDED(options, options);
    GUARDED(fields, fields);
    GUARDED(report, report);
    GUARDED(accuracy, accuracy);
    GUARDED(influence, influence);
    GUARDED(row_tables, rows);
    GUARDED(layer, layer);
    GUARDED(pressure_limit, limit);
    GUARDED(period, period);
    GUARDED(patches, patches);
    GUARDED(coating, coating);
    GUARDED(friction, friction);
    GUARDED(friction_results, results);
    GUARDED(stress_outputs, stresses);
    GUARDED(stress_maximum, largest);
    GUARDED(hertz_solution, hertz);
    GUARDED(cycle, shape);
    GUARDED(solver_info, info);

    flat(M, M, 0.5, 0.5, h, NULL);
    scene.it.mx = scene.it.my = M;
    scene.it.dx = scene.it.dy = 0.5;
    scene.it.undeformed_distance = h;
    scene.it.shear_modulus[0] = scene.it.shear_modulus[1] = 82000.0;
    scene.it.poisson_ratio[0] = scene.it.poisson_ratio[1] = 0.28;
    scene.it.approach = 0.05;
    fields.it.pressure = p, fields.it.deformed_distance = e, fields.it.displacement = u, fields.it.contact = contact;

    /* The defaults are those of the library. */
    check(options.it.tolerance == 1e-6 && options.it.max_cycles == 1000 && options.it.threads == 1, "defaults of options");
    check(influence.it.scale == 1.0 && rows.it.scale == 1.0 && accuracy.it.target == 1e-3, "defaults");

    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_OK, "solve");
    check(p[N / 2 + M / 2] > 0.0 && contact[0] == 0, "its result");

    /* Rows of the ledger are as far apart as the first one says. */
    contact_normal_ledger_row ledger[3];
    memset(ledger, 0xAB, sizeof ledger);
    contact_normal_ledger_row_init(ledger);
    report.it.ledger = ledger, report.it.ledger_capacity = 2;
    options.it.method = CONTACT_NORMAL_METHOD_FULL_MULTIGRID, options.it.cycle = &shape.it;
    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_OK, "solve with a ledger");
    check(ledger[0].mx == M / 2 && ledger[1].mx == M && ledger[1].struct_size == (int64_t)sizeof *ledger, "its rows");
    check(((unsigned char *)&ledger[2])[0] == 0xAB, "no row more");
    options.it.method = CONTACT_NORMAL_METHOD_AUTO, options.it.cycle = NULL;
    report.it.ledger = NULL, report.it.ledger_capacity = 0;

    /* Every effect that goes with the others. */
    for (int i = 0; i < N; i++) each[i] = 1e-7, patch[i] = i % M >= M / 2;
    layer.it.compliances = each;
    limit.it.limit = 1e6;
    patches.it.count = 2, patches.it.patch = patch, patches.it.factors = factors;
    scene.it.layer = &layer.it, scene.it.pressure_limit = &limit.it, scene.it.patches = &patches.it;
    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_OK, "effects");
    scene.it.layer = NULL, scene.it.pressure_limit = NULL, scene.it.patches = NULL;
    period.it.x = 1;
    scene.it.period = &period.it;
    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_OK, "period");
    scene.it.period = NULL;
    coating.it.thickness = 0.5, coating.it.shear_modulus = 1e5, coating.it.poisson_ratio = 0.3;
    scene.it.coating[0] = &coating.it;
    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_OK, "coating");
    scene.it.coating[0] = NULL;

    /* Coefficients of one's own, and a handle. */
    check(contact_normal_influence_half_space(M, M, 0.5, 0.5, scene.it.shear_modulus, scene.it.poisson_ratio, table) == CONTACT_NORMAL_OK,
          "influence_half_space");
    influence.it.cx = influence.it.cy = M, influence.it.coefficients = table;
    scene.it.influence = &influence.it;
    contact_normal_solver *solver = NULL;
    check(contact_normal_solver_new(&scene.it, &options.it, &solver) == CONTACT_NORMAL_OK, "solver_new");
    check(contact_normal_solver_solve(solver, &scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_OK, "solver_solve");
    check(contact_normal_solver_set_influence(solver, &influence.it, NULL) == CONTACT_NORMAL_OK, "solver_set_influence");
    check(contact_normal_solver_fields(solver, &fields.it) == CONTACT_NORMAL_OK, "solver_fields");
    check(contact_normal_solver_query(solver, &info.it) == CONTACT_NORMAL_OK && info.it.mx == M && info.it.has_result == 1, "solver_query");
    check(contact_normal_solver_free(solver) == CONTACT_NORMAL_OK, "solver_free");
    scene.it.influence = NULL;
    for (int j = 0; j < M; j++) {
        for (int k = 0; k < M; k++) {
            memcpy(&row_tables[(j * M + k) * 2 * M], &table[(j >= k ? j - k + M : k - j + M) % (2 * M) * 2 * M], 2 * M * sizeof *table);
        }
    }
    rows.it.cx = M, rows.it.rows = M, rows.it.coefficients = row_tables;
    scene.it.row_tables = &rows.it;
    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_OK, "row_tables");
    scene.it.row_tables = NULL;

    /* An accuracy, and what it costs. */
    accuracy.it.target = 0.1, accuracy.it.surface = flat;
    check(contact_normal_solve_to_accuracy(&scene.it, &options.it, &accuracy.it, NULL, &report.it) == CONTACT_NORMAL_OK, "solve_to_accuracy");
    check(accuracy.it.mx >= M && accuracy.it.reached <= 0.1, "its grid");

    contact_normal_price prices[3];
    memset(prices, 0xAB, sizeof prices);
    contact_normal_price_init(prices);
    const double targets[2] = {0.1, 0.05};
    check(contact_normal_cost_of_accuracy(&scene.it, &options.it, &accuracy.it, CONTACT_NORMAL_QUANTITY_FORCE, 2, targets, prices) ==
              CONTACT_NORMAL_OK,
          "cost_of_accuracy");
    check(prices[0].target == 0.1 && prices[1].target == 0.05 && prices[1].struct_size == (int64_t)sizeof *prices, "its rows");
    check(((unsigned char *)&prices[2])[0] == 0xAB, "no row more");
    check(contact_normal_hertz(0.02, 0.02, scene.it.shear_modulus, scene.it.poisson_ratio, CONTACT_NORMAL_PRESCRIBED_APPROACH, 0.05, &hertz.it) ==
              CONTACT_NORMAL_OK,
          "hertz");
    check(hertz.it.force > 0.0, "its force");

    /* Friction. */
    friction.it.coefficient = 0.3, friction.it.creepage[0] = -1e-4;
    scene.it.friction = &friction.it;
    fields.it.stick_slip = stick_slip;
    fields.it.traction[0] = q[0], fields.it.traction[1] = q[1], fields.it.slip[0] = slip[0], fields.it.slip[1] = slip[1];
    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_OK, "friction");
    check(stick_slip[0] == CONTACT_NORMAL_STICK_SLIP_EXTERIOR && stick_slip[N / 2 + M / 2] != stick_slip[0], "stick_slip");
    const double entries[2][3] = {{-1e-4, 0.0, 0.0}, {-2e-4, 0.0, 0.0}};
    double forces[4];
    int32_t statuses[2];
    results.it.force = forces, results.it.status = statuses;
    check(contact_normal_solve_tangential(NULL, &scene.it, p, &options.it, 2, entries[0], &results.it, &report.it) == CONTACT_NORMAL_OK, "a table");
    check(forces[2] > forces[0] && forces[0] > 0.0, "its forces");
    check(contact_normal_solve_tangential(NULL, &scene.it, p, &options.it, 1, NULL, &results.it, &report.it) == CONTACT_NORMAL_OK, "one problem");
    check(forces[0] == report.it.tangential.force[0] && statuses[0] == CONTACT_NORMAL_OK, "its force");

    /* Stresses. */
    const double depths[1] = {0.5};
    stresses.it.von_mises = u;
    stresses.it.largest_von_mises = &largest.it;
    check(contact_normal_subsurface_stress(&scene.it, 1, p, NULL, NULL, depths, 1, &options.it, &stresses.it) == CONTACT_NORMAL_OK,
          "subsurface_stress");
    check(largest.it.value > 0.0 && largest.it.z == 0.5, "the largest");

#ifdef LATER
    struct {
        int64_t struct_size;
        double value;
    } effect_of_later;
    contact_normal_init(1000, &effect_of_later, (int64_t)sizeof effect_of_later);
    check(effect_of_later.struct_size == (int64_t)sizeof effect_of_later && effect_of_later.value == 0.0, "a struct that is not known");
    p[0] = -1.0;
    scene.it.added_last = &effect_of_later;
    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_STRUCT_SIZE, "a later effect is refused");
    check(strstr(contact_normal_last_error(), "scene sets the member at byte") != NULL && p[0] == -1.0, "by name");
    scene.it.added_last = NULL;
    options.it.added_later = 0.5;
    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_STRUCT_SIZE, "a later option is refused");
    check(strstr(contact_normal_last_error(), "options sets the member at byte") != NULL && p[0] == -1.0, "by name");
    options.it.added_later = 0.0;
    friction.it.added_later = 0.5;
    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_STRUCT_SIZE, "a later member of friction");
    check(strstr(contact_normal_last_error(), "friction sets the member at byte") != NULL && p[0] == -1.0, "by name");
    friction.it.added_later = 0.0;
    check(contact_normal_solve(&scene.it, &options.it, &fields.it, &report.it) == CONTACT_NORMAL_OK && p[0] == 0.0, "nothing of later");
#endif

    check(is_untouched(scene.guard) && is_untouched(options.guard) && is_untouched(fields.guard) && is_untouched(report.guard) &&
              is_untouched(accuracy.guard) && is_untouched(influence.guard) && is_untouched(rows.guard) && is_untouched(layer.guard) &&
              is_untouched(limit.guard) && is_untouched(period.guard) && is_untouched(patches.guard) && is_untouched(coating.guard) &&
              is_untouched(friction.guard) && is_untouched(results.guard) && is_untouched(stresses.guard) && is_untouched(largest.guard) &&
              is_untouched(hertz.guard) && is_untouched(shape.guard) &&
              is_untouched(info.guard),
          "what lies beyond the structs");
    if (failures == 0) puts("all as expected");
    return failures != 0;
}
