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
//!
//! All products are made of numbers near 1 and powers of two: a result that is a number is found, whatever the factors are, and others are refused.

use crate::effects::Coefficient;
use crate::error::{finite, not_negative, positive, Error, Result};
use crate::grid::{check_values, Grid};
use crate::memory::{collected, zeros};
use crate::powers::{apart, largest_power, PowerOfTwo};
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
}

/// What is multiplied, near 1, and the powers of two that are left out.
struct Scaled<'a> {
    wear: &'a Wear<'a>,
    traction: PowerOfTwo,
    slip: PowerOfTwo,
    pressure: PowerOfTwo,
    coefficient: PowerOfTwo,
    hardness: f64,
    steps: f64,
    /// Of the work and of the depth of a step, and of so many steps.
    of_work: i32,
    of_depth: i32,
    of_steps: i32,
}

/// Near 1 and a power of two; 0 is 0.
fn parts_of(value: f64) -> (f64, i32) {
    if value > 0.0 {
        apart(value)
    } else {
        (0.0, 0)
    }
}

impl<'a> Scaled<'a> {
    fn new(wear: &'a Wear<'a>) -> Scaled<'a> {
        let of = |[x, y]: [&[f64]; 2]| largest_power(x.iter().chain(y).copied());
        let (traction, slip) = (of(wear.traction), of(wear.slip));
        let pressure = largest_power(wear.pressure.into_iter().flatten().copied());
        let coefficient = match wear.coefficient {
            Coefficient::Uniform(value) => largest_power([value].into_iter()),
            Coefficient::PerElement(values) => largest_power(values.iter().copied()),
        };
        let ((hardness, of_hardness), (steps, of_steps)) = (apart(wear.hardness), parts_of(wear.steps));
        let by = if wear.pressure.is_some() { pressure } else { traction };
        Scaled {
            wear,
            traction: PowerOfTwo::new(-traction),
            slip: PowerOfTwo::new(-slip),
            pressure: PowerOfTwo::new(-pressure),
            coefficient: PowerOfTwo::new(-coefficient),
            hardness,
            steps,
            of_work: traction + slip,
            of_depth: by + slip + coefficient - of_hardness,
            of_steps,
        }
    }

    /// Of a step at element i.
    fn work_at(&self, i: usize) -> f64 {
        let ([qx, qy], [sx, sy]) = (self.wear.traction, self.wear.slip);
        let product = |q: f64, s: f64| self.traction.times(q) * self.slip.times(s);
        -(product(qx[i], sx[i]) + product(qy[i], sy[i]))
    }

    /// Of a step at element i. An element that sticks has a work of either sign, of the size of the tolerance: nothing grows.
    fn depth_at(&self, i: usize) -> f64 {
        let by = match self.wear.pressure {
            None => self.work_at(i).max(0.0),
            Some(p) => {
                let [sx, sy] = self.wear.slip.map(|s| self.slip.times(s[i]));
                self.pressure.times(p[i]).max(0.0) * sx.hypot(sy)
            }
        };
        self.coefficient.times(self.wear.coefficient.at(i)) * by / self.hardness
    }
}

/// Times a power of two; refuses what is no number then, by its name.
fn unscaled(name: &str, values: &mut [f64], power: i32) -> Result<()> {
    let power = PowerOfTwo::new(power);
    values.iter_mut().for_each(|value| *value = power.times(*value));
    match values.iter().find(|value| !value.is_finite()) {
        Some(value) => {
            Err(Error::NotFinite(format!("{name} is {value}: what is given takes it out of the range of numbers")))
        }
        None => Ok(()),
    }
}

/// Frictional work and depth of wear of each element.
///
/// # Errors
/// `Invalid`, `NotFinite`: numbers out of their range, results out of the range of numbers, and arrays that have not one value per element.
/// `OutOfMemory`.
pub fn frictional_wear(wear: &Wear<'_>) -> Result<Worn> {
    wear.check()?;
    let Wear { grid, rolling_distance, .. } = *wear;
    let scaled = Scaled::new(wear);
    let Scaled { steps, of_work, of_depth, of_steps, .. } = scaled;
    let mut work = collected((0..grid.len()).map(|i| steps * scaled.work_at(i)), FIELDS)?;
    let mut depth = collected((0..grid.len()).map(|i| steps * scaled.depth_at(i)), FIELDS)?;
    let ((dx, of_dx), (dy, of_dy)) = (apart(grid.dx), apart(grid.dy));
    let mut passage = zeros(if rolling_distance > 0.0 { grid.my } else { 0 }, FIELDS)?;
    if rolling_distance > 0.0 {
        let (distance, of_distance) = apart(rolling_distance);
        for (iy, passage) in passage.iter_mut().enumerate() {
            let row = iy * grid.mx..(iy + 1) * grid.mx;
            *passage = in_blocks(row.map(|i| scaled.depth_at(i))) * (dx / distance);
        }
        unscaled("the depth of a passage", &mut passage, of_depth + of_dx - of_distance)?;
    }
    let (at, _) =
        depth.iter().enumerate().fold((0, 0.0), |top, (i, depth)| if *depth > top.1 { (i, *depth) } else { top });
    let sum = |values: &[f64]| [in_blocks(values.iter().copied()) * (dx * dy)];
    let (mut total_work, mut volume) = (sum(&work), sum(&depth));
    unscaled("the work of an element", &mut work, of_work + of_steps)?;
    unscaled("the depth of an element", &mut depth, of_depth + of_steps)?;
    unscaled("the work of all elements", &mut total_work, of_work + of_steps + of_dx + of_dy)?;
    unscaled("the volume of all elements", &mut volume, of_depth + of_steps + of_dx + of_dy)?;
    let ([total_work], [volume], largest) = (total_work, volume, depth[at]);
    Ok(Worn { work, depth, passage, total_work, volume, largest, at })
}
