//! A caller's tangential coefficients, one table per loaded row.

use contact_normal::error::Error;
use contact_normal::friction::{Solver, Tangential, Vector};
use contact_normal::grid::Grid;
use contact_normal::influence::RowTables;
use contact_normal::scene::{
    Bodies, Coefficient, Friction, Load, Motion, Prescribed, Previous, Scene, TangentialInfluence,
};
use contact_normal::solver::{self, solve, solve_tangential, Options};
use contact_normal::threads::Threads;

use super::case::paraboloid;
use super::support::{residual_by, run, tangential};

/// Columns of the tables beyond those of the grid.
const BEYOND: usize = 3;
const NU: f64 = 0.3;

/// The rotation of a row about the normal, and the factor of its compliance.
type Row = (f64, f64);

/// `A_IJ = f_I f_J R_I' A(I - J) R_J` is symmetric and positive definite, as the half-space's A is. `of(row)` has the rotation and the factor of a
/// row. Returns xx, yy and xy by loaded row, row and offset.
fn tables(grid: &Grid, of: &dyn Fn(usize) -> Row) -> [Vec<f64>; 3] {
    let (cx, half_space) = (grid.mx + BEYOND, tangential(grid, NU));
    let mut tables = [const { Vec::new() }; 3];
    for k in 0..grid.my * grid.my * 2 * cx {
        let (jy, iy, kx) = (k / (2 * cx) / grid.my, k / (2 * cx) % grid.my, (k % (2 * cx)) as f64 - cx as f64);
        let [xx, yy, xy] = half_space.at(kx, iy as f64 - jy as f64);
        let ((turned_i, soft_i), (turned_j, soft_j)) = (of(iy), of(jy));
        let turn =
            |angle: f64, v: Vector| [angle.cos() * v[0] - angle.sin() * v[1], angle.sin() * v[0] + angle.cos() * v[1]];
        let column = |unit: Vector| {
            let q = turn(turned_j, unit);
            let u = turn(-turned_i, [xx * q[0] + xy * q[1], xy * q[0] + yy * q[1]]);
            u.map(|u| soft_i * soft_j * u)
        };
        let ([xx, _], [xy, yy]) = (column([1.0, 0.0]), column([0.0, 1.0]));
        for (table, value) in tables.iter_mut().zip([xx, yy, xy]) {
            table.push(value);
        }
    }
    tables
}

fn influence<'a>(grid: &Grid, tables: &'a [Vec<f64>; 3]) -> TangentialInfluence<'a> {
    let coefficients = tables.each_ref().map(|table| &table[..]);
    TangentialInfluence { cx: grid.mx + BEYOND, cy: grid.my, by_row: true, coefficients, cross: None, scale: 1.0 }
}

/// Displacements by direct summation. The coefficients yx follow from xy by the symmetry of A.
fn sums(grid: &Grid, tables: &[Vec<f64>; 3], by: (f64, f64), q: &[Vector], u: &mut [Vector]) {
    let (cx, my) = ((grid.mx + BEYOND) as i64, grid.my);
    let by = by.0.round() as i64;
    for (i, u) in u.iter_mut().enumerate() {
        *u = [0.0; 2];
        for (j, q) in q.iter().enumerate().filter(|(_, q)| **q != [0.0; 2]) {
            let (ix, iy, jx, jy) = (i % grid.mx, i / grid.mx, j % grid.mx, j / grid.mx);
            let kx = ix as i64 - jx as i64 + by;
            let at = |jy: usize, iy: usize, kx: i64| (jy * my + iy) * 2 * cx as usize + (kx + cx) as usize;
            let [xx, yy, xy] = [0, 1, 2].map(|k: usize| tables[k][at(jy, iy, kx)]);
            let yx = tables[2][at(iy, jy, -kx)];
            *u = [u[0] + xx * q[0] + xy * q[1], u[1] + yx * q[0] + yy * q[1]];
        }
    }
}

/// A rotation and a factor that differ from row to row.
fn uneven(row: usize) -> Row {
    (0.9 * (0.3 * row as f64).sin(), 1.0 + 0.4 * (0.2 * row as f64).cos())
}

fn own_solver(grid: &Grid, tables: &[Vec<f64>; 3]) -> Solver {
    let tangential = Tangential::of_tables(grid.dx, grid.dy, &influence(grid, tables)).unwrap();
    Solver::new(*grid, tangential, true, &Threads::One)
}

