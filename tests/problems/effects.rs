//! Pairs of effects. A pair is either solved, and the conditions with both effects hold, or it is refused with a message that names both. No effect
//! is ignored.

use std::f64::consts::PI;

use contact_normal::contact::State;
use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::influence::{radial, Coated, CoatedBody, HalfSpace, Kernel, Periodic, RowTables, Table};
use contact_normal::scene::{Bodies, Coating, Each, Layer, Load, Patches, Period, PressureLimit, Scene};
use contact_normal::solver::{solve, Options, Outcome};

const EFFECTS: [&str; 8] =
    ["influence", "layer", "pressure_limit", "period", "patches", "row_tables", "excluded elements", "coating"];

/// The pairs that are refused, as in the table of docs/effects.md. All other pairs are solved.
const REFUSED: [(&str, &str); 7] = [
    ("influence", "period"),
    ("period", "patches"),
    ("influence", "row_tables"),
    ("period", "row_tables"),
    ("influence", "coating"),
    ("period", "coating"),
    ("row_tables", "coating"),
];

/// Asserts the contact conditions by direct sums over the coefficients.
fn assert_conditions(
    scene: &Scene<'_>,
    state: &State,
    coefficient: &dyn Fn(&Scene<'_>, usize, usize) -> f64,
    names: &[&str; 2],
) {
    let (mut residual, mut distance, mut count, mut violation) = (0.0, 0.0, 0.0, 0.0f64);
    let limit = scene.pressure_limit.map_or(f64::INFINITY, |limit| limit.0.at(0));
    for (i, &h) in scene.undeformed_distance.iter().enumerate() {
        let p = state.p[i];
        assert!(p >= 0.0 && p <= limit && (h.is_finite() || p == 0.0), "{names:?}: p = {p}");
        let u: f64 =
            (0..state.p.len()).filter(|&j| state.p[j] != 0.0).map(|j| coefficient(scene, i, j) * state.p[j]).sum();
        let e = h - state.approach + u;
        if p == limit {
            violation = violation.max(e);
        } else if p > 0.0 {
            (residual, distance, count) = (residual + e * e, distance + (h - state.approach).powi(2), count + 1.0);
        } else {
            violation = violation.max(-e);
        }
    }
    // The default tolerance is 1e-6; sums of 360 terms have a round-off below 1e-12.
    assert!(residual.sqrt() <= (1e-6 + 1e-12) * distance.sqrt(), "{names:?}: {residual:e} of {distance:e}");
    assert!(violation <= (1e-6 + 1e-12) * f64::sqrt(distance / count), "{names:?}: {violation:e}");
    let force = state.p.iter().sum::<f64>() * scene.grid.element_area();
    assert!((force - 0.1).abs() <= 1e-12, "{names:?}: force {force}");
}

#[test]
fn every_pair_is_solved_or_refused_and_each_effect_tells() {
    let grid = Grid::new(20, 18, 0.1, 0.1).unwrap();
    let h: Vec<f64> = (0..grid.len())
        .map(|i| 0.02 * ((i % 20) as f64 - 9.0).powi(2) * 0.1 + 0.003 * ((i / 20) as f64 - 8.0).powi(2))
        .collect();
    let patch: Vec<i32> = (0..grid.len()).map(|i| i32::from(i % 20 > 9)).collect();
    let mut hole = h.clone();
    hole[8 * 20 + 9] = f64::INFINITY;
    let half_space = HalfSpace::new(0.1, 0.1, Bodies::same(1.0, 0.3).compliance());
    let periodic = Periodic::new(half_space.clone(), (true, false), &grid).unwrap();
    let table_at = |kx: i64, ky: i64| half_space.at(kx, ky) * (-0.3 * ((kx * kx + ky * ky) as f64).sqrt()).exp();
    let table: Vec<f64> = (0..4 * grid.len() as i64).map(|i| table_at(i % 40 - 20, i / 40 - 18)).collect();
    let table = Table::new(20, 18, &table, &grid).unwrap();
    // Coefficients that decrease from row to row, so that row tables differ from a table of offsets.
    let answers = |iy: i64| 1.0 - 0.03 * iy as f64;
    let row_tables: Vec<f64> = (0..18 * 18 * 40)
        .map(|i| {
            let (jy, iy, kx) = (i / 40 / 18, i / 40 % 18, i % 40 - 20);
            half_space.at(kx, iy - jy) * answers(iy) * answers(jy)
        })
        .collect();
    let row_tables = RowTables::new(20, 18, &row_tables, &grid).unwrap();
    // A soft coating that is two elements thick. Other tests check its coefficients.
    let below = CoatedBody { compliance: 0.7 / (2.0 * PI), layer: None };
    let above = CoatedBody { compliance: 0.6 / (2.0 * PI * 0.3), layer: Some((0.2, radial(0.3, [0.4, 0.3]))) };
    let coated = Coated::new([above, below], &grid).unwrap();
    let with = |names: [&str; 2]| {
        let has = |name: &str| names.contains(&name);
        Scene {
            influence: has("influence").then(|| table.clone()),
            layer: has("layer").then_some(Layer(Each::Uniform(0.05))),
            pressure_limit: has("pressure_limit").then_some(PressureLimit(Each::Uniform(0.15))),
            patches: has("patches").then_some(Patches { count: 2, patch: &patch, factors: &[1.0, 0.2, 0.2, 1.0] }),
            row_tables: has("row_tables").then(|| row_tables.clone()),
            coating: has("coating").then_some(Coating::of_body_1(0.2, 0.3, 0.4)),
            period: has("period").then_some(Period { x: true, y: false }),
            ..Scene::new(
                grid,
                if has("excluded elements") { &hole } else { &h },
                Bodies::same(1.0, 0.3),
                Load::Force(0.1),
            )
        }
    };
    let coefficient = |scene: &Scene<'_>, i: usize, j: usize| {
        let (ix, iy, jx, jy) = (i as i64 % 20, i as i64 / 20, j as i64 % 20, j as i64 / 20);
        let base = match (&scene.influence, &scene.row_tables, scene.period) {
            (Some(_), ..) => table_at(ix - jx, iy - jy),
            (_, Some(_), _) => half_space.at(ix - jx, iy - jy) * answers(iy) * answers(jy),
            (.., Some(_)) => periodic.at(ix - jx, iy - jy),
            _ if scene.coating.is_some() => coated.at(ix - jx, iy - jy),
            _ => half_space.at(ix - jx, iy - jy),
        };
        let factor = if scene.patches.is_some() && patch[i] != patch[j] { 0.2 } else { 1.0 };
        let layer = if scene.layer.is_some() && i == j { 0.05 } else { 0.0 };
        factor * base + layer
    };
    let solved = |names: [&str; 2]| {
        let (solver, stop, _) = solve(&with(names), &Options::default()).unwrap_or_else(|e| panic!("{names:?}: {e}"));
        assert_eq!(stop, Outcome::Converged, "{names:?}");
        let state = solver.state();
        assert_conditions(&with(names), state, &coefficient, &names);
        state.p.clone()
    };
    for (k, one) in EFFECTS.into_iter().enumerate() {
        let alone = solved([one, one]);
        for other in &EFFECTS[k + 1..] {
            if REFUSED.contains(&(one, other)) {
                let Err(Error::Unsupported(message)) = solve(&with([one, other]), &Options::default()) else {
                    panic!("{one} and {other}: not refused as UNSUPPORTED")
                };
                assert!(message.contains(one) && message.contains(other), "{message}");
                continue;
            }
            // Pressures are some 0.2. Leaving out an effect changes them by far more than the tolerance of 1e-6.
            let both = solved([one, other]);
            let second = solved([other, other]);
            for (name, single) in [(one, &alone), (*other, &second)] {
                let change = both.iter().zip(single).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(change > 1e-3, "{one} and {other}: as if there were {name} alone, {change}");
            }
        }
    }
}
