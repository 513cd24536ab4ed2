//! Tangential coefficients of bodies that relax and roll steadily: each of xx, yy and xy by the integral of the
//! [normal ones](crate::visco::rolling_table), at a constant Poisson ratio.
//!
//! Material behind has relaxed for longer: the tables are not even in x, and serve steady rolling.

use super::coefficients::{Compliance, Entry, Tangential};
use super::row_tables::TABLES;
use crate::error::{finite, require, Error, Result};
use crate::memory::zeros;
use crate::powers::{apart, times_power};
use crate::visco::rolling::{check, finest, parts, Row, OUT_OF_RANGE};
use crate::visco::RollingBody;

/// Refuses bodies that pressures would displace sideways, at once or later. `compliance` is 1/(2 G).
fn check_alike(bodies: &[RollingBody; 2], nu: [f64; 2]) -> Result<()> {
    let push = [0, 1].map(|b: usize| (1.0 - 2.0 * nu[b]) * bodies[b].compliance);
    let same = |of: fn(&RollingBody) -> &[f64]| of(&bodies[0]) == of(&bodies[1]);
    let relax_alike = same(|body| &body.series.fractions) && same(|body| &body.series.times);
    if push[0] == push[1] && (push[0] == 0.0 || relax_alike) {
        return Ok(());
    }
    Err(Error::Unsupported(
        "the bodies are unlike, at once or as they relax: pressures push them sideways, and this version has no coefficients of that".into(),
    ))
}

/// xx, yy and xy of two bodies in steady rolling towards +x, or towards -x for a negative speed, as tables of the offsets `-cx..cx` by
/// `-cy..cy`. `compliance` of the bodies is the instantaneous `1/(2 G)`.
///
/// # Errors
/// As `rolling_table`; `Unsupported`: unlike bodies.
pub fn rolling_tables(
    (cx, cy): (usize, usize),
    (dx, dy): (f64, f64),
    (bodies, nu): (&[RollingBody; 2], [f64; 2]),
    speed: f64,
) -> Result<[Vec<f64>; 3]> {
    let most = check((cx, cy), (dx, dy), bodies, speed)?;
    check_alike(bodies, nu)?;
    let ((d, of_d), (_, of_compliance)) = (apart(dx), apart(most));
    // The aspect of elements.
    let width = times_power(dy, -of_d) / d;
    let of_body = |b: usize| -> Result<_> {
        // Coefficients of compliance 1.
        let at_once = Compliance { shear: 1.0, poisson: nu[b], unlike: 0.0 };
        Ok((Tangential::new(d, times_power(dy, -of_d), at_once), parts(b, &bodies[b], of_compliance, dx, speed)?))
    };
    let of_bodies = [of_body(0)?, of_body(1)?];
    let table = || zeros(4 * cx * cy, TABLES);
    let mut tables: [Vec<f64>; 3] = [table()?, table()?, table()?];
    let mut row: Vec<Entry> = zeros(2 * cx + 1, TABLES)?;
    for ky in 0..=cy {
        row.fill([0.0; 3]);
        for (tangential, parts) in &of_bodies {
            let at = |kx: f64| tangential.at(kx, ky as f64);
            let of = Row { at: &at, finest: finest(ky, width) };
            parts.iter().for_each(|part| of.add(part, cx, &mut row));
        }
        for entry in &mut row {
            *entry = entry.map(|value| times_power(value, of_d + of_compliance));
            let [xx, yy, xy] = *entry;
            let are_some = [xx, yy].iter().all(|value| value.is_normal() && *value > 0.0);
            require(are_some, "a coefficient", xx.min(yy), OUT_OF_RANGE)?;
            finite("a coefficient", xy)?;
        }
        write(&row, speed < 0.0, (cx, cy, ky), &mut tables);
    }
    Ok(tables)
}

/// Writes a row of offsets and its mirror image in y: xx and yy are even in y, xy is odd. `back`: bodies roll towards -x, mirrored in x.
fn write(row: &[Entry], back: bool, (cx, cy, ky): (usize, usize, usize), tables: &mut [Vec<f64>; 3]) {
    for (iy, side) in [(cy.checked_sub(ky), -1.0), (Some(cy + ky), 1.0)] {
        let Some(iy) = iy.filter(|iy| *iy < 2 * cy) else { continue };
        for (k, table) in tables.iter_mut().enumerate() {
            let sign = match (k == 2, back) {
                (false, _) => 1.0,
                // Exactly 0 in the row of the element.
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
