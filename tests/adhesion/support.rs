//! Spheres in the units of Johnson, Kendall and Roberts, and certificates by products that do not use the library.
//!
//! R = 1, w = 1/pi and E* = 3/4 give forces in pi w R, radii in (pi w R^2/K)^(1/3), and approaches in (pi^2 w^2 R/K^2)^(1/3), with K = 4/3 E* = 1.

use std::f64::consts::PI;

use contact_normal::adhesion::{Law, Report, Start};
use contact_normal::grid::Grid;
use contact_normal::scene::{Adhesion, Bodies, Load, Scene, Work};
use contact_normal::solver::{self, Options, Outcome, Solver};

/// The modulus E* of the sphere in these units.
pub const MODULUS: f64 = 0.75;

/// Two bodies with a given E*, one of them rigid.
pub fn bodies(modulus: f64) -> Bodies {
    // 1/E* = (1 - nu)/(2 G) of the elastic body.
    Bodies { shear_modulus: [0.5 * modulus, f64::INFINITY], poisson_ratio: [0.0; 2] }
}

/// Adhesion with a uniform work of adhesion, and the other members at their defaults.
pub fn adhesion(law: Law, work: f64, range: f64) -> Adhesion<'static> {
    let (work, start) = (Work::Uniform(work), Start::Auto);
    Adhesion { law, work, range, start, stiffness: false, stability: false, shear_strength: 0.0 }
}

/// A sphere on a square grid.
pub struct Sphere {
    pub grid: Grid,
    pub h: Vec<f64>,
    pub adhesion: Adhesion<'static>,
}

impl Sphere {
    /// A sphere on n x n elements of a square with this half-width.
    pub fn new(n: usize, half_width: f64, law: Law, range: f64) -> Sphere {
        let d = 2.0 * half_width / n as f64;
        let grid = Grid::new(n, n, d, d).expect("a grid");
        let at = |i: usize| (i as f64 + 0.5) * d - half_width;
        let h = (0..n * n).map(|i| 0.5 * (at(i % n).powi(2) + at(i / n).powi(2))).collect();
        Sphere { grid, h, adhesion: adhesion(law, 1.0 / PI, range) }
    }

    /// A sphere with the exponential law, by Tabor's parameter (R w^2/E*^2)^(1/3)/rho.
    pub fn by_tabor(tabor: f64, n: usize, half_width: f64) -> Sphere {
        Sphere::new(n, half_width, Law::Exponential, range_of(tabor))
    }

    pub fn scene(&self, load: Load) -> Scene<'_> {
        Scene { adhesion: Some(self.adhesion), ..Scene::new(self.grid, &self.h, bodies(MODULUS), load) }
    }

    /// Solves without a guess.
    pub fn solve(&self, load: Load) -> (Solver, Found) {
        let (solver, outcome, report) = solver::solve(&self.scene(load), &Options::default()).expect("a solve");
        assert_eq!(outcome, Outcome::Converged, "{load:?}");
        let found = Found::of(&report);
        (solver, found)
    }
}

/// The range rho for Tabor's parameter.
pub fn range_of(tabor: f64) -> f64 {
    (1.0 / (PI * MODULUS).powi(2)).cbrt() / tabor
}

/// The result of a solve.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    pub force: f64,
    pub work_units: f64,
    pub products: u64,
    pub adhesion: Report,
}

impl Found {
    pub fn of(report: &solver::Report) -> Found {
        Found {
            force: report.measures.force,
            work_units: report.count.work_units,
            products: report.count.matrix_products,
            adhesion: report.adhesion.expect("a scene with adhesion"),
        }
    }
}
