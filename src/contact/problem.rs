//! The problem of all methods: grid, influence coefficients, operator. The solver owns it.

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

/// Round-off of a displacement by FFT, relative to that of an element by itself or to the terms of a distance: some units of round-off.
pub const OF_PRODUCT: f64 = 16.0 * f64::EPSILON;
/// The length in elements of a wave whose response is about an element's influence on itself.
const WAVE_OF_SELF_INFLUENCE: f64 = 16.0;

/// `e = h - approach + A p` on one grid, without h, the load and the unknowns, which a [`State`] holds.
pub struct Problem {
    /// The grid.
    pub grid: Grid,
    /// Influence coefficients.
    pub coefficients: Coefficients,
    /// Whether A is symmetric.
    pub symmetric: bool,
    /// Whether the coefficients are the caller's, which need not be those of an elastic body.
    pub given: bool,
    /// Whether the surface of the last solve ends between elements only, for estimates.
    pub exact_edges: bool,
    /// Whether it has no jumps, for estimates.
    pub exact_jumps: bool,
    /// Work units of one product.
    pub work: f64,
    /// The threads of the solve.
    pub threads: Threads,
    operators: Operators,
    products: u64,
}

impl Problem {
    /// The problem of the finest grid.
    pub fn new(grid: Grid, coefficients: Coefficients, threads: &Threads) -> Result<Problem> {
        Problem::with(Operators::default(), grid, coefficients, 1.0, threads)
    }

    /// The problem of a grid; a product takes `work` of one on the finest.
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

    /// Takes other coefficients on the same grid, and keeps plans and memory if the operator is not shared. After an error the problem must be
    /// renewed before use.
    pub fn renew(&mut self, coefficients: Coefficients) -> Result<()> {
        self.symmetric = coefficients.is_symmetric(&self.grid);
        self.coefficients = coefficients;
        let Problem { coefficients, grid, threads, operators, .. } = self;
        operators.renew(MadeOf { coefficients, grid, threads })
    }

    /// A for any p, if the product with `p` needs it.
    pub fn operator_if_needed(&mut self, p: &[f64]) -> Result<Option<Arc<Operator<f64>>>> {
        let Problem { coefficients, grid, threads, operators, .. } = self;
        operators.whole_if_needed(MadeOf { coefficients, grid, threads }, p)
    }

    /// A for any p, set up at the first call.
    pub fn operator(&mut self) -> Result<&Arc<Operator<f64>>> {
        let Problem { coefficients, grid, threads, operators, .. } = self;
        operators.whole(MadeOf { coefficients, grid, threads })
    }

    /// The influence of an element on itself.
    pub fn self_influence(&self) -> f64 {
        self.coefficients.self_influence()
    }

    /// E* of half-spaces with the kernel's coefficients, if it is that of elastic bodies.
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
        let own = OF_PRODUCT * self.self_influence();
        match self.coefficients.is_mean_free() {
            // Displacements by waves of up to the whole grid cancel.
            true => own * (1.0 + self.grid.mx.max(self.grid.my) as f64 / WAVE_OF_SELF_INFLUENCE),
            false => own,
        }
    }

    /// `u = A p`.
    pub fn displace(&mut self, p: &[f64], u: &mut [f64]) -> Result<()> {
        let Problem { coefficients, grid, threads, operators, .. } = self;
        operators.displace(MadeOf { coefficients, grid, threads }, p, u)?;
        self.products += 1;
        if self.coefficients.is_mean_free() {
            remove_mean(u, &self.threads);
        }
        Ok(())
    }

    /// `p = A p`, with the same bits.
    pub fn displace_in_place(&mut self, p: &mut [f64]) -> Result<()> {
        let Problem { coefficients, grid, threads, operators, .. } = self;
        operators.displace_in_place(MadeOf { coefficients, grid, threads }, p)?;
        self.products += 1;
        if self.coefficients.is_mean_free() {
            remove_mean(p, &self.threads);
        }
        Ok(())
    }

    /// Makes p carry the prescribed force, computes u = A p by a fresh product, and fits the approach to both.
    pub fn refresh<S: AdmissibleSet>(&mut self, state: &mut State, set: S) -> Result<()> {
        state.carry_force(set, &self.threads);
        self.displace(&state.p, &mut state.u)?;
        state.u_is = Freshness::Exact;
        state.fit_approach(&self.threads);
        Ok(())
    }

    /// Products since the last call.
    pub fn take_products(&mut self) -> u64 {
        std::mem::take(&mut self.products)
    }

    /// Gives the memory of products back until the next product.
    pub fn rest(&mut self) {
        self.operators.rest();
    }

    /// Bytes of the operator for any p.
    pub fn bytes_of_operator(&self) -> usize {
        self.operators.bytes_of_whole()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.operators.bytes()
    }
}

/// With two periods the mean of u is 0: removes the mean of a product, which is round-off of sums over the whole grid.
fn remove_mean(u: &mut [f64], threads: &Threads) {
    let mut sums = Sums::new();
    sums.add::<f64, 1, 0>([&*u], [], |[u], []| [u]);
    let [sum] = sums.values();
    let mean = sum / u.len() as f64;
    if mean.is_finite() {
        threads.for_a_pass(u.len()).for_each_plain_row(u, BLOCK, |_, u| u.iter_mut().for_each(|u| *u -= mean));
    }
}
