//! The tangential part of a scene with friction: motion, creepages or forces, and previous tractions.

use contact_normal::ffi::*;

use crate::grid::Grid;
use crate::own_tractions::{Kind, STEP};
use crate::random::Random;

/// The friction of a scene.
#[derive(Clone, Debug)]
pub struct Slide {
    /// The friction coefficients of the elements.
    pub mu: Vec<f64>,
    /// Whether the coefficient is given to the library as one number.
    pub uniform: bool,
    /// Shift, transient rolling or steady rolling.
    pub motion: i32,
    /// Whether the creepage or the force is prescribed, in x and in y.
    pub prescribed: [i32; 2],
    /// The prescribed creepages or forces.
    pub amount: [f64; 2],
    pub spin: f64,
    pub spin_centre: [f64; 2],
    /// The rolling distance of a step; 0 stands for dx.
    pub distance: f64,
    /// The rolling direction, as an angle.
    pub direction: f64,
    /// The tractions before the step, in x and y. None: there are none.
    pub previous: Option<[Vec<f64>; 2]>,
    /// The rigid slip of each element that is added to that by creepages and spin, in x and y.
    pub rigid: Option<[Vec<f64>; 2]>,
    /// Whether the library computes the derivatives of the forces.
    pub sensitivities: bool,
}

impl Slide {
    /// Steady rolling without creepages, in the rolling direction of these tables.
    pub fn nothing(kind: &Kind, n: usize) -> Slide {
        Slide {
            direction: kind.direction(),
            mu: vec![0.3; n],
            uniform: true,
            motion: CONTACT_NORMAL_MOTION_STEADY_ROLLING,
            prescribed: [CONTACT_NORMAL_PRESCRIBED_CREEPAGE; 2],
            amount: [0.0; 2],
            spin: 0.0,
            spin_centre: [0.0; 2],
            distance: 0.0,
            previous: None,
            rigid: None,
            sensitivities: false,
        }
    }

    /// Changes the motion to one that the tables allow: steps of whole elements along x, for uneven tables in their rolling direction.
    pub fn fit(&mut self, kind: &Kind, random: &mut Random, grid: &Grid) {
        self.direction = random.pick(&[0.0, std::f64::consts::PI]);
        if matches!(kind, Kind::Uneven { .. }) {
            (self.motion, self.direction) = (CONTACT_NORMAL_MOTION_STEADY_ROLLING, kind.direction());
        }
        self.distance = random.integer(1, STEP) as f64 * grid.dx;
    }

    /// Whether a force is given in x or in y.
    pub fn has_forces(&self) -> bool {
        self.is_force(0) || self.is_force(1)
    }

    /// Whether the force is given in direction k.
    pub fn is_force(&self, k: usize) -> bool {
        self.prescribed[k] == CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE
    }

    /// The length of the vector of given forces; 0 if no force is given.
    pub fn force(&self) -> f64 {
        let [x, y] = [0, 1].map(|k| if self.is_force(k) { self.amount[k] } else { 0.0 });
        x.hypot(y)
    }

    /// The rolling distance of a step; 1 for a shift, whose creepages are lengths.
    pub fn length(&self, grid: &Grid) -> f64 {
        match self.motion {
            CONTACT_NORMAL_MOTION_SHIFT => 1.0,
            _ if self.distance == 0.0 => grid.dx,
            _ => self.distance,
        }
    }

    /// The position of a particle before the step, relative to that after it; 0 for a shift.
    pub fn step(&self, grid: &Grid) -> [f64; 2] {
        if self.motion == CONTACT_NORMAL_MOTION_SHIFT {
            return [0.0; 2];
        }
        let (sine, cosine) = self.direction.sin_cos();
        let without_rounding = |value: f64| if value.abs() < 1e-15 { 0.0 } else { value };
        [self.length(grid) * without_rounding(cosine), self.length(grid) * without_rounding(sine)]
    }

    /// The rigid slip of element i for these creepages. Also returns the sum of the absolute values of its terms, which is the scale of its
    /// round-off.
    pub fn rigid_slip(&self, grid: &Grid, i: usize, creepage: [f64; 2]) -> ([f64; 2], f64) {
        let (step, length) = (self.step(grid), self.length(grid));
        let centre = |k: usize, m: usize, d: f64| (k as f64 - 0.5 * (m as f64 - 1.0)) * d;
        let x = centre(i % grid.mx, grid.mx, grid.dx) - self.spin_centre[0] + step[0] / 6.0;
        let y = centre(i / grid.mx, grid.my, grid.dy) - self.spin_centre[1] + step[1] / 6.0;
        let [wx, wy] = self.rigid.as_ref().map_or([0.0; 2], |rigid| [rigid[0][i], rigid[1][i]]);
        let arms = self.spin_centre[0].abs() + self.spin_centre[1].abs() + x.abs() + y.abs();
        let sizes = length * (creepage[0].abs() + creepage[1].abs() + self.spin.abs() * arms);
        let w = [length * (creepage[0] - self.spin * y) + wx, length * (creepage[1] + self.spin * x) + wy];
        (w, sizes + wx.abs() + wy.abs())
    }

    /// The tractions before the step.
    pub fn before(&self) -> Vec<[f64; 2]> {
        let at = |i: usize| self.previous.as_ref().map_or([0.0; 2], |before| [before[0][i], before[1][i]]);
        (0..self.mu.len()).map(at).collect()
    }
}
