//! The prediction of stick and slip by the natural map, and the linearisation of the slip condition.
//!
//! ```text
//! tau = q - rho s;                        an element slips if |tau| > g
//! n = tau/|tau|,  D = (|tau|/g - 1)/rho   on slip; at the solution D = |s|/g
//! P v = v on stick,  v - n (n.v) on slip,  0 outside C
//! ```
//!
//! The natural map tau, and not |q| = g, decides whether an element slips, which makes the iterations robust. If the traction of a slipping element
//! moves along its circle, the direction of the slip follows: the slip changes as by a layer of compliance D between the bodies. D is called the
//! curvature.
//!
//! For tractions near their circle n is q/|q| and `D = -(n.s)/g`, which is the same at the solution. Then the step onto the circle is the shortest,
//! of second order in the error.

use super::certificate::rest;
use super::plane::{add, dot, plus, square, Vector};
use super::problem::{Problem, State};
use crate::contact::relative;
use crate::error::Result;
use crate::memory::zeros;
use crate::methods::fields::{self, BLOCK};

/// The factor on D/a0 in `E = 1/(1 + CURVATURE_WEIGHT D/a0)`. In the preconditioner E is the weight of the approximate inverse of A, and 1 - E that
/// of the inverse of D + a0.
pub(super) const CURVATURE_WEIGHT: f64 = 0.5;

/// A traction is near its circle if |q| differs from g by at most this part of g.
pub(super) const NEAR_THE_CIRCLE: f64 = 0.2;
/// Near the circle n is q/|q| only if the cosine of the angle between q and tau is at least this. A traction that points along its slip has to
/// reverse, so its n is that of tau.
pub(super) const ALIGNED: f64 = 0.9;

/// Whether an element is predicted to stick or to slip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The element is not in C.
    #[default]
    Outside,
    /// The element sticks.
    Stick,
    /// The element slips.
    Slip,
}

/// The prediction of the natural map on a grid.
#[derive(Default)]
pub struct Tangent {
    pub side: Vec<Side>,
    /// The normal n of the circle on slip; 0 on stick, undefined outside C.
    pub normal: Vec<Vector>,
    /// The curvature D on slip; 0 elsewhere.
    pub curvature: Vec<f64>,
    /// The weight E of the preconditioner. On stick it is 1, unless a layer between the bodies is softer there than elsewhere.
    pub mixing: Vec<f64>,
    /// The projected residual `P(-s)`.
    pub projected: Vec<Vector>,
    /// The number of elements that slip.
    pub slip_count: usize,
}

/// How well a state meets the conditions of friction.
#[derive(Clone, Copy, Debug)]
pub struct Measures {
    /// The residual of the certificate.
    pub residual: f64,
    /// The excess of tractions over their bounds, `rms_C(max(0, |q| - g))/rms_C(g)`.
    pub excess: f64,
}

/// The prediction for one element of C. The fields are those of [`Tangent`]; n is 0 on stick.
pub(super) struct Prediction {
    pub side: Side,
    pub normal: Vector,
    pub curvature: f64,
    pub projected: Vector,
    /// The square of the residual slip.
    pub rest: f64,
}

/// Predicts stick or slip of an element with q, s and the bound g.
#[inline]
pub(super) fn predict_element((q, s): (Vector, Vector), g: f64, (rho, inverse_rho): (f64, f64)) -> Prediction {
    let (tau, against, rest) = (plus(q, -rho, s), [-s[0], -s[1]], rest(s, q, g));
    if !(square(tau) > g * g) {
        return Prediction { side: Side::Stick, normal: [0.0; 2], curvature: 0.0, projected: against, rest };
    }
    let (normal, curvature) = normal_and_curvature((q, s), g, tau, inverse_rho);
    Prediction { side: Side::Slip, normal, curvature, projected: plus(against, dot(s, normal), normal), rest }
}

/// The rho of the natural map with which rho times the rms slip is the rms bound, but at most `most`.
pub(super) fn rho_of((bound, slip): (f64, f64), most: f64) -> f64 {
    if slip > 0.0 {
        most.min(bound / slip)
    } else {
        most
    }
}

/// E of the preconditioner for the curvature D. `a0` is the influence of an element on itself.
#[inline]
pub(super) fn mixing(curvature: f64, a0: f64) -> f64 {
    1.0 / (1.0 + CURVATURE_WEIGHT * curvature / a0)
}

