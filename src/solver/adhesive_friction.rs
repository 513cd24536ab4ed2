//! Friction of adhesive bodies. The contact pressures q bound the tractions, not the total pressures, which may pull (Derjaguin 1934). A shear
//! strength tau0 of the contact adds to the bound:
//!
//! ```text
//! |tractions| <= mu q + tau0  in C,     0 outside
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

/// The bound as pressures and coefficients of a tangential problem: pressures 1 on C, and the bound as coefficient.
pub struct Bound {
    /// 1 on C, 0 outside.
    pub pressing: Vec<f64>,
    bound: Vec<f64>,
}

impl Bound {
    /// The bound from contact pressures q of n elements; C are elements with q > 0.
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

    /// A friction with this bound.
    pub fn of<'a>(&'a self, friction: &Friction<'a>) -> Friction<'a> {
        Friction { coefficient: Coefficient::PerElement(&self.bound), ..*friction }
    }
}

/// Calls `solve` with friction and pressures for contact pressures `q`. With adhesion they are those of the [bound](Bound).
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

/// Rejects friction that changes the pressures.
pub fn check_alike(scene: &Scene<'_>) -> Result<()> {
    if scene.friction.is_none() || !is_of_unlike_bodies(scene)? {
        return Ok(());
    }
    let message = "adhesion and friction are both given, and the bodies are unlike: tractions change the pressures; this version does not \
                   solve them together";
    Err(Error::Unsupported(message.into()))
}

impl Solver {
    /// The tangential problem of a scene with adhesion, whose normal problem ended with `outcome`.
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
