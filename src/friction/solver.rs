//! The solve of a tangential problem: the box around C, the rigid slip, nested iteration, hand-over, the result.

use super::certificate::Certificate;
use super::forces::Forces;
use super::levels::{interpolate, levels, restrict, Level};
use super::march::Rolling;
use super::newton;
use super::problem::{dot, square, Operators, Problem, Scale};
use super::sensitivity;
use super::shift::{self, Goal, Memory};
use super::toeplitz::{Toeplitz, Workspace};
use super::{Tangential, Vector};
use crate::effects::{Friction, Motion, Prescribed, Previous};
use crate::error::{invalid, Error, Result};
use crate::grid::Grid;
use crate::memory::zeros;
use crate::progress::Outcome;
use crate::threads::Threads;

/// What memory is for.
const FIELDS: &str = "tangential fields";
/// Coarser grids are solved to this residual: what they leave wrong costs more on the finest.
const COARSE: f64 = 1e-3;
/// Iterations at most on each of them.
const COARSE_LIMIT: u64 = 60;
/// With forces given, the coarsest grid is solved with these parts of the load first, to this residual.
const PARTS: [f64; 2] = [0.5, 0.8];
const PART: f64 = 3e-2;
/// Where more than this part of C slips after the step before, Newton's method is the faster one for the next step.
const MOSTLY_SLIP: f64 = 0.8;

/// What an element does: see [`Solution::adhesion`].
pub const EXTERIOR: i32 = 0;
/// It sticks.
pub const STICK: i32 = 1;
/// It slips.
pub const SLIP: i32 = 2;

/// Fields on the whole grid.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// q, on body 1: 0 outside C.
    pub traction: Vec<Vector>,
    /// s of the step, body 1 over body 2, a length: 0 outside C.
    pub slip: Vec<Vector>,
    /// Of each element: exterior 0, stick 1, slip 2.
    pub adhesion: Vec<i32>,
}

/// What a solve found and what it cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// How well the conditions hold.
    pub certificate: Certificate,
    /// `sum of q dx dy`, on body 1.
    pub force: Vector,
    /// `sum of (x qy - y qx) dx dy` about the centre of spin.
    pub moment: f64,
    /// Creepages: given, or found.
    pub creepage: Vector,
    /// Where they were asked for: derivatives of the force in x, in y and of the moment (rows) by xi, eta and phi (columns). Creepages
    /// that are found count as given.
    pub sensitivities: Option<[[f64; 3]; 3]>,
    /// Products of two components on all grids, in products on the finest.
    pub products: f64,
    /// Seconds, with the set-up of operators.
    pub seconds: f64,
}

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

/// `A q` at places between the centres.
struct Displaced {
    by: (f64, f64),
    grid: Grid,
    operator: Toeplitz<f64>,
    workspace: Workspace<f64>,
}

/// A box of elements: the first column and row, and behind the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Window {
    x: (usize, usize),
    y: (usize, usize),
}

impl Window {
    /// Around the elements that are `inside`; none if there is none.
    fn around(grid: &Grid, inside: impl Fn(usize) -> bool) -> Option<Window> {
        let mut window: Option<Window> = None;
        for iy in 0..grid.my {
            let row = iy * grid.mx;
            let Some(first) = (0..grid.mx).find(|ix| inside(row + ix)) else { continue };
            let last = (0..grid.mx).rfind(|ix| inside(row + ix)).unwrap_or(first);
            let Window { x, y } = window.unwrap_or(Window { x: (first, last + 1), y: (iy, iy + 1) });
            window = Some(Window { x: (x.0.min(first), x.1.max(last + 1)), y: (y.0, iy + 1) });
        }
        window
    }

    fn grid(&self, grid: &Grid) -> Grid {
        Grid { mx: self.x.1 - self.x.0, my: self.y.1 - self.y.0, ..*grid }
    }

