//! Derivatives of the forces by the creepages and the spin, at the solution. Each takes one linear solve.
//!
//! The slip area is kept constant. Tractions of slipping elements move along their circles, `q = g n`, and the slip stays opposite to them:
//!
//! ```text
//! (P A P + D) dq = -P dw,     D = |s|/g on slip,     dw = dq_r e_x, dq_r e_y, dq_r (-y, x)        dq_r: the length rolled
//! ```
//!
//! with B in place of A in steady rolling, for a change of xi, eta or phi by 1. The derivatives of the forces are the sums of dq times dx dy, and
//! those of the moment follow from the moments of dq.

use super::forces::Forces;
use super::plane::Vector;
use super::problem::{Problem, State};
use super::step::DIRECTIONS;
use super::system::TangentSystem;
use super::tangent::Tangent;
use crate::error::Result;
use crate::methods::fgmres::{self, Bordered, Until};
use crate::methods::fields::{self, Fields};

/// The relative residual of the linear solves for reported derivatives.
pub const TOLERANCE: f64 = 1e-5;
/// The largest number of calls of GMRES, each of which restarts it.
const MOST_CALLS: usize = 10;

/// Determines the slip area of the solution, for [`solve`].
pub fn predict(problem: &mut Problem, state: &State, tangent: &mut Tangent) -> Result<()> {
    tangent.fit(problem.grid.len())?;
    problem.continue_residuals()?;
    let slip = problem.rms_slip();
    let rho = if slip > 0.0 { problem.rms_bound() / slip } else { 1.0 / problem.operators.self_influence };
    tangent.predict(problem, state, rho.min(1.0 / problem.operators.self_influence));
    Ok(())
}

/// Computes dq for a change dw of the rigid slip, on the grid of the problem. The array holds dw on entry and dq on return. If dw or all bounds are
/// 0, dq is 0. `tolerance` is that of the relative residual. `goes_on(relative residual)` is called before each call of GMRES. If it returns false,
/// dq is the present approximation.
pub fn solve(
    problem: &mut Problem,
    tangent: &Tangent,
    (fields, dw): (&mut Fields, &mut [Vector]),
    tolerance: f64,
    goes_on: &mut dyn FnMut(f64) -> bool,
) -> Result<()> {
    let (n, threads) = (dw.len(), problem.threads().clone());
    // The linear system is scaled so that dw has the size of the bounds, because single precision has a small range.
    let size = fields::dot(&threads, dw, dw).sqrt();
    let scale = problem.rms_bound() / size;
    if !(scale > 0.0 && scale < f64::INFINITY) {
        fields::fill(&threads, dw, |_| [0.0; 2]);
        return Ok(());
    }
    let mut system = TangentSystem::new(problem, tangent, Forces::NONE, fields)?;
    let mut r = fields.take(n)?;
    fields::fill(&threads, &mut r, |i| tangent.project_inside(i, dw[i].map(|w| -w * scale)));
    let first = fields::dot(&threads, &r, &r).sqrt();
    let until = Until { target: tolerance * first, most: DIRECTIONS };
    let mut x = Bordered { field: fields.zeros(n, &threads)?, border: [0.0; 2] };
    let mut product = fields.take(n)?;
    for _ in 0..MOST_CALLS {
        let residual = fields::dot(&threads, &r, &r).sqrt();
        if !(residual > tolerance * first) || !goes_on(residual / first) {
            break;
        }
        product.fill([0.0; 2]);
        let mut change = Bordered { field: fields.zeros(n, &threads)?, border: [0.0; 2] };
        let mut right_side = fields.take(n)?;
        right_side.copy_from_slice(&r);
        let right_side = Bordered { field: right_side, border: [0.0; 2] };
        let found = fgmres::solve(&mut system, right_side, (until, 0.0), &threads, fields)?;
        found.add_to(&mut change, &mut product, &threads, fields);
        fields::add_all(&threads, &mut x.field, &[(1.0, &change.field)]);
        system.subtract(&change, &product, &mut r);
        fields.give(change.field);
    }
    system.give(fields);
    fields::fill(&threads, dw, |i| x.field[i].map(|q| q / scale));
    [r, product, x.field].into_iter().for_each(|field| fields.give(field));
    Ok(())
}
