//! Projected, preconditioned conjugate gradients on one grid: pressures and contact area together.
//!
//! ```text
//! r = -e on C, 0 outside          (prescribed force: the approach is the mean of h + u over C)
//! z = M r on C                    M: the inverse of a circulant near A
//! t = z + beta t on C,            beta = max(0, -(z, q)/(t, q)): the new direction is conjugate to the last
//! t = max(t, -p/alpha')           alpha': a forecast of alpha. Elements with t < -p/alpha' are *clipped*
//! q = A t,                        alpha = (r, t)/(t, q)
//! p = p + alpha t, u = u + alpha q
//! 4.1  elements with p < 0, and those clipped at -p/alpha', leave C with p = 0
//! 4.2  elements with e < 0 enter C
//! ```
//!
//! *Directions without force.* z and t have mean zero over C, so a step along t does not change the force. Clipping increases the sum of t, which is
//! lowered until its sum is 0 again. The force comes from a second change of p after the step along t:
//!
//! - With a prescribed force, p is scaled to carry the force.
//! - With a prescribed approach, p is scaled to the least energy (module `energy`), or moves along a deflation direction: the last change in time
//!   (module `along`), or a uniform pressure where few elements carry much of the force (module `uniform`).
//! - With a prescribed approach, directions carry force in three cases only: on a given C, after an element has reached its limit, or while p = 0
//!   cannot be scaled.
//!
//! The reason is that a residual which is uniform over C is the displacement by the pressure of a flat punch on C. M approximates this pressure
//! poorly, and p itself approximates it better. Measured products to 1e-6 with a prescribed approach, with directions that carry force and without:
//! ellipse 16 x 16 11.5 and 8.5, 64 x 64 11 and 8, 512 x 512 4.9 and 4.3; rough surface 512 x 512 19.3 and 11.
//!
//! *Why t is lowered.* Scaling p by one percent changes u by one percent, and the depth of a spike may be a thousand times the roughness of all other
//! elements. A clipped direction that is not lowered carries force, which the scaling then takes from the spike, and C alternates for ever. Planes of
//! 128 x 128 with a spike take 10 to 12 iterations on the finest grid; without lowering 23, 745, or no convergence. On rough surfaces lowering saves
//! one product in ten.
//!
//! *Truncation* of negative pressures changes p without a product: see module `truncation`. After a large truncation pressures may be far too large:
//! a coarse grid's h is a mean, with which white noise is in full contact. Then all of C may leave and enter in turn, for ever. Scaling prevents
//! that. Of 66 scenes of white noise with a prescribed approach, 19 failed without scaling, none with it.
//!
//! *The first step.* If u only approximates A p, after an interpolation from a coarser grid, [`Iteration::correct`] makes one step of a fixed length,
//! truncates, and then computes u. This takes one product instead of three. A prediction from earlier solutions, whose u is A p, may be negative and
//! is truncated. If the correction of this truncation is large, the first step has the length of the forecast, so that its product includes the whole
//! correction.
//!
//! *Precision.* p and u are double. t, q and z may be single, because their rounding errors are relative to the change of p, not to p. So directions
//! in single precision lead to a solution in double precision.

use super::search::{Search, FIRST_FORECAST};
use super::step_sums::{StepSums, Update};
use super::vectors::Iteration;
use crate::contact::{AdmissibleSet, NonNegative, State};
use crate::operator::fft::Real;
use crate::progress::Goal;

/// A correction is deferred if it is at most this fraction of the step. Both are measured by the sum of absolute changes of pressures. The number of
/// products hardly varies for fractions from 0.02 to 0.4.
pub(super) const LARGEST_DEFERRED: f64 = 0.1;
/// The length of a first step whose alpha is not computed: the optimum if the eigenvalues of M A lie between 1 and 4.
const FIRST_STEP: f64 = 2.0 / (1.0 + 4.0);
/// The largest alpha, relative to the forecast. Elements are clipped for the forecast, and a longer step truncates far more than it gains. Strips
/// with two periods do not converge without this bound.
const LONGEST_STEP: f64 = 2.0;
/// The round-off of directions leaves short waves in p that are hardly visible in the residual. Therefore the iteration ends, for a fresh u, when the
/// residual falls to this many units of round-off of its first value.
const ROUNDINGS: f64 = 800.0;
/// The iteration ends after this many iterations without a new smallest residual, because the contact area may cycle. On 162 scenes (ellipse, rough
/// surface, wheel and rail, white noise) 20 and 40 give the same results.
const PATIENCE: u32 = 20;
/// After an element has reached its limit, a residual counts as progress only below this fraction of the smallest one so far. This halves the number
/// of products on random scenes that take more than 120 with a fraction of 1. [`PATIENCE`] is the same with limits: on one rough surface of 256 x 256
/// elements nine iterations bring no progress and later ones do.
const PROGRESS_AT_LIMITS: f64 = 0.7;

