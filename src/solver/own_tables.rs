//! The tangential coefficients of the caller's own that a solver has: later scenes need not name them, and name no others.

use std::borrow::Cow;
use std::sync::Arc;

use super::{Solver, Tangent};
use crate::effects::{Effect, KeptInfluence, SET_THEM};
use crate::error::{invalid, Error, Result};
use crate::scene::{Bodies, Friction, Load, Scene};

impl Solver {
    /// A scene with the coefficients of this solver, `own`; refuses others.
    pub(super) fn with_own_tables<'s>(
        &self,
        scene: &'s Scene<'_>,
        own: Option<&'s KeptInfluence>,
    ) -> Result<Cow<'s, Scene<'s>>> {
        let Some(friction) = &scene.friction else { return Ok(Cow::Borrowed(scene)) };
        let refused = |what: &str| Err(Error::InfluenceChanged(format!("friction->influence {what}")));
        match (&friction.influence, own) {
            (None, Some(own)) => {
                let friction = Friction { influence: Some(own.view()), ..*friction };
                Ok(Cow::Owned(Scene { friction: Some(friction), ..scene.clone() }))
            }
            (Some(given), Some(own)) if !own.is(given) => {
                refused(&format!("holds other coefficients than this solver has; {SET_THEM}"))
            }
            (Some(_), None) if self.friction.is_some() => {
                refused(&format!("is given, but this solver has solved friction without; {SET_THEM}"))
            }
            _ => Ok(Cow::Borrowed(scene)),
        }
    }

    /// From here on friction is that of the tables of a scene, if it names some.
    pub(super) fn keep_tables(&mut self, scene: &Scene<'_>) -> Result<()> {
        let given = scene.friction.as_ref().and_then(|friction| friction.influence);
        if let (Some(given), None) = (given, &self.own_tables) {
            self.own_tables = Some(Arc::new(KeptInfluence::new(&given)?));
        }
        Ok(())
    }

    /// The tangential coefficients of the caller's own, if it has some.
    pub(crate) fn own_tangential_tables(&self) -> Option<&KeptInfluence> {
        self.own_tables.as_deref()
    }

    /// Refuses tangential coefficients that this solver cannot use.
    pub fn check_tangential_influence(&self, friction: &Friction<'_>) -> Result<()> {
        if friction.influence.is_none() {
            return invalid("friction->influence is not given: there is nothing to set".into());
        }
        if self.own_tables.is_none() {
            return invalid("friction->influence is given, but this solver was set up without".into());
        }
        Effect::check(friction, &self.problem.grid)
    }

    /// All later solves with friction use these tables. The last result stays.
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

    /// What solves friction with the tables that it names.
    fn tangent_of(&self, friction: &Friction<'_>) -> Result<Tangent> {
        let (bodies, load) = (Bodies::same(1.0, 0.0), Load::Approach(0.0));
        let scene = Scene { friction: Some(*friction), ..Scene::new(self.problem.grid, &[], bodies, load) };
        Tangent::new(&scene, &self.set_up.options, &self.problem.threads)
    }
}
