//! The bodies and the values of all effects of a set-up: an owned record, compared with later scenes.
//!
//! Numbers are kept. Tables are shared with the coefficients, without additional memory, and compared value by value unless they are the same object.
//! Arrays of one value per element are kept as their length and a hash of 128 bits. Each word enters by one-to-one steps (exclusive or, a product by
//! an odd number, a rotation): arrays that differ in one value always have different hashes. Other different arrays have equal hashes in one case of
//! 2^128. A comparison without difference allocates nothing.

use std::sync::Arc;

use super::effect::{Effect, Value};
use super::together::{effects, list, refuse_together, replace_bodies, COUNT};
use crate::error::{self, invalid, Error, Result};
use crate::memory::Held;
use crate::scene::{Bodies, Scene};

/// The advice for other coefficients.
pub const SET_THEM: &str =
    "leave them out, or set them first (influence and tangential tables: contact_normal_solver_set_influence)";

/// The record of a value.
#[derive(Clone, Debug, PartialEq)]
enum Kept {
    Number(f64),
    Hash(usize, [u64; 2]),
    Shared(Arc<Held>),
}

impl Kept {
    fn new(value: Value<'_>) -> Kept {
        match value {
            Value::Number(number) => Kept::Number(number),
            // Adding 0 turns -0 into 0.
            Value::Array(values) => Kept::Hash(values.len(), hash(values.iter().map(|value| (value + 0.0).to_bits()))),
            Value::Integers(values) => Kept::Hash(values.len(), hash(values.iter().map(|value| *value as u64))),
            Value::Shared(values) => Kept::Shared(values.clone()),
        }
    }

    fn is(&self, value: Value<'_>) -> bool {
        match (self, value) {
            (Kept::Shared(kept), Value::Shared(values)) if Arc::ptr_eq(kept, values) => true,
            _ => *self == Kept::new(value),
        }
    }
}

/// Odd numbers without pattern: the fractions of the golden ratio and of the square root of 3.
const FIRST: u64 = 0x9e37_79b9_7f4a_7c15;
const SECOND: u64 = 0xbb67_ae85_84ca_a73b;

fn hash(words: impl Iterator<Item = u64>) -> [u64; 2] {
    words.fold([FIRST, SECOND], |[a, b], word| {
        [
            (a ^ word).wrapping_mul(FIRST).rotate_left(29),
            (b.rotate_left(17) ^ word).wrapping_mul(SECOND).rotate_left(31),
        ]
    })
}

/// The scene of a set-up, without its grid.
#[derive(Clone, Debug)]
pub struct Named {
    /// The bodies. None if the caller's coefficients replace them.
    bodies: Option<Bodies>,
    effects: [Option<&'static str>; COUNT],
    values: Vec<(&'static str, Kept)>,
}

impl Named {
    /// The record of a set-up's scene.
    pub fn new(scene: &Scene<'_>) -> Named {
        let mut values = Vec::new();
        effects(scene).for_each(|effect| effect.values(&mut |name, value| values.push((name, Kept::new(value)))));
        let bodies = (!replace_bodies(scene)).then_some(scene.bodies);
        Named { bodies, effects: list(scene).map(name_of_set_up), values }
    }

    /// Replaces the values of an effect of the set-up.
    pub fn replace(&mut self, effect: &dyn Effect) {
        effect.values(&mut |name, value| {
            self.values.retain(|(known, _)| *known != name);
            self.values.push((name, Kept::new(value)));
        });
    }

    /// Refuses a scene that differs from the set-up's.
    pub fn check(&self, scene: &Scene<'_>) -> Result<()> {
        if let Some(bodies) = self.bodies.filter(|bodies| !replace_bodies(scene) && *bodies != scene.bodies) {
            return scene.bodies.differs(&bodies).map_or(Ok(()), invalid);
        }
        for pair in self.effects.into_iter().zip(list(scene).map(name_of_set_up)) {
            match pair {
                (None, Some(name)) => return invalid(format!("{name} is given, but this solver was set up without")),
                (Some(name), None) if !self.is_table(name) => {
                    return invalid(format!("{name} is not given, but this solver was set up with it"));
                }
                _ => {}
            }
        }
        // Values of effects that this scene does not name are compared below.
        for effect in effects(scene) {
            let name = effect.name();
            let left_out = |other: &str| self.effects.iter().flatten().any(|effect| *effect == other);
            refuse_together(effect, left_out, |other| format!("{name} is given, and this solver has {other}"))?;
        }
        let mut same = Ok(());
        for effect in effects(scene) {
            effect.values(&mut |name, value| {
                if same.is_ok() {
                    same = self.check_value(name, value);
                }
            });
        }
        same
    }

    /// Whether an effect is a table, which later scenes need not name again.
    fn is_table(&self, effect: &str) -> bool {
        let is_of = |name: &str| name.strip_prefix(effect).is_some_and(|rest| rest.starts_with("->"));
        self.values.iter().any(|(name, kept)| is_of(name) && matches!(kept, Kept::Shared(_)))
    }

    fn check_value(&self, name: &'static str, value: Value<'_>) -> Result<()> {
        let kept = self.values.iter().find(|(known, _)| *known == name).map(|(_, kept)| kept);
        match (kept, value) {
            (Some(kept), value) if kept.is(value) => Ok(()),
            (Some(Kept::Number(kept)), Value::Number(number)) => invalid(format!(
                "{name} is {}; this solver was set up with {}",
                error::Number(number),
                error::Number(*kept)
            )),
            // Even tables are kept in a smaller array.
            (Some(Kept::Shared(kept)), Value::Shared(values)) if kept.len() == values.len() => {
                let other = kept.iter().zip(values.iter()).find(|(kept, now)| kept != now);
                let (kept, now) = other.unwrap_or((&f64::NAN, &f64::NAN));
                Err(Error::InfluenceChanged(format!(
                    "{name} holds other coefficients: {now} where those of this solver have {kept}; {SET_THEM}"
                )))
            }
            (Some(Kept::Shared(_)), _) => Err(Error::InfluenceChanged(format!(
                "{name} holds other coefficients than this solver has; {SET_THEM}"
            ))),
            (Some(_), _) => invalid(format!("{name} has other values than this solver was set up with")),
            (None, _) => invalid(format!("{name} is given, but this solver was set up without")),
        }
    }
}

/// The name of an effect that a set-up depends on.
fn name_of_set_up(effect: Option<&dyn Effect>) -> Option<&'static str> {
    let mut matters = false;
    effect?.values(&mut |_, _| matters = true);
    effect.filter(|_| matters).map(Effect::name)
}
