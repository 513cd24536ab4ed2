//! The linear system of a Newton step with a law, whose unknowns have both components on slip, too.
//!
//! ```text
//! stick:        B x                                        = -s
//! slip along t: t.(B x) + D t.x                            = -t.s + D t.x0          x0 = g n - q
//! slip along n: b0 (n.x - change of g by n.x - rho n.(B x)) = b0 n.x0               b0: an element's influence on itself
//! ```
//!
//! Preconditioned on stick and along t as without a law, along n by `1/(b0 (1 - g_T (1 - rho b0)))`, g_T the own derivative of g by the traction.

use super::super::plane::{dot, plus, Vector};
use super::super::problem::{Problem, State};
use super::super::tangent::{project, Side, Tangent};
use super::march::March;
use crate::error::Result;
use crate::methods::fgmres::{self, Bordered, Direction, System, Until};
use crate::methods::fields::{self, Fields};

/// The system at the state that the tangent and the march hold.
struct RadialSystem<'a> {
    problem: &'a mut Problem,
    tangent: &'a Tangent,
    march: &'a mut March,
    rho: f64,
    scratch: Vec<Vector>,
    along: Vec<Vector>,
}

impl RadialSystem<'_> {
    fn precondition(&mut self, r: &[Vector], z: &mut [Vector]) {
        let RadialSystem { problem, tangent, march, rho, scratch, along } = self;
        let (b0, unit, threads) = (problem.operators.self_influence, problem.rms_bound(), problem.threads().clone());
        fields::fill(&threads, along, |k| tangent.project_inside(k, r[k]));
        tangent.precondition(problem, along, unit, scratch, z);
        fields::map(&threads, z, |k, z| match tangent.side[k] {
            Side::Slip => {
                let own = 1.0 - march.resolved(k).linear[0][0] * (1.0 - *rho * b0);
                plus(z, dot(tangent.normal[k], r[k]) / (b0 * own), tangent.normal[k])
            }
            _ => z,
        });
    }

    fn apply(&mut self, z: &[Vector], product: &[Vector], h: &mut [Vector]) {
        let RadialSystem { problem, tangent, march, rho, .. } = self;
        let b0 = problem.operators.self_influence;
        let traction = |k: usize| dot(tangent.normal[k], z[k]) - *rho * dot(tangent.normal[k], product[k]);
        march.change(traction, |k, bound| {
            h[k] = match tangent.side[k] {
                Side::Outside => [0.0; 2],
                Side::Stick => product[k],
                Side::Slip => {
                    let n = tangent.normal[k];
                    let across = project(n, plus(product[k], tangent.curvature[k], z[k]));
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
        let unit = self.problem.rms_bound();
        self.problem.operators.multiply_fast(&z, unit, &mut product);
        self.apply(&z, &product, &mut h);
        let border = [0.0; 2];
        Ok((Direction { z: Bordered { field: z, border }, product }, Bordered { field: h, border }))
    }
}

/// One step of Newton's method, solved to `inner` of its right-hand side, with so many directions at most.
pub fn step(
    problem: &mut Problem,
    state: &mut State,
    (tangent, march): (&Tangent, &mut March),
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
    let target = inner * fields::dot(&threads, &r, &r).sqrt();
    let (scratch, along) = (fields.take(n)?, fields.take(n)?);
    let mut system = RadialSystem { problem, tangent, march, rho, scratch, along };
    let r = Bordered { field: r, border: [0.0; 2] };
    let found = fgmres::solve(&mut system, r, (Until { target, most }, 0.0), &threads, fields)?;
    let RadialSystem { scratch, along, .. } = system;
    [scratch, along].into_iter().for_each(|field| fields.give(field));
    let (mut gained, mut product) = (Bordered { field: fields.take(n)?, border: [0.0; 2] }, fields.take(n)?);
    fields::fill(&threads, &mut gained.field, |_| [0.0; 2]);
    fields::fill(&threads, &mut product, |_| [0.0; 2]);
    found.add_to(&mut gained, &mut product, &threads, fields);
    problem.update = problem.rms_of(fields::dot(&threads, &gained.field, &gained.field));
    fields::add_all(&threads, &mut state.q, &[(1.0, &gained.field)]);
    fields::add_all(&threads, &mut state.u, &[(1.0, &product)]);
    fields.give(gained.field);
    fields.give(product);
    state.is_exact = false;
    Ok(())
}
