//! An effect for tests: a Winkler foundation with memory, in series with the bodies. It is one file and one line in the list of effects, and in no
//! release.

use super::coupled::{Coupled, History};
use super::effect::{Effect, Value};
use super::properties::{Continues, Properties, Stresses};
use crate::contact::State;
use crate::error::{require, Result};
use crate::grid::Grid;
use crate::influence::{self, Coefficients};
use crate::progress::{Monitor, Outcome};
use crate::scene::Plain;

/// The foundation during one step in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foundation {
    /// The instantaneous compliance c, a length per pressure.
    pub at_once: f64,
    /// The compliance d of the later part, a length per pressure.
    pub later: f64,
    /// r = dt/T, the step relative to the relaxation time.
    pub step: f64,
    /// Whether the step continues from the v of the last step.
    pub continues: bool,
}

const CONTINUES: Continues =
    Continues { member: "foundation->continues", from: "creep", instead: "begin each problem at rest" };

impl Effect for Foundation {
    fn name(&self) -> &'static str {
        "foundation"
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &["layer"],
            without_multigrid: None,
            with_given_area: true,
            one_grid: Some("what it remembers is that of one grid"),
            own_coefficients: None,
            repeats: (false, false),
            limits: None,
            is_beside: true,
            continues: self.continues.then_some(CONTINUES),
        }
    }

    fn check(&self, _grid: &Grid) -> Result<()> {
        let rule = "it must be positive and finite";
        let numbers = [("at_once", self.at_once), ("later", self.later), ("step", self.step)];
        let is_positive = |value: f64| value > 0.0 && value.is_finite();
        numbers.iter().try_for_each(|(name, value)| require(is_positive(*value), name, *value, rule))
    }

    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        tell("foundation->at_once", Value::Number(self.at_once));
    }

    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        true
    }

    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        Stresses::Unknown("is given; stresses within it are not known")
    }

    fn apply(&self, coefficients: Coefficients) -> Result<Coefficients> {
        Ok(coefficients.with_layer(influence::Layer::uniform(self.at_once)))
    }

    fn coupled<'s>(&'s self, scene: &Plain<'_>, history: &'s mut History) -> Result<Option<Box<dyn Coupled + 's>>> {
        let (before, now) = history.fields(2, &scene.grid)?.split_at_mut(1);
        Ok(Some(Box::new(Creep { foundation: self, before: &mut before[0], now: &mut now[0] })))
    }
}

/// The delayed displacement v: before the step, and at its end.
struct Creep<'a> {
    foundation: &'a Foundation,
    before: &'a mut [f64],
    now: &'a mut [f64],
}

impl Coupled for Creep<'_> {
    fn solve(&mut self, _stop: Outcome, state: &State, _monitor: &mut Monitor<'_>) -> Result<Outcome> {
        let Foundation { later, step, continues, .. } = *self.foundation;
        let before = |i: usize| if continues { self.before[i] } else { 0.0 };
        for (i, now) in self.now.iter_mut().enumerate() {
            *now = (before(i) + step * later * state.p[i]) / (1.0 + step);
        }
        Ok(Outcome::Converged)
    }

    fn displaces(&self) -> bool {
        true
    }

    fn displace(&mut self, distance: &mut [f64]) {
        distance.iter_mut().zip(&*self.now).for_each(|(distance, v)| *distance += v);
    }

    fn has_work_left(&self) -> bool {
        true
    }

    fn step_done(&mut self, _state: &State) {
        self.before.copy_from_slice(self.now);
    }
}

#[path = "foundation_tests.rs"]
mod tests;
