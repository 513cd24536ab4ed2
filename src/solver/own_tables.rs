//! The caller's tangential influence coefficients. A solver keeps those of its set-up: later scenes may leave them out, and may not have others.

use std::borrow::Cow;
use std::sync::Arc;

use super::{Solver, Tangent};
use crate::effects::{Effect, KeptInfluence, SET_THEM};
use crate::error::{invalid, Error, Result};
use crate::scene::{Bodies, Friction, Load, Scene};

impl Solver {
    /// Returns the scene with the tangential coefficients of this solver. Refuses a scene with other ones. `own` are the coefficients of this solver,
    /// held by the caller of this function, so that the solver may change while the scene borrows them. If the caller also gave normal coefficients,
    /// the elastic constants are not read, and arbitrary valid ones replace them.
    pub(super) fn with_own_tables<'s>(
        &self,
        scene: &'s Scene<'_>,
        own: Option<&'s KeptInfluence>,
    ) -> Result<Cow<'s, Scene<'s>>> {
        let Some(friction) = &scene.friction else { return Ok(Cow::Borrowed(scene)) };
        let bodies = if self.problem.given { Bodies::same(1.0, 0.0) } else { scene.bodies };
        let name = friction.influence.or(own.map(KeptInfluence::view)).map_or("", |tables| tables.name());
        let refused = |what: &str| Err(Error::InfluenceChanged(format!("{name} {what}")));
        match (&friction.influence, own) {
            (None, Some(own)) => {
                let friction = Friction { influence: Some(own.view()), ..*friction };
                Ok(Cow::Owned(Scene { friction: Some(friction), bodies, ..scene.clone() }))
            }
            (Some(given), Some(own)) if !own.is(given) => {
                refused(&format!("holds other coefficients than this solver has; {SET_THEM}"))
            }
            // Coefficients that are invalid are refused for that reason, not because the solver has none.
            (Some(_), None) => Effect::check(friction, &self.problem.grid)
                .and_then(|()| refused("is given, but this solver was set up without: set up another one with it")),
            _ if bodies != scene.bodies => Ok(Cow::Owned(Scene { bodies, ..scene.clone() })),
            _ => Ok(Cow::Borrowed(scene)),
        }
    }

    /// The caller's tangential influence coefficients, if this solver has any.
    pub(crate) fn own_tangential_tables(&self) -> Option<&KeptInfluence> {
        self.own_tables.as_deref()
    }

    /// Refuses tangential coefficients that cannot replace those of this solver: they must have the same layout, and cross tables if this solver has
    /// them.
    pub fn check_tangential_influence(&self, friction: &Friction<'_>) -> Result<()> {
        let Some(given) = &friction.influence else {
            let name = self.own_tables.as_ref().map_or("friction->influence", |own| own.view().name());
            return invalid(format!("{name} is not given: there is nothing to set"));
        };
        if self.own_tables.as_ref().is_none_or(|own| own.view().by_row != given.by_row) {
            return invalid(format!("{} is given, but this solver was set up without", given.name()));
        }
        if self.own_tables.as_ref().is_some_and(|own| own.view().cross.is_some() != given.cross.is_some()) {
            let (now, before) = if given.cross.is_some() { ("given", "without") } else { ("not given", "with it") };
            return invalid(format!("friction->influence_cross is {now}, but this solver was set up {before}"));
        }
        given.check_for_any_motion(&self.problem.grid)
    }

    /// Replaces the tangential coefficients for all later solves with friction. The last result does not change.
    pub fn set_tangential_influence(&mut self, friction: &Friction<'_>) -> Result<()> {
        self.check_tangential_influence(friction)?;
        let Some(given) = &friction.influence else { return Ok(()) };
        let kept = Arc::new(KeptInfluence::new(given)?);
        if let Some(before) = self.friction.take() {
            match self.tangent_of(friction) {
                Ok(new) => self.friction = Some(Box::new(new.with_last_of(*before))),
                Err(error) => {
                    self.friction = Some(before);
                    return Err(error);
                }
            }
        }
        self.own_tables = Some(kept);
        self.workers.clear();
        self.crew.clear();
        Ok(())
    }

    /// Sets up a solver of the tangential problem with the coefficients of `friction`.
    fn tangent_of(&self, friction: &Friction<'_>) -> Result<Tangent> {
        let (bodies, load) = (Bodies::same(1.0, 0.0), Load::Approach(0.0));
        let scene = Scene { friction: Some(*friction), ..Scene::new(self.problem.grid, &[], bodies, load) };
        Tangent::new(&scene, &self.set_up.options, &self.problem.threads)
    }
}
