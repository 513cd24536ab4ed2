//! The linear system of a Newton step with a law of friction. x is the change of q, and both of its components are unknowns on slip as well. B stands
//! for A, or for the operator of steady rolling.
//!
//! ```text
//! stick:        B x                                        = -s
//! slip along t: t.(B x) + D t.x                            = -t.s + D t.x0          x0 = g n - q
//! slip along n: b0 (n.x - dg)                              = b0 n.x0                b0: an element's influence on itself
//! ```
//!
//! dg is the change of the bound by the change `n.x - rho n.(B x)` of |tau|, on this element and on those upstream (see [`march`](super::march)).
//!
//! With given forces `B x + c` replaces B x, where c is the change of the creepages, and `sum x = F/(dx dy) - sum q`. The border is eliminated as
//! without a law, where `Y_k` is the preconditioned column of c_k.
//!
//! The preconditioner on stick and along t is that without a law. Along n it is `1/(b0 (1 - g_T (1 - rho b0)))`, where g_T is the derivative of g
//! by |tau| of the same element.

use super::super::forces::{sum_of, Forces};
use super::super::plane::{add, dot, plus, Vector};
use super::super::problem::{Problem, State};
use super::super::step::border_weight;
use super::super::system::Border;
use super::super::tangent::{project, Side, Tangent};
use super::march::March;
use crate::error::Result;
use crate::methods::fgmres::{self, Bordered, Direction, System, Until};
use crate::methods::fields::{self, Fields};

/// The system, linearised at the prediction of the tangent and the last resolved state of the march.
struct RadialSystem<'a> {
    problem: &'a mut Problem,
    tangent: &'a Tangent,
    march: &'a mut March,
    rho: f64,
    border: Border,
    scratch: Vec<Vector>,
    /// Scratch for P r.
    projected: Vec<Vector>,
}

impl RadialSystem<'_> {
    /// Computes the columns Y of the border, and their sums.
    fn set_border(&mut self, fields: &mut Fields) -> Result<()> {
        let n = self.problem.bound.len();
        for (k, e) in self.border.directions() {
            let nothing = fields.zeros(n, &self.problem.threads().clone())?;
            let (mut column, mut y) = (fields.take(n)?, fields.take(n)?);
            self.apply((&nothing, e), &nothing, &mut column);
            self.precondition(&column, &mut y);
            [nothing, column].into_iter().for_each(|field| fields.give(field));
            self.border.set_column(k, y, self.problem);
        }
        Ok(())
    }

    /// Computes the preconditioned z of r, without the border.
    fn precondition(&mut self, r: &[Vector], z: &mut [Vector]) {
        let RadialSystem { problem, tangent, march, rho, scratch, projected, .. } = self;
        let (b0, unit, threads) = (problem.operators.self_influence, problem.rms_bound(), problem.threads().clone());
        fields::fill(&threads, projected, |k| tangent.project_inside(k, r[k]));
        tangent.precondition(problem, projected, unit, scratch, z);
        fields::map(&threads, z, |k, z| match tangent.side[k] {
            Side::Slip => {
                let [[g_by_tau, ..], ..] = march.resolved(k).linear;
                let diagonal = 1.0 - g_by_tau * (1.0 - *rho * b0);
                plus(z, dot(tangent.normal[k], r[k]) / (b0 * diagonal), tangent.normal[k])
            }
            _ => z,
        });
    }

    /// Computes the left-hand side h of the system for z and changes of the creepages `border`. `product` is B z.
    fn apply(&mut self, (z, border): (&[Vector], Vector), product: &[Vector], h: &mut [Vector]) {
        let RadialSystem { problem, tangent, march, rho, .. } = self;
        let b0 = problem.operators.self_influence;
        let moved = |k: usize| add(product[k], problem.weighted(k, border));
        let traction = |k: usize| dot(tangent.normal[k], z[k]) - *rho * dot(tangent.normal[k], moved(k));
        march.change(traction, |k, bound| {
            h[k] = match tangent.side[k] {
                Side::Outside => [0.0; 2],
                Side::Stick => moved(k),
                Side::Slip => {
                    let n = tangent.normal[k];
                    let across = project(n, plus(moved(k), tangent.curvature[k], z[k]));
                    plus(across, b0 * (dot(n, z[k]) - bound), n)
                }
            };
        });
    }
}

impl System for RadialSystem<'_> {
    fn direction(&mut self, v: &Bordered, fields: &mut Fields) -> Result<(Direction, Bordered)> {
        let n = v.field.len();
        let (mut z, mut product, mut h) = (fields.take(n)?, fields.take(n)?, fields.take(n)?);
        self.precondition(&v.field, &mut z);
        let creepages = self.border.creepages(plus(self.border.sums_of(self.problem, &z), -1.0, v.border));
        self.border.balance(self.problem.threads(), creepages, &mut z);
        let sum = self.border.sums_of(self.problem, &z);
        let unit = self.problem.rms_bound();
        self.problem.operators.multiply_fast(&z, unit, &mut product);
        self.apply((&z, creepages), &product, &mut h);
        Ok((Direction { z: Bordered { field: z, border: creepages }, product }, Bordered { field: h, border: sum }))
    }
}

/// Makes one Newton step. Its linear system is solved to the relative residual `inner`, with at most `most` search directions.
pub fn step(
    problem: &mut Problem,
    state: &mut State,
    (tangent, march, forces): (&Tangent, &mut March, Forces),
    (rho, inner, most): (f64, f64, usize),
    fields: &mut Fields,
) -> Result<()> {
    let (n, threads, b0) = (state.q.len(), problem.threads().clone(), problem.operators.self_influence);
    let mut r = fields.take(n)?;
    fields::fill(&threads, &mut r, |k| {
        let s = if tangent.side[k] == Side::Outside { [0.0; 2] } else { problem.slip_at(k, &state.u) };
        let against = [-s[0], -s[1]];
        match tangent.side[k] {
            Side::Outside => [0.0; 2],
            Side::Stick => against,
            Side::Slip => {
                let normal = tangent.normal[k];
                let way = plus(normal.map(|n| problem.bound[k] * n), -1.0, state.q[k]);
                let across = project(normal, plus(against, tangent.curvature[k], way));
                plus(across, b0 * dot(normal, way), normal)
            }
        }
    });
    let (weight, missing) = (border_weight(problem, state, forces), forces.less(|| sum_of(problem, &state.q)));
    let target = inner * (fields::dot(&threads, &r, &r) + weight * dot(missing, missing)).sqrt();
    let (scratch, projected) = (fields.take(n)?, fields.take(n)?);
    let mut system = RadialSystem { problem, tangent, march, rho, border: Border::new(forces), scratch, projected };
    system.set_border(fields)?;
    let r = Bordered { field: r, border: missing };
    let found = fgmres::solve(&mut system, r, (Until { target, most }, weight), &threads, fields)?;
    let RadialSystem { scratch, projected, border, .. } = system;
    border.give(fields);
    [scratch, projected].into_iter().for_each(|field| fields.give(field));
    let mut change = Bordered { field: fields.zeros(n, &threads)?, border: [0.0; 2] };
    let mut product = fields.zeros(n, &threads)?;
    found.add_to(&mut change, &mut product, &threads, fields);
    problem.update = problem.rms_of(fields::dot(&threads, &change.field, &change.field));
    fields::add_all(&threads, &mut state.q, &[(1.0, &change.field)]);
    fields::add_all(&threads, &mut state.u, &[(1.0, &product)]);
    problem.offset = add(problem.offset, forces.only_given(change.border));
    fields.give(change.field);
    fields.give(product);
    state.is_exact = false;
    Ok(())
}
