//! Restarted GMRES (Saad & Schultz 1986) for the equations on a fixed contact area with an A that is not symmetric, as the caller's table may be.
//! Conjugate gradients would converge to a wrong solution or not at all.

use super::conjugate_gradients::noise;
use super::{InnerStop, Workspace};
use crate::contact::{norm_of_distance, relative, State};
use crate::error::Result;
use crate::memory::reserve;
use crate::methods::Task;
use crate::scene::Load;
use crate::sums::dot;

/// Directions kept before a restart.
const RESTART: usize = 40;

/// Memory for the directions and the small system of their coefficients.
#[derive(Default)]
pub(super) struct Krylov {
    /// The elements in contact; all vectors have one value for each.
    elements: Vec<usize>,
    /// One direction after the other.
    basis: Vec<f64>,
    change: Vec<f64>,
    /// [`RESTART`] values a column: the triangle of the Hessenberg matrix after Givens rotations.
    columns: Vec<f64>,
    rotations: Vec<(f64, f64)>,
    right: Vec<f64>,
    y: Vec<f64>,
}

impl Krylov {
    /// Allocates memory for the directions of a state's contact area.
    fn begin(&mut self, state: &State) -> Result<()> {
        reserve(&mut self.elements, state.p.len(), "GMRES")?;
        self.elements.clear();
        self.elements.extend((0..state.p.len()).filter(|&i| state.contact[i]));
        reserve(&mut self.basis, (RESTART + 1) * self.elements.len(), "GMRES's directions")?;
        Ok(reserve(&mut self.change, self.elements.len(), "GMRES")?)
    }

    /// The first direction is the residual, whose norm is `beta`.
    fn restart(&mut self, residual: &[f64], beta: f64) {
        self.basis.clear();
        self.basis.extend(residual.iter().map(|r| r / beta));
        self.columns.clear();
        self.rotations.clear();
        self.right.clear();
        self.right.push(beta);
    }

    /// The last direction, as pressures on the grid; zero outside C.
    fn write_last(&self, full: &mut [f64]) {
        let m = self.elements.len();
        for (&i, v) in self.elements.iter().zip(&self.basis[self.rotations.len() * m..]) {
            full[i] = *v;
        }
    }

    /// Adds a direction, from the product of the last. Returns the remaining residual, and whether the direction is dependent; none for a singular
    /// system, for which the best of this space is taken.
    fn add(&mut self, product: &[f64], project: impl Fn(&mut [f64])) -> Option<(f64, bool)> {
        let (k, m) = (self.rotations.len(), self.elements.len());
        self.basis.extend(self.elements.iter().map(|&i| product[i]));
        let (basis, w) = self.basis.split_at_mut((k + 1) * m);
        self.columns.resize((k + 1) * RESTART, 0.0);
        let column = &mut self.columns[k * RESTART..];
        // The direction is orthogonalised twice, and its mean is removed each time. A mean left by round-off would not appear in the residual.
        for _ in 0..2 {
            project(w);
            for (h, v) in column.iter_mut().zip(basis.chunks_exact(m)) {
                let part: f64 = v.iter().zip(&*w).map(|(a, b)| a * b).sum();
                *h += part;
                w.iter_mut().zip(v).for_each(|(w, v)| *w -= part * v);
            }
        }
        let below = norm(w);
        w.iter_mut().for_each(|w| *w /= below);
        for (j, &(c, s)) in self.rotations.iter().enumerate() {
            (column[j], column[j + 1]) = (c * column[j] + s * column[j + 1], c * column[j + 1] - s * column[j]);
        }
        let diagonal = column[k].hypot(below);
        if !(diagonal > 0.0) {
            return None;
        }
        let (c, s) = (column[k] / diagonal, below / diagonal);
        column[k] = diagonal;
        self.rotations.push((c, s));
        self.right.push(-s * self.right[k]);
        self.right[k] *= c;
        Some((self.right[k + 1].abs(), below <= f64::EPSILON * diagonal))
    }

    /// The change of p on C: the combination of the directions with the least residual, by back substitution.
    fn combine(&mut self) -> &[f64] {
        let Krylov { elements, basis, change, columns, rotations, right, y } = self;
        let k = rotations.len();
        y.clear();
        y.resize(k, 0.0);
        for row in (0..k).rev() {
            let sum: f64 = (row + 1..k).map(|col| columns[col * RESTART + row] * y[col]).sum();
            y[row] = (right[row] - sum) / columns[row * RESTART + row];
        }
        change.clear();
        change.resize(elements.len(), 0.0);
        for (v, y) in basis.chunks_exact(elements.len()).zip(&*y) {
            change.iter_mut().zip(v).for_each(|(c, v)| *c += y * v);
        }
        change
    }
}

/// GMRES from the state's p, with u = A p. With a prescribed force, corrections keep mean zero over C. Returns the update:
/// rms over C of the last change of p.
pub fn minimal_residual<S>(task: &mut Task<'_, '_, S>, stop: InnerStop, workspace: &mut Workspace) -> Result<f64> {
    let Task { problem, state, monitor, .. } = task;
    let Workspace { residual, direction: full, product, krylov } = workspace;
    krylov.begin(state)?;
    let count = krylov.elements.len() as f64;
    let mean_free = matches!(state.load, Load::Force(_));
    let project = |values: &mut [f64]| {
        if mean_free {
            let mean = values.iter().sum::<f64>() / count;
            values.iter_mut().for_each(|value| *value -= mean);
        }
    };
    let aim = stop.residual.max(f64::EPSILON * norm_of_distance(state));
    full.clear();
    full.resize(state.p.len(), 0.0);
    product.clone_from(&state.u);
    let (mut update, mut iterations, mut before) = (0.0, 0, f64::INFINITY);
    loop {
        residual.clear();
        residual.extend(krylov.elements.iter().map(|&i| state.approach - state.h[i] - product[i]));
        project(residual);
        let beta = norm(residual);
        // A true residual at round-off does not decrease by restarts.
        let stays = beta > 0.5 * before && beta <= noise(state, krylov.elements.iter().copied(), product);
        if beta <= aim || iterations >= stop.iterations || stays {
            return Ok(update);
        }
        before = beta;
        krylov.restart(residual, beta);
        let mut cancelled = false;
        while krylov.rotations.len() < RESTART && iterations < stop.iterations && !cancelled {
            krylov.write_last(full);
            problem.displace(full, product)?;
            iterations += 1;
            let Some((left, is_last)) = krylov.add(product, project) else { break };
            cancelled = !monitor.cycle_done(&state.grid, 0, update, relative(left, stop.distance));
            if left <= aim || is_last {
                break;
            }
        }
        let change = krylov.combine();
        update = norm(change) / count.sqrt();
        for (&i, c) in krylov.elements.iter().zip(&krylov.change) {
            state.p[i] += c;
        }
        let squares = krylov.elements.iter().map(|&i| state.p[i] * state.p[i]).sum::<f64>();
        let small = stop.update > 0.0 && update <= stop.update * (squares / count).sqrt();
        let left = krylov.right.last().map_or(0.0, |right| right.abs());
        if cancelled || krylov.rotations.is_empty() || small && left <= stop.believed {
            return Ok(update);
        }
        problem.displace(&state.p, product)?;
    }
}

fn norm(values: &[f64]) -> f64 {
    dot(values, values).sqrt()
}
