//! The ledger of quantities: their values on the scene's grid and on coarser grids, with their errors.

use std::time::Instant;

use super::{values, Course, Lack, Quantity, Value};
use crate::error::Result;
use crate::grid::Grid;
use crate::scene::{scaled, Regridded, Scene};
use crate::solver::{Asked, Options, Outcome, Progress, ProgressCallback, Report, Solver};

/// The value and the error of one quantity on one grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuantityRow {
    /// The quantity.
    pub quantity: Quantity,
    /// The grid.
    pub grid: Grid,
    /// The value; None if there is none.
    pub value: Option<f64>,
    /// The estimated error of the value, in its unit; None if unknown.
    pub error: Option<f64>,
    /// Why value or error is unknown; None if both are known.
    pub lack: Option<Lack>,
    /// Seconds of set-up and solve on this grid, the same for all quantities. Computations of stresses and of the stiffness are not included.
    pub seconds: f64,
    /// Products of the solve on this grid, in work units.
    pub work_units: f64,
}

/// The solve on one grid, and the values of quantities.
pub struct OnGrid {
    /// The grid.
    pub grid: Grid,
    /// The outcome of the solve.
    pub outcome: Outcome,
    /// The value of each wanted quantity, or why there is none.
    pub values: Vec<std::result::Result<Value, Lack>>,
    /// The error of each wanted quantity, as estimated from this grid alone.
    pub estimates: Vec<Option<f64>>,
    /// Whether the solve converged without contact or attraction.
    pub is_apart: bool,
    /// Whether a single grid has no estimates in this scene: elements are at their pressure limit, or bodies attract.
    pub lacks_estimates: bool,
    /// The larger of the relative residuals of the normal and the tangential problem.
    pub residual: f64,
    /// Seconds of set-up and solve.
    pub seconds: f64,
    /// Seconds of the set-up, which `seconds` contain.
    pub setup_seconds: f64,
    /// Products of the normal and the tangential problem, in work units.
    pub work_units: f64,
    /// Products of the tangential problem, which `work_units` contain.
    pub tangential: f64,
    /// Bytes of the grid's solver.
    pub bytes: u64,
}

impl OnGrid {
    /// Solves a scene on its grid, and computes the wanted values.
    pub fn solve(
        scene: &Scene<'_>,
        options: &Options,
        wanted: &[Quantity],
        mut progress: Option<ProgressCallback<'_>>,
    ) -> Result<OnGrid> {
        let began = Instant::now();
        let mut watch = |told: &Progress| progress.as_mut().is_some_and(|progress| progress(told));
        let (mut solver, lowest) = Solver::for_scene(scene, options)?;
        let (mut outcome, report) = solver.solve_checked(Asked::new((scene, lowest), options), Some(&mut watch))?;
        let seconds = began.elapsed().as_secs_f64();
        let values = match outcome {
            Outcome::Converged => values(&mut solver, scene, &report, wanted, &mut watch)?,
            _ => Some(vec![Err(Lack::Unsolved); wanted.len()]),
        };
        let values = values.unwrap_or_else(|| {
            outcome = Outcome::Cancelled;
            vec![Err(Lack::Unsolved); wanted.len()]
        });
        Ok(OnGrid {
            grid: scene.grid,
            outcome,
            values,
            estimates: wanted.iter().map(|quantity| estimate(&report, *quantity)).collect(),
            is_apart: outcome == Outcome::Converged && report.measures.is_apart(),
            lacks_estimates: solver.lacks_estimates(),
            residual: report.residual(),
            seconds,
            setup_seconds: report.setup_seconds + report.coarse_seconds,
            work_units: report.count.work_units + report.tangential_products(),
            tangential: report.tangential_products(),
            bytes: report.bytes,
        })
    }

    /// The record of a grid on which the scene is refused: `wanted` quantities without values.
    fn refused(grid: Grid, wanted: usize) -> OnGrid {
        OnGrid {
            grid,
            outcome: Outcome::Stagnated,
            values: vec![Err(Lack::Unsolved); wanted],
            estimates: vec![None; wanted],
            is_apart: false,
            lacks_estimates: true,
            residual: 0.0,
            seconds: 0.0,
            setup_seconds: 0.0,
            work_units: 0.0,
            tangential: 0.0,
            bytes: 0,
        }
    }

    /// Whether the elements resolve the peak of the pressure: the largest pressure has an estimate. Also true if it is not wanted, or if nothing has
    /// estimates.
    pub fn has_peak(&self, wanted: &[Quantity]) -> bool {
        let index = wanted.iter().position(|quantity| *quantity == Quantity::MaxPressure);
        self.lacks_estimates || index.is_none_or(|index| self.estimates[index].is_some())
    }
}

