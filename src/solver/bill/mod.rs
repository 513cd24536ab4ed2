//! The bill of effects: how much each quantity changes without an effect, what leaving it out saves, and whether that is allowed.
//!
//! The scene is solved on small grids, as it is and without each of its effects. What a quantity changes by on grids of twice the elements
//! tells the error of the change (module `quantities`). Pairs are left out, too: leaving out two is not the sum of leaving out each.

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
/// ITERATION_LIMIT, CANCELLED: `progress` said so; rows have what was known then.
///
/// # Errors
/// Those of the scene; `Unsupported`: own coefficients, tractions that a handle keeps, a contact area that is fixed.
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
