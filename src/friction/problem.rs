//! The tangential problem of one grid, and its unknowns.
//!
//! Find tractions q on C with
//!
//! ```text
//! s = w + A q                         the slip; w is the rigid slip, minus the displacement u' before the step
//! stick:  s = 0,             |q| <= g
//! slip:   s = -lambda q,     |q| = g,     lambda >= 0
//! outside C:                  q = 0
//! ```
//!
//! It is the minimum of `1/2 q.Aq + w.q` over the discs `|q| <= g`, strictly convex: there is one solution.

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

/// Least weight of an element, relative to the largest, that bounds the creepages.
const LEAST_WEIGHT: f64 = 1e-6;

/// The scale of residuals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// The larger of the rigid slip and the displacements: a shift, and steady rolling by a force.
    SlipOrDisplacement,
    /// The rigid slip of the step: other rolling.
    Slip,
}

/// Round-off of displacements as a part of the scale, for slow rolling.
const ROUND_OFF: f64 = 1.5e-8;

impl Scale {
    /// The scale from the rms of both.
    pub fn of(self, rigid: f64, displacement: f64) -> f64 {
        match self {
            Scale::SlipOrDisplacement => rigid.max(displacement),
            Scale::Slip => rigid.max(ROUND_OFF * displacement),
        }
    }
}

/// The tangential problem of one grid, a box around C.
pub struct Problem {
    /// The box.
    pub grid: Grid,
    /// g, 0 outside C.
    pub bound: Vec<f64>,
    /// The rigid slip without `offset`.
    pub rigid: Vec<Vector>,
    /// w without `offset`: the rigid slip minus u'.
    pub slip: Vec<Vector>,
    /// The creepages in w and the rigid slip, times the weights: found if forces are given.
    pub offset: Vector,
    /// The weights of the creepages at each element; empty: 1.
    pub weights: Vec<Vector>,
    /// In steady rolling: the change of the slip by spin over a step.
    pub ahead: Vector,
    /// The scale of residuals.
    pub scale: Scale,
    /// A.
    pub operators: Operators,
    /// The extension of residuals beyond C for Newton's method, made by [`Problem::continue_residuals`].
    pub extension: Option<Extension<f64, 2>>,
    /// The elements of C.
    pub places: Places,
    /// With given forces: rms over C of the rigid slip without the found creepages, the scale of its round-off.
    pub given: f64,
    /// rms over C of u', the displacement before the step, the scale of its round-off.
    pub left: f64,
    /// rms over C of the last change of q.
    pub update: f64,
    /// rms over C of g.
    rms_bound: f64,
}

/// Tractions and their displacements.
#[derive(Default)]
pub struct State {
    /// q: 0 outside C.
    pub q: Vec<Vector>,
    /// u = A q, exactly if `is_exact`.
    pub u: Vec<Vector>,
    /// Whether u is a product of this q in double precision.
    pub is_exact: bool,
}

impl State {
    /// An undefined state: call [`State::unload`] first.
    pub fn new(n: usize) -> Result<State> {
        let field = || blank(n, [f64::NAN; 2], FIELDS);
        Ok(State { q: field()?, u: field()?, is_exact: false })
    }

    /// q = 0.
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
    /// A problem without bounds and slips.
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
            given: 0.0,
            left: 0.0,
            update: 0.0,
            rms_bound: 0.0,
        })
    }

    /// Sets up the extension of residuals beyond C, if missing. Steady rolling has none.
    pub fn continue_residuals(&mut self) -> Result<()> {
        if self.operators.rolling.is_none() && self.extension.is_none() {
            self.extension = extension_on(&self.grid, self.threads())?;
            count_near(&mut self.extension, &self.bound);
        }
        Ok(())
    }

    /// Updates C after a change of `bound`.
    pub fn bound_changed(&mut self) {
        count_near(&mut self.extension, &self.bound);
        self.places.contact_changed(&self.bound);
        let (threads, bound) = (self.threads(), &self.bound);
        let largest = fields::largest(threads, bound.len(), |i| bound[i]);
        // Without friction 0/0 gives 0.
        let [squares] = fields::sum(threads, bound.len(), |i| [(bound[i] / largest).max(0.0).powi(2)]);
        self.rms_bound = largest * (squares / self.count().max(1) as f64).sqrt();
    }

    /// Whether the operators suit a grid, for tables per loaded row from that row on, and a step.
    pub fn suits(&self, grid: &Grid, first: Option<usize>, rolling: Option<Rolling>) -> bool {
        let own = self.operators.tangential.rows().map(RowTables::first);
        self.grid == *grid && own == first && self.operators.step() == rolling
    }

    /// The elements of C.
    pub fn contact(&self) -> impl Iterator<Item = usize> + '_ {
        self.places.elements()
    }

    /// The threads of this grid.
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

    /// The order of the displacement by tractions of the size of the bounds.
    pub fn displaced_by_bounds(&self) -> f64 {
        self.operators.self_influence * self.rms_bound
    }

    /// `s = w + u` of element i.
    #[inline]
    pub fn slip_at(&self, i: usize, u: &[Vector]) -> Vector {
        let (w, offset, u) = (self.slip[i], self.weighted(i, self.offset), u[i]);
        [w[0] + offset[0] + u[0], w[1] + offset[1] + u[1]]
    }

    /// The slip of element i by creepages c. For a traction in place of c, it is the element's contribution to the forces.
    #[inline]
    pub fn weighted(&self, i: usize, c: Vector) -> Vector {
        match self.weights.get(i) {
            Some(weight) => [weight[0] * c[0], weight[1] * c[1]],
            None => c,
        }
    }

    /// The creepage that moves the element of the least weight by 1. Weights below [`LEAST_WEIGHT`] are ignored.
    pub fn farthest_creepage(&self) -> f64 {
        let sizes = || self.weights.iter().flatten().map(|weight| weight.abs());
        let most = sizes().fold(0.0, f64::max);
        let least = sizes().filter(|weight| *weight > LEAST_WEIGHT * most).fold(most, f64::min);
        if least > 0.0 {
            1.0 / least
        } else {
            1.0
        }
    }

    /// The scale of residuals, from the rms of the rigid slip and of the displacements.
    pub fn compared(&self, rigid: f64, displacement: f64) -> f64 {
        self.scale.of(rigid, displacement).max(ROUND_OFF * self.given.max(self.left))
    }

    /// rms over C of a field.
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

    /// Makes q feasible to the last bit, and u = A q by a fresh product.
    pub fn refresh(&mut self, state: &mut State) {
        self.clip(state);
        self.refresh_unclipped(state);
    }

    /// Makes `u = A q` by a fresh product, without change of q.
    pub fn refresh_unclipped(&mut self, state: &mut State) {
        self.operators.multiply(&state.q, self.rms_bound, &mut state.u);
        state.is_exact = true;
    }

    /// [`Problem::refresh`], in single precision if that suffices for the tolerance.
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

    /// Products since the last call.
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
