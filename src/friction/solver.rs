//! The solve of a tangential problem: finds the box around C, sets up its operators, iterates, and writes the result.

use super::certificate::Certificate;
use super::displaced::Displaced;
use super::forces::Forces;
use super::law::Particle;
use super::levels::{levels, Level};
use super::nested::{self, Work, COARSE_TOLERANCE, COUNTED_TOLERANCE};
use super::plane::Vector;
use super::request::{before, Request, Start};
use super::scales::Scales;
use super::solution::{Report, Solution};
use super::sweep::Rolling;
use super::Tangential;
use crate::effects::{Coefficient, Friction, Motion, Previous};
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::memory::keep;
use crate::progress::Outcome;
use crate::rectangle::Rectangle;
use crate::threads::Threads;

/// A guess with a larger residual, or that misses more of the given forces, is discarded for a start from the coarser grids.
const LARGEST_USEFUL: f64 = 0.1;

/// Solves tangential problems on one grid. It keeps the operators of the box around C and the last result for the next solve.
pub struct Solver {
    pub(super) grid: Grid,
    /// The coefficients, in the caller's units.
    pub(super) tangential: Tangential,
    pub(super) scales: Scales,
    /// The coefficients in the units of the iterations.
    pub(super) scaled: Tangential,
    single: bool,
    pub(super) threads: Threads,
    /// The box around C and its coarser grids, the finest first. Empty before the first solve.
    pub(super) levels: Vec<Level>,
    /// The product at points between the centres, for steps of transient rolling.
    pub(super) displaced: Option<Displaced>,
    /// The last result.
    pub(super) solution: Solution,
    /// The tractions of the step before, if the friction continues from them.
    pub(super) before: Vec<Vector>,
    /// The state of the particles after the step before, if the friction continues from it.
    pub(super) particles_before: Vec<Particle>,
    /// The creepages found for given forces, times the length of the step.
    pub(super) offset: Vector,
    pub(super) has_solution: bool,
    /// Whether the last solve had friction. If not, `solution` belongs to an earlier one.
    pub(super) had_friction: bool,
    /// The box around C of the last solve; none if no element was in contact.
    pub(super) window: Option<Rectangle>,
    /// Scratch: sums over each row of the grid.
    pub(super) sums: Vec<[f64; 3]>,
}

/// What is known of a guess: its certificate, whether it meets the tolerance, whether to iterate from it, and the products so far.
struct StartQuality {
    certificate: Certificate,
    is_solution: bool,
    is_useful: bool,
    products: f64,
}

impl Drop for Solver {
    fn drop(&mut self) {
        let Solution { traction, slip, stick_slip, .. } = &mut self.solution;
        keep([traction, slip, &mut self.before]);
        keep([stick_slip]);
    }
}

impl Solver {
    /// A solver for one grid and one pair of bodies. `single` tells whether products of search directions may be in single precision.
    pub fn new(grid: Grid, tangential: Tangential, single: bool, threads: &Threads) -> Solver {
        let (scales, scaled) = Scales::of(&grid, &tangential);
        Solver {
            grid,
            tangential,
            scales,
            scaled,
            single,
            threads: threads.clone(),
            levels: Vec::new(),
            displaced: None,
            solution: Solution::default(),
            before: Vec::new(),
            particles_before: Vec::new(),
            offset: [0.0; 2],
            has_solution: false,
            had_friction: true,
            window: None,
            sums: Vec::new(),
        }
    }

    /// The influence coefficients, in the caller's units.
    pub fn tangential(&self) -> &Tangential {
        &self.tangential
    }

    /// The result of the last solve; none if that solve had no friction.
    pub fn solution(&self) -> Option<&Solution> {
        (self.has_solution && self.had_friction).then_some(&self.solution)
    }

    /// Ends the solver and returns its last result, or empty fields if there is none.
    pub fn into_solution(mut self) -> Solution {
        if self.has_solution {
            std::mem::take(&mut self.solution)
        } else {
            Solution::default()
        }
    }

