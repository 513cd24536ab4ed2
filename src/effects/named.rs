//! A record of the bodies and of all effects with which a solver was set up. The solver compares later scenes with this record and refuses scenes
//! that differ.
//!
//! The record holds numbers by value. It shares the tables of coefficients with the solver, without additional memory; tables that are not the same
//! object are compared value by value. Of an array the record holds the length and a hash of 128 bits. Each word enters the hash by one-to-one steps
//! (exclusive or, a product by an odd number, a rotation). So two arrays that differ in one value always have different hashes. Two other different
//! arrays have equal hashes in one case of 2^128. A comparison that finds no difference allocates nothing.

use std::sync::Arc;

use super::effect::{Effect, Value};
use super::together::{effects, list, refuse_together, replace_bodies, COUNT};
use crate::error::{self, invalid, Error, Result};
use crate::memory::Held;
use crate::scene::{Bodies, Scene};

/// The advice in messages about coefficients other than the solver's.
pub const SET_THEM: &str =
    "leave them out, or set them first (influence and tangential tables: contact_normal_solver_set_influence)";

/// The record of a [`Value`].
#[derive(Clone, Debug, PartialEq)]
enum Kept {
    Number(f64),
    /// The length and the hash of an array.
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

    /// Whether `value` equals the recorded one.
    fn equals(&self, value: Value<'_>) -> bool {
        match (self, value) {
            (Kept::Shared(kept), Value::Shared(values)) if Arc::ptr_eq(kept, values) => true,
            _ => *self == Kept::new(value),
        }
    }
}

/// Two odd numbers whose bits have no pattern: the first 64 bits of the fractions of the golden ratio and of the square root of 3.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
const ROOT_OF_3: u64 = 0xbb67_ae85_84ca_a73b;

/// A hash of 128 bits: two hashes of 64 bits with different factors and rotations.
fn hash(words: impl Iterator<Item = u64>) -> [u64; 2] {
    words.fold([GOLDEN, ROOT_OF_3], |[a, b], word| {
        [
            (a ^ word).wrapping_mul(GOLDEN).rotate_left(29),
            (b.rotate_left(17) ^ word).wrapping_mul(ROOT_OF_3).rotate_left(31),
        ]
    })
}

/// A record of the scene with which a solver was set up, without the grid.
#[derive(Clone, Debug)]
pub struct Named {
    /// The bodies. None if the caller's coefficients replace them.
    bodies: Option<Bodies>,
    /// The names of the effects on which the set-up depends, at their places in the list.
    effects: [Option<&'static str>; COUNT],
    /// The name and the record of each value of these effects.
    values: Vec<(&'static str, Kept)>,
}

impl Named {
    /// Records the scene with which a solver is set up.
    pub fn new(scene: &Scene<'_>) -> Named {
        let mut values = Vec::new();
        effects(scene).for_each(|effect| effect.values(&mut |name, value| values.push((name, Kept::new(value)))));
        let bodies = (!replace_bodies(scene)).then_some(scene.bodies);
        Named { bodies, effects: list(scene).map(name_of_set_up), values }
    }

    /// Replaces the recorded values of an effect.
    pub fn replace(&mut self, effect: &dyn Effect) {
        effect.values(&mut |name, value| {
            self.values.retain(|(known, _)| *known != name);
            self.values.push((name, Kept::new(value)));
        });
    }

    /// Refuses a scene that differs from the recorded one.
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
        // The recorded effects include tables that `scene` leaves out: effects of `scene` may exclude these as well.
        for effect in effects(scene) {
            let name = effect.name();
            let is_recorded = |other: &str| self.effects.iter().flatten().any(|effect| *effect == other);
            refuse_together(effect, is_recorded, |other| format!("{name} is given, and this solver has {other}"))?;
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

    /// Whether an effect is a table of influence coefficients, which later scenes may leave out.
    fn is_table(&self, effect: &str) -> bool {
        let is_of = |name: &str| name.strip_prefix(effect).is_some_and(|rest| rest.starts_with("->"));
        self.values.iter().any(|(name, kept)| is_of(name) && matches!(kept, Kept::Shared(_)))
    }

    /// Refuses a value that differs from the recorded value of the same name.
    fn check_value(&self, name: &'static str, value: Value<'_>) -> Result<()> {
        let kept = self.values.iter().find(|(known, _)| *known == name).map(|(_, kept)| kept);
        match (kept, value) {
            (Some(kept), value) if kept.equals(value) => Ok(()),
            (Some(Kept::Number(kept)), Value::Number(number)) => invalid(format!(
                "{name} is {}; this solver was set up with {}",
                error::Number(number),
                error::Number(*kept)
            )),
            // A table that is even in both directions has fewer values: tables of different symmetry differ in length.
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

/// The name of an effect if a set-up depends on it.
fn name_of_set_up(effect: Option<&dyn Effect>) -> Option<&'static str> {
    let mut matters = false;
    effect?.values(&mut |_, _| matters = true);
    effect.filter(|_| matters).map(Effect::name)
}
