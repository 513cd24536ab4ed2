//! Effect: friction, `|q| <= g = mu p`: tangential tractions from the motion of the bodies, or from the tangential forces.
//!
//! See [`friction`](crate::friction) for the problem that is solved. For like bodies the normal problem is the same with and without friction. It is
//! solved first.

use super::each::Each;
use super::friction_law::{Branch, FrictionLaw, PlasticLayer};
use super::tangential_influence::TangentialInfluence;
use crate::grid::Grid;

/// A coefficient of friction or of wear, or a compliance.
pub type Coefficient<'a> = Each<'a>;

/// Relative round-off of `distance * cosine / dx`: below 1e-15 from the angle (at most 2 pi), cosine, product and quotient; ten times that.
const ROUND_OFF: f64 = 1e-14;

/// How the bodies move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Motion {
    /// Sideways and about the normal, without rolling; creepages are lengths, spin is an angle.
    #[default]
    Shift,
    /// A step of rolling, from the previous tractions.
    TransientRolling,
    /// Rolling whose tractions no longer change. Given or kept tractions only start the iteration.
    SteadyRolling,
}

/// The quantity that is prescribed in a direction; the other one is found.
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
    /// There are none: from rest.
    #[default]
    None,
    /// Tractions in x and y, `[my][mx]` each.
    Given([&'a [f64]; 2]),
    /// The last result of this solver.
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
    /// chi, the angle of rolling from the x axis.
    pub rolling_direction: f64,
    /// The slip by spin is taken ahead of each element's centre by this part of the length rolled.
    pub spin_offset: f64,
    /// The tractions before the step.
    pub previous: Previous<'a>,
    /// Tractions in x and y to start the iteration from, `[my][mx]` each; the solution does not depend on them.
    pub initial: Option<[&'a [f64]; 2]>,
    /// An additional rigid slip, lengths per step, x and y.
    pub rigid_slip: Option<[&'a [f64]; 2]>,
    /// Weights of the creepages in x and in y at each element, `[my][mx]` each; none: 1. Prescribed forces are sums of q with these weights.
    pub weights: Option<[&'a [f64]; 2]>,
    /// The compliance of a thin elastic layer between the bodies: its displacement per traction.
    pub compliance: Coefficient<'a>,
    /// The caller's tangential coefficients; none: those of the bodies.
    pub influence: Option<TangentialInfluence<'a>>,
    /// Whether the derivatives of the forces by the creepages and the spin are computed.
    pub sensitivities: bool,
    /// How the coefficient falls with the slip velocity; none: it is constant.
    pub law: Option<FrictionLaw>,
    /// A layer that yields; none: tractions are bounded by friction alone.
    pub layer: Option<PlasticLayer>,
    /// Coefficients of the particles before the step (law with memory), `[my][mx]`, in rolling at their places before it; none: those at rest.
    pub coefficients_before: Option<&'a [f64]>,
    /// Yield limits of the particles before the step; none: those of fresh material.
    pub yield_limits: Option<&'a [f64]>,
    /// Which of several solutions, with a law or a layer that hardens or softens.
    pub branch: Branch,
}

impl Friction<'_> {
    /// The effect's name in a scene.
    pub const NAME: &'static str = "friction";

    /// Friction with this coefficient and no motion.
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

    /// The length rolled in a step; for a shift 1, so that creepages are lengths.
    pub fn distance(&self, grid: &Grid) -> f64 {
        match self.motion {
            Motion::Shift => 1.0,
            _ if self.rolling_distance == 0.0 => grid.dx,
            _ => self.rolling_distance,
        }
    }

    /// The elements that a step of rolling covers in x and in y. Numbers that are whole up to round-off are rounded,
    /// because coefficients are simpler there.
    pub fn elements_rolled(&self, grid: &Grid) -> (f64, f64) {
        let (distance, (sine, cosine)) = (self.distance(grid), self.rolling_direction.sin_cos());
        let clean = |value: f64| {
            if (value - value.round()).abs() <= ROUND_OFF * distance / grid.dx.min(grid.dy) {
                value.round()
            } else {
                value
            }
        };
        (clean(distance * cosine / grid.dx), clean(distance * sine / grid.dy))
    }

    /// The rigid slip of the step at element i, without unknown creepages.
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
        let own = self.rigid_slip.map_or([0.0; 2], |own| [own[0][i], own[1][i]]);
        let weight = self.weight_at(i);
        let creepage = [weight[0] * creepage[0], weight[1] * creepage[1]];
        [distance * (creepage[0] - self.spin * y) + own[0], distance * (creepage[1] + self.spin * x) + own[1]]
    }

    /// Whether the force is given in x, and in y.
    pub fn has_forces(&self) -> [bool; 2] {
        self.prescribed.map(|given| matches!(given, Prescribed::Force(_)))
    }

    /// The weights of the creepages at element i.
    pub fn weight_at(&self, i: usize) -> [f64; 2] {
        self.weights.map_or([1.0; 2], |[x, y]| [x[i], y[i]])
    }

    /// The derivative of the rigid slip at element i by xi (0), eta (1) or phi (2).
    pub fn rigid_slip_by(&self, grid: &Grid, i: usize, creepage: usize) -> [f64; 2] {
        let mut unit = Friction { prescribed: [Prescribed::Creepage(0.0); 2], spin: 0.0, rigid_slip: None, ..*self };
        match creepage {
            2 => unit.spin = 1.0,
            k => unit.prescribed[k] = Prescribed::Creepage(1.0),
        }
        unit.rigid_slip_at(grid, i)
    }
}
