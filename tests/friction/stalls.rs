//! Where gradients stall, Newton's method goes on: what is logged, and that the conditions hold.

use std::cell::Cell;

use contact_normal::friction::Request;
use contact_normal::solver::Outcome;
use log::{set_logger, set_max_level, LevelFilter, Log, Metadata, Record};

use super::scenes::Ellipse;
use super::support::{residual, solver};

thread_local! {
    /// How often this thread was told that Newton's method goes on.
    static TOLD: Cell<u32> = const { Cell::new(0) };
}

struct Listener;

impl Log for Listener {
    fn enabled(&self, _: &Metadata<'_>) -> bool {
        true
    }

    fn log(&self, record: &Record<'_>) {
        if record.args().to_string().contains("no further progress, Newton's method goes on") {
            TOLD.set(TOLD.get() + 1);
        }
    }

    fn flush(&self) {}
}

/// Shifts on elements 30 and 300 times as long as wide, to 1e-11: single precision does not carry the gradients that far.
#[test]
fn where_gradients_stall_newtons_method_goes_on() {
    set_logger(&Listener).expect("the only logger of these tests");
    set_max_level(LevelFilter::Info);
    let mut scenes = 0;
    for (seed, longer) in [(12, 30.0), (12, 300.0), (21, 300.0), (36, 30.0), (36, 300.0), (51, 30.0), (51, 300.0)] {
        let mut case = Ellipse::random(seed, 24, false);
        case.grid.dx *= longer;
        let mut solver = solver(&case.grid, case.nu);
        TOLD.set(0);
        let request = Request::new(&case.bound, &case.friction, 1e-11);
        let (end, report) = solver.solve(&request, &mut |_, _| true).unwrap();
        assert_eq!(end, Outcome::Converged, "{seed} {longer}");
        assert!(report.certificate.stick_count > 0 && report.certificate.slip_count > 0, "{seed} {longer}");
        let found = (&report, solver.solution().unwrap());
        let none = vec![[0.0; 2]; case.grid.len()];
        let left = residual((&case.grid, case.nu), &case.bound, &case.friction, &none, found);
        // The tolerance, and round-off of two products.
        assert!(left <= 1.001e-11, "{seed} {longer}: {left}");
        scenes += u32::from(TOLD.get() > 0);
    }
    assert!(scenes > 0, "gradients never stalled");
}
