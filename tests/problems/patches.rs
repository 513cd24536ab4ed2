//! Effect `patches`: independent patches have the pressures of separate scenes, factors of 1 have no effect, and the contact conditions hold by
//! direct sums.

use super::dense;
use crate::support::run;
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Layer, Load, Patches, PressureLimit, Scene};
use contact_normal::solver::{solve, Method, Options, Solver};

/// Three bumps side by side, and the patch of each element: the patches are thirds of the grid in x.
fn bumps(grid: &Grid) -> (Vec<f64>, Vec<i32>) {
    let patch: Vec<i32> = (0..grid.len()).map(|i| (3 * (i % grid.mx) / grid.mx) as i32).collect();
    let h = (0..grid.len())
        .map(|i| {
            let centre = (grid.mx as f64 * (2 * patch[i] + 1) as f64 / 6.0) - 0.5;
            let (x, y) = ((i % grid.mx) as f64 - centre, (i / grid.mx) as f64 - 0.5 * (grid.my - 1) as f64);
            0.01 * (x * x + y * y) + 0.05 * f64::from(patch[i])
        })
        .collect();
    (h, patch)
}

const FACTORS: [f64; 9] = [1.0, 0.5, 0.1, 0.5, 1.0, 0.0, 0.1, 0.0, 1.0];
const INDEPENDENT: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

fn tight(method: Method) -> Options {
    Options { method, tolerance: 1e-10, ..Options::default() }
}

#[test]
fn the_equations_hold_with_the_direct_sum() {
    let grid = Grid::new(60, 22, 1.0, 0.8).unwrap();
    let (h, patch) = bumps(&grid);
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.6));
    let patches = Some(Patches { count: 3, patch: &patch, factors: &FACTORS });
    let c: Vec<f64> = (0..grid.len()).map(|i| 0.1 * (i % 4) as f64).collect();
    for load in [plain.load, Load::Force(5.0)] {
        for layer in [None, Some(Layer(Each::Uniform(0.2))), Some(Layer(Each::PerElement(&c)))] {
            let scene = Scene { patches, load, layer, ..plain.clone() };
            for method in [Method::Auto, Method::Norm] {
                let (solver, report) = run(&scene, &tight(method));
                let state = solver.state();
                let mut u = vec![0.0; grid.len()];
                for b in 0..3 {
                    let mine: Vec<f64> =
                        state.p.iter().zip(&patch).map(|(p, &of)| if of == b { *p } else { 0.0 }).collect();
                    let mut product = vec![0.0; grid.len()];
                    dense::apply(&plain.coefficients().unwrap(), &grid, &mine, &mut product);
                    for (i, u) in u.iter_mut().enumerate() {
                        *u += FACTORS[(3 * patch[i] + b) as usize] * product[i];
                    }
                }
                // The residual of 1e-10 is an rms over some 300 elements in contact, of which one may have all of it: a factor of about 20.
                let allowed = 20.0 * 1e-10 * u.iter().copied().fold(0.0, f64::max);
                for i in 0..grid.len() {
                    let give = match layer {
                        None => 0.0,
                        Some(Layer(Each::Uniform(c))) => c,
                        Some(Layer(Each::PerElement(c))) => c[i],
                    };
                    let e = h[i] - report.measures.approach + u[i] + give * state.p[i];
                    let holds = if state.contact[i] { e.abs() <= allowed } else { e >= -allowed && state.p[i] == 0.0 };
                    assert!(holds && state.p[i] >= 0.0, "{load:?} {layer:?} {method:?}, element {i}: e = {e}");
                }
                let loaded = |a: i32| state.p.iter().zip(&patch).any(|(p, &of)| of == a && *p > 0.0);
                assert!((0..3).all(loaded), "each patch carries something");
            }
        }
    }
}

#[test]
fn independent_patches_are_scenes_of_their_own() {
    // The grid is so large that products use windows.
    let grid = Grid::new(96, 64, 0.5, 0.5).unwrap();
    let (h, patch) = bumps(&grid);
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.8));
    let patches = Some(Patches { count: 3, patch: &patch, factors: &INDEPENDENT });
    let (together, report) = run(&Scene { patches, ..plain.clone() }, &tight(Method::Auto));
    let mut force = 0.0;
    for a in 0..3 {
        let alone: Vec<f64> = h.iter().zip(&patch).map(|(h, &of)| if of == a { *h } else { f64::INFINITY }).collect();
        let (single, of_one) = run(&Scene { undeformed_distance: &alone, ..plain.clone() }, &tight(Method::Auto));
        force += of_one.measures.force;
        for (i, p) in together.state().p.iter().enumerate().filter(|(i, _)| patch[*i] == a) {
            // Relative residuals of 1e-10 and condition numbers of some 100.
            let (expected, largest) = (single.state().p[i], report.measures.max_pressure);
            assert!((p - expected).abs() <= 1e-7 * largest, "patch {a}, element {i}: {p}, alone {expected}");
        }
    }
    assert!((report.measures.force / force - 1.0).abs() <= 1e-8);
}

