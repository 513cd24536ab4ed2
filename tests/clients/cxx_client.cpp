// The library from C++11: a progress callback that cancels, a log callback, the rows of the ledger.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "contact_normal.h"

static void expect(bool holds, const char *what) {
    if (!holds) {
        std::fprintf(stderr, "%s does not hold (last error: %s)\n", what, contact_normal_last_error());
        std::exit(EXIT_FAILURE);
    }
}

/// The paper's problem on m x m elements, with the arrays that it needs.
struct Problem {
    std::vector<double> h, p;
    std::vector<int32_t> contact;
    contact_normal_scene scene;
    contact_normal_options options;
    contact_normal_fields fields;
    contact_normal_report report;

    explicit Problem(int m) : h(static_cast<size_t>(m) * static_cast<size_t>(m)), p(h.size()), contact(h.size()) {
        contact_normal_scene_init(&scene);
        contact_normal_options_init(&options);
        contact_normal_fields_init(&fields);
        contact_normal_report_init(&report);
        scene.mx = scene.my = m;
        scene.dx = 20.0 / m;
        scene.dy = 12.0 / m;
        for (size_t i = 0; i < h.size(); i++) {
            const double x = (static_cast<double>(i % static_cast<size_t>(m)) + 0.5) * scene.dx - 10.0;
            const double y = (static_cast<double>(i / static_cast<size_t>(m)) + 0.5) * scene.dy - 6.0;
            h[i] = 0.0016681 * x * x + 0.0030671 * y * y;
        }
        scene.undeformed_distance = h.data();
        scene.shear_modulus[0] = scene.shear_modulus[1] = 82000.0;
        scene.poisson_ratio[0] = scene.poisson_ratio[1] = 0.28;
        scene.approach = 0.1091;
        fields.pressure = p.data();
        fields.contact = contact.data();
    }
    Problem(const Problem &) = delete; // the structs point into the vectors
    Problem &operator=(const Problem &) = delete;

    contact_normal_status solve() { return contact_normal_solve(&scene, &options, &fields, &report); }
};

struct Calls {
    int32_t finest;
    int on_finest;
};

extern "C" int32_t cancel_in_the_second_cycle(const contact_normal_progress *progress, void *user) {
    Calls &calls = *static_cast<Calls *>(user);
    expect(progress->struct_size == static_cast<int64_t>(sizeof *progress), "progress->struct_size is the header's");
    expect(std::isfinite(progress->update) && progress->seconds >= 0.0, "progress is finite");
    if (progress->mx != calls.finest) return 0;
    calls.on_finest++;
    return calls.on_finest == 2;
}

extern "C" void keep_message(int32_t level, const char *message, void *user) {
    if (level == CONTACT_NORMAL_LOG_INFO) static_cast<std::vector<std::string> *>(user)->push_back(message);
}

static void a_progress_callback_cancels() {
    Problem problem(64);
    Calls calls = {64, 0};
    problem.options.progress = cancel_in_the_second_cycle;
    problem.options.user = &calls;
    expect(problem.solve() == CONTACT_NORMAL_CANCELLED, "the status is CANCELLED");
    expect(calls.on_finest == 2, "the callback is not called after it cancelled");
    expect(problem.report.statistics.cycles == 2, "the report counts two cycles");
    double force = 0.0;
    for (double p : problem.p) {
        expect(std::isfinite(p), "the best iterate is finite");
        force += p * problem.scene.dx * problem.scene.dy;
    }
    // After nested iteration and two cycles: 1 % of the final force (Hertz), far more than the method leaves.
    expect(std::fabs(force - 81987.0) < 820.0, "the best iterate is near the solution");
    expect(std::string(contact_normal_last_error()).find("cancel") != std::string::npos, "the message says so");
}

static void the_log_says_what_was_done() {
    std::vector<std::string> messages;
    Problem problem(128);
    expect(contact_normal_set_log(keep_message, CONTACT_NORMAL_LOG_INFO, &messages) == CONTACT_NORMAL_OK, "set_log is OK");
    expect(problem.solve() == CONTACT_NORMAL_OK, "the problem is solved");
    expect(!messages.empty(), "the log callback was called");
    expect(messages.front().find("128 x 128") != std::string::npos, "the message names the grid");
    messages.clear();
    expect(contact_normal_set_log(nullptr, CONTACT_NORMAL_LOG_INFO, nullptr) == CONTACT_NORMAL_OK, "set_log NULL is OK");
    expect(problem.solve() == CONTACT_NORMAL_OK && messages.empty(), "no callback, no messages");
}

static void the_ledger_has_a_row_per_grid() {
    Problem problem(64);
    problem.options.method = CONTACT_NORMAL_METHOD_FULL_MULTIGRID;
    std::vector<contact_normal_ledger_row> rows(16);
    contact_normal_ledger_row_init(rows.data());
    problem.report.ledger = rows.data();
    problem.report.ledger_capacity = 16;
    expect(problem.solve() == CONTACT_NORMAL_OK, "the status is OK");
    // 64, 32, 16, 8, 4: the coarsest grid has at most 4 elements in each direction.
    expect(problem.report.ledger_rows == 5, "there are five grids");
    for (size_t i = 0; i < 5; i++) {
        expect(rows[i].mx == (4 << i) && rows[i].my == (4 << i), "the rows go from coarse to fine");
        expect(i == 0 || rows[i].seconds >= rows[i - 1].seconds, "time does not run back");
        expect(i == 0 || rows[i].work_units >= rows[i - 1].work_units, "nor does work");
    }
    expect(rows[4].force == problem.report.normal.force, "the last row holds the result's force");
    expect(rows[4].max_pressure == problem.report.normal.max_pressure, "and its largest pressure");

    // Too little room: the rows of the finest grids are written, and the report has the number of all rows.
    std::vector<contact_normal_ledger_row> few(3);
    few[2].mx = -1;
    contact_normal_ledger_row_init(few.data());
    problem.report.ledger = few.data();
    problem.report.ledger_capacity = 2;
    expect(problem.solve() == CONTACT_NORMAL_OK, "the status is OK with little room");
    expect(problem.report.ledger_rows == 5, "the report tells how many rows there are");
    expect(few[0].mx == 32 && few[1].mx == 64, "the finest grids are kept");
    expect(few[2].mx == -1, "no row beyond the room is written");
}

static void a_handle_has_an_owner() {
    Problem problem(32);
    contact_normal_solver *made = nullptr;
    expect(contact_normal_solver_new(&problem.scene, nullptr, &made) == CONTACT_NORMAL_OK, "solver_new is OK");
    std::unique_ptr<contact_normal_solver, contact_normal_status (*)(contact_normal_solver *)> solver(made, contact_normal_solver_free);
    expect(contact_normal_solver_solve(solver.get(), &problem.scene, nullptr, &problem.fields, &problem.report)
               == CONTACT_NORMAL_OK,
           "solver_solve is OK");
    expect(problem.report.normal.contact_count > 0, "there is contact");
}

int main() {
    expect(contact_normal_abi_version() >= CONTACT_NORMAL_ABI_VERSION, "the library is not older than the header");
    a_progress_callback_cancels();
    the_log_says_what_was_done();
    the_ledger_has_a_row_per_grid();
    a_handle_has_an_owner();
    std::printf("C++ client: all as expected\n");
    return EXIT_SUCCESS;
}
