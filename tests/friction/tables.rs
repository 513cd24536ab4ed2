//! A caller's tables of tangential coefficients. Tables with the coefficients of the half-space give its results. Invalid tables are refused with a
//! message that names them.

use std::f64::consts::PI;

use contact_normal::error::Error;
use contact_normal::friction::cross::integrals;
use contact_normal::friction::{Compliance, Solution, Tangential};
use contact_normal::grid::Grid;
use contact_normal::influence::{HalfSpace, Kernel, RowTables, Table};
use contact_normal::scene::{
    Bodies, Coating, CoatingLayer, Friction, Load, Motion, Prescribed, Previous, Scene, TangentialInfluence,
};
use contact_normal::solver::{solve, solve_tangential, Options, Outcome, Solver};

use super::case::{distance, grid};

const STEEL: Bodies = Bodies { shear_modulus: [82000.0; 2], poisson_ratio: [0.28; 2] };
/// Columns and rows of the tables beyond those of the grid.
const BEYOND: usize = 2;

fn ball(mx: usize, my: usize) -> (Grid, Vec<f64>) {
    let grid = grid(mx, my, 0.06, 0.05);
    (grid, distance(&grid, |x, y| (x * x + y * y) / 100.0))
}

/// The tables xx, yy and xy of the steel half-space, divided by `scale`, a power of two.
fn tables(grid: &Grid, scale: f64) -> [Vec<f64>; 3] {
    tables_of(&STEEL, grid, scale)
}

fn tables_of(bodies: &Bodies, grid: &Grid, scale: f64) -> [Vec<f64>; 3] {
    let tangential = Tangential::new(grid.dx, grid.dy, Compliance::of(bodies));
    let (cx, cy) = (grid.mx + BEYOND, grid.my + BEYOND);
    let offset = |k: usize, c: usize| (k % (2 * c)) as f64 - c as f64;
    [0, 1, 2].map(|component| {
        let value = |k: usize| tangential.at(offset(k, cx), offset(k / (2 * cx), cy))[component] / scale;
        (0..4 * cx * cy).map(value).collect()
    })
}

fn influence<'a>(grid: &Grid, tables: &'a [Vec<f64>; 3], scale: f64) -> TangentialInfluence<'a> {
    let coefficients = [&tables[0][..], &tables[1][..], &tables[2][..]];
    TangentialInfluence { cx: grid.mx + BEYOND, cy: grid.my + BEYOND, coefficients, cross: None, scale, by_row: false }
}

fn pushed() -> Friction<'static> {
    Friction { prescribed: [Prescribed::Creepage(-1e-3), Prescribed::Force(60.0)], spin: 1e-3, ..Friction::new(0.3) }
}

fn steps() -> [Friction<'static>; 3] {
    let rolling = Friction { motion: Motion::TransientRolling, previous: Previous::Kept, ..pushed() };
    let aside = Friction { rolling_direction: 0.5 * PI, rolling_distance: 0.1, ..rolling };
    [pushed(), rolling, aside]
}

fn solved<'a>(scene: &Scene<'a>, own: Option<TangentialInfluence<'a>>, tolerance: f64) -> Vec<Solution> {
    let options = Options { tolerance, ..Options::default() };
    let tables = Friction { influence: own, ..Friction::new(0.3) };
    let mut solver = Solver::new(&Scene { friction: Some(tables), ..scene.clone() }, &options).unwrap();
    let step = |friction: Friction<'a>| {
        let scene = Scene { friction: Some(Friction { influence: own, ..friction }), ..scene.clone() };
        let (stop, _) = solver.solve(&scene, &options, None, None).unwrap();
        assert_eq!(stop, Outcome::Converged);
        solver.friction().unwrap().clone()
    };
    steps().into_iter().map(step).collect()
}

#[test]
fn tables_of_the_half_space_give_what_the_half_space_gives() {
    // On a grid without coarser grids every number is the same. Otherwise only the coefficients on the coarser grids differ.
    for (m, most) in [(20, 0.0), (48, 1e-5)] {
        let (grid, h) = ball(m, m - 2);
        let scene = Scene::new(grid, &h, STEEL, Load::Force(900.0));
        let known = solved(&scene, None, 1e-8);
        for scale in [1.0, 0.25] {
            let tables = tables(&grid, scale);
            let found = solved(&scene, Some(influence(&grid, &tables, scale)), 1e-8);
            for (known, found) in known.iter().zip(&found) {
                let largest = known.traction.iter().map(|q| q[0].hypot(q[1])).fold(0.0, f64::max);
                for (a, b) in known.traction.iter().zip(&found.traction) {
                    let off = (a[0] - b[0]).hypot(a[1] - b[1]);
                    // The error of tractions with a residual of 1e-8: docs/friction.md has 1e-5 at 1e-6, and the error falls with the square root.
                    assert!(off <= most * largest, "{m}: {off:e} of {largest}");
                }
            }
        }
    }
}

