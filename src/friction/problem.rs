//! The tangential problem of one grid ([`Problem`]) and its unknowns ([`State`]).
//!
//! Find tractions q on C with
//!
//! ```text
//! s = w + A q                         the slip; w is the rigid slip less u', the displacement before the step
//! stick:  s = 0,             |q| <= g
//! slip:   s = -lambda q,     |q| = g,     lambda >= 0
//! outside C:                  q = 0
//! ```
//!
//! The solution minimises `1/2 q.Aq + w.q` over the discs `|q| <= g`. This function is strictly convex, so there is one solution. In steady rolling
//! B of [`sweep`](super::sweep) takes the place of A.

use super::beside::{count_near, extension_on};
use super::operators::Operators;
use super::places::Places;
use super::plane::{add, clip, square, Vector};
use super::row_tables::RowTables;
use super::sweep::Rolling;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{blank, keep};
use crate::methods::extension::Extension;
use crate::methods::fields::{self, Stored, BLOCK};
use crate::threads::Threads;

pub const FIELDS: &str = "tangential fields";

/// Weights below this part of the largest one are ignored where weights bound the search for creepages.
const LEAST_WEIGHT: f64 = 1e-6;

/// The slip to which residuals are relative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// The larger of the rigid slip and the displacements: for a shift, and for steady rolling with a given force.
    SlipOrDisplacement,
    /// The rigid slip of the step, but at least the round-off of the displacements: for other rolling.
    Slip,
}

/// The round-off of displacements relative to them. A residual scale is never smaller, however slowly the bodies roll.
const ROUND_OFF: f64 = 1.5e-8;

impl Scale {
    /// The scale, from the rms over C of the rigid slip and of the displacements.
    pub fn of(self, rigid: f64, displacement: f64) -> f64 {
        match self {
            Scale::SlipOrDisplacement => rigid.max(displacement),
            Scale::Slip => rigid.max(ROUND_OFF * displacement),
        }
    }
}

/// The tangential problem on one grid, which is a box around C or a coarser grid of this box.
pub struct Problem {
    /// The grid.
    pub grid: Grid,
    /// The traction bound g of each element; 0 outside C.
    pub bound: Vec<f64>,
    /// The rigid slip of each element, without the part of `offset`.
    pub rigid: Vec<Vector>,
    /// w of each element, the rigid slip less u', without the part of `offset`.
    pub slip: Vec<Vector>,
    /// Creepages times the length of the step. They add `weights * offset` to the rigid slip and to w. With given forces they are unknowns.
    pub offset: Vector,
    /// The weights of the creepages at each element, in x and y; empty if all are 1.
    pub weights: Vec<Vector>,
    /// In steady rolling: the difference, by spin, of the rigid slips at two points one step apart.
    pub ahead: Vector,
    /// The scale of residuals.
    pub scale: Scale,
    /// Products with A, or with B in steady rolling.
    pub operators: Operators,
    /// The extension of residuals beyond C for Newton's method; none before [`Problem::continue_residuals`].
    pub extension: Option<Extension<f64, 2>>,
    /// The elements of C.
    pub places: Places,
    /// With given forces: rms over C of the rigid slip without `offset`. The round-off of s is relative to it if the creepages cancel this slip.
    pub rms_given_slip: f64,
    /// rms over C of u', the displacement before the step. The round-off of s is relative to it as well.
    pub rms_previous: f64,
    /// rms over C of the change of q in the last step of the iteration.
    pub update: f64,
    /// rms over C of g.
    rms_bound: f64,
}

/// The unknowns: tractions and their displacements.
#[derive(Default)]
pub struct State {
    /// q of each element; 0 outside C.
    pub q: Vec<Vector>,
    /// u = A q, up to the accuracy that `is_exact` tells.
    pub u: Vec<Vector>,
    /// Whether u is a product of the present q in double precision. Otherwise u was updated step by step, or computed in single precision.
    pub is_exact: bool,
}

