//! Wear: frictional work and depth of wear of each element, from the tractions and slips of a solve.
//!
//! ```text
//! work  = -(q . s)                   frictional work of a step per area, an energy per area
//! depth = K/H work  or  K/H p |s|    Archard 1953: volume = K/H times load times distance slid
//! ```
//!
//! K is the wear coefficient (no unit), H the hardness (a pressure). For a uniform friction coefficient mu both forms of the depth are equivalent, if
//! K of the first is K of the second over mu. Tractions act on body 1, and slips are those of body 1 over body 2, so q is opposite to s.
//!
//! If bodies roll in +x, a point of a surface passes through a row of elements, and stays in each element for dx/dq steps, where dq is the length of
//! a step. The depth that the point loses in one passage is `passage`.
//!
//! Products are computed with numbers near 1 and powers of two (module `powers`): if the result is finite, so are all intermediate results. Results
//! that overflow are refused.

use crate::effects::Coefficient;
use crate::error::{finite, not_negative, positive, Error, Result};
use crate::grid::{check_values, Grid};
use crate::memory::{collected, zeros};
use crate::powers::Scaled;
use crate::sums::in_blocks;

/// The name of these arrays in messages.
const FIELDS: &str = "the wear";

/// The inputs of a computation of wear.
#[derive(Clone, Copy, Debug)]
pub struct Wear<'a> {
    /// The grid of all arrays.
    pub grid: Grid,
    /// The tractions q on body 1, in x and in y, `[my][mx]` each: a force per area.
    pub traction: [&'a [f64]; 2],
    /// The slips s of body 1 over body 2 in a step, in x and in y, `[my][mx]` each: a length.
    pub slip: [&'a [f64]; 2],
    /// The pressures p, `[my][mx]`. If given, the depth follows from `p |s|`, else from the work.
    pub pressure: Option<&'a [f64]>,
    /// The wear coefficient K.
    pub coefficient: Coefficient<'a>,
    /// The hardness H, a pressure. With 1, `coefficient` is K/H.
    pub hardness: f64,
    /// The number of equal steps that work and depth are summed over.
    pub steps: f64,
    /// dq, the length of a step of rolling along x. With 0 there is no `passage`.
    pub rolling_distance: f64,
}

/// The frictional work and the wear.
#[derive(Clone, Debug)]
pub struct Worn {
    /// Frictional work per area of each element, in all steps.
    pub work: Vec<f64>,
    /// Depth of wear of each element in all steps, a length.
    pub depth: Vec<f64>,
    /// The depth that a point of the surface loses in one passage through the contact, for each row of elements. Empty without a rolling distance.
    pub passage: Vec<f64>,
    /// The frictional work of all elements, an energy.
    pub total_work: f64,
    /// The material that all elements lose, a volume.
    pub volume: f64,
    /// The largest depth.
    pub largest: f64,
    /// The index of the element with the largest depth.
    pub at: usize,
}

impl Wear<'_> {
    /// Refuses invalid inputs.
    fn check(&self) -> Result<()> {
        self.grid.check()?;
        let [qx, qy] = self.traction;
        let [sx, sy] = self.slip;
        let fields = [("traction[0]", qx), ("traction[1]", qy), ("slip[0]", sx), ("slip[1]", sy)];
        let coefficients = self.coefficient.per_element().map(|values| ("coefficients", values));
        let pressure = self.pressure.map(|p| ("pressure", p));
        for (name, values) in fields.into_iter().chain(pressure).chain(coefficients) {
            check_values(name, values, &self.grid, finite)?;
        }
        self.coefficient.check(["coefficient", "coefficients"], &self.grid, not_negative)?;
        positive("hardness", self.hardness)?;
        not_negative("steps", self.steps)?;
        not_negative("rolling_distance", self.rolling_distance)
    }

    /// The frictional work per area of one step at element i.
    fn work_at(&self, i: usize) -> Scaled {
        let [x, y] = [0, 1].map(|k| Scaled::of(self.traction[k][i]).times(Scaled::of(self.slip[k][i])));
        x.with(y, |x, y| -(x + y))
    }

    /// The depth of wear of one step at element i. Negative work counts as 0: where elements stick, the work has either sign and the size of the
    /// tolerance.
    fn depth_at(&self, i: usize) -> Scaled {
        let Scaled(factor, power) = match self.pressure {
            None => self.work_at(i),
            Some(p) => {
                let [x, y] = self.slip.map(|s| Scaled::of(s[i]));
                Scaled::of(p[i]).times(x.with(y, f64::hypot))
            }
        };
        let work = Scaled(factor.max(0.0), power);
        Scaled::of(self.coefficient.at(i)).times(work).over(Scaled::of(self.hardness))
    }
}

/// The sum of the terms, which are added as multiples of the largest power of two among them.
fn sum(terms: impl Iterator<Item = Scaled> + Clone) -> Scaled {
    let powers = terms.clone().filter(|Scaled(factor, _)| *factor != 0.0).map(|Scaled(_, power)| power);
    let power = powers.max().unwrap_or(0);
    Scaled(in_blocks(terms.map(|term| term.at(power))), power)
}

/// Refuses results that are not finite; `name` names them in the message.
fn require_finite<'a>(name: &str, values: impl IntoIterator<Item = &'a f64>) -> Result<()> {
    match values.into_iter().find(|value| !value.is_finite()) {
        Some(value) => {
            Err(Error::NotFinite(format!("{name} is {value}: what is given takes it out of the range of numbers")))
        }
        None => Ok(()),
    }
}

/// Computes frictional work and depth of wear of each element.
///
/// # Errors
/// - `InvalidArgument`: numbers out of their range, and arrays that have not one value per element.
/// - `NotFinite`: inputs that are not finite, and results that overflow.
/// - `OutOfMemory`.
pub fn frictional_wear(wear: &Wear<'_>) -> Result<Worn> {
    wear.check()?;
    let Wear { grid, rolling_distance, .. } = *wear;
    let [dx, dy, steps] = [grid.dx, grid.dy, wear.steps].map(Scaled::of);
    let all = 0..grid.len();
    let work = collected(all.clone().map(|i| steps.times(wear.work_at(i)).value()), FIELDS)?;
    require_finite("the work of an element", &work)?;
    let depth = collected(all.clone().map(|i| steps.times(wear.depth_at(i)).value()), FIELDS)?;
    let mut passage = zeros(if rolling_distance > 0.0 { grid.my } else { 0 }, FIELDS)?;
    for (iy, passage) in passage.iter_mut().enumerate() {
        let row = iy * grid.mx..(iy + 1) * grid.mx;
        *passage = sum(row.map(|i| wear.depth_at(i))).times(dx).over(Scaled::of(rolling_distance)).value();
    }
    require_finite("the depth of a passage", &passage)?;
    require_finite("the depth of an element", &depth)?;
    let whole = |of_step: Scaled| of_step.times(steps).times(dx).times(dy).value();
    let total_work = whole(sum(all.clone().map(|i| wear.work_at(i))));
    let volume = whole(sum(all.map(|i| wear.depth_at(i))));
    require_finite("the work of all elements", [&total_work])?;
    require_finite("the volume of all elements", [&volume])?;
    let (at, largest) =
        depth.iter().enumerate().fold((0, 0.0), |(at, most), (i, d)| if *d > most { (i, *d) } else { (at, most) });
    Ok(Worn { work, depth, passage, total_work, volume, largest, at })
}
