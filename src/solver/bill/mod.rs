//! The bill of effects: how much each quantity changes if an effect is left out, what that saves, and a verdict on whether the effect is needed.
//!
//! The scene is solved on small grids, as it is and without each of its effects. On a sequence of finer grids, the differences of a change give the
//! error of the change (module `quantities`). Pairs of effects are left out as well, because the change without two effects is not the sum of the
//! changes without each.

mod asked;
mod effort;
mod neglect;
mod omission;
mod small_grids;
mod verdict;

pub use asked::BillOptions;
pub use neglect::Neglected;
pub use omission::Omission;
pub use verdict::{BillRow, Verdict};

use super::quantities::Quantity;
use super::{Options, Outcome, ProgressCallback};
use crate::error::Result;
use crate::scene::Scene;
use small_grids::SmallGrids;

/// Makes the bill of a scene: one row for each omission and for each pair of omissions, and for each of the quantities `wanted`. A scene without
/// effects has no rows. Returns the outcome as well:
///
/// - ITERATION_LIMIT: a solve on the last grid ended at `max_cycles`. Rows that need this solve have no change (`Lack::Unsolved`).
/// - CANCELLED: `progress` cancelled. Rows have the results of the last grid that was solved.
/// - CONVERGED: otherwise.
///
/// # Errors
/// Those of the scene. `Unsupported`: the caller's influence coefficients, tractions kept by a handle, or a given contact area.
pub fn effects_bill(
    scene: &Scene<'_>,
    options: &Options,
    asked: &BillOptions,
    wanted: &[Quantity],
    progress: Option<ProgressCallback<'_>>,
) -> Result<(Outcome, Vec<BillRow>)> {
    small_grids::check(scene, options, asked)?;
    let left_out = Omission::left_out_of(scene, asked.pairs);
    let mut grids = SmallGrids::new(scene, options, asked, wanted, left_out);
    let outcome = grids.solve(progress)?;
    Ok((outcome, grids.rows()))
}
