//! Bills of effects whose last grid is not solved, with all effects or without one of them. The bill must not report the change on a coarser grid
//! instead.

use contact_normal::grid::Grid;
use contact_normal::progress::Progress;
use contact_normal::scene::{Bodies, Each, Layer, Load, Scene};
use contact_normal::solver::{
    effects_bill, quantities, solve, BillOptions, Lack, Omission, Options, Outcome, Quantity, Verdict,
};

const M: usize = 64;
const D: f64 = 0.1;

/// A ball of radius 100 with a roughness of 0.02 between neighbours. Smaller grids average it: the force rises from grid to grid.
fn rough_ball() -> Vec<f64> {
    let at = |k: usize| (k as f64 - 0.5 * (M as f64 - 1.0)) * D;
    let rough = |i: usize| 0.02 * ((i * 7919) % 1009) as f64 / 1009.0;
    (0..M * M).map(|i| (at(i % M).powi(2) + at(i / M).powi(2)) / 200.0 + rough(i)).collect()
}

fn with_layer(h: &[f64]) -> Scene<'_> {
    let grid = Grid::new(M, M, D, D).expect("a grid");
    let plain = Scene::new(grid, h, Bodies::same(82000.0, 0.28), Load::Approach(0.05));
    Scene { layer: Some(Layer(Each::Uniform(2e-6))), ..plain }
}

/// A bill on all grids up to that of the scene.
fn asked(target: f64) -> BillOptions {
    BillOptions { max_seconds: 1e3, ..BillOptions::new(target) }
}

/// Ten cycles suffice on 64 x 64 elements with the layer, but not without it. On 16 x 16 elements they suffice in both cases, with a change of 759.7
/// of a force of 13235. On 64 x 64 elements the change is 1843.
#[test]
fn a_change_of_a_coarser_grid_is_no_change_of_the_last() {
    let h = rough_ball();
    let (scene, few) = (with_layer(&h), Options { max_cycles: 10, threads: 1, ..Options::default() });
    let outcome = |scene: &Scene<'_>| solve(scene, &few).expect("a scene").1;
    assert_eq!(outcome(&scene), Outcome::Converged);
    assert_eq!(outcome(&Omission::Layer.leave_out(&scene)), Outcome::IterationLimit);
    let wanted = [Quantity::Force, Quantity::ContactArea];
    for target in [6e-2, 1e-2] {
        let (stop, rows) = effects_bill(&scene, &few, &asked(target), &wanted, None).expect("a bill");
        assert_eq!((stop, rows.len()), (Outcome::IterationLimit, 2));
        for row in &rows {
            assert!(row.value.is_some_and(|value| value > 0.0), "{row:?}");
            assert_eq!((row.change, row.error, row.lack), (None, None, Some(Lack::Unsolved)), "{row:?}");
            assert_eq!(row.verdict, Verdict::NotDecided, "{row:?}");
        }
        let (stop, rows) = effects_bill(&scene, &Options::default(), &asked(target), &wanted, None).expect("a bill");
        let change = rows[0].change.expect("a change");
        assert!(stop == Outcome::Converged && (1800.0..1900.0).contains(&change), "{rows:?}");
    }
}

/// If a bill is cancelled on the scene's grid, after the solve with the layer, it reports the changes on the grid with half the elements in each
/// direction.
#[test]
fn a_cancelled_bill_is_that_of_the_grid_before() {
    let h = rough_ball();
    let scene = with_layer(&h);
    let (mut last, mut solves) = (f64::INFINITY, 0);
    let mut second = |told: &Progress| {
        if told.mx == M {
            solves += usize::from(told.work_units < last);
            last = told.work_units;
        }
        solves == 2
    };
    let (wanted, options) = ([Quantity::Force], Options::default());
    let (stop, rows) =
        effects_bill(&scene, &options, &asked(1e-2), &wanted, Some(&mut second)).expect("the rows so far");
    assert_eq!((stop, rows.len()), (Outcome::Cancelled, 1));
    let on_half = |scene: &Scene<'_>| {
        let (_, rows) = quantities(scene, &options, &wanted, 1, None).expect("a solvable scene");
        assert_eq!(rows[0].grid.mx, M / 2);
        rows[0].value.expect("a force")
    };
    let (with, without) = (on_half(&scene), on_half(&Omission::Layer.leave_out(&scene)));
    // The solves have a tolerance of 1e-6, of which 1e-4 is ample.
    assert!((rows[0].value.expect("a force") / with - 1.0).abs() < 1e-4, "{rows:?} {with}");
    assert!((rows[0].change.expect("a change") - (without - with)).abs() < 1e-4 * with, "{rows:?} {without}");
    // Bytes are predicted for the scene's grid, here from a grid with a quarter of the elements.
    let (_, whole) = effects_bill(&scene, &options, &asked(1e-2), &wanted, None).expect("a bill");
    let ratio = rows[0].bytes[0] / whole[0].bytes[0];
    assert!((0.6..1.6).contains(&ratio), "{ratio}");
}
