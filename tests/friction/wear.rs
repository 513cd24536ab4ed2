//! Frictional work and wear: balances of energy by direct sums, and closed forms.

use contact_normal::error::Error;
use contact_normal::friction::{dense, Solution};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Coefficient, Friction, Load, Motion, Prescribed, Previous, Scene};
use contact_normal::solver::{solve, Options, Outcome};
use contact_normal::wear::{frictional_wear, Wear, Worn};

use super::steady::rolling;
use super::steady_scenes::ellipse;
use super::support::{run, solver, tangential};

const NU: f64 = 0.28;

/// x and y in arrays of their own.
fn split(of: &[[f64; 2]]) -> [Vec<f64>; 2] {
    [0, 1].map(|k| of.iter().map(|v| v[k]).collect())
}

/// By the work, K/H = 1; tractions and slips are those of the solution that goes with it.
fn by_work(grid: &Grid) -> Wear<'static> {
    Wear {
        grid: *grid,
        traction: [&[]; 2],
        slip: [&[]; 2],
        pressure: None,
        coefficient: Coefficient::Uniform(1.0),
        hardness: 1.0,
        steps: 1.0,
        rolling_distance: 0.0,
    }
}

fn worn(found: &Solution, wear: Wear<'_>) -> Worn {
    let (q, s) = (split(&found.traction), split(&found.slip));
    frictional_wear(&Wear { traction: [&q[0], &q[1]], slip: [&s[0], &s[1]], ..wear }).expect("wear")
}

/// q . (w + A q - A' q'), by direct sums: w is the rigid slip, A' q' what the tractions before the step displaced.
fn put_in(grid: &Grid, friction: &Friction<'_>, found: &Solution, before: &[[f64; 2]]) -> (f64, f64) {
    let (n, q) = (grid.len(), &found.traction);
    let (mut u, mut u_before) = (vec![[0.0; 2]; n], vec![[0.0; 2]; n]);
    let by = match friction.motion {
        Motion::Shift => (0.0, 0.0),
        _ => friction.elements_rolled(grid),
    };
    dense::apply(&tangential(grid, NU), grid, (0.0, 0.0), q, &mut u);
    dense::apply(&tangential(grid, NU), grid, by, before, &mut u_before);
    let (mut sum, mut scale) = (0.0, 0.0);
    for i in 0..n {
        let w = friction.rigid_slip_at(grid, i);
        for k in 0..2 {
            sum -= q[i][k] * (w[k] + u[i][k] - u_before[i][k]);
            scale += q[i][k].abs() * (w[k].abs() + u[i][k].abs() + u_before[i][k].abs());
        }
    }
    (sum * grid.element_area(), scale * grid.element_area())
}

#[test]
fn the_work_of_all_elements_is_what_the_motion_puts_in_less_what_is_stored() {
    let (grid, g) = ellipse(0.7, 28);
    let shift = Friction {
        prescribed: [Prescribed::Creepage(-0.2), Prescribed::Creepage(0.1)],
        spin: 0.05,
        ..Friction::new(1.0)
    };
    let (_, first) = run(&mut solver(&grid, NU), &g, &shift, 1e-6);
    let q = split(&first.traction);
    let step = Friction {
        motion: Motion::TransientRolling,
        previous: Previous::Given([&q[0], &q[1]]),
        ..rolling([-0.3, 0.1], 0.2)
    };
    let steady = rolling([-0.3, 0.1], 0.4);
    for (friction, before) in [(&shift, None), (&step, Some(&first)), (&steady, None)] {
        let (_, found) = run(&mut solver(&grid, NU), &g, friction, 1e-6);
        let none = vec![[0.0; 2]; grid.len()];
        let before = match (friction.motion, before) {
            (Motion::SteadyRolling, _) => &found.traction,
            (_, Some(before)) => &before.traction,
            _ => &none,
        };
        let (exact, scale) = put_in(&grid, friction, &found, before);
        let total = worn(&found, by_work(&grid)).total_work;
        // Of coefficients, transforms and sums, as for the conditions.
        assert!((total - exact).abs() <= 1e-12 * scale, "{friction:?}: {total} {exact}");
        assert!(total > 0.0);
    }
}

