//! The combined elastic constants of two bodies, as in Kalker's theory of rolling contact.

use crate::scene::Bodies;

/// The factors by which the materials enter the displacements of two half-spaces: `1/G`, `nu/G` and `K/G`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compliance {
    /// `1/G = (1/G1 + 1/G2)/2`.
    pub shear: f64,
    /// `nu/G = (nu1/G1 + nu2/G2)/2`.
    pub poisson: f64,
    /// `K/G = ((1 - 2 nu1)/G1 - (1 - 2 nu2)/G2)/4`, where K is the difference parameter. If K is 0, the bodies are alike, and their normal and
    /// tangential problems are independent.
    pub unlike: f64,
}

impl Compliance {
    /// Combines the elastic constants of two bodies.
    pub fn of(bodies: &Bodies) -> Compliance {
        let Bodies { shear_modulus: [g1, g2], poisson_ratio: [nu1, nu2] } = *bodies;
        Compliance {
            shear: 0.5 * (1.0 / g1 + 1.0 / g2),
            poisson: 0.5 * (nu1 / g1 + nu2 / g2),
            unlike: 0.25 * ((1.0 - 2.0 * nu1) / g1 - (1.0 - 2.0 * nu2) / g2),
        }
    }
}
