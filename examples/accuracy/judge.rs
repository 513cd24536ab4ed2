//! Compares the library's error estimates, searches for an accuracy and price lists with exact solutions. Every run is counted.

use std::collections::BTreeMap;

use contact_normal::grid::Grid;
use contact_normal::solver::{
    cost_of_accuracy, solve, solve_to_accuracy, Accuracy, Options, Outcome, Price, Quantity, Report, SurfaceCallback,
};

use super::random::Random;
use super::surfaces::Surface;

/// A function that returns the surfaces of one seed.
pub type Surfaces = fn(&mut Random) -> Vec<Surface>;

/// Wanted relative errors of the force or the approach.
pub const TARGETS: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Elements in a direction of the first grid of a search for an accuracy.
const START: usize = 16;
/// Doublings of the elements in a direction from the first grid to the finest one that is studied.
const DOUBLINGS: usize = 5;

/// All surfaces of some seeds, each once with a given approach (false) and once with a given force (true).
fn all(surfaces: Surfaces, seeds: std::ops::Range<u64>) -> impl Iterator<Item = (Surface, bool)> {
    let of_seed = move |seed| surfaces(&mut Random::new(seed));
    seeds.flat_map(move |seed| of_seed(seed).into_iter().zip(of_seed(seed))).flat_map(|(a, b)| [(a, false), (b, true)])
}

/// The estimated errors of one quantity on one family of surfaces.
#[derive(Debug, Default)]
pub struct Estimates {
    pub runs: usize,
    /// The number of runs without an estimate, although the exact value is finite.
    pub unknown: usize,
    /// The number of runs with an estimate, although the exact value is infinite.
    pub trusted_infinite: usize,
    /// The ratios of the estimated and the true error, sorted.
    pub ratios: Vec<f64>,
}

impl Estimates {
    fn count(&mut self, found: f64, exact: Option<f64>, error: Option<f64>) {
        self.runs += 1;
        match (exact, error) {
            (None, _) => self.trusted_infinite += usize::from(error.is_some()),
            (Some(_), None) => self.unknown += 1,
            (Some(exact), Some(error)) => self.ratios.push(error / (found - exact).abs().max(f64::MIN_POSITIVE)),
        }
    }

    /// The part of the runs whose estimated error is below 0.3 of the true one.
    pub fn low(&self) -> f64 {
        self.ratios.iter().filter(|ratio| **ratio < 0.3).count() as f64 / self.runs as f64
    }

    /// The part of the runs without an estimate.
    pub fn unknown(&self) -> f64 {
        self.unknown as f64 / self.runs as f64
    }

    /// A quantile of the ratios: `part` of them are smaller.
    pub fn quantile(&self, part: f64) -> f64 {
        let at = (part * (self.ratios.len() as f64 - 1.0)).round() as usize;
        self.ratios.get(at).copied().unwrap_or(f64::NAN)
    }
}

/// The quantities whose estimates are judged.
pub const QUANTITIES: [&str; 4] = ["force, approach", "largest pressure", "area", "corrected area"];

/// For each of these the quantity of the library that says how many elements across the contact its estimates need.
const BELIEVED_AS: [Quantity; 4] =
    [Quantity::Force, Quantity::MaxPressure, Quantity::ContactArea, Quantity::ContactArea];

/// Judges the estimates by quantity and family, on all grids that have enough elements across the contact for the quantity.
pub fn estimates(
    surfaces: Surfaces,
    seeds: std::ops::Range<u64>,
    sizes: &[usize],
) -> BTreeMap<(usize, &'static str), Estimates> {
    let mut found: BTreeMap<_, Estimates> = BTreeMap::new();
    let options = Options { tolerance: 1e-8, estimates: true, ..Options::default() };
    for (surface, by_force) in all(surfaces, seeds) {
        for &m in sizes {
            let (report, across) = solved_across(&surface, m, by_force, &options);
            let (value, error) = (report.measures, report.error);
            let exact = Some(surface.exact(by_force));
            let of_quantity = [
                (value.found(surface.load(by_force)), exact, error.force),
                (value.max_pressure, surface.max_pressure, error.max_pressure),
                (value.contact_area, Some(surface.area), error.contact_area),
                (value.corrected_area, Some(surface.area), error.corrected_area),
            ];
            for (quantity, (value, exact, error)) in of_quantity.into_iter().enumerate() {
                if across < BELIEVED_AS[quantity].enough_across() {
                    continue;
                }
                found.entry((quantity, surface.family)).or_default().count(value, exact, error);
            }
        }
    }
    found.values_mut().for_each(|estimates| estimates.ratios.sort_by(f64::total_cmp));
    found
}

fn solved(surface: &Surface, m: usize, by_force: bool, options: &Options) -> Report {
    solved_across(surface, m, by_force, options).0
}

/// Solves a surface on a grid. Returns the report, and the elements across the contact in the direction with fewer (of a wave: along it).
fn solved_across(surface: &Surface, m: usize, by_force: bool, options: &Options) -> (Report, usize) {
    let grid = surface.grid(m);
    let h = surface.distance(&grid);
    let (solver, stop, report) = solve(&surface.scene(grid, &h, by_force), options).expect("a solvable scene");
    assert_eq!(stop, Outcome::Converged, "{} {m}", surface.family);
    let (x, y) = spans(&solver.state().contact, &grid);
    (report, if surface.period.is_some() { x } else { x.min(y) })
}

