//! Costs that the library counts instead of timing them: the grids of a bill of effects, and the products in price lists with friction.

use std::time::Duration;

use contact_normal::grid::Grid;
use contact_normal::progress::Progress;
use contact_normal::scene::{Bodies, Each, Friction, Layer, Load, Motion, Prescribed, Scene};
use contact_normal::solver::{
    cost_of_accuracy, effects_bill, solve, Accuracy, BillOptions, BillRow, Options, Quantity,
};

const ALIKE: Bodies = Bodies { shear_modulus: [0.5, 0.5], poisson_ratio: [0.3, 0.3] };
const UNLIKE: Bodies = Bodies { shear_modulus: [0.5, 0.9], poisson_ratio: [0.3, 0.25] };

fn grid(m: usize) -> Grid {
    Grid::new(m, m, 1.0 / m as f64, 1.0 / m as f64).expect("a grid")
}

fn paraboloid(grid: &Grid, h: &mut [f64]) {
    let at = |k: usize| (k as f64 + 0.5) * grid.dx - 0.5;
    for (i, h) in h.iter_mut().enumerate() {
        *h = 0.8 * at(i % grid.mx).powi(2) + 1.7 * at(i / grid.mx).powi(2);
    }
}

/// The bill has the same bits if each iteration takes 40 ms longer, as on a busy machine.
#[test]
fn a_bill_is_the_same_on_a_busy_machine() {
    let grid = grid(64);
    let mut h = vec![0.0; grid.len()];
    paraboloid(&grid, &mut h);
    let plain = Scene::new(grid, &h, ALIKE, Load::Approach(0.04));
    let scene = Scene { layer: Some(Layer(Each::Uniform(0.003))), ..plain };
    let of = |wait: u64| -> Vec<BillRow> {
        let mut progress = |_: &Progress| {
            std::thread::sleep(Duration::from_millis(wait));
            false
        };
        let wanted = [Quantity::Force, Quantity::MaxPressure, Quantity::ContactArea];
        effects_bill(&scene, &Options::default(), &BillOptions::new(1e-2), &wanted, Some(&mut progress))
            .expect("a bill")
            .1
    };
    let (idle, busy) = (of(0), of(40));
    assert_eq!(idle.len(), busy.len());
    for (idle, busy) in idle.iter().zip(&busy) {
        assert_eq!((idle.value, idle.change, idle.error), (busy.value, busy.change, busy.error), "{:?}", idle.quantity);
    }
}

/// A solve that gives the largest stress gives its depth, too. So a bill of both quantities chooses the grids of a bill of one, and has its values to
/// the last bit. With two different stresses the last grid would be 64 x 64 instead of 128 x 128.
#[test]
fn the_depth_of_a_largest_stress_costs_nothing_beside_it() {
    let grid = grid(128);
    let mut h = vec![0.0; grid.len()];
    paraboloid(&grid, &mut h);
    let plain = Scene::new(grid, &h, ALIKE, Load::Approach(0.04));
    let scene = Scene { layer: Some(Layer(Each::Uniform(0.003))), ..plain };
    let of = |wanted: &[Quantity]| -> Vec<BillRow> {
        let (_, rows) =
            effects_bill(&scene, &Options::default(), &BillOptions::new(1e-2), wanted, None).expect("a bill");
        rows.into_iter().filter(|row| row.quantity == Quantity::MaxVonMises).collect()
    };
    let (one, both) = (of(&[Quantity::MaxVonMises]), of(&[Quantity::MaxVonMises, Quantity::VonMisesDepth]));
    assert_eq!((one.len(), both.len()), (1, 1));
    assert_eq!((one[0].value, one[0].change, one[0].error), (both[0].value, both[0].change, both[0].error));
    let two = of(&[Quantity::MaxVonMises, Quantity::MaxShear]);
    assert_ne!(one[0].value, two[0].value, "a second stress ends on a coarser grid");
}

/// A loose target takes at most half of the products of a tight one. The products include those of the tangential problem, whose iterations are not
/// reported.
#[test]
fn products_with_friction_are_those_of_each_target() {
    let (mut rows, mut near) = (0, 0);
    let shift =
        Friction { prescribed: [Prescribed::Creepage(0.002), Prescribed::Creepage(0.001)], ..Friction::new(0.3) };
    let prescribed = [Prescribed::Creepage(-0.002), Prescribed::Creepage(0.001)];
    let rolling = Friction { prescribed, motion: Motion::SteadyRolling, spin: 0.01, ..Friction::new(0.3) };
    let transient = Friction { motion: Motion::TransientRolling, rolling_distance: 0.02, ..rolling };
    let options = Options { threads: 1, ..Options::default() };
    for bodies in [ALIKE, UNLIKE] {
        for friction in [shift, rolling, transient] {
            let scene = Scene { friction: Some(friction), ..Scene::new(grid(32), &[], bodies, Load::Approach(0.04)) };
            let mut surface = |grid: &Grid, h: &mut [f64]| {
                paraboloid(grid, h);
                false
            };
            let wanted = (Quantity::Force, &[1e-2, 3e-3, 1e-3][..]);
            let (_, prices) = cost_of_accuracy(&scene, &options, &Accuracy::new(0.1), wanted, Some(&mut surface), None)
                .expect("prices");
            for price in prices {
                let grid = price.grid.expect("a grid");
                let mut h = vec![0.0; grid.len()];
                paraboloid(&grid, &mut h);
                let scene = Scene { grid, undeformed_distance: &h, ..scene.clone() };
                let report = solve(&scene, &Options { tolerance: price.tolerance, ..options }).expect("a solve").2;
                let counted = report.count.work_units + report.friction.expect("friction").products;
                let ratio = price.work_units / counted;
                // The number of products grows with the number of elements. Coarser samples show only a part of this growth.
                assert!((0.6..1.6).contains(&ratio), "{:?}, {:?}, {}: {ratio}", bodies, friction.motion, price.target);
                (rows, near) = (rows + 1, near + usize::from((1.0 / 1.3..1.3).contains(&ratio)));
            }
        }
    }
    assert!(10 * near >= 9 * rows, "{near} of {rows} within 1.3");
}
