//! Kinks of the surface within the contact. There the largest pressure grows as the logarithm of the number of elements, and its error is unknown.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Period, Scene};
use contact_normal::solver::{solve, solve_to_accuracy, Accuracy, Options, Outcome, Quantity};

const SIDE: f64 = 6.0;

/// A parabola with a slope that jumps by 2 `slope` at x = 0.2, on mx x my elements.
fn bent(mx: usize, my: usize, slope: f64) -> (Grid, Vec<f64>) {
    let grid = Grid::new(mx, my, SIDE / mx as f64, SIDE / my as f64).expect("a grid");
    let place = |k: usize, m: usize| if m == 1 { 0.0 } else { (k as f64 + 0.5) * SIDE / m as f64 - 0.5 * SIDE };
    let of = |i: usize| {
        let (x, y) = (place(i % mx, mx), place(i / mx, my));
        0.05 * (x * x + y * y) + slope * (x - 0.2).abs()
    };
    (grid, (0..grid.len()).map(of).collect())
}

/// Whether the error of the largest pressure is known, and the pressure.
fn largest((grid, h): &(Grid, Vec<f64>), is_line: bool) -> (bool, f64) {
    let bodies = Bodies::same(1.0, 0.3);
    let period = is_line.then_some(Period { x: true, y: true });
    let scene = Scene { period, ..Scene::new(*grid, h, bodies, Load::Force(0.4)) };
    let (_, outcome, report) = solve(&scene, &Options { estimates: true, ..Options::default() }).expect("a scene");
    assert_eq!(outcome, Outcome::Converged);
    (report.error.max_pressure.is_some(), report.measures.max_pressure)
}

/// The peak at the kink adds to the pressure of the parabola, which the elements resolve. The library must not report the error of the parabola's
/// pressure as that of the peak.
#[test]
fn the_largest_pressure_at_a_kink_has_no_error() {
    // On coarse grids, four doublings of the elements change the peak of a weak kink by less than the error of the parabola, so that this kink needs
    // finer grids.
    for (slope, coarsest) in [(0.005, 64), (0.02, 32)] {
        for m in [coarsest, 2 * coarsest] {
            let (is_known, pressure) = largest(&bent(m, m, slope), false);
            assert!(!is_known, "{slope} on {m} x {m}: {pressure}");
        }
        for m in [2 * coarsest, 8 * coarsest] {
            let (is_known, pressure) = largest(&bent(m, 1, slope), true);
            assert!(!is_known, "{slope} on {m}: {pressure}");
        }
    }
    // The peak at a kink grows by E* s ln 2/(2 pi) for each doubling of the elements, s the jump of the slope (here 2 times 0.02).
    let [coarse, fine] = [64, 4096].map(|m| largest(&bent(m, 1, 0.02), true).1);
    let modulus = 1.0 / (1.0 - 0.3);
    let expected = 6.0 * modulus * 0.04 * 2.0_f64.ln() / (2.0 * std::f64::consts::PI);
    // 30 %: the kink may lie anywhere within its element.
    assert!(((fine - coarse) / expected - 1.0).abs() < 0.3, "{coarse} {fine}: {expected}");
    // The error is known without a kink, and with a concave kink, which carries no pressure.
    for slope in [0.0, -0.03] {
        for m in [64, 128] {
            assert!(largest(&bent(m, m, slope), false).0, "{slope} on {m} x {m}");
        }
    }
}

/// A search for the largest pressure does not end as converged here, because the error is unknown.
#[test]
fn a_search_at_a_kink_does_not_say_that_it_is_done() {
    let (grid, h) = bent(32, 32, 0.02);
    let scene = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(0.4));
    let accuracy = Accuracy { max_elements: 40_000, ..Accuracy::new(0.05).with(Quantity::MaxPressure, 0.1) };
    let mut surface = |grid: &Grid, out: &mut [f64]| {
        out.copy_from_slice(&bent(grid.mx, grid.my, 0.02).1);
        false
    };
    let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, Some(&mut surface), None).expect("a scene");
    assert_ne!(found.stop, Outcome::Converged, "{}", found.reason);
    assert!(found.reason.contains("for max_pressure is not known"), "{}", found.reason);
}
