//! Semismooth Newton: where forces are given, and where the projected gradients stall.
//!
//! With the prediction of [`Tangent`] (P, D, n) and x0 the way to the circles, each step solves
//!
//! ```text
//! (P A P + D) z + sum_k dc_k P e_k = P(-(s + A x0)),        x0 = g n - q on slip
//!                            sum z = F/(dx dy) - sum(q + x0)        for each direction k whose force is given
//! ```
//!
//! with B for A in steady rolling, by flexible GMRES, with the preconditioner of the gradients, bordered by the creepages dc. Then `q += x0 + z`: no line search and no
//! projection between steps (Alart and Curnier 1991; Christensen 2002). [`step`](super::step) takes them.
//!
//! The certificate takes a fresh product. It is taken at what a step starts with, x0 and a part of the preconditioned residual: where little is missing, that
//! is enough. Where the preconditioner is far from an inverse, as for thin stiff coatings in steady rolling, that part brings back more than it takes, each
//! time. Then the certificate is taken at x0 alone.

use super::balance::balanced;
use super::best::Best;
use super::forces::Forces;
use super::plane::square;
use super::problem::{Problem, State};
use super::shift::Goal;
use super::step::{compliance, polish, step, Effort};
use super::tangent::{rho_of, Measures, Tangent};
use crate::error::Result;
use crate::methods::fields::Fields;
use crate::progress::Outcome;

/// The inner residual relative to that of the step.
const INNER: f64 = 0.15;
const INNER_ROLLING: f64 = 0.35;
/// The last step need not be solved further than to this part of the tolerance, and what starts the next one does the rest, from
/// residuals below that part of it.
const ENOUGH: f64 = 0.9;
const NEAR: f64 = 1.5;
/// But always to this part.
const LEAST_GAIN: f64 = 0.5;
/// Below this residual fresh displacements are round-off: the certificate is tried from here on, whatever the tolerance, for what is not fresh hides more.
const ROUND_OFF: f64 = 1e-15;
/// It and rho are cut by this when steps bring nothing, down to the least.
const CUT: f64 = 0.3;
const LEAST_INNER: f64 = 0.01;
/// Directions of a linear solve. Where steps bring nothing, as many as it has unknowns solve it whatever the preconditioner: so many
/// elements of them together may be kept.
const DIRECTIONS: usize = 40;
const KEPT: usize = 1 << 21;
/// Steps then go this part of their way, every other time: two sets of slipping elements may follow each other for ever.
const PART: f64 = 0.5;
/// The preconditioner does not help where a certificate finds more than WORSE times the residual before it, TIMES_WORSE times in a row. A single time may
/// come from displacements that were not fresh.
const WORSE: f64 = 1.5;
const TIMES_WORSE: u32 = 2;
/// Steps without the residual falling to this part of its least.
const PATIENCE: u32 = 4;
const PROGRESS: f64 = 0.7;
/// Coarser grids are left where q exceeds its bounds by so many times the tolerance: the next one cuts it off.
const COARSE_EXCESS: f64 = 10.0;
/// Steps at most where nothing is certified.
const MOST_STEPS: u64 = 60;
/// Cuts without progress after which the steps end.
const MOST_CUTS: u32 = 6;
/// Creepages of more than so many times that at which all slips, and the slip that is given, run away: the system has nothing that holds them.
const RUNAWAY: f64 = 1e4;

/// How it finds what slips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// By the natural map in which the slip moves tractions as far as their bounds.
    Plain,
    /// In which it moves them as far as they displace: what slips much is seen to slip, whatever its bound.
    Bold,
    /// The same with creepages by which the natural map carries the forces.
    Balanced,
    /// The same in turns: creepages that carry the forces while displacements stand still, and a step in which these creepages are given.
    InTurns,
}

/// The progress of the steps, and the kind of the next one.
struct Course {
    /// Of rho.
    factor: f64,
    /// The inner residual.
    inner: f64,
    /// The least residual, the steps since then, and the cuts since then.
    least: f64,
    since: u32,
    cuts: u32,
    /// The last residual, and the steps that did not change it.
    last: f64,
    still: u32,
}

impl Course {
    fn new(inner: f64) -> Course {
        Course { factor: 1.0, inner, least: f64::INFINITY, since: 0, cuts: 0, last: f64::INFINITY, still: 0 }
    }

