//! Quantities of a scene on its grid and on coarser ones, with their errors: the ledger of all quantities.

use std::time::Instant;

use super::{values, Course, Lack, Quantity, Value};
use crate::error::Result;
use crate::grid::Grid;
use crate::scene::{scaled, Regridded, Scene};
use crate::solver::{Asked, Options, Outcome, Progress, ProgressCallback, Report, Solver};

/// One quantity on one grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuantityRow {
    /// The quantity.
    pub quantity: Quantity,
    /// The grid.
    pub grid: Grid,
    /// The value, if there is one.
    pub value: Option<f64>,
    /// The error of the value, if known.
    pub error: Option<f64>,
    /// Why value or error is unknown.
    pub lack: Option<Lack>,
    /// Seconds of set-up and solve of the grid, the same for all its quantities; stresses and stiffness not included.
    pub seconds: f64,
    /// Products of the grid, in work units.
    pub work_units: f64,
}

/// A solved grid.
pub struct OnGrid {
    /// The grid.
    pub grid: Grid,
    /// The outcome of the solve.
    pub outcome: Outcome,
    /// The values of the wanted quantities, in their order.
    pub values: Vec<std::result::Result<Value, Lack>>,
    /// Errors from this grid alone.
    pub estimates: Vec<Option<f64>>,
    /// Whether nothing touches.
    pub is_apart: bool,
    /// Whether one such grid has no estimates: a limit is reached, or bodies attract.
    pub lacks_estimates: bool,
    /// The relative residual.
    pub residual: f64,
    /// Seconds, and the part of the set-up.
    pub seconds: f64,
    pub setup_seconds: f64,
    /// Products, in work units, and those of the tangential problem among them.
    pub work_units: f64,
    pub tangential: f64,
    /// Bytes of the grid's solver.
    pub bytes: u64,
}

impl OnGrid {
    /// Solves a scene and takes the values.
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

    /// A grid on which the scene is refused, without values.
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

    /// Whether the elements resolve the peak of the pressure, if there are estimates.
    pub fn has_peak(&self, wanted: &[Quantity]) -> bool {
        let at = wanted.iter().position(|quantity| *quantity == Quantity::MaxPressure);
        self.lacks_estimates || at.is_none_or(|at| self.estimates[at].is_some())
    }
}

/// The error of a quantity in a report.
fn estimate(report: &Report, quantity: Quantity) -> Option<f64> {
    match quantity {
        Quantity::Force => report.error.force,
        Quantity::MaxPressure => report.error.max_pressure,
        Quantity::ContactArea => report.error.corrected_area,
        _ => None,
    }
}

/// The values of `wanted` on the grid of the scene and on `coarser` grids, each with half the elements of the next in both directions. The coarsest
/// comes first, with one row for each grid and quantity. Each grid is solved without a guess. Errors of force, largest pressure and area are the
/// estimates of the report. All others follow from the coarser grids (module `sequence`); the coarsest grid has none. Values of 0 are exact if
/// nothing touches on the grid of the scene. Otherwise a value of 0 on a coarser grid where nothing touches has no known error.
///
/// # Errors
/// Those of a solve on the grid of the scene. `Unsupported`: own coefficients, kept tractions, and a fixed contact area. Rows of a coarser grid
/// that is refused have no values.
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
        // The grid cannot be coarsened any more.
        if before == Some(grid) {
            continue;
        }
        before = Some(grid);
        let regridded = (doublings < 0).then(|| Regridded::new(scene, grid, None)).transpose()?;
        let on_this = regridded.as_ref().map_or_else(|| scene.clone(), |regridded| regridded.scene(scene));
        let watch = progress.as_mut().map(|progress| &mut **progress as ProgressCallback<'_>);
        let found = match OnGrid::solve(&on_this, &options, wanted, watch) {
            // A coarser grid may be refused where the scene's is not.
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

fn row(k: usize, found: &OnGrid, doublings: i32, course: &mut Course) -> QuantityRow {
    let value = found.values[k].ok();
    if let Some(value) = value {
        course.add(doublings, value, found.residual);
    }
    let falling = value.and_then(|_| course.falling(found.lacks_estimates));
    let of_sequence = falling.map(|falling| falling.now());
    // If another grid has contact, the error of this 0 is unknown.
    let is_zero = found.is_apart && value.is_some_and(|value| value.value == 0.0);
    let error = value.and(found.estimates[k]).or(of_sequence).filter(|_| !is_zero);
    let lack = match (found.values[k], error) {
        (Err(lack), _) => Some(lack),
        (Ok(_), None) if is_zero => Some(Lack::NoContact),
        (Ok(_), Some(_)) => None,
        (Ok(_), None) if course.len() < 2 + usize::from(found.lacks_estimates) => Some(Lack::OneGrid),
        (Ok(_), None) if course.is_empty() => Some(Lack::Unsettled),
        // The report of one grid has no estimate.
        (Ok(_), None) if course.tells_singular() || course.quantity().has_estimate() => Some(Lack::Singular),
        (Ok(_), None) => Some(Lack::Unsettled),
    };
    let (quantity, value) = (course.quantity(), value.map(|value| value.value));
    QuantityRow { quantity, grid: found.grid, value, error, lack, seconds: found.seconds, work_units: found.work_units }
}
