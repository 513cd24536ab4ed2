//! Effect: adhesion. The surfaces attract each other with sigma(e), a stress that falls with the distance e: `p = q - sigma(e)`, with contact
//! pressures `q >= 0`.
//!
//! See [`adhesion`](crate::adhesion) for the problem that is solved.

use std::ops::Range;

use super::each::Each;
use super::effect::{Effect, Value};
use super::properties::{Properties, Stresses};
use crate::adhesion::{Law, Start};
use crate::error::{not_negative, require, Error, Number, Result};
use crate::grid::Grid;
use crate::powers::LARGEST;
use crate::scene::{Load, Plain};

/// The values that a work of adhesion and a range may have. Their squares, and quotients of these squares, are finite.
const ALLOWED: Range<f64> = 1e-70..1e70;
/// The smallest `smear` of Dugdale's law, as a part of the range. No grid resolves less.
const LEAST_SMEAR: f64 = 1e-6;

/// The work of adhesion w: an energy per area.
pub type Work<'a> = Each<'a>;

/// Attraction between the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adhesion<'a> {
    /// How the attraction falls with the distance.
    pub law: Law,
    /// The work of adhesion, >= 0.
    pub work: Work<'a>,
    /// The range rho of the attraction, a length. 0: the shortest range that the elements resolve.
    pub range: f64,
    /// Where a solve without a previous state begins. It matters if several states belong to one approach.
    pub start: Start,
    /// Whether to compute the stiffness dF/dapproach.
    pub stiffness: bool,
    /// Whether to compute the stability margin 1 - lambda: 1 without attraction, 0 where the bodies snap (module `adhesion::stability`).
    pub stability: bool,
    /// The shear strength tau0 >= 0 of the adhesive contact, a traction. With friction, tractions in contact are at most `mu q + tau0`, where q is
    /// the contact pressure.
    pub shear_strength: f64,
}

impl Adhesion<'_> {
    /// Whether the surfaces attract each other: the work of adhesion is not 0 on all elements.
    pub fn attracts(&self) -> bool {
        !self.work.is_zero()
    }
}

impl Effect for Adhesion<'_> {
    fn name(&self) -> &'static str {
        "adhesion"
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &["row_tables", "pressure_limit"],
            without_multigrid: Some("adhesion"),
            with_given_area: false,
            one_grid: (self.range == 0.0)
                .then_some("the range 0 is the shortest that the elements of one grid carry: name a range"),
            own_coefficients: None,
            repeats: (false, false),
            limits: None,
            is_beside: false,
            continues: None,
        }
    }

    // A scene has the effect also if its values are invalid, so that the scene refuses them.
    fn is_one(&self, scene: &Plain<'_>) -> bool {
        self.attracts() || self.check(&scene.grid).is_err()
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        let require_work = |name: &str, work: f64| {
            not_negative(name, work)?;
            let is_work = work == 0.0 || ALLOWED.contains(&work);
            require(is_work, name, work, "it must be 0 or lie in 1e-70..1e70: choose other units")
        };
        self.work.check(["adhesion->work_of_adhesion", "adhesion->works_of_adhesion"], grid, require_work)?;
        let is_range = self.range == 0.0 || ALLOWED.contains(&self.range);
        require(
            is_range,
            "adhesion->range",
            self.range,
            "it must be 0, for the shortest that the elements carry, or lie in 1e-70..1e70",
        )?;
        let strength = self.shear_strength;
        let rule = "a shear strength must be 0 or more, and below 1e140";
        require((0.0..LARGEST).contains(&strength), "adhesion->shear_strength", strength, rule)?;
        if let Law::Dugdale(smear) = self.law {
            let rule = "the part of the range over which the edge is smeared must lie in [1e-6, 1]";
            require((LEAST_SMEAR..=1.0).contains(&smear), "adhesion->smear", smear, rule)?;
        }
        Ok(())
    }

    fn check_load(&self, scene: &Plain<'_>, others: &[Option<&dyn Effect>]) -> Result<()> {
        self.check(&scene.grid)?;
        let repeats = others.iter().flatten().any(|other| other.properties().repeats == (true, true));
        if repeats && scene.grid.len() == 1 {
            let message = "adhesion is given on a grid of one element with two periods, which displaces nothing; this version does not solve that";
            return Err(Error::Unsupported(message.into()));
        }
        if let (Load::Force(force), true) = (scene.load, scene.undeformed_distance.iter().all(|h| h.is_infinite())) {
            if force < 0.0 {
                return Err(Error::Infeasible(format!(
                    "force is {}, but undeformed_distance is infinite on every element: nothing can carry it",
                    Number(force)
                )));
            }
        }
        Ok(())
    }

    // The set-up of a solver does not depend on adhesion, which may differ in each solve.
    fn values(&self, _tell: &mut dyn FnMut(&'static str, Value<'_>)) {}

    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        false
    }

    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        Stresses::Same
    }
}
