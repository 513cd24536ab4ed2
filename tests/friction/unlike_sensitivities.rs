//! Derivatives of the forces of unlike bodies compared with central differences of whole solves, in which the tractions change the pressures.

use contact_normal::scene::{Bodies, Each, Friction, Load, Motion, Prescribed, PressureLimit, Previous, Scene};
use contact_normal::solver::{solve, Options, Outcome};

use super::case::paraboloid;
use super::unlike::RIGID_ON_SOFT;

/// Half the step of a central difference, relative to a motion of full slip. It is so small that hardly any element changes between stick and slip.
const STEP: f64 = 1e-5;

fn at(scene: &Scene<'_>, creepage: [f64; 2], spin: f64, sensitivities: bool) -> ([f64; 3], Option<[[f64; 3]; 3]>) {
    let prescribed = creepage.map(Prescribed::Creepage);
    let friction = Friction { prescribed, spin, sensitivities, ..scene.friction.unwrap() };
    let scene = Scene { friction: Some(friction), ..scene.clone() };
    // The differences are 1e-5 of the forces, and must be accurate to 1e-5: the error of the forces at a residual of 1e-11 is smaller.
    let (_, stop, report) = solve(&scene, &Options { tolerance: 1e-11, ..Options::default() }).unwrap();
    assert_eq!(stop, Outcome::Converged);
    let found = report.friction.unwrap();
    ([found.force[0], found.force[1], found.moment], found.sensitivities)
}

/// The largest error of a derivative, relative to the largest derivative, with moments and spins in units of the radius.
fn off(scene: &Scene<'_>, creepage: [f64; 2], spin: f64, (size, radius): (f64, f64)) -> f64 {
    let found = at(scene, creepage, spin, true).1.expect("derivatives");
    let (mut off, mut largest) = (0.0_f64, 0.0_f64);
    for by in 0..3 {
        let unit = if by == 2 { radius } else { 1.0 };
        let step = STEP * size / unit;
        let mut change = [0.0; 3];
        change[by] = step;
        let shifted = |sign: f64| {
            let [x, y, spin_by] = change.map(|step| sign * step);
            at(scene, [creepage[0] + x, creepage[1] + y], spin + spin_by, false).0
        };
        let (up, down) = (shifted(1.0), shifted(-1.0));
        for k in 0..3 {
            let difference = (up[k] - down[k]) / (2.0 * step);
            let in_units = if k == 2 { unit * radius } else { unit };
            off = off.max((found[k][by] - difference).abs() / in_units);
            largest = largest.max(difference.abs() / in_units);
        }
    }
    off / largest
}

#[test]
fn derivatives_are_those_of_whole_solves() {
    let m = 22;
    let grid = contact_normal::grid::Grid::new(m, m, 0.5, 0.4).unwrap();
    let place = |i: usize| ((i % m) as f64 - 10.4, (i / m) as f64 - 10.6);
    let h: Vec<f64> = (0..grid.len()).map(|i| 0.01 * (0.25 * place(i).0.powi(2) + 0.16 * place(i).1.powi(2))).collect();
    let small = vec![2e-3; grid.len()];
    let all = [RIGID_ON_SOFT, Bodies { shear_modulus: [4.0, 1.0], poisson_ratio: [0.4, 0.1] }];
    for (bodies, mu) in all.into_iter().zip([0.9, 0.4]) {
        for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
            for (load, limit, previous) in [
                (Load::Approach(0.12), None, Previous::None),
                (Load::Force(1.5), None, Previous::None),
                (Load::Approach(0.12), Some(0.045), Previous::None),
                (Load::Force(1.0), Some(0.045), Previous::Given([&small, &small])),
            ] {
                let friction = Friction { motion, previous, ..Friction::new(mu) };
                let scene = Scene {
                    friction: Some(friction),
                    pressure_limit: limit.map(|limit| PressureLimit(Each::Uniform(limit))),
                    ..Scene::new(grid, &h, bodies, load)
                };
                // Parts of a motion of full slip, from little slip to full slip.
                let size = if motion == Motion::Shift { 0.1 * mu } else { 0.05 * mu };
                for part in [0.15, 0.5, 1.5] {
                    let off = off(&scene, [-part * size, 0.4 * part * size], 0.02 * part * size, (size, 3.0));
                    // The linear systems are solved to 1e-5. Derivatives with fixed pressures would differ by .05 to .5, so that the test sees the
                    // coupling.
                    assert!(off <= 3e-5, "{bodies:?} {motion:?} {load:?} {limit:?} {part}: {off:e}");
                }
            }
        }
    }
}

/// Without slip, or without any force, derivatives are numbers: nothing is divided by 0.
#[test]
fn derivatives_without_slip_and_without_force_are_numbers() {
    let m = 12;
    let grid = contact_normal::grid::Grid::new(m, m, 0.5, 0.5).unwrap();
    let h = paraboloid(&grid, 0.04);
    for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
        for load in [Load::Approach(0.1), Load::Force(0.4), Load::Approach(-1.0), Load::Force(0.0)] {
            for mu in [0.0, 0.5, 0.9] {
                let friction = Friction { motion, ..Friction::new(mu) };
                let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, RIGID_ON_SOFT, load) };
                let (force, found) = at(&scene, [-1e-3, 5e-4], 1e-5, true);
                let found = found.expect("derivatives");
                assert!(found.iter().flatten().all(|value| value.is_finite()), "{found:?}");
                let nothing = mu == 0.0 || matches!(load, Load::Approach(-1.0) | Load::Force(0.0));
                assert!(!nothing || force == [0.0; 3] && found == [[0.0; 3]; 3], "{force:?} {found:?}");
                assert!(nothing || found[0][0] < 0.0 && found[1][1] < 0.0, "{found:?}");
            }
        }
    }
}
