//! The elasticity of the two bodies.

use crate::error::{invalid, require, Error, Number, Result};

/// Shear modulus G and Poisson ratio nu of the two bodies. A body with `G = +infinity` is rigid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bodies {
    /// G of body 1 and of body 2, in the caller's unit of pressure.
    pub shear_modulus: [f64; 2],
    /// nu of body 1 and of body 2, in (-1, 0.5].
    pub poisson_ratio: [f64; 2],
}

impl Bodies {
    /// Two bodies of the same material.
    pub fn same(shear_modulus: f64, poisson_ratio: f64) -> Bodies {
        Bodies { shear_modulus: [shear_modulus; 2], poisson_ratio: [poisson_ratio; 2] }
    }

    /// `1/E* = sum over the bodies of (1 - nu)/(2 G)`, the compliance of two half-spaces in series (Johnson 1985, chapter 4). Each term is
    /// `(1 - nu^2)/E`, as `E = 2 G (1 + nu)`.
    pub fn compliance(&self) -> f64 {
        (0..2).map(|b| self.compliance_of(b)).sum()
    }

    /// `(1 - nu)/(2 G)` of body b.
    pub fn compliance_of(&self, b: usize) -> f64 {
        (1.0 - self.poisson_ratio[b]) / (2.0 * self.shear_modulus[b])
    }

    /// `(1 - 2 nu1)/G1 - (1 - 2 nu2)/G2`: four times K/G, Kalker's difference parameter over the shear modulus. If this is 0, the normal and the
    /// tangential problem of half-spaces are independent; the bodies are then called alike.
    pub fn unlike(&self) -> f64 {
        let term = |b: usize| (1.0 - 2.0 * self.poisson_ratio[b]) / self.shear_modulus[b];
        term(0) - term(1)
    }

    /// A message that names the first elastic constant in which these bodies differ from those of a set-up. None if all constants are equal.
    pub fn differs(&self, of_set_up: &Bodies) -> Option<String> {
        let constants = |bodies: &Bodies| {
            let ([g0, g1], [nu0, nu1]) = (bodies.shear_modulus, bodies.poisson_ratio);
            [("shear_modulus[0]", g0), ("shear_modulus[1]", g1), ("poisson_ratio[0]", nu0), ("poisson_ratio[1]", nu1)]
        };
        let pairs = constants(self).into_iter().zip(constants(of_set_up));
        let ((name, now), (_, at_set_up)) = pairs.into_iter().find(|((_, now), (_, at_set_up))| now != at_set_up)?;
        Some(format!("{name} is {now}; this solver was set up for {at_set_up}"))
    }

    /// Refuses invalid materials. Each body is checked alone, so both may be rigid.
    pub fn check_each(&self) -> Result<()> {
        for i in 0..2 {
            let (modulus, ratio) = (self.shear_modulus[i], self.poisson_ratio[i]);
            if modulus.is_nan() {
                return Err(Error::NotFinite(format!("shear_modulus[{i}] is {modulus}; it must be a number")));
            }
            if modulus <= 0.0 {
                return invalid(format!(
                    "shear_modulus[{i}] is {}; it must be positive, or +infinity for a rigid body",
                    Number(modulus)
                ));
            }
            let name = ["poisson_ratio[0]", "poisson_ratio[1]"][i];
            require(ratio > -1.0 && ratio <= 0.5, name, ratio, "it must lie in (-1, 0.5]")?;
        }
        Ok(())
    }

    /// Refuses invalid materials, two rigid bodies, and a compliance 1/E* outside the range of normal numbers.
    pub fn check(&self) -> Result<()> {
        self.check_each()?;
        if self.shear_modulus.iter().all(|modulus| modulus.is_infinite()) {
            return invalid("shear_modulus is infinite for both bodies; at least one of them must be elastic".into());
        }
        let compliance = self.compliance();
        if !(compliance.is_normal() && (1.0 / compliance).is_normal()) {
            let [one, other] = self.shear_modulus;
            return invalid(format!(
                "shear_modulus is {one:e} and {other:e}, so that 1/E* is {compliance:e}; it is out of range: choose other units"
            ));
        }
        Ok(())
    }
}
