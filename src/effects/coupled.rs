//! Problems that are coupled with the normal one: both are solved in turns, and a step leaves something to the next one.

use crate::contact::State;
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::memory::zeros;
use crate::progress::{Monitor, Outcome};

/// A problem of its own that displaces the undeformed distance of the normal one. `state` holds the solution of the normal problem, with
/// the distance that was made last.
///
/// ```text
/// repeat   solve           its own problem, with the pressures of the normal one
///          displace        h by what was found
///          until the certificate of the normal problem holds with that distance; else the normal problem once more
/// step_done
/// ```
pub trait Coupled {
    /// Solves its own problem with the pressures of a normal problem that ended with `stop`. Says how that ended.
    fn solve(&mut self, stop: Outcome, state: &State, monitor: &mut Monitor<'_>) -> Result<Outcome>;

    /// Whether it displaces the undeformed distance; if not, there is one turn.
    fn displaces(&self) -> bool;

    /// Adds what it displaces to the undeformed distance of the scene.
    fn displace(&mut self, distance: &mut [f64]);

    /// Whether the options leave it work for another turn.
    fn has_work_left(&self) -> bool;

    /// The turns have come to their end: refuses what the last pressures do not allow.
    fn refuse(&mut self) -> Result<()> {
        Ok(())
    }

    /// The step is done: keeps what the next one continues from.
    fn step_done(&mut self, state: &State);
}

/// The history of an effect from step to step: fields of one value per element.
#[derive(Debug, Default)]
pub struct History {
    fields: Vec<Vec<f64>>,
    has_step: bool,
    /// It is that of another solver, which has the result that goes with it.
    pub is_given: bool,
    /// Of the steps so far, for effects that have a time.
    pub time: f64,
    /// The error of the steps so far, added up: a length.
    pub error: f64,
}

impl History {
    /// So many fields, which are 0 where no step was done. Refuses a history that was [taken](History::take) and has another number of them.
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

    /// The fields that there are.
    pub fn known(&self) -> &[Vec<f64>] {
        &self.fields
    }

    /// The same, to be written.
    pub fn known_mut(&mut self) -> &mut [Vec<f64>] {
        &mut self.fields
    }

    /// Whether a step was done.
    pub fn has_step(&self) -> bool {
        self.has_step
    }

    /// A step is done.
    pub fn keep(&mut self) {
        self.has_step = true;
    }

    /// There is no last step.
    pub fn forget(&mut self) {
        self.fields.iter_mut().for_each(|field| field.fill(0.0));
        (self.has_step, self.is_given, self.time, self.error) = (false, false, 0.0, 0.0);
    }

    /// All of it as numbers: the time, the error, then the fields one after the other; none before the first step, and without fields.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        let is_there = self.has_step && !self.fields.is_empty();
        is_there.then(|| [self.time, self.error].into_iter().chain(self.fields.iter().flatten().copied()).collect())
    }

    /// Becomes what these numbers say.
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
