//! Restarted GMRES (Saad & Schultz 1986) for the equations on a fixed contact area when A is not symmetric: a table of the caller's own
//! need not be, and conjugate gradients would then converge to something else, or not at all.

use super::{Inner, InnerStop};
use crate::active_set::{norm_of_distance, State};
use crate::error::Result;
use crate::scene::Load;

/// Directions kept before a restart.
const RESTART: usize = 40;

/// GMRES from the state's p, whose u = A p is known. With a prescribed force, corrections keep mean zero over C.
pub fn minimal_residual(
    state: &mut State,
    stop: InnerStop,
    mut displace: impl FnMut(&[f64], &mut [f64]),
    mut go_on: impl FnMut(f64, f64) -> bool,
) -> Result<Inner> {
    let mean_free = matches!(state.load, Load::Force(_));
    let elements: Vec<usize> = (0..state.p.len()).filter(|&i| state.contact[i]).collect();
    let count = elements.len() as f64;
    let project = |values: &mut [f64]| {
        if mean_free {
            let mean = values.iter().sum::<f64>() / count;
            values.iter_mut().for_each(|value| *value -= mean);
        }
    };
    let mut inner = Inner::default();
    let stop = InnerStop { residual: stop.residual.max(f64::EPSILON * norm_of_distance(state)), ..stop };
    let mut full = vec![0.0; state.p.len()];
    let mut product = vec![0.0; state.p.len()];
    let mut residual: Vec<f64> = elements.iter().map(|&i| state.approach - state.h[i] - state.u[i]).collect();
    project(&mut residual);
    loop {
        let beta = norm(&residual);
        if beta <= stop.residual {
            inner.met = true;
            return Ok(inner);
        }
        if inner.iterations >= stop.iterations {
            return Ok(inner);
        }
        residual.iter_mut().for_each(|r| *r /= beta);
        let mut basis = vec![residual.clone()];
        let mut columns: Vec<Vec<f64>> = Vec::new(); // of the triangle that Givens rotations make of the Hessenberg matrix
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let mut right = vec![beta];
        let mut cancelled = false;
        while columns.len() < RESTART && inner.iterations < stop.iterations && !cancelled {
            let k = columns.len();
            for (&i, v) in elements.iter().zip(&basis[k]) {
                full[i] = *v;
            }
            displace(&full, &mut product);
            inner.iterations += 1;
            let mut w: Vec<f64> = elements.iter().map(|&i| product[i]).collect();
            project(&mut w);
            let mut column = vec![0.0; k + 1];
            for _ in 0..2 {
                for (h, v) in column.iter_mut().zip(&basis) {
                    let part: f64 = v.iter().zip(&w).map(|(a, b)| a * b).sum();
                    *h += part;
                    w.iter_mut().zip(v).for_each(|(w, v)| *w -= part * v);
                }
            }
            let below = norm(&w);
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
            columns.push(column);
            cancelled = !go_on(inner.update, right[k + 1].abs());
            if right[k + 1].abs() <= stop.residual || below <= f64::EPSILON * diagonal {
                break;
            }
            w.iter_mut().for_each(|w| *w /= below);
            basis.push(w);
        }
        // Back substitution, then p += basis * y.
        let mut y = vec![0.0; columns.len()];
        for row in (0..y.len()).rev() {
            let sum: f64 = (row + 1..y.len()).map(|col| columns[col][row] * y[col]).sum();
            y[row] = (right[row] - sum) / columns[row][row];
        }
        let mut change = vec![0.0; elements.len()];
        for (v, y) in basis.iter().zip(&y) {
            change.iter_mut().zip(v).for_each(|(c, v)| *c += y * v);
        }
        for (&i, c) in elements.iter().zip(&change) {
            state.p[i] += c;
        }
        inner.update = norm(&change) / count.sqrt();
        let size = (elements.iter().map(|&i| state.p[i] * state.p[i]).sum::<f64>() / count).sqrt();
        if cancelled || y.is_empty() {
            return Ok(inner);
        }
        if stop.update > 0.0 && inner.update <= stop.update * size {
            inner.met = true;
            return Ok(inner);
        }
        displace(&state.p, &mut product);
        residual = elements.iter().map(|&i| state.approach - state.h[i] - product[i]).collect();
        project(&mut residual);
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}