    /// Of each element of the window its index, and that on the whole grid.
    fn elements(self, grid: &Grid) -> impl Iterator<Item = (usize, usize)> {
        let (mx, width) = (grid.mx, self.x.1 - self.x.0);
        let count = width * (self.y.1 - self.y.0);
        (0..count).map(move |k| (k, (self.y.0 + k / width) * mx + self.x.0 + k % width))
    }
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
        let mut report = Report::default();
        if let Some(window) = window {
            self.set_up(window, rolling)?;
            let had_slip = self.take_over((request, from_rest), window, bound, |kept, i| before(kept, i))?;
            let goal = (request.tolerance, request.limit);
            let mut work = Work { products: 0.0, watch };
            let nested = from_rest && !request.again;
            end = self.run(forces, (nested, had_slip), goal, &mut work)?;
            report.products = work.products;
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
        let operators = Operators::new(&self.tangential, &grid, rolling, self.single, &self.threads)?;
        self.levels = levels(operators, grid, self.single, &self.threads)?;
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
            Motion::Shift => problem.operators.multiply(&state.q, &mut state.u),
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

    fn run(
        &mut self,
        forces: Forces,
        (nested, mostly_slips): (bool, bool),
        (tolerance, limit): (f64, u64),
        work: &mut Work<'_>,
    ) -> Result<Outcome> {
        let finest = self.levels[0].problem.grid.len() as f64;
        if nested {
            for l in 1..self.levels.len() {
                let (fine, coarse) = self.levels.split_at_mut(l);
                restrict(&fine[l - 1].problem, &mut coarse[0]);
            }
            for l in (1..self.levels.len()).rev() {
                let level = &mut self.levels[l];
                let part = level.problem.grid.len() as f64 / finest;
                let area = level.problem.grid.element_area() / self.grid.element_area();
                let forces = forces.times(1.0 / area);
                if l + 1 == self.levels_count() && forces.any() {
                    let end = self.approach(l, forces, part, work)?;
                    if end == Outcome::Cancelled {
                        return Ok(end);
                    }
                }
                let level = &mut self.levels[l];
                let end = one(level, forces, forces.any(), (tolerance.max(COARSE), COARSE_LIMIT), part, work)?;
                if end == Outcome::Cancelled {
                    return Ok(end);
                }
                let (fine, coarse) = self.levels.split_at_mut(l);
                interpolate(&coarse[0], &mut fine[l - 1])?;
                let Level { problem, state, .. } = &mut fine[l - 1];
                problem.refresh(state);
            }
        }
        let level = &mut self.levels[0];
        one(level, forces, forces.any() || mostly_slips, (tolerance, limit), 1.0, work)
    }

    fn levels_count(&self) -> usize {
        self.levels.len()
    }

    /// Forces that are given are brought on in parts, on the coarsest grid.
    fn approach(&mut self, l: usize, forces: Forces, part: f64, work: &mut Work<'_>) -> Result<Outcome> {
        let mut before = 1.0;
        for load in PARTS.into_iter().chain([1.0]) {
            let level = &mut self.levels[l];
            let scale = |v: &mut Vector| *v = v.map(|v| v * (load / before));
            level.problem.slip.iter_mut().for_each(scale);
            level.problem.rigid.iter_mut().for_each(scale);
            before = load;
            if load < 1.0 {
                let end = one(level, forces.times(load), true, (PART, COARSE_LIMIT), part, work)?;
                if end == Outcome::Cancelled {
                    return Ok(end);
                }
            }
        }
        Ok(Outcome::Converged)
    }

    /// See [`Report::sensitivities`].
    fn sensitivities(&mut self, friction: &Friction<'_>, window: Option<Window>) -> Result<[[f64; 3]; 3]> {
        let mut derivatives = [[0.0; 3]; 3];
        let (Some(window), Some(Level { problem, state, memory })) = (window, self.levels.first_mut()) else {
            return Ok(derivatives);
        };
        for by in 0..3 {
            let mut change = memory.fields.take(state.q.len())?;
            for (k, i) in window.elements(&self.grid) {
                change[k] = friction.rigid_slip_by(&self.grid, i, by);
            }
            let Memory { tangent, fields, .. } = memory;
            sensitivity::solve(problem, state, (tangent, fields), &mut change)?;
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

/// The force of tractions, and their moment about `centre`, a place from the middle of the grid.
fn resultant(grid: &Grid, centre: Vector, tractions: impl Iterator<Item = (usize, Vector)>) -> (Vector, f64) {
    let (Grid { mx, my, dx, dy }, area) = (*grid, grid.element_area());
    let (mut force, mut moment) = ([0.0; 2], 0.0);
    for (i, q) in tractions.filter(|(_, q)| *q != [0.0; 2]) {
        let x = ((i % mx) as f64 - 0.5 * (mx as f64 - 1.0)) * dx - centre[0];
        let y = ((i / mx) as f64 - 0.5 * (my as f64 - 1.0)) * dy - centre[1];
        force = [force[0] + area * q[0], force[1] + area * q[1]];
        moment += area * dot([-y, x], q);
    }
    (force, moment)
}

/// What is counted, and who is told.
struct Work<'a> {
    products: f64,
    watch: &'a mut dyn FnMut(&Grid, f64) -> bool,
}

/// Solves one grid from what it holds: by gradients, and where they stall or forces are given by Newton's method.
fn one(
    level: &mut Level,
    forces: Forces,
    newton_first: bool,
    (tolerance, limit): (f64, u64),
    part: f64,
    work: &mut Work<'_>,
) -> Result<Outcome> {
    let Level { problem, state, memory } = level;
    let grid = problem.grid;
    let mut end = Outcome::Stagnated;
    // Nothing moves, and nothing did.
    if problem.rms_slip() == 0.0 && !forces.any() {
        state.unload();
        return Ok(Outcome::Converged);
    }
    let only_newton = forces.any() || problem.operators.rolling.is_some();
    for newton in [newton_first || only_newton, true, only_newton] {
        let watch = &mut |residual: f64| (work.watch)(&grid, residual);
        let certified = part == 1.0;
        let goal = Goal { tolerance, limit, certified, watch };
        end = if newton {
            newton::solve(problem, state, (&mut memory.tangent, &mut memory.fields), forces, goal)?
        } else {
            shift::solve(problem, state, memory, goal)
        };
        if end != Outcome::Stagnated {
            break;
        }
        log::info!("tangential problem: no further progress, Newton's method goes on");
    }
    if end != Outcome::Converged && !state.is_exact && part == 1.0 {
        problem.refresh(state);
    }
    work.products += part * problem.take_products() as f64;
    Ok(end)
}

/// Products displaced by so many elements, set up where they are not there.
fn displaced<'a>(
    kept: &'a mut Option<Displaced>,
    tangential: &Tangential,
    grid: Grid,
    by: (f64, f64),
    threads: &Threads,
) -> Result<&'a mut Displaced> {
    if !kept.as_ref().is_some_and(|kept| kept.by == by && kept.grid == grid) {
        *kept = None;
        let operator = Toeplitz::displaced(tangential, &grid, by, &threads.suited_to(grid.len()))?;
        let workspace = operator.workspace()?;
        *kept = Some(Displaced { by, grid, operator, workspace });
    }
    match kept {
        Some(kept) => Ok(kept),
        None => invalid("no displaced operator".into()),
    }
}
