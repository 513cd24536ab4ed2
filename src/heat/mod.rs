//! Flash temperature: the steady temperature rise of both surfaces by a heat flux through the contact, that of friction.
//!
//! Each body is a half-space whose surface moves past the contact. The heat flux is constant on elements, a part of it goes into body 1 and the
//! rest into body 2. The part is given, or such that the largest temperatures of both are equal (Blok 1937), if both bodies have a positive rise
//! somewhere, else one half. A flux below 0 cools.
//!
//! | module | contents |
//! |---|---|
//! | `kernel` | the temperature rise by one element |

mod kernel;

use crate::error::{finite, positive, require, Error, Result};
use crate::grid::{check_values, Grid};
use crate::influence::{Coefficients, Table};
use crate::memory::{copied, zeros};
use crate::operator::Operator;
use crate::threads::Threads;

/// Rounding errors of a product by FFT, relative to its largest value: some 1e-16 times the logarithm of the grid's size.
const NOISE: f64 = 1e-13;
/// The name of this memory in messages.
const FIELDS: &str = "the flash temperature";

/// The heat flux, and the bodies.
#[derive(Clone, Copy, Debug)]
pub struct Heat<'a> {
    /// The elements.
    pub grid: Grid,
    /// The flux of each element, `[my][mx]`: a power per area; below 0 it cools.
    pub flux: &'a [f64],
    /// lambda of body 1 and 2: power per length and temperature.
    pub conductivity: [f64; 2],
    /// kappa = lambda/(rho c) of both: area per time.
    pub diffusivity: [f64; 2],
    /// The speed of each surface in x past the contact: length per time, of any sign.
    pub speed: [f64; 2],
    /// The part of the heat that goes into body 1; none: such that the largest temperatures of both are equal.
    pub share: Option<f64>,
}

/// The temperature rise of the surfaces, above the temperature far away.
#[derive(Clone, Debug)]
pub struct Flash {
    /// The rise of body 1 and 2, `[my][mx]` each.
    pub rise: [Vec<f64>; 2],
    /// The part of the heat that goes into body 1.
    pub share: f64,
    /// The largest rise of each body.
    pub largest: [f64; 2],
    /// The elements of the largest rises.
    pub at: [usize; 2],
}

