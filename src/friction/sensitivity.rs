//! Derivatives of the forces by the creepages and the spin, in the final state. Each takes one linear solve.
//!
//! The elements in slip stay the same. Their tractions move along circles, `q = g n`, and the slip stays opposite to them:
//!
//! ```text
//! (P A P + D) dq = -P dw,     D = |s|/g on slip,     dw = dq_r e_x, dq_r e_y, dq_r (-y, x)        dq_r: the length rolled
//! ```
//!
//! with B in place of A in steady rolling. The derivatives are the sums of dq and of its moments.

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
/// The most restarts.
const MOST_CALLS: usize = 10;

/// Determines the elements in slip of the final state, for [`solve`].
pub fn predict(problem: &mut Problem, state: &State, tangent: &mut Tangent) -> Result<()> {
    tangent.fit(problem.grid.len())?;
    problem.continue_residuals()?;
    let slip = problem.rms_slip();
    let rho = if slip > 0.0 { problem.rms_bound() / slip } else { 1.0 / problem.operators.self_influence };
    tangent.predict(problem, state, rho.min(1.0 / problem.operators.self_influence));
    Ok(())
}

/// Computes dq for a change dw of the rigid slip, on the grid of the problem. The array holds dw on entry and dq on
/// return. dq = 0 without motion or tractions. `tolerance` is that of the relative residual.
/// `goes_on(relative residual)` is called before each restart. If it returns false, dq is the present approximation.
pub fn solve(
    problem: &mut Problem,
    tangent: &Tangent,
    (fields, dw): (&mut Fields, &mut [Vector]),
    tolerance: f64,
    goes_on: &mut dyn FnMut(f64) -> bool,
) -> Result<()> {
    let (n, threads) = (dw.len(), problem.threads().clone());
    // The system is linear. It is scaled to unit tractions, because single precision has a small range.
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
        let left = fields::dot(&threads, &r, &r).sqrt();
        if !(left > tolerance * first) || !goes_on(left / first) {
            break;
        }
        product.fill([0.0; 2]);
        let mut gained = Bordered { field: fields.zeros(n, &threads)?, border: [0.0; 2] };
        let mut given = fields.take(n)?;
        given.copy_from_slice(&r);
        let given = Bordered { field: given, border: [0.0; 2] };
        let found = fgmres::solve(&mut system, given, (until, 0.0), &threads, fields)?;
        found.add_to(&mut gained, &mut product, &threads, fields);
        fields::add_all(&threads, &mut x.field, &[(1.0, &gained.field)]);
        system.subtract(&gained, &product, &mut r);
        fields.give(gained.field);
    }
    system.give(fields);
    fields::fill(&threads, dw, |i| x.field[i].map(|q| q / scale));
    [r, product, x.field].into_iter().for_each(|field| fields.give(field));
    Ok(())
}
