//! A ball is pushed sideways, and then rolls with the same force until the tractions are steady. Compared with the output of CONTACT for its example
//! catt_to_cart (Kalker 1990, section 5.2.2.5), and with the steady solution.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Previous, Scene};
use contact_normal::solver::{solve, Options, Outcome, Report, Solver};

use super::case::{grid, paraboloid};

const M: usize = 33;
const FORCE: f64 = 0.4705;
const MU: f64 = 0.4013;

/// The ball: 33 x 33 elements of side 0.25 (CONTACT has a 34th column, which is never in contact), h = .002963 r^2.
fn ball() -> (Grid, Vec<f64>) {
    let grid = grid(M, M, 0.25, 0.25);
    (grid, paraboloid(&grid, 0.002963))
}

fn scene<'a>((grid, h): &'a (Grid, Vec<f64>), motion: Motion, previous: Previous<'a>, distance: f64) -> Scene<'a> {
    let friction = Friction {
        motion,
        previous,
        prescribed: [Prescribed::Force(-0.657 * MU * FORCE), Prescribed::Creepage(0.0)],
        rolling_distance: distance,
        ..Friction::new(MU)
    };
    Scene { friction: Some(friction), ..Scene::new(*grid, h, Bodies::same(1.0, 0.28), Load::Force(FORCE)) }
}

fn options() -> Options {
    Options { tolerance: 1e-8, ..Options::default() }
}

fn counts(report: &Report) -> (u64, u64) {
    let certificate = report.friction.as_ref().unwrap().certificate;
    (certificate.stick_count as u64, certificate.slip_count as u64)
}

/// Solves a shift, then `steps` steps of transient rolling. `tell` gets the number and the report of each step. Returns the largest difference
/// between the last tractions and those of steady rolling, relative to the largest mu p.
fn roll(steps: u32, distance: f64, tell: &mut dyn FnMut(u32, &Report)) -> f64 {
    let ball = ball();
    let (steady, outcome, report) =
        solve(&scene(&ball, Motion::SteadyRolling, Previous::None, distance), &options()).unwrap();
    assert_eq!(outcome, Outcome::Converged);
    let bound = MU * report.measures.max_pressure;
    let first = scene(&ball, Motion::Shift, Previous::None, 0.0);
    let mut solver = Solver::new(&first, &options()).unwrap();
    let (_, report) = solver.solve(&first, &options(), None, None).unwrap();
    tell(0, &report);
    for step in 1..=steps {
        let next = scene(&ball, Motion::TransientRolling, Previous::Kept, distance);
        let (outcome, report) = solver.solve(&next, &options(), None, None).unwrap();
        assert_eq!(outcome, Outcome::Converged, "{step}");
        tell(step, &report);
    }
    let (last, steady) = (solver.friction().unwrap(), steady.friction().unwrap());
    let apart = last.traction.iter().zip(&steady.traction).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
    apart.fold(0.0, f64::max) / bound
}

#[test]
fn contacts_onset_of_rolling_is_met() {
    // For each step: the shift or creepage that CONTACT printed, half a unit of its last digit, and the numbers of elements in stick and in slip.
    let printed = [
        (0, 1.774e-2, 5e-6, (305, 316)),
        (1, 1.824e-3, 5e-7, (422, 199)),
        (2, 1.882e-3, 5e-7, (420, 201)),
        (3, 1.955e-3, 5e-7, (416, 205)),
        (4, 2.050e-3, 5e-7, (406, 215)),
        (5, 2.140e-3, 5e-7, (405, 216)),
        (6, 2.221e-3, 5e-7, (395, 226)),
        (7, 2.334e-3, 5e-7, (390, 231)),
        (53, 3.101e-3, 5e-7, (346, 275)),
        (56, 3.101e-3, 5e-7, (346, 275)),
    ];
    let mut met = 0;
    let apart = roll(56, 0.25, &mut |step, report| {
        if let Some((_, creepage, half_a_digit, elements)) = printed.into_iter().find(|row| row.0 == step) {
            let found = report.friction.as_ref().unwrap().creepage[0];
            assert!((found - creepage).abs() <= half_a_digit, "{step}: {found}");
            assert_eq!(counts(report), elements, "{step}");
            met += 1;
        }
    });
    assert_eq!(met, printed.len());
    // The ball rolls over two lengths of the contact, one element a step. The difference is .59 after the first step, and in the end falls to a
    // quarter every 8 steps.
    assert!(apart <= 2e-4, "{apart}");
}

#[test]
fn the_onset_of_rolling_ends_at_steady_rolling() {
    // The ball rolls over four lengths of the contact, two elements a step.
    let apart = roll(56, 0.5, &mut |_, _| ());
    // With a residual of 1e-8 either solution has an error of some 1e-7 in the tractions.
    assert!(apart <= 1e-6, "{apart}");
}
