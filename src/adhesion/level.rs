//! One grid: its operator and preconditioner, the unknowns, and the solver of contact problems with frozen attraction.

use std::sync::Arc;

use super::unknowns::{is_small, measure, Measured, Surface, Unknowns};
use crate::contact::{self, State};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::methods::fields::{self, Fields};
use crate::methods::projected_cg::Preconditioner;
use crate::operator::{Operator, Workspace};
use crate::progress::{Monitor, Outcome};
use crate::scene::Load;
use crate::threads::Threads;

/// A solver of the contact problem `e = h - approach + A q`, `q >= 0`, `e >= 0`, `q e = 0`, which is that of adhesion with frozen attraction.
pub trait Frozen: Send + Sync {
    /// Solves from `state`. `goal` has the tolerance of the residual and the largest number of cycles.
    fn solve(
        &mut self,
        problem: &mut contact::Problem,
        state: &mut State,
        goal: (f64, u64),
        monitor: &mut Monitor<'_>,
    ) -> Result<Outcome>;

    /// Bytes of the solver.
    fn bytes(&self) -> usize;
}

/// A solver of frozen problems, and the state of its contact problem.
pub type FrozenSolver = (Box<dyn Frozen>, State);

/// Makes a solver of frozen problems on a grid.
pub type MakeFrozen<'a> = &'a dyn Fn(&contact::Problem) -> Result<Box<dyn Frozen>>;

/// In [`Level::open`] an element leaves the contact if its q - e/a0 exceeds the smallest one by less than this fraction of the range of q - e/a0.
const OPENING_PRESSURE: f64 = 0.01;

/// The preconditioner M in single precision: the inverse of a circulant near A. Residuals are not extended beyond C, because separate equations
/// determine the pressures there. A sphere of Tabor's parameter 3 on 256 x 256 elements takes 18 to 21 products without the normal problem's
/// extension, and 30 to 47 with it.
struct Inverse {
    /// M of the coefficients divided by a power of two near a0, so that its numbers are near 1.
    m: Preconditioner<f32>,
    workspace: Workspace<f32>,
    /// This power of two. `m` is `unit M`, so that `a0 M` is `m a0/unit`.
    unit: f64,
}

/// One grid, with its problem, unknowns and memory.
pub struct Level {
    /// The influence coefficients, and products by them.
    pub problem: contact::Problem,
    /// The cost of a product, relative to one on the finest grid.
    pub work: f64,
    /// The undeformed distances and the attraction.
    pub surface: Surface,
    /// The current iterate.
    pub now: Unknowns,
    /// The last iterate from which descent can continue, as [kept](Unknowns::keep).
    pub good: Unknowns,
    /// The pool of fields for linear solves. All grids share it, and the active one has it.
    pub fields: Fields<1>,
    /// The preconditioner; `None` if the circulant has no positive inverse.
    inverse: Option<Inverse>,
    /// The solver of frozen problems. On a small grid it is made when first needed, and kept.
    pub frozen: Option<FrozenSolver>,
    /// On a large grid: the largest number of bytes of the fields together with the solver of frozen problems, so far.
    at_most: usize,
}

impl Level {
    /// A grid with these unknowns. `work` is the cost of a product relative to one on the finest grid.
    pub fn new(
        (grid, coefficients): (Grid, Coefficients),
        operator: Arc<Operator<f64>>,
        (now, work): (Unknowns, f64),
        threads: &Threads,
    ) -> Result<Level> {
        let threads = &threads.suited_to(grid.len());
        let problem = contact::Problem::with_operator(grid, coefficients, operator, 1.0, threads)?;
        let unit = problem.self_influence().log2().round().exp2();
        let inverse = match Preconditioner::new(&problem.coefficients, 1.0 / unit, &grid, threads)? {
            None => None,
            Some(m) => Some(Inverse { workspace: m.inverse().workspace()?, m, unit }),
        };
        Ok(Level {
            problem,
            work,
            surface: Surface::default(),
            now,
            good: Unknowns::default(),
            fields: Fields::touched_by(threads),
            inverse,
            frozen: None,
            at_most: 0,
        })
    }

    /// The influence a0 of an element on itself.
    pub fn self_influence(&self) -> f64 {
        self.problem.self_influence()
    }

    /// Computes the residuals of the current iterate. C is first updated by the natural map, unless it `is_kept`. `wanted`: the sum of p if the
    /// force is given.
    pub fn measure(&mut self, is_kept: bool, wanted: Option<f64>) -> Measured {
        let of_element = (self.self_influence(), self.problem.round_off());
        let is_mean_free = wanted.is_none() && self.is_mean_free();
        measure(&self.surface, &mut self.now, of_element, (is_kept, wanted, is_mean_free), &self.problem.threads)
    }

