//! Tangential influence coefficients Axx, Ayy and Axy of viscoelastic bodies in steady rolling, at a constant Poisson ratio. Each of them follows
//! from the elastic coefficients by the integral over the way of the material, as the [normal ones](crate::visco::rolling_table).
//!
//! Material behind the loaded element has relaxed for longer than material ahead of it. So the tables are not even in x, and serve steady rolling
//! only.

use super::coefficients::{Compliance, Entry, Tangential};
use super::row_tables::TABLES;
use crate::error::{finite, require, Error, Result};
use crate::memory::zeros;
use crate::powers::{apart, times_power};
use crate::visco::rolling::{check, finest, parts, Row, OUT_OF_RANGE};
use crate::visco::RollingBody;

/// Refuses bodies that pressures would displace tangentially, at once or as they relax. `compliance` of the bodies is 1/(2 G).
fn check_alike(bodies: &[RollingBody; 2], nu: [f64; 2]) -> Result<()> {
    let [first, second] = [0, 1].map(|b: usize| (1.0 - 2.0 * nu[b]) * bodies[b].compliance);
    let same = |of: fn(&RollingBody) -> &[f64]| of(&bodies[0]) == of(&bodies[1]);
    let relax_alike = same(|body| &body.series.fractions) && same(|body| &body.series.times);
    if first == second && (first == 0.0 || relax_alike) {
        return Ok(());
    }
    Err(Error::Unsupported(
        "the bodies are unlike, at once or as they relax: pressures push them sideways, and this version has no coefficients of that".into(),
    ))
}

/// Computes the tables Axx, Ayy and Axy of two bodies in steady rolling, at the offsets `-cx..cx` by `-cy..cy`. The bodies roll towards +x, or
/// towards -x if the speed is negative. `compliance` of the bodies is the instantaneous `1/(2 G)`.
///
/// # Errors
/// Those of `rolling_table`, and `Unsupported` for unlike bodies.
pub fn rolling_tables(
    (cx, cy): (usize, usize),
    (dx, dy): (f64, f64),
    (bodies, nu): (&[RollingBody; 2], [f64; 2]),
    speed: f64,
) -> Result<[Vec<f64>; 3]> {
    let most = check((cx, cy), (dx, dy), bodies, speed)?;
    check_alike(bodies, nu)?;
    let ((d, of_d), (_, of_compliance)) = (apart(dx), apart(most));
    // dy/dx.
    let width = times_power(dy, -of_d) / d;
    let of_body = |b: usize| -> Result<_> {
        // The parts multiply these instantaneous coefficients by the compliance of the body.
        let unit = Compliance { shear: 1.0, poisson: nu[b], unlike: 0.0 };
        Ok((Tangential::new(d, times_power(dy, -of_d), unit), parts(b, &bodies[b], of_compliance, dx, speed)?))
    };
    let of_bodies = [of_body(0)?, of_body(1)?];
    let table = || zeros(4 * cx * cy, TABLES);
    let mut tables: [Vec<f64>; 3] = [table()?, table()?, table()?];
    let mut row: Vec<Entry> = zeros(2 * cx + 1, TABLES)?;
    for ky in 0..=cy {
        row.fill([0.0; 3]);
        for (tangential, parts) in &of_bodies {
            let at = |kx: f64| tangential.at(kx, ky as f64);
            let elements = Row { at: &at, finest: finest(ky, width) };
            parts.iter().for_each(|part| elements.add(part, cx, &mut row));
        }
        for entry in &mut row {
            *entry = entry.map(|value| times_power(value, of_d + of_compliance));
            let [xx, yy, xy] = *entry;
            let are_in_range = [xx, yy].iter().all(|value| value.is_normal() && *value > 0.0);
            require(are_in_range, "a coefficient", xx.min(yy), OUT_OF_RANGE)?;
            finite("a coefficient", xy)?;
        }
        write(&row, speed < 0.0, (cx, cy, ky), &mut tables);
    }
    Ok(tables)
}

/// Writes the row at offsets ky to the tables, and its mirror image at -ky: Axx and Ayy are even in y, Axy is odd. If `back`, bodies roll towards -x,
/// and the row is mirrored in x, too.
fn write(row: &[Entry], back: bool, (cx, cy, ky): (usize, usize, usize), tables: &mut [Vec<f64>; 3]) {
    for (iy, side) in [(cy.checked_sub(ky), -1.0), (Some(cy + ky), 1.0)] {
        let Some(iy) = iy.filter(|iy| *iy < 2 * cy) else { continue };
        for (k, table) in tables.iter_mut().enumerate() {
            let sign = match (k == 2, back) {
                (false, _) => 1.0,
                // Axy is exactly 0 in the row of the loaded element.
                _ if ky == 0 => 0.0,
                (true, false) => side,
                (true, true) => -side,
            };
            for (kx, value) in table[iy * 2 * cx..][..2 * cx].iter_mut().enumerate() {
                *value = sign * row[if back { 2 * cx - kx } else { kx }][k];
            }
        }
    }
}
