//! The small grids of a bill. On each grid the scene is solved as it is, and with each omission: these scenes are the variants.

use std::time::Instant;

use super::asked::BillOptions;
use super::effort::effort;
use super::omission::Omission;
use super::verdict::{self, BillRow, Measured, MOST_MOVED, STICK_MOVED};
use crate::effects;
use crate::error::{require, Error, Result};
use crate::grid::Grid;
use crate::scene::{scaled, Regridded, Scene};
use crate::solver::quantities::{Lack, OnGrid, Quantity, Sequence};
use crate::solver::refinement::LEAST_TOLERANCE;
use crate::solver::seconds::{seconds_on, Cost, GROWTH, NEXT_GRID_RATIO};
use crate::solver::{Options, Outcome, ProgressCallback};
use crate::threads::Threads;

/// The [effort] in ns that a bill may always take. It is less than the tenth of a second that a bill may take, because the effort is not exact.
const LEAST_EFFORT: f64 = 7e7;
/// The effort that a bill may take, relative to that of the scene on its own grid.
const EFFORT_SHARE: f64 = 0.05;
/// The first grid has at least this many elements in its longer direction, if the scene's grid has at least twice as many.
const FIRST_GRID: usize = 16;
/// Elements that enter or leave an area together: four with two planes of symmetry. Counts of elements do not resolve smaller changes.
const JUMP: f64 = 4.0;
/// Tolerance of the solves, relative to the target.
const TOLERANCE_PER_TARGET: f64 = 0.01;

/// Refuses scenes and options for which there is no bill.
pub fn check(scene: &Scene<'_>, options: &Options, asked: &BillOptions) -> Result<()> {
    options.check_several_grids()?;
    let (target, seconds) = (asked.target, asked.max_seconds);
    require(target > 0.0 && target < 1.0, "target", target, "it must lie between 0 and 1")?;
    let is_limit = seconds >= 0.0 && seconds.is_finite();
    require(is_limit, "max_seconds", seconds, "it must be positive, or 0 for the default")?;
    scene.check(&Threads::One)?;
    scene.check_area(None)?;
    effects::check_other_grids(scene)
}

/// The value of a quantity, or why there is none.
type Value = std::result::Result<f64, Lack>;

/// The scene with some omissions, or as it is, and its results.
pub struct Variant {
    /// What is left out; empty for the scene as it is.
    pub left_out: Vec<Omission>,
    /// The value of each wanted quantity on the last grid.
    pub values: Vec<Value>,
    /// The change of each wanted quantity from the scene as it is, grid by grid.
    pub changes: Vec<Sequence>,
    /// Whether the elements of the last grid resolve the peak of the pressure.
    has_peak: bool,
    /// The largest relative change, on the last grid, of quantities other than pressures, stresses, areas and the stiffness.
    moved: f64,
    /// The cost on each grid.
    costs: Vec<Cost>,
    /// The effort on the last grid; 0 if the variant was refused there.
    effort: f64,
    /// Predicted bytes on the scene's grid.
    bytes: f64,
}

/// The solve of a variant on a grid, and its effort. None: the variant was refused.
type Solved = Option<(OnGrid, f64)>;

/// The largest relative change from `as_it_is` to `without` of quantities other than pressures, stresses, areas and the stiffness. Infinite if there
/// are none.
fn moved(wanted: &[Quantity], without: &[Value], as_it_is: &[Value]) -> f64 {
    let is_smooth =
        |quantity: &Quantity| !quantity.is_local() && !quantity.is_area() && *quantity != Quantity::Stiffness;
    let change = |(quantity, (without, as_it_is)): (&Quantity, (&Value, &Value))| match (*without, *as_it_is) {
        (Ok(without), Ok(value)) if is_smooth(quantity) && value != 0.0 => Some(((without - value) / value).abs()),
        _ => None,
    };
    wanted.iter().zip(without.iter().zip(as_it_is)).filter_map(change).reduce(f64::max).unwrap_or(f64::INFINITY)
}

/// All variants, with their results on the grids so far.
pub struct SmallGrids<'s, 'a> {
    scene: &'s Scene<'a>,
    options: Options,
    asked: BillOptions,
    wanted: Vec<Quantity>,
    /// The variants; the first is the scene as it is.
    pub variants: Vec<Variant>,
    /// Elements of the scene's grid over those of the last grid.
    ratio: f64,
    /// ITERATION_LIMIT if a variant ended with it on the last grid.
    outcome: Outcome,
}

