//! The solve of a tangential problem: the box around C, the rigid slip, nested iteration, hand-over, the result.

use super::certificate::Certificate;
use super::forces::Forces;
use super::levels::{levels, Level};
use super::march::Rolling;
use super::nested::{self, Work, COARSE, COUNTS};
use super::problem::{square, Problem, Scale};
use super::sensitivity;
use super::shift::Memory;
use super::solution::{resultant, Report, Solution, EXTERIOR, SLIP, STICK};
use super::window::{displaced, Displaced, Window};
use super::{Tangential, Vector};
use crate::effects::{Friction, Motion, Prescribed, Previous};
use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::memory::zeros;
use crate::progress::Outcome;
use crate::threads::Threads;

/// What memory is for.
const FIELDS: &str = "tangential fields";
/// Where more than this part of C slips after the step before, Newton's method is the faster one for the next step.
const MOSTLY_SLIP: f64 = 0.8;

/// Rigid slips and what tractions displace may be so far apart.
const LARGEST_RATIO: f64 = 1e60;

/// What is asked of a solve.
pub struct Request<'a> {
    /// The pressures of the normal problem, `[my][mx]`.
    pub pressure: &'a [f64],
    /// The friction.
    pub friction: &'a Friction<'a>,
    /// Of the residual.
    pub tolerance: f64,
    /// Iterations on the finest grid at most.
    pub limit: u64,
    /// Unlike bodies: the sideways displacements by the pressures, less those before the step.
    pub sideways: Option<&'a [Vector]>,
    /// Whether this is the same step once more, with other pressures: it starts from the last result, and what was before stays.
    pub again: bool,
    /// Whether errors are to be estimated.
    pub estimates: bool,
}

/// Solves tangential problems on one grid and keeps what the next can use: operators of the box around C, and the tractions.
pub struct Solver {
    grid: Grid,
    tangential: Tangential,
    single: bool,
    threads: Threads,
    /// The finest first; none: nothing was solved yet.
    levels: Vec<Level>,
    /// Products displaced by so many elements.
    displaced: Option<Displaced>,
    solution: Solution,
    /// The tractions before the step, where they were kept.
    before: Vec<Vector>,
    /// The creepages found, times the length rolled.
    offset: Vector,
    has_solution: bool,
}

impl Solver {
    /// For a grid and bodies. `single`: whether directions may be multiplied in single precision.
    pub fn new(grid: Grid, tangential: Tangential, single: bool, threads: &Threads) -> Solver {
        Solver {
            grid,
            tangential,
            single,
            threads: threads.clone(),
            levels: Vec::new(),
            displaced: None,
            solution: Solution::default(),
            before: Vec::new(),
            offset: [0.0; 2],
            has_solution: false,
        }
    }

    /// The coefficients.
    pub fn tangential(&self) -> &Tangential {
        &self.tangential
    }

    /// The last result.
    pub fn solution(&self) -> Option<&Solution> {
        self.has_solution.then_some(&self.solution)
    }

    /// There is no last result any more.
    pub fn forget(&mut self) {
        self.has_solution = false;
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let displaced = self.displaced.as_ref().map_or(0, |displaced| displaced.operator.bytes());
        let fields = self.solution.traction.len() * (2 * size_of::<Vector>() + size_of::<i32>());
        self.levels.iter().map(Level::bytes).sum::<usize>() + displaced + fields
    }