impl Heat<'_> {
    fn check(&self) -> Result<()> {
        self.grid.check()?;
        check_values("heat_flux", self.flux, &self.grid, finite)?;
        for (name, value) in ["conductivity[0]", "conductivity[1]"].iter().zip(self.conductivity) {
            positive(name, value)?;
        }
        for (name, value) in ["diffusivity[0]", "diffusivity[1]"].iter().zip(self.diffusivity) {
            positive(name, value)?;
        }
        for (name, value) in ["speed[0]", "speed[1]"].iter().zip(self.speed) {
            finite(name, value)?;
        }
        match self.share {
            Some(share) => require((0.0..=1.0).contains(&share), "share", share, "a part must lie in [0, 1]"),
            None => Ok(()),
        }
    }

    /// lambda T at element offsets by a unit flux, for a moving body.
    fn table(&self, b: usize, threads: &Threads) -> Result<Table> {
        let Grid { mx, my, dx, dy } = self.grid;
        let (speed, diffusivity) = (self.speed[b], self.diffusivity[b]);
        let reason = || format!("speed[{b}] is {speed:e} with diffusivity[{b}] of {diffusivity:e}");
        let wave = speed.abs() / (2.0 * diffusivity);
        require_range(wave.is_finite(), reason)?;
        // x downstream.
        let sign = if self.speed[b] < 0.0 { -1.0 } else { 1.0 };
        let mut values: Vec<f64> = zeros(4 * mx * my, FIELDS)?;
        threads.for_each_plain_row(&mut values[2 * mx * my..], 2 * mx, |ky, row| {
            for (column, value) in row.iter_mut().enumerate() {
                let x = sign * (column as f64 - mx as f64) * dx;
                *value = kernel::of_element((x, ky as f64 * dy), (dx, dy), wave);
            }
        });
        // Even in y; row -my is never read.
        let (below, above) = values.split_at_mut(2 * mx * my);
        for ky in 1..my {
            below[(my - ky) * 2 * mx..][..2 * mx].copy_from_slice(&above[ky * 2 * mx..][..2 * mx]);
        }
        let own = values[2 * mx * my + mx];
        // Values that are not finite are due to the speed.
        let is_within = own > 0.0 && values.iter().all(|value| value.is_finite());
        require_range(is_within, reason)?;
        Table::new(mx, my, &values, &self.grid)
    }

    /// lambda times the rise of a body with all of the heat.
    fn alone(&self, b: usize, threads: &Threads) -> Result<Vec<f64>> {
        let coefficients = Coefficients::from(self.table(b, threads)?);
        let operator = Operator::<f64>::new(&coefficients, &self.grid, threads)?;
        let mut rise = zeros(self.grid.len(), FIELDS)?;
        operator.apply(self.flux, &mut rise, &mut operator.workspace()?);
        Ok(rise)
    }

    /// The rise of each body with all of the heat. If both have the same speed and diffusivity, one product serves both.
    fn each(&self, threads: &Threads) -> Result<[Vec<f64>; 2]> {
        let first = self.alone(0, threads)?;
        let is_same = self.speed[0] == self.speed[1] && self.diffusivity[0] == self.diffusivity[1];
        let second = if is_same { copied(&first, FIELDS)? } else { self.alone(1, threads)? };
        let mut both = [first, second];
        for (b, (rise, conductivity)) in both.iter_mut().zip(self.conductivity).enumerate() {
            rise.iter_mut().for_each(|rise| *rise /= conductivity);
            require_range(rise.iter().all(|rise| rise.is_finite()), || {
                let largest = self.flux.iter().fold(0.0f64, |most, flux| most.max(flux.abs()));
                format!("heat_flux reaches {largest:e} with conductivity[{b}] of {conductivity:e}")
            })?;
        }
        Ok(both)
    }
}

/// Refuses temperatures that are not finite, with the reason.
fn require_range(is_within: bool, reason: impl FnOnce() -> String) -> Result<()> {
    match is_within {
        true => Ok(()),
        false => Err(Error::NotFinite(format!("{}: temperatures are beyond the range of numbers", reason()))),
    }
}

/// The flash temperatures of both bodies.
///
/// # Errors
/// `InvalidArgument`, `NotFinite`: numbers out of their range, a flux without one value per element, temperatures that overflow.
/// `OutOfMemory`.
pub fn flash_temperature(heat: &Heat<'_>, threads: &Threads) -> Result<Flash> {
    heat.check()?;
    let threads = &threads.suited_to(heat.grid.len());
    let mut rise = heat.each(threads)?;
    let top = |rise: &[f64]| {
        rise.iter().enumerate().fold((0, f64::NEG_INFINITY), |top, (i, t)| if *t > top.1 { (i, *t) } else { top })
    };
    let tops = [top(&rise[0]), top(&rise[1])];
    let [first, second] = tops.map(|(_, top)| top);
    // The transforms leave rounding errors where it is cold.
    let noise = [0, 1].map(|b| NOISE * rise[b].iter().fold(0.0f64, |most, t| most.max(t.abs())));
    // Without heat the part is arbitrary.
    let equal = if first > noise[0] && second > noise[1] { 1.0 / (1.0 + first / second) } else { 0.5 };
    let share = heat.share.unwrap_or(equal);
    let parts = [share, 1.0 - share];
    for (rise, part) in rise.iter_mut().zip(parts) {
        rise.iter_mut().for_each(|rise| *rise *= part);
    }
    Ok(Flash { rise, share, largest: [parts[0] * tops[0].1, parts[1] * tops[1].1], at: [tops[0].0, tops[1].0] })
}