impl<'s, 'a> SmallGrids<'s, 'a> {
    /// The variants of a scene: as it is, and with each item of `left_out`. Nothing is solved yet.
    pub fn new(
        scene: &'s Scene<'a>,
        options: &Options,
        asked: &BillOptions,
        wanted: &[Quantity],
        left_out: Vec<Vec<Omission>>,
    ) -> SmallGrids<'s, 'a> {
        let least = options.tolerance.max(LEAST_TOLERANCE);
        let tolerance = (TOLERANCE_PER_TARGET * asked.target).clamp(LEAST_TOLERANCE, least);
        let options = Options { tolerance, threads: 1, estimates: true, ..*options };
        let variant = |left_out: Vec<Omission>| Variant {
            left_out,
            values: vec![Err(Lack::Unsolved); wanted.len()],
            changes: vec![Sequence::default(); wanted.len()],
            has_peak: true,
            moved: 0.0,
            costs: vec![],
            effort: 0.0,
            bytes: 0.0,
        };
        let variants = std::iter::once(vec![]).chain(left_out).map(variant).collect();
        SmallGrids {
            scene,
            options,
            asked: *asked,
            wanted: wanted.to_vec(),
            variants,
            ratio: 1.0,
            outcome: Outcome::Converged,
        }
    }

    /// Solves on finer and finer grids, until the time or the effort is used or the scene's own grid is reached. At least two grids are solved.
    pub fn solve(&mut self, mut progress: Option<ProgressCallback<'_>>) -> Result<Outcome> {
        let began = Instant::now();
        if self.variants.len() < 2 {
            return Ok(Outcome::Converged);
        }
        let elements = self.scene.grid.mx.max(self.scene.grid.my);
        // At least two grids, because a single one gives no errors.
        let first = -((elements / FIRST_GRID).max(2).ilog2() as i32);
        let mut spent = 0.0;
        for doublings in first..=0 {
            let entered = Instant::now();
            if !self.solve_on(doublings, &mut progress)? {
                return Ok(Outcome::Cancelled);
            }
            let effort: f64 = self.variants.iter().map(|variant| variant.effort).sum();
            spent += effort;
            let over = if self.asked.max_seconds > 0.0 {
                let next = entered.elapsed().as_secs_f64() * NEXT_GRID_RATIO;
                began.elapsed().as_secs_f64() + next > self.asked.max_seconds
            } else {
                let whole = self.variants[0].effort * self.ratio.powf(GROWTH);
                spent + NEXT_GRID_RATIO * effort > LEAST_EFFORT.max(EFFORT_SHARE * whole)
            };
            if doublings > first && over {
                break;
            }
        }
        Ok(self.outcome)
    }