/// P v, with the normal n. On stick n is 0, and P v is v.
#[inline]
pub(super) fn project(n: Vector, v: Vector) -> Vector {
    plus(v, -dot(v, n), n)
}

/// n and D of a slipping element.
#[inline]
fn normal_and_curvature((q, s): (Vector, Vector), g: f64, tau: Vector, inverse_rho: f64) -> (Vector, f64) {
    let (length, reach) = (square(q).sqrt(), square(tau).sqrt());
    if (length - g).abs() <= NEAR_THE_CIRCLE * g && dot(q, tau) >= ALIGNED * length * reach {
        let n = q.map(|q| q / length);
        return (n, (-dot(n, s) / g).max(0.0));
    }
    (tau.map(|tau| tau / reach), (reach / g - 1.0) * inverse_rho)
}

impl Tangent {
    /// Allocates memory for n elements, unless it is allocated already.
    pub fn fit(&mut self, n: usize) -> Result<()> {
        let what = "the stick and slip areas";
        if self.projected.len() != n {
            self.normal = zeros(n, what)?;
            self.curvature = zeros(n, what)?;
            self.mixing = zeros(n, what)?;
            self.side = zeros(n, what)?;
            self.projected = zeros(n, what)?;
        }
        Ok(())
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let each = size_of::<Side>() + 2 * size_of::<f64>() + 2 * size_of::<Vector>();
        self.projected.capacity() * each
    }

    /// Predicts stick and slip of all elements from q and u. Returns the measures of this state.
    pub fn predict(&mut self, problem: &Problem, state: &State, rho: f64) -> Measures {
        let (u, a0, inverse_rho) = (&state.u, problem.operators.self_influence, 1.0 / rho);
        // In steady rolling a0 is the self-influence of a step. The excess of a layer is scaled by the same ratio to that without rolling.
        let share = a0 / problem.operators.greatest();
        let beyond = |i: usize| problem.operators.excess.as_ref().map_or(0.0, |excess| share * excess.at(i));
        let Tangent { side, normal, curvature, mixing: mixings, projected, .. } = self;
        let (sides, normals) = (side.chunks_mut(BLOCK), normal.chunks_mut(BLOCK));
        let (curvatures, mixings, projecteds) =
            (curvature.chunks_mut(BLOCK), mixings.chunks_mut(BLOCK), projected.chunks_mut(BLOCK));
        let blocks = sides.zip(normals).zip(curvatures.zip(mixings)).zip(projecteds);
        let sums =
            fields::over(problem.threads(), blocks, |start, (((side, normal), (curvature, mixings)), projected)| {
                let [mut squares, mut excess, mut slips, mut rigid, mut displaced] = [0.0; 5];
                for k in 0..side.len() {
                    let i = start + k;
                    let g = problem.bound[i];
                    if !(g > 0.0) {
                        // Writes only if needed: most elements outside C were outside before.
                        if side[k] != Side::Outside {
                            (side[k], curvature[k], projected[k]) = (Side::Outside, 0.0, [0.0; 2]);
                        }
                        continue;
                    }
                    let (q, s) = (state.q[i], problem.slip_at(i, u));
                    if square(q) > g * g {
                        excess += (square(q).sqrt() - g).powi(2);
                    }
                    rigid += square(add(problem.rigid[i], problem.weighted(i, problem.offset)));
                    displaced += square(u[i]);
                    let predicted = predict_element((q, s), g, (rho, inverse_rho));
                    squares += predicted.rest;
                    slips += f64::from(u8::from(predicted.side == Side::Slip));
                    (side[k], normal[k], projected[k]) = (predicted.side, predicted.normal, predicted.projected);
                    (curvature[k], mixings[k]) = (predicted.curvature, mixing(predicted.curvature + beyond(i), a0));
                }
                [squares, excess, slips, rigid, displaced]
            });
        self.slip_count = sums[2] as usize;
        let [squares, excess, _, rigid, displaced] = sums.map(|sum| (sum / problem.count().max(1) as f64).sqrt());
        let scale = problem.compared(rigid, displaced);
        Measures { residual: relative(squares, scale), excess: relative(excess, problem.rms_bound()) }
    }

    /// P v of element i.
    #[inline]
    pub fn project_inside(&self, i: usize, v: Vector) -> Vector {
        match self.side[i] {
            Side::Slip => project(self.normal[i], v),
            Side::Stick => v,
            Side::Outside => [0.0; 2],
        }
    }

