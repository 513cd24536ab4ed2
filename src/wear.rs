//! Wear: what friction does in each element, and how much material that takes off, from the tractions and slips of a solve.
//!
//! ```text
//! work  = -(q . s)                   frictional work of a step per area, an energy per area
//! depth = K/H work  or  K/H p |s|    Archard 1953: volume = K/H times load times distance slid
//! ```
//!
//! K is the wear coefficient (no unit), H the hardness (a pressure). Both forms are the same where the friction coefficient is the same
//! everywhere: then K of the first is K of the second over mu. Tractions are those on body 1 and slips those of body 1 over body 2, so that friction
//! has q against s.
//!
//! Where bodies roll in +x a point of a surface passes through a row of elements, and spends dx/dq steps in each: what it loses is `passage`.

use crate::effects::Coefficient;
use crate::error::{finite, not_negative, positive, Result};
use crate::grid::{check_values, Grid};
use crate::memory::{collected, zeros};
use crate::sums::in_blocks;

/// Names its memory in messages.
const FIELDS: &str = "the wear";

/// The tractions and slips, and how easily the surface wears.
#[derive(Clone, Copy, Debug)]
pub struct Wear<'a> {
    /// The elements.
    pub grid: Grid,
    /// q on body 1, in x and y, `[my][mx]` each: a force per area.
    pub traction: [&'a [f64]; 2],
    /// s of body 1 over body 2 in a step, in x and y: a length.
    pub slip: [&'a [f64]; 2],
    /// p: the depth is that of `p |s|`; none: that of the work.
    pub pressure: Option<&'a [f64]>,
    /// K.
    pub coefficient: Coefficient<'a>,
    /// H, a pressure; 1: `coefficient` is K/H.
    pub hardness: f64,
    /// How many steps work and depth are those of.
    pub steps: f64,
    /// dq, the length of a step that rolls along x; 0: nothing passes.
    pub rolling_distance: f64,
}

/// Work and wear of friction.
#[derive(Clone, Debug)]
pub struct Worn {
    /// Frictional work per area of each element.
    pub work: Vec<f64>,
    /// The depth of wear, a length.
    pub depth: Vec<f64>,
    /// The depth that a point of the surface loses while it passes through the contact once, of each row; empty without a rolling distance.
    pub passage: Vec<f64>,
    /// The work of all elements, an energy.
    pub total_work: f64,
    /// The material of all elements, a volume.
    pub volume: f64,
    /// The largest depth.
    pub largest: f64,
    /// Where that is: an element.
    pub at: usize,
}

impl Wear<'_> {
    fn check(&self) -> Result<()> {
        self.grid.check()?;
        let [qx, qy] = self.traction;
        let [sx, sy] = self.slip;
        let fields = [("traction[0]", qx), ("traction[1]", qy), ("slip[0]", sx), ("slip[1]", sy)];
        let own = match self.coefficient {
            Coefficient::Uniform(_) => None,
            Coefficient::PerElement(values) => Some(("coefficients", values)),
        };
        for (name, values) in fields.into_iter().chain(self.pressure.map(|p| ("pressure", p))).chain(own) {
            check_values(name, values, &self.grid, finite)?;
        }
        match self.coefficient {
            Coefficient::Uniform(value) => not_negative("coefficient", value)?,
            Coefficient::PerElement(values) => check_values("coefficients", values, &self.grid, not_negative)?,
        }
        positive("hardness", self.hardness)?;
        not_negative("steps", self.steps)?;
        not_negative("rolling_distance", self.rolling_distance)
    }

    /// Of a step at element i.
    fn work_at(&self, i: usize) -> f64 {
        -(self.traction[0][i] * self.slip[0][i] + self.traction[1][i] * self.slip[1][i])
    }

    /// Of a step at element i. An element that sticks has a work of either sign, of the size of the tolerance: nothing grows.
    fn depth_at(&self, i: usize) -> f64 {
        let by = match self.pressure {
            None => self.work_at(i).max(0.0),
            Some(p) => p[i].max(0.0) * self.slip[0][i].hypot(self.slip[1][i]),
        };
        self.coefficient.at(i) * by / self.hardness
    }
}

/// Frictional work and depth of wear of each element.
///
/// # Errors
/// `Invalid`, `NotFinite`: numbers out of their range, and arrays that have not one value per element. `OutOfMemory`.
pub fn frictional_wear(wear: &Wear<'_>) -> Result<Worn> {
    wear.check()?;
    let Wear { grid, steps, rolling_distance, .. } = *wear;
    let work = collected((0..grid.len()).map(|i| steps * wear.work_at(i)), FIELDS)?;
    let depth = collected((0..grid.len()).map(|i| steps * wear.depth_at(i)), FIELDS)?;
    let mut passage = zeros(if rolling_distance > 0.0 { grid.my } else { 0 }, FIELDS)?;
    for (iy, passage) in passage.iter_mut().enumerate() {
        *passage =
            in_blocks((iy * grid.mx..(iy + 1) * grid.mx).map(|i| wear.depth_at(i))) * (grid.dx / rolling_distance);
    }
    let (at, largest) =
        depth.iter().enumerate().fold((0, 0.0), |top, (i, depth)| if *depth > top.1 { (i, *depth) } else { top });
    let area = grid.element_area();
    let total_work = in_blocks(work.iter().copied()) * area;
    let volume = in_blocks(depth.iter().copied()) * area;
    Ok(Worn { work, depth, passage, total_work, volume, largest, at })
}
