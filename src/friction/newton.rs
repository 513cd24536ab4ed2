//! The semismooth Newton method: for steady rolling, for given forces, and for motions for which the projected conjugate gradients stall.
//!
//! With the prediction of [`Tangent`] (P, D, n) and the step onto the circles x0, each Newton step solves
//!
//! ```text
//! (P A P + D) z + sum_k dc_k P e_k = P(-(s + A x0)),        x0 = g n - q on slip
//!                            sum z = F/(dx dy) - sum(q + x0)        for each direction k whose force is given
//! ```
//!
//! with B in place of A in steady rolling. e_k is the slip by a unit creepage in direction k, and dc_k the change of that creepage. Flexible GMRES
//! solves the system; its preconditioner is that of the conjugate gradients, bordered by the creepages. Then `q += x0 + z`, without line search or
//! projection (Alart and Curnier 1991; Christensen 2002). [`step`](super::step) makes the steps.
//!
//! A certificate needs a fresh product. Before this product [`polish`] makes a cheap step, x0 plus a part of the preconditioned residual, which
//! suffices near the solution. If the preconditioner is far from an inverse, as for thin stiff coatings in steady rolling, that part increases the
//! residual each time. Then `polish` uses x0 alone.

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

/// The relative residual at which the linear solve of a step ends, except in steady rolling.
const INNER: f64 = 0.15;
/// The same in steady rolling.
const INNER_ROLLING: f64 = 0.35;
/// If the residual is below this times the tolerance, `polish` follows instead of a step.
const POLISH_BELOW: f64 = 1.5;
/// Smaller residuals are round-off, and displacements that are not fresh have larger errors. So `polish` also follows below this residual.
const ROUND_OFF: f64 = 1e-15;
/// If steps make no progress, rho and the relative residual of linear solves are multiplied by this factor. This is called a cut.
const CUT: f64 = 0.3;
/// The least relative residual of linear solves after cuts.
const LEAST_INNER: f64 = 0.01;
/// After a cut a linear solve may take as many search directions as it has unknowns, which solve it with any preconditioner. The fields of these
/// directions together must have at most this many elements.
const MOST_VALUES: usize = 1 << 21;
/// The length of steps after an odd number of cuts: full steps may alternate between two slip areas for ever.
const SHORT_STEP: f64 = 0.5;
/// A certificate is worse if its residual is more than this times the residual predicted before `polish`.
const WORSE_CERTIFICATE: f64 = 1.5;
/// After this many worse certificates in a row `polish` uses x0 alone. A single one may come from displacements that were not fresh.
const TIMES_WORSE: u32 = 2;
/// A cut follows after more than this many steps without progress.
const PATIENCE: u32 = 4;
/// Progress is a residual below this times the least one so far.
pub const PROGRESS: f64 = 0.7;
/// On coarser grids q may exceed its bounds by this times the tolerance, because the interpolation to the next finer grid projects q.
const COARSE_EXCESS: f64 = 10.0;
/// The largest number of steps on a coarser grid.
const MOST_STEPS: u64 = 60;
/// The iteration ends as stagnated after more than this many cuts without progress.
const MOST_CUTS: u32 = 6;
/// The iteration ends if the creepages, as slips, exceed this times the sum of the given slip and the displacement by tractions at the bounds. Then
/// the linear systems do not determine them.
const RUNAWAY: f64 = 1e4;

/// How the natural map `tau = q - rho s` predicts the slipping elements, and how creepages of given forces are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// rho times the rms slip is the rms bound, but rho is at most the inverse compliance. The creepages are unknowns of the linear systems.
    Plain,
    /// rho is the inverse compliance: elements of large slip are predicted to slip, whatever their bounds. Before each step the creepages are set to
    /// those at which the projections of tau onto the discs carry the given forces ([`balanced`]). They are also unknowns of the linear systems.
    Balanced,
    /// As `Balanced`, but in turns: the creepages are set so, then a step is made with these creepages given.
    InTurns,
}

/// The progress of the steps, and how the next one is solved.
struct StepControl {
    /// The factor on rho.
    factor: f64,
    /// The relative residual at which linear solves end.
    inner: f64,
    /// The least residual so far.
    least: f64,
    /// The number of steps since progress was made or since the last cut.
    since: u32,
    /// The number of cuts since progress was made.
    cuts: u32,
    /// The residual of the last step.
    last: f64,
    /// The number of last steps that did not change the residual.
    still: u32,
}

impl StepControl {
    fn new(inner: f64) -> StepControl {
        StepControl { factor: 1.0, inner, least: f64::INFINITY, since: 0, cuts: 0, last: f64::INFINITY, still: 0 }
    }

    /// Records the residual of an iterate, and cuts if there is no progress. Returns whether to go on.
    fn goes_on(&mut self, worst: f64, by_force: bool) -> bool {
        // If the residual stays constant, the linear systems do not determine the creepages, whatever rho is.
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

/// Whether certificates confirm the residuals that were predicted before them.
#[derive(Default)]
struct Certificates {
    /// The residual before the last `polish`, until it is compared.
    before: Option<f64>,
    /// The number of last certificates in a row that were worse.
    worse: u32,
}

impl Certificates {
    /// Compares the residual of a certificate with that before `polish`.
    fn compare(&mut self, residual: f64) {
        if let Some(before) = self.before.take().filter(|_| self.uses_preconditioner()) {
            self.worse = if residual > WORSE_CERTIFICATE * before { self.worse + 1 } else { 0 };
        }
    }

    /// Whether `polish` uses a part of the preconditioned residual.
    fn uses_preconditioner(&self) -> bool {
        self.worse < TIMES_WORSE
    }

    /// Whether the iterate is so near to the tolerance that `polish` follows.
    fn is_near(&self, measures: Measures, missing: f64, tolerance: f64) -> bool {
        let part = if self.uses_preconditioner() { POLISH_BELOW } else { 1.0 };
        measures.residual < part * tolerance && measures.excess.max(missing) < tolerance
    }
}

/// Iterates from the given tractions and from the creepages in the problem's offset.
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
    let displaced = problem.rms_bound() / cap;
    let given_slip = problem.rms(|i| problem.rigid[i]).max(problem.rms(|i| problem.slip[i]));
    let made = problem.operators.products;
    let forces_of_step = if manner == Manner::InTurns { Forces::NONE } else { forces };
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
            polish(problem, state, (tangent, certificates.uses_preconditioner()), forces_of_step, fields)?;
            continue;
        }
        let runs_away = manner == Manner::Plain && square(problem.offset).sqrt() > RUNAWAY * (displaced + given_slip);
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
        step(problem, state, tangent, (forces_of_step, effort), fields)?;
        if !watch(worst) {
            return Ok(Outcome::Cancelled);
        }
    }
}

/// Discards an iterate that is not finite: sets q, u and the creepages to 0. Returns the outcome.
fn unloaded(problem: &mut Problem, state: &mut State) -> Outcome {
    problem.offset = [0.0; 2];
    state.unload(problem.threads());
    Outcome::Stagnated
}

/// As many directions as unknowns, but not more than [`MOST_VALUES`] allows, and at least [`DIRECTIONS`].
fn all_directions(problem: &Problem) -> usize {
    (MOST_VALUES / problem.grid.len()).min(2 * problem.count() + 2).max(DIRECTIONS)
}