    /// The creepages that the last solve found for given forces, times the length of the step.
    pub fn offset(&self) -> Vector {
        self.offset
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let displaced = self.displaced.as_ref().map_or(0, Displaced::bytes);
        let fields = self.solution.traction.len() * (2 * size_of::<Vector>() + size_of::<i32>())
            + self.before.capacity() * size_of::<Vector>()
            + size_of_val(&self.sums[..]);
        self.levels.iter().map(Level::bytes).sum::<usize>() + displaced + fields
    }

    /// Solves the tangential problem and keeps the result. `watch(grid, residual)` is called at each iteration; it returns false to cancel.
    pub fn solve(
        &mut self,
        request: &Request<'_>,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
    ) -> Result<(Outcome, Report)> {
        let began = std::time::Instant::now();
        let Request { pressure, friction, .. } = *request;
        let limits = self.limits_before(request)?;
        let request = &Request { limits: &limits, ..*request };
        let (bound, keeps) = (|i: usize| request.bound(i), friction.previous == Previous::Kept);
        if keeps && !self.has_solution {
            return invalid("friction continues, but this solver holds no tractions yet".into());
        }
        self.make_room()?;
        self.set_layer(friction);
        let forces = match request.start {
            Start::Held(_) => Forces::NONE,
            _ => Forces::of(friction, &self.grid, bound)?,
        };
        if !request.start.is_again() {
            self.take_products(); // Those of a step that was refused do not count.
            if keeps {
                self.keep_tractions()?;
                self.keep_particles();
            }
        }
        let kept = &self.before;
        let from_rest =
            friction.previous == Previous::None || (0..self.grid.len()).all(|i| before(friction, kept, i) == [0.0; 2]);
        let rolling = self.steady_rolling(friction);
        // Except in steady rolling elements with a previous traction are inside, too.
        let is_inside = |i: usize| pressure[i] > 0.0 || rolling.is_none() && before(friction, kept, i) != [0.0; 2];
        let window = Rectangle::around(&self.grid, &self.threads, |mut elements| elements.any(is_inside));
        let (mut end, mut is_lowered) = (Outcome::Converged, false);
        let mut report = Report { from_rest, ..Report::default() };
        if let Some(window) = &window {
            let by = if friction.motion == Motion::Shift { (0.0, 0.0) } else { friction.elements_rolled(&self.grid) };
            self.tangential.check_reach(&window.grid(&self.grid), by)?;
            (end, is_lowered) = self.solve_within_reach((window, rolling), request, forces, watch, &mut report)?;
        }
        self.window = window;
        // The derivatives are computed before the result is written, so that a failure leaves the result of the solve before.
        if friction.sensitivities && end != Outcome::Cancelled {
            report.sensitivities = self.sensitivities(friction, watch)?;
            end = if report.sensitivities.is_some() { end } else { Outcome::Cancelled };
        }
        report.products += self.take_products();
        let march = self.march(friction, pressure)?;
        self.write(request, &mut report);
        if is_lowered {
            report.certificate.gap = self.gap_of_bounds(request);
        }
        self.write_particles(march);
        report.missing = self.missing(friction, &report);
        (self.has_solution, self.had_friction) = (true, true);
        report.seconds = began.elapsed().as_secs_f64();
        Ok((end, report))
    }

    /// The step of steady rolling in the units of the iterations; none for other motions.
    fn steady_rolling(&self, friction: &Friction<'_>) -> Option<Rolling> {
        (friction.motion == Motion::SteadyRolling).then(|| Rolling {
            distance: self.scales.length(friction.distance(&self.grid)),
            by: friction.elements_rolled(&self.grid),
        })
    }

