//! Semismooth Newton: where forces are given, and where the projected gradients stall.
//!
//! With the prediction of [`Tangent`] (P, D, n) and x0 the way to the circles, each step solves
//!
//! ```text
//! (P A P + D) z + sum_k dc_k P e_k = P(-(s + A x0)),        x0 = g n - q on slip
//!                            sum z = F/(dx dy) - sum(q + x0)        for each direction k whose force is given
//! ```
//!
//! with B for A in steady rolling, by flexible GMRES, with the preconditioner of the gradients, bordered by the creepages dc. Then `q += x0 + z`: no line search and no
//! projection between steps (Alart and Curnier 1991; Christensen 2002).

use super::certificate::scale;
use super::fgmres::{self, Bordered, Direction, System};
use super::problem::{add, plus, square, Problem, State};
use super::shift::{End, Goal};
use super::tangent::{Side, Tangent};
use super::Vector;
use crate::error::{Error, Result};

/// The inner residual relative to that of the step.
const INNER: f64 = 0.15;
const INNER_ROLLING: f64 = 0.2;
/// The last step need not be solved further than to this part of the tolerance.
const ENOUGH: f64 = 0.5;
/// It and rho are cut by this when steps bring nothing, down to the least.
const CUT: f64 = 0.3;
const LEAST_INNER: f64 = 0.01;
/// Steps without the residual falling to this part of its least.
const PATIENCE: u32 = 4;
const PROGRESS: f64 = 0.7;
/// Cuts without progress after which the steps end.
const MOST_CUTS: u32 = 6;
/// Whatever the spin, a creepage far above it carries the force to mu N. Creepages of more than so many times that at which all slips,
/// and the spin's slip, run away: the force differs from mu N by less than a tolerance.
const RUNAWAY: f64 = 1e4;
/// Eigenvalues of the border below this part of the largest are none.
const SINGULAR: f64 = 1e-8;

/// Forces that are given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forces {
    /// Whether that in x, in y.
    pub given: [bool; 2],
    /// `F/(dx dy)` of each.
    pub sum: Vector,
}

impl Forces {
    /// None.
    pub const NONE: Forces = Forces { given: [false; 2], sum: [0.0; 2] };

    /// Whether there are any.
    pub fn any(&self) -> bool {
        self.given[0] || self.given[1]
    }

    /// The same, a part of it.
    pub fn times(&self, part: f64) -> Forces {
        Forces { sum: [part * self.sum[0], part * self.sum[1]], ..*self }
    }

    fn only_given(&self, v: Vector) -> Vector {
        [if self.given[0] { v[0] } else { 0.0 }, if self.given[1] { v[1] } else { 0.0 }]
    }

    /// What of the forces is missing, relative to the sum of g.
    pub fn missing(&self, problem: &Problem, q: &[Vector]) -> f64 {
        let (sum, bounds) = sums(problem, |i| q[i]);
        let missing = self.only_given([self.sum[0] - sum[0], self.sum[1] - sum[1]]);
        square(missing).sqrt() / bounds
    }
}

/// Sums over C of a field, and of g.
fn sums(problem: &Problem, value: impl Fn(usize) -> Vector) -> (Vector, f64) {
    let (mut sum, mut bounds) = ([0.0; 2], 0.0);
    for i in problem.contact() {
        sum = add(sum, value(i));
        bounds += problem.bound[i];
    }
    (sum, bounds)
}

/// The linear system of a step.
struct Step<'a> {
    problem: &'a mut Problem,
    tangent: &'a Tangent,
    forces: Forces,
    /// Preconditioned `P e_k`, and the inverse of their sums.
    border: [Vec<Vector>; 2],
    inverse: [Vector; 2],
    scratch: Vec<Vector>,
}

