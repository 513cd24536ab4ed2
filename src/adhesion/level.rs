//! One grid: the operator, its preconditioner, the unknowns, and what solves the contact problem of an attraction that stands still.

use std::sync::Arc;

use super::unknowns::{measure, Measured, Surface, Unknowns, MEMORY};
use crate::contact::{self, State};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::zeros;
use crate::methods::fields::{self, Fields};
use crate::methods::projected_cg::Preconditioner;
use crate::operator::{Operator, Workspace};
use crate::progress::{Monitor, Outcome};
use crate::scene::Load;
use crate::threads::Threads;

/// Solves `e = h - approach + A q`, `q >= 0`, `e >= 0`, `q e = 0` from what a state holds: the contact problem that is left when the attraction
/// stands still.
pub trait Frozen: Send + Sync {
    /// To a tolerance of the residual, or until so many cycles are done.
    fn solve(
        &mut self,
        problem: &mut contact::Problem,
        state: &mut State,
        goal: (f64, u64),
        monitor: &mut Monitor<'_>,
    ) -> Result<Outcome>;

    /// Bytes held.
    fn bytes(&self) -> usize;
}

/// Makes what solves frozen problems on a grid.
pub type MakeFrozen<'a> = &'a dyn Fn(&contact::Problem) -> Result<Box<dyn Frozen>>;

/// M, the inverse of a circulant near A. Residuals are not continued beside C, where rows of their own tell what they are: a sphere of Tabor's
/// parameter 3 on 256 x 256 elements takes 18 to 21 products so, and 30 to 47 with the normal problem's extension.
struct Inverse {
    m: Preconditioner<f64>,
    workspace: Workspace<f64>,
    field: Vec<f64>,
}

/// One grid.
pub struct Level {
    /// Coefficients and products.
    pub problem: contact::Problem,
    /// The work of a product, that on the finest grid being 1.
    pub work: f64,
    /// The surfaces.
    pub surface: Surface,
    /// The unknowns now.
    pub now: Unknowns,
    /// The last state from which descent has to go on.
    pub good: Unknowns,
    /// For products of single fields.
    pub product: Vec<f64>,
    /// Fields of linear solves.
    pub fields: Fields<1>,
    inverse: Option<Inverse>,
    /// Of frozen problems, made when first needed.
    pub frozen: Option<(Box<dyn Frozen>, State)>,
}

impl Level {
    /// A grid, a product on which takes `work` of one on the finest.
    pub fn new(
        (grid, coefficients): (Grid, Coefficients),
        operator: Arc<Operator<f64>>,
        work: f64,
        threads: &Threads,
    ) -> Result<Level> {
        let threads = &threads.suited_to(grid.len());
        let problem = contact::Problem::with_operator(grid, coefficients, operator, 1.0, threads)?;
        let n = grid.len();
        let inverse = match Preconditioner::new(&problem.coefficients, 1.0, &grid, threads)? {
            None => None,
            Some(m) => {
                let workspace = m.inverse().workspace()?;
                Some(Inverse { workspace, m, field: zeros(n, MEMORY)? })
            }
        };
        Ok(Level {
            problem,
            work,
            surface: Surface::default(),
            now: Unknowns::new(n)?,
            good: Unknowns::default(),
            product: zeros(n, MEMORY)?,
            fields: Fields::default(),
            inverse,
            frozen: None,
        })
    }

    /// The influence of an element on itself.
    pub fn self_influence(&self) -> f64 {
        self.problem.self_influence()
    }

    /// Measures what is known now; C is that of the natural map unless it `is_kept`.
    pub fn measure(&mut self, is_kept: bool, wanted: Option<f64>) -> Measured {
        let a0 = self.self_influence();
        measure(&self.surface, &mut self.now, a0, (is_kept, wanted), &self.problem.threads)
    }

    /// u = A p by a fresh product.
    pub fn refresh(&mut self) -> Result<()> {
        let Level { problem, now, .. } = self;
        problem.displace(now.p.field.as_flattened(), now.u.as_flattened_mut())
    }

    /// `z = M (a0 y)` on C.
    pub fn precondition(&mut self, y: &[[f64; 1]], z: &mut [[f64; 1]]) {
        let a0 = self.problem.self_influence();
        let (contact, threads) = (&self.now.contact, &self.problem.threads);
        let Some(Inverse { m, workspace, field }) = &mut self.inverse else {
            return fields::fill(threads, z, |i| if contact[i] { y[i] } else { z_outside() });
        };
        threads.for_each_plain_row(&mut field[..], fields::BLOCK, |k, field| {
            for (k, value) in (k * fields::BLOCK..).zip(field) {
                *value = if contact[k] { a0 * y[k][0] } else { 0.0 };
            }
        });
        m.apply(field, (contact, false), &mut None, workspace);
        let field = &*field;
        fields::fill(threads, z, |i| if contact[i] { [field[i]] } else { z_outside() });
    }

    /// Adds the products made here since the last call to those of the solve.
    pub fn count_products(&mut self, monitor: &mut Monitor<'_>) {
        monitor.count_products(self.problem.take_products(), self.work);
    }

    /// The state of frozen problems, with what solves them.
    pub fn prepare_frozen(&mut self, make: MakeFrozen<'_>) -> Result<()> {
        if self.frozen.is_none() {
            let state = State::new(self.problem.grid, (Load::Approach(0.0), 0.0), &self.problem.threads)?;
            self.frozen = Some((make(&self.problem)?, state));
        }
        Ok(())
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let frozen = self.frozen.as_ref().map_or(0, |(methods, state)| methods.bytes() + state.bytes());
        let inverse = self
            .inverse
            .as_ref()
            .map_or(0, |inverse| inverse.m.bytes() + inverse.workspace.bytes() + size_of_val(&inverse.field[..]));
        let surface = size_of_val(&self.surface.h[..]) + size_of_val(&self.surface.works[..]);
        let unknowns = self.now.bytes() + self.good.bytes() + size_of_val(&self.product[..]);
        self.problem.bytes() + inverse + surface + unknowns + self.fields.bytes() + frozen
    }
}

/// The value outside C, which the preconditioner leaves to its caller.
fn z_outside() -> [f64; 1] {
    [0.0]
}
