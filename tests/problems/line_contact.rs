//! Line contacts, on one row or one column of elements. A caller's coefficients take no more cycles than the half-space's.

use std::f64::consts::PI;

use contact_normal::grid::Grid;
use contact_normal::influence::{HalfSpace, Kernel, Table};
use contact_normal::operator::Operator;
use contact_normal::scene::{Bodies, Load, Period, Scene};
use contact_normal::solver::{quantities, solve, Lack, Options, Outcome, Quantity};
use contact_normal::threads::Threads;

use super::dense;

fn grid(mx: usize, my: usize) -> Grid {
    Grid::new(mx, my, 0.1, 0.1).unwrap()
}

/// A table of the half-space's coefficients times `factor(distance in elements)`.
fn table(grid: &Grid, bodies: &Bodies, factor: fn(f64) -> f64) -> Table {
    let half_space = HalfSpace::new(grid.dx, grid.dy, bodies.compliance());
    let (cx, cy) = (grid.mx as i64, grid.my as i64);
    let offsets = (-cy..cy).flat_map(|ky| (-cx..cx).map(move |kx| (kx, ky)));
    let values: Vec<f64> =
        offsets.map(|(kx, ky)| half_space.at(kx, ky) * factor((kx as f64).hypot(ky as f64))).collect();
    Table::new(grid.mx, grid.my, &values, grid).unwrap()
}

#[test]
fn own_coefficients_on_one_row_or_column_keep_the_preconditioner() {
    let bodies = Bodies::same(1.0, 0.3);
    let factors: [fn(f64) -> f64; 2] = [|_| 1.0, |r| (-0.05 * r).exp()];
    for (mx, my) in [(256, 1), (1, 256)] {
        let grid = grid(mx, my);
        let h: Vec<f64> = (0..256).map(|i| 0.002 * (i as f64 - 127.3).powi(2) * 0.01).collect();
        for load in [Load::Approach(0.1), Load::Force(0.3)] {
            let plain = Scene::new(grid, &h, bodies, load);
            let (_, _, report) = solve(&plain, &Options::default()).unwrap();
            for factor in factors {
                let scene = Scene { influence: Some(table(&grid, &bodies, factor)), ..plain.clone() };
                let (solver, stop, own) = solve(&scene, &Options::default()).unwrap();
                assert_eq!(stop, Outcome::Converged, "{mx} x {my} {load:?}");
                // The circulants differ only in the coefficients beyond the grid, which allows for 4 more cycles.
                let allowed = report.count.cycles + 4;
                assert!(
                    own.count.cycles <= allowed,
                    "{mx} x {my} {load:?}: {} cycles, {} without a table",
                    own.count.cycles,
                    report.count.cycles
                );
                let state = solver.state();
                let mut u = vec![0.0; grid.len()];
                dense::apply(&scene.coefficients().unwrap(), &grid, &state.p, &mut u);
                let distances: f64 = (0..256)
                    .filter(|&i| state.contact[i])
                    .map(|i| (state.h[i] - state.approach + u[i]).powi(2))
                    .sum::<f64>();
                let scale: f64 =
                    (0..256).filter(|&i| state.contact[i]).map(|i| (state.h[i] - state.approach).powi(2)).sum::<f64>();
                assert!(distances.sqrt() <= Options::default().tolerance * scale.sqrt(), "{mx} x {my} {load:?}");
            }
        }
    }
}

#[test]
fn the_circulant_of_one_row_is_one_row_long() {
    for (mx, my) in [(24, 1), (1, 24), (1, 1)] {
        let grid = grid(mx, my);
        let coefficients = table(&grid, &Bodies::same(1.0, 0.3), |_| 1.0).into();
        let (px, py) = Operator::<f64>::circulant_period(&coefficients, &grid);
        assert!((mx > 1 || px == 1) && (my > 1 || py == 1), "{mx} x {my}: period {px} x {py}");
        // The inverse of a positive circulant exists: it maps a uniform u of 1 over a whole period to a pressure of one over the sum of the
        // circulant's coefficients.
        let inverse = Operator::<f64>::inverse_circulant(&coefficients, &grid, (px, py), &Threads::One).unwrap();
        assert!(inverse.is_some(), "{mx} x {my}: not positive");
    }
}

/// A roller on one row of long elements. In a line contact the largest shear stress is .300 p0 at a depth of .786 a. In plane strain with nu = .3 the
/// largest von Mises stress is .558 p0 at .70 a (Johnson, Contact Mechanics, section 4.2).
#[test]
fn largest_stresses_of_a_roller_lie_below_its_surface() {
    let (load, radius, bodies) = (500.0, 50.0, Bodies::same(82_000.0, 0.3));
    let modulus = 1.0 / bodies.compliance();
    let a = (4.0 * load * radius / (PI * modulus)).sqrt();
    let p0 = 2.0 * load / (PI * a);
    for (mx, my) in [(64, 1), (1, 64)] {
        for long in [100.0, 1000.0] {
            let (dx, dy) = if mx > my { (0.05, long) } else { (long, 0.05) };
            let grid = Grid::new(mx, my, dx, dy).unwrap();
            let h: Vec<f64> = (0..64).map(|i| ((i as f64 - 31.5) * 0.05).powi(2) / (2.0 * radius)).collect();
            let scene = Scene::new(grid, &h, bodies, Load::Force(load * long));
            let wanted = [Quantity::MaxVonMises, Quantity::VonMisesDepth, Quantity::MaxShear];
            let (_, rows) = quantities(&scene, &Options::default(), &wanted, 2, None).unwrap();
            let found: Vec<f64> = rows[6..].iter().map(|row| row.value.expect("a value")).collect();
            println!("{mx} {long} {found:?} {a} {p0}");
            // The ends of the roller change stresses by a over its length. The contact has 21 elements across, which allows for 2e-3. The exact depth
            // is known to two digits.
            let ends = a / long;
            for (value, exact, allowed) in
                [(found[0], 0.558 * p0, 2e-3), (found[1], 0.70 * a, 0.03), (found[2], 0.3003 * p0, 2e-3)]
            {
                assert!((value / exact - 1.0).abs() < allowed + ends, "{mx} {long}: {value} {exact}");
            }
        }
    }
}

/// A line with two periods is uniform along itself, so that its largest stresses do not depend on the length of its elements. On a grid with several
/// such elements along the line the stresses are not available.
#[test]
fn largest_stresses_of_a_line_with_two_periods_do_not_depend_on_its_length() {
    let of = |mx: usize, my: usize, long: f64| {
        let grid = Grid::new(mx, my, 0.05, long).unwrap();
        let h: Vec<f64> = (0..grid.len()).map(|i| (((i % mx) as f64 - 31.5) * 0.05).powi(2) / 100.0).collect();
        let load = Load::Force(500.0 * long * my as f64);
        let period = Some(Period { x: true, y: true });
        let scene = Scene { period, ..Scene::new(grid, &h, Bodies::same(82_000.0, 0.3), load) };
        quantities(&scene, &Options::default(), &[Quantity::MaxVonMises], 0, None).unwrap().1[0]
    };
    let short = of(64, 1, 0.05).value.unwrap();
    for long in [1.0, 10.0, 100.0] {
        // 1e-5 allows for the tolerance of the solve.
        assert!((of(64, 1, long).value.unwrap() / short - 1.0).abs() < 1e-5, "{long}");
    }
    assert_eq!((of(64, 4, 10.0).value, of(64, 4, 10.0).lack), (None, Some(Lack::Effect)));
}
