//! Unlike bodies whose contact is partly or fully at the pressure limit, or has one element. The normal conditions, including displacements by
//! tractions, are recomputed by direct sums.

use contact_normal::scene::{Bodies, Each, Friction, Load, Motion, Prescribed, PressureLimit, Scene};
use contact_normal::solver::{solve, Options, Outcome};

use super::unlike::{ball, Sums, RIGID_ON_SOFT};

/// Solves a scene. Returns the smallest tolerance for which the normal conditions hold, relative to the rms of `h - approach` in contact; the number
/// of elements at their limit; and the number of elements in contact.
fn normal_residual(sums: &Sums, scene: &Scene<'_>, tolerance: f64) -> (f64, usize, usize) {
    let (solver, stop, report) = solve(scene, &Options { tolerance, ..Options::default() }).unwrap();
    assert_eq!(stop, Outcome::Converged, "{:?}", scene.load);
    let (state, traction) = (solver.state(), &solver.friction().unwrap().traction);
    let (mut residual, mut distance, mut all, mut touching, mut violation) = (0.0, 0.0, 0.0, 0, 0.0_f64);
    let mut limited = 0;
    for (i, h) in scene.undeformed_distance.iter().enumerate() {
        let [by_q, by_p] = sums.displacements(i, traction, &state.p);
        let d = h - state.approach + by_q[2];
        let e = d + by_p[2];
        let p = state.p[i];
        assert!((state.deformed_distance(i) - e).abs() <= 1e-12, "{i}: {} {e}", state.deformed_distance(i));
        match scene.pressure_limit.map_or(f64::INFINITY, |limit| limit.0.at(i)) {
            _ if p == 0.0 => {
                violation = violation.max(-e);
                continue;
            }
            limit if p == limit => {
                violation = violation.max(e);
                limited += 1;
            }
            _ => (residual, distance) = (residual + e * e, distance + d * d),
        }
        (all, touching) = (all + d * d, touching + 1);
    }
    if let Load::Force(force) = scene.load {
        assert!((report.measures.force - force).abs() <= 1e-12 * force);
    }
    assert_eq!(report.measures.contact_count, touching);
    let scale = (all / touching as f64).sqrt();
    let residual = if distance == 0.0 { 0.0 } else { (residual / distance).sqrt() };
    (f64::max(residual, violation / scale), limited, touching)
}

#[test]
fn elements_at_their_limit_are_moved_by_tractions() {
    let (grid, h) = ball(16);
    let mut full = 0;
    for bodies in [RIGID_ON_SOFT, Bodies { shear_modulus: [4.0, 1.0], poisson_ratio: [0.4, 0.1] }] {
        let sums = Sums::new(16, &bodies);
        for motion in [Motion::Shift, Motion::TransientRolling, Motion::SteadyRolling] {
            let creepage = if motion == Motion::Shift { 0.2 } else { 0.5 };
            let prescribed = [Prescribed::Creepage(-creepage), Prescribed::Creepage(0.3 * creepage)];
            let friction = Friction { motion, prescribed, spin: 1e-3, ..Friction::new(0.5) };
            for limit in [5e-4, 1e-3, 4e-3, 0.03] {
                for load in [Load::Approach(0.02), Load::Approach(0.006), Load::Force(0.5 * limit)] {
                    let pressure_limit = Some(PressureLimit(Each::Uniform(limit)));
                    let plain = Scene::new(grid, &h, bodies, load);
                    let scene = Scene { friction: Some(friction), pressure_limit, ..plain };
                    let (residual, limited, touching) = normal_residual(&sums, &scene, 1e-6);
                    // .1 % of the tolerance allows for the different round-off of direct sums and FFT products.
                    assert!(residual <= 1.001e-6, "{bodies:?} {motion:?} {limit} {load:?}: {residual:e}");
                    full += usize::from(limited == touching);
                }
            }
        }
    }
    assert!(full >= 18, "{full} scenes at their limit everywhere");
}

/// The traction of the only element in contact displaces its neighbours along the normal, but not itself, so that they may come into contact.
#[test]
fn neighbours_of_a_single_element_are_moved_by_its_traction() {
    let (grid, mut h) = ball(5);
    h.iter_mut().for_each(|h| *h *= 20.0);
    let mut grown = 0;
    for bodies in [RIGID_ON_SOFT, Bodies { shear_modulus: [4.0, 1.0], poisson_ratio: [0.0, 0.4] }] {
        let sums = Sums::new(5, &bodies);
        for k in 0..20 {
            let scene = Scene::new(grid, &h, bodies, Load::Approach(2e-4 * f64::from(k + 25)));
            let (alone, ..) = solve(&scene, &Options::default()).unwrap();
            let before = alone.state().p.iter().filter(|p| **p > 0.0).count();
            let friction = Friction { prescribed: [Prescribed::Creepage(1.0); 2], ..Friction::new(0.9) };
            let (residual, _, touching) = normal_residual(&sums, &Scene { friction: Some(friction), ..scene }, 1e-8);
            assert!(residual <= 1.001e-8, "{k}: {residual:e}");
            grown += usize::from(before == 1 && touching > 1);
        }
    }
    assert!(grown > 0);
}