impl<'a> Step<'a> {
    fn new(problem: &'a mut Problem, tangent: &'a Tangent, forces: Forces) -> Step<'a> {
        let n = problem.bound.len();
        let mut step = Step {
            problem,
            tangent,
            forces,
            border: [Vec::new(), Vec::new()],
            inverse: [[0.0; 2]; 2],
            scratch: vec![[0.0; 2]; n],
        };
        let mut matrix = [[0.0; 2]; 2];
        for k in 0..2 {
            if !forces.given[k] {
                continue;
            }
            let mut unit = vec![[0.0; 2]; n];
            for i in step.problem.contact() {
                let mut e = [0.0; 2];
                e[k] = 1.0;
                unit[i] = tangent.project(i, e);
            }
            step.border[k] = step.precondition_field(&unit);
            let (sum, _) = sums(step.problem, |i| step.border[k][i]);
            let sum = forces.only_given(sum);
            (matrix[0][k], matrix[1][k]) = (sum[0], sum[1]);
        }
        step.inverse = pseudo_inverse(matrix);
        step
    }

    fn precondition_field(&mut self, r: &[Vector]) -> Vec<Vector> {
        let mut z = vec![[0.0; 2]; r.len()];
        // r is of the order of the slip here: the unit only keeps single precision in its range.
        let unit = self.problem.rms_bound();
        self.tangent.precondition(self.problem, r, unit, &mut self.scratch, &mut z);
        let outside = self.problem.bound.iter().enumerate().filter(|(_, g)| !(**g > 0.0));
        outside.for_each(|(i, _)| z[i] = [0.0; 2]);
        z
    }

    /// `y = M r;  dc = S^-1 (sum y - f);  z = y - Y dc`.
    fn precondition(&mut self, r: &Bordered) -> Bordered {
        let mut z = self.precondition_field(&r.field);
        if !self.forces.any() {
            return Bordered { field: z, border: [0.0; 2] };
        }
        let (sum, _) = sums(self.problem, |i| z[i]);
        let rest = self.forces.only_given([sum[0] - r.border[0], sum[1] - r.border[1]]);
        let [upper, lower] = self.inverse;
        let c = [upper[0] * rest[0] + upper[1] * rest[1], lower[0] * rest[0] + lower[1] * rest[1]];
        for (c, y) in c.iter().zip(&self.border).filter(|(_, y)| !y.is_empty()) {
            z.iter_mut().zip(y).for_each(|(z, y)| *z = plus(*z, -c, *y));
        }
        Bordered { field: z, border: c }
    }

    /// `H` of a vector, whose field was multiplied by A.
    fn apply(&self, z: &Bordered, product: &[Vector]) -> Bordered {
        let mut h = Bordered::zeros(product.len());
        for i in self.problem.contact() {
            let pushed = self.tangent.project(i, add(product[i], z.border));
            h.field[i] = plus(pushed, self.tangent.curvature[i], z.field[i]);
        }
        h.border = self.forces.only_given(sums(self.problem, |i| z.field[i]).0);
        h
    }

    fn multiply(&mut self, field: &[Vector]) -> Vec<Vector> {
        let mut product = vec![[0.0; 2]; field.len()];
        let unit = self.problem.rms_bound();
        self.problem.operators.multiply_fast(field, unit, &mut product);
        product
    }
}

impl System for Step<'_> {
    fn direction(&mut self, v: &Bordered) -> (Direction, Bordered) {
        let z = self.precondition(v);
        let product = self.multiply(&z.field);
        let h = self.apply(&z, &product);
        (Direction { z, product }, h)
    }
}

/// The pseudo-inverse of a symmetric 2 x 2 matrix, by its eigenvectors: where all slips one way, or one force is given, it is singular.
fn pseudo_inverse([[a, b], [c, d]]: [Vector; 2]) -> [Vector; 2] {
    let off = 0.5 * (b + c);
    let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
    let radius = half.hypot(off);
    let angle = 0.5 * off.atan2(half);
    let largest = mean.abs() + radius;
    let mut inverse = [[0.0; 2]; 2];
    for (value, v) in [(mean + radius, [angle.cos(), angle.sin()]), (mean - radius, [-angle.sin(), angle.cos()])] {
        if value.abs() > SINGULAR * largest {
            for (i, row) in inverse.iter_mut().enumerate() {
                *row = [row[0] + v[i] * v[0] / value, row[1] + v[i] * v[1] / value];
            }
        }
    }
    inverse
}

/// What tractions on all of C displace by, and in steady rolling in a step, where near and far tractions cancel, those on one element.
fn compliance(problem: &Problem) -> f64 {
    let own = problem.operators.self_influence;
    match problem.operators.rolling {
        Some(_) => own,
        None => own * (problem.count().max(1) as f64).sqrt(),
    }
}

