//! The reported slope of a friction law with memory, and results with steep laws.

use contact_normal::grid::Grid;
use contact_normal::scene::{Branch, Fall, Friction, FrictionLaw};
use contact_normal::solver::Outcome;

use super::laws::{Wheel, RUNNING};
use super::laws_steep::Draw;
use super::laws_that_rise::{along, Scene, POISSON, TOLERANCE};
use super::support::tangential;

/// `law_slope` is the largest slope of an element's bound by its slip, including the memory of the particle's coefficient, times the influence of the
/// element on itself. It is compared with differences over a sequence of slips.
#[test]
fn the_slope_of_a_law_counts_its_memory() {
    let grid = Grid::new(1, 1, 1.0, 1.0).unwrap();
    let (own, mut draw) = (tangential(&grid, POISSON).at(0.0, 0.0)[0], Draw(4));
    for k in 0..60 {
        let (half, memory_distance) = (draw.between(0.01, 1.0), draw.between(0.01, 1.0));
        let fall = draw.one_of(&[Fall::Linear, Fall::Rational, Fall::Exponential]);
        let law = FrictionLaw {
            memory_distance,
            memory_speed: draw.one_of(&[0.0, 0.1]),
            ..FrictionLaw::new(fall, (0.1, 0.9), half, 1.0)
        };
        let had = draw.between(0.2, 1.0);
        let friction = Friction {
            prescribed: along(0.3),
            law: Some(law),
            coefficients_before: Some(std::slice::from_ref(&had)),
            ..Friction::new(0.5)
        };
        let scene = Scene { grid, pressure: &[1.0], friction };
        let bound = |slip: f64| scene.bound(0, slip, (had, 0.0)).0;
        let places = (0..200_000).map(|m| 1e-5 * 1.00008f64.powi(m) - 1e-5);
        let fall_of = |slip: f64| (bound(slip) - bound(slip + 1e-8)) / 1e-8;
        let exact = own * places.map(fall_of).fold(0.0, f64::max);
        let slope = scene.solve(TOLERANCE).1.law_slope;
        // The sequence of slips is fine enough to miss less than 1 % of the largest slope. The differences have an error of 1e-8.
        assert!((slope - exact).abs() <= 1e-2 * exact + 1e-6, "{k} {law:?} {had}: {slope} {exact}");
    }
}

/// If a single element has three solutions, its slope is above 1.
#[test]
fn an_element_with_three_solutions_has_a_slope_above_one() {
    let law = FrictionLaw {
        memory_distance: 0.4,
        time_step: 1.0,
        ..FrictionLaw::new(Fall::Exponential, (0.1, 0.9), 0.008, 1.0)
    };
    let mut slips = Vec::new();
    for branch in [Branch::Low, Branch::High] {
        let friction = Friction { prescribed: along(-0.47998), law: Some(law), branch, ..Friction::new(0.5) };
        let scene = Scene { grid: Grid::new(1, 1, 1.0, 1.0).unwrap(), pressure: &[1.0], friction };
        for tolerance in [1e-6, 1e-9] {
            let (end, report, found) = scene.solve(tolerance);
            println!("{branch:?} {tolerance} {end:?} {} {:?} {}", report.law_slope, found.slip, report.products);
            assert_eq!(end, Outcome::Converged);
            assert!((report.law_slope - 1.115).abs() <= 2e-3, "{}", report.law_slope);
            slips.push(found.slip[0][0].abs());
        }
    }
    assert!(slips[3] > 2.0 * slips[1], "{slips:?}");
}

/// If Newton's method ends without a solution, repeated solves of Coulomb's problem with updated coefficients find the solution of the branch LOW.
#[test]
fn a_steep_law_that_turns_solve_is_solved_without_a_branch() {
    let wheel = Wheel::new(1);
    let law = FrictionLaw { half_speed: [300.0, 1.0], memory_distance: 0.0, ..RUNNING };
    let [near, low] = [Branch::Near, Branch::Low].map(|branch| {
        let friction = Friction { branch, ..wheel.friction(0.004, 0.0, Some(law)) };
        wheel.ended(&friction, 1e-6)
    });
    println!("{} {} products, slope {}", near.1.products, low.1.products, near.1.law_slope);
    assert!(near.1.law_slope > 1.0);
    assert_eq!((near.0, low.0), (Outcome::Converged, Outcome::Converged));
    let [force, other] = [&near, &low].map(|ended| ended.1.force[0]);
    assert!((force - other).abs() <= 1e-4 * force.abs(), "{force} {other}");
}