    /// The preconditioner of Newton's systems, for residuals r = P r. z is 0 outside C.
    ///
    /// ```text
    /// z = P(E X' M X E r) + (1 - E) r/(D + a0),    E = 1/(1 + D/(2 a0))
    /// ```
    ///
    /// M is the inverse of a circulant near A. X extends residuals beyond C (see [`Extension`](crate::methods::extension::Extension)). The second
    /// term is a diagonal inverse where the curvature D dominates. The excess compliance of a layer adds to D. In steady rolling, where `B = A d`,
    /// the first term is the solution z of `d z = E M E r` (see [`Sweep`](super::sweep::Sweep)).
    pub fn precondition(&self, problem: &mut Problem, r: &[Vector], unit: f64, mixed: &mut [Vector], z: &mut [Vector]) {
        let a0 = problem.operators.self_influence;
        let threads = problem.threads().clone();
        self.invert(problem, r, unit, mixed, z);
        // `own` is the factor of the diagonal inverse. It is not 0 on slip and where a layer is softer than elsewhere.
        let beyond = |i: usize| problem.operators.excess.as_ref().map_or(0.0, |excess| excess.at(i));
        let own = |i: usize| match self.side[i] {
            Side::Outside => 0.0,
            _ if self.mixing[i] == 1.0 => 0.0,
            _ => (1.0 - self.mixing[i]) / (self.curvature[i] + beyond(i) + a0),
        };
        let Some((_, sweep)) = &problem.operators.rolling else {
            fields::map(&threads, z, |i, z| plus(self.project_inside(i, z.map(|z| self.mixing[i] * z)), own(i), r[i]));
            return;
        };
        fields::map(&threads, z, |i, z| self.project_inside(i, z.map(|z| self.mixing[i] * z)));
        let project = |i: usize, v: Vector| self.project_inside(i, v);
        if problem.operators.excess.is_none() {
            sweep.solve(&problem.grid, |i| self.mixing[i], project, &threads, z);
            return fields::map(&threads, z, |i, z| plus(z, own(i), r[i]));
        }
        // In steady rolling d also acts on the displacement of the layer. So the sweep solves for (a + r) z, where r is the excess of each element.
        let a = problem.operators.greatest();
        let soft = |i: usize| (a + beyond(i)) / a;
        let of_layer = |i: usize| match self.side[i] {
            Side::Stick => (1.0 - self.mixing[i]) / (a + beyond(i)),
            _ => 0.0,
        };
        fields::map(&threads, z, |i, z| plus(z, of_layer(i), r[i]).map(|z| soft(i) * z));
        sweep.solve(&problem.grid, |i| mixing(self.curvature[i], a0 * soft(i)), project, &threads, z);
        let after = |i: usize| if self.side[i] == Side::Slip { own(i) } else { 0.0 };
        fields::map(&threads, z, |i, z| plus(z.map(|z| z / soft(i)), after(i), r[i]));
    }

    /// Computes `z = X' M X E r`, which is undefined outside C. `mixed` is scratch.
    fn invert(&self, problem: &mut Problem, r: &[Vector], unit: f64, mixed: &mut [Vector], z: &mut [Vector]) {
        let (threads, n) = (problem.threads().clone(), r.len());
        let compliance = problem.operators.relative_compliance();
        let Problem { operators, extension, .. } = problem;
        // Steady rolling has no extension: the sweep starts from 0 at each leading edge, so that values outside C do not help.
        let Some(extension) = extension else {
            fields::fill(&threads, mixed, |i| r[i].map(|r| self.mixing[i] * r));
            return operators.precondition(mixed, unit, z);
        };
        // The components of a field are stored one after the other, in the memory of z and of `mixed`.
        let (x, y) = z.as_flattened_mut().split_at_mut(n);
        for (component, values) in [&mut *x, &mut *y].into_iter().enumerate() {
            threads.for_each_plain_row(values, BLOCK, |k, values| {
                let factors = self.mixing[k * BLOCK..].iter().zip(&r[k * BLOCK..]);
                values.iter_mut().zip(factors).for_each(|(value, (mixing, r))| *value = mixing * r[component]);
            });
        }
        let (to_x, to_y) = mixed.as_flattened_mut().split_at_mut(n);
        let apply = |r: [&[f64]; 2], z: [&mut [f64]; 2]| operators.precondition_components(r, unit, z);
        extension.between([x, y], [&mut *to_x, &mut *to_y], compliance, apply);
        fields::fill(&threads, z, |i| [to_x[i], to_y[i]]);
    }
}