/// Pressures of an ellipse about the element (x, y), with half axes in elements.
fn ellipse(grid: &Grid, (x, y): (f64, f64), (a, b): (f64, f64)) -> Vec<f64> {
    let squared = |i: usize| (((i % grid.mx) as f64 - x) / a).powi(2) + (((i / grid.mx) as f64 - y) / b).powi(2);
    (0..grid.len()).map(|i| (1.0 - squared(i)).max(0.0).sqrt()).collect()
}

fn motions() -> Vec<Friction<'static>> {
    let prescribed = [Prescribed::Creepage(-0.2), Prescribed::Creepage(0.1)];
    let shift = Friction { prescribed, spin: 0.02, ..Friction::new(0.3) };
    let rolling = Friction { motion: Motion::TransientRolling, ..shift };
    let backward = Friction { rolling_direction: std::f64::consts::PI, ..rolling };
    let steady = Friction { motion: Motion::SteadyRolling, ..shift };
    let two = Friction { rolling_distance: 2.0, ..rolling };
    let motions = [shift, rolling, backward, two, steady, Friction { rolling_distance: 2.0, ..steady }];
    let forced = motions
        .map(|friction| Friction { prescribed: [Prescribed::Force(8.0), Prescribed::Creepage(0.05)], ..friction });
    motions.into_iter().chain(forced).collect()
}

#[test]
fn all_motions_meet_the_conditions_by_direct_sums() {
    // The larger grid has coarser grids, the smaller one has none. The numbers of rows are odd.
    for (mx, my) in [(14, 11), (30, 25)] {
        let grid = Grid::new(mx, my, 1.0, 0.8).unwrap();
        let tables = tables(&grid, &uneven);
        let (x, y) = (0.5 * mx as f64, 0.5 * my as f64);
        let pressure = ellipse(&grid, (x - 1.0, y - 0.3), (0.8 * x, 0.8 * y));
        let layers: Vec<f64> = (0..grid.len()).map(|i| 0.3 * (1.0 + (0.7 * i as f64).sin())).collect();
        for compliance in [Coefficient::Uniform(0.0), Coefficient::Uniform(0.4), Coefficient::PerElement(&layers)] {
            for friction in motions() {
                let friction = Friction { compliance, ..friction };
                let mut solver = own_solver(&grid, &tables);
                let (report, solution) = run(&mut solver, &pressure, &friction, 1e-6);
                let none = vec![[0.0; 2]; grid.len()];
                let direct = |by: (f64, f64), q: &[Vector], u: &mut [Vector]| sums(&grid, &tables, by, q, u);
                let slip_residual = residual_by(direct, &grid, &pressure, &friction, &none, (&report, &solution));
                // The tolerance of the solve, and 1e-9 for the different round-off of direct sums and FFT products.
                assert!(slip_residual <= 1.001e-6, "{mx} {friction:?}: {slip_residual}");
                if friction.motion == Motion::SteadyRolling {
                    continue;
                }
                // The next step. The contact has moved by one row, so that the box around it begins at another row, with as many rows.
                let moved = ellipse(&grid, (x - 1.0, y + 0.7), (0.8 * x, 0.8 * y));
                let next = Friction { previous: Previous::Kept, ..friction };
                let (report, after) = run(&mut solver, &moved, &next, 1e-6);
                let slip_residual = residual_by(direct, &grid, &moved, &next, &solution.traction, (&report, &after));
                assert!(slip_residual <= 1.001e-6, "{mx} {friction:?}, the next step: {slip_residual}");
            }
        }
    }
}

#[test]
fn a_box_that_begins_at_another_row_has_other_tables() {
    let grid = Grid::new(12, 20, 1.0, 1.0).unwrap();
    let tables = tables(&grid, &uneven);
    let (low, high) = (ellipse(&grid, (6.0, 6.0), (4.0, 4.0)), ellipse(&grid, (6.0, 13.0), (4.0, 4.0)));
    let none = vec![[0.0; 2]; grid.len()];
    for friction in motions() {
        let mut kept = own_solver(&grid, &tables);
        for pressure in [&low, &high, &low] {
            let (report, solution) = run(&mut kept, pressure, &friction, 1e-8);
            let direct = |by: (f64, f64), q: &[Vector], u: &mut [Vector]| sums(&grid, &tables, by, q, u);
            let slip_residual = residual_by(direct, &grid, pressure, &friction, &none, (&report, &solution));
            assert!(slip_residual <= 1.001e-8, "{friction:?}: {slip_residual}");
        }
    }
}