/// The estimated error of a quantity in a report; None if it has none.
fn estimate(report: &Report, quantity: Quantity) -> Option<f64> {
    match quantity {
        Quantity::Force => report.error.force,
        Quantity::MaxPressure => report.error.max_pressure,
        Quantity::ContactArea => report.error.corrected_area,
        _ => None,
    }
}

/// Computes the values of the `wanted` quantities and their errors, on the grid of the scene and on a number `coarser` of coarser grids. Each of
/// these has half the elements of the next finer one in both directions. Each grid is solved without a guess. Returns one row for each grid and
/// quantity, coarsest grid first, and the outcome on the grid of the scene.
///
/// - Errors of force, largest pressure and area are the estimates of the report. All other errors follow from the values on this grid and coarser
///   ones (module `sequence`); on the coarsest grid they are unknown.
/// - If there is no contact on the grid of the scene, values of 0 are exact. Otherwise a value of 0 on a coarser grid without contact has no known
///   error.
///
/// # Errors
/// Those of a solve on the grid of the scene. `Unsupported`: the caller's influence coefficients, kept tractions, or a given contact area. If the
/// scene is refused on a coarser grid, this is no error: the rows of that grid have no values.
pub fn quantities(
    scene: &Scene<'_>,
    options: &Options,
    wanted: &[Quantity],
    coarser: usize,
    mut progress: Option<ProgressCallback<'_>>,
) -> Result<(Outcome, Vec<QuantityRow>)> {
    options.check_several_grids()?;
    scene.check(&crate::threads::Threads::One)?;
    let options = Options { estimates: true, ..*options };
    let mut courses: Vec<Course> = wanted.iter().map(|quantity| Course::of(*quantity, scene)).collect();
    let (mut rows, mut worst, mut before, mut is_apart) = (Vec::new(), Outcome::Converged, None, false);
    for doublings in -(coarser as i32)..=0 {
        let grid = scaled(scene, doublings)?;
        // At one element in both directions halving gives the same grid again.
        if before == Some(grid) {
            continue;
        }
        before = Some(grid);
        let regridded = (doublings < 0).then(|| Regridded::new(scene, grid, None)).transpose()?;
        let on_this = regridded.as_ref().map_or_else(|| scene.clone(), |regridded| regridded.scene(scene));
        let watch = progress.as_mut().map(|progress| &mut **progress as ProgressCallback<'_>);
        let found = match OnGrid::solve(&on_this, &options, wanted, watch) {
            // Only the refusal of the scene's own grid is an error.
            Err(_) if doublings < 0 => OnGrid::refused(grid, wanted.len()),
            found => found?,
        };
        if found.outcome == Outcome::Cancelled {
            return Ok((Outcome::Cancelled, rows));
        }
        if doublings == 0 {
            (worst, is_apart) = (found.outcome, found.is_apart);
        }
        for (k, course) in courses.iter_mut().enumerate() {
            rows.push(row(k, &found, doublings, course));
        }
    }
    let is_exact = |row: &&mut QuantityRow| is_apart && row.value == Some(0.0) && row.lack == Some(Lack::NoContact);
    rows.iter_mut().filter(is_exact).for_each(|row| (row.error, row.lack) = (Some(0.0), None));
    Ok((worst, rows))
}

/// Adds the value of quantity number k on a grid to its course, and makes the row.
fn row(k: usize, found: &OnGrid, doublings: i32, course: &mut Course) -> QuantityRow {
    let value = found.values[k].ok();
    if let Some(value) = value {
        course.add(doublings, value, found.residual);
    }
    let of_sequence = value.and_then(|_| course.error(found.lacks_estimates)).map(|error| error.now());
    // Finer grids may have contact, so the error of such a 0 is unknown here.
    let is_zero = found.is_apart && value.is_some_and(|value| value.value == 0.0);
    let error = value.and(found.estimates[k]).or(of_sequence).filter(|_| !is_zero);
    let lack = match (found.values[k], error) {
        (Err(lack), _) => Some(lack),
        (Ok(_), None) if is_zero => Some(Lack::NoContact),
        (Ok(_), Some(_)) => None,
        (Ok(_), None) if course.len() < 2 + usize::from(found.lacks_estimates) => Some(Lack::OneGrid),
        (Ok(_), None) if course.is_empty() => Some(Lack::Unsettled),
        // Forces, pressures and areas without an estimate are singular or not resolved.
        (Ok(_), None) if course.tells_singular() || course.quantity().has_estimate() => Some(Lack::Singular),
        (Ok(_), None) => Some(Lack::Unsettled),
    };
    let (quantity, value) = (course.quantity(), value.map(|value| value.value));
    QuantityRow { quantity, grid: found.grid, value, error, lack, seconds: found.seconds, work_units: found.work_units }
}
