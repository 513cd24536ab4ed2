//! The [extension](Extension) of residuals beyond C, which improves the preconditioner, on grids where it saves time.

use crate::error::Result;
use crate::grid::Grid;
use crate::methods::extension::Extension;
use crate::operator::fft::Real;
use crate::threads::Threads;

/// Sets up the extension on a grid; none if it would not save time there.
pub(super) fn extension_on<T: Real>(grid: &Grid, threads: &Threads) -> Result<Option<Extension<T, 2>>> {
    let mut extension = Extension::if_worthwhile(grid, threads)?;
    extension.iter_mut().for_each(Extension::wake);
    Ok(extension)
}

/// Tells an extension that C are the elements of positive `bound`.
pub(super) fn count_near<T: Real>(extension: &mut Option<Extension<T, 2>>, bound: &[f64]) {
    if let Some(extension) = extension {
        extension.count(bound, |g| g > 0.0, |_| true);
    }
}
