//! The stable state of a force. An equilibrium of a force may be an unstable one: then the stable one lies on the side of the larger approach.

use super::newton::{newton, End};
use super::place::{Place, Walk};
use super::tangent::is_stable;
use super::way::Walker;
use crate::error::Result;

/// Secants at most, between two states.
const SECANTS: u32 = 40;
/// They keep this part of the way from both.
const END: f64 = 0.02;
/// Steps up at most, and how they grow.
const MOST_STEPS: u32 = 80;
const GROWTH: f64 = 1.5;
/// The first step up, as a part of the length of the contact.
const STEP: f64 = 0.02;

impl Walker<'_, '_, '_> {
    /// Takes an equilibrium of the force that is wanted, which the level holds, if it is stable, or looks for the stable one above.
    pub fn settle(&mut self) -> Result<Walk> {
        let Some(wanted) = self.goal.wanted else { return Ok(Walk::Found) };
        if is_stable(self.level, true, self.monitor)? {
            return Ok(Walk::Found);
        }
        log::debug!("adhesion: an equilibrium at an approach of {:e} is not stable", self.level.now.approach());
        let mut step = self.first_step(STEP)?;
        if !(step > 0.0) {
            return Ok(Walk::Lost);
        }
        let (mut low, mut sum_low) = (self.level.now.approach(), wanted);
        for _ in 0..MOST_STEPS {
            let approach = low + step;
            let Some(sum) = self.solve_at(approach)? else { break };
            if sum > wanted {
                let mut best = Place::of(self.level, sum)?;
                return self.between(&mut best, (sum_low, low));
            }
            (low, sum_low) = (approach, sum);
            step *= GROWTH;
        }
        Ok(self.lost())
    }

    /// The state of the force that is wanted, between the `best` state of more force and one of less.
    pub fn between(&mut self, best: &mut Place, (mut sum_low, mut low): (f64, f64)) -> Result<Walk> {
        let Some(wanted) = self.goal.wanted else { return Ok(Walk::Lost) };
        for secant in 0..SECANTS {
            if self.goal.is_interrupted(self.monitor) {
                return Ok(Walk::Interrupted);
            }
            let part = ((best.sum - wanted) / (best.sum - sum_low)).clamp(END, 1.0 - END);
            // Now and then the middle: the secant may stand still near one end.
            let part = if secant % 3 == 2 { 0.5 } else { part };
            let approach = best.approach() + part * (low - best.approach());
            self.level.now.copy_from(&best.at)?;
            self.level.now.p.border = [approach];
            let (end, _) = newton(self.level, self.goal, true, self.monitor)?;
            let (reached, slack) = (self.level.now.approach(), best.approach() - low);
            let is_near = reached <= best.approach() + slack && reached >= low - slack;
            if end == End::Solved && is_near && is_stable(self.level, true, self.monitor)? {
                return Ok(Walk::Found);
            }
            self.level.now.copy_from(&best.at)?;
            match self.solve_at(approach)? {
                Some(sum) if sum > wanted => best.take(self.level, sum)?,
                Some(sum) => (sum_low, low) = (sum, approach),
                None => return Ok(self.lost()),
            }
        }
        Ok(Walk::Lost)
    }
}
