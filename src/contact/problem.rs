//! The problem that all methods solve: grid, influence coefficients and operator. The solver owns the problem.

use std::sync::Arc;

use super::admissible::AdmissibleSet;
use super::operators::{MadeOf, Operators};
use super::state::{Freshness, State};
use crate::blocks::BLOCK;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::Operator;
use crate::sums::Sums;
use crate::threads::Threads;

/// Round-off of a displacement computed by FFT, a few units of round-off. It is relative to the displacement of an element by its own pressure, or to
/// the terms of a distance.
pub const PRODUCT_ROUND_OFF: f64 = 16.0 * f64::EPSILON;
/// A wave of pressure of this length, in elements, causes a displacement of about the same amplitude as a pressure on one element causes there.
const WAVE_OF_SELF_INFLUENCE: f64 = 16.0;

/// The equations `e = h - approach + A p` of one grid: A and its products. h, the load and the unknowns are in [`State`].
pub struct Problem {
    /// The grid.
    pub grid: Grid,
    /// The influence coefficients, of which A consists.
    pub coefficients: Coefficients,
    /// Whether A is symmetric.
    pub symmetric: bool,
    /// Whether the caller gave the coefficients. Such coefficients need not be those of an elastic body.
    pub given: bool,
    /// Whether the surface of the last solve ends between elements only. Error estimates use this.
    pub exact_edges: bool,
    /// Whether the surface of the last solve has no jumps. Error estimates use this.
    pub exact_jumps: bool,
    /// The cost of one product on this grid, in work units.
    pub work: f64,
    /// The threads of the solve.
    pub threads: Threads,
    operators: Operators,
    products: u64,
}

impl Problem {
    /// Sets up the problem of the finest grid.
    pub fn new(grid: Grid, coefficients: Coefficients, threads: &Threads) -> Result<Problem> {
        Problem::with(Operators::default(), grid, coefficients, 1.0, threads)
    }

    /// The problem of a grid whose operator exists already. A product on it costs `work` work units.
    pub fn with_operator(
        grid: Grid,
        coefficients: Coefficients,
        operator: Arc<Operator<f64>>,
        work: f64,
        threads: &Threads,
    ) -> Result<Problem> {
        Problem::with(Operators::with(operator), grid, coefficients, work, threads)
    }

    fn with(
        mut operators: Operators,
        grid: Grid,
        coefficients: Coefficients,
        work: f64,
        threads: &Threads,
    ) -> Result<Problem> {
        operators.prepare(MadeOf { coefficients: &coefficients, grid: &grid, threads })?;
        let symmetric = coefficients.is_symmetric(&grid);
        let threads = threads.clone();
        Ok(Problem {
            grid,
            coefficients,
            symmetric,
            given: false,
            exact_edges: false,
            exact_jumps: false,
            work,
            threads,
            operators,
            products: 0,
        })
    }

    /// Replaces the coefficients on the same grid. Plans and memory are kept if the operator is not shared. After an error, `renew` must succeed
    /// before the problem is used.
    pub fn renew(&mut self, coefficients: Coefficients) -> Result<()> {
        self.symmetric = coefficients.is_symmetric(&self.grid);
        self.coefficients = coefficients;
        let Problem { coefficients, grid, threads, operators, .. } = self;
        operators.renew(MadeOf { coefficients, grid, threads })
    }

    /// Returns the operator for any p if the product with `p` uses it, otherwise None.
    pub fn operator_if_needed(&mut self, p: &[f64]) -> Result<Option<Arc<Operator<f64>>>> {
        let Problem { coefficients, grid, threads, operators, .. } = self;
        operators.whole_if_needed(MadeOf { coefficients, grid, threads }, p)
    }

    /// Returns the operator for any p, and sets it up at the first call.
    pub fn operator(&mut self) -> Result<&Arc<Operator<f64>>> {
        let Problem { coefficients, grid, threads, operators, .. } = self;
        operators.whole(MadeOf { coefficients, grid, threads })
    }

    /// The displacement of an element by a unit pressure on itself.
    pub fn self_influence(&self) -> f64 {
        self.coefficients.self_influence()
    }

    /// The modulus E* of half-spaces that have the kernel's influence of an element on itself. For kernels of elastic bodies it is their E*.
    pub fn modulus(&self) -> f64 {
        let kernel = self.coefficients.kernel();
        self.grid.modulus(kernel.at(0, 0) - kernel.constant())
    }

    /// The compliance c of the layer on element `i`.
    pub fn layer(&self, i: usize) -> f64 {
        self.coefficients.layer(i)
    }

    /// See [`State::round_off`].
    pub fn round_off(&self) -> f64 {
        let of_element = PRODUCT_ROUND_OFF * self.self_influence();
        match self.coefficients.is_mean_free() {
            // The displacements by waves as long as the whole grid cancel in the sum. They grow with the wave's length, and so does their round-off.
            true => of_element * (1.0 + self.grid.mx.max(self.grid.my) as f64 / WAVE_OF_SELF_INFLUENCE),
            false => of_element,
        }
    }

    /// Computes `u = A p`.
    pub fn displace(&mut self, p: &[f64], u: &mut [f64]) -> Result<()> {
        let Problem { coefficients, grid, threads, operators, .. } = self;
        operators.displace(MadeOf { coefficients, grid, threads }, p, u)?;
        self.products += 1;
        if self.coefficients.is_mean_free() {
            remove_mean(u, &self.threads);
        }
        Ok(())
    }

    /// Replaces p by A p, which has the bits that [`displace`](Problem::displace) computes.
    pub fn displace_in_place(&mut self, p: &mut [f64]) -> Result<()> {
        let Problem { coefficients, grid, threads, operators, .. } = self;
        operators.displace_in_place(MadeOf { coefficients, grid, threads }, p)?;
        self.products += 1;
        if self.coefficients.is_mean_free() {
            remove_mean(p, &self.threads);
        }
        Ok(())
    }

    /// Makes p admissible and lets it carry a prescribed force, computes u = A p by a fresh product, and fits the approach to h + u.
    pub fn refresh<S: AdmissibleSet>(&mut self, state: &mut State, set: S) -> Result<()> {
        state.carry_force(set, &self.threads);
        self.displace(&state.p, &mut state.u)?;
        state.u_is = Freshness::Exact;
        state.fit_approach(&self.threads);
        Ok(())
    }

    /// Returns the number of products since the last call of this function.
    pub fn take_products(&mut self) -> u64 {
        std::mem::take(&mut self.products)
    }

    /// Releases the workspace of products until the next product.
    pub fn rest(&mut self) {
        self.operators.rest();
    }

    /// Bytes of the operator for any p.
    pub fn bytes_of_operator(&self) -> usize {
        self.operators.bytes_of_whole()
    }

    /// Bytes of the operators and of their workspace.
    pub fn bytes(&self) -> usize {
        self.operators.bytes()
    }
}

/// Subtracts the mean of u. In a scene with two periods the exact mean is 0; the mean of a product is round-off of sums over the whole grid.
fn remove_mean(u: &mut [f64], threads: &Threads) {
    let mut sums = Sums::new();
    sums.add::<f64, 1, 0>([&*u], [], |[u], []| [u]);
    let [sum] = sums.values();
    let mean = sum / u.len() as f64;
    if mean.is_finite() {
        threads.for_a_pass(u.len()).for_each_plain_row(u, BLOCK, |_, u| u.iter_mut().for_each(|u| *u -= mean));
    }
}
