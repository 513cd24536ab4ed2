//! Whichever allocation in a solve with adhesion fails, the next solve on the same solver equals that of a new one: on small grids, and on large
//! ones, for which the library keeps fewer vectors.

use contact_normal::adhesion::Law;
use contact_normal::error::Error;
use contact_normal::scene::{Adhesion, Load, Scene, Work};
use contact_normal::solver::{Options, Outcome, Solver};

use super::alone;
use super::limited_memory::{self, release};
use super::spheres::Sphere;

/// A sphere of radius 1 on a square of this half-width.
const HALF_WIDTH: f64 = 3.0;

/// The least size of an allocation that counts, unless one byte per element is more. Allocations whose size does not depend on the grid are smaller.
const LARGE: usize = 33_000;

/// A sphere on m x m elements. Tabor's parameter is 1.2.
fn sphere(m: usize) -> Sphere {
    let of = Sphere::new(m, HALF_WIDTH, Law::Exponential, 0.5);
    let adhesion = Adhesion { work: Work::Uniform(0.32), stiffness: true, stability: true, ..of.adhesion };
    Sphere { adhesion, ..of }
}

/// Solves, and returns the pressures.
fn solve(solver: &mut Solver, scene: &Scene<'_>, options: &Options) -> Result<Vec<f64>, Error> {
    let (outcome, _) = solver.solve(scene, options, None, None)?;
    assert_eq!(outcome, Outcome::Converged);
    Ok(solver.state().p.clone())
}

/// Lets one allocation after the other fail until a solve succeeds. If there are more than `all` of them, only some fail.
fn fails_everywhere(m: usize, load: Load, all: usize) {
    let (sphere, options) = (sphere(m), Options { threads: 1, ..Options::default() });
    let scene = sphere.scene(load);
    let expected = solve(&mut Solver::new(&scene, &options).unwrap(), &scene, &options).unwrap();
    let (mut failures, mut allowed) = (0, 0);
    loop {
        let mut solver = Solver::new(&scene, &options).unwrap();
        release();
        let solve_once = || solver.solve(&scene, &options, None, None).map(|_| ());
        match limited_memory::with(LARGE.max(m * m), allowed as u64, solve_once) {
            Ok(()) => break,
            Err(error) => assert!(matches!(error, Error::OutOfMemory(_)), "{m}, {allowed} allocations: {error}"),
        }
        failures += 1;
        let next = solve(&mut solver, &scene, &options).unwrap();
        assert!(next == expected, "{m}, {allowed} allocations: the next solve");
        allowed += 1 + allowed / all;
    }
    println!("{m} x {m}, {load:?}: {failures} failures, {allowed} allocations");
    assert!(failures > 20, "{m}: {failures}");
}

#[test]
fn after_a_lack_of_memory_adhesion_is_solved() {
    let _alone = alone();
    fails_everywhere(96, Load::Approach(0.3), 20);
    fails_everywhere(96, Load::Force(-0.5), 20);
    fails_everywhere(182, Load::Force(-0.5), 20);
}
