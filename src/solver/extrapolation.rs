//! Extrapolation of the fixed-point iteration between the normal and the tangential problem (Anderson 1965). A turn maps the distance x of the normal
//! problem to the distance y with the displacements by the new tractions.
//!
//! ```text
//! r = y - x                                  the residual of a turn
//! dr_j, dy_j                                 the changes of r and y in the last turns
//! g minimises |r - sum over j of g_j dr_j|
//! next x = y - sum over j of g_j dy_j
//! ```
//!
//! For unlike bodies near full slip plain turns converge slowly in a few modes: the creepage, and the sizes of the stick areas.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::{factor, solve};
use faer::prelude::ReborrowMut;
use faer::{MatMut, Par};

use crate::error::Result;
use crate::memory::reserve;
use crate::sums::in_blocks;

/// Number of kept changes dr_j, dy_j. Unlike bodies on 16 x 16 elements, with a force of .9997 mu N and a tolerance of 1e-9, take 15 turns with five.
/// They take more than 50 turns with none, and also with one, which is the method of Irons and Tuck.
const KEPT_CHANGES: usize = 5;

/// This part of the trace is added to the diagonal of the Gram matrix, because its entries have round-off: products of numbers with a round-off of
/// 1e-16.
const ROUND_OFF: f64 = 1e-14;

/// r and y of a turn, or their changes from one turn to the next.
#[derive(Debug, Default)]
struct Pair {
    r: Vec<f64>,
    y: Vec<f64>,
}

/// The last turn and the changes before it.
#[derive(Debug, Default)]
pub struct Extrapolation {
    /// r and y of the last turn; empty before the first.
    last: Pair,
    /// The changes, oldest first.
    changes: Vec<Pair>,
}

impl Extrapolation {
    /// Adds a turn from x to y.
    pub fn turn(&mut self, x: &[f64], y: &[f64]) -> Result<()> {
        let mut pair = if self.changes.len() < KEPT_CHANGES { Pair::default() } else { self.changes.remove(0) };
        // Elements without a surface do not change.
        let values = || x.iter().zip(y).map(|(x, y)| if x.is_finite() { [y - x, *y] } else { [0.0; 2] });
        difference(&mut pair.r, values().map(|[r, _]| r), &self.last.r)?;
        difference(&mut pair.y, values().map(|[_, y]| y), &self.last.y)?;
        if self.last.r.is_empty() {
            self.last = pair;
        } else {
            for (last, change) in [(&mut self.last.r, &pair.r), (&mut self.last.y, &pair.y)] {
                last.iter_mut().zip(change).for_each(|(last, change)| *last += change);
            }
            self.changes.push(pair);
        }
        Ok(())
    }

    /// Replaces y of the last turn by the next x.
    pub fn extrapolate(&self, y: &mut [f64]) {
        let count = self.changes.len();
        if count == 0 {
            return;
        }
        let dot = |a: &[f64], b: &[f64]| in_blocks(a.iter().zip(b).map(|(a, b)| a * b));
        let row = |i: usize| self.changes.iter().map(move |change| dot(&self.changes[i].r, &change.r));
        let gram: Vec<f64> = (0..count).flat_map(row).collect();
        let right = self.changes.iter().map(|change| dot(&change.r, &self.last.r)).collect();
        let g = least_squares(gram, right);
        for (g_j, change) in g.iter().zip(&self.changes) {
            y.iter_mut().zip(&change.y).for_each(|(y, dy)| *y -= g_j * dy);
        }
    }
}

/// Writes `values - before` to `to`, or `values` if `before` is empty.
fn difference(to: &mut Vec<f64>, values: impl ExactSizeIterator<Item = f64>, before: &[f64]) -> Result<()> {
    to.clear();
    reserve(to, values.len(), "the turns before")?;
    to.extend(values);
    to.iter_mut().zip(before).for_each(|(now, before)| *now -= before);
    Ok(())
}

/// Solves the normal equations `gram g = right`. The diagonal that is added keeps g small for linearly dependent changes. Empty if there is no finite
/// solution.
fn least_squares(mut gram: Vec<f64>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    let trace: f64 = gram.iter().step_by(n + 1).sum();
    gram.iter_mut().step_by(n + 1).for_each(|square| *square += ROUND_OFF * trace);
    let scratch = StackReq::any_of(&[
        factor::cholesky_in_place_scratch::<f64>(n, Par::Seq, Default::default()),
        solve::solve_in_place_scratch::<f64>(n, 1, Par::Seq),
    ]);
    let mut memory = MemBuffer::new(scratch);
    let stack = MemStack::new(&mut memory);
    let mut matrix = MatMut::from_column_major_slice_mut(&mut gram, n, n);
    if factor::cholesky_in_place(matrix.rb_mut(), Default::default(), Par::Seq, stack, Default::default()).is_err() {
        return Vec::new();
    }
    solve::solve_in_place(matrix.as_ref(), MatMut::from_column_major_slice_mut(&mut right, n, 1), Par::Seq, stack);
    right.retain(|g_j| g_j.is_finite());
    if right.len() == n {
        right
    } else {
        Vec::new()
    }
}
