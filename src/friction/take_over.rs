//! The start of a solve: sets the bounds g, the slip w and the first tractions q on the finest grid of the box.

use super::certificate::is_on_circle;
use super::displaced::displaced;
use super::excess::Excess;
use super::glued::NEGLIGIBLE_BOUND;
use super::levels::Level;
use super::plane::{add, length, square, Vector};
use super::problem::{Problem, Scale, State, FIELDS};
use super::request::{before, Request, Start};
use super::scales::Scales;
use super::solution::{Solution, EXTERIOR};
use super::solver::Solver;
use super::sweep::{Rolling, Sweep};
use crate::effects::{Coefficient, Friction, Motion, Previous};
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::memory::{blank, collected, unwritten, zeros};
use crate::methods::fields;
use crate::powers::LARGEST;
use crate::rectangle::Rectangle;

/// The largest ratio of rigid slips to displacements by tractions: numbers of single precision end at 1e38.
pub(super) const LARGEST_RATIO: f64 = 1e30;
/// The least such ratio of slips that are not 0. It is so small because the round-off of tangential displacements by pressures is a slip, too.
const LEAST_RATIO: f64 = 1e-60;

impl Solver {
    /// Allocates memory for the result, unless it is allocated already.
    pub(super) fn make_room(&mut self) -> Result<()> {
        if self.solution.traction.is_empty() {
            let n = self.grid.len();
            let field = || blank(n, [f64::NAN; 2], FIELDS);
            self.sums = zeros(self.grid.my, FIELDS)?;
            let stick_slip = blank(n, EXTERIOR, FIELDS)?;
            self.solution = Solution { traction: field()?, slip: field()?, stick_slip, particles: Vec::new() };
        }
        Ok(())
    }

    /// Copies the tractions of the last result: they are those before the step.
    pub(super) fn keep_tractions(&mut self) -> Result<()> {
        let last = &self.solution.traction;
        unwritten(&mut self.before, last.len(), [f64::NAN; 2], FIELDS, &self.threads)?;
        self.before.copy_from_slice(last);
        Ok(())
    }

    /// Sets g, w and the tractions of the start. Refuses slips out of range. Returns whether nearly all of C slips at the start.
    pub(super) fn begin(&mut self, request: &Request<'_>, from_rest: bool, window: &Rectangle) -> Result<bool> {
        let mostly_slips = self.set_problem(request, from_rest, window)?;
        self.reset_creepages_out_of_range();
        self.check_range()?;
        Ok(mostly_slips)
    }

    fn set_problem(&mut self, request: &Request<'_>, from_rest: bool, window: &Rectangle) -> Result<bool> {
        let Request { friction, start, .. } = *request;
        let (grid, kept, scales) = (&self.grid, &self.before, self.scales);
        let Level { problem, state, .. } = &mut self.levels[0];
        let (threads, width) = (problem.threads().clone(), problem.grid.mx);
        state.unload(&threads);
        threads.for_each_row_pair((&mut problem.bound, width), (&mut problem.rigid, width), |iy, bounds, rigid| {
            let places = window.row(grid, iy);
            for ((g, rigid), i) in bounds.iter_mut().zip(rigid).zip(places) {
                let traction = scales.traction(request.bound(i));
                *g = if traction < NEGLIGIBLE_BOUND { 0.0 } else { traction };
                *rigid = scales.displacement(request.rigid_slip(grid, i));
            }
        });
        take_weights_and_layer(problem, friction, (grid, window), &scales)?;
        if !from_rest {
            threads.for_each_plain_row(&mut state.q, width, |iy, row| {
                row.iter_mut()
                    .zip(window.row(grid, iy))
                    .for_each(|(q, i)| *q = in_range(before(friction, kept, i), &scales));
            });
        }
        take_step(problem, friction, grid, (&scales, self.offset));
        let found = friction.has_forces();
        (problem.rms_given_slip, problem.rms_previous, problem.update) = (0.0, 0.0, 0.0);
        problem.bound_changed();
        threads.for_each_row_pair((&mut problem.slip, width), (&mut problem.rigid, width), |_, slip, rigid| {
            slip.copy_from_slice(rigid);
        });
        if !from_rest {
            self.subtract_previous_displacements(friction)?;
        }
        if from_rest && matches!(start, Start::Before) {
            return Ok(false);
        }
        self.start_from(request, window);
        let Level { problem, state, .. } = &mut self.levels[0];
        let slipping = problem.contact().filter(|&i| square(state.q[i]).sqrt() >= 0.999 * problem.bound[i]).count();
        let mostly_slips = problem.places.is_mostly_slip(slipping);
        problem.refresh(state);
        if let Start::Given(_) = request.start {
            problem.offset = [0, 1].map(|k| if found[k] { creepage_of(problem, state, k) } else { 0.0 });
        }
        Ok(mostly_slips)
    }