#[test]
fn own_coefficients_of_both_problems_need_no_bodies() {
    let (grid, h) = ball(20, 18);
    let half_space = HalfSpace::new(grid.dx, grid.dy, 2.0 * (1.0 - 0.28) / 82000.0 / 2.0);
    let (cx, cy) = (grid.mx as i64, grid.my as i64);
    let normal: Vec<f64> =
        (-cy..cy).flat_map(|ky| (-cx..cx).map(move |kx| (kx, ky))).map(|(kx, ky)| half_space.at(kx, ky)).collect();
    let tables = tables(&grid, 1.0);
    let scene = |bodies, is_own: bool| Scene {
        influence: is_own.then(|| Table::new(grid.mx, grid.my, &normal, &grid).unwrap()),
        friction: Some(Friction { influence: is_own.then(|| influence(&grid, &tables, 1.0)), ..pushed() }),
        ..Scene::new(grid, &h, bodies, Load::Force(900.0))
    };
    let options = Options { tolerance: 1e-8, ..Options::default() };
    let none = Bodies { shear_modulus: [0.0; 2], poisson_ratio: [0.0; 2] };
    let (known, ..) = solve(&scene(STEEL, false), &options).unwrap();
    let (found, ..) = solve(&scene(none, true), &options).unwrap();
    for (a, b) in known.friction().unwrap().traction.iter().zip(&found.friction().unwrap().traction) {
        // The pressures, too, are those of two kernels with the same coefficients, each to a residual of 1e-8. The tolerance is 1e-5 of tractions of
        // mu N over some hundred elements.
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) <= 1e-5 * 0.3 * 900.0 / grid.element_area() / 100.0, "{a:?} {b:?}");
    }
}

/// Steel on a body that is eight times softer.
const UNLIKE: Bodies = Bodies { shear_modulus: [82000.0, 10000.0], poisson_ratio: [0.28, 0.2] };

/// The tables Axz and Ayz of unlike half-spaces.
fn cross_tables(grid: &Grid) -> [Vec<f64>; 2] {
    let unlike = Compliance::of(&UNLIKE).unlike;
    let (cx, cy) = ((grid.mx + BEYOND) as i64, (grid.my + BEYOND) as i64);
    [0, 1].map(|component| {
        let offsets = (-cy..cy).flat_map(|ky| (-cx..cx).map(move |kx| (kx as f64, ky as f64)));
        offsets.map(|(x, y)| -unlike / PI * integrals(x, y, grid.dx, grid.dy)[component]).collect()
    })
}

#[test]
fn tables_of_unlike_half_spaces_give_what_these_give() {
    let (grid, h) = ball(20, 18);
    let scene = Scene::new(grid, &h, UNLIKE, Load::Force(900.0));
    let (tables, [xz, yz]) = (tables_of(&UNLIKE, &grid, 1.0), cross_tables(&grid));
    let own = TangentialInfluence { cross: Some([&xz, &yz]), ..influence(&grid, &tables, 1.0) };
    let known = solved(&scene, None, 1e-8);
    let found = solved(&scene, Some(own), 1e-8);
    for (known, found) in known.iter().zip(&found) {
        // The same coefficients are used in the same order, so that the bits are equal.
        assert_eq!(known.traction, found.traction);
    }
    // Without the coupling of pressures and tractions the result differs.
    let like = solved(&Scene { bodies: STEEL, ..scene.clone() }, Some(influence(&grid, &tables, 1.0)), 1e-8);
    assert_ne!(like[0].traction, found[0].traction);
    let (mut even, good) = (xz.clone(), &yz);
    let middle = (grid.my + BEYOND) * 2 * (grid.mx + BEYOND) + grid.mx + BEYOND;
    even[middle + 3] = -even[middle + 3];
    for (cross, words) in
        [([&even[..], good], "(xz)"), ([&xz[..], &xz[..]], "(yz)"), ([&xz[..], &[]], "(yz) has 0 values")]
    {
        let own = TangentialInfluence { cross: Some(cross), ..own };
        let friction = Some(Friction { influence: Some(own), ..pushed() });
        let error = solve(&Scene { friction, ..scene.clone() }, &Options::default()).err().unwrap().to_string();
        assert!(error.contains(words), "{error} ({words})");
    }
}