/// What one iteration has changed.
#[derive(Clone, Copy, Debug)]
pub struct Cycle {
    /// The number of elements that left or entered C.
    pub changes: u64,
    /// An upper bound on the rms over C of the change of p.
    pub update: f64,
    /// The rms over C of p before the iteration.
    pub pressure: f64,
    /// The relative residual over C after the iteration.
    pub residual: f64,
    /// The number of products in the iteration.
    pub products: u64,
}

/// How the iteration on one grid ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The criterion holds with the u that was updated step by step.
    Met,
    /// All iterations are used up.
    Limit,
    /// The caller has cancelled the solve.
    Cancelled,
    /// `(t, q) <= 0`, by round-off or because the operator is not positive definite.
    Breakdown,
    /// The residual no longer decreases.
    Stagnated,
}

impl<T: Real> Iteration<T> {
    /// Makes one step of a fixed length from a u that approximates A p, with step (4.2) before and (4.1) after. Afterwards u is stale.
    pub fn correct<S: AdmissibleSet>(&mut self, state: &mut State, set: S) {
        self.deflation.forget();
        if self.preconditioner.is_some() {
            self.limits.forget();
            self.forget_directions(state.grid.mx);
            self.find_contact(state);
            self.choose_punches(state);
            let mut update = Update::default();
            self.least_energy::<S>(state, &mut update, None);
            if S::LIMITED && state.has_limited() {
                state.fit_approach(&self.threads);
            } else {
                self.fit_approach(state, &update);
            }
            self.update_displacements::<S>(state, &update);
            self.segments.find(&state.contact);
            self.residual(state);
            self.precondition(state);
            self.direct(state, 0.0, None);
            self.update_pressures(state, set, (FIRST_STEP, 0.0), None);
            self.truncation.clear();
            state.carry_force(set, &self.threads);
        }
    }

    /// Iterates from a state whose u is A p; p may be negative. `after_cycle` gets the measures of each iteration and returns whether to go on.
    pub fn run<S: AdmissibleSet>(
        &mut self,
        state: &mut State,
        set: S,
        (goal, is_mean_free): (&Goal, bool),
        mut after_cycle: impl FnMut(&Cycle) -> bool,
    ) -> End {
        let mut search = self.begin(state, set, is_mean_free);
        let mut cycle: Option<Cycle> = None;
        let (mut iterations, mut floor) = (0, None);
        let (mut least, mut since_least) = (f64::INFINITY, 0);
        loop {
            // r = -e on C
            let residual = self.residual(state);
            if let Some(cycle) = &mut cycle {
                cycle.residual = residual;
                if !after_cycle(cycle) {
                    return End::Cancelled;
                }
            }
            let floor = *floor.get_or_insert(ROUNDINGS * T::epsilon().to_double() * residual);
            let met = residual == 0.0 || cycle.as_ref().is_some_and(|cycle| cycle.meets(goal, floor));
            if met && (!S::LIMITED || self.limits.carries(state, goal)) {
                return End::Met;
            }
            if iterations == goal.max_cycles {
                return End::Limit;
            }
            since_least += 1;
            let progress = if S::LIMITED && state.reached_limit { PROGRESS_AT_LIMITS } else { 1.0 };
            if residual < progress * least {
                (least, since_least) = (residual, 1);
            }
            if since_least > PATIENCE {
                return End::Stagnated;
            }
            iterations += 1;
            cycle = self.iterate(state, set, &mut search);
            let Some(cycle) = &mut cycle else { return End::Breakdown };
            if self.is_another_area(cycle, iterations) {
                cycle.products += self.deflate::<S>(state, is_mean_free);
            }
        }
    }

    /// Makes steps (4.1) and (4.2) before the first iteration, sets up the deflation direction, and moves p along it.
    fn begin<S: AdmissibleSet>(&mut self, state: &mut State, set: S, is_mean_free: bool) -> Search {
        self.forget_directions(state.grid.mx);
        self.truncation.clear();
        self.find_contact(state);
        let mut update = Update::default();
        self.limits.forget();
        if self.update_pressures(state, set, (0.0, 0.0), None) > 0 {
            update.factor = self.carry_force::<S>(state);
        } else if S::LIMITED {
            update.factor = self.carry_beside_limits(state).unwrap_or(1.0);
        }
        // A predicted p is truncated. u is corrected for this before the residual is used.
        let products = u64::from(self.deflation.is_there() && self.truncation.sum() > 0.0);
        if products > 0 {
            self.correct_now();
            update.is_corrected = true;
        }
        self.least_energy::<S>(state, &mut update, None);
        self.fit_approach(state, &update);
        self.choose_punches(state);
        self.update_displacements::<S>(state, &update);
        self.segments.find(&state.contact);
        let products = products + self.deflate::<S>(state, is_mean_free) + self.restrict_deflation(state);
        self.step_along_deflation(state);
        let first = if self.truncation.sum() > 0.0 { FIRST_STEP } else { FIRST_FORECAST };
        // Without a preconditioner there is no first forecast.
        Search { products, ..Search::new(self.preconditioner.as_ref().map(|_| first)) }
    }

