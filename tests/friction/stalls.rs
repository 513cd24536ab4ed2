//! If the gradient method stalls, Newton's method continues, with a log message. Then the conditions hold.

use std::cell::Cell;

use contact_normal::friction::Request;
use contact_normal::solver::Outcome;
use log::{set_logger, set_max_level, LevelFilter, Log, Metadata, Record};

use super::scenes::Ellipse;
use super::support::{residual, solver};

thread_local! {
    /// How many log messages of this thread say that Newton's method continues.
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

/// Shifts with the tangential coefficients of nu = 0.999. No half-space has this nu, but a caller's tables may be like it: the coupling of x and y is
/// nearly as large as the displacement in the direction of the traction. The gradient method alone does not solve 18 of the first 30 scenes.
#[test]
fn where_gradients_stall_newtons_method_goes_on() {
    set_logger(&Listener).expect("the only logger of these tests");
    set_max_level(LevelFilter::Info);
    let mut stalls = 0;
    for seed in 0..12 {
        let case = Ellipse { nu: 0.999, ..Ellipse::random(seed, 24, false) };
        let mut solver = solver(&case.grid, case.nu);
        TOLD.set(0);
        let request = Request::new(&case.bound, &case.friction, 1e-6);
        let (end, report) = solver.solve(&request, &mut |_, _| true).unwrap();
        assert_eq!(end, Outcome::Converged, "{seed}");
        let found = (&report, solver.solution().unwrap());
        let none = vec![[0.0; 2]; case.grid.len()];
        let slip_residual = residual((&case.grid, case.nu), &case.bound, &case.friction, &none, found);
        // The tolerance of the solve, and 1e-9 for the different round-off of direct sums and FFT products.
        assert!(slip_residual <= 1.001e-6, "{seed}: {slip_residual}");
        stalls += u32::from(TOLD.get() > 0);
    }
    assert!(stalls >= 4, "gradients stalled in {stalls} scenes");
}