impl State {
    /// Allocates a state whose values are NaN: call [`State::unload`] before reading them.
    pub fn new(n: usize) -> Result<State> {
        let field = || blank(n, [f64::NAN; 2], FIELDS);
        Ok(State { q: field()?, u: field()?, is_exact: false })
    }

    /// Sets q and u to 0.
    pub fn unload(&mut self, threads: &Threads) {
        let State { q, u, is_exact } = self;
        threads.for_each_row_pair((q, BLOCK), (u, BLOCK), |_, q, u| {
            q.fill([0.0; 2]);
            u.fill([0.0; 2]);
        });
        *is_exact = true;
    }
}

impl Drop for State {
    fn drop(&mut self) {
        keep([&mut self.q, &mut self.u]);
    }
}

impl Drop for Problem {
    fn drop(&mut self) {
        keep([&mut self.bound]);
        keep([&mut self.rigid, &mut self.slip]);
    }
}

impl Problem {
    /// A problem on a grid. Its bounds and slips are NaN until the caller sets them.
    pub fn new(grid: Grid, operators: Operators) -> Result<Problem> {
        let n = grid.len();
        Ok(Problem {
            grid,
            bound: blank(n, f64::NAN, FIELDS)?,
            rigid: blank(n, [f64::NAN; 2], FIELDS)?,
            slip: blank(n, [f64::NAN; 2], FIELDS)?,
            offset: [0.0; 2],
            weights: Vec::new(),
            ahead: [0.0; 2],
            scale: Scale::SlipOrDisplacement,
            extension: None,
            operators,
            places: Places::new(&grid)?,
            rms_given_slip: 0.0,
            rms_previous: 0.0,
            update: 0.0,
            rms_bound: 0.0,
        })
    }

    /// Sets up the extension of residuals beyond C, unless it exists. Steady rolling has none.
    pub fn continue_residuals(&mut self) -> Result<()> {
        if self.operators.rolling.is_none() && self.extension.is_none() {
            self.extension = extension_on(&self.grid, self.threads())?;
            count_near(&mut self.extension, &self.bound);
        }
        Ok(())
    }

    /// Recomputes the elements of C and the rms bound after a change of `bound`.
    pub fn bound_changed(&mut self) {
        count_near(&mut self.extension, &self.bound);
        self.places.contact_changed(&self.bound);
        let (threads, bound) = (self.threads(), &self.bound);
        let largest = fields::largest(threads, bound.len(), |i| bound[i]);
        // If all bounds are 0, `0/0` is NaN, and `max` makes it 0.
        let [squares] = fields::sum(threads, bound.len(), |i| [(bound[i] / largest).max(0.0).powi(2)]);
        self.rms_bound = largest * (squares / self.count().max(1) as f64).sqrt();
    }

    /// Whether the operators are those of a grid and of a step of steady rolling. `first_row` is the first row of the grid in tables per loaded row,
    /// if there are such tables.
    pub fn suits(&self, grid: &Grid, first_row: Option<usize>, rolling: Option<Rolling>) -> bool {
        let present = self.operators.tangential.rows().map(RowTables::first);
        self.grid == *grid && present == first_row && self.operators.step() == rolling
    }

