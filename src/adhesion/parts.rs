//! Linear systems without a border, solved to small residuals. On large grids GMRES restarts with the remaining residual as the right-hand side, so that
//! few directions are kept at a time.

use super::system::{Linearised, Short};
use super::unknowns::is_small;
use crate::error::Result;
use crate::methods::fgmres::{self, Bordered, Until};
use crate::methods::fields::{self, Fields};

/// Factor on the target for round-off: a system with a residual of at most this times the target counts as solved.
const SLACK: f64 = 1.0 + 1e-6;

/// The accuracy and the cost of a solve.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// The target: the relative residual at which a solve ends.
    pub part: f64,
    /// Most directions.
    pub most: usize,
    /// Most kept directions on a large grid, after which the solve restarts.
    pub at_once: usize,
}

/// A solution, and its product with A in units of a0.
pub struct Solution {
    pub y: Vec<Short>,
    pub product: Vec<Short>,
    /// Whether the target is reached.
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
