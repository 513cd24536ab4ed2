//! Conjugate gradients for the equations on a fixed contact area, with the approach or the force prescribed.
//!
//! ```text
//! prescribed approach:  A p = approach - h              on C, p = 0 outside
//! prescribed force:     A p = approach - h, sum of p dx dy = F;  the approach is unknown, so residuals and search
//!                       directions keep mean zero over C, and the approach is the mean of h + A p over C
//! ```

use super::Workspace;
use crate::contact::{norm_of_distance, relative, State, PRODUCT_ROUND_OFF};
use crate::error::{Error, Result};
use crate::methods::Task;
use crate::scene::Load;
use crate::sums::dot;

/// The stopping criteria of the inner iteration.
#[derive(Clone, Copy, Debug)]
pub struct InnerStop {
    /// 2-norm over C of the recursively updated residual.
    pub residual: f64,
    /// Or: rms of the last change of p at most this part of the rms of p (NORM's own criterion); 0: not used.
    pub update: f64,
    /// With `update`: the residual has to be at most this as well.
    pub believed: f64,
    /// 2-norm over C of `h - approach`, the scale of reported residuals.
    pub distance: f64,
    /// Most iterations.
    pub iterations: usize,
}

/// Conjugate gradients from the state's p, with u = A p. Updates p but not u. Returns the update: rms over C of the last change of p.
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
    // Bodies that fit up to round-off have no distances.
    let aim = stop.residual.max(f64::EPSILON * norm_of_distance(state).max(rr.sqrt()));
    for _ in 0..stop.iterations {
        if !(rr.sqrt() > aim) {
            break;
        }
        if stop.update > 0.0 && rr.sqrt() <= noise {
            // On few elements the solution is exact after few iterations, although the last update was not small.
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
        // A mean from round-off would accumulate in the directions until it dominates.
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

/// Sets values outside C to 0 and, with a prescribed force, makes the mean over the `count` elements of C zero.
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

/// The round-off of a residual on `elements` with displacement `u`: a smaller residual is noise, and so is its curvature.
pub(super) fn noise(state: &State, elements: impl Iterator<Item = usize>, u: &[f64]) -> f64 {
    let terms = |i: usize| (state.approach - state.h[i]).abs() + u[i].abs();
    PRODUCT_ROUND_OFF * elements.map(|i| terms(i) * terms(i)).sum::<f64>().sqrt()
}
