//! The bill of effects: the change of each quantity without an effect, the savings by leaving it out, and the verdict.
//!
//! The scene is solved on small grids, as it is and without each of its effects. The change from grid to grid gives the error of a change of a
//! quantity (module `quantities`). Pairs are left out as well: the change without two effects is not the sum of the changes without each.

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

/// The bill of a scene: for each omission, and for each pair, a row for each of the quantities `wanted`. A scene without effects has none.
/// ITERATION_LIMIT: a solve of the last grid ended at `max_cycles`, and the rows that need it have no change (`Lack::Unsolved`). CANCELLED (by
/// `progress`): rows have the results of the last grid that was solved.
///
/// # Errors
/// Those of the scene; `Unsupported`: own coefficients, tractions kept by a handle, a fixed contact area.
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
