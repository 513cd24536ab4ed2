//! Effect `layer`. A soft layer is Winkler's foundation, a rigid one has no effect, and equal compliances of all elements act as a uniform one. A
//! layer does not increase the number of products by much.

use super::dense;
use crate::support::run;
use contact_normal::contact::State;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Layer, Load, Period, Scene};
use contact_normal::solver::{solve, Method, Options, Solver};

fn ellipse(grid: &Grid) -> Vec<f64> {
    let (mx, my) = (grid.mx, grid.my);
    let at = |k: usize, m: usize| (2 * k + 1) as f64 / m as f64 - 1.0;
    (0..grid.len()).map(|i| 0.3 * at(i % mx, mx).powi(2) + 0.5 * at(i / mx, my).powi(2)).collect()
}

fn tight(method: Method) -> Options {
    Options { method, tolerance: 1e-10, ..Options::default() }
}

fn assert_near(found: &State, expected: &[f64], tolerance: f64, what: &str) {
    let largest = expected.iter().copied().fold(0.0, f64::max);
    for (i, (a, b)) in found.p.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= tolerance * largest, "{what}, element {i}: {a}, expected {b}");
    }
}

/// The self-influence of an element, the unit of compliances.
fn self_influence(scene: &Scene<'_>) -> f64 {
    scene.coefficients().unwrap().at(0, 0)
}

#[test]
fn a_soft_layer_is_winklers_foundation() {
    let grid = Grid::new(40, 30, 0.05, 0.05).unwrap();
    let h = ellipse(&grid);
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.2));
    // A p is at most p times the sum of all coefficients, which is below 1200 self-influences. So p = (approach - h)/c holds to 1200/1e9.
    let c = 1e9 * self_influence(&plain);
    let winkler: Vec<f64> = h.iter().map(|h| f64::max(0.2 - h, 0.0) / c).collect();
    for method in [Method::Auto, Method::Norm, Method::Multigrid, Method::FullMultigrid] {
        let scene = Scene { layer: Some(Layer(Each::Uniform(c))), ..plain.clone() };
        let (solver, _) = run(&scene, &tight(method));
        assert_near(solver.state(), &winkler, 2e-6, &format!("{method:?}"));
    }
    let each = vec![c; grid.len()];
    let scene = Scene { layer: Some(Layer(Each::PerElement(&each))), ..plain };
    for method in [Method::Auto, Method::ProjectedCg, Method::Norm] {
        assert_near(run(&scene, &tight(method)).0.state(), &winkler, 2e-6, &format!("{method:?} per element"));
    }
}

#[test]
fn a_rigid_layer_is_none_and_a_stiff_one_hardly_any() {
    let grid = Grid::new(48, 48, 0.05, 0.05).unwrap();
    let h = ellipse(&grid);
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(0.2));
    let (without, _) = run(&plain, &tight(Method::Auto));
    let zeros = vec![0.0; grid.len()];
    for layer in [Layer(Each::Uniform(0.0)), Layer(Each::PerElement(&zeros))] {
        let (rigid, _) = run(&Scene { layer: Some(layer), ..plain.clone() }, &tight(Method::Auto));
        assert_eq!((&rigid.state().p, &rigid.state().u), (&without.state().p, &without.state().u));
    }
    // The smallest eigenvalue of A is about 0.3 of the self-influence, so that pressures change by at most about c/0.3, c in units of the
    // self-influence: 3e-6.
    let c = 1e-6 * self_influence(&plain);
    let (stiff, _) = run(&Scene { layer: Some(Layer(Each::Uniform(c))), ..plain }, &tight(Method::Auto));
    assert_near(stiff.state(), &without.state().p, 1e-5, "stiff");
    assert!(stiff.state().p != without.state().p);
}

/// Compliances per element: soft in the middle, rigid at the rim of the contact, and rough.
fn uneven(grid: &Grid, scale: f64) -> Vec<f64> {
    let middle = |i: usize| {
        let (x, y) = ((i % grid.mx) as f64 / grid.mx as f64 - 0.5, (i / grid.mx) as f64 / grid.my as f64 - 0.5);
        f64::max(0.0, 1.0 - 16.0 * (x * x + y * y))
    };
    (0..grid.len()).map(|i| scale * middle(i) * (1.0 + 0.5 * ((i * 7919) % 13) as f64 / 13.0)).collect()
}