    /// The indices of the elements of C.
    pub fn contact(&self) -> impl Iterator<Item = usize> + '_ {
        self.places.elements()
    }

    /// The threads that suit the size of this grid.
    pub fn threads(&self) -> &Threads {
        &self.operators.threads
    }

    /// The number of elements of C.
    pub fn count(&self) -> usize {
        self.places.count()
    }

    /// rms over C of g.
    pub fn rms_bound(&self) -> f64 {
        self.rms_bound
    }

    /// The order of magnitude of the displacement of an element by a traction of the size of the bounds.
    pub fn displaced_by_bounds(&self) -> f64 {
        self.operators.self_influence * self.rms_bound
    }

    /// `s = w + u` of element i.
    #[inline]
    pub fn slip_at(&self, i: usize, u: &[Vector]) -> Vector {
        let (w, offset, u) = (self.slip[i], self.weighted(i, self.offset), u[i]);
        [w[0] + offset[0] + u[0], w[1] + offset[1] + u[1]]
    }

    /// The weights of element i times c. With creepages c it is their slip of the element, with a traction c the part of the element in the forces.
    #[inline]
    pub fn weighted(&self, i: usize, c: Vector) -> Vector {
        match self.weights.get(i) {
            Some(weight) => [weight[0] * c[0], weight[1] * c[1]],
            None => c,
        }
    }

    /// The inverse of the least absolute weight: a creepage of this size moves each element by at least 1. Weights below [`LEAST_WEIGHT`] times the
    /// largest one are ignored.
    pub fn farthest_creepage(&self) -> f64 {
        let sizes = || self.weights.iter().flatten().map(|weight| weight.abs());
        let largest = sizes().fold(0.0, f64::max);
        let least = sizes().filter(|weight| *weight > LEAST_WEIGHT * largest).fold(largest, f64::min);
        if least > 0.0 {
            1.0 / least
        } else {
            1.0
        }
    }

    /// The scale of residuals, from the rms of the rigid slip and of the displacements. It is at least the round-off of the slip.
    pub fn compared(&self, rigid: f64, displacement: f64) -> f64 {
        self.scale.of(rigid, displacement).max(ROUND_OFF * self.rms_given_slip.max(self.rms_previous))
    }

    /// The rms over C of a field.
    pub fn rms(&self, value: impl Fn(usize) -> Vector + Sync + Send) -> f64 {
        let squared = |i: usize| [if self.bound[i] > 0.0 { square(value(i)) } else { 0.0 }];
        let [sum] = fields::sum(self.threads(), self.bound.len(), squared);
        self.rms_of(sum)
    }

    /// The rms over C of a field, from its sum of squares.
    pub fn rms_of(&self, squares: f64) -> f64 {
        (squares / self.count().max(1) as f64).sqrt()
    }

    /// rms over C of w.
    pub fn rms_slip(&self) -> f64 {
        self.rms(|i| add(self.slip[i], self.weighted(i, self.offset)))
    }

    /// rms over C of the rigid slip.
    pub fn rms_rigid(&self) -> f64 {
        self.rms(|i| add(self.rigid[i], self.weighted(i, self.offset)))
    }

    /// Projects q onto the discs, so that `|q| <= g` to the last bit, and computes u = A q by a fresh product.
    pub fn refresh(&mut self, state: &mut State) {
        self.clip(state);
        self.refresh_unclipped(state);
    }

    /// Computes `u = A q` by a fresh product, and leaves q unchanged.
    pub fn refresh_unclipped(&mut self, state: &mut State) {
        self.operators.multiply(&state.q, self.rms_bound, &mut state.u);
        state.is_exact = true;
    }

    /// [`Problem::refresh`], in single precision if its round-off is below the tolerance.
    pub fn refresh_to(&mut self, state: &mut State, tolerance: f64) {
        if tolerance < f32::ROUND_OFF {
            return self.refresh(state);
        }
        self.clip(state);
        self.operators.multiply_fast(&state.q, self.rms_bound, &mut state.u);
        state.is_exact = self.operators.fast_is_exact();
    }

    fn clip(&self, state: &mut State) {
        let (bound, threads) = (&self.bound, self.threads());
        fields::map(threads, &mut state.q, |i, q| clip(q, bound[i]));
    }

    /// Returns the number of products since the last call of this function.
    pub fn take_products(&mut self) -> u64 {
        std::mem::take(&mut self.operators.products)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.operators.bytes()
            + self.grid.len() * (size_of::<f64>() + 2 * size_of::<Vector>())
            + size_of_val(&self.weights[..])
    }
}