#[test]
fn equal_rows_give_what_tables_of_offsets_give() {
    let grid = Grid::new(40, 30, 1.0, 0.8).unwrap();
    let tables = tables(&grid, &|_| (0.0, 1.0));
    let pressure = ellipse(&grid, (19.0, 14.0), (17.0, 12.0));
    for friction in motions() {
        let (_, found) = run(&mut own_solver(&grid, &tables), &pressure, &friction, 1e-9);
        let mut half_space = Solver::new(grid, tangential(&grid, NU), true, &Threads::One);
        let (_, known) = run(&mut half_space, &pressure, &friction, 1e-9);
        for (a, b) in known.traction.iter().zip(&found.traction) {
            // Tractions are up to .3. The relative error of tractions is 1e-5 at a residual of 1e-6 (docs/friction.md), and falls with its square
            // root: 1e-5 is ample for two solves to 1e-9.
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) <= 0.3 * 1e-5, "{friction:?}: {a:?} {b:?}");
        }
    }
}

#[test]
fn a_single_row_and_a_single_column_are_solved() {
    for (mx, my) in [(60, 1), (1, 30), (1, 1)] {
        let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
        let tables = tables(&grid, &uneven);
        let pressure = vec![1.0; grid.len()];
        for friction in motions().into_iter().filter(|friction| mx > 1 || friction.motion == Motion::Shift) {
            let friction = Friction { prescribed: [Prescribed::Creepage(-0.2), Prescribed::Creepage(0.1)], ..friction };
            let (report, solution) = run(&mut own_solver(&grid, &tables), &pressure, &friction, 1e-7);
            let none = vec![[0.0; 2]; grid.len()];
            let direct = |by: (f64, f64), q: &[Vector], u: &mut [Vector]| sums(&grid, &tables, by, q, u);
            let slip_residual = residual_by(direct, &grid, &pressure, &friction, &none, (&report, &solution));
            assert!(slip_residual <= 1.001e-7, "{mx} x {my} {friction:?}: {slip_residual}");
        }
    }
}

#[test]
fn threads_change_no_bit() {
    // Products are shared between threads if four times the elements of the box around C exceed 110 x 110, as they do here.
    let grid = Grid::new(80, 52, 1.0, 0.8).unwrap();
    let tables = tables(&grid, &uneven);
    let pressure = ellipse(&grid, (39.0, 25.0), (38.0, 24.0));
    let solved = |threads: &Threads, friction: &Friction<'_>| {
        let tangential = Tangential::of_tables(grid.dx, grid.dy, &influence(&grid, &tables)).unwrap();
        let mut solver = Solver::new(grid, tangential, true, threads);
        run(&mut solver, &pressure, friction, 1e-6).1.traction
    };
    for friction in motions() {
        assert_eq!(solved(&Threads::One, &friction), solved(&Threads::new(3).unwrap(), &friction), "{friction:?}");
    }
}

