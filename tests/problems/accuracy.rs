//! The promises about accuracy, tested on surfaces with exact solutions. The estimates were developed with some of these surfaces (`studied`); the
//! others had no part in it (`held_back`). Every solve counts. `make accuracy` prints the same for more random seeds.

use contact_normal::grid::Grid;
use contact_normal::scene::{Load, Scene};
use contact_normal::solver::{cost_of_accuracy, solve_to_accuracy, Accuracy, Obstacle, Options, Outcome, Quantity};

use crate::judge::{self, estimates, prices, searches, QUANTITIES, TARGETS};
use crate::random::Random;
use crate::surfaces::{held_back, studied, Surface, BODIES};

const SIZES: [usize; 4] = [64, 100, 128, 200];
/// Grids with few elements across the contact. A quantity is judged only on those grids that have enough elements for it.
const COARSE: [usize; 4] = [16, 24, 32, 48];

/// Asserts for each surface: at most 5 % of the estimates are below 0.3 of the true error, at most 10 % are unknown, and infinite peaks have no
/// estimate. Only the peak of a cusp (r^1.5) may be unknown more often, because its pressure is nearly singular.
fn assert_estimates_hold(surfaces: judge::Surfaces, families: usize) {
    for ((quantity, family), estimates) in estimates(surfaces, 0..2, &COARSE) {
        let what = format!("{} of {family}, few elements: {estimates:?}", QUANTITIES[quantity]);
        // The estimate of a peak that these grids do not resolve is unknown.
        assert!(estimates.low() <= 0.05, "{what}");
        assert_eq!(estimates.trusted_infinite, 0, "{what}");
    }
    let found = estimates(surfaces, 0..2, &SIZES);
    assert_eq!(found.len(), QUANTITIES.len() * families);
    for ((quantity, family), estimates) in found {
        let what = format!("{} of {family}: {estimates:?}", QUANTITIES[quantity]);
        // All quantities have enough elements across, except for the areas of a few contacts.
        assert!(estimates.runs >= 2 * 2, "{what}");
        assert!(estimates.low() <= 0.05, "{what}");
        assert!(estimates.unknown() <= 0.1 || family == "r^1.5" && quantity == 1, "{what}");
        assert_eq!(estimates.trusted_infinite, 0, "{what}");
    }
}

#[test]
fn estimates_hold_on_the_surfaces_they_were_measured_by() {
    assert_estimates_hold(studied, 13);
}

#[test]
fn estimates_hold_on_surfaces_that_nothing_was_chosen_by() {
    assert_estimates_hold(held_back, 10);
}

/// Asserts for the searches: of the results with status OK at most 2 % miss the target, and none by more than a factor of 1.5. At least 80 % are
/// within one doubling of the cheapest grid that is safe, and all have 6 elements across. Only a flat punch, whose error is of first order, may need
/// more elements than allowed. No search stagnates.
fn assert_searches_hold(surfaces: judge::Surfaces, families: usize) {
    let all = searches(surfaces, 1..2);
    assert_eq!(all.len(), families * 2 * TARGETS.len());
    let (mut missed, mut ratios) = (0, Vec::new());
    for search in &all {
        let what = format!("{} by force: {}, {:e}: {}", search.family, search.by_force, search.target, search.reason);
        if search.stop != Outcome::Converged {
            assert!(search.stop == Outcome::IterationLimit && search.family.starts_with("flat punch"), "{what}");
            continue;
        }
        assert!(search.miss <= 1.5, "{what}: {} of the target", search.miss);
        missed += usize::from(search.miss > 1.0);
        let endless = search.family.contains("wave");
        assert!(search.across.0 >= 6 && (endless || search.across.1 >= 6), "{what}: {:?}", search.across);
        ratios.extend(search.cheapest.map(|cheapest| search.elements as f64 / cheapest as f64));
    }
    ratios.sort_by(f64::total_cmp);
    assert!(50 * missed <= all.len(), "{missed} of {}", all.len());
    // The cheapest safe grid is known for at least 80 % of the searches.
    assert!(10 * ratios.len() >= 8 * all.len(), "{} of {}", ratios.len(), all.len());
    let near = ratios.iter().filter(|ratio| **ratio <= 4.0).count();
    assert!(10 * near >= 8 * ratios.len() && ratios[ratios.len() / 2] <= 4.0, "{ratios:?}");
}

#[test]
fn accuracies_are_kept_on_the_surfaces_estimates_were_measured_by() {
    assert_searches_hold(studied, 13);
}