#[test]
fn factors_of_one_are_none() {
    let grid = Grid::new(45, 30, 0.5, 0.5).unwrap();
    let (h, patch) = bumps(&grid);
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(4.0));
    let (without, report) = run(&plain, &tight(Method::Auto));
    let patches = Some(Patches { count: 3, patch: &patch, factors: &[1.0; 9] });
    for limit in [None, Some(PressureLimit(Each::Uniform(0.8 * report.measures.max_pressure)))] {
        let expected = run(&Scene { pressure_limit: limit, ..plain.clone() }, &tight(Method::Auto)).0;
        let (with, _) = run(&Scene { patches, pressure_limit: limit, ..plain.clone() }, &tight(Method::Auto));
        for (a, b) in with.state().p.iter().zip(&expected.state().p) {
            assert!((a - b).abs() <= 1e-7 * report.measures.max_pressure, "{a} {b}");
        }
        assert!(limit.is_none() || expected.state().p != without.state().p);
    }
}

#[test]
fn nothing_touches_where_there_is_no_patch() {
    let grid = Grid::new(60, 22, 1.0, 0.8).unwrap();
    let (h, mut patch) = bumps(&grid);
    // The middle of the first bump and some rows are in no patch. This equals elements without a surface.
    let is_none = |i: usize| i % 60 == 10 || (i / 60) % 7 == 3;
    let holes: Vec<f64> = (0..grid.len()).map(|i| if is_none(i) { f64::INFINITY } else { h[i] }).collect();
    let of_holes = patch.clone();
    (0..grid.len()).filter(|&i| is_none(i)).for_each(|i| patch[i] = -1);
    for load in [Load::Approach(0.6), Load::Force(5.0)] {
        let scene = |h, patch| Scene {
            patches: Some(Patches { count: 3, patch, factors: &FACTORS }),
            ..Scene::new(grid, h, Bodies::same(1.0, 0.3), load)
        };
        for method in [Method::Auto, Method::Norm] {
            let (found, _) = run(&scene(&h, &patch), &tight(method));
            let (expected, _) = run(&scene(&holes, &of_holes), &tight(method));
            // With a residual of 1e-10 errors are some 1e-9 of the pressures. Sums over patches are taken in another order.
            let largest = expected.state().p.iter().copied().fold(0.0, f64::max);
            let same = |p: &[f64]| p.iter().zip(&expected.state().p).all(|(a, b)| (a - b).abs() <= 1e-7 * largest);
            assert!(same(&found.state().p), "{load:?} {method:?}");
            assert!((0..grid.len()).all(|i| !is_none(i) || found.state().p[i] == 0.0));
            // A handle that is set up with the patches has the same pressures, bit for bit.
            let mut handle = Solver::new(&scene(&h, &patch), &tight(method)).unwrap();
            handle.solve(&scene(&h, &patch), &tight(method), None, None).unwrap();
            assert_eq!(handle.state().p, found.state().p);
        }
    }
    let nowhere = vec![-1; grid.len()];
    let patches = Some(Patches { count: 3, patch: &nowhere, factors: &FACTORS });
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(5.0));
    let refused = solve(&Scene { patches, ..plain }, &Options::default()).map(|_| ());
    assert!(matches!(&refused, Err(Error::Infeasible(_))), "{refused:?}");
}

#[test]
fn what_are_no_patches_is_refused_by_name() {
    let grid = Grid::new(6, 4, 1.0, 1.0).unwrap();
    let (h, patch) = bumps(&grid);
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(1.0));
    let good = Patches { count: 3, patch: &patch, factors: &FACTORS };
    let refuse = |patches: Patches<'_>, method: Method, words: &[&str]| {
        let scene = Scene { patches: Some(patches), ..plain.clone() };
        let Err(error) = solve(&scene, &tight(method)) else { panic!("{words:?}: solved") };
        assert!(words.iter().all(|word| error.to_string().contains(word)), "{error}");
    };
    let mut far = patch.clone();
    far[7] = 3;
    refuse(Patches { patch: &far, ..good }, Method::Auto, &["patches->patch", "(1, 1)", "3"]);
    refuse(Patches { patch: &patch[1..], ..good }, Method::Auto, &["patches->patch", "23", "24"]);
    refuse(Patches { count: 65, ..good }, Method::Auto, &["patches->count", "65"]);
    for (k, value, words) in [(1, 0.4, "symmetric"), (4, 0.9, "within"), (2, 1.5, "[0, 1]"), (2, f64::NAN, "NaN")] {
        let mut factors = FACTORS;
        factors[k] = value;
        refuse(Patches { factors: &factors, ..good }, Method::Auto, &["patches->factors", words]);
    }
    refuse(good, Method::Multigrid, &["MULTIGRID", "patches"]);
    let mut solver = Solver::new(&plain, &Options::default()).unwrap();
    let error = solver.solve(&Scene { patches: Some(good), ..plain.clone() }, &Options::default(), None, None);
    assert!(error.unwrap_err().to_string().contains("without"));
}