    /// Solves in a box, in the units of the iterations. Writes the certificate, the last change of q and the products to the report.
    pub(super) fn solve_in(
        &mut self,
        (window, rolling): (&Rectangle, Option<Rolling>),
        request: &Request<'_>,
        forces: Forces,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let from_rest = report.from_rest;
        self.set_up(window, rolling)?;
        let mut mostly_slips = self.begin(request, from_rest, window)?;
        if request.friction.has_law() {
            let nested = from_rest && !request.start.is_again();
            let end = self.iterate_with_law(request, (window, forces, (nested, mostly_slips)), watch, report)?;
            [report.update, _] = self.scales.callers_traction([self.levels[0].problem.update, 0.0]);
            return Ok(end);
        }
        let mut is_useful = false;
        if request.start.is_guess() {
            let guess = self.assess_start(forces, request.tolerance);
            (report.products, report.certificate) = (guess.products, guess.certificate);
            if guess.is_solution {
                return Ok(Outcome::Converged);
            }
            is_useful = guess.is_useful;
            if !is_useful {
                mostly_slips = self.begin(&Request { start: Start::Before, ..*request }, from_rest, window)?;
            }
        }
        let nested = from_rest && !is_useful && !request.start.is_again();
        let end = match request.is_cancelled {
            true => Outcome::Cancelled,
            false => self.iterate(request, forces, (nested, mostly_slips), watch, report)?,
        };
        let Level { problem, state, .. } = &self.levels[0];
        report.certificate = Certificate::of(problem, state);
        [report.update, _] = self.scales.callers_traction([problem.update, 0.0]);
        Ok(end)
    }

    /// Iterates from the present state, or from the coarsest grid if `nested`. Adds products and the coarser result, if wanted, to the report.
    pub(super) fn iterate(
        &mut self,
        request: &Request<'_>,
        forces: Forces,
        (nested, mostly_slips): (bool, bool),
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
        report: &mut Report,
    ) -> Result<Outcome> {
        let scales = self.scales;
        let watch = &mut |grid: &Grid, residual: f64| watch(&scales.callers_grid(grid), residual);
        let keeps_coarser = nested && request.estimates && request.friction.motion == Motion::SteadyRolling;
        let coarse = if keeps_coarser { COUNTED_TOLERANCE } else { COARSE_TOLERANCE };
        let mut work = Work { products: 0.0, limit: request.limit, coarse, watch };
        let end = nested::solve(&mut self.levels, forces, (nested, mostly_slips), request.tolerance, &mut work)?;
        report.products += work.products;
        let converted = |(force, creepage)| (scales.callers_force(force), scales.callers_creepage(creepage));
        report.coarser =
            self.levels.get(1).filter(|_| keeps_coarser).map(|level| converted(level.force_and_creepages()));
        Ok(end)
    }

    /// Adds the least compliance of the layer between the bodies to the coefficients. If it has changed, the operators are discarded.
    fn set_layer(&mut self, friction: &Friction<'_>) {
        let layer = match friction.compliance {
            Coefficient::Uniform(compliance) => compliance,
            Coefficient::PerElement(of) => of.iter().copied().fold(f64::INFINITY, f64::min),
        };
        if layer != self.tangential.layer() {
            self.tangential = self.tangential.with_layer(layer);
            self.scaled = self.scaled.with_layer(self.scales.compliance(layer));
            (self.levels, self.displaced) = (Vec::new(), None);
        }
    }

    /// Sets up the operators of a box and its coarser grids, unless those of the last solve suit.
    fn set_up(&mut self, window: &Rectangle, rolling: Option<Rolling>) -> Result<()> {
        let grid = self.scales.grid(&window.grid(&self.grid));
        let first = self.scaled.rows().map(|_| window.y.start);
        if self.levels.first().is_some_and(|level| level.problem.suits(&grid, first, rolling)) {
            return Ok(());
        }
        self.levels.clear();
        let tangential = self.scaled.of_run(window.y.start, grid.my);
        self.levels = levels(&tangential, grid, rolling, self.single, &self.threads)?;
        Ok(())
    }

    /// Measures the residual and the missing forces of the present state, whose displacements are a fresh product.
    fn assess_start(&mut self, forces: Forces, tolerance: f64) -> StartQuality {
        let Level { problem, state, .. } = &mut self.levels[0];
        let certificate = Certificate::of(problem, state);
        let missing = forces.missing(problem, &state.q);
        let below = |bound: f64| certificate.residual < bound && missing < bound;
        StartQuality {
            certificate,
            is_solution: below(tolerance),
            is_useful: below(LARGEST_USEFUL),
            products: problem.take_products() as f64,
        }
    }
}
