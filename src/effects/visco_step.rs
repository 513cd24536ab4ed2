//! A step in time of bodies that relax, on the elements of a grid.
//!
//! The history has A p of the last step, then the displacements of each body's dashpots, branch by branch.

use super::coupled::History;
use super::memory::Memory;
use crate::contact::State;
use crate::visco::{Form, Map, Report, Series, MOST_BRANCHES};

/// With this factor squares of all lengths up to 1e300 are finite.
const SMALL: f64 = 1e-150;

/// A body: its share of the instantaneous compliance, and its step.
pub struct Body {
    share: f64,
    map: Map,
}

impl Body {
    /// The map of a body over a time step in a form.
    pub fn new(series: &Series, share: f64, (time_step, form): (f64, Form)) -> Body {
        Body { share, map: Map::new(series, time_step, form) }
    }
}

/// One step in time.
pub struct Step {
    /// The length of the step; 0: an instantaneous load.
    pub time_step: f64,
    pub bodies: Vec<Body>,
    /// The bodies in another form, for the error.
    pub compared: Vec<Body>,
    /// Whether there is a step before.
    pub continues: bool,
}

impl Step {
    /// Fields of the history.
    pub fn fields(&self) -> usize {
        1 + self.bodies.iter().map(|body| body.map.branches()).sum::<usize>()
    }

    /// H, the displacement of element i by the history, by the maps of `bodies`, from the fields `[A p, q...]`.
    fn history(bodies: &[Body], fields: &[Vec<f64>], i: usize) -> f64 {
        let (mut sum, mut first, mut q) = (0.0, 1, [0.0; MOST_BRANCHES]);
        for Body { share, map } in bodies {
            let n = map.branches();
            fields[first..first + n].iter().zip(&mut q).for_each(|(field, q)| *q = field[i]);
            sum += map.history(&q[..n], share * fields[0][i]);
            first += n;
        }
        sum
    }

    /// The compliance of `bodies` over the step, relative to their instantaneous compliance.
    pub fn compliance_of(bodies: &[Body]) -> f64 {
        bodies.iter().map(|body| body.share * body.map.compliance()).sum()
    }

    /// The difference of the displacements by both forms, and h - approach: rms over the elements in contact.
    fn error(&self, fields: &[Vec<f64>], state: &State) -> (f64, f64) {
        let found = self.error_by(1.0, fields, state);
        // In very long steps, bodies that flow have displacements whose squares overflow.
        if found.0.is_finite() && found.1.is_finite() {
            return found;
        }
        let (off, distance) = self.error_by(SMALL, fields, state);
        (off / SMALL, distance / SMALL)
    }

    /// [`Step::error`], times a `factor` that prevents overflow.
    fn error_by(&self, factor: f64, fields: &[Vec<f64>], state: &State) -> (f64, f64) {
        let (s, other) = (Step::compliance_of(&self.bodies), Step::compliance_of(&self.compared));
        let (mut differences, mut distances, mut count) = (0.0, 0.0, 0usize);
        for i in (0..state.p.len()).filter(|&i| state.touches(i)) {
            let history = if self.continues { Step::history(&self.bodies, fields, i) } else { 0.0 };
            let compared = if self.continues { Step::history(&self.compared, fields, i) } else { 0.0 };
            differences += (((other - s) * state.u[i] + compared - history) * factor).powi(2);
            // The distances of the problem solved contain the history, and are s times shorter.
            distances += ((s * (state.h[i] - state.approach) - history) * factor).powi(2);
            count += 1;
        }
        let rms = |squares: f64| (squares / count.max(1) as f64).sqrt();
        (if self.time_step == 0.0 { 0.0 } else { rms(differences) }, rms(distances))
    }
}

impl Memory for Step {
    fn compliance(&self) -> f64 {
        Step::compliance_of(&self.bodies)
    }

    fn fill(&self, history: &History, displacement: &mut [f64]) {
        let fields = history.known();
        for (i, displacement) in displacement.iter_mut().enumerate() {
            *displacement = if self.continues { Step::history(&self.bodies, fields, i) } else { 0.0 };
        }
    }

    fn step_done(&self, history: &mut History, state: &State) -> Report {
        let (off, distance) = self.error(history.known(), state);
        if !self.continues {
            history.forget();
        }
        history.time += self.time_step;
        history.error += off;
        let (time, sum) = (history.time, history.error);
        let fields = history.known_mut();
        let (mut q, mut after) = ([0.0; MOST_BRANCHES], [0.0; MOST_BRANCHES]);
        for i in 0..state.u.len() {
            let (before, now, mut first) = (fields[0][i], state.u[i], 1);
            for Body { share, map } in &self.bodies {
                let n = map.branches();
                fields[first..first + n].iter().zip(&mut q).for_each(|(field, q)| *q = field[i]);
                map.advance(&q[..n], share * before, share * now, &mut after[..n]);
                fields[first..first + n].iter_mut().zip(&after).for_each(|(field, after)| field[i] = *after);
                first += n;
            }
            fields[0][i] = now;
        }
        history.keep();
        // Without contact there are no distances to compare with.
        let relative = |length: f64| if distance > 0.0 { length / distance } else { 0.0 };
        Report { time, step_error: relative(off), time_error: relative(sum), compliance: self.compliance() }
    }
}
