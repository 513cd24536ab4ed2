//! Problems coupled with the normal one: both are solved in turns, with a history from step to step.

use crate::contact::State;
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::memory::zeros;
use crate::progress::{Monitor, Outcome};

/// A problem that displaces the undeformed distance of the normal one. `state` holds the solution of the normal problem, with the last displaced
/// distance.
///
/// ```text
/// repeat   solve           its own problem, with the pressures of the normal one
///          displace        h by the displacements of this solution
///          until the certificate of the normal problem holds with that distance; else the normal problem once more
/// step_done
/// ```
pub trait Coupled {
    /// Solves the problem with the pressures of a normal problem that ended with `outcome`. Returns its own outcome.
    fn solve(&mut self, outcome: Outcome, state: &State, monitor: &mut Monitor<'_>) -> Result<Outcome>;

    /// Whether the problem displaces the undeformed distance; if not, there is one turn.
    fn displaces(&self) -> bool;

    /// Adds the problem's displacements to the undeformed distance of the scene.
    fn displace(&mut self, distance: &mut [f64]);

    /// Whether the options allow another turn.
    fn has_work_left(&self) -> bool;

    /// After the last turn: refuses loads that the last pressures do not allow.
    fn refuse(&mut self) -> Result<()> {
        Ok(())
    }

    /// Ends the step: keeps the state from which the next one continues.
    fn step_done(&mut self, state: &State);
}

/// The history of an effect from step to step: fields of one value per element.
#[derive(Debug, Default)]
pub struct History {
    fields: Vec<Vec<f64>>,
    has_step: bool,
    /// Whether the history was [taken](History::take) from another solver, whose result belongs to it.
    pub is_given: bool,
    /// The time of the steps so far, for effects with a time.
    pub time: f64,
    /// The sum of the errors of the steps so far, a length.
    pub error: f64,
}

impl History {
    /// The `count` fields, 0 before the first step. Refuses a [taken](History::take) history with another number of fields.
    pub fn fields(&mut self, count: usize, grid: &Grid) -> Result<&mut [Vec<f64>]> {
        if self.is_given && self.fields.len() != count {
            let known = self.fields.len();
            return invalid(format!("a history has {known} fields; steps of these bodies keep {count}"));
        }
        while self.fields.len() < count {
            self.fields.push(zeros(grid.len(), "what an effect keeps from step to step")?);
        }
        Ok(&mut self.fields[..count])
    }

    /// The present fields.
    pub fn known(&self) -> &[Vec<f64>] {
        &self.fields
    }

    /// The present fields, mutable.
    pub fn known_mut(&mut self) -> &mut [Vec<f64>] {
        &mut self.fields
    }

    /// Whether a step was done.
    pub fn has_step(&self) -> bool {
        self.has_step
    }

    /// Ends a step.
    pub fn keep(&mut self) {
        self.has_step = true;
    }

    /// Forgets all steps.
    pub fn forget(&mut self) {
        self.fields.iter_mut().for_each(|field| field.fill(0.0));
        (self.has_step, self.is_given, self.time, self.error) = (false, false, 0.0, 0.0);
    }

    /// The history as numbers: the time, the error, then the fields one after the other. None before the first step or
    /// without fields.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        let is_there = self.has_step && !self.fields.is_empty();
        is_there.then(|| [self.time, self.error].into_iter().chain(self.fields.iter().flatten().copied()).collect())
    }

    /// Takes the history from its [numbers](History::numbers).
    pub fn take(&mut self, numbers: &[f64], grid: &Grid) -> Result<()> {
        let [time, error, values @ ..] = numbers else { return invalid("a history begins with two numbers".into()) };
        if values.is_empty() || values.len() % grid.len() != 0 {
            let (count, elements) = (values.len(), grid.len());
            return invalid(format!("a history has {count} values; it must have fields of {elements}"));
        }
        (self.fields, self.is_given) = (Vec::new(), false);
        self.fields(values.len() / grid.len(), grid)?;
        for (field, values) in self.fields.iter_mut().zip(values.chunks(grid.len())) {
            field.copy_from_slice(values);
        }
        (self.has_step, self.is_given, self.time, self.error) = (true, true, *time, *error);
        Ok(())
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.fields.iter().map(|field| size_of_val(&field[..])).sum()
    }
}