    /// Solves. `watch(grid, residual)` is told of each iteration, and says whether to go on.
    pub fn solve(
        &mut self,
        request: &Request<'_>,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
    ) -> Result<(Outcome, Report)> {
        let began = std::time::Instant::now();
        let Request { pressure, friction, .. } = *request;
        let bound = |i: usize| friction.coefficient.at(i) * pressure[i].max(0.0);
        let keeps = friction.previous == Previous::Kept;
        if keeps && !self.has_solution {
            return invalid("friction continues, but this solver holds no tractions yet".into());
        }
        if self.solution.traction.is_empty() {
            let n = self.grid.len();
            self.solution =
                Solution { traction: zeros(n, FIELDS)?, slip: zeros(n, FIELDS)?, adhesion: zeros(n, FIELDS)? };
        }
        let before = |kept: &[Vector], i: usize| match friction.previous {
            Previous::None => [0.0; 2],
            Previous::Given([x, y]) => [x[i], y[i]],
            Previous::Kept => kept[i],
        };
        let forces = self.forces(friction, bound)?;
        if keeps && !request.again {
            self.before.clone_from(&self.solution.traction);
        }
        let kept = &self.before;
        let from_rest = (0..self.grid.len()).all(|i| before(kept, i) == [0.0; 2]);
        let rolling = (friction.motion == Motion::SteadyRolling)
            .then(|| Rolling { distance: friction.distance(&self.grid), by: friction.elements_rolled(&self.grid) });
        let window =
            Window::around(&self.grid, |i| pressure[i] > 0.0 || rolling.is_none() && before(kept, i) != [0.0; 2]);
        let mut end = Outcome::Converged;
        let mut report = Report { from_rest, ..Report::default() };
        if let Some(window) = window {
            self.set_up(window, rolling)?;
            let had_slip = self.take_over((request, from_rest), window, bound, |kept, i| before(kept, i))?;
            self.check_range()?;
            let goal = (request.tolerance, request.limit);
            let nested = from_rest && !request.again;
            let compared = nested && request.estimates && rolling.is_some();
            let mut work = Work { products: 0.0, coarse: if compared { COUNTS } else { COARSE }, watch };
            end = nested::solve(&mut self.levels, forces, (nested, had_slip), goal, &mut work)?;
            report.products = work.products;
            report.coarser = self.levels.get(1).filter(|_| compared).map(Level::found);
            report.carried = self.levels[0].problem.bound.iter().sum::<f64>() * self.grid.element_area();
        }
        self.write(friction, pressure, window, &mut report);
        if friction.sensitivities {
            report.sensitivities = Some(self.sensitivities(friction, window)?);
            report.products += self.levels.first_mut().map_or(0, |level| level.problem.take_products()) as f64;
        }
        self.has_solution = true;
        report.seconds = began.elapsed().as_secs_f64();
        Ok((end, report))
    }

    /// Refuses slips that dwarf what tractions displace, and the reverse: products of their ratios are no numbers.
    fn check_range(&self) -> Result<()> {
        let problem = &self.levels[0].problem;
        let (slip, displaced) = (problem.rms_rigid(), problem.operators.self_influence * problem.rms_bound());
        if slip > 0.0 && displaced > 0.0 && !(slip / displaced < LARGEST_RATIO && displaced / slip < LARGEST_RATIO) {
            let rule = "choose a smaller motion, coefficients of friction or shear moduli of another order";
            return invalid(format!(
                "slips are of order {slip:e}, displacements by friction of order {displaced:e}, more than 1e60 apart; {rule}"
            ));
        }
        Ok(())
    }

    /// The forces that are given; refuses those that are more than friction carries.
    fn forces(&self, friction: &Friction<'_>, bound: impl Fn(usize) -> f64) -> Result<Forces> {
        let area = self.grid.element_area();
        let mut forces = Forces::NONE;
        for (k, prescribed) in friction.prescribed.iter().enumerate() {
            if let Prescribed::Force(force) = *prescribed {
                (forces.given[k], forces.sum[k]) = (true, force / area);
            }
        }
        let greatest: f64 = (0..self.grid.len()).map(bound).sum();
        if forces.any() && !(square(forces.sum).sqrt() < greatest) {
            return Err(Error::Infeasible(format!(
                "the tangential force is {}; with this friction it must be less than {}",
                square(forces.sum).sqrt() * area,
                greatest * area
            )));
        }
        Ok(forces)
    }

    /// Operators of a window.
    fn set_up(&mut self, window: Window, rolling: Option<Rolling>) -> Result<()> {
        let grid = window.grid(&self.grid);
        let fits = |problem: &Problem| problem.grid == grid && problem.operators.step() == rolling;
        if self.levels.first().is_some_and(|level| fits(&level.problem)) {
            return Ok(());
        }
        self.levels.clear();
        self.levels = levels(&self.tangential, grid, rolling, self.single, &self.threads)?;
        Ok(())
    }