#[test]
fn a_handle_refuses_other_tables_until_they_are_set() {
    let (grid, h) = ball(20, 18);
    let (tables, half) = (tables(&grid, 1.0), tables(&grid, 2.0));
    let scene = |tables| Scene {
        friction: Some(Friction { influence: Some(influence(&grid, tables, 1.0)), ..pushed() }),
        ..Scene::new(grid, &h, STEEL, Load::Force(900.0))
    };
    let options = Options::default();
    let mut handle = Solver::new(&scene(&tables), &options).unwrap();
    handle.solve(&scene(&tables), &options, None, None).unwrap();
    let refused = handle.solve(&scene(&half), &options, None, None).map(|_| ());
    assert!(matches!(&refused, Err(Error::InfluenceChanged(_))), "{refused:?}");
    handle.set_tangential_influence(scene(&half).friction.as_ref().unwrap()).unwrap();
    handle.solve(&scene(&half), &options, None, None).unwrap();
    let (fresh, ..) = solve(&scene(&half), &options).unwrap();
    let (first, ..) = solve(&scene(&tables), &options).unwrap();
    let traction = |solver: &Solver| solver.friction().unwrap().traction.clone();
    let off = |a: &[[f64; 2]], b: &[[f64; 2]]| a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f64::max);
    let largest = traction(&fresh).iter().map(|q| q[0].abs()).fold(0.0, f64::max);
    // A start from the last result changes the pressures within their tolerance.
    assert!(off(&traction(&handle), &traction(&fresh)) <= 1e-3 * largest);
    assert!(off(&traction(&first), &traction(&fresh)) > 1e-2 * largest, "the tables do not matter here");
}