    /// Takes what is missing now. Says whether steps go on.
    fn goes_on(&mut self, worst: f64, by_force: bool) -> bool {
        // Nothing moves any more: the system holds no creepages, whatever rho is.
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

    /// The part of its way that the next step goes.
    fn length(&self) -> f64 {
        if self.cuts % 2 == 1 {
            PART
        } else {
            1.0
        }
    }
}

/// What certificates were taken at.
#[derive(Default)]
struct Tried {
    /// The residual before the last one, which was not met.
    before: Option<f64>,
    /// In a row.
    worse: u32,
}

impl Tried {
    /// Takes the residual behind it.
    fn compare(&mut self, residual: f64) {
        if let Some(before) = self.before.take().filter(|_| self.is_by_step()) {
            self.worse = if residual > WORSE * before { self.worse + 1 } else { 0 };
        }
    }

    /// Whether the preconditioner serves.
    fn is_by_step(&self) -> bool {
        self.worse < TIMES_WORSE
    }

    /// Whether it is to be tried.
    fn is_near(&self, measures: Measures, missing: f64, tolerance: f64) -> bool {
        let part = if self.is_by_step() { NEAR } else { 1.0 };
        measures.residual < part * tolerance && measures.excess.max(missing) < tolerance
    }
}

/// Iterates from what the state and the offset hold.
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
    let mut course = Course::new(if problem.operators.rolling.is_some() { INNER_ROLLING } else { INNER });
    let (mut iterations, mut tried) = (0, Tried::default());
    loop {
        let rho = course.factor
            * if manner == Manner::Plain { rho_of((problem.rms_bound(), problem.rms_slip()), cap) } else { cap };
        if matches!(manner, Manner::Balanced | Manner::InTurns) {
            problem.offset = balanced(problem, state, rho, forces);
        }
        let measures = tangent.predict(problem, state, rho);
        let missing = if forces.any() { forces.missing(problem, &state.q) } else { 0.0 };
        let excess = if certified { measures.excess } else { measures.excess / COARSE_EXCESS };
        let worst = largest([measures.residual, excess, missing]);
        if !worst.is_finite() {
            return Ok(unloaded(problem, state));
        }
        if worst < tolerance && (state.is_exact || !certified) {
            return Ok(Outcome::Converged);
        }
        best.see(problem, state, worst, fields)?;
        tried.compare(measures.residual);
        if certified && !state.is_exact && tried.is_near(measures, missing, tolerance.max(ROUND_OFF)) {
            tried.before = Some(measures.residual);
            polish(problem, state, (tangent, tried.is_by_step()), of_step, fields)?;
            continue;
        }
        let runs_away = manner == Manner::Plain && square(problem.offset).sqrt() > RUNAWAY * (saturating + spinning);
        if runs_away || !course.goes_on(worst, forces.any()) {
            return Ok(Outcome::Stagnated);
        }
        let left = limit.saturating_sub(problem.operators.products - made);
        if left == 0 || iterations >= MOST_STEPS && !certified {
            return Ok(Outcome::IterationLimit);
        }
        iterations += 1;
        let enough = course.inner.max((ENOUGH * tolerance / worst).min(LEAST_GAIN));
        let most = if course.factor < 1.0 { all_directions(problem) } else { DIRECTIONS }.min(left as usize);
        let effort = Effort { inner: enough, most, left: measures.residual, length: course.length() };
        step(problem, state, tangent, (of_step, effort), fields)?;
        if !watch(worst) {
            return Ok(Outcome::Cancelled);
        }
    }
}

/// Nothing is left of an iteration that came to no numbers.
fn unloaded(problem: &mut Problem, state: &mut State) -> Outcome {
    problem.offset = [0.0; 2];
    state.unload(problem.threads());
    Outcome::Stagnated
}

/// The largest of these, which are not negative; NaN if there is one.
fn largest(values: [f64; 3]) -> f64 {
    values.into_iter().fold(0.0, |most, value| if most.is_nan() || value <= most { most } else { value })
}

/// As many as there are unknowns, if so many can be kept.
fn all_directions(problem: &Problem) -> usize {
    (KEPT / problem.grid.len()).min(2 * problem.count() + 2).max(DIRECTIONS)
}
