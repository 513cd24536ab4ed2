//! Semismooth Newton: where forces are given, and where the projected gradients stall.
//!
//! With the prediction of [`Tangent`] (P, D, n) and x0 the step onto the circles, each Newton step solves
//!
//! ```text
//! (P A P + D) z + sum_k dc_k P e_k = P(-(s + A x0)),        x0 = g n - q on slip
//!                            sum z = F/(dx dy) - sum(q + x0)        for each direction k whose force is given
//! ```
//!
//! with B for A in steady rolling, by flexible GMRES with the preconditioner of the gradients, bordered by the creepages dc. Then
//! `q += x0 + z`, without line search or projection (Alart and Curnier 1991; Christensen 2002). [`step`](super::step) makes the steps.
//!
//! A certificate costs a fresh product. It is taken after a cheap step, x0 and a part of the preconditioned residual, which suffices near
//! the solution. If the preconditioner is far from an inverse, as for thin stiff coatings in steady rolling, that part increases the
//! residual each time. Then the certificate is taken after x0 alone.

use super::balance::balanced;
use super::best::Best;
use super::forces::Forces;
use super::plane::square;
use super::problem::{Problem, State};
use super::shift::Goal;
use super::step::{compliance, enough, polish, step, Effort, DIRECTIONS};
use super::tangent::{rho_of, Measures, Tangent};
use crate::contact::largest;
use crate::error::Result;
use crate::methods::fields::Fields;
use crate::progress::Outcome;

/// Relative tolerances of the linear solve of a step, without and with rolling.
const INNER: f64 = 0.15;
const INNER_ROLLING: f64 = 0.35;
/// Below this times the tolerance `polish` takes the certificate.
const POLISH_BELOW: f64 = 1.5;
/// Residuals below this are round-off, and displacements that are not fresh have a larger error. Then the certificate is taken, whatever the
/// tolerance.
const ROUND_OFF: f64 = 1e-15;
/// Factor on the relative tolerance and on rho when steps make no progress, and the least relative tolerance.
const CUT: f64 = 0.3;
const LEAST_INNER: f64 = 0.01;
/// Without progress a linear solve gets as many directions as it has unknowns, which solve it with any preconditioner, if they hold at most this many
/// values of two components together.
const MOST_VALUES: usize = 1 << 21;
/// Length of steps after an odd number of cuts: full steps may alternate between two slip areas for ever.
const SHORT_STEP: f64 = 0.5;
/// The preconditioner is left out of `polish` once TIMES_WORSE certificates in a row find more than WORSE_CERTIFICATE
/// times the residual before. A single one may come from displacements that were not fresh.
const WORSE_CERTIFICATE: f64 = 1.5;
const TIMES_WORSE: u32 = 2;
/// Steps without progress before a cut; progress is a residual below PROGRESS times the least.
const PATIENCE: u32 = 4;
pub const PROGRESS: f64 = 0.7;
/// Coarser grids may leave q above its bounds by this times the tolerance: the next finer grid projects q.
const COARSE_EXCESS: f64 = 10.0;
/// Most steps on a grid without certificate.
const MOST_STEPS: u64 = 60;
/// Cuts without progress after which the steps end.
const MOST_CUTS: u32 = 6;
/// Creepages above this times the displacement by g plus the given slip run away: nothing in the system holds them.
const RUNAWAY: f64 = 1e4;

/// How the slipping elements are predicted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// By the natural map whose rho makes the rms slip move tractions by the rms bound.
    Plain,
    /// By the natural map whose rho is the inverse compliance: elements of large slip are predicted to slip, whatever their bounds. The creepages are
    /// those at which the map carries the given forces.
    Balanced,
    /// `Balanced` in turns: the creepages that carry the forces at fixed displacements, then a step with these creepages given.
    InTurns,
}

/// The progress of the steps, and the kind of the next one.
struct StepControl {
    /// The factor on rho.
    factor: f64,
    /// The relative tolerance of linear solves.
    inner: f64,
    /// The least residual, the steps since then, and the cuts since then.
    least: f64,
    since: u32,
    cuts: u32,
    /// The last residual, and the steps that did not change it.
    last: f64,
    still: u32,
}

impl StepControl {
    fn new(inner: f64) -> StepControl {
        StepControl { factor: 1.0, inner, least: f64::INFINITY, since: 0, cuts: 0, last: f64::INFINITY, still: 0 }
    }

    /// Records the worst measure of an iterate. Returns whether to go on.
    fn goes_on(&mut self, worst: f64, by_force: bool) -> bool {
        // If the measure stays constant, nothing holds the creepages, whatever rho is.
        self.still = if worst == self.last { self.still + 1 } else { 0 };
        self.last = worst;
        if by_force && self.still > PATIENCE {
            return false;
        }
        self.since += 1;
        if worst < PROGRESS * self.least {
            (self.least, self.since, self.cuts) = (worst, 0, 0);
        }
        if self.since > PATIENCE {
            (self.factor, self.inner) = (self.factor * CUT, f64::max(self.inner * CUT, LEAST_INNER));
            (self.since, self.cuts) = (0, self.cuts + 1);
        }
        self.cuts <= MOST_CUTS
    }

