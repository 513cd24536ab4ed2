//! Effect `row_tables`: row tables of the half-space's coefficients have no effect, products equal direct sums, tables with scaled rows have the
//! solution of plain ones, and the contact conditions hold by direct sums, whether tables are symmetric or not.

use crate::support::run;
use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace, Kernel, RowTables};
use contact_normal::operator::Operator;
use contact_normal::scene::{Bodies, Each, Layer, Load, PressureLimit, Scene};
use contact_normal::solver::{solve, solve_to_accuracy, Accuracy, ActiveSet, Guess, Method, Options, Outcome, Solver};
use contact_normal::threads::Threads;

const BODIES: Bodies = Bodies { shear_modulus: [1.0, 1.0], poisson_ratio: [0.3, 0.3] };

/// Row tables of `coefficient(jy, iy, kx)`. The library never reads the offset -mx.
fn tables(grid: &Grid, coefficient: impl Fn(usize, usize, i64) -> f64) -> RowTables {
    let (mx, my) = (grid.mx as i64, grid.my);
    let value = |jy, iy, kx| if kx == -mx { f64::NAN } else { coefficient(jy, iy, kx) };
    let values: Vec<f64> = (0..my * my).flat_map(|k| (-mx..mx).map(move |kx| value(k / my, k % my, kx))).collect();
    RowTables::new(grid.mx, my, &values, grid).unwrap()
}

fn half_space(grid: &Grid) -> impl Fn(usize, usize, i64) -> f64 {
    let half_space = HalfSpace::new(grid.dx, grid.dy, BODIES.compliance());
    move |jy, iy, kx| half_space.at(kx, iy as i64 - jy as i64)
}