    /// Sets the tractions of the start, and its creepages if forces are given. With [`Start::Before`] q is already that before the step.
    fn start_from(&mut self, request: &Request<'_>, window: &Rectangle) {
        let scales = self.scales;
        let Level { problem, state, .. } = &mut self.levels[0];
        match request.start {
            Start::Before => {}
            Start::Again | Start::Held(_) | Start::Last => {
                window
                    .elements(&self.grid)
                    .for_each(|(k, i)| state.q[k] = self.solution.traction[i].map(|q| scales.traction(q)));
                let found = request.friction.has_forces();
                let offset = if let Start::Held(offset) = request.start { offset } else { self.offset };
                problem.offset = scales.displacement([0, 1].map(|k| if found[k] { offset[k] } else { 0.0 }));
            }
            Start::Given([x, y]) => {
                window.elements(&self.grid).for_each(|(k, i)| state.q[k] = in_range([x[i], y[i]], &scales));
            }
        }
    }

    /// Subtracts u', the displacements before the step, from w, except in steady rolling. q of the state are the tractions before the step.
    fn subtract_previous_displacements(&mut self, friction: &Friction<'_>) -> Result<()> {
        let Level { problem, state, .. } = &mut self.levels[0];
        match friction.motion {
            Motion::SteadyRolling => return Ok(()),
            Motion::Shift => problem.operators.multiply(&state.q, problem.rms_bound(), &mut state.u),
            Motion::TransientRolling => {
                let by = friction.elements_rolled(&self.grid);
                let tangential = &problem.operators.tangential;
                let displaced = displaced(&mut self.displaced, tangential, problem.grid, by, &self.threads)?;
                displaced.apply(&state.q, &mut state.u);
                if let Some(excess) = &problem.operators.excess {
                    let rolling = Rolling { distance: self.scales.length(friction.distance(&self.grid)), by };
                    excess.subtract_ahead(&state.q, &Sweep::new(&rolling), &mut problem.slip);
                }
            }
        }
        for (w, u) in problem.slip.iter_mut().zip(&state.u) {
            *w = [w[0] - u[0], w[1] - u[1]];
        }
        problem.rms_previous = problem.rms(|i| state.u[i]);
        Ok(())
    }

    /// The order of magnitude of the displacement of an element by a traction at its bound, in the last solve.
    pub fn full_displacement(&self) -> f64 {
        let displaced = self.levels.first().map_or(0.0, |level| level.problem.displaced_by_bounds());
        self.scales.callers_displacement([displaced, 0.0])[0]
    }

    /// Starts the search for creepages at 0 if those of the start are out of range. They are not refused: the caller need not have given them.
    fn reset_creepages_out_of_range(&mut self) {
        let problem = &mut self.levels[0].problem;
        let ratio = length(problem.offset) / problem.displaced_by_bounds();
        if !(LEAST_RATIO < ratio && ratio < LARGEST_RATIO) {
            problem.offset = [0.0; 2];
        }
    }

    /// Refuses slips far above or below the displacements by tractions, because squares of their ratio would leave the range of numbers.
    fn check_range(&self) -> Result<()> {
        let problem = &self.levels[0].problem;
        let (slip, displaced) = (problem.rms_rigid(), problem.displaced_by_bounds());
        let is_far = |slip: f64| !(slip / displaced < LARGEST_RATIO);
        // Each slip is compared with 0, because the squares of tiny slips, and with them the rms, are 0.
        let rigid = |i: usize| add(problem.rigid[i], problem.weighted(i, problem.offset));
        let moves = problem.contact().any(|i| rigid(i) != [0.0; 2]);
        // w, which contains the displacements before the step, must be in range as well.
        let slipped = problem.rms_slip();
        let most = slip.max(slipped);
        if displaced > 0.0 && (is_far(slip) || is_far(slipped) || moves && !(most / displaced > LEAST_RATIO)) {
            // The message has the largest component if the rms of tiny slips is 0.
            let components = problem.contact().flat_map(rigid);
            let largest = components.fold(0.0, |most: f64, w| most.max(w.abs()));
            let slip = if most > 0.0 { most } else { largest };
            let motion = if slip > displaced { "a smaller motion" } else { "a larger motion or none" };
            let rule = format!("choose {motion}, coefficients of friction or shear moduli of another order");
            // A length that overflows in the caller's units is not printed as a number.
            let lengths = self.scales.callers_displacement([slip, displaced]);
            let [slip, displaced] =
                lengths.map(|length| if length.is_finite() { format!("{length:e}") } else { "1e308 or more".into() });
            return invalid(format!(
                "slips are of order {slip}, displacements by friction of order {displaced}, more than 1e30 times or less than 1e-60 times that; {rule}"
            ));
        }
        Ok(())
    }
}

