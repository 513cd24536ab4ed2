//! Restarted GMRES (Saad & Schultz 1986) for the equations on a fixed contact area when A is not symmetric: a table of the caller's own
//! need not be, and conjugate gradients would then converge to something else, or not at all.

use super::conjugate_gradients::ROUND_OFF;
use super::{Inner, InnerStop, Workspace};
use crate::contact::{norm_of_distance, State};
use crate::error::Result;
use crate::memory::reserve;
use crate::scene::Load;

/// Directions kept before a restart.
const RESTART: usize = 40;

/// Memory for the directions and the small system of their coefficients.
#[derive(Default)]
pub(super) struct Krylov {
    /// The elements in contact; what follows has one value for each of them.
    elements: Vec<usize>,
    /// One direction after the other.
    basis: Vec<f64>,
    change: Vec<f64>,
    /// [`RESTART`] values a column: of the triangle that Givens rotations make of the Hessenberg matrix.
    columns: Vec<f64>,
    rotations: Vec<(f64, f64)>,
    right: Vec<f64>,
    y: Vec<f64>,
}

/// GMRES from the state's p, whose u = A p is known. With a prescribed force, corrections keep mean zero over C.
pub fn minimal_residual(
    state: &mut State,
    stop: InnerStop,
    workspace: &mut Workspace,
    mut displace: impl FnMut(&[f64], &mut [f64]),
    mut go_on: impl FnMut(f64, f64) -> bool,
) -> Result<Inner> {
    let Workspace { residual, direction: full, product, krylov } = workspace;
    let Krylov { elements, basis, change, columns, rotations, right, y } = krylov;
    let mean_free = matches!(state.load, Load::Force(_));
    elements.clear();
    reserve(elements, state.p.len(), "GMRES")?;
    elements.extend((0..state.p.len()).filter(|&i| state.contact[i]));
    let (m, count) = (elements.len(), elements.len() as f64);
    let project = |values: &mut [f64]| {
        if mean_free {
            let mean = values.iter().sum::<f64>() / count;
            values.iter_mut().for_each(|value| *value -= mean);
        }
    };
    reserve(basis, (RESTART + 1) * m, "GMRES's directions")?;
    reserve(change, m, "GMRES")?;
    let mut inner = Inner::default();
    let stop = InnerStop { residual: stop.residual.max(f64::EPSILON * norm_of_distance(state)), ..stop };
    full.clear();
    full.resize(state.p.len(), 0.0);
    product.resize(state.p.len(), 0.0);
    residual.clear();
    residual.extend(elements.iter().map(|&i| state.approach - state.h[i] - state.u[i]));
    project(residual);
    loop {
        let beta = norm(residual);
        if beta <= stop.residual {
            inner.met = true;
            return Ok(inner);
        }
        if inner.iterations >= stop.iterations {
            return Ok(inner);
        }
        basis.clear();
        basis.extend(residual.iter().map(|r| r / beta));
        columns.clear();
        rotations.clear();
        right.clear();
        right.push(beta);
        let mut k = 0; // columns so far
        let mut cancelled = false;
        while k < RESTART && inner.iterations < stop.iterations && !cancelled {
            for (&i, v) in elements.iter().zip(&basis[k * m..]) {
                full[i] = *v;
            }
            displace(full, product);
            inner.iterations += 1;
            basis.extend(elements.iter().map(|&i| product[i]));
            let (basis, w) = basis.split_at_mut((k + 1) * m);
            columns.resize((k + 1) * RESTART, 0.0);
            let column = &mut columns[k * RESTART..];
            // Twice, and the mean each time: what round-off leaves of it no residual would show.
            for _ in 0..2 {
                project(w);
                for (h, v) in column.iter_mut().zip(basis.chunks_exact(m)) {
                    let part: f64 = v.iter().zip(&*w).map(|(a, b)| a * b).sum();
                    *h += part;
                    w.iter_mut().zip(v).for_each(|(w, v)| *w -= part * v);
                }
            }
            let below = norm(w);
            for (j, &(c, s)) in rotations.iter().enumerate() {
                (column[j], column[j + 1]) = (c * column[j] + s * column[j + 1], c * column[j + 1] - s * column[j]);
            }
            let diagonal = column[k].hypot(below);
            if !(diagonal > 0.0) {
                break; // a singular system: the best that this space holds is taken
            }
            let (c, s) = (column[k] / diagonal, below / diagonal);
            column[k] = diagonal;
            rotations.push((c, s));
            right.push(-s * right[k]);
            right[k] *= c;
            k += 1;
            cancelled = !go_on(inner.update, right[k].abs());
            if right[k].abs() <= stop.residual || below <= f64::EPSILON * diagonal {
                break;
            }
            w.iter_mut().for_each(|w| *w /= below);
        }
        // Back substitution, then p += basis * y.
        y.clear();
        y.resize(k, 0.0);
        for row in (0..k).rev() {
            let sum: f64 = (row + 1..k).map(|col| columns[col * RESTART + row] * y[col]).sum();
            y[row] = (right[row] - sum) / columns[row * RESTART + row];
        }
        change.clear();
        change.resize(m, 0.0);
        for (v, y) in basis.chunks_exact(m).zip(&*y) {
            change.iter_mut().zip(v).for_each(|(c, v)| *c += y * v);
        }
        for (&i, c) in elements.iter().zip(&*change) {
            state.p[i] += c;
        }
        inner.update = norm(change) / count.sqrt();
        let size = (elements.iter().map(|&i| state.p[i] * state.p[i]).sum::<f64>() / count).sqrt();
        if cancelled || y.is_empty() {
            return Ok(inner);
        }
        let last = right[k].abs();
        if stop.update > 0.0 && inner.update <= stop.update * size && last <= stop.believed {
            inner.met = true;
            return Ok(inner);
        }
        displace(&state.p, product);
        residual.clear();
        residual.extend(elements.iter().map(|&i| state.approach - state.h[i] - product[i]));
        project(residual);
        // A true residual that is round-off stays that, restart after restart.
        let terms = |i: usize| (state.approach - state.h[i]).abs() + product[i].abs();
        let noise = ROUND_OFF * elements.iter().map(|&i| terms(i) * terms(i)).sum::<f64>().sqrt();
        if norm(residual) <= noise && norm(residual) > 0.5 * beta {
            return Ok(inner);
        }
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}
