//! Coefficients of friction that fall with the slip velocity, and a layer between the bodies that yields. See [`friction::law`](crate::friction::law)
//! for the problem.

use crate::error::{not_negative, positive, require, Result};
use crate::powers::LARGEST;

/// How the falling parts f of a coefficient of friction depend on the slip velocity v. A coefficient has two falling parts, each with a half speed h.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fall {
    /// `max(0, 1 - v/(2 h))` for both parts.
    Linear,
    /// `1/(1 + v/h)` for the first part, `1/(1 + (v/h)^2)` for the second.
    Rational,
    /// `2^(-v/h)` for both parts.
    Exponential,
}

/// The wanted solution. There may be several solutions if the traction bounds fall with the slip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Branch {
    /// The solution near the initial guess, which takes the least time. If the iteration finds none and no force is prescribed, it starts again from
    /// an iterate of `Low`.
    #[default]
    Near,
    /// The solution of an iteration that starts from the traction bounds without slip.
    Low,
    /// The solution of an iteration that starts from the traction bounds of unlimited slip.
    High,
}

/// A coefficient of friction that depends on the slip velocity:
///
/// ```text
/// mu_s(v) = mu_0 (kinetic + falling_1 f_1(v) + falling_2 f_2(v))/(kinetic + falling_1 + falling_2)     mu_0: the coefficient at rest
/// mu      = t mu_v + (1 - t) mu_s(v),    t = c/(c + dt max(v, v0))      c: memory_distance, v0: memory_speed, mu_v: mu before the step
/// ```
///
/// dt is the duration of the step. f_1 and f_2 are those of [`Fall`]: the laws of CONTACT (L = 2, 3, 4). Polach's law is `Exponential` with
/// kinetic A, falling 1 - A and half speed ln 2/B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionLaw {
    /// How both falling parts depend on the slip velocity.
    pub fall: Fall,
    /// The part that remains at high slip velocity. Only the ratios of `kinetic` and `falling` matter.
    pub kinetic: f64,
    /// The two parts that fall.
    pub falling: [f64; 2],
    /// The slip velocity at which each falling part is a half of its value at rest.
    pub half_speed: [f64; 2],
    /// The speed of rolling. The duration of a step is the distance rolled divided by this speed.
    pub speed: f64,
    /// The duration of a shift.
    pub time_step: f64,
    /// c, the distance of slip over which mu approaches mu_s. 0: mu is mu_s at once.
    pub memory_distance: f64,
    /// v0: below this slip velocity mu approaches mu_s as fast as at v0.
    pub memory_speed: f64,
}

/// A plastic layer between the bodies: `|q| <= min(mu p, yield_limit + hardening * plastic slip)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlasticLayer {
    /// The yield limit of fresh material, a traction.
    pub yield_limit: f64,
    /// The change of the yield limit per plastic slip, a traction per length. Negative: the layer softens, down to a thousandth of `yield_limit`.
    pub hardening: f64,
}

impl FrictionLaw {
    /// A law with one falling part and no memory.
    pub const fn new(fall: Fall, (kinetic, falling): (f64, f64), half_speed: f64, speed: f64) -> FrictionLaw {
        let (falling, half_speed) = ([falling, 0.0], [half_speed, 1.0]);
        FrictionLaw {
            fall,
            kinetic,
            falling,
            half_speed,
            speed,
            time_step: 1.0,
            memory_distance: 0.0,
            memory_speed: 0.0,
        }
    }

    /// `mu_s(v)/mu_0` and its derivative by v.
    pub fn at(&self, v: f64) -> (f64, f64) {
        let (mut value, mut slope) = (self.kinetic, 0.0);
        for (k, (part, h)) in self.falling.into_iter().zip(self.half_speed).enumerate() {
            if part == 0.0 {
                continue;
            }
            let (f, derivative) = match (self.fall, k) {
                (Fall::Linear, _) if v < 2.0 * h => (1.0 - 0.5 * v / h, -0.5 / h),
                (Fall::Linear, _) => (0.0, 0.0),
                (Fall::Rational, 0) => (1.0 / (1.0 + v / h), -1.0 / h / (1.0 + v / h).powi(2)),
                (Fall::Rational, _) => {
                    let square = (v / h).powi(2);
                    (1.0 / (1.0 + square), -2.0 * v / (h * h) / (1.0 + square).powi(2))
                }
                (Fall::Exponential, _) => {
                    let f = (-v / h).exp2();
                    (f, -std::f64::consts::LN_2 * f / h)
                }
            };
            (value, slope) = (value + part * f, slope + part * derivative);
        }
        let at_rest = self.kinetic + self.falling[0] + self.falling[1];
        (value / at_rest, slope / at_rest)
    }

    /// Refuses invalid numbers. Of `time_step` and `speed` it checks only the one that determines the duration: `time_step` if the motion `is_shift`.
    pub(super) fn check(&self, is_shift: bool) -> Result<()> {
        not_negative("friction->kinetic", self.kinetic)?;
        for k in 0..2 {
            not_negative(["friction->falling[0]", "friction->falling[1]"][k], self.falling[k])?;
            if self.falling[k] > 0.0 {
                ordinary(["friction->half_speed[0]", "friction->half_speed[1]"][k], self.half_speed[k])?;
            }
        }
        positive("friction->kinetic + falling", self.kinetic + self.falling[0] + self.falling[1])?;
        match is_shift {
            true => ordinary("friction->time_step", self.time_step)?,
            false => ordinary("friction->speed", self.speed)?,
        }
        zero_or_ordinary("friction->memory_distance", self.memory_distance)?;
        zero_or_ordinary("friction->memory_speed", self.memory_speed)
    }
}

/// Refuses a number that is not positive, or so large or small that products with a few such numbers may be infinite or 0.
pub(super) fn ordinary(name: &str, value: f64) -> Result<()> {
    let rule = "it must be positive, from 1e-140 to 1e140: choose other units";
    require((1.0 / LARGEST..=LARGEST).contains(&value), name, value, rule)
}

/// As [`ordinary`], but allows 0.
pub(super) fn zero_or_ordinary(name: &str, value: f64) -> Result<()> {
    let rule = "it must be 0, or from 1e-140 to 1e140: choose other units";
    require(value == 0.0 || (1.0 / LARGEST..=LARGEST).contains(&value), name, value, rule)
}
