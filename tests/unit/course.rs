//! Estimated errors of largest stresses: on finer grids a stress at the surface may exceed the largest one below it.

use super::*;
use crate::grid::Grid;
use crate::scene::{Bodies, Friction, Load};

fn rolling() -> Friction<'static> {
    Friction { motion: Motion::SteadyRolling, ..Friction::new(0.3) }
}

fn course(quantity: Quantity, peaks: &[(f64, f64, f64)]) -> Course {
    let grid = Grid::new(8, 8, 1.0, 1.0).expect("a grid");
    let scene = Scene::new(grid, &[], Bodies::same(1.0, 0.3), Load::Approach(1.0));
    let mut course = Course::of(quantity, &scene);
    for (k, &(value, depth, at_surface)) in peaks.iter().enumerate() {
        let mut close = [0.0; CLOSE.len()];
        close[0] = at_surface;
        let elements = if depth == 0.0 { 0.0 } else { 10.0 };
        let peak = Peak { value, depth, elements, close };
        let value = if quantity == Quantity::VonMisesDepth { depth } else { value };
        course.add(k as i32, Value { value, peak: Some(peak), least: 0.0 }, 0.0);
    }
    course
}

/// On three grids: the stress below the surface is 1 and has converged; that at the surface is `1.3 - h^.5`. Each has the largest stress, its depth,
/// and the stress at the surface.
const OVERTAKEN: [(f64, f64, f64); 3] = [(0.99, 0.1, 0.3), (1.0, 0.1, 0.593), (1.0, 0.1, 0.8)];

#[test]
fn a_stress_at_the_surface_that_overtakes_is_counted() {
    let error = course(Quantity::MaxVonMises, &OVERTAKEN).error(false).expect("an error").now();
    // The stress at the surface tends to 1.3: the remaining change is at least 2.41 times the last one.
    assert!((0.29..0.45).contains(&error), "{error}");
    let error = course(Quantity::VonMisesDepth, &OVERTAKEN).error(false).expect("an error").now();
    assert!((error - 0.1).abs() < 1e-9, "{error}");
}

#[test]
fn a_stress_at_the_surface_that_stays_below_is_not_counted() {
    let low = OVERTAKEN.map(|(value, depth, at_surface)| (value, depth, 0.3 * at_surface));
    let error = course(Quantity::MaxVonMises, &low).error(false).expect("an error").now();
    assert!(error < 0.01, "{error}");
    let error = course(Quantity::VonMisesDepth, &low).error(false).expect("an error").now();
    assert!(error < 1e-9, "{error}");
}

/// A stress below the surface has a limit, even if its changes do not fall yet. One at the surface may be infinite.
#[test]
fn only_a_stress_at_the_surface_may_be_infinite() {
    let grows = |depth: f64| [1.0, 1.1, 1.2].map(|value| (value, depth, if depth == 0.0 { value } else { 0.1 }));
    assert!(course(Quantity::MaxShear, &grows(0.0)).error(false).is_none());
    let error = course(Quantity::MaxShear, &grows(0.2)).error(false).expect("an error").now();
    assert!((0.1..0.4).contains(&error), "{error}");
}

/// The largest stress lies at least ten elements below the surface and has converged. Another one, two elements below the surface, grows.
#[test]
fn a_stress_some_elements_below_the_surface_is_followed_too() {
    let grid = Grid::new(8, 8, 1.0, 1.0).expect("a grid");
    let scene = Scene::new(grid, &[], Bodies::same(1.0, 0.3), Load::Approach(1.0));
    let error = |grows: f64, elements: f64| {
        let mut course = Course::of(Quantity::MaxShear, &scene);
        for k in 0..3 {
            let mut close = [0.0; CLOSE.len()];
            // A stress close to the surface, with the limit 1.2.
            close[5] = 1.2 - grows * 0.5f64.powi(k).sqrt();
            let peak = Peak { value: 1.0, depth: 1.0, elements: elements * 2f64.powi(k), close };
            course.add(k, Value { value: 1.0, peak: Some(peak), least: 0.0 }, 0.0);
        }
        course.error(false).expect("an error").now()
    };
    assert!((error(0.5, 5.0) - 0.2).abs() < 1e-9, "{}", error(0.5, 5.0));
    assert_eq!(error(-0.5, 5.0), 0.0);
    // Here the largest stress on the grid before was itself at this depth.
    assert_eq!(error(0.5, 0.5), 0.0);
}

