//! Flash temperature: the steady rise of the surface temperatures of both bodies by the heat that friction produces in the contact.
//!
//! Each body is a half-space whose surface moves past the contact. The heat flux is constant on each element. A part of it goes into body 1 and the
//! rest into body 2. The part is given, or it is that for which the largest temperature rises of both bodies are equal (Blok 1937). If a body has no
//! positive rise, it is one half. A negative flux cools.
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

/// A temperature rise below this times the largest absolute one is round-off. The round-off of a product by FFT is some 1e-16 times the logarithm of
/// the grid's size.
const NOISE: f64 = 1e-13;
/// The name of this memory in messages.
const FIELDS: &str = "the flash temperature";

/// The heat flux, and the thermal properties and speeds of the bodies.
#[derive(Clone, Copy, Debug)]
pub struct Heat<'a> {
    /// The grid of the flux.
    pub grid: Grid,
    /// The heat flux of each element, `[my][mx]`: a power per area. A negative flux cools.
    pub flux: &'a [f64],
    /// The thermal conductivity lambda of each body: a power per length and temperature.
    pub conductivity: [f64; 2],
    /// The thermal diffusivity kappa = lambda/(rho c) of each body: an area per time.
    pub diffusivity: [f64; 2],
    /// The speed of each surface in x relative to the contact: a length per time, of any sign.
    pub speed: [f64; 2],
    /// The part of the heat that goes into body 1. None: the part for which the largest temperature rises of both bodies are equal.
    pub share: Option<f64>,
}

/// The flash temperatures of both surfaces.
#[derive(Clone, Debug)]
pub struct Flash {
    /// The temperature rise of the surface of each body above the temperature far away, `[my][mx]`.
    pub rise: [Vec<f64>; 2],
    /// The part of the heat that goes into body 1.
    pub share: f64,
    /// The largest rise of each body.
    pub largest: [f64; 2],
    /// The index of the element with the largest rise of each body.
    pub at: [usize; 2],
}

impl Heat<'_> {
    /// Refuses numbers out of range, and a flux of another size than the grid.
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

    /// The influence coefficients of body b: lambda times the temperature rise at the offsets between elements, by a unit flux on one element.
    fn table(&self, b: usize, threads: &Threads) -> Result<Table> {
        let Grid { mx, my, dx, dy } = self.grid;
        let (speed, diffusivity) = (self.speed[b], self.diffusivity[b]);
        let reason = || format!("speed[{b}] is {speed:e} with diffusivity[{b}] of {diffusivity:e}");
        let wave = speed.abs() / (2.0 * diffusivity);
        require_range(wave.is_finite(), reason)?;
        // x is positive downstream.
        let sign = if self.speed[b] < 0.0 { -1.0 } else { 1.0 };
        let mut values: Vec<f64> = zeros(4 * mx * my, FIELDS)?;
        threads.for_each_plain_row(&mut values[2 * mx * my..], 2 * mx, |ky, row| {
            for (column, value) in row.iter_mut().enumerate() {
                let x = sign * (column as f64 - mx as f64) * dx;
                *value = kernel::of_element((x, ky as f64 * dy), (dx, dy), wave);
            }
        });
        // The coefficients are even in y. Those at the offset -my are never read.
        let (below, above) = values.split_at_mut(2 * mx * my);
        for ky in 1..my {
            below[(my - ky) * 2 * mx..][..2 * mx].copy_from_slice(&above[ky * 2 * mx..][..2 * mx]);
        }
        let self_influence = values[2 * mx * my + mx];
        // The speed is the reason if values are not finite.
        let is_within = self_influence > 0.0 && values.iter().all(|value| value.is_finite());
        require_range(is_within, reason)?;
        Table::new(mx, my, &values, &self.grid)
    }

    /// lambda times the temperature rise of body b if all of the heat goes into it.
    fn alone(&self, b: usize, threads: &Threads) -> Result<Vec<f64>> {
        let coefficients = Coefficients::from(self.table(b, threads)?);
        let operator = Operator::<f64>::new(&coefficients, &self.grid, threads)?;
        let mut rise = zeros(self.grid.len(), FIELDS)?;
        operator.apply(self.flux, &mut rise, &mut operator.workspace()?);
        Ok(rise)
    }

    /// The temperature rise of each body if all of the heat goes into that body. If both have the same speed and diffusivity, one product serves
    /// both.
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

/// Refuses temperatures beyond the range of numbers. `reason` begins the message.
fn require_range(is_within: bool, reason: impl FnOnce() -> String) -> Result<()> {
    match is_within {
        true => Ok(()),
        false => Err(Error::NotFinite(format!("{}: temperatures are beyond the range of numbers", reason()))),
    }
}

/// Computes the flash temperatures of both bodies.
///
/// # Errors
/// `InvalidArgument` or `NotFinite` for numbers out of their range, a flux without one value per element, and temperatures that overflow;
/// `OutOfMemory`.
pub fn flash_temperature(heat: &Heat<'_>, threads: &Threads) -> Result<Flash> {
    heat.check()?;
    let threads = &threads.suited_to(heat.grid.len());
    let mut rise = heat.each(threads)?;
    // The element with the largest rise, and this rise.
    let hottest = |rise: &[f64]| {
        rise.iter().enumerate().fold(
            (0, f64::NEG_INFINITY),
            |(at, largest), (i, t)| {
                if *t > largest {
                    (i, *t)
                } else {
                    (at, largest)
                }
            },
        )
    };
    let [(at_first, first), (at_second, second)] = [hottest(&rise[0]), hottest(&rise[1])];
    // The transforms leave rounding errors where there is no heat.
    let noise = [0, 1].map(|b| NOISE * rise[b].iter().fold(0.0f64, |most, t| most.max(t.abs())));
    // The part for which first * part = second * (1 - part). Without a positive rise there is none, and one half is used.
    let equal = if first > noise[0] && second > noise[1] { 1.0 / (1.0 + first / second) } else { 0.5 };
    let share = heat.share.unwrap_or(equal);
    let parts = [share, 1.0 - share];
    for (rise, part) in rise.iter_mut().zip(parts) {
        rise.iter_mut().for_each(|rise| *rise *= part);
    }
    Ok(Flash { rise, share, largest: [parts[0] * first, parts[1] * second], at: [at_first, at_second] })
}
