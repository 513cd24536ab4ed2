//! The exact solve on the coarsest grid: Gaussian elimination restricted to the contact area.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::prelude::ReborrowMut;
use faer::{Conj, MatMut, Par};

use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::dense;

/// The elimination, with memory for the largest number of elements so far.
pub struct Coarsest {
    elements: Vec<usize>,
    matrix: Vec<f64>,
    right: Vec<f64>,
    permutation: Vec<usize>,
    inverse: Vec<usize>,
    scratch: MemBuffer,
    /// Multiplications since the last [`Coarsest::take_multiplications`].
    multiplications: f64,
}

impl Coarsest {
    /// An elimination without memory.
    pub fn new() -> Coarsest {
        Coarsest {
            elements: Vec::new(),
            matrix: Vec::new(),
            right: Vec::new(),
            permutation: Vec::new(),
            inverse: Vec::new(),
            scratch: MemBuffer::new(StackReq::EMPTY),
            multiplications: 0.0,
        }
    }

    /// Multiplications of eliminations since the last call: `n^3/3` each.
    pub fn take_multiplications(&mut self) -> f64 {
        std::mem::take(&mut self.multiplications)
    }

    /// Solves `A x = b` on the elements in contact; `x = 0` elsewhere.
    pub fn solve(&mut self, coefficients: &Coefficients, grid: &Grid, contact: &[bool], b: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        self.elements.clear();
        self.elements.extend((0..grid.len()).filter(|&i| contact[i]));
        let n = self.elements.len();
        if n == 0 {
            return;
        }
        self.multiplications += (n as f64).powi(3) / 3.0;
        dense::fill_matrix(grid, &self.elements, |x, y| coefficients.at(x, y), &mut self.matrix);
        self.right.clear();
        self.right.extend(self.elements.iter().map(|&i| b[i]));
        if self.permutation.len() < n {
            self.permutation.resize(n, 0);
            self.inverse.resize(n, 0);
            self.scratch = MemBuffer::new(StackReq::any_of(&[
                factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default()),
                solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq),
            ]));
        }
        let stack = MemStack::new(&mut self.scratch);
        let (permutation, inverse) = (&mut self.permutation[..n], &mut self.inverse[..n]);
        let mut matrix = MatMut::from_column_major_slice_mut(&mut self.matrix, n, n);
        let (_, rows) = factor::lu_in_place(matrix.rb_mut(), permutation, inverse, Par::Seq, stack, Default::default());
        let right = MatMut::from_column_major_slice_mut(&mut self.right, n, 1);
        let factors = matrix.as_ref();
        solve::solve_in_place_with_conj(factors, factors, rows, Conj::No, right, Par::Seq, stack);
        for (&i, value) in self.elements.iter().zip(&self.right) {
            x[i] = *value;
        }
    }
}