    /// The length of the next step.
    fn length(&self) -> f64 {
        if self.cuts % 2 == 1 {
            SHORT_STEP
        } else {
            1.0
        }
    }
}

/// The residuals at which certificates were taken.
#[derive(Default)]
struct Certificates {
    /// The predicted residual before the last certificate, which failed.
    before: Option<f64>,
    /// Certificates in a row that were worse.
    worse: u32,
}

impl Certificates {
    /// Compares the residual after a certificate with the prediction before it.
    fn compare(&mut self, residual: f64) {
        if let Some(before) = self.before.take().filter(|_| self.uses_preconditioner()) {
            self.worse = if residual > WORSE_CERTIFICATE * before { self.worse + 1 } else { 0 };
        }
    }

    /// Whether `polish` uses the preconditioner.
    fn uses_preconditioner(&self) -> bool {
        self.worse < TIMES_WORSE
    }

    /// Whether to take a certificate.
    fn is_near(&self, measures: Measures, missing: f64, tolerance: f64) -> bool {
        let part = if self.uses_preconditioner() { POLISH_BELOW } else { 1.0 };
        measures.residual < part * tolerance && measures.excess.max(missing) < tolerance
    }
}

/// Iterates from the state and the offset.
pub fn solve(
    problem: &mut Problem,
    state: &mut State,
    (tangent, fields, best): (&mut Tangent, &mut Fields, &mut Best),
    (forces, manner): (Forces, Manner),
    goal: Goal<'_>,
) -> Result<Outcome> {
    let Goal { tolerance, limit, certified, watch } = goal;
    tangent.fit(problem.grid.len())?;
    problem.continue_residuals()?;
    let cap = 1.0 / compliance(problem);
    let saturating = problem.rms_bound() / cap;
    let spinning = problem.rms(|i| problem.rigid[i]).max(problem.rms(|i| problem.slip[i]));
    let made = problem.operators.products;
    let of_step = if manner == Manner::InTurns { Forces::NONE } else { forces };
    let mut control = StepControl::new(if problem.operators.rolling.is_some() { INNER_ROLLING } else { INNER });
    let (mut iterations, mut certificates) = (0, Certificates::default());
    loop {
        let rho = control.factor
            * if manner == Manner::Plain { rho_of((problem.rms_bound(), problem.rms_slip()), cap) } else { cap };
        if manner != Manner::Plain && forces.any() {
            problem.offset = balanced(problem, state, rho, forces);
        }
        let measures = tangent.predict(problem, state, rho);
        let missing = forces.missing(problem, &state.q);
        let excess = if certified { measures.excess } else { measures.excess / COARSE_EXCESS };
        let worst = largest([measures.residual, excess, missing]);
        if !worst.is_finite() {
            return Ok(unloaded(problem, state));
        }
        if worst < tolerance && (state.is_exact || !certified) {
            return Ok(Outcome::Converged);
        }
        best.see(problem, state, worst, fields)?;
        certificates.compare(measures.residual);
        if certified && !state.is_exact && certificates.is_near(measures, missing, tolerance.max(ROUND_OFF)) {
            certificates.before = Some(measures.residual);
            polish(problem, state, (tangent, certificates.uses_preconditioner()), of_step, fields)?;
            continue;
        }
        let runs_away = manner == Manner::Plain && square(problem.offset).sqrt() > RUNAWAY * (saturating + spinning);
        if runs_away || !control.goes_on(worst, forces.any()) {
            return Ok(Outcome::Stagnated);
        }
        let left = limit.saturating_sub(problem.operators.products - made);
        if left == 0 || iterations >= MOST_STEPS && !certified {
            return Ok(Outcome::IterationLimit);
        }
        iterations += 1;
        let inner = enough(control.inner, tolerance, worst);
        let most = if control.factor < 1.0 { all_directions(problem) } else { DIRECTIONS }.min(left as usize);
        let effort = Effort { inner, most, residual: measures.residual, length: control.length() };
        step(problem, state, tangent, (of_step, effort), fields)?;
        if !watch(worst) {
            return Ok(Outcome::Cancelled);
        }
    }
}

/// Discards an iterate that is not finite.
fn unloaded(problem: &mut Problem, state: &mut State) -> Outcome {
    problem.offset = [0.0; 2];
    state.unload(problem.threads());
    Outcome::Stagnated
}

/// As many directions as unknowns, if they hold at most MOST_VALUES values together.
fn all_directions(problem: &Problem) -> usize {
    (MOST_VALUES / problem.grid.len()).min(2 * problem.count() + 2).max(DIRECTIONS)
}