    /// Whether no element is in contact, and none attracts at its undeformed or at its deformed distance. Bodies that are drawn together attract
    /// each other although their undeformed distance is beyond the reach of the attraction.
    pub fn leaves_nothing(&self) -> bool {
        let (surface, now) = (&self.surface, &self.now);
        let distances = |i: usize| [surface.h[i] - now.approach(), surface.distance(i, now)];
        let attracts = |i: usize| distances(i).into_iter().any(|distance| surface.traction(i, distance) > 0.0);
        !now.contact.contains(&true) && !(0..now.contact.len()).any(attracts)
    }

    /// Whether a uniform pressure displaces nothing.
    pub fn is_mean_free(&self) -> bool {
        self.problem.coefficients.is_mean_free()
    }

    /// Lowers all pressures by a constant, so that the elements with the smallest values of the natural map leave the contact. With two periods
    /// the constant displaces nothing.
    pub fn open(&mut self) {
        let (surface, a0, n) = (&self.surface, self.self_influence(), self.now.u.len());
        let pressing = |i: usize| {
            let e = surface.distance(i, &self.now);
            self.now.p.field[i][0] + surface.traction(i, e) - e / a0
        };
        let widen = |(least, most): (f64, f64), value: f64| (least.min(value), most.max(value));
        let (least, most) = (0..n).map(pressing).fold((f64::INFINITY, f64::NEG_INFINITY), widen);
        let by = least + OPENING_PRESSURE * (most - least);
        fields::map(&self.problem.threads, &mut self.now.p.field, |_, [p]| [p - by]);
    }

    /// Computes u = A p by a fresh product.
    pub fn refresh(&mut self) -> Result<()> {
        let Level { problem, now, .. } = self;
        problem.displace(now.p.field.as_flattened(), now.u.as_flattened_mut())
    }

    /// Computes `z = M (a0 y)` on C. Outside, z is not meaningful.
    pub fn precondition(&mut self, y: &[[f32; 1]], z: &mut [[f32; 1]]) {
        let a0 = self.problem.self_influence();
        let (contact, threads) = (&self.now.contact, &self.problem.threads);
        let Some(Inverse { m, workspace, unit }) = &mut self.inverse else {
            return z.copy_from_slice(y);
        };
        let factor = (a0 / *unit) as f32;
        fields::fill(threads, z, |i| [if contact[i] { factor * y[i][0] } else { 0.0 }]);
        m.apply_alone(z.as_flattened_mut(), workspace);
    }

    /// Adds the products that this grid has made since the last call to the count of the solve.
    pub fn count_products(&mut self, monitor: &mut Monitor<'_>) {
        monitor.count_products(self.problem.take_products(), self.work);
    }

    /// Takes the solver of frozen problems and its state. A large grid makes them for each descent, in place of the fields of linear solves.
    pub fn take_frozen(&mut self, make: MakeFrozen<'_>) -> Result<FrozenSolver> {
        if let Some(still) = self.frozen.take() {
            return Ok(still);
        }
        self.clear_fields(0);
        let state = State::new(self.problem.grid, (Load::Approach(0.0), 0.0), &self.problem.threads)?;
        Ok((make(&self.problem)?, state))
    }

    /// Gives the solver of frozen problems back. A large grid frees it.
    pub fn give_frozen(&mut self, still: FrozenSolver) {
        self.clear_fields(bytes_of(&still));
        self.frozen = Some(still).filter(|_| is_small(self.now.u.len()));
    }

    /// Frees the fields of a large grid. `beside`: bytes of other memory in use at the same time. Descent, Newton's method and Lanczos' iteration
    /// follow each other, and none of them reads fields of another.
    pub fn clear_fields(&mut self, beside: usize) {
        if !is_small(self.now.u.len()) {
            self.at_most = self.at_most.max(self.fields.bytes() + beside);
            self.fields = Fields::touched_by(&self.problem.threads);
        }
    }

    /// Bytes of the grid, without [`Level::bytes_at_work`].
    pub fn bytes(&self) -> usize {
        let inverse = self.inverse.as_ref().map_or(0, |inverse| inverse.m.bytes() + inverse.workspace.bytes());
        let surface = size_of_val(&self.surface.h[..]) + size_of_val(&self.surface.works[..]);
        let unknowns = self.now.bytes() + self.good.bytes();
        self.problem.bytes() + inverse + surface + unknowns + self.frozen.as_ref().map_or(0, bytes_of)
    }

    /// The largest number of bytes of linear solves and of descents. Only one grid is active at a time.
    pub fn bytes_at_work(&self) -> usize {
        self.fields.bytes().max(self.at_most)
    }
}

fn bytes_of((frozen, state): &FrozenSolver) -> usize {
    frozen.bytes() + state.bytes()
}
