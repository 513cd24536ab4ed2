//! Which elements stick and which slip, by the natural map, and the tangents of their circles.
//!
//! ```text
//! tau = q - rho s;   slip where |tau| > g
//! n = tau/|tau|,  D = (|tau|/g - 1)/rho   on slip: |s|/g at the solution, the curvature of the circle
//! P v = v on stick,  v - n (n.v) on slip,  0 outside C
//! ```
//!
//! States come from the natural map and not from |q| = g: that makes the iterations robust. On a circle of radius g the slope of the
//! slip along the tangent is as if a layer of compliance D lay between the bodies.

use super::certificate::{relative, rest, scale, ON_THE_CIRCLE};
use super::problem::{dot, plus, square, Problem, State};
use super::vectors;
use super::Vector;
use crate::error::Result;
use crate::memory::zeros;

/// How fast the preconditioner leaves the inverse of A for that of D, as D grows beside the influence of an element on itself.
const MIXED: f64 = 0.5;

/// What an element does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// It is not in C.
    #[default]
    Outside,
    /// It sticks.
    Stick,
    /// It slips.
    Slip,
}

/// The prediction of the natural map.
#[derive(Default)]
pub struct Tangent {
    pub side: Vec<Side>,
    /// n, on slip.
    pub normal: Vec<Vector>,
    /// D; 0 where nothing slips.
    pub curvature: Vec<f64>,
    /// `P(-s)`.
    pub driving: Vec<Vector>,
    /// Elements that slip.
    pub slip_count: usize,
}

/// What a prediction saw.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// The residual of the certificate.
    pub residual: f64,
    /// `rms_C(max(0, |q| - g))/rms_C(g)`.
    pub excess: f64,
}

impl Tangent {
    /// Memory for n elements.
    pub fn new(n: usize) -> Result<Tangent> {
        let what = "the stick and slip areas";
        Ok(Tangent {
            side: zeros(n, what)?,
            normal: zeros(n, what)?,
            curvature: zeros(n, what)?,
            driving: zeros(n, what)?,
            slip_count: 0,
        })
    }

    /// Predicts from q and its displacements.
    pub fn predict(&mut self, problem: &Problem, state: &State, rho: f64) -> Sight {
        let (mut squares, mut excess) = (0.0, 0.0);
        self.slip_count = 0;
        for i in 0..problem.bound.len() {
            if !(problem.bound[i] > 0.0) {
                (self.side[i], self.curvature[i], self.driving[i]) = (Side::Outside, 0.0, [0.0; 2]);
                continue;
            }
            let (q, g, s) = (state.q[i], problem.bound[i], problem.slip_at(i, &state.u));
            let length = square(q).sqrt();
            squares += rest(s, q, length, length >= g * ON_THE_CIRCLE);
            excess += (length - g).max(0.0).powi(2);
            let tau = plus(q, -rho, s);
            let reach = square(tau).sqrt();
            if reach > g {
                let n = [tau[0] / reach, tau[1] / reach];
                self.slip_count += 1;
                (self.side[i], self.normal[i], self.curvature[i]) = (Side::Slip, n, (reach / g - 1.0) / rho);
                self.driving[i] = plus([-s[0], -s[1]], dot(s, n), n);
            } else {
                (self.side[i], self.curvature[i]) = (Side::Stick, 0.0);
                self.driving[i] = [-s[0], -s[1]];
            }
        }
        let rms = |sum: f64| (sum / problem.count().max(1) as f64).sqrt();
        Sight {
            residual: relative(rms(squares), scale(problem, state)),
            excess: relative(rms(excess), problem.rms_bound()),
        }
    }

    /// P v at element i, 0 outside C.
    #[inline]
    pub fn project_inside(&self, i: usize, v: Vector) -> Vector {
        match self.side[i] {
            Side::Slip => plus(v, -dot(v, self.normal[i]), self.normal[i]),
            Side::Stick => v,
            Side::Outside => [0.0; 2],
        }
    }

    /// P v at element i of C.
    #[inline]
    pub fn project(&self, i: usize, v: Vector) -> Vector {
        match self.side[i] {
            Side::Slip => plus(v, -dot(v, self.normal[i]), self.normal[i]),
            _ => v,
        }
    }

    /// `z = P(E X' M X E r) + (1 - E) r/(D + a0)`, `E = 1/(1 + D/(2 a0))`, for r of which P r = r and which is 0 outside C: the circulant
    /// inverse M of A with residuals continued beside C by X (see [`Extension`](super::extension::Extension)) and, where the curvature D
    /// dominates, its own inverse. In steady rolling, `B = A d`, with x of `d x = E M E r` in the place of the first term (see [`March`](super::march::March)).
    pub fn precondition(&self, problem: &mut Problem, r: &[Vector], unit: f64, mixed: &mut [Vector], z: &mut [Vector]) {
        let a0 = problem.operators.self_influence;
        let mixing = |i: usize| 1.0 / (1.0 + MIXED * self.curvature[i] / a0);
        let threads = problem.threads().clone();
        vectors::fill(&threads, mixed, |i| {
            let e = mixing(i);
            [e * r[i][0], e * r[i][1]]
        });
        // The march starts from nothing at each leading edge: what is beside C does not help it.
        let is_continued = problem.operators.rolling.is_none();
        if is_continued {
            problem.extension.fill(mixed);
        }
        problem.operators.precondition(mixed, unit, z);
        if is_continued {
            problem.extension.fold(z);
        }
        let own = |i: usize| (1.0 - mixing(i)) / (self.curvature[i] + a0);
        let Some((_, march)) = &problem.operators.rolling else {
            vectors::map(&threads, z, |i, z| {
                let e = mixing(i);
                plus(self.project_inside(i, [e * z[0], e * z[1]]), own(i), r[i])
            });
            return;
        };
        vectors::map(&threads, z, |i, z| {
            let e = mixing(i);
            self.project_inside(i, [e * z[0], e * z[1]])
        });
        march.solve(&problem.grid, self, mixing, &threads, z);
        vectors::map(&threads, z, |i, z| plus(z, own(i), r[i]));
    }
}
