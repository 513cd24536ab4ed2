//! Problems that are coupled with the normal one and solved in turns with it, and the history of an effect from load step to load step.

use crate::contact::State;
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::memory::zeros;
use crate::progress::{Monitor, Outcome};

/// A problem whose solution depends on the pressures and may change the undeformed distance of the normal problem. In the methods, `state` holds the
/// last solution of the normal problem. After the first solution of the normal problem, the solver calls
///
/// ```text
/// repeat   solve           this problem, with the pressures of the normal one
///          displace        adds the displacements of this solution to h
///          if the certificate of the normal problem holds with the new h: leave the loop; else solve the normal problem again
/// step_done
/// ```
pub trait Coupled {
    /// Solves this problem for the pressures of a normal problem that ended with `outcome`. Returns the outcome of this problem.
    fn solve(&mut self, outcome: Outcome, state: &State, monitor: &mut Monitor<'_>) -> Result<Outcome>;

    /// Whether the problem changes the undeformed distance. If not, it is solved once, without turns.
    fn displaces(&self) -> bool;

    /// Adds the problem's displacements to the undeformed distance of the scene.
    fn displace(&mut self, distance: &mut [f64]);

    /// Whether the limits of the options (on cycles, for instance) allow another turn.
    fn has_work_left(&self) -> bool;

    /// Called after the last turn. Refuses loads that cannot be carried with the final pressures.
    fn refuse(&mut self) -> Result<()> {
        Ok(())
    }

    /// Ends the step: keeps what the next step continues from.
    fn step_done(&mut self, state: &State);
}

/// What an effect keeps from step to step: some fields of one value per element, the time, and the error.
#[derive(Debug, Default)]
pub struct History {
    fields: Vec<Vec<f64>>,
    has_step: bool,
    /// Whether the history was [taken](History::take) from another solver.
    pub is_given: bool,
    /// The sum of the time steps so far, for effects with a time.
    pub time: f64,
    /// The sum of the estimated errors of the steps so far, a length.
    pub error: f64,
}

impl History {
    /// The `count` fields. They are 0 before the first step. Refuses a [taken](History::take) history with another number of fields.
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

    /// The fields as they are, without a check of their number.
    pub fn known(&self) -> &[Vec<f64>] {
        &self.fields
    }

    /// The fields as they are, mutable.
    pub fn known_mut(&mut self) -> &mut [Vec<f64>] {
        &mut self.fields
    }

    /// Whether there is a finished step.
    pub fn has_step(&self) -> bool {
        self.has_step
    }

    /// Records that a step is finished.
    pub fn keep(&mut self) {
        self.has_step = true;
    }

    /// Clears the history: all fields, the time and the error are 0.
    pub fn forget(&mut self) {
        self.fields.iter_mut().for_each(|field| field.fill(0.0));
        (self.has_step, self.is_given, self.time, self.error) = (false, false, 0.0, 0.0);
    }

    /// The history as an array: the time, the error, then the fields one after the other. None before the first step or
    /// without fields.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        let has_history = self.has_step && !self.fields.is_empty();
        has_history.then(|| [self.time, self.error].into_iter().chain(self.fields.iter().flatten().copied()).collect())
    }

    /// Sets the history from the [`numbers`](History::numbers) of another one.
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