    /// g, w, and for rolling the tractions to start from. Returns whether most of C slipped before.
    fn take_over(
        &mut self,
        (request, from_rest): (&Request<'_>, bool),
        window: Window,
        bound: impl Fn(usize) -> f64,
        before: impl Fn(&[Vector], usize) -> Vector,
    ) -> Result<bool> {
        let Request { friction, again, .. } = *request;
        let Level { problem, state, memory: _ } = &mut self.levels[0];
        state.unload();
        for (k, i) in window.elements(&self.grid) {
            problem.bound[k] = bound(i);
            let sideways = request.sideways.map_or([0.0; 2], |sideways| sideways[i]);
            problem.rigid[k] = super::problem::add(friction.rigid_slip_at(&self.grid, i), sideways);
            state.q[k] = before(&self.before, i);
        }
        // A warm start of steady rolling starts from the last creepages, too.
        let is_warm = friction.motion == Motion::SteadyRolling && friction.previous == Previous::Kept;
        let found = |k: usize| matches!(friction.prescribed[k], Prescribed::Force(_));
        problem.offset = [0, 1].map(|k| if is_warm && found(k) { self.offset[k] } else { 0.0 });
        problem.scale = match friction.motion {
            Motion::Shift => Scale::SlipOrDisplacement,
            Motion::SteadyRolling if found(0) || found(1) => Scale::SlipOrDisplacement,
            _ => Scale::Slip,
        };
        problem.bound_changed();
        problem.slip.copy_from_slice(&problem.rigid);
        if !from_rest {
            self.leave(friction)?;
        }
        let Level { problem, state, .. } = &mut self.levels[0];
        if again {
            window.elements(&self.grid).for_each(|(k, i)| state.q[k] = self.solution.traction[i]);
            problem.offset = self.offset;
        }
        if !again && from_rest {
            return Ok(false);
        }
        let slipped = problem.contact().filter(|&i| square(state.q[i]).sqrt() >= 0.999 * problem.bound[i]).count();
        let mostly = slipped as f64 > MOSTLY_SLIP * problem.count() as f64;
        problem.refresh(state);
        Ok(mostly)
    }

    /// w less the displacements before the step, by the tractions that the state holds.
    fn leave(&mut self, friction: &Friction<'_>) -> Result<()> {
        let Level { problem, state, .. } = &mut self.levels[0];
        match friction.motion {
            Motion::SteadyRolling => return Ok(()),
            Motion::Shift => problem.operators.multiply(&state.q, problem.rms_bound(), &mut state.u),
            Motion::TransientRolling => {
                let by = friction.elements_rolled(&self.grid);
                let displaced = displaced(&mut self.displaced, &self.tangential, problem.grid, by, &self.threads)?;
                displaced.operator.apply(&state.q, 1.0, &mut state.u, &mut displaced.workspace);
            }
        }
        for (w, u) in problem.slip.iter_mut().zip(&state.u) {
            *w = [w[0] - u[0], w[1] - u[1]];
        }
        Ok(())
    }

    /// See [`Report::sensitivities`].
    fn sensitivities(&mut self, friction: &Friction<'_>, window: Option<Window>) -> Result<[[f64; 3]; 3]> {
        let mut derivatives = [[0.0; 3]; 3];
        let (Some(window), Some(Level { problem, state, memory })) = (window, self.levels.first_mut()) else {
            return Ok(derivatives);
        };
        sensitivity::predict(problem, state, &mut memory.tangent);
        for by in 0..3 {
            let mut change = memory.fields.take(state.q.len())?;
            for (k, i) in window.elements(&self.grid) {
                change[k] = friction.rigid_slip_by(&self.grid, i, by);
            }
            let Memory { tangent, fields, .. } = memory;
            sensitivity::solve(problem, tangent, fields, &mut change)?;
            let changes = window.elements(&self.grid).map(|(k, i)| (i, change[k]));
            let (force, moment) = resultant(&self.grid, friction.spin_centre, changes);
            for (row, value) in derivatives.iter_mut().zip([force[0], force[1], moment]) {
                row[by] = value;
            }
            memory.fields.give(change);
        }
        Ok(derivatives)
    }

    /// The result on the whole grid, and what is to be said of it.
    fn write(&mut self, friction: &Friction<'_>, pressure: &[f64], window: Option<Window>, report: &mut Report) {
        let Solution { traction, slip, adhesion } = &mut self.solution;
        traction.fill([0.0; 2]);
        slip.fill([0.0; 2]);
        adhesion.fill(EXTERIOR);
        let distance = friction.distance(&self.grid);
        let mut offset = [0.0; 2];
        if let (Some(window), Some(Level { problem, state, .. })) = (window, self.levels.first()) {
            report.certificate = Certificate::of(problem, state);
            offset = problem.offset;
            self.offset = offset;
            for (k, i) in window.elements(&self.grid).filter(|(_, i)| pressure[*i] > 0.0) {
                let (q, g) = (state.q[k], problem.bound[k]);
                traction[i] = q;
                slip[i] = problem.slip_at(k, &state.u);
                let slides = square(q).sqrt() >= g * super::certificate::ON_THE_CIRCLE;
                adhesion[i] = if slides { SLIP } else { STICK };
                // Without friction all slips.
                report.certificate.slip_count += usize::from(!(g > 0.0));
            }
        }
        for (k, prescribed) in friction.prescribed.iter().enumerate() {
            report.creepage[k] = match prescribed {
                Prescribed::Creepage(creepage) => *creepage,
                Prescribed::Force(_) => offset[k] / distance,
            };
        }
        let tractions = traction.iter().copied().enumerate();
        (report.force, report.moment) = resultant(&self.grid, friction.spin_centre, tractions);
    }
}