/// Iterates from what the state and the offset hold.
pub fn solve(
    problem: &mut Problem,
    state: &mut State,
    tangent: &mut Tangent,
    forces: Forces,
    goal: Goal<'_>,
) -> Result<End> {
    let Goal { tolerance, limit, certified, watch } = goal;
    let cap = 1.0 / compliance(problem);
    let saturating = problem.rms_bound() / cap;
    let spinning = problem.rms(|i| problem.rigid[i]);
    let (mut factor, mut inner) = (1.0, if problem.operators.rolling.is_some() { INNER_ROLLING } else { INNER });
    let (mut least, mut since, mut cuts, mut iterations) = (f64::INFINITY, 0, 0, 0);
    loop {
        let slip = problem.rms_slip();
        let rho = factor * if slip > 0.0 { cap.min(problem.rms_bound() / slip) } else { cap };
        let sight = tangent.predict(problem, state, rho);
        let missing = if forces.any() { forces.missing(problem, &state.q) } else { 0.0 };
        let worst = sight.residual.max(sight.excess).max(missing);
        if worst < tolerance {
            if state.is_exact || !certified {
                return Ok(End::Converged);
            }
            problem.refresh(state);
            continue;
        }
        if forces.any() && square(problem.offset).sqrt() > RUNAWAY * (saturating + spinning) {
            return Err(Error::Infeasible(format!(
                "the tangential forces are as good as mu N, which no creepages reach: they run away beyond {:?}",
                problem.offset
            )));
        }
        since += 1;
        if worst < PROGRESS * least {
            (least, since, cuts) = (worst, 0, 0);
        }
        if since > PATIENCE {
            (factor, inner, since, cuts) = (factor * CUT, f64::max(inner * CUT, LEAST_INNER), 0, cuts + 1);
        }
        if cuts > MOST_CUTS || !worst.is_finite() {
            return Ok(End::Stalled);
        }
        if iterations >= limit {
            return Ok(End::Limit);
        }
        iterations += 1;
        let enough = inner.max((ENOUGH * tolerance / worst).min(ENOUGH));
        step(problem, state, tangent, forces, enough);
        if !watch(worst) {
            return Ok(End::Cancelled);
        }
    }
}

/// One step.
fn step(problem: &mut Problem, state: &mut State, tangent: &Tangent, forces: Forces, inner: f64) {
    let n = state.q.len();
    let stiff = problem.rms_bound() * compliance(problem);
    let slips = scale(problem, state);
    let saturating = if slips > 0.0 { slips } else { stiff };
    let (_, bounds) = sums(problem, |_| [0.0; 2]);
    let border_weight = (saturating / bounds).powi(2) * problem.count() as f64;
    let mut step = Step::new(problem, tangent, forces);
    let driving = Bordered { field: masked(step.problem, &tangent.driving), border: [0.0; 2] };
    // The way to the circles, and half of what the preconditioner says: one product for both.
    let mut gained = Bordered::zeros(n);
    for i in step.problem.contact().filter(|&i| tangent.side[i] == Side::Slip) {
        let (g, normal, q) = (step.problem.bound[i], tangent.normal[i], state.q[i]);
        gained.field[i] = [g * normal[0] - q[0], g * normal[1] - q[1]];
    }
    let mut half = step.precondition_field(&driving.field);
    half.iter_mut().for_each(|z| *z = [0.5 * z[0], 0.5 * z[1]]);
    gained.field.iter_mut().zip(&half).for_each(|(to, z)| *to = add(*to, *z));
    let mut product = step.multiply(&gained.field);
    let mut r = Bordered::zeros(n);
    for i in step.problem.contact() {
        let pushed = tangent.project(i, product[i]);
        r.field[i] = plus(plus(driving.field[i], -1.0, pushed), -tangent.curvature[i], half[i]);
    }
    let (sum, _) = sums(step.problem, |i| add(state.q[i], gained.field[i]));
    r.border = forces.only_given([forces.sum[0] - sum[0], forces.sum[1] - sum[1]]);
    let target = inner * driving.dot(&driving, 0.0).max(border_weight * square(r.border)).sqrt();
    let (directions, y) = fgmres::solve(&mut step, r, target, border_weight);
    for (direction, &y) in directions.iter().zip(&y) {
        gained.add(y, &direction.z);
        product.iter_mut().zip(&direction.product).for_each(|(to, from)| *to = plus(*to, y, *from));
    }
    for i in problem.contact() {
        state.q[i] = add(state.q[i], gained.field[i]);
        state.u[i] = add(state.u[i], product[i]);
    }
    problem.offset = add(problem.offset, forces.only_given(gained.border));
    state.is_exact = false;
}

/// A field, 0 outside C.
fn masked(problem: &Problem, field: &[Vector]) -> Vec<Vector> {
    field.iter().zip(&problem.bound).map(|(v, g)| if *g > 0.0 { *v } else { [0.0; 2] }).collect()
}