#[test]
fn what_is_no_symmetric_operator_or_does_not_fit_is_refused_by_name() {
    let grid = Grid::new(8, 6, 1.0, 1.0).unwrap();
    let (good, width) = (tables(&grid, &uneven), 2 * (8 + BEYOND));
    let pressure = ellipse(&grid, (4.0, 3.0), (3.0, 2.5));
    let bodies = Bodies::same(1.0, 0.3);
    let refused = |tables: &[Vec<f64>; 3], change: &dyn Fn(&mut Friction<'_>)| {
        let mut friction = Friction { influence: Some(influence(&grid, tables)), ..motions()[0] };
        change(&mut friction);
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &[], bodies, Load::Force(1.0)) };
        solve_tangential(&scene, &pressure, &Options::default(), None).err().unwrap()
    };
    // The index of loaded row 1, row 3, offset 2 in a table.
    let place = (6 + 3) * width + 8 + BEYOND + 2;
    let changed = |table: usize, at: usize, by: &dyn Fn(f64) -> f64| {
        let mut tables = good.clone();
        tables[table][at] = by(tables[table][at]);
        tables
    };
    for table in 0..2 {
        let error = refused(&changed(table, place, &|value| 1.1 * value), &|_| {});
        assert!(
            matches!(error, Error::Unsupported(_)) && error.to_string().contains("(jy 3, iy 1) at offset -2"),
            "{error}"
        );
    }
    let error = refused(&changed(2, place, &|_| f64::NAN), &|_| {});
    assert!(matches!(error, Error::NotFinite(_)) && error.to_string().contains("row_tables[2] (xy)"), "{error}");
    let error = refused(&changed(1, (6 + 1) * width + 8 + BEYOND, &|value| -value), &|_| {});
    assert!(matches!(error, Error::NotPositiveDefinite(_)) && error.to_string().contains("(jy 1, iy 1)"), "{error}");
    // 2 is larger than any coefficient of an element on itself, so that A cannot be positive definite.
    let error = refused(&changed(2, place, &|_| 2.0), &|_| {});
    assert!(
        matches!(error, Error::NotPositiveDefinite(_)) && error.to_string().contains("(xy) of rows (jy"),
        "{error}"
    );
    type Change = &'static dyn Fn(&mut Friction<'_>);
    let own: [(&str, Change); 6] = [
        ("row_tables->cx is 7", &|friction| friction.influence.iter_mut().for_each(|own| own.cx = 7)),
        ("row_tables->rows is 5", &|friction| friction.influence.iter_mut().for_each(|own| own.cy = 5)),
        ("has 0 values", &|friction| friction.influence.iter_mut().for_each(|own| own.coefficients[1] = &[])),
        ("row_tables->scale is 0", &|friction| friction.influence.iter_mut().for_each(|own| own.scale = 0.0)),
        ("must go along x", &|friction| {
            (friction.motion, friction.rolling_direction) = (Motion::TransientRolling, 0.5 * std::f64::consts::PI);
        }),
        ("friction->row_tables is given, and a step of rolling goes (1.5, 0)", &|friction| {
            (friction.motion, friction.rolling_distance) = (Motion::SteadyRolling, 1.5);
        }),
    ];
    for (words, change) in own {
        let error = refused(&good, change).to_string();
        assert!(error.contains(words), "{error} ({words})");
    }
    let unlike = Bodies { shear_modulus: [1.0, 5.0], poisson_ratio: [0.3; 2] };
    let friction = Some(Friction { influence: Some(influence(&grid, &good)), ..motions()[0] });
    let scene = Scene { friction, ..Scene::new(grid, &[], unlike, Load::Force(1.0)) };
    let error = solve_tangential(&scene, &pressure, &Options::default(), None).err().unwrap();
    assert!(error.to_string().contains("friction->row_tables has no coefficients"), "{error}");
}

#[test]
fn a_handle_keeps_tangential_row_tables_beside_those_of_pressures() {
    let grid = Grid::new(20, 14, 0.1, 0.1).unwrap();
    let h = paraboloid(&grid, 0.05);
    let tables = tables(&grid, &uneven);
    // The influence coefficients of pressures are, in this test, those of tractions in x.
    let normal = RowTables::new(20 + BEYOND, 14, &tables[0], &grid).unwrap();
    let (half, options) =
        (tables.clone().map(|table| table.iter().map(|value| 0.5 * value).collect()), Options::default());
    let scene = |tables| Scene {
        row_tables: Some(normal.clone()),
        friction: Some(Friction { influence: Some(influence(&grid, tables)), ..motions()[0] }),
        ..Scene::new(grid, &h, Bodies { shear_modulus: [0.0; 2], poisson_ratio: [0.0; 2] }, Load::Force(1.0))
    };
    let mut handle = solver::Solver::new(&scene(&tables), &options).unwrap();
    handle.solve(&scene(&tables), &options, None, None).unwrap();
    let (fresh, ..) = solve(&scene(&tables), &options).unwrap();
    let tractions = |solver: &solver::Solver| solver.friction().unwrap().traction.clone();
    assert_eq!(tractions(&handle), tractions(&fresh));
    let refused = handle.solve(&scene(&half), &options, None, None).map(|_| ());
    assert!(matches!(&refused, Err(Error::InfluenceChanged(message)) if message.contains("row_tables")), "{refused:?}");
    let own = scene(&half);
    let friction = own.friction.as_ref().unwrap();
    handle.set_tangential_influence(friction).unwrap();
    // Later scenes need not contain the tables.
    let unnamed = Scene { friction: Some(Friction { influence: None, ..*friction }), ..own.clone() };
    let cold = Options { initial_guess: solver::InitialGuess::default(), ..options };
    handle.solve(&unnamed, &cold, None, None).unwrap();
    let (fresh, ..) = solve(&scene(&half), &options).unwrap();
    assert_eq!(tractions(&handle), tractions(&fresh));
    // Tables of offsets are refused on this handle.
    let offsets = TangentialInfluence { by_row: false, ..friction.influence.unwrap() };
    let error = handle.set_tangential_influence(&Friction { influence: Some(offsets), ..*friction }).err().unwrap();
    assert!(error.to_string().contains("friction->influence is given"), "{error}");
}
