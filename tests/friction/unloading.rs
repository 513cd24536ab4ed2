//! Steps without a rigid slip in the contact. Previous tractions relax, and rigid slips outside the contact have no effect.

use contact_normal::friction::{Compliance, Tangential, Vector};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Previous, Scene};
use contact_normal::solver::{solve, Options, Outcome, Solver};

use super::dense;
use crate::support::ball;

const BODIES: Bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3; 2] };
const MU: f64 = 0.3;

fn solved(scene: &Scene<'_>, what: &str) -> (Solver, f64) {
    let (solver, outcome, report) = solve(scene, &Options::default()).unwrap_or_else(|why| panic!("{what}: {why}"));
    assert_eq!(outcome, Outcome::Converged, "{what}");
    (solver, report.friction.expect("friction").certificate.gap)
}

/// The displacements by tractions at places `by` elements from each centre, by direct sums.
fn displaced(grid: &Grid, by: f64, q: &[Vector]) -> Vec<Vector> {
    let tangential = Tangential::new(grid.dx, grid.dy, Compliance { shear: 1.0, poisson: 0.3, unlike: 0.0 });
    let mut u = vec![[0.0; 2]; q.len()];
    dense::apply(&tangential, grid, (by, 0.0), q, &mut u);
    u
}

/// Tractions as `[k][element]`, of all directions, `size` times the bound of an element under a unit pressure.
fn tractions(n: usize, size: f64) -> [Vec<f64>; 2] {
    let of = |i: usize, k: usize| size * ((i * 7919 + 104_729 * k) as f64).sin();
    [0, 1].map(|k| (0..n).map(|i| of(i, k)).collect())
}

/// Larger previous tractions have displacements with larger round-off, and so has the slip. Rolling steps without creepage must converge all the
/// same.
#[test]
fn tractions_relax_however_large_they_were() {
    let (grid, h) = ball(9, 1.0);
    let mut count = 0;
    for (motion, by) in [(Motion::Shift, 0.0), (Motion::TransientRolling, 1.5)] {
        for size in [1e-3, 1.0, 1e2, 1e4, 1e6] {
            let before = tractions(grid.len(), size);
            let friction = Friction {
                motion,
                rolling_distance: 1.5,
                prescribed: [Prescribed::Creepage(0.0); 2],
                previous: Previous::Given([&before[0], &before[1]]),
                ..Friction::new(MU)
            };
            let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, BODIES, Load::Force(0.3)) };
            let what = format!("{motion:?}, {size:e}");
            let (solver, gap) = solved(&scene, &what);
            let (p, q) = (&solver.state().p, &solver.friction().expect("tractions").traction);
            let pressed = |i: usize| p[i] > 0.0;
            let previous: Vec<Vector> = (0..grid.len()).map(|i| [before[0][i], before[1][i]]).collect();
            let (now, then) = (displaced(&grid, 0.0, q), displaced(&grid, by, &previous));
            let (mut lost, mut scale) = (0.0, 0.0);
            for i in (0..grid.len()).filter(|&i| pressed(i)) {
                let bound = MU * p[i];
                assert!(q[i][0].hypot(q[i][1]) <= bound, "{what}");
                let s = [now[i][0] - then[i][0], now[i][1] - then[i][1]];
                lost += s[0] * q[i][0] + s[1] * q[i][1] + bound * s[0].hypot(s[1]);
                scale += bound * then[i][0].hypot(then[i][1]);
            }
            // `scale` is the work of mu p over the displacements u' of the previous tractions. The tolerance is 1e-6 of a slip that in rolling is at
            // least 1.5e-8 of u'.
            assert!(lost <= 1e-5 * scale, "{what}: {lost:e} of {scale:e}");
            assert!((0.0..=1e-4).contains(&gap), "{what}: gap {gap:e}");
            count += 1;
        }
    }
    assert_eq!(count, 10);
}

/// Only a rigid slip in the contact counts as a motion. One outside must not be refused as a slip that is 1e-60 times the displacements.
#[test]
fn a_slip_beside_the_contact_is_no_motion() {
    let m = 9;
    let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
    let middle = |i: usize| (i % m).abs_diff(m / 2).max((i / m).abs_diff(m / 2)) <= 1;
    let (_, round) = ball(m, 1.0);
    let h: Vec<f64> = (0..m * m).map(|i| if middle(i) { 0.5 } else { 0.1 * round[i] }).collect();
    let slip: Vec<f64> = (0..m * m).map(|i| if middle(i) { 1e-3 } else { 0.0 }).collect();
    let none = vec![0.0; m * m];
    for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
        let prescribed = [Prescribed::Creepage(0.0); 2];
        let friction = Friction { motion, prescribed, rigid_slip: Some([&slip, &none]), ..Friction::new(MU) };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, BODIES, Load::Force(0.3)) };
        let (solver, gap) = solved(&scene, &format!("{motion:?}"));
        assert!(solver.state().contact.iter().enumerate().all(|(i, contact)| !(*contact && middle(i))), "{motion:?}");
        assert!(solver.friction().unwrap().traction.iter().all(|q| *q == [0.0; 2]), "{motion:?}");
        assert_eq!(gap, 0.0, "{motion:?}");
    }
}

/// A force of 0 is given beside a spin. The creepages cancel the slip of the only element, so that no work is done and the relative gap is 0/0.
#[test]
fn a_gap_without_work_is_a_number() {
    let grid = Grid::new(1, 1, 1.0, 1.0).unwrap();
    for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
        for k in 0..100 {
            let place = |seed: i32| f64::from((k * seed) % 97) / 97.0;
            let (spin, spin_centre) = (10f64.powi(k % 13 - 12) * (1.0 + place(31)), [place(17), place(59)]);
            let prescribed = [Prescribed::Force(0.0); 2];
            let friction = Friction { motion, prescribed, spin, spin_centre, ..Friction::new(MU) };
            let scene = Scene { friction: Some(friction), ..Scene::new(grid, &[0.0], BODIES, Load::Force(1e-3)) };
            let (_, gap) = solved(&scene, &format!("{motion:?} {spin}"));
            assert!((0.0..1e-6).contains(&gap), "{motion:?} {spin}: {gap}");
        }
    }
}
