//! Effect: friction. The tangential tractions q follow from the motion of the bodies or from the tangential forces, with `|q| <= g = mu p`.
//!
//! See [`friction`](crate::friction) for the problem that is solved. The normal problem is solved first. For like bodies friction does not change it.

use super::each::Each;
use super::friction_law::{Branch, FrictionLaw, PlasticLayer};
use super::tangential_influence::TangentialInfluence;
use crate::grid::Grid;

/// A coefficient of friction or of wear, or a compliance.
pub type Coefficient<'a> = Each<'a>;

/// Relative to the length rolled: a number of elements that differs from a whole number by no more than this counts as whole. The round-off of
/// `distance * cosine / dx` is below 1e-15: that of the angle (at most 2 pi), the cosine, the product and the quotient.
const ROUND_OFF: f64 = 1e-14;

/// How the bodies move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Motion {
    /// The bodies slide along the surface and turn about the normal, without rolling. Creepages are lengths, the spin is an angle.
    #[default]
    Shift,
    /// The bodies roll by one step, which begins with the previous tractions.
    TransientRolling,
    /// The bodies roll, and the tractions no longer change. Previous tractions are only an initial guess of the iteration.
    SteadyRolling,
}

/// The quantity that is prescribed in a direction, the creepage or the force. The solver finds the other one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prescribed {
    /// The creepage: for a shift a length, for rolling a length per length rolled.
    Creepage(f64),
    /// The force on body 1.
    Force(f64),
}