/// Pseudo-random numbers in [0, 1).
fn random(i: u64) -> f64 {
    let mut x = i.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// `u = A p` by direct sums, and the largest sum of the absolute values of the terms.
fn direct(grid: &Grid, tables: &RowTables, p: &[f64]) -> (Vec<f64>, f64) {
    let (mut u, mut largest) = (vec![0.0; grid.len()], 0.0_f64);
    for (i, u) in u.iter_mut().enumerate() {
        let mut magnitudes = 0.0;
        for (j, p) in p.iter().enumerate().filter(|(_, p)| **p != 0.0) {
            let term = tables.coefficient(j / grid.mx, i / grid.mx, (i % grid.mx) as i64 - (j % grid.mx) as i64) * p;
            *u += term;
            magnitudes += term.abs();
        }
        largest = largest.max(magnitudes);
    }
    (u, largest)
}

fn bump(grid: &Grid) -> Vec<f64> {
    let centre = |i: usize, m: usize| i as f64 - 0.5 * (m - 1) as f64;
    (0..grid.len())
        .map(|i| 0.01 * centre(i % grid.mx, grid.mx).powi(2) + 0.02 * centre(i / grid.mx, grid.my).powi(2))
        .collect()
}

fn tight(method: Method) -> Options {
    Options { method, tolerance: 1e-10, ..Options::default() }
}

/// Asserts the contact conditions of the returned arrays, with u by direct sums. `give` is the compliance of a layer.
fn assert_conditions(scene: &Scene<'_>, solver: &Solver, give: impl Fn(usize) -> f64, what: &str) {
    let (state, h) = (solver.state(), scene.undeformed_distance);
    let (u, _) = direct(&scene.grid, scene.row_tables.as_ref().unwrap(), &state.p);
    // The residual of 1e-10 is an rms over some 300 elements in contact, of which one may have all of it: a factor of about 20.
    let allowed = 20.0 * 1e-10 * u.iter().copied().fold(0.0, f64::max);
    let mut counts = [0, 0];
    for i in (0..h.len()).filter(|&i| h[i].is_finite()) {
        let e = h[i] - state.approach + u[i] + give(i) * state.p[i];
        let holds = if state.contact[i] { e.abs() <= allowed } else { e >= -allowed && state.p[i] == 0.0 };
        assert!(holds && state.p[i] >= 0.0, "{what}, element {i}: e = {e}, p = {}", state.p[i]);
        counts[usize::from(state.contact[i])] += 1;
    }
    assert!(counts[0] > 10 && counts[1] > 10, "{what}: {counts:?} outside and in contact");
    if let Load::Force(force) = scene.load {
        assert!((state.force() / force - 1.0).abs() <= 1e-12, "{what}");
    }
}

#[test]
fn products_are_those_of_the_direct_sum() {
    for (mx, my) in [(1, 1), (1, 9), (8, 1), (7, 5), (16, 11), (31, 18), (12, 64)] {
        let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
        for even in [true, false] {
            let at = |jy: usize, iy: usize, kx: i64| {
                let kx = if even { kx.abs() } else { kx + mx as i64 };
                let own = if (jy, kx) == (iy, if even { 0 } else { mx as i64 }) { 2.0 } else { 0.0 };
                own + random(((jy * my + iy) * 2 * mx) as u64 + kx as u64) - 0.3
            };
            let tables = tables(&grid, at);
            assert_eq!(tables.is_even_in_x(), even || mx == 1);
            let influence = Coefficients::from(tables.clone());
            for loaded in [0..my, my / 3..my - my / 4] {
                let p: Vec<f64> = (0..grid.len())
                    .map(|i| if loaded.contains(&(i / mx)) { random(i as u64) - 0.4 } else { 0.0 })
                    .collect();
                let (expected, magnitudes) = direct(&grid, &tables, &p);
                let mut bits = Vec::new();
                for threads in [Threads::One, Threads::new(3).unwrap()] {
                    let operator = Operator::<f64>::new(&influence, &grid, &threads).unwrap();
                    let mut u = vec![f64::NAN; grid.len()];
                    operator.apply(&p, &mut u, &mut operator.workspace().unwrap());
                    for (u, expected) in u.iter().zip(&expected) {
                        // Transforms of 63 values and sums of 64 terms have some ten units of round-off of the magnitudes.
                        assert!((u - expected).abs() <= 1e-13 * magnitudes, "{mx} x {my} {even}: {u} {expected}");
                    }
                    let mut in_place = p.clone();
                    operator.apply_in_place(&mut in_place, &mut operator.workspace().unwrap());
                    assert_eq!(in_place, u);
                    let single = operator.in_precision::<f32>(1.0).unwrap();
                    let of_p: Vec<f32> = p.iter().map(|p| *p as f32).collect();
                    let mut of_u = vec![f32::NAN; grid.len()];
                    single.apply(&of_p, &mut of_u, &mut single.workspace().unwrap());
                    for (u, expected) in of_u.iter().zip(&expected) {
                        assert!((f64::from(*u) - expected).abs() <= 1e-13 * 2f64.powi(29) * magnitudes);
                    }
                    bits.push(u);
                }
                assert_eq!(bits[0], bits[1], "any number of threads has the same bits");
            }
        }
    }
}

#[test]
fn tables_of_the_half_space_are_no_effect() {
    let grid = Grid::new(41, 30, 0.5, 0.4).unwrap();
    let h = bump(&grid);
    let row_tables = Some(tables(&grid, half_space(&grid)));
    let c: Vec<f64> = (0..grid.len()).map(|i| 0.1 * (i % 4) as f64).collect();
    for load in [Load::Approach(0.5), Load::Force(4.0)] {
        let plain = Scene::new(grid, &h, BODIES, load);
        let peak = run(&plain, &tight(Method::Auto)).1.measures.max_pressure;
        let limit = Some(PressureLimit(Each::Uniform(0.8 * peak)));
        for (layer, pressure_limit) in [
            (None, None),
            (Some(Layer(Each::Uniform(0.2))), None),
            (Some(Layer(Each::PerElement(&c))), None),
            (None, limit),
        ] {
            let plain = Scene { layer, pressure_limit, ..plain.clone() };
            let scene = Scene { row_tables: row_tables.clone(), ..plain.clone() };
            for method in [Method::Auto, Method::ProjectedCg, Method::Norm] {
                let (expected, without) = run(&plain, &tight(method));
                let (found, with) = run(&scene, &tight(method));
                for (a, b) in found.state().p.iter().zip(&expected.state().p) {
                    // Relative residuals of 1e-10 and condition numbers of some 100.
                    assert!((a - b).abs() <= 1e-7 * without.measures.max_pressure, "{load:?} {method:?}: {a} {b}");
                }
                assert_eq!(found.state().contact, expected.state().contact, "{load:?} {method:?}");
                assert_eq!(found.state().at_limit, expected.state().at_limit, "{load:?} {method:?}");
                assert!(pressure_limit.is_none() || found.state().at_limit.contains(&true));
                // The coefficients of coarse grids are means instead of those of larger elements, and there is no window and no direct solve. So row
                // tables may take more products.
                let (with, without) = (with.count.matrix_products, without.count.matrix_products);
                assert!(with <= without + without / 2 + 3, "{load:?} {layer:?} {method:?}: {with} products, {without}");
            }
        }
    }
}

/// `c_jy(iy, k) = d(jy) d(iy) c(k, iy - jy)`, and h - approach is multiplied by d: then e is multiplied by d, and p is divided by d.
#[test]
fn rows_in_other_units_have_the_same_solution() {
    // Without row tables this scene is solved on a window around the contact area.
    let grid = Grid::new(75, 61, 0.5, 0.4).unwrap();
    let h: Vec<f64> = bump(&grid).iter().map(|h| h - 0.9).collect();
    let d = |iy: usize| 1.0 + 0.8 * (0.3 * iy as f64).sin();
    let plain = Scene::new(grid, &h, BODIES, Load::Approach(0.0));
    let expected = run(&plain, &tight(Method::Auto)).0;
    let h_by_d: Vec<f64> = h.iter().enumerate().map(|(i, h)| d(i / grid.mx) * h).collect();
    let c = half_space(&grid);
    let row_tables = Some(tables(&grid, |jy, iy, kx| d(jy) * d(iy) * c(jy, iy, kx)));
    let scene = Scene { row_tables, undeformed_distance: &h_by_d, ..plain.clone() };
    let largest = expected.state().p.iter().copied().fold(0.0, f64::max);
    for method in [Method::Auto, Method::ProjectedCg, Method::Norm] {
        let (found, _) = run(&scene, &tight(method));
        assert_eq!(found.state().contact, expected.state().contact);
        for (i, (a, b)) in found.state().p.iter().zip(&expected.state().p).enumerate() {
            // As above 1e-7, times a factor because d is between 0.2 and 1.8.
            assert!((a * d(i / grid.mx) - b).abs() <= 1e-6 * largest, "{method:?} {i}: {a} {b}");
        }
        assert_conditions(&scene, &found, |_| 0.0, "rows in other units");
    }
}

/// Normals that rotate along y, as for a wheel in a groove. A pressure along one normal causes a displacement along another one with a factor of the
/// cosine between them.
fn turning(grid: &Grid) -> RowTables {
    let c = half_space(grid);
    let angle = |iy: usize| 1.2 * iy as f64 / grid.my as f64;
    tables(grid, |jy, iy, kx| (angle(iy) - angle(jy)).cos() * c(jy, iy, kx))
}

#[test]
fn the_conditions_hold_with_the_direct_sum() {
    let grid = Grid::new(40, 33, 0.5, 0.4).unwrap();
    let mut h = bump(&grid);
    let c: Vec<f64> = (0..grid.len()).map(|i| 0.1 * (i % 4) as f64).collect();
    h[16 * 40 + 21] = f64::INFINITY;
    let row_tables = Some(turning(&grid));
    for load in [Load::Approach(0.7), Load::Force(5.0)] {
        for layer in [None, Some(Layer(Each::Uniform(0.2))), Some(Layer(Each::PerElement(&c)))] {
            let scene = Scene { row_tables: row_tables.clone(), layer, ..Scene::new(grid, &h, BODIES, load) };
            for method in [Method::Auto, Method::ProjectedCg, Method::Norm] {
                let (solver, report) = run(&scene, &tight(method));
                let give = |i: usize| match layer {
                    None => 0.0,
                    Some(Layer(Each::Uniform(c))) => c,
                    Some(Layer(Each::PerElement(c))) => c[i],
                };
                assert_conditions(&scene, &solver, give, &format!("{load:?} {layer:?} {method:?}"));
                // The numbers of products are those of the plain scene, or those of conjugate gradients without a preconditioner: at most 60.
                assert!(
                    method == Method::Norm || report.count.matrix_products <= 60,
                    "{} products",
                    report.count.matrix_products
                );
            }
        }
    }
}

#[test]
fn what_is_not_symmetric_is_solved_too() {
    let grid = Grid::new(22, 19, 0.5, 0.4).unwrap();
    let h = bump(&grid);
    let c = half_space(&grid);
    // Tables that are even in x and tables that are not, with rows that differ.
    let uneven = |jy: usize, iy: usize, kx: i64| c(jy, iy, kx) * (1.0 + 0.02 * iy as f64 + 0.01 * kx as f64);
    let even = |jy: usize, iy: usize, kx: i64| c(jy, iy, kx) * (1.0 + 0.02 * iy as f64);
    for (row_tables, is_even) in [(tables(&grid, uneven), false), (tables(&grid, even), true)] {
        assert_eq!((row_tables.is_even_in_x(), row_tables.is_symmetric(&grid)), (is_even, false));
        for load in [Load::Approach(0.4), Load::Force(1.5)] {
            let scene = Scene { row_tables: Some(row_tables.clone()), ..Scene::new(grid, &h, BODIES, load) };
            for method in [Method::Auto, Method::Norm] {
                let (solver, _) = run(&scene, &tight(method));
                assert_conditions(&scene, &solver, |_| 0.0, &format!("{load:?} {method:?}"));
            }
            let Err(error) = solve(&scene, &tight(Method::ProjectedCg)) else { panic!("not refused") };
            assert!(error.to_string().contains("not symmetric"), "{error}");
        }
    }
    // Tables that are symmetric but not even in x: the transposed table is at -k.
    let leaning = |jy: usize, iy: usize, kx: i64| c(jy, iy, kx) * (1.0 + 0.002 * (iy as f64 - jy as f64) * kx as f64);
    let row_tables = tables(&grid, leaning);
    assert_eq!((row_tables.is_even_in_x(), row_tables.is_symmetric(&grid)), (false, true));
    let scene = Scene { row_tables: Some(row_tables), ..Scene::new(grid, &h, BODIES, Load::Force(1.5)) };
    let (solver, _) = run(&scene, &tight(Method::ProjectedCg));
    assert_conditions(&scene, &solver, |_| 0.0, "leaning");
}

#[test]
fn coarser_tables_of_the_half_space_are_near_those_of_larger_elements() {
    // Odd numbers of elements: the last row and column of the coarse grid stick out of the fine one.
    let grid = Grid::new(13, 11, 1.0, 0.9).unwrap();
    let coarse = Grid::new(7, 6, 2.0, 1.8).unwrap();
    let fine = tables(&grid, half_space(&grid));
    let coarser = Coefficients::from(fine).coarsen(&grid, &coarse).unwrap();
    let (means, _) = coarser.row_tables().unwrap();
    let exact = half_space(&coarse);
    for (jy, iy, kx) in (0..6 * 6 * 7).map(|k| (k / 42, k / 7 % 6, k as i64 % 7)) {
        let (mean, exact) = (means.coefficient(jy, iy, kx), exact(jy, iy, kx));
        // For unit squares the coefficients at offsets (0, 0), (1, 0), (1, 1), (2, 0) are 3.525, 1.038, 0.73, 0.505. The mean is 6.33 at offset 0,
        // where 7.05 is exact, and 2.165 at offset 1, where 2.076 is exact.
        let allowed = if (jy, kx) == (iy, 0) { 0.13 } else { 0.07 };
        assert!((mean / exact - 1.0).abs() <= allowed, "({jy}, {iy}, {kx}): {mean} {exact}");
        assert_eq!(mean, means.coefficient(jy, iy, -kx));
    }
    assert!(means.is_symmetric(&coarse));
}

#[test]
fn a_fixed_contact_area_and_handles() {
    let grid = Grid::new(24, 20, 0.5, 0.4).unwrap();
    let h = bump(&grid);
    let plain = Scene::new(grid, &h, BODIES, Load::Approach(0.4));
    let scene = Scene { row_tables: Some(turning(&grid)), ..plain.clone() };
    let (free, _) = run(&scene, &tight(Method::Auto));
    let (pressure, contact) = (vec![0.0; grid.len()], free.state().contact.clone());
    let fixed = Options { active_set: ActiveSet::Fixed, ..tight(Method::Auto) };
    let mut solver = Solver::new(&scene, &fixed).unwrap();
    let guess = Some(Guess { pressure: &pressure, contact: &contact });
    // A later scene may contain the tables or not, because they belong to the set-up of the handle.
    for scene in [&scene, &plain] {
        let (stop, _) = solver.solve(scene, &fixed, guess, None).unwrap();
        assert_eq!(stop, Outcome::Converged);
        for (a, b) in solver.state().p.iter().zip(&free.state().p) {
            assert!((a - b).abs() <= 1e-7, "{a} {b}");
        }
    }
    let mut without = Solver::new(&plain, &fixed).unwrap();
    let error = without.solve(&scene, &fixed, guess, None).unwrap_err();
    assert!(error.to_string().contains("row_tables") && error.to_string().contains("without"), "{error}");
    for method in [Method::Multigrid, Method::FullMultigrid] {
        let Err(error) = solve(&scene, &tight(method)) else { panic!("not refused") };
        assert!(error.to_string().contains("MULTIGRID") && error.to_string().contains("row_tables"), "{error}");
    }
    let Err(error) = solve_to_accuracy(&scene, &Options::default(), &Accuracy::new(0.01), None, None) else { panic!() };
    assert!(error.to_string().contains("row_tables"), "{error}");
}

/// The solver holds the tables and their symbols twice: in double precision, and in single precision for the iteration.
#[test]
fn reported_bytes_hold_the_tables() {
    let grid = Grid::new(32, 48, 0.5, 0.4).unwrap();
    let h = bump(&grid);
    let scene = Scene { row_tables: Some(turning(&grid)), ..Scene::new(grid, &h, BODIES, Load::Approach(0.4)) };
    let (_, report) = run(&scene, &tight(Method::Auto));
    let (finest, share) = (48 * 48, 8 * 32 + 8 * 32 + 4 * 32);
    assert!(report.bytes >= finest * share, "{} bytes", report.bytes);
    // Coarser grids take a sixth more. The rest of the factor of 3/2 is for arrays of the grid.
    assert!(report.bytes <= finest * share * 3 / 2, "{} bytes", report.bytes);
}
