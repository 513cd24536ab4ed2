//! The direction of rolling of coefficients that are not even in an offset: those of relaxing bodies, which are softer behind. A step of rolling must
//! have this direction. Otherwise bodies would return more work than was done on them, and the problem would have no solution or several.

use toeplitz::coefficients::SYMMETRY;

use super::friction::{Friction, Motion};
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::influence::Coefficients;

const INSTEAD: &str = "give coefficients of bodies that roll as the step goes: of contact_normal_influence_rolling those with a speed below 0 for \
     rolling towards -x; for rolling along y a grid whose x goes along that";

/// Coefficients of the offsets of a line through an element.
struct Line<'a> {
    name: &'static str,
    count: usize,
    at: &'a dyn Fn(i64) -> f64,
}

impl Line<'_> {
    /// The offset with the largest difference of both sides, if that exceeds round-off of the largest coefficient.
    fn uneven_at(&self) -> Option<i64> {
        let off = |k: i64| ((self.at)(k) - (self.at)(-k)).abs();
        let most = (1..self.count as i64).max_by(|a, b| off(*a).total_cmp(&off(*b)))?;
        (off(most) > SYMMETRY * (self.at)(0).abs()).then_some(most)
    }

    /// 1: softer at smaller offsets, which are behind a body rolling towards the end of the axis; -1: at larger ones; 0: even.
    fn towards(&self) -> f64 {
        let softer: f64 = (1..self.count as i64).map(|k| (self.at)(-k) - (self.at)(k)).sum();
        self.uneven_at().map_or(0.0, |_| softer.signum())
    }
}

/// Refuses a step of rolling, in elements, in another direction than that of the coefficients `name`.
fn check(name: &str, lines: [Line<'_>; 2], step: (f64, f64)) -> Result<()> {
    let goes = [step.0, step.1].map(|step| if step == 0.0 { 0.0 } else { step.signum() });
    let towards = lines.each_ref().map(Line::towards);
    if towards == [0.0; 2] || towards == goes {
        return Ok(());
    }
    let Some((line, k)) = lines.iter().find_map(|line| Some((line, line.uneven_at()?))) else { return Ok(()) };
    let ways = lines.iter().zip(towards).filter(|(_, towards)| *towards != 0.0);
    let ways: Vec<String> =
        ways.map(|(line, towards)| format!("{}{}", if towards > 0.0 { "+" } else { "-" }, line.name)).collect();
    invalid(format!(
        "{name} is {} at {k} elements along {axis} and {} at {}: these bodies roll towards {}, but the step goes {step:?} elements; {INSTEAD}",
        (line.at)(k),
        (line.at)(-k),
        -k,
        ways.join(" and "),
        axis = line.name,
    ))
}

/// Refuses tangential coefficients of another direction of rolling.
pub(super) fn check_tangential(friction: &Friction<'_>, grid: &Grid) -> Result<()> {
    let Some(own) = friction.influence.filter(|own| friction.motion != Motion::Shift && !own.by_row) else {
        return Ok(());
    };
    for component in 0..2 {
        let in_x = |k: i64| own.at(k, 0)[component];
        let in_y = |k: i64| own.at(0, k)[component];
        let lines = [Line { name: "x", count: own.cx, at: &in_x }, Line { name: "y", count: own.cy, at: &in_y }];
        let name = ["friction->influence[0] (xx)", "friction->influence[1] (yy)"][component];
        check(name, lines, friction.elements_rolled(grid))?;
    }
    Ok(())
}

/// Refuses coefficients of pressures of another direction of rolling. For tables per loaded row the coefficients of each row on itself are compared.
/// They are even if the operator is symmetric.
pub(super) fn check_pressures(friction: &Friction<'_>, grid: &Grid, coefficients: &Coefficients) -> Result<()> {
    if friction.motion == Motion::Shift {
        return Ok(());
    }
    let step = friction.elements_rolled(grid);
    let Some((rows, _)) = coefficients.row_tables() else {
        let (in_x, in_y) = (|k: i64| coefficients.at(k, 0), |k: i64| coefficients.at(0, k));
        let lines = [Line { name: "x", count: grid.mx, at: &in_x }, Line { name: "y", count: grid.my, at: &in_y }];
        return check("influence", lines, step);
    };
    (0..grid.my).try_for_each(|row| {
        let (in_x, own) = (|k: i64| rows.coefficient(row, row, k), |_: i64| rows.coefficient(row, row, 0));
        let lines = [Line { name: "x", count: grid.mx, at: &in_x }, Line { name: "y", count: 1, at: &own }];
        check(&format!("row_tables of row {row} on itself"), lines, step)
    })
}