/// Bodies that slide on, from full sliding: displacements stay, all of the motion is slip, and the work is mu F s.
#[test]
fn a_hertzian_contact_that_slides_on_loses_mu_f_s() {
    let (mu, n, d, radius, force) = (0.3, 48, 0.25, 500.0, 1000.0);
    let grid = Grid::new(n, n, d, d).unwrap();
    let at = |k: usize| (k as f64 - 0.5 * (n as f64 - 1.0)) * d;
    let h: Vec<f64> = (0..n * n).map(|i| (at(i % n).powi(2) + at(i / n).powi(2)) / (2.0 * radius)).collect();
    let slide = [-0.12, 0.09];
    let steel = Bodies::same(82000.0, NU);
    let solved = |before: Option<&[Vec<f64>; 2]>| {
        let previous = before.map_or(Previous::None, |q| Previous::Given([&q[0], &q[1]]));
        let friction = Friction { prescribed: slide.map(Prescribed::Creepage), previous, ..Friction::new(mu) };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, steel, Load::Force(force)) };
        let (solver, stop, _) = solve(&scene, &Options { tolerance: 1e-10, ..Options::default() }).unwrap();
        assert_eq!(stop, Outcome::Converged);
        (solver.friction().unwrap().clone(), solver.state().p.clone())
    };
    // Tractions turn towards the motion, by a hundredth of what is left in each step.
    let (mut found, mut p) = solved(None);
    for _ in 0..5 {
        let q = split(&found.traction);
        (found, p) = solved(Some(&q));
    }
    let (exact, most) = (mu * force * 0.15, p.iter().copied().fold(0.0, f64::max));
    let once = worn(&found, by_work(&grid));
    // The elastic displacement is a hundredth of the slip; directions of both steps are the same to the tolerance of 1e-10, relative to the slip.
    assert!((once.total_work / exact - 1.0).abs() <= 1e-9, "{} {exact}", once.total_work);
    assert!((once.volume / exact - 1.0).abs() <= 1e-9);
    assert!((once.largest / (mu * most * 0.15) - 1.0).abs() <= 1e-9 && p[once.at] == most);
    for (work, p) in once.work.iter().zip(&p) {
        assert!((work - mu * p * 0.15).abs() <= 1e-9 * mu * most * 0.15);
    }
    // Archard by the load: K F s/H, of 2.5 steps, K of each element.
    let own: Vec<f64> = (0..n * n).map(|i| if i % n < n / 2 { 1e-3 } else { 3e-3 }).collect();
    let coefficient = Coefficient::PerElement(&own);
    let wear = Wear { pressure: Some(&p), hardness: 2000.0, steps: 2.5, coefficient, ..by_work(&grid) };
    let by_load = worn(&found, wear);
    let halves = 2.5 * 2e-3 / 2000.0 * force * 0.15;
    // Pressures of both halves are the same to the tolerance of the certificate of pressures.
    assert!((by_load.volume / halves - 1.0).abs() <= 1e-6, "{} {halves}", by_load.volume);
    assert!((by_load.total_work / (2.5 * exact) - 1.0).abs() <= 1e-9 && by_load.passage.is_empty());
}

/// Carter: the power is `F xi V`, with F = mu N (1 - (a'/a)^2), and a point loses K/H F xi/width in a passage.
#[test]
fn a_cylinder_that_rolls_wears_as_carter_says() {
    let (creepage, load, width) = (0.00024, 35780.0, 200.0);
    let mut before = f64::INFINITY;
    for m in [110, 220, 440] {
        let dx = 2.2 / m as f64;
        let grid = Grid::new(m, 1, dx, width).unwrap();
        let h: Vec<f64> = (0..m).map(|i| 0.001 * (-1.07 + (i as f64 + 0.5) * dx).powi(2)).collect();
        let friction = Friction {
            motion: Motion::SteadyRolling,
            prescribed: [Prescribed::Creepage(-creepage), Prescribed::Creepage(0.0)],
            ..Friction::new(0.3)
        };
        let scene =
            Scene { friction: Some(friction), ..Scene::new(grid, &h, Bodies::same(82000.0, NU), Load::Force(load)) };
        let (solver, stop, report) = solve(&scene, &Options::default()).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let force = report.friction.unwrap().force[0];
        let speed = 20_000.0;
        let wear = Wear { steps: speed / dx, rolling_distance: dx, hardness: 1e6, ..by_work(&grid) };
        let worn = worn(solver.friction().unwrap(), wear);
        // The stick area is .6 a.
        let exact = 0.3 * load * 0.64 * creepage * speed;
        let error = (worn.total_work / exact - 1.0).abs();
        // The error of the force is .8/m of mu N, 1.25/m of itself; the differences over an element dissipate as much again at most.
        assert!(error <= 2.5 / m as f64 && error < 0.9 * before, "{m}: {error} {before}");
        // The work is below force times creepage by what differences dissipate: never above it.
        assert!(worn.total_work <= force * creepage * speed * (1.0 + 1e-6), "{} {force}", worn.total_work);
        let passage = 0.3 * load * 0.64 * creepage / width / 1e6;
        assert!((worn.passage[0] / passage - 1.0).abs() <= 2.5 / m as f64 && worn.passage.len() == 1);
        before = error;
    }
}

#[test]
fn numbers_out_of_their_range_are_refused() {
    let grid = Grid::new(2, 2, 1.0, 1.0).unwrap();
    let (ones, bad) = ([1.0; 4], [1.0, f64::NAN, 0.0, 0.0]);
    let wear = Wear { traction: [&ones; 2], slip: [&ones; 2], ..by_work(&grid) };
    let refused = |wear: &Wear<'_>| frictional_wear(wear).expect_err("a refusal").to_string();
    assert!(refused(&Wear { hardness: 0.0, ..wear }).contains("hardness"));
    assert!(refused(&Wear { steps: -1.0, ..wear }).contains("steps"));
    assert!(refused(&Wear { rolling_distance: -1.0, ..wear }).contains("rolling_distance"));
    assert!(refused(&Wear { coefficient: Coefficient::Uniform(-1.0), ..wear }).contains("coefficient"));
    let negative = [1.0, 1.0, -1.0, 1.0];
    let own = refused(&Wear { coefficient: Coefficient::PerElement(&negative), ..wear });
    assert!(own.contains("coefficients of element (0, 1) is -1"), "{own}");
    assert!(refused(&Wear { slip: [&ones, &ones[..3]], ..wear }).contains("slip[1]"));
    for each in [Wear { pressure: Some(&bad), ..wear }, Wear { traction: [&bad, &ones], ..wear }] {
        assert!(matches!(frictional_wear(&each), Err(Error::NotFinite(_))));
    }
    // Tractions along the slip: a work below 0, which wears nothing.
    let along = frictional_wear(&wear).unwrap();
    assert!(along.total_work == -8.0 && along.volume == 0.0 && along.largest == 0.0);
}