#[test]
fn accuracies_are_kept_on_surfaces_that_nothing_was_chosen_by() {
    assert_searches_hold(held_back, 10);
}

/// The studied surface of this name.
fn surface(name: &str) -> Surface {
    let all = studied(&mut Random::new(3));
    all.into_iter().find(|surface| surface.family == name).expect("the surface")
}

fn outcome_of(surface: &Surface, accuracy: &Accuracy) -> contact_normal::solver::Refinement {
    let scene = surface.scene(surface.grid(16), &[], false);
    let mut write = |grid: &Grid, h: &mut [f64]| {
        surface.write(grid, h);
        false
    };
    solve_to_accuracy(&scene, &Options::default(), accuracy, Some(&mut write), None).expect("a solvable scene")
}

#[test]
fn targets_of_the_largest_pressure_and_the_area_are_kept() {
    for name in ["r^2", "r^4", "rotated ellipse"] {
        let surface = surface(name);
        let asked = Accuracy::new(1e-2).with(Quantity::MaxPressure, 3e-4).with(Quantity::ContactArea, 3e-3);
        let outcome = outcome_of(&surface, &asked);
        assert_eq!(outcome.stop, Outcome::Converged, "{name}: {}", outcome.reason);
        let measures = outcome.report.measures;
        let off = |found: f64, exact: f64| (found / exact - 1.0).abs();
        let peak = surface.max_pressure.expect("a finite peak");
        assert!(off(measures.max_pressure, peak) <= 3e-4, "{name}: {}", off(measures.max_pressure, peak));
        assert!(
            off(measures.corrected_area, surface.area) <= 3e-3,
            "{name}: {}",
            off(measures.corrected_area, surface.area)
        );
        // An accuracy of the force alone needs fewer elements.
        let alone = outcome_of(&surface, &Accuracy::new(1e-2));
        assert!(
            alone.solver.expect("a result").grid().len() < outcome.solver.expect("a result").grid().len(),
            "{name}"
        );
    }
    let cone = outcome_of(&surface("cone"), &Accuracy::new(1e-2).with(Quantity::MaxPressure, 1e-2));
    assert_eq!(cone.stop, Outcome::Stagnated, "{}", cone.reason);
    assert!(cone.reason.contains("estimate"), "{}", cone.reason);
}

/// At least 85 % of the rows of price lists name a grid within one doubling of the cheapest safe one. At most 2 % name a grid whose true error
/// exceeds the target.
#[test]
fn prices_name_the_grid_that_does() {
    let (mut rows, mut near, mut beyond) = (0, 0, 0);
    for surfaces in [studied as judge::Surfaces, held_back] {
        for paid in prices(surfaces, 1..2, 512) {
            let what = format!("{} by force: {}, {:?}", paid.family, paid.by_force, paid.price);
            if paid.price.obstacle.is_some() {
                assert!(paid.family.starts_with("flat punch"), "{what}");
                assert_eq!(paid.price.obstacle, Some(Obstacle::Elements), "{what}");
                continue;
            }
            assert!(
                paid.price.error.is_some_and(|error| error <= 1.2 * paid.price.target)
                    && paid.price.tolerance <= 0.1 * paid.price.target,
                "{what}"
            );
            assert!(paid.price.seconds > Some(0.0) && paid.price.seconds_one_thread >= paid.price.seconds, "{what}");
            assert!(paid.price.bytes > 8 * paid.price.grid.expect("a grid").len() as u64, "{what}");
            if let (k, Some(cheapest)) = paid.doublings {
                rows += 1;
                near += usize::from((k - cheapest as i32).abs() <= 1);
            }
            beyond += usize::from(paid.error > paid.price.target);
        }
    }
    println!("{rows} rows, {near} within one doubling, {beyond} beyond their target");
    assert!(100 * near >= 85 * rows && rows > 100, "{near} of {rows}");
    assert!(50 * beyond <= rows, "{beyond} of {rows}");
}

