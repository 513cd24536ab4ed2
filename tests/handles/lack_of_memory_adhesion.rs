//! After a lack of memory at any allocation of a solve with adhesion the next solve of the same solver is that of a new one: on small grids, and on large
//! ones, which keep fewer vectors.

use contact_normal::adhesion::{Law, Start};
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Adhesion, Bodies, Load, Scene, Work};
use contact_normal::solver::{Options, Outcome, Solver};

use super::alone;
use super::limited_memory::{self, release};

/// A sphere of radius 1 on a square of this half-width.
const HALF_WIDTH: f64 = 3.0;

/// Bytes of an allocation that counts, or one an element if that is more: what has the same size on any grid is less.
const LARGE: usize = 33_000;

struct Sphere {
    grid: Grid,
    h: Vec<f64>,
}

impl Sphere {
    /// On m x m elements.
    fn new(m: usize) -> Sphere {
        let d = 2.0 * HALF_WIDTH / m as f64;
        let at = |i: usize| (i as f64 + 0.5) * d - HALF_WIDTH;
        let h = (0..m * m).map(|i| 0.5 * (at(i % m).powi(2) + at(i / m).powi(2))).collect();
        Sphere { grid: Grid::new(m, m, d, d).expect("a grid"), h }
    }

    /// Tabor's parameter is 1.2.
    fn scene(&self, load: Load) -> Scene<'_> {
        let adhesion = Adhesion {
            law: Law::Exponential,
            work: Work::Uniform(0.32),
            range: 0.5,
            start: Start::Auto,
            stiffness: true,
            stability: true,
            shear_strength: 0.0,
        };
        let bodies = Bodies { shear_modulus: [0.375, f64::INFINITY], poisson_ratio: [0.0; 2] };
        Scene { adhesion: Some(adhesion), ..Scene::new(self.grid, &self.h, bodies, load) }
    }
}

/// The pressures of a solve.
fn solve(solver: &mut Solver, scene: &Scene<'_>, options: &Options) -> Result<Vec<f64>, Error> {
    let (outcome, _) = solver.solve(scene, options, None, None)?;
    assert_eq!(outcome, Outcome::Converged);
    Ok(solver.state().p.clone())
}

/// One failure after the other until a solve has all that it needs; of many every so many only.
fn fails_everywhere(m: usize, load: Load, all: usize) {
    let (sphere, options) = (Sphere::new(m), Options { threads: 1, ..Options::default() });
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
    fails_everywhere(96, Load::Approach(0.3), 40);
    fails_everywhere(96, Load::Force(-0.5), 40);
    fails_everywhere(182, Load::Force(-0.5), 20);
}