    /// Solves all variants on one grid; false: cancelled. If a solve is cancelled, or the scene as it is is refused on a grid coarser than its own,
    /// the results remain those of the grid before.
    fn solve_on(&mut self, doublings: i32, progress: &mut Option<ProgressCallback<'_>>) -> Result<bool> {
        let grid = scaled(self.scene, doublings)?;
        let regridded = Regridded::new(self.scene, grid, None)?;
        let scene = regridded.scene(self.scene);
        let mut solved: Vec<Solved> = vec![];
        for (k, variant) in self.variants.iter().enumerate() {
            let without = variant.left_out.iter().fold(scene.clone(), |scene, omission| omission.leave_out(&scene));
            let watch = progress.as_mut().map(|progress| &mut **progress as ProgressCallback<'_>);
            match OnGrid::solve(&without, &self.options, &self.wanted, watch) {
                Ok(found) if found.outcome == Outcome::Cancelled => return Ok(false),
                Ok(found) => {
                    let effort = effort(&without, &found, &self.wanted);
                    solved.push(Some((found, effort)));
                }
                // This variant cannot be solved and has no values.
                Err(Error::Infeasible(_) | Error::Unsupported(_)) if k > 0 => solved.push(None),
                Err(_) if k > 0 && doublings < 0 => solved.push(None),
                // A grid coarser than the scene's may be refused; finer ones follow.
                Err(_) if doublings < 0 => return Ok(true),
                Err(error) => return Err(error),
            }
        }
        self.add((doublings, grid), solved);
        Ok(true)
    }

    /// Replaces the values and efforts of all variants by those of a new grid, and adds the changes and costs to the earlier ones.
    fn add(&mut self, (doublings, grid): (i32, Grid), solved: Vec<Solved>) {
        self.ratio = self.scene.grid.len() as f64 / grid.len() as f64;
        let is_cut_short =
            |solved: &Solved| solved.as_ref().is_some_and(|(on, _)| on.outcome == Outcome::IterationLimit);
        self.outcome = if solved.iter().any(is_cut_short) { Outcome::IterationLimit } else { Outcome::Converged };
        let mut as_it_is: Vec<Value> = vec![];
        for (k, (variant, solved)) in self.variants.iter_mut().zip(solved).enumerate() {
            variant.values.fill(Err(Lack::Unsolved));
            variant.effort = 0.0;
            let Some((found, effort)) = solved else { continue };
            let (seconds, setup) = (found.seconds, found.setup_seconds);
            variant.costs.push(Cost { elements: grid.len() as f64, seconds, setup, products: found.work_units });
            (variant.effort, variant.bytes) = (effort, found.bytes as f64 * self.ratio);
            variant.has_peak = found.has_peak(&self.wanted);
            // Without contact on a coarser grid, a value of 0 tells nothing: finer grids may have contact.
            let is_missed = |value: f64| value == 0.0 && found.is_apart && doublings < 0;
            for (q, quantity) in self.wanted.iter().enumerate() {
                let value = found.values[q].map(|found| found.value);
                let value = value.and_then(|value| if is_missed(value) { Err(Lack::NoContact) } else { Ok(value) });
                variant.values[q] = verdict::without(*quantity, &variant.left_out, value);
            }
            variant.moved = moved(&self.wanted, &variant.values, &as_it_is);
            for (q, quantity) in self.wanted.iter().enumerate() {
                if let (Ok(value), Some(Ok(before))) = (variant.values[q], as_it_is.get(q)) {
                    // The uncertainty of a change because areas, and stiffnesses of the contact area, change by whole elements: at most [`JUMP`]
                    // elements, and at most in proportion to the change of smooth quantities.
                    let (jump, most) = (JUMP * grid.element_area(), MOST_MOVED * variant.moved * before.abs());
                    let by_elements = match quantity {
                        // The scene's own grid defines the exact change.
                        _ if doublings >= 0 => 0.0,
                        // Near full slip the stick area changes far more than forces do. If it is empty here, finer grids may have a few elements of
                        // it.
                        Quantity::StickArea => {
                            jump.min(STICK_MOVED * variant.moved * before.abs().max(grid.element_area()))
                        }
                        Quantity::ContactArea => jump.min(most),
                        Quantity::Stiffness => {
                            most.min(before.abs() * found.values[q].map_or(0.0, |found| found.least))
                        }
                        _ => 0.0,
                    };
                    variant.changes[q].add(doublings, value - before, by_elements + found.residual * before.abs());
                }
            }
            if k == 0 {
                as_it_is = variant.values.clone();
            }
        }
    }

    /// The rows of the bill.
    pub fn rows(&self) -> Vec<BillRow> {
        let Some((as_it_is, variants)) = self.variants.split_first() else { return vec![] };
        let seconds = |variant: &Variant| seconds_on(&variant.costs, self.scene.grid.len() as f64);
        let seconds_as_it_is = seconds(as_it_is);
        let rows_of = |variant: &Variant| -> Vec<BillRow> {
            let seconds_without = seconds(variant);
            let row = |(q, quantity): (usize, &Quantity)| {
                let measured = Measured {
                    quantity: *quantity,
                    value: as_it_is.values[q],
                    without: variant.values[q],
                    change: &variant.changes[q],
                    on_own_grid: self.ratio == 1.0,
                    has_peaks: as_it_is.has_peak && variant.has_peak,
                    moved: variant.moved,
                };
                let seconds = [seconds_as_it_is, seconds_without];
                let bytes = [as_it_is.bytes, variant.bytes];
                measured.row(&variant.left_out, self.asked.target, seconds, bytes)
            };
            self.wanted.iter().enumerate().map(row).collect()
        };
        variants.iter().flat_map(rows_of).collect()
    }
}