#[test]
fn what_is_not_to_be_had_is_said() {
    let list = |surface: &Surface, accuracy: Accuracy, quantity: Quantity, targets: &[f64]| {
        let scene = surface.scene(surface.grid(16), &[], false);
        let mut write = |grid: &Grid, h: &mut [f64]| {
            surface.write(grid, h);
            false
        };
        let wanted = (quantity, targets);
        cost_of_accuracy(&scene, &Options::default(), &accuracy, wanted, Some(&mut write), None)
            .expect("a price list")
            .1
    };
    let none = Accuracy::new(1.0);
    let cone = list(&surface("cone"), none, Quantity::MaxPressure, &[1e-2]);
    assert_eq!((cone[0].obstacle, cone[0].grid), (Some(Obstacle::Singular), None));
    let rows = list(&surface("r^2"), none, Quantity::Force, &[1e-15, 1e-3]);
    assert_eq!((rows[0].obstacle, rows[1].obstacle), (Some(Obstacle::RoundOff), None));
    // How many sample grids are solved, and so which grid is named, depends on the clock. The limits are below those of any grid.
    let (bytes, elements) = (8 * 16 * 16, 16 * 16);
    for (accuracy, obstacle) in [
        (Accuracy { max_bytes: bytes, ..none }, Obstacle::Memory),
        (Accuracy { max_elements: elements, ..none }, Obstacle::Elements),
        (Accuracy { max_seconds: 1e-9, ..none }, Obstacle::Time),
    ] {
        let row = list(&surface("r^2"), accuracy, Quantity::Force, &[1e-3])[0];
        assert_eq!(row.obstacle, Some(obstacle), "{row:?}");
        // A row with an obstacle still has the grid and its costs.
        let grid = row.grid.expect("a grid");
        assert!(row.seconds > Some(0.0) && row.bytes > bytes && grid.len() as u64 > elements, "{row:?}");
    }
}

/// Without a surface callback the price list takes coarser grids from the array. With one, the callback may cancel the list.
#[test]
fn a_price_list_needs_no_callback_and_obeys_one() {
    let surface = surface("r^2");
    let grid = surface.grid(256);
    let h = surface.distance(&grid);
    let scene = Scene::new(grid, &h, BODIES, Load::Approach(surface.approach));
    let wanted = (Quantity::Force, &TARGETS[..]);
    let list = |surface| cost_of_accuracy(&scene, &Options::default(), &Accuracy::new(1.0), wanted, surface, None);
    let (_, from_array) = list(None).expect("a price list");
    let mut write = |grid: &Grid, h: &mut [f64]| {
        surface.write(grid, h);
        false
    };
    let (_, from_callback) = list(Some(&mut write)).expect("a price list");
    // The means of the array on coarser grids are a little above the surface, so that an estimate near its target may fall on either side.
    for (array, callback) in from_array.iter().zip(&from_callback) {
        let [array, callback] = [array, callback].map(|row| row.grid.expect("a grid").mx);
        assert!(array <= 2 * callback && callback <= 2 * array, "{array} {callback}");
    }
    let mut cancels = |_: &Grid, _: &mut [f64]| true;
    let (stop, rows) = list(Some(&mut cancels)).expect("rows");
    assert_eq!((stop, rows.len(), rows[0].grid), (Outcome::Cancelled, TARGETS.len(), None));
}

/// If the list itself has solved the grid of a row, the row has the products of that solve. This includes direct solves, which report a residual only
/// at their end.
#[test]
fn a_row_has_the_products_of_its_grid() {
    let grid = Grid::new(16, 16, 1.0 / 16.0, 1.0 / 16.0).expect("a grid");
    let place = |k: usize| (k as f64 + 0.5) / 16.0 - 0.5;
    let mut on_this_grid = 0;
    for flat in [0.0, 0.005, 0.02] {
        let of = |x: f64, y: f64| f64::max(x * x + 1.5 * y * y - flat, 0.0);
        let h: Vec<f64> = (0..256).map(|i| of(place(i % 16), place(i / 16))).collect();
        for load in [Load::Approach(0.12), Load::Approach(0.15), Load::Force(0.05)] {
            let scene = Scene::new(grid, &h, BODIES, load);
            let options = Options { threads: 1, ..Options::default() };
            let wanted = (Quantity::Force, &[1e-2][..]);
            let (_, rows) =
                cost_of_accuracy(&scene, &options, &Accuracy::new(1e-2), wanted, None, None).expect("a price list");
            if rows[0].grid.is_none_or(|found| found.mx != 16) {
                continue;
            }
            on_this_grid += 1;
            let options = Options { tolerance: rows[0].tolerance, ..options };
            let counted = contact_normal::solver::solve(&scene, &options).expect("a solve").2.count.work_units;
            assert_eq!(rows[0].work_units, counted, "{flat} {load:?}");
        }
    }
    assert!(on_this_grid >= 4, "{on_this_grid}");
}
