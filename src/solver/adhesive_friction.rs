//! Friction of adhesive bodies. The contact pressures q bound the tractions (Derjaguin 1934). The total pressures p cannot, because they are negative
//! where the attraction exceeds q. A shear strength tau0 of the contact adds to the bound:
//!
//! ```text
//! |traction| <= mu q + tau0   in C,     traction = 0   outside
//! ```

use super::tangential::{is_of_unlike_bodies, Turn};
use super::{Options, Outcome, Solver};
use crate::adhesion::Split;
use crate::effects::{Adhesion, Coefficient};
use crate::error::{Error, Result};
use crate::friction::Report;
use crate::memory::zeros;
use crate::progress::Monitor;
use crate::scene::{Friction, Scene};

/// The traction bound `mu q + tau0` as inputs of a tangential problem, whose bound is a product: the pressures are 1 on C, and the coefficients of
/// friction are the bound.
pub struct Bound {
    /// The pressures: 1 on C, 0 outside.
    pub pressing: Vec<f64>,
    /// The coefficients of friction: the bound of each element, 0 outside C.
    bound: Vec<f64>,
}

impl Bound {
    /// Computes the bound of n elements from their contact pressures `q(i)` and the shear strength tau0. C is where q > 0.
    pub fn new(friction: &Friction<'_>, strength: f64, n: usize, q: impl Fn(usize) -> f64) -> Result<Bound> {
        let field = || zeros::<f64>(n, "the bound of friction");
        let (mut pressing, mut bound) = (field()?, field()?);
        for (i, (pressing, bound)) in pressing.iter_mut().zip(&mut bound).enumerate() {
            let q = q(i);
            if q > 0.0 {
                (*pressing, *bound) = (1.0, friction.coefficient.at(i) * q + strength);
            }
        }
        Ok(Bound { pressing, bound })
    }

    /// Returns `friction` with this bound as its coefficients.
    pub fn of<'a>(&'a self, friction: &Friction<'a>) -> Friction<'a> {
        Friction { coefficient: Coefficient::PerElement(&self.bound), ..*friction }
    }
}

/// Calls `solve` with the friction and the pressures of a tangential problem with contact pressures `q`. Without adhesion these are the given ones,
/// with adhesion those of [`Bound`].
pub fn bounded<R>(
    scene: &Scene<'_>,
    friction: &Friction<'_>,
    q: &[f64],
    solve: impl FnOnce(&Friction<'_>, &[f64]) -> Result<R>,
) -> Result<R> {
    let Some(adhesion) = scene.attraction() else { return solve(friction, q) };
    check_alike(scene)?;
    let bound = Bound::new(friction, adhesion.shear_strength, q.len(), |i| q[i])?;
    solve(&bound.of(friction), &bound.pressing)
}

/// Refuses friction of unlike bodies, whose tractions change the pressures.
pub fn check_alike(scene: &Scene<'_>) -> Result<()> {
    if scene.friction.is_none() || !is_of_unlike_bodies(scene)? {
        return Ok(());
    }
    let message = "adhesion and friction are both given, and the bodies are unlike: tractions change the pressures; this version does not \
                   solve them together";
    Err(Error::Unsupported(message.into()))
}

impl Solver {
    /// Solves the tangential problem of a scene with adhesion, whose normal problem ended with `outcome`. Returns the outcome of the normal problem
    /// unless it converged, else that of the tangential one; and the report of friction if the scene has friction.
    pub(super) fn rub(
        &mut self,
        scene: &Scene<'_>,
        (adhesion, split): (&Adhesion<'_>, &Split),
        options: &Options,
        outcome: Outcome,
        monitor: &mut Monitor<'_>,
    ) -> Result<(Outcome, Option<Report>)> {
        let Some(friction) = &scene.friction else {
            self.friction.iter_mut().for_each(|before| before.pass_over());
            return Ok((outcome, None));
        };
        let of_element = |i: usize| split.at(&self.state, i).0;
        let bound = Bound::new(friction, adhesion.shear_strength, scene.grid.len(), of_element)?;
        let threads = self.problem.threads.clone();
        let mut tangent = self.take_tangent(scene, options)?;
        let turn = Turn { scene, friction: &bound.of(friction), options, threads: &threads };
        let solved = tangent.solve_after(outcome, &turn, &bound.pressing, turn.start(), monitor);
        self.friction = Some(tangent);
        let (ended, report, _) = solved?;
        Ok((if outcome == Outcome::Converged { ended } else { outcome }, Some(report)))
    }
}
