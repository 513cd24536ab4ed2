//! The direct solution of the equations on C by Cholesky's method, for few elements in contact.
//!
//! ```text
//! prescribed approach   A p = approach - h                         on C
//! prescribed force      A x = 1, A y = h,  p = approach x - y,     sum of p dx dy = force
//! 4.1  elements with p < 0 leave C; repeated until none leaves
//! ```
//!
//! With up to 64 elements in C this is faster than an iteration. The solver's loop determines the elements that enter C. Another
//! method takes over if C has more elements, if the matrix is not positive definite, or if a pressure would exceed its limit.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::{factor, solve};
use faer::prelude::ReborrowMut;
use faer::{MatMut, Par};

use crate::contact::{AdmissibleSet, Freshness, State};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::blank;
use crate::methods::{Change, Policy, Step, Task};
use crate::scene::Load;

/// The largest number of elements in C for which the direct solution is used. Up to it, it is faster than an iteration (`cargo bench -- dense`).
const MOST_IN_CONTACT: usize = 64;
/// The largest number of elements of a grid on which the direct solution is used (measured likewise).
const LARGEST_GRID: usize = 32 * 32;

/// An empty array with room for n values.
fn room<A>(n: usize) -> Result<Vec<A>> {
    let mut values = Vec::new();
    values.try_reserve_exact(n).map_err(|_| no_memory())?;
    Ok(values)
}

fn no_memory() -> Error {
    Error::OutOfMemory("no memory for the matrix of a direct solution".into())
}

/// The direct method: a table of coefficients, and memory for the largest system.
pub struct Direct {
    grid: Grid,
    coefficients: Coefficients,
    /// The coefficients at the offsets `1 - mx..mx` in x and `0..my` in y, x fastest. Filled when first needed.
    table: Vec<f64>,
    /// Whether `table` is filled.
    is_filled: bool,
    /// The elements in C.
    elements: Vec<usize>,
    /// The elements in C as groups of consecutive elements of a row: the first element and the length of each group.
    runs: Vec<(usize, usize)>,
    /// The coefficients between the elements in C, column by column; later its Cholesky factor.
    matrix: Vec<f64>,
    /// The right-hand side approach - h, or with a prescribed force the two right-hand sides h and 1. Later the solutions.
    right: Vec<f64>,
    /// Memory for the factorisation.
    scratch: MemBuffer,
}

impl Direct {
    /// Sets up the method. None if the grid is too large, or if the coefficients are not even, depend on the place, or have no inverse.
    pub fn new(coefficients: &Coefficients, grid: &Grid) -> Result<Option<Direct>> {
        let suits = coefficients.is_even(grid) && !coefficients.depends_on_place() && !coefficients.is_mean_free();
        if grid.len() > LARGEST_GRID || !suits {
            return Ok(None);
        }
        let scratch = factor::cholesky_in_place_scratch::<f64>(MOST_IN_CONTACT, Par::Seq, Default::default());
        Ok(Some(Direct {
            grid: *grid,
            coefficients: coefficients.clone(),
            table: blank(grid.my * (2 * grid.mx - 1), f64::NAN, "influence coefficients")?,
            is_filled: false,
            elements: room(MOST_IN_CONTACT + 1)?,
            runs: room(MOST_IN_CONTACT + 1)?,
            matrix: room(MOST_IN_CONTACT * MOST_IN_CONTACT)?,
            right: room(2 * MOST_IN_CONTACT)?,
            scratch: MemBuffer::try_new(scratch).map_err(|_| no_memory())?,
        }))
    }

    /// Bytes of the table and of the matrix.
    pub fn bytes(&self) -> usize {
        (self.table.len() + self.matrix.capacity()) * size_of::<f64>()
    }

    /// Fills the table of coefficients.
    fn fill_table(&mut self) {
        let mx = self.grid.mx;
        for (row, ky) in self.table.chunks_exact_mut(2 * mx - 1).zip(0..) {
            self.coefficients.fill_row(0, ky, &mut row[mx - 1..]);
            (1..mx).for_each(|kx| row[mx - 1 - kx] = row[mx - 1 + kx]);
        }
        self.is_filled = true;
    }

