//! The exact solution on the coarsest grid, by Gaussian elimination (LU factors) for the elements in contact.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::prelude::ReborrowMut;
use faer::{Conj, MatMut, Par};

use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::dense;

/// The elimination, with memory for the largest number of elements so far.
pub struct Coarsest {
    /// The elements in contact.
    elements: Vec<usize>,
    /// The coefficients between these elements, column by column; later the LU factors.
    matrix: Vec<f64>,
    /// The right-hand side; later the solution.
    right: Vec<f64>,
    /// The permutation of rows by pivoting, and its inverse.
    permutation: Vec<usize>,
    inverse: Vec<usize>,
    scratch: MemBuffer,
    /// The multiplications since the last [`Coarsest::take_multiplications`].
    multiplications: f64,
}

impl Coarsest {
    /// Creates an elimination. It allocates memory when it is first used.
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

    /// Returns the multiplications since the last call: `n^3/3` for each elimination with n elements.
    pub fn take_multiplications(&mut self) -> f64 {
        std::mem::take(&mut self.multiplications)
    }

    /// Solves `A x = b` on the elements in contact, with `x = 0` elsewhere.
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
