//! A step in time of viscoelastic bodies, on the elements of a grid. The [equations](crate::visco) are linear in w, the instantaneous displacement of
//! a body, and in q_k, the displacements of its dashpots.
//!
//! Field 0 of the history is A p after the last step. The further fields are q_k of each body, branch by branch.

use super::coupled::History;
use super::memory::Memory;
use crate::contact::State;
use crate::visco::{Form, Map, Report, Series, MOST_BRANCHES};

/// The squares of lengths up to 1e300, multiplied by this factor, are finite.
const SMALL: f64 = 1e-150;

/// A viscoelastic body in a step.
pub struct Body {
    /// The part of A p by which this body is displaced at once.
    share: f64,
    /// The linear map from w and q_k before the step, and w after it, to the displacement and to q_k after the step.
    map: Map,
}

impl Body {
    /// A body in a step of duration `time_step` and of a `form`.
    pub fn new(series: &Series, share: f64, (time_step, form): (f64, Form)) -> Body {
        Body { share, map: Map::new(series, time_step, form) }
    }
}

/// One step in time of the bodies of a scene.
pub struct Step {
    /// The duration of the step. 0: the load jumps.
    pub time_step: f64,
    /// The bodies in the form of the step.
    pub bodies: Vec<Body>,
    /// The bodies in the other form, for an estimate of the error.
    pub compared: Vec<Body>,
    /// Whether the step begins at the end of the last step. Otherwise the bodies are at rest before the step.
    pub continues: bool,
}

impl Step {
    /// The number of fields in the history.
    pub fn fields(&self) -> usize {
        1 + self.bodies.iter().map(|body| body.map.branches()).sum::<usize>()
    }

    /// H of element i: the displacement after the step that the `fields` of the history cause, with the maps of `bodies`.
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

    /// Two rms values over the elements in contact: of the difference between the displacements of both forms, and of h - approach.
    fn error(&self, fields: &[Vec<f64>], state: &State) -> (f64, f64) {
        let (difference, distance) = self.error_by(1.0, fields, state);
        if difference.is_finite() && distance.is_finite() {
            return (difference, distance);
        }
        // In very long steps, bodies that flow have displacements whose squares overflow.
        let (difference, distance) = self.error_by(SMALL, fields, state);
        (difference / SMALL, distance / SMALL)
    }

    /// Both values of [`Step::error`], multiplied by a `factor` that prevents overflow.
    fn error_by(&self, factor: f64, fields: &[Vec<f64>], state: &State) -> (f64, f64) {
        let (s, other) = (Step::compliance_of(&self.bodies), Step::compliance_of(&self.compared));
        let (mut differences, mut distances, mut count) = (0.0, 0.0, 0usize);
        for i in (0..state.p.len()).filter(|&i| state.touches(i)) {
            let history = if self.continues { Step::history(&self.bodies, fields, i) } else { 0.0 };
            let compared = if self.continues { Step::history(&self.compared, fields, i) } else { 0.0 };
            differences += (((other - s) * state.u[i] + compared - history) * factor).powi(2);
            // `state.h` is (h + H)/s, and `state.approach` is approach/s (module `memory`).
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
        let (difference, distance) = self.error(history.known(), state);
        if !self.continues {
            history.forget();
        }
        history.time += self.time_step;
        history.error += difference;
        let (time, sum_of_errors) = (history.time, history.error);
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
        // Without contact there is no h - approach to which an error is relative.
        let relative = |length: f64| if distance > 0.0 { length / distance } else { 0.0 };
        let (step_error, time_error) = (relative(difference), relative(sum_of_errors));
        Report { time, step_error, time_error, compliance: self.compliance() }
    }
}
