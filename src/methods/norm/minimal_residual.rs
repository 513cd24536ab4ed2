//! Restarted GMRES (Saad & Schultz 1986) for the equations on a fixed contact area C. It is used if A is not symmetric, which the caller's table of
//! coefficients may be. For such an A, conjugate gradients would converge to a wrong solution or not at all.

use super::conjugate_gradients::noise;
use super::{InnerStop, Workspace};
use crate::contact::{norm_of_distance, relative, State};
use crate::error::Result;
use crate::memory::reserve;
use crate::methods::Task;
use crate::scene::Load;
use crate::sums::dot;

/// The number of directions after which GMRES is restarted.
const RESTART: usize = 40;

/// The directions of GMRES, and the triangular system for the factors y of the directions in the change of p.
#[derive(Default)]
pub(super) struct Krylov {
    /// The elements in C. All vectors have one value for each of them.
    elements: Vec<usize>,
    /// The orthonormal directions, one after the other.
    basis: Vec<f64>,
    /// The change of p on C.
    change: Vec<f64>,
    /// The columns of the Hessenberg matrix after Givens rotations, which make it upper triangular. Each column has [`RESTART`] values.
    columns: Vec<f64>,
    /// Cosine and sine of each rotation.
    rotations: Vec<(f64, f64)>,
    /// The right-hand side after the rotations. Its last value is the norm of the residual, up to the sign.
    right: Vec<f64>,
    /// The factors of the directions.
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

    /// Bytes held for vectors of the contact area.
    pub(super) fn bytes(&self) -> usize {
        self.elements.len() * (size_of::<usize>() + (RESTART + 2) * size_of::<f64>())
    }

    /// Discards all directions, and takes the residual, whose norm is `beta`, as the first new direction.
    fn restart(&mut self, residual: &[f64], beta: f64) {
        self.basis.clear();
        self.basis.extend(residual.iter().map(|r| r / beta));
        self.columns.clear();
        self.rotations.clear();
        self.right.clear();
        self.right.push(beta);
    }

    /// Writes the last direction to the elements of C in `full`, an array on the grid.
    fn write_last(&self, full: &mut [f64]) {
        let m = self.elements.len();
        for (&i, v) in self.elements.iter().zip(&self.basis[self.rotations.len() * m..]) {
            full[i] = *v;
        }
    }

    /// Adds a direction: `product`, which is A times the last direction, orthogonalised against all directions. Returns the norm of the residual, and
    /// whether the new direction depends linearly on the others. None if the triangular system would be singular: then the solution comes from the
    /// directions before.
    fn add(&mut self, product: &[f64], project: impl Fn(&mut [f64])) -> Option<(f64, bool)> {
        let (k, m) = (self.rotations.len(), self.elements.len());
        self.basis.extend(self.elements.iter().map(|&i| product[i]));
        let (basis, w) = self.basis.split_at_mut((k + 1) * m);
        self.columns.resize((k + 1) * RESTART, 0.0);
        let column = &mut self.columns[k * RESTART..];
        // The direction is orthogonalised twice, and its mean is removed each time: a mean left by round-off would not appear in the residual.
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

    /// Computes the change of p on C: the linear combination of the directions that has the smallest residual. Its factors come by back substitution.
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

/// Solves the equations on C by GMRES, from the state's p and u = A p. Updates p but not u. If the force is prescribed, the changes of p have the
/// mean zero over C. Returns the rms over C of the change of p since the last restart.
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
        // If the true residual is round-off, restarts do not decrease it.
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

/// The 2-norm.
fn norm(values: &[f64]) -> f64 {
    dot(values, values).sqrt()
}
