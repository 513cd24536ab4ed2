//! Conjugate gradients for the equations on a fixed contact area C, with the approach or the force prescribed.
//!
//! ```text
//! prescribed approach:  A p = approach - h                            on C, p = 0 outside
//! prescribed force:     A p = approach - h, sum of p dx dy = F        on C, p = 0 outside
//! ```
//!
//! If the force is prescribed, the approach is unknown. Then residuals and search directions have the mean zero over C, so that the force does not
//! change, and the approach is the mean of h + A p over C.

use super::Workspace;
use crate::contact::{norm_of_distance, relative, State, PRODUCT_ROUND_OFF};
use crate::error::{Error, Result};
use crate::methods::Task;
use crate::scene::Load;
use crate::sums::dot;

/// The stopping criteria of an inner solve. It stops if the criterion `residual` holds, or if the criteria `update` and `believed` hold.
#[derive(Clone, Copy, Debug)]
pub struct InnerStop {
    /// The 2-norm over C of the recursive residual is at most this.
    pub residual: f64,
    /// The rms of the last change of p is at most this part of the rms of p (NORM's own criterion). 0: this criterion is not used.
    pub update: f64,
    /// The 2-norm over C of the recursive residual is at most this, so that a small update can be believed.
    pub believed: f64,
    /// The 2-norm over C of `h - approach`, to which reported residuals are relative.
    pub distance: f64,
    /// The largest number of iterations.
    pub iterations: usize,
}

/// Solves the equations on C by conjugate gradients, from the state's p and u = A p. Updates p but not u. Returns the rms over C of the last change
/// of p.
pub fn conjugate_gradients<S>(task: &mut Task<'_, '_, S>, stop: InnerStop, workspace: &mut Workspace) -> Result<f64> {
    let Task { problem, state, monitor, .. } = task;
    let n = state.p.len();
    let mean_free = matches!(state.load, Load::Force(_));
    let count = state.contact_count() as f64;
    let contact = &state.contact;
    let project = |values: &mut [f64]| project(values, contact, mean_free.then_some(count));
    let Workspace { residual: r, direction, product, .. } = workspace;
    r.clear();
    r.extend((0..n).map(|i| if contact[i] { state.approach - state.h[i] - state.u[i] } else { 0.0 }));
    project(r);
    direction.clone_from(r);
    product.resize(n, 0.0);
    let mut rr: f64 = dot(r, r);
    let mut update = 0.0;
    let noise = noise(state, (0..n).filter(|&i| contact[i]), &state.u);
    // If the bodies fit up to round-off, all distances are round-off. Then the first residual is the scale.
    let aim = stop.residual.max(f64::EPSILON * norm_of_distance(state).max(rr.sqrt()));
    for _ in 0..stop.iterations {
        if !(rr.sqrt() > aim) {
            break;
        }
        if stop.update > 0.0 && rr.sqrt() <= noise {
            // On few elements p is exact after few iterations, although the last update is not small. The next update would be 0.
            return Ok(0.0);
        }
        problem.displace(direction, product)?;
        project(product);
        let curvature = dot(direction, product);
        if !(curvature > 0.0) {
            return Err(Error::NotPositiveDefinite(format!(
                "influence coefficients: p'Ap is {curvature} for some pressures p; it must be positive"
            )));
        }
        let step = rr / curvature;
        for (p, d) in state.p.iter_mut().zip(&*direction) {
            *p += step * d;
        }
        for (r, q) in r.iter_mut().zip(&*product) {
            *r -= step * q;
        }
        // Without this projection, a mean due to round-off would accumulate in the search directions until it dominates.
        project(r);
        let before = std::mem::replace(&mut rr, dot(r, r));
        update = step.abs() * (dot(direction, direction) / count).sqrt();
        let small = update <= stop.update * (dot(&state.p, &state.p) / count).sqrt();
        let met = stop.update > 0.0 && small && rr.sqrt() <= stop.believed;
        if !monitor.cycle_done(&state.grid, 0, update, relative(rr.sqrt(), stop.distance)) || met {
            break;
        }
        for (d, r) in direction.iter_mut().zip(&*r) {
            *d = r + rr / before * *d;
        }
    }
    Ok(update)
}

/// Sets values outside C to 0. If `count`, the number of elements in C, is given, also subtracts the mean over C.
fn project(values: &mut [f64], contact: &[bool], count: Option<f64>) {
    let mut sum = 0.0;
    for (value, &inside) in values.iter_mut().zip(contact) {
        if inside {
            sum += *value;
        } else {
            *value = 0.0;
        }
    }
    if let Some(count) = count {
        values.iter_mut().zip(contact).filter(|(_, &inside)| inside).for_each(|(value, _)| *value -= sum / count);
    }
}

/// The round-off of the norm of `approach - h - u` over `elements`. A smaller residual is noise, and so is the curvature p'Ap of a direction from it.
pub(super) fn noise(state: &State, elements: impl Iterator<Item = usize>, u: &[f64]) -> f64 {
    let terms = |i: usize| (state.approach - state.h[i]).abs() + u[i].abs();
    PRODUCT_ROUND_OFF * elements.map(|i| terms(i) * terms(i)).sum::<f64>().sqrt()
}