/// The true relative errors of the force or the approach on the first grid of a search and on finer ones.
fn true_errors(surface: &Surface, by_force: bool) -> Vec<f64> {
    let options = Options { tolerance: 1e-8, ..Options::default() };
    let on = |k: usize| {
        let found = solved(surface, START << k, by_force, &options).measures.found(surface.load(by_force));
        (found / surface.exact(by_force) - 1.0).abs()
    };
    (0..=DOUBLINGS).map(on).collect()
}

/// The number of doublings of the coarsest grid with an error below the target on this and all finer grids; None if no studied grid is so.
fn cheapest_safe(errors: &[f64], target: f64) -> Option<usize> {
    (0..errors.len()).find(|k| errors[*k..].iter().all(|error| *error <= target))
}

/// The result of a search for an accuracy.
pub struct Search {
    pub family: &'static str,
    pub by_force: bool,
    pub target: f64,
    pub stop: Outcome,
    /// The true error over the target.
    pub miss: f64,
    /// The number of columns and of rows with contact.
    pub across: (usize, usize),
    pub elements: usize,
    /// The elements of the cheapest safe grid: no error on this and finer grids is above the target. None: it is finer than studied.
    pub cheapest: Option<usize>,
    pub reason: String,
}

/// Searches for all targets, beginning with grids of 16 elements in a direction.
pub fn searches(surfaces: Surfaces, seeds: std::ops::Range<u64>) -> Vec<Search> {
    let mut found = Vec::new();
    for (surface, by_force) in all(surfaces, seeds) {
        let errors = true_errors(&surface, by_force);
        let start = surface.grid(START);
        for target in TARGETS {
            let accuracy = Accuracy { max_elements: (surface.grid(1024).len() + 1) as u64, ..Accuracy::new(target) };
            let mut write = |grid: &Grid, h: &mut [f64]| {
                surface.write(grid, h);
                false
            };
            let scene = surface.scene(start, &[], by_force);
            let surface_callback: SurfaceCallback<'_> = &mut write;
            let outcome = solve_to_accuracy(&scene, &Options::default(), &accuracy, Some(surface_callback), None)
                .expect("a solvable scene");
            let solver = outcome.solver.as_ref().expect("a result");
            let value = outcome.report.measures.found(surface.load(by_force));
            let across = spans(&solver.state().contact, solver.grid());
            let cheapest = cheapest_safe(&errors, target);
            found.push(Search {
                family: surface.family,
                by_force,
                target,
                stop: outcome.stop,
                miss: (value / surface.exact(by_force) - 1.0).abs() / target,
                across,
                elements: solver.grid().len(),
                cheapest: cheapest.map(|k| start.len() << (2 * k)),
                reason: outcome.reason,
            });
        }
    }
    found
}

/// The number of columns and of rows with an element in contact.
fn spans(contact: &[bool], grid: &Grid) -> (usize, usize) {
    let columns = (0..grid.mx).filter(|x| (0..grid.my).any(|y| contact[grid.index(*x, y)])).count();
    (columns, contact.chunks(grid.mx).filter(|row| row.contains(&true)).count())
}

/// A row of a price list, and the true costs of its grid and tolerance.
pub struct Paid {
    pub family: &'static str,
    pub by_force: bool,
    pub price: Price,
    /// The number of doublings from the first grid to the grid of the price, and to the cheapest safe one, if that was studied.
    pub doublings: (i32, Option<usize>),
    /// The seconds of a solve on the grid of the price with its tolerance; negative: not solved, because there is no grid or it is too fine.
    pub seconds: f64,
    /// The true relative error of this solve.
    pub error: f64,
    /// The seconds that the price list itself took.
    pub list: f64,
}

/// Makes price lists, and solves each row of at most `most` columns to find its true costs.
pub fn prices(surfaces: Surfaces, seeds: std::ops::Range<u64>, most: usize) -> Vec<Paid> {
    let mut found = Vec::new();
    for (surface, by_force) in all(surfaces, seeds) {
        let errors = true_errors(&surface, by_force);
        let start = surface.grid(START);
        let mut write = |grid: &Grid, h: &mut [f64]| {
            surface.write(grid, h);
            false
        };
        let began = std::time::Instant::now();
        let wanted = (Quantity::Force, &TARGETS[..]);
        let scene = surface.scene(start, &[], by_force);
        let list = cost_of_accuracy(&scene, &Options::default(), &Accuracy::new(1.0), wanted, Some(&mut write), None)
            .expect("a price list")
            .1;
        let list_seconds = began.elapsed().as_secs_f64();
        for price in list {
            let columns = price.grid.map_or(0, |grid| grid.mx);
            let k = (columns.max(1) as f64 / start.mx as f64).log2().round() as i32;
            let (mut seconds, mut error) = (-1.0, f64::NAN);
            if price.obstacle.is_none() && columns <= most {
                let options = Options { tolerance: price.tolerance, threads: 1, ..Options::default() };
                // A price may name a grid that is coarser than the first one of a search.
                let elements = if k < 0 { START >> -k } else { START << k };
                let mut times = Vec::new();
                // The least of five times, as in the library's own samples: the time of a machine that does nothing else.
                for _ in 0..5 {
                    let began = std::time::Instant::now();
                    let report = solved(&surface, elements, by_force, &options);
                    times.push(began.elapsed().as_secs_f64());
                    error = (report.measures.found(surface.load(by_force)) / surface.exact(by_force) - 1.0).abs();
                }
                times.sort_by(f64::total_cmp);
                seconds = times[0];
            }
            let cheapest = cheapest_safe(&errors, price.target);
            found.push(Paid {
                family: surface.family,
                by_force,
                price,
                doublings: (k, cheapest),
                seconds,
                error,
                list: list_seconds,
            });
        }
    }
    found
}
