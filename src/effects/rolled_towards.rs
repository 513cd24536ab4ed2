//! The direction of rolling to which the caller's influence coefficients belong. Coefficients of viscoelastic bodies in steady rolling are not even
//! in the offset: the bodies are softer behind a load. A step of rolling must have the direction of the coefficients. Otherwise the bodies would
//! return more work than was done on them, and the problem would have no solution or several solutions.

use toeplitz::coefficients::SYMMETRY;

use super::friction::{Friction, Motion};
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::influence::Coefficients;

const INSTEAD: &str = "give coefficients of bodies that roll as the step goes: of contact_normal_influence_rolling those with a speed below 0 for \
     rolling towards -x; for rolling along y a grid whose x goes along that";

/// The influence coefficients of an element on the elements of a line through it, along x or along y.
struct Line<'a> {
    /// The axis along which the line goes.
    axis: &'static str,
    /// The coefficients reach the offsets `1 - count` to `count - 1`.
    count: usize,
    /// The coefficient at an offset, in elements.
    coefficient: &'a dyn Fn(i64) -> f64,
}

impl Line<'_> {
    /// The offset k > 0 at which the coefficients of k and -k differ most. None: they differ by no more than round-off of the coefficient at 0.
    fn uneven_at(&self) -> Option<i64> {
        let difference = |k: i64| ((self.coefficient)(k) - (self.coefficient)(-k)).abs();
        let most = (1..self.count as i64).max_by(|a, b| difference(*a).total_cmp(&difference(*b)))?;
        (difference(most) > SYMMETRY * (self.coefficient)(0).abs()).then_some(most)
    }

    /// The direction in which bodies with these coefficients roll. 1: along the axis, as the bodies are softer at negative offsets, which are behind
    /// the load; -1: against the axis; 0: the coefficients are even.
    fn towards(&self) -> f64 {
        let softer: f64 = (1..self.count as i64).map(|k| (self.coefficient)(-k) - (self.coefficient)(k)).sum();
        self.uneven_at().map_or(0.0, |_| softer.signum())
    }
}

/// Refuses a `step` of rolling, in elements along x and y, whose direction is not that of the coefficients, which messages call `name`.
fn check(name: &str, lines: [Line<'_>; 2], step: (f64, f64)) -> Result<()> {
    let goes = [step.0, step.1].map(|step| if step == 0.0 { 0.0 } else { step.signum() });
    let towards = lines.each_ref().map(Line::towards);
    if towards == [0.0; 2] || towards == goes {
        return Ok(());
    }
    let Some((line, k)) = lines.iter().find_map(|line| Some((line, line.uneven_at()?))) else { return Ok(()) };
    let directions = lines.iter().zip(towards).filter(|(_, towards)| *towards != 0.0);
    let directions: Vec<String> =
        directions.map(|(line, towards)| format!("{}{}", if towards > 0.0 { "+" } else { "-" }, line.axis)).collect();
    invalid(format!(
        "{name} is {} at {k} elements along {axis} and {} at {}: these bodies roll towards {}, but the step goes {step:?} elements; {INSTEAD}",
        (line.coefficient)(k),
        (line.coefficient)(-k),
        -k,
        directions.join(" and "),
        axis = line.axis,
    ))
}

/// Refuses the caller's tangential coefficients if they belong to another direction of rolling.
pub(super) fn check_tangential(friction: &Friction<'_>, grid: &Grid) -> Result<()> {
    let Some(tables) = friction.influence.filter(|tables| friction.motion != Motion::Shift && !tables.by_row) else {
        return Ok(());
    };
    for component in 0..2 {
        let in_x = |k: i64| tables.at(k, 0)[component];
        let in_y = |k: i64| tables.at(0, k)[component];
        let lines = [
            Line { axis: "x", count: tables.cx, coefficient: &in_x },
            Line { axis: "y", count: tables.cy, coefficient: &in_y },
        ];
        let name = ["friction->influence[0] (xx)", "friction->influence[1] (yy)"][component];
        check(name, lines, friction.elements_rolled(grid))?;
    }
    Ok(())
}

/// Refuses the caller's coefficients of pressures if they belong to another direction of rolling. Of tables per loaded row it compares the
/// coefficients of each row on itself, which are even if the operator is symmetric.
pub(super) fn check_pressures(friction: &Friction<'_>, grid: &Grid, coefficients: &Coefficients) -> Result<()> {
    if friction.motion == Motion::Shift {
        return Ok(());
    }
    let step = friction.elements_rolled(grid);
    let Some((rows, _)) = coefficients.row_tables() else {
        let (in_x, in_y) = (|k: i64| coefficients.at(k, 0), |k: i64| coefficients.at(0, k));
        let lines = [
            Line { axis: "x", count: grid.mx, coefficient: &in_x },
            Line { axis: "y", count: grid.my, coefficient: &in_y },
        ];
        return check("influence", lines, step);
    };
    (0..grid.my).try_for_each(|row| {
        let (in_x, on_itself) = (|k: i64| rows.coefficient(row, row, k), |_: i64| rows.coefficient(row, row, 0));
        let lines = [
            Line { axis: "x", count: grid.mx, coefficient: &in_x },
            Line { axis: "y", count: 1, coefficient: &on_itself },
        ];
        check(&format!("row_tables of row {row} on itself"), lines, step)
    })
}
