//! A caught panic in a product does not affect later solves, with any effect: the next solve equals that of a new solver.

use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::Ordering;

use contact_normal::adhesion::{Law, Start};
use contact_normal::grid::Grid;
use contact_normal::influence::{HalfSpace, Kernel, RowTables};
use contact_normal::panics::BLOCKS;
use contact_normal::scene::{Adhesion, Bodies, Each, Layer, Load, Patches, Scene, Work};
use contact_normal::solver::{Options, Outcome, Solver};

#[test]
fn after_a_panic_the_next_solve_is_right_with_every_effect() {
    let _alone = crate::alone();
    let grid = Grid::new(12, 10, 0.5, 0.4).unwrap();
    let bodies = Bodies::same(1.0, 0.3);
    let n = grid.len();
    let h: Vec<f64> =
        (0..n).map(|i| 0.1 * ((i % 12) as f64 - 5.5).powi(2) + 0.1 * ((i / 12) as f64 - 4.5).powi(2)).collect();
    let compliances: Vec<f64> = (0..n).map(|i| (i % 5) as f64).collect();
    let patch: Vec<i32> = (0..n as i32).map(|i| i32::from(i % 12 < 6)).collect();
    let half_space = HalfSpace::new(0.5, 0.4, bodies.compliance());
    let values = (0..10 * 10 * 24).map(|k| (k as i64 / 240, k as i64 / 24 % 10, k as i64 % 24 - 12));
    let values: Vec<f64> = values.map(|(jy, iy, kx)| half_space.at(kx, iy - jy)).collect();
    let plain = Scene::new(grid, &h, bodies, Load::Force(2.0));
    let layer = Some(Layer(Each::PerElement(&compliances)));
    let patches = Some(Patches { count: 2, patch: &patch, factors: &[1.0, 0.5, 0.5, 1.0] });
    let row_tables = Some(RowTables::new(12, 10, &values, &grid).unwrap());
    let attraction = Adhesion {
        law: Law::Exponential,
        work: Work::Uniform(0.1),
        range: 0.5,
        start: Start::Auto,
        stiffness: true,
        stability: true,
        shear_strength: 0.0,
    };
    let scenes = [
        ("a layer", Scene { layer, ..plain.clone() }),
        ("patches", Scene { patches, ..plain.clone() }),
        ("row tables", Scene { row_tables: row_tables.clone(), ..plain.clone() }),
        ("all three", Scene { layer, patches, row_tables, ..plain.clone() }),
        ("adhesion", Scene { adhesion: Some(attraction), ..plain.clone() }),
    ];
    std::panic::set_hook(Box::new(|_| {}));
    for (name, scene) in scenes {
        let options = Options { threads: 1, ..Options::default() };
        let mut solver = Solver::new(&scene, &options).unwrap();
        let (stop, _) = solver.solve(&scene, &options, None, None).unwrap();
        assert_eq!(stop, Outcome::Converged, "{name}");
        let expected = solver.state().p.clone();
        let mut panics = 0;
        for block in 0.. {
            BLOCKS.store(block, Ordering::Relaxed);
            let outcome = catch_unwind(AssertUnwindSafe(|| solver.solve(&scene, &options, None, None)));
            BLOCKS.store(-1, Ordering::Relaxed);
            if outcome.is_ok() {
                break;
            }
            panics += 1;
            let next = catch_unwind(AssertUnwindSafe(|| solver.solve(&scene, &options, None, None)));
            let (stop, _) = next.unwrap_or_else(|_| panic!("{name}, block {block}: the next solve panics")).unwrap();
            assert_eq!((stop, &solver.state().p), (Outcome::Converged, &expected), "{name}, block {block}");
        }
        assert!(panics > 4, "{name}: {panics} panics");
    }
}