/// Sets the first guess of the unknown creepages, the scale of residuals and `ahead` of the problem. `last` are the creepages that the last solve
/// found.
fn take_step(problem: &mut Problem, friction: &Friction<'_>, grid: &Grid, (scales, last): (&Scales, Vector)) {
    // Steady rolling that continues starts from the last creepages.
    let is_warm = friction.motion == Motion::SteadyRolling && friction.previous == Previous::Kept;
    let found = friction.has_forces();
    problem.offset = scales.displacement([0, 1].map(|k| if is_warm && found[k] { last[k] } else { 0.0 }));
    problem.scale = match friction.motion {
        Motion::Shift => Scale::SlipOrDisplacement,
        Motion::SteadyRolling if found != [false; 2] => Scale::SlipOrDisplacement,
        _ => Scale::Slip,
    };
    problem.ahead = scales.displacement(spin_ahead(friction, grid));
}

/// Sets the weights of creepages, and the compliance by which a layer exceeds its least compliance, on the elements of the box.
fn take_weights_and_layer(
    problem: &mut Problem,
    friction: &Friction<'_>,
    (grid, window): (&Grid, &Rectangle),
    scales: &Scales,
) -> Result<()> {
    let width = problem.grid.mx;
    let place = |k: usize| window.row(grid, k / width).start + k % width;
    problem.weights = match friction.weights {
        None => Vec::new(),
        Some([x, y]) => {
            let weights = (0..problem.grid.len()).map(place).map(|i| [x[i], y[i]]);
            collected(weights, "the weights of creepages")?
        }
    };
    let least = problem.operators.tangential.layer();
    problem.operators.excess = match friction.compliance {
        Coefficient::Uniform(_) => None,
        Coefficient::PerElement(of) => Some(Excess::new(&problem.grid, |k| scales.compliance(of[place(k)]) - least)?),
    };
    Ok(())
}

/// The creepage in direction k that fits the tractions of a start: with it the weighted mean slip of the stick area is 0. In full slip it is 0.
fn creepage_of(problem: &Problem, state: &State, k: usize) -> f64 {
    let sticks = |i: usize| problem.bound[i] > 0.0 && !is_on_circle(state.q[i], problem.bound[i]);
    let terms = |i: usize| {
        let weight = problem.weighted(i, [1.0; 2])[k];
        let slip = problem.slip[i][k] + state.u[i][k];
        if sticks(i) {
            [weight * slip, weight * weight]
        } else {
            [0.0; 2]
        }
    };
    let [slip, weights] = fields::sum(problem.threads(), problem.bound.len(), terms);
    if weights > 0.0 {
        -slip / weights
    } else {
        0.0
    }
}

/// Converts a traction to the units of the iterations, and clamps its components to the range of numbers whose squares are finite. Tractions that are
/// so large occur in steady rolling only, where they are a first guess.
fn in_range(q: Vector, scales: &Scales) -> Vector {
    q.map(|q| scales.traction(q).clamp(-LARGEST, LARGEST))
}

/// The difference, by spin, of the rigid slips of a step at two points one step apart, in steady rolling.
fn spin_ahead(friction: &Friction<'_>, grid: &Grid) -> Vector {
    let (distance, (sine, cosine)) = (friction.distance(grid), friction.rolling_direction.sin_cos());
    match friction.motion {
        Motion::SteadyRolling => [-sine, cosine].map(|part| friction.spin * distance * distance * part),
        _ => [0.0; 2],
    }
}