/// Close to the surface changes are assumed to fall as the square root of the element size, however small the last change is.
#[test]
fn a_largest_stress_within_an_element_is_not_believed_to_settle_at_once() {
    let near = [(0.8, 0.0, 0.8), (0.9, 0.0, 0.9), (0.901, 0.0, 0.901)];
    let error = course(Quantity::MaxShear, &near).error(false).expect("an error").now();
    assert!((0.049..0.2).contains(&error), "{error}");
}

/// A single small change may be due to chance, so that three grids are needed: for tractions, and for stresses in scenes with tractions or with a
/// limit.
#[test]
fn three_grids_are_needed_where_tractions_or_pressures_end_steeply() {
    let grid = Grid::new(8, 8, 1.0, 1.0).expect("a grid");
    let scene = Scene::new(grid, &[], Bodies::same(1.0, 0.3), Load::Approach(1.0));
    let friction = Scene { friction: Some(rolling()), ..scene.clone() };
    let is_believed = |quantity: Quantity, scene: &Scene<'_>, limit: bool| {
        let mut course = Course::of(quantity, scene);
        [0, 1, 2].map(|k| {
            course.add(k, Value::from(1.0), 0.0);
            if limit {
                course.reaches_limit();
            }
            course.is_believed()
        })
    };
    assert_eq!(is_believed(Quantity::MaxShear, &scene, false), [true; 3]);
    assert_eq!(is_believed(Quantity::MaxShear, &scene, true), [false, false, true]);
    assert_eq!(is_believed(Quantity::MaxShear, &friction, false), [false, false, true]);
    assert_eq!(is_believed(Quantity::SpinMoment, &friction, false), [false, false, true]);
    assert_eq!(is_believed(Quantity::MeanGap, &friction, true), [true; 3]);
}

/// If the pressure is not resolved, a stress some elements below the surface has no estimate, unless it lies deep.
#[test]
fn a_stress_below_a_pressure_that_is_not_resolved_is_not_believed() {
    let grid = Grid::new(8, 8, 1.0, 1.0).expect("a grid");
    let scene = Scene::new(grid, &[], Bodies::same(1.0, 0.3), Load::Approach(1.0));
    let is_believed = |elements: f64, is_known: bool| {
        let mut course = Course::of(Quantity::MaxVonMises, &scene);
        let peak = Peak { value: 1.0, depth: 1.0, elements, close: [0.0; CLOSE.len()] };
        course.add(0, Value { value: 1.0, peak: Some(peak), least: 0.0 }, 0.0);
        course.below_known_pressure(is_known);
        course.is_believed()
    };
    assert_eq!(
        [(1.0, true), (1.0, false), (10.0, false)].map(|(at, known)| is_believed(at, known)),
        [true, false, true]
    );
}

/// Creepages that change by -154 and -99. For like bodies their error is of first order. For unlike bodies further changes may fall no faster than
/// these.
#[test]
fn steady_rolling_of_unlike_bodies_is_slow() {
    let grid = Grid::new(8, 8, 1.0, 1.0).expect("a grid");
    let error = |nu: f64| {
        let bodies = Bodies { shear_modulus: [1.0, 2.0], poisson_ratio: [0.3, nu] };
        let scene = Scene { friction: Some(rolling()), ..Scene::new(grid, &[], bodies, Load::Approach(1.0)) };
        let mut course = Course::of(Quantity::Creepage, &scene);
        for (k, value) in [3608.0, 3454.0, 3355.0].into_iter().enumerate() {
            course.add(k as i32, Value::from(value), 0.0);
        }
        course.error(false).expect("an error").now()
    };
    assert!((error(0.1) - 99.0).abs() < 1e-9, "{}", error(0.1));
    assert!((178.0..179.0).contains(&error(0.25)), "{}", error(0.25));
}

/// Three grids agree by chance on an area of 1828 elements, but its outline is uncertain, and so is the area.
#[test]
fn an_area_is_no_better_than_its_outline() {
    let grid = Grid::new(8, 8, 1.0, 1.0).expect("a grid");
    let scene = Scene::new(grid, &[], Bodies::same(1.0, 0.3), Load::Approach(1.0));
    let mut course = Course::of(Quantity::StickArea, &scene);
    for (k, counted) in [114.0, 457.0, 1828.0].into_iter().enumerate() {
        let least = 0.3 / f64::sqrt(counted);
        course.add(k as i32, Value { value: 1.828, peak: None, least }, 0.0);
    }
    let falling = course.error(false).expect("an error");
    assert!((falling.now() - 0.3 * 1.828 / 1828f64.sqrt()).abs() < 1e-12, "{falling:?}");
    assert!((falling.after(1) - 0.5 * falling.now()).abs() < 1e-12, "{falling:?}");
}
