//! A prescribed force within limits, as a sequence of approaches: what takes over where iterations that carry the force at every step go
//! round in circles.
//!
//! By approach the problem is that of a least energy in a box, and the force that it needs grows with the approach, in pieces that are
//! linear. Two approaches between which the prescribed force lies are brought together: by the secant, and by the middle where that has
//! replaced the same one of them twice. Each solve starts from what lies between their pressures:
//!
//! ```text
//! p = p1 + s (p2 - p1),   s = (F - F1)/(F2 - F1)
//! ```
//!
//! These pressures carry the force and keep the limits. As soon as both approaches lie on the same piece they are the answer, on which
//! the loop's certificate decides.

use super::best::Best;
use super::iterate::iterate;
use crate::contact::{AdmissibleSet, Freshness, State};
use crate::error::Result;
use crate::memory::reserve;
use crate::methods::descent::Descent;
use crate::methods::projected_cg::ProjectedCg;
use crate::methods::{Change, Policy, Step, Task};
use crate::progress::{Criterion, Goal, Outcome};
use crate::scene::Load;

/// Each solve by approach reaches this part of the tolerance: both ends together must pass the certificate.
const AIM: f64 = 0.25;
/// Cycles of one solve by approach at most. It starts near its solution.
const CYCLES: u64 = 200;
/// Doublings of the depth at most, until the force lies between two approaches: a force of more is out of a double's precision.
const DOUBLINGS: u32 = 60;

/// The solution of one approach.
#[derive(Default)]
struct End {
    p: Vec<f64>,
    approach: f64,
    /// Sum of p.
    pressures: f64,
}

/// Two approaches and their solutions, kept from one solve to the next.
#[derive(Default)]
pub struct Bracket {
    low: End,
    high: End,
    /// The pressures of the step before.
    before: Vec<f64>,
    /// Of one solve by approach.
    best: Best,
}

impl Bracket {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        3 * self.before.len() * size_of::<f64>() + self.best.bytes()
    }
}

/// The method.
pub struct ByApproach<'a> {
    pub projected_cg: &'a mut ProjectedCg,
    pub descent: &'a mut Descent,
    pub bracket: &'a mut Bracket,
    /// Which end was replaced last, the high one or not, and whether twice running.
    pub last: Option<bool>,
    pub twice: bool,
}

impl ByApproach<'_> {
    /// The solution of an approach, from the pressures that the state holds, becomes an end of the bracket. False if it is not found.
    fn solve<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>, approach: f64, wanted: f64) -> Result<bool> {
        let most = task.goal.max_cycles;
        task.goal.max_cycles = most.min(task.monitor.count.cycles + CYCLES);
        let load = std::mem::replace(&mut task.state.load, Load::Approach(approach));
        task.state.approach = approach;
        task.refresh()?;
        self.bracket.best.forget();
        let mut stop = iterate(self.projected_cg, task, &mut self.bracket.best)?;
        if stop == Outcome::Stagnated {
            self.bracket.best.restore(task)?;
            stop = iterate(self.descent, task, &mut self.bracket.best)?;
        }
        (task.state.load, task.goal.max_cycles) = (load, most);
        if stop != Outcome::Converged {
            return Ok(false);
        }
        let pressures = task.state.pressures(&task.problem.threads);
        let is_high = pressures > wanted || task.carries();
        let end = if is_high { &mut self.bracket.high } else { &mut self.bracket.low };
        end.p.clone_from(&task.state.p);
        (end.approach, end.pressures) = (approach, pressures);
        self.twice = self.last == Some(is_high);
        self.last = Some(is_high);
        Ok(true)
    }

    /// The first two approaches, from the one of the state upwards. False if there are none.
    fn enclose<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>, wanted: f64) -> Result<bool> {
        let lowest = task.lowest;
        let Bracket { low, high, before, .. } = &mut *self.bracket;
        for p in [&mut low.p, &mut high.p, before] {
            reserve(p, task.state.p.len(), "the solutions of two approaches")?;
            p.clear();
            p.resize(task.state.p.len(), 0.0);
        }
        (low.approach, low.pressures, high.approach) = (lowest, 0.0, f64::INFINITY);
        let known = Some(task.state.approach - lowest).filter(|depth| *depth > 0.0);
        let mut depth = known.unwrap_or(task.problem.self_influence() * wanted);
        for _ in 0..DOUBLINGS {
            if !self.solve(task, lowest + depth, wanted)? || self.bracket.high.approach.is_finite() {
                break;
            }
            depth *= 2.0;
        }
        Ok(self.bracket.high.approach.is_finite())
    }

    /// Replaces one of the two approaches by one between them. False if its solution is not found.
    fn narrow<S: AdmissibleSet>(&mut self, task: &mut Task<'_, '_, S>, wanted: f64) -> Result<bool> {
        let Bracket { low, high, .. } = &*self.bracket;
        let part = if self.twice { 0.5 } else { (wanted - low.pressures) / (high.pressures - low.pressures) };
        let approach = low.approach + part * (high.approach - low.approach);
        self.between(task.state, task.set, part);
        self.solve(task, approach, wanted)
    }

    /// The pressures between the two ends.
    fn between<S: AdmissibleSet>(&self, state: &mut State, set: S, part: f64) {
        let Bracket { low, high, .. } = &*self.bracket;
        for i in 0..state.p.len() {
            let p = set.project(i, low.p[i] + part * (high.p[i] - low.p[i]));
            let at_limit = p >= set.limit(i);
            (state.p[i], state.at_limit[i], state.contact[i]) = (p, at_limit, p > 0.0 && !at_limit);
            state.reached_limit |= at_limit;
        }
        state.u_is = Freshness::Stale;
    }
}

impl<S: AdmissibleSet> Step<S> for ByApproach<'_> {
    fn name(&self) -> &'static str {
        "approaches in turn"
    }

    fn policy(&self) -> Policy {
        Policy { exchanged_by_loop: true, step_is_cycle: false, chatter: 0, patience: 30, progress: 1.0 }
    }

    fn begin(&mut self, _: &State) -> Result<()> {
        self.last = None;
        Ok(())
    }

    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change> {
        let gives_up = Change { gives_up: true, ..Change::default() };
        let Load::Force(force) = task.state.load else { return Ok(gives_up) };
        let wanted = force / task.state.grid.element_area();
        let aim = Goal { criterion: Criterion::Residual, tolerance: AIM * task.goal.tolerance, ..task.goal };
        let goal = std::mem::replace(&mut task.goal, aim);
        let found = match self.last {
            None => self.enclose(task, wanted)?,
            Some(_) => self.narrow(task, wanted)?,
        };
        task.goal = goal;
        let (state, set) = (&mut *task.state, task.set);
        if !found {
            // The force is not carried.
            state.u_is = Freshness::Stale;
            return Ok(gives_up);
        }
        let Bracket { low, high, .. } = &*self.bracket;
        let part = (wanted - low.pressures) / (high.pressures - low.pressures);
        // All that is at its limit may carry less than the force, by rounding.
        self.between(state, set, part.min(1.0));
        let before = &mut self.bracket.before;
        let update = before.iter().zip(&state.p).map(|(before, p)| (p - before) * (p - before)).sum::<f64>();
        before.clone_from(&state.p);
        Ok(Change { update: (update / state.contact_count().max(1) as f64).sqrt(), ..Change::default() })
    }
}