#[test]
fn tables_that_are_none_are_refused_by_name() {
    let (grid, h) = ball(20, 18);
    let good = tables(&grid, 1.0);
    let of =
        |tables: &[Vec<f64>; 3], change: &dyn Fn(&mut TangentialInfluence<'_>), friction: Friction<'static>, bodies| {
            let mut own = influence(&grid, tables, 1.0);
            change(&mut own);
            let friction = Some(Friction { influence: Some(own), ..friction });
            let scene = Scene { friction, ..Scene::new(grid, &h, bodies, Load::Force(900.0)) };
            solve(&scene, &Options::default()).err()
        };
    let as_it_is = |_: &mut TangentialInfluence<'_>| ();
    let refused = |error: Option<Error>, words: &str| {
        let message = error.as_ref().expect(words).to_string();
        assert!(message.contains(words), "{message} ({words})");
        error.unwrap()
    };
    assert!(of(&good, &as_it_is, pushed(), STEEL).is_none());
    let with = |component: usize, k: usize, value: f64| {
        let mut tables = good.clone();
        tables[component][k] = value;
        tables
    };
    let width = 2 * (grid.mx + BEYOND);
    let middle = (grid.my + BEYOND) * width + grid.mx + BEYOND;
    let error = of(&with(0, middle + 3, f64::NAN), &as_it_is, pushed(), STEEL);
    assert!(matches!(refused(error, "(xx) at offset (3, 0) is NaN"), Error::NotFinite(_)));
    for (component, name) in ["(xx)", "(yy)", "(xy)"].into_iter().enumerate() {
        let error = of(&with(component, middle - 2 + width, 0.1 * good[0][middle]), &as_it_is, pushed(), STEEL);
        assert!(matches!(refused(error, name), Error::Unsupported(_)));
    }
    let error = of(&with(1, middle, -1.0), &as_it_is, pushed(), STEEL);
    assert!(matches!(refused(error, "offset (0, 0)"), Error::NotPositiveDefinite(_)));
    for (change, words) in [
        (&(|own: &mut TangentialInfluence<'_>| own.cx = 19) as &dyn Fn(&mut TangentialInfluence<'_>), "cx is 19"),
        (&|own| own.cy = usize::MAX, "2 cx by 2 cy"),
        (&|own| own.scale = 0.0, "scale is 0"),
        (&|own| own.coefficients[2] = &[], "(xy) has 0 values"),
    ] {
        refused(of(&good, change, pushed(), STEEL), words);
    }
    let rolling = Friction { motion: Motion::TransientRolling, ..pushed() };
    for (direction, distance, words) in
        [(0.3, 0.06, "whole elements"), (0.0, 0.07, "whole elements"), (0.0, 0.18, "a step of rolling ask for 23")]
    {
        let friction = Friction { rolling_direction: direction, rolling_distance: distance, ..rolling };
        refused(of(&good, &as_it_is, friction, STEEL), words);
    }
    let unlike = Bodies { shear_modulus: [82000.0, 1000.0], poisson_ratio: [0.28, 0.4] };
    refused(of(&good, &as_it_is, pushed(), unlike), "unlike bodies");
}

/// The normal problem has row tables or a coating, and the tangential problem has tables. The pressures are those of the scene without friction, and
/// the tractions those that belong to these pressures.
#[test]
fn own_coefficients_go_with_row_tables_and_coatings() {
    let (grid, h) = ball(20, 18);
    let tables = tables(&grid, 1.0);
    let own = Some(influence(&grid, &tables, 1.0));
    // Each row is softer than the one before by .5 % as a load and by .5 % as a place, which a table of offsets cannot describe.
    let half_space = HalfSpace::new(grid.dx, grid.dy, STEEL.compliance());
    let value = |k: usize| {
        let (x, iy, jy) = ((k % 40) as i64 - 20, (k / 40 % 18) as i64, (k / 720) as i64);
        (1.0 + 0.005 * (iy + jy) as f64) * half_space.at(x, iy - jy)
    };
    let rows: Vec<f64> = (0..18 * 18 * 40).map(value).collect();
    let plain = Scene::new(grid, &h, STEEL, Load::Force(900.0));
    let layer = CoatingLayer { thickness: 0.1, shear_modulus: 20000.0, poisson_ratio: 0.3 };
    let coating = Some(Coating { layers: [Some(layer), None] });
    let row_tables = Some(RowTables::new(20, 18, &rows, &grid).unwrap());
    let options = Options { tolerance: 1e-9, ..Options::default() };
    for scene in [Scene { row_tables, ..plain.clone() }, Scene { coating, ..plain.clone() }] {
        let (normal, stop, _) = solve(&scene, &options).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let friction = Friction { influence: own, ..pushed() };
        let (found, stop, _) = solve(&Scene { friction: Some(friction), ..scene.clone() }, &options).unwrap();
        assert_eq!(stop, Outcome::Converged);
        assert_eq!(found.state().p, normal.state().p);
        // The expected tractions are those of the half-space with these pressures, because the tables have its coefficients.
        let alone = Scene { friction: Some(pushed()), ..plain.clone() };
        let (stop, expected, _) = solve_tangential(&alone, &normal.state().p, &options, None).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let largest = expected.traction.iter().flatten().fold(0.0f64, |most, q| most.max(q.abs()));
        for (a, b) in found.friction().unwrap().traction.iter().zip(&expected.traction) {
            assert!((0..2).all(|k| (a[k] - b[k]).abs() <= 1e-6 * largest), "{a:?} {b:?}");
        }
        let without = Scene { friction: Some(pushed()), ..scene.clone() };
        assert!(matches!(solve(&without, &options).map(|_| ()), Err(Error::Unsupported(_))));
    }
}

#[test]
fn coefficients_larger_than_those_of_an_element_on_itself_are_refused() {
    let (grid, h) = ball(12, 10);
    let refusal = |influence: TangentialInfluence<'_>| {
        let friction = Friction { influence: Some(influence), ..pushed() };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, STEEL, Load::Force(900.0)) };
        match solve(&scene, &Options::default()) {
            Err(Error::NotPositiveDefinite(message)) => message,
            other => panic!("{:?}", other.err()),
        }
    };
    let (cx, cy) = (grid.mx + BEYOND, grid.my + BEYOND);
    // A wrong layout: offset (0, 0) is the first value, as in an FFT. Without Poisson's ratio xy is 0, and xx and yy are symmetric in this layout,
    // too, so that only their sizes show the mistake.
    let mut first = tables_of(&Bodies { shear_modulus: [82000.0; 2], poisson_ratio: [0.0; 2] }, &grid, 1.0);
    for table in &mut first {
        let centred = table.clone();
        for (k, value) in table.iter_mut().enumerate() {
            *value = centred[(k / (2 * cx) + cy) % (2 * cy) * 2 * cx + (k + cx) % (2 * cx)];
        }
    }
    assert!(refusal(influence(&grid, &first, 1.0)).contains("(xx)"));
    // One table has coefficients at neighbouring elements that are 1 % too large.
    for (component, place) in [(0, (1, 0)), (1, (0, 1)), (2, (1, 1))] {
        let mut changed = tables(&grid, 1.0);
        let own = changed[component.min(1)][cy * 2 * cx + cx];
        for (sign_x, sign_y) in [(1, 1), (1, -1), (-1, 1), (-1, -1)] {
            let (x, y) = (cx as i64 + sign_x * place.0, cy as i64 + sign_y * place.1);
            let sign = if component == 2 { (sign_x * sign_y) as f64 } else { 1.0 };
            changed[component][y as usize * 2 * cx + x as usize] = sign * 1.01 * own;
        }
        let message = refusal(influence(&grid, &changed, 1.0));
        assert!(message.contains(["(xx)", "(yy)", "(xy)"][component]) && message.contains("[cy][cx]"), "{message}");
    }
}
