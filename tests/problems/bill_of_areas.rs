//! A contact area whose change does not show on small grids, because no element enters or leaves the contact there. On the scene's grid some elements
//! do.

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Friction, Layer, Load, Motion, Prescribed, Scene};
use contact_normal::solver::{effects_bill, quantities, BillOptions, Omission, Options, Quantity, Verdict};

const M: usize = 256;
const TARGET: f64 = 1e-2;

/// On small grids the layer changes no bit of the area, on the scene's grid it changes the area by 2.7 %. With more seconds the bill reaches the
/// scene's grid, with fewer it solves one small grid only. In neither case may it call the layer negligible.
#[test]
fn an_area_that_no_element_of_small_grids_changes_is_not_decided() {
    let grid = Grid::new(M, M, 1.0 / M as f64, 1.0 / M as f64).expect("a grid");
    let place = |k: usize| (k as f64 + 0.5) / M as f64 - 0.5;
    let of = |x: f64, y: f64| 1.28 * (x + 0.015).powi(2) + 1.0625 * (y + 0.0211).powi(2);
    let h: Vec<f64> = (0..M * M).map(|i| of(place(i % M), place(i / M))).collect();
    let bodies = Bodies { shear_modulus: [0.5, 0.7445], poisson_ratio: [0.3, 0.3] };
    let prescribed = [Prescribed::Creepage(0.0037), Prescribed::Creepage(0.0)];
    let friction = Friction { prescribed, motion: Motion::SteadyRolling, spin: 2.6e-4, ..Friction::new(0.3) };
    let plain = Scene::new(grid, &h, bodies, Load::Force(0.0021468));
    let scene = Scene { layer: Some(Layer(Each::Uniform(0.0022278))), friction: Some(friction), ..plain.clone() };
    let asked = BillOptions { max_seconds: 0.1, ..BillOptions::new(TARGET) };
    let wanted = [Quantity::ContactArea];
    let (_, rows) = effects_bill(&scene, &Options::default(), &asked, &wanted, None).expect("a bill");
    let of_layer = rows.iter().find(|row| row.omission == Omission::Layer && row.other.is_none()).expect("a row");
    let area = |scene: &Scene<'_>| {
        let (_, rows) = quantities(scene, &Options::default(), &wanted, 0, None).expect("a solvable scene");
        rows[0].value.expect("an area")
    };
    // Here friction changes pressures by at most a thousandth.
    let (with, without) = (area(&Scene { friction: None, ..scene.clone() }), area(&plain));
    assert!((without / with - 1.0).abs() > 2.0 * TARGET, "{with} {without}");
    assert_ne!(of_layer.verdict, Verdict::Negligible, "{of_layer:?}");
}
