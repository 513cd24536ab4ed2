//! Wear: the frictional work on each element and the depth of wear, from the tractions and slips of a solve.
//!
//! ```text
//! work  = -(q . s)                   the frictional work of a step, an energy per area
//! depth = K/H work  or  K/H p |s|    Archard 1953: volume = K/H times load times distance slid
//! ```
//!
//! K is the wear coefficient (no unit), H the hardness (a pressure). If the coefficient of friction mu is uniform, both forms are equivalent: K of
//! the first one is K of the second one over mu. Tractions act on body 1, and slips are those of body 1 over body 2, so that q is opposite to s.
//!
//! If bodies roll in +x by dq in a step, a point of a surface passes through a row of elements and spends dx/dq steps in each of them. `passage` is
//! the depth that the point loses.
//!
//! Numbers are split into a factor near 1 and a power of two, so that intermediate results do not overflow. Results that overflow are refused.

use crate::effects::Coefficient;
use crate::error::{finite, not_negative, positive, Error, Result};
use crate::grid::{check_values, Grid};
use crate::memory::{collected, zeros};
use crate::powers::Scaled;
use crate::sums::in_blocks;

/// The name of this memory in messages.
const FIELDS: &str = "the wear";

/// The tractions and slips of a step, and what the wear depends on.
#[derive(Clone, Copy, Debug)]
pub struct Wear<'a> {
    /// The grid of all arrays.
    pub grid: Grid,
    /// The tractions q on body 1 in x and in y, `[my][mx]` each: a force per area.
    pub traction: [&'a [f64]; 2],
    /// The slips s of body 1 over body 2 in a step, in x and in y, `[my][mx]` each: a length.
    pub slip: [&'a [f64]; 2],
    /// The pressures p, `[my][mx]`. With them the depth follows from `p |s|`, without them from the work.
    pub pressure: Option<&'a [f64]>,
    /// The wear coefficient K, uniform or one for each element; K/H if `hardness` is 1.
    pub coefficient: Coefficient<'a>,
    /// The hardness H, a pressure.
    pub hardness: f64,
    /// The number of steps over which work and depth are summed.
    pub steps: f64,
    /// The length dq of a step of rolling along x. If it is 0, `passage` is not computed.
    pub rolling_distance: f64,
}

/// The work of friction and the wear.
#[derive(Clone, Debug)]
pub struct Worn {
    /// The frictional work of all steps on each element, an energy per area.
    pub work: Vec<f64>,
    /// The depth of wear of all steps on each element, a length.
    pub depth: Vec<f64>,
    /// The depth that a point of the surface loses in one passage through the contact, for each row; empty without a rolling distance.
    pub passage: Vec<f64>,
    /// The frictional work of all steps on all elements, an energy.
    pub total_work: f64,
    /// The volume that all elements lose in all steps.
    pub volume: f64,
    /// The largest value of `depth`.
    pub largest: f64,
    /// The index of the element with the largest depth.
    pub at: usize,
}

impl Wear<'_> {
    /// Refuses numbers out of range, and arrays of another size than the grid.
    fn check(&self) -> Result<()> {
        self.grid.check()?;
        let [qx, qy] = self.traction;
        let [sx, sy] = self.slip;
        let fields = [("traction[0]", qx), ("traction[1]", qy), ("slip[0]", sx), ("slip[1]", sy)];
        let coefficients = self.coefficient.per_element().map(|values| ("coefficients", values));
        for (name, values) in fields.into_iter().chain(self.pressure.map(|p| ("pressure", p))).chain(coefficients) {
            check_values(name, values, &self.grid, finite)?;
        }
        self.coefficient.check(["coefficient", "coefficients"], &self.grid, not_negative)?;
        positive("hardness", self.hardness)?;
        not_negative("steps", self.steps)?;
        not_negative("rolling_distance", self.rolling_distance)
    }

    /// The frictional work of a step on element i, an energy per area.
    fn work_at(&self, i: usize) -> Scaled {
        let [x, y] = [0, 1].map(|k| Scaled::of(self.traction[k][i]).times(Scaled::of(self.slip[k][i])));
        x.with(y, |x, y| -(x + y))
    }

    /// The depth of wear of a step on element i. It is not negative, although the work of a sticking element has either sign, with a size of the
    /// order of the tolerance.
    fn depth_at(&self, i: usize) -> Scaled {
        let worn_by = match self.pressure {
            None => self.work_at(i),
            Some(p) => {
                let [x, y] = self.slip.map(|s| Scaled::of(s[i]));
                Scaled::of(p[i]).times(x.with(y, f64::hypot))
            }
        };
        let Scaled(factor, power) = worn_by;
        let worn_by = Scaled(factor.max(0.0), power);
        Scaled::of(self.coefficient.at(i)).times(worn_by).over(Scaled::of(self.hardness))
    }
}

/// The sum of terms. They are added in units of the power of the largest one.
fn sum(terms: impl Iterator<Item = Scaled> + Clone) -> Scaled {
    let powers = terms.clone().filter(|Scaled(factor, _)| *factor != 0.0).map(|Scaled(_, power)| power);
    let largest_power = powers.max().unwrap_or(0);
    Scaled(in_blocks(terms.map(|term| term.at(largest_power))), largest_power)
}

/// Refuses values that are not finite. `name` names them in the message.
fn require_finite<'a>(name: &str, values: impl IntoIterator<Item = &'a f64>) -> Result<()> {
    match values.into_iter().find(|value| !value.is_finite()) {
        Some(value) => {
            Err(Error::NotFinite(format!("{name} is {value}: what is given takes it out of the range of numbers")))
        }
        None => Ok(()),
    }
}

/// Computes the frictional work and the depth of wear of each element.
///
/// # Errors
/// `InvalidArgument` or `NotFinite` for numbers out of their range, results that overflow, and arrays without one value per element; `OutOfMemory`.
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
        depth.iter().enumerate().fold(
            (0, 0.0),
            |(at, largest), (i, depth)| {
                if *depth > largest {
                    (i, *depth)
                } else {
                    (at, largest)
                }
            },
        );
    Ok(Worn { work, depth, passage, total_work, volume, largest, at })
}