/// Where the tractions before this step come from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Previous<'a> {
    /// There are no tractions before the step.
    #[default]
    None,
    /// The caller gives the tractions in x and in y, `[my][mx]` each.
    Given([&'a [f64]; 2]),
    /// The tractions are those of this solver's last result.
    Kept,
}

/// Friction between the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction<'a> {
    /// The coefficient of friction mu.
    pub coefficient: Coefficient<'a>,
    /// How the bodies move.
    pub motion: Motion,
    /// The prescribed quantity in x and in y. The slip is that of body 1 over body 2: a negative creepage gives a positive force.
    pub prescribed: [Prescribed; 2],
    /// The spin phi about the normal: for a shift an angle, for rolling an angle per length rolled.
    pub spin: f64,
    /// The axis of the spin and of the moment, relative to the centre of the grid.
    pub spin_centre: [f64; 2],
    /// dq, the length rolled in the step; 0: dx.
    pub rolling_distance: f64,
    /// chi, the angle between the x axis and the direction of rolling.
    pub rolling_direction: f64,
    /// In rolling, the slip due to spin is that at a point ahead of the element's centre, by this part of the length rolled.
    pub spin_offset: f64,
    /// The tractions before the step.
    pub previous: Previous<'a>,
    /// The initial guess of the tractions in x and in y, `[my][mx]` each. The solution does not depend on them.
    pub initial: Option<[&'a [f64]; 2]>,
    /// An additional rigid slip in x and in y, `[my][mx]` each: lengths per step.
    pub rigid_slip: Option<[&'a [f64]; 2]>,
    /// Weights of the creepages in x and in y at each element, `[my][mx]` each. None: 1. Prescribed forces are sums of q with these weights.
    pub weights: Option<[&'a [f64]; 2]>,
    /// The compliance of a thin elastic layer between the bodies: the tangential displacement per traction.
    pub compliance: Coefficient<'a>,
    /// The caller's tangential influence coefficients. None: those of the bodies.
    pub influence: Option<TangentialInfluence<'a>>,
    /// Whether to compute the derivatives of the forces by the creepages and by the spin.
    pub sensitivities: bool,
    /// How the coefficient falls with the slip velocity. None: the coefficient is constant.
    pub law: Option<FrictionLaw>,
    /// A layer that yields. None: tractions are bounded by friction alone.
    pub layer: Option<PlasticLayer>,
    /// The coefficients of friction of the particles before the step (for a law with memory), `[my][mx]`. In rolling these are the particles that are
    /// at the elements before the step. None: the coefficients at rest.
    pub coefficients_before: Option<&'a [f64]>,
    /// The yield limits of the same particles, `[my][mx]`. None: the limit of fresh material.
    pub yield_limits: Option<&'a [f64]>,
    /// Which solution is wanted, if a law, or a layer that hardens or softens, allows several.
    pub branch: Branch,
}

impl Friction<'_> {
    /// The effect's name in a scene.
    pub const NAME: &'static str = "friction";

    /// Friction with a uniform coefficient, and a shift of 0.
    pub fn new(coefficient: f64) -> Friction<'static> {
        Friction {
            coefficient: Coefficient::Uniform(coefficient),
            motion: Motion::Shift,
            prescribed: [Prescribed::Creepage(0.0); 2],
            spin: 0.0,
            spin_centre: [0.0; 2],
            rolling_distance: 0.0,
            rolling_direction: 0.0,
            spin_offset: 1.0 / 6.0,
            previous: Previous::None,
            initial: None,
            rigid_slip: None,
            weights: None,
            compliance: Coefficient::Uniform(0.0),
            influence: None,
            sensitivities: false,
            law: None,
            layer: None,
            coefficients_before: None,
            yield_limits: None,
            branch: Branch::Near,
        }
    }

    /// The factor from creepages to slips: the length rolled in the step, or 1 for a shift, whose creepages are lengths.
    pub fn distance(&self, grid: &Grid) -> f64 {
        match self.motion {
            Motion::Shift => 1.0,
            _ if self.rolling_distance == 0.0 => grid.dx,
            _ => self.rolling_distance,
        }
    }

    /// The length of a step of rolling in x and in y, in elements. Numbers that are whole up to round-off are rounded, because steps of whole
    /// elements have simpler coefficients.
    pub fn elements_rolled(&self, grid: &Grid) -> (f64, f64) {
        let (distance, (sine, cosine)) = (self.distance(grid), self.rolling_direction.sin_cos());
        let rounded_if_whole = |value: f64| {
            if (value - value.round()).abs() <= ROUND_OFF * distance / grid.dx.min(grid.dy) {
                value.round()
            } else {
                value
            }
        };
        (rounded_if_whole(distance * cosine / grid.dx), rounded_if_whole(distance * sine / grid.dy))
    }

    /// The rigid slip of the step at element i, in x and in y, from the prescribed creepages, the spin and the additional rigid slip.
    pub fn rigid_slip_at(&self, grid: &Grid, i: usize) -> [f64; 2] {
        let distance = self.distance(grid);
        let centre =
            |k: usize, m: usize, d: f64, spin_centre: f64| (k as f64 - 0.5 * (m as f64 - 1.0)) * d - spin_centre;
        let mut x = centre(i % grid.mx, grid.mx, grid.dx, self.spin_centre[0]);
        let mut y = centre(i / grid.mx, grid.my, grid.dy, self.spin_centre[1]);
        if self.motion != Motion::Shift {
            let ahead = self.spin_offset * distance;
            x += ahead * self.rolling_direction.cos();
            y += ahead * self.rolling_direction.sin();
        }
        let creepage = self.prescribed.map(|prescribed| match prescribed {
            Prescribed::Creepage(creepage) => creepage,
            Prescribed::Force(_) => 0.0,
        });
        let additional = self.rigid_slip.map_or([0.0; 2], |[in_x, in_y]| [in_x[i], in_y[i]]);
        let weight = self.weight_at(i);
        let [xi, eta] = [weight[0] * creepage[0], weight[1] * creepage[1]];
        [distance * (xi - self.spin * y) + additional[0], distance * (eta + self.spin * x) + additional[1]]
    }

    /// Whether the force is prescribed in x, and in y.
    pub fn has_forces(&self) -> [bool; 2] {
        self.prescribed.map(|given| matches!(given, Prescribed::Force(_)))
    }

    /// The weights of both creepages at element i.
    pub fn weight_at(&self, i: usize) -> [f64; 2] {
        self.weights.map_or([1.0; 2], |[x, y]| [x[i], y[i]])
    }

    /// The derivative of the rigid slip at element i by the creepage xi (`creepage` is 0), the creepage eta (1) or the spin phi (2).
    pub fn rigid_slip_by(&self, grid: &Grid, i: usize, creepage: usize) -> [f64; 2] {
        let mut unit = Friction { prescribed: [Prescribed::Creepage(0.0); 2], spin: 0.0, rigid_slip: None, ..*self };
        match creepage {
            2 => unit.spin = 1.0,
            k => unit.prescribed[k] = Prescribed::Creepage(1.0),
        }
        unit.rigid_slip_at(grid, i)
    }
}