    /// Makes one iteration; z holds r. Returns None if (t, q) is not positive or a sum is not finite.
    fn iterate<S: AdmissibleSet>(&mut self, state: &mut State, set: S, search: &mut Search) -> Option<Cycle> {
        // z = M r, t = max(z + beta t, -p/alpha'), and the deferred correction
        self.precondition(state);
        let clipping = search.forecast.filter(|_| search.may_clip && !S::FIXED);
        self.direct(state, search.tq, clipping);
        clipping.filter(|_| S::LIMITED).into_iter().for_each(|forecast| self.clip_at_limit(state, set, forecast));
        let forecast = search.forecast.unwrap_or(1.0);
        self.truncation.include(&mut self.t, forecast);

        // q = A t, alpha = (r, t)/(t, q)
        self.operator.apply(&self.t, &mut self.q, &mut self.workspace);
        let (mut step, count) = (self.step_sums(state), self.segments.count() as f64);
        if !(step.tq > 0.0 && step.rt.is_finite()) {
            return None;
        }
        let alpha = self.step_length(&step, search, S::LIMITED && state.has_limited());
        let alpha = clipping.map_or(alpha, |forecast| alpha.min(LONGEST_STEP * forecast));
        let believed = search.believed(alpha);
        let is_near_limit = S::LIMITED && (state.reached_limit || self.reaches_limit(state, set, alpha, believed));
        if is_near_limit {
            self.deflation.forget();
            self.remember(state);
        }
        self.truncation.exclude((&mut self.t, &self.q), state, (forecast, alpha), &mut step);
        let included = self.truncation.count();

        // p = p + alpha t + gamma d, 4.1
        let gamma = self.gamma(&step, alpha);
        let left = if S::LIMITED && !is_near_limit {
            self.update_pressures(state, NonNegative, (alpha, gamma), believed)
        } else {
            self.update_pressures(state, set, (alpha, gamma), believed)
        };
        self.leave_deflation(gamma);
        search.expect(alpha, self.preconditioner.is_some());

        // u = u + alpha q + gamma w, 4.2
        let mut update = Update { alpha, gamma, ..Update::default() };
        let sums = step.energy.map(|energy| self.after_truncation(state, energy.after(alpha), alpha, included));
        let (limited, deferred) = (S::LIMITED && state.has_limited(), self.truncation.sum());
        if deferred > LARGEST_DEFERRED * alpha.abs() * step.t1 || search.forecast.is_none() && deferred > 0.0 {
            self.correct_now();
            update.is_corrected = true;
            if limited {
                self.step_back(state, set, &mut update);
                search.tq = 0.0;
            }
        }
        self.scale_to_load::<S>(state, &mut update, limited, sums);
        self.fit_approach(state, &update);
        let entered = self.update_displacements::<S>(state, &update);
        self.segments.find(&state.contact);
        Some(Cycle {
            changes: left + entered,
            update: step.change(alpha, gamma.abs() * self.deflation.norm(), update.factor) / count.sqrt(),
            pressure: (step.pp / count).sqrt(),
            residual: f64::INFINITY,
            products: 1 + u64::from(update.is_corrected) + std::mem::take(&mut search.products),
        })
    }

    /// The step length alpha. In the first step, and while elements are at their limit, alpha is the forecast if the product includes a large
    /// correction: u then gets the whole correction.
    fn step_length(&self, step: &StepSums, search: &mut Search, limited: bool) -> f64 {
        let alpha = step.rt / step.tq;
        search.tq = step.tq;
        let includes = std::mem::take(&mut search.is_first) || limited;
        if includes && self.truncation.sum() > LARGEST_DEFERRED * alpha.abs() * step.t1 {
            search.tq = 0.0;
            return search.forecast.unwrap_or(1.0);
        }
        alpha
    }
}

impl Cycle {
    /// Whether the criterion of the goal holds. A residual of at most `floor` satisfies any tolerance of the residual.
    fn meets(&self, goal: &Goal, floor: f64) -> bool {
        if goal.by_update() {
            self.update <= goal.tolerance * self.pressure
        } else {
            self.residual <= goal.tolerance.max(floor)
        }
    }
}