#[test]
fn one_compliance_per_element_satisfies_the_equations_of_the_direct_sum() {
    let grid = Grid::new(33, 26, 0.05, 0.06).unwrap();
    let h = ellipse(&grid);
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(0.2));
    for scale in [0.01, 1.0, 100.0] {
        let c = uneven(&grid, scale * self_influence(&plain));
        for period in [None, Some(Period { x: true, y: false }), Some(Period { x: true, y: true })] {
            let bodies = Scene { period, ..plain.clone() }.coefficients().unwrap();
            for load in [Load::Force(0.2), Load::Approach(0.15)] {
                let scene = Scene { layer: Some(Layer(Each::PerElement(&c))), load, period, ..plain.clone() };
                let (solver, report) = run(&scene, &tight(Method::Auto));
                let state = solver.state();
                let mut u = vec![0.0; grid.len()];
                dense::apply(&bodies, &grid, &state.p, &mut u);
                let size = u.iter().copied().fold(0.0, f64::max);
                for i in 0..grid.len() {
                    let e = h[i] - report.measures.approach + u[i] + c[i] * state.p[i];
                    // The residual is an rms over some 800 elements, of which one may have all of it: a factor of 30. Outside C the round-off of FFT
                    // products counts.
                    let allowed = 1e-10 * size * 30.0;
                    let holds = if state.contact[i] { e.abs() <= allowed } else { e >= -allowed && state.p[i] == 0.0 };
                    assert!(holds && state.p[i] >= 0.0, "{scale} {period:?} {load:?}, element {i}: e = {e}");
                    assert!((state.u[i] - u[i] - c[i] * state.p[i]).abs() <= allowed, "displacements hold the layer's");
                }
            }
        }
    }
}

#[test]
fn one_compliance_everywhere_is_the_uniform_layer() {
    let grid = Grid::new(64, 80, 0.05, 0.05).unwrap();
    let h = ellipse(&grid);
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(0.3));
    let c = 0.7 * self_influence(&plain);
    let each = vec![c; grid.len()];
    let (uniform, _) = run(&Scene { layer: Some(Layer(Each::Uniform(c))), ..plain.clone() }, &tight(Method::Auto));
    let scene = Scene { layer: Some(Layer(Each::PerElement(&each))), ..plain };
    for method in [Method::Auto, Method::Norm] {
        // The relative residual is 1e-10, and with this layer the condition number is below 100.
        assert_near(run(&scene, &tight(method)).0.state(), &uniform.state().p, 1e-8, &format!("{method:?}"));
    }
}

#[test]
fn the_count_of_products_does_not_grow() {
    let grid = Grid::new(128, 128, 0.02, 0.02).unwrap();
    let h = ellipse(&grid);
    for load in [Load::Approach(0.2), Load::Force(0.3)] {
        let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), load);
        let products = |layer: Option<Layer<'_>>| {
            run(&Scene { layer, ..plain.clone() }, &Options::default()).1.count.matrix_products
        };
        let without = products(None);
        for relative in [1e-3, 0.1, 1.0, 10.0, 1e3] {
            let c = relative * self_influence(&plain);
            let (uniform, each) = (products(Some(Layer(Each::Uniform(c)))), uneven(&grid, c));
            let each = products(Some(Layer(Each::PerElement(&each))));
            let smooth: Vec<f64> = (0..grid.len()).map(|i| c * ((i % grid.mx) as f64 / 64.0 - 1.0).powi(2)).collect();
            let smooth = products(Some(Layer(Each::PerElement(&smooth))));
            assert!(smooth <= without + 2, "{relative}, smooth: {smooth} products, without a layer {without}");
            assert!(uniform <= without + 2, "{relative}: {uniform} products, without a layer {without}");
            // Measured with compliances over three decades, and 0 at the rim: 7 to 17 products, compared with 8 without a layer.
            assert!(each <= 2 * without + 1, "{relative}, per element: {each} products, without a layer {without}");
        }
    }
}

#[test]
fn what_is_no_layer_is_refused_by_name() {
    let grid = Grid::new(8, 8, 1.0, 1.0).unwrap();
    let h = ellipse(&grid);
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(0.3));
    let mut negative = vec![1.0; 64];
    negative[10] = -1.0;
    let short = [1.0; 63];
    let refuse = |layer: Layer<'_>, method: Method, words: &[&str]| {
        let scene = Scene { layer: Some(layer), ..plain.clone() };
        let Err(error) = solve(&scene, &tight(method)) else { panic!("{words:?}: solved") };
        assert!(words.iter().all(|word| error.to_string().contains(word)), "{error}");
    };
    refuse(Layer(Each::Uniform(-2.5)), Method::Auto, &["layer->compliance", "-2.5"]);
    refuse(Layer(Each::Uniform(f64::NAN)), Method::Auto, &["layer->compliance", "NaN"]);
    refuse(Layer(Each::PerElement(&negative)), Method::Auto, &["layer->compliances", "(2, 1)", "-1"]);
    refuse(Layer(Each::PerElement(&short)), Method::Auto, &["layer->compliances", "63", "64"]);
    refuse(Layer(Each::PerElement(&[1.0; 64])), Method::Multigrid, &["MULTIGRID", "layer"]);
    refuse(Layer(Each::PerElement(&[1.0; 64])), Method::FullMultigrid, &["FULL_MULTIGRID", "layer"]);
    let mut solver = Solver::new(&plain, &Options::default()).unwrap();
    let layered = Scene { layer: Some(Layer(Each::Uniform(1.0))), ..plain.clone() };
    let error = solver.solve(&layered, &Options::default(), None, None).unwrap_err();
    assert!(error.to_string().contains("without"), "{error}");
}
