//! Solves linear systems at a fixed approach to small residuals. On large grids GMRES restarts with the remaining residual as the right-hand
//! side, so that few search directions are kept at a time.

use super::system::{Linearised, Short};
use super::unknowns::is_small;
use crate::error::Result;
use crate::methods::fgmres::{self, Bordered, Until};
use crate::methods::fields::{self, Fields};

/// A system counts as solved if its residual is at most this factor times the target. The factor allows for round-off.
const SLACK: f64 = 1.0 + 1e-6;

/// The accuracy and the cost of a solve.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// The relative residual at which the solve ends.
    pub part: f64,
    /// The largest number of search directions.
    pub most: usize,
    /// The number of search directions after which a solve on a large grid restarts.
    pub at_once: usize,
}

/// A solution of a linear system.
pub struct Solution {
    /// The pressures y.
    pub y: Vec<Short>,
    /// A y, in units of a0.
    pub product: Vec<Short>,
    /// Whether the relative residual is reached.
    pub is_solved: bool,
}

/// Solves the system. `right(system, i)` is element i of the right-hand side.
pub fn solve_in_parts(
    system: &mut Linearised<'_>,
    right: impl Fn(&Linearised<'_>, usize) -> f64 + Sync + Send,
    Effort { part, most, at_once }: Effort,
    fields: &mut Fields<1>,
) -> Result<Solution> {
    let (n, threads) = (system.stiffness.len(), system.level.problem.threads.clone());
    let at_once = if is_small(n) { most } else { at_once };
    let (mut known, mut first, mut made) = (None::<(Bordered<1, f32>, Vec<Short>)>, None, 0);
    loop {
        let mut r = fields.take(n)?;
        fields::fill(&threads, &mut r, |i| {
            let solved =
                known.as_ref().map_or(0.0, |(y, product)| system.row(i, y.field[i][0].into(), product[i][0].into()));
            [right(system, i) - solved]
        });
        let norm = fields::dot(&threads, &r, &r).sqrt();
        let target = part * *first.get_or_insert(norm);
        let until = Until { target, most: at_once.min(most - made) };
        let found = fgmres::solve(system, Bordered { field: r, border: [0.0] }, (until, 0.0), &threads, fields)?;
        let is_solved = found.left * norm <= SLACK * target;
        made += found.count.max(1);
        let (mut y, mut product) = match known {
            Some(known) => known,
            None => (Bordered { field: fields.zeros(n, &threads)?, border: [0.0] }, fields.zeros(n, &threads)?),
        };
        found.add_to(&mut y, &mut product, &threads, fields);
        if is_solved || made >= most {
            return Ok(Solution { y: y.field, product, is_solved });
        }
        known = Some((y, product));
    }
}