    /// Fills the matrix column by column. The part of a column that belongs to one group of elements is copied from a row of the table.
    fn fill_matrix(&mut self) {
        if !self.is_filled {
            self.fill_table();
        }
        let Direct { grid: Grid { mx, .. }, table, elements, runs, matrix, .. } = self;
        runs.clear();
        for &i in &*elements {
            match runs.last_mut() {
                Some((first, count)) if *first + *count == i && i % *mx > 0 => *count += 1,
                _ => runs.push((i, 1)),
            }
        }
        matrix.clear();
        for j in elements {
            let (x, y) = (*j % *mx, *j / *mx);
            for &(first, count) in &*runs {
                let start = (first / *mx).abs_diff(y) * (2 * *mx - 1) + *mx - 1 + first % *mx - x;
                matrix.extend_from_slice(&table[start..start + count]);
            }
        }
    }

    /// Solves for p on C, which replaces the first right-hand side, and sets the approach if the force is prescribed. Returns false if the matrix is
    /// not positive definite or a pressure is not finite.
    fn solve(&mut self, state: &mut State) -> bool {
        let n = self.elements.len();
        self.fill_matrix();
        self.right.clear();
        self.right.extend(self.elements.iter().map(|&i| match state.load {
            Load::Approach(approach) => approach - state.h[i],
            Load::Force(_) => state.h[i],
        }));
        let sides = if let Load::Force(_) = state.load { 2 } else { 1 };
        self.right.resize(sides * n, 1.0);

        let stack = MemStack::new(&mut self.scratch);
        let mut matrix = MatMut::from_column_major_slice_mut(&mut self.matrix, n, n);
        let regularization = Default::default();
        let done = factor::cholesky_in_place(matrix.rb_mut(), regularization, Par::Seq, stack, Default::default());
        if done.is_err() {
            return false;
        }
        let right = MatMut::from_column_major_slice_mut(&mut self.right, n, sides);
        solve::solve_in_place(matrix.as_ref(), right, Par::Seq, stack);
        if let Load::Force(force) = state.load {
            let (y, x) = self.right.split_at_mut(n);
            let sum = |values: &[f64]| values.iter().sum::<f64>();
            state.approach = (force / self.grid.element_area() + sum(y)) / sum(x);
            y.iter_mut().zip(x).for_each(|(y, x)| *y = state.approach * *x - *y);
        }
        self.right[..n].iter().all(|p| p.is_finite())
    }
}

impl<S: AdmissibleSet> Step<S> for Direct {
    fn name(&self) -> &'static str {
        "the direct solve"
    }

    fn policy(&self) -> Policy {
        // Elements may enter and leave C in an endless cycle. `patience` ends it.
        Policy { exchanged_by_loop: true, step_is_cycle: false, chatter: 0, patience: 12, progress: 1.0 }
    }

    /// Computes p on C, and removes the elements that leave C.
    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change> {
        let Task { state, set, goal, monitor, .. } = task;
        let gives_up = Change { gives_up: true, ..Change::default() };
        loop {
            self.elements.clear();
            self.elements.extend((0..self.grid.len()).filter(|&i| state.contact[i]).take(MOST_IN_CONTACT + 1));
            let held = S::FIXED || S::LIMITED && state.has_limited();
            if held || self.elements.len() > MOST_IN_CONTACT || self.elements.is_empty() || !self.solve(state) {
                return Ok(gives_up);
            }
            if S::LIMITED && self.elements.iter().zip(&self.right).any(|(&i, &p)| p > set.limit(i)) {
                return Ok(gives_up);
            }
            let (mut left, mut change) = (0, 0.0);
            for (&i, &p) in self.elements.iter().zip(&self.right) {
                change += (p - state.p[i]) * (p - state.p[i]);
                state.p[i] = p.max(0.0);
                if p < 0.0 {
                    state.contact[i] = false;
                    left += 1;
                }
            }
            state.u_is = Freshness::Stale;
            monitor.count.active_set_steps += 1;
            let update = (change / self.elements.len() as f64).sqrt();
            let goes_on = monitor.cycle_done(&self.grid, left, update, 0.0);
            if left == 0 || !goes_on || monitor.count.cycles >= goal.max_cycles {
                return Ok(Change { update, ..Change::default() });
            }
        }
    }
}
