//! Wear: the frictional work in each element and the depth of wear, from the tractions and slips of a solve.
//!
//! ```text
//! work  = -(q . s)                   frictional work of a step per area, an energy per area
//! depth = K/H work  or  K/H p |s|    Archard 1953: volume = K/H times load times distance slid
//! ```
//!
//! K is the wear coefficient (no unit), H the hardness (a pressure). For a uniform friction coefficient both forms are equivalent: K of the
//! first is K of the second over mu. Tractions act on body 1, slips are those of body 1 over body 2, so q is opposite to s.
//!
//! If bodies roll in +x, a point of a surface passes through a row of elements and spends dx/dq steps in each: its loss is `passage`.
//!
//! All products are of numbers near 1 and powers of two: a finite result is found for any factors, others are refused.

use crate::effects::Coefficient;
use crate::error::{finite, not_negative, positive, Error, Result};
use crate::grid::{check_values, Grid};
use crate::memory::{collected, zeros};
use crate::powers::Scaled;
use crate::sums::in_blocks;

/// The name of this memory in messages.
const FIELDS: &str = "the wear";

/// The tractions and slips, and the wear coefficients of the surface.
#[derive(Clone, Copy, Debug)]
pub struct Wear<'a> {
    /// The elements.
    pub grid: Grid,
    /// q on body 1, in x and y, `[my][mx]` each: a force per area.
    pub traction: [&'a [f64]; 2],
    /// s of body 1 over body 2 in a step, in x and y: a length.
    pub slip: [&'a [f64]; 2],
    /// p: the depth follows from `p |s|`; none: from the work.
    pub pressure: Option<&'a [f64]>,
    /// K.
    pub coefficient: Coefficient<'a>,
    /// H, a pressure; 1: `coefficient` is K/H.
    pub hardness: f64,
    /// The number of steps of work and depth.
    pub steps: f64,
    /// dq, the length of a step of rolling along x; 0: no passage.
    pub rolling_distance: f64,
}

/// Work and wear of friction.
#[derive(Clone, Debug)]
pub struct Worn {
    /// Frictional work per area of each element.
    pub work: Vec<f64>,
    /// The depth of wear, a length.
    pub depth: Vec<f64>,
    /// The depth lost by a point of the surface in one passage through the contact, for each row; empty without a rolling distance.
    pub passage: Vec<f64>,
    /// The work of all elements, an energy.
    pub total_work: f64,
    /// The material of all elements, a volume.
    pub volume: f64,
    /// The largest depth.
    pub largest: f64,
    /// The element of the largest depth.
    pub at: usize,
}

impl Wear<'_> {
    fn check(&self) -> Result<()> {
        self.grid.check()?;
        let [qx, qy] = self.traction;
        let [sx, sy] = self.slip;
        let fields = [("traction[0]", qx), ("traction[1]", qy), ("slip[0]", sx), ("slip[1]", sy)];
        let own = self.coefficient.per_element().map(|values| ("coefficients", values));
        for (name, values) in fields.into_iter().chain(self.pressure.map(|p| ("pressure", p))).chain(own) {
            check_values(name, values, &self.grid, finite)?;
        }
        self.coefficient.check(["coefficient", "coefficients"], &self.grid, not_negative)?;
        positive("hardness", self.hardness)?;
        not_negative("steps", self.steps)?;
        not_negative("rolling_distance", self.rolling_distance)
    }

    /// The work of a step at element i.
    fn work_at(&self, i: usize) -> Scaled {
        let [x, y] = [0, 1].map(|k| Scaled::of(self.traction[k][i]).times(Scaled::of(self.slip[k][i])));
        x.with(y, |x, y| -(x + y))
    }

    /// The depth of a step at element i, not negative: on stick the work has either sign and the size of the tolerance.
    fn depth_at(&self, i: usize) -> Scaled {
        let by = match self.pressure {
            None => self.work_at(i),
            Some(p) => {
                let [x, y] = self.slip.map(|s| Scaled::of(s[i]));
                Scaled::of(p[i]).times(x.with(y, f64::hypot))
            }
        };
        let by = Scaled(by.0.max(0.0), by.1);
        Scaled::of(self.coefficient.at(i)).times(by).over(Scaled::of(self.hardness))
    }
}

/// The sum, relative to the largest term.
fn sum(terms: impl Iterator<Item = Scaled> + Clone) -> Scaled {
    let power = terms.clone().filter(|term| term.0 != 0.0).map(|term| term.1).max().unwrap_or(0);
    Scaled(in_blocks(terms.map(|term| term.at(power))), power)
}

/// Refuses values that are not finite, by their name.
fn numbers<'a>(name: &str, values: impl IntoIterator<Item = &'a f64>) -> Result<()> {
    match values.into_iter().find(|value| !value.is_finite()) {
        Some(value) => {
            Err(Error::NotFinite(format!("{name} is {value}: what is given takes it out of the range of numbers")))
        }
        None => Ok(()),
    }
}

/// Frictional work and depth of wear of each element.
///
/// # Errors
/// `InvalidArgument`, `NotFinite`: numbers out of their range, results that overflow, and arrays without one value per element.
/// `OutOfMemory`.
pub fn frictional_wear(wear: &Wear<'_>) -> Result<Worn> {
    wear.check()?;
    let Wear { grid, rolling_distance, .. } = *wear;
    let [dx, dy, steps] = [grid.dx, grid.dy, wear.steps].map(Scaled::of);
    let all = 0..grid.len();
    let work = collected(all.clone().map(|i| steps.times(wear.work_at(i)).value()), FIELDS)?;
    numbers("the work of an element", &work)?;
    let depth = collected(all.clone().map(|i| steps.times(wear.depth_at(i)).value()), FIELDS)?;
    let mut passage = zeros(if rolling_distance > 0.0 { grid.my } else { 0 }, FIELDS)?;
    for (iy, passage) in passage.iter_mut().enumerate() {
        let row = iy * grid.mx..(iy + 1) * grid.mx;
        *passage = sum(row.map(|i| wear.depth_at(i))).times(dx).over(Scaled::of(rolling_distance)).value();
    }
    numbers("the depth of a passage", &passage)?;
    numbers("the depth of an element", &depth)?;
    let whole = |of_step: Scaled| of_step.times(steps).times(dx).times(dy).value();
    let total_work = whole(sum(all.clone().map(|i| wear.work_at(i))));
    let volume = whole(sum(all.map(|i| wear.depth_at(i))));
    numbers("the work of all elements", [&total_work])?;
    numbers("the volume of all elements", [&volume])?;
    let (at, largest) =
        depth.iter().enumerate().fold((0, 0.0), |top, (i, depth)| if *depth > top.1 { (i, *depth) } else { top });
    Ok(Worn { work, depth, passage, total_work, volume, largest, at })
}
