//! Frictional work and wear, compared with balances of energy by direct sums and with closed forms.

use contact_normal::error::Error;
use contact_normal::friction::Solution;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Coefficient, Friction, Load, Motion, Prescribed, Previous, Scene};
use contact_normal::solver::{solve, Options, Outcome};
use contact_normal::wear::{frictional_wear, Wear, Worn};

use super::case::distance;
use super::dense;
use super::steady::rolling;
use super::steady_scenes::ellipse;
use super::support::{run, solver, tangential};

const NU: f64 = 0.28;

/// The x and y components in separate arrays.
fn split(of: &[[f64; 2]]) -> [Vec<f64>; 2] {
    [0, 1].map(|k| of.iter().map(|v| v[k]).collect())
}

/// Input of wear by frictional work, with K/H = 1 and no tractions yet.
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

/// The work of the motion, the sum of q . (w + A q - A' q') by direct sums. w is the rigid slip, and A' q' the displacement by the previous
/// tractions. Also returns the scale of its round-off.
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
        // The round-off of coefficients, transforms and sums: the same factor of 1e-12 as for the conditions (support.rs).
        assert!((total - exact).abs() <= 1e-12 * scale, "{friction:?}: {total} {exact}");
        assert!(total > 0.0);
    }
}

/// Bodies in full slip slide on. The displacements do not change, so that the whole motion is slip, and the work is mu F s.
#[test]
fn a_hertzian_contact_that_slides_on_loses_mu_f_s() {
    let (mu, n, d, radius, force) = (0.3, 48, 0.25, 500.0, 1000.0);
    let grid = Grid::new(n, n, d, d).unwrap();
    let h = distance(&grid, |x, y| (x * x + y * y) / (2.0 * radius));
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
    // In each step tractions turn towards the motion, until a hundredth of the angle is left.
    let (mut found, mut p) = solved(None);
    for _ in 0..5 {
        let q = split(&found.traction);
        (found, p) = solved(Some(&q));
    }
    let (exact, most) = (mu * force * 0.15, p.iter().copied().fold(0.0, f64::max));
    let once = worn(&found, by_work(&grid));
    // The elastic displacement is a hundredth of the slip. The directions of two successive steps differ by the tolerance of 1e-10, relative to the
    // slip.
    assert!((once.total_work / exact - 1.0).abs() <= 1e-9, "{} {exact}", once.total_work);
    assert!((once.volume / exact - 1.0).abs() <= 1e-9);
    assert!((once.largest / (mu * most * 0.15) - 1.0).abs() <= 1e-9 && p[once.at] == most);
    for (work, p) in once.work.iter().zip(&p) {
        assert!((work - mu * p * 0.15).abs() <= 1e-9 * mu * most * 0.15);
    }
    // Archard's law by pressure and slip: the volume K F s/H for 2.5 steps, with K per element.
    let own: Vec<f64> = (0..n * n).map(|i| if i % n < n / 2 { 1e-3 } else { 3e-3 }).collect();
    let coefficient = Coefficient::PerElement(&own);
    let wear = Wear { pressure: Some(&p), hardness: 2000.0, steps: 2.5, coefficient, ..by_work(&grid) };
    let by_load = worn(&found, wear);
    let halves = 2.5 * 2e-3 / 2000.0 * force * 0.15;
    // The mean of the two K counts, because both halves have the same pressures, to the tolerance of the normal problem.
    assert!((by_load.volume / halves - 1.0).abs() <= 1e-6, "{} {halves}", by_load.volume);
    assert!((by_load.total_work / (2.5 * exact) - 1.0).abs() <= 1e-9 && by_load.passage.is_empty());
}

/// Carter's cylinder: the power is `F xi V`, with F = mu N (1 - (a'/a)^2), and the depth of wear in a passage is K/H F xi/width.
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
        // The stick area is a' = .6 a: F = .64 mu N.
        let exact = 0.3 * load * 0.64 * creepage * speed;
        let error = (worn.total_work / exact - 1.0).abs();
        // The error of the force is .8/m of mu N (steady.rs), 1.25/m of the force. Differences of displacements over an element dissipate at most as
        // much again.
        assert!(error <= 2.5 / m as f64 && error < 0.9 * before, "{m}: {error} {before}");
        // The work never exceeds force times creepage, because the difference of displacements loses work.
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
    // Tractions in the direction of the slip have a negative work, which wears nothing off.
    let along = frictional_wear(&wear).unwrap();
    assert!(along.total_work == -8.0 && along.volume == 0.0 && along.largest == 0.0);
}

/// Inputs that are multiplied by powers of two give results that are multiplied by powers of two, also if products of single factors overflow or
/// underflow.
#[test]
fn work_and_depth_are_right_at_the_ends_of_the_range_of_numbers() {
    let by = |value: f64, power: i32| value * 2f64.powi(power / 2) * 2f64.powi(power - power / 2);
    let at = |k: usize| 0.3 + 0.7 * (0.37 * k as f64).sin().abs();
    let field = |from: usize, power: i32| -> Vec<f64> { (from..from + 12).map(|k| by(at(k), power)).collect() };
    // The powers of q, s, p, K, H, the steps, dx, dy and dq, in this order.
    let of = |powers: [i32; 9], by_load: bool| {
        let [of_q, of_s, of_p, of_k, of_h, of_steps, of_dx, of_dy, of_dq] = powers;
        let q = [0, 20].map(|k| field(k, of_q));
        let s = [40, 60].map(|k| field(k, of_s).iter().map(|s| -s).collect::<Vec<f64>>());
        let (p, k) = (field(80, of_p), field(100, of_k));
        let grid = Grid::new(4, 3, by(0.7, of_dx), by(0.9, of_dy)).unwrap();
        frictional_wear(&Wear {
            grid,
            traction: [&q[0], &q[1]],
            slip: [&s[0], &s[1]],
            pressure: by_load.then_some(&p[..]),
            coefficient: Coefficient::PerElement(&k),
            hardness: by(3.0, of_h),
            steps: by(5.0, of_steps),
            rolling_distance: by(0.7, of_dq),
        })
    };
    for by_load in [false, true] {
        let plain = of([0; 9], by_load).unwrap();
        // The formula of the depth, evaluated in the order in which it is written.
        let by_hand = 5.0 * at(100) / 3.0
            * if by_load { at(80) * at(40).hypot(at(60)) } else { at(0) * at(40) + at(20) * at(60) };
        assert!((plain.depth[0] / by_hand - 1.0).abs() <= 1e-15 && plain.passage.len() == 3);
        for powers in [
            [600, 600, 600, -900, 0, -300, 0, 0, 0],
            [-600, -600, -600, 500, -600, 700, 0, 0, 0],
            [0, 0, 0, -1000, -1000, 0, -1000, -10, -1000],
            [0, 0, 0, 1000, 1010, 0, 1000, 10, 900],
            [1000, -1000, 1000, 1000, 1000, 0, 600, -600, 600],
            [-500, 900, -500, 100, 500, 0, -700, 700, -700],
        ] {
            let [of_q, of_s, of_p, of_k, of_h, of_steps, of_dx, of_dy, of_dq] = powers;
            let found = of(powers, by_load).unwrap();
            let (of_work, of_depth) = (of_q + of_s + of_steps, if by_load { of_p } else { of_q } + of_s + of_k - of_h);
            for i in 0..12 {
                assert_eq!(found.work[i], by(plain.work[i], of_work), "{powers:?}");
                assert_eq!(found.depth[i], by(plain.depth[i], of_depth + of_steps), "{powers:?}");
            }
            for row in 0..3 {
                assert_eq!(found.passage[row], by(plain.passage[row], of_depth + of_dx - of_dq), "{powers:?}");
            }
            assert_eq!(found.total_work, by(plain.total_work, of_work + of_dx + of_dy));
            assert_eq!(found.volume, by(plain.volume, of_depth + of_steps + of_dx + of_dy));
            assert_eq!((found.largest, found.at), (by(plain.largest, of_depth + of_steps), plain.at));
        }
        for (powers, what) in [
            ([600, 600, 0, 0, 1000, 0, -1000, 0, 0], "the work of an element is"),
            ([-600, 600, 600, 600, -1000, 0, 0, 0, 0], "the depth of a passage is inf"),
            ([0, 0, 0, 0, 0, 1010, 10, 10, 0], "the work of all elements is"),
            ([0, 0, 0, 600, -600, 0, -600, -500, 0], "the depth of an element is inf"),
            ([0, 0, 0, 600, -400, 0, -10, 80, 0], "the volume of all elements is inf"),
        ] {
            let error = of(powers, by_load).expect_err(what);
            assert!(matches!(&error, Error::NotFinite(message) if message.contains(what)), "{powers:?}: {error}");
        }
    }
}

/// The factors of an element's work may differ by more than the range of numbers.
#[test]
fn elements_of_any_size_have_their_work() {
    let grid = Grid::new(2, 1, 1.0, 1.0).unwrap();
    let (q, s, none) = ([1e200, 1e-200], [-1e-150, -1e200], [0.0; 2]);
    let wear = Wear {
        grid,
        traction: [&q, &none],
        slip: [&s, &none],
        pressure: None,
        coefficient: Coefficient::Uniform(1.0),
        hardness: 1.0,
        steps: 1.0,
        rolling_distance: 0.0,
    };
    let found = frictional_wear(&wear).unwrap();
    // Each product has a single rounding error, as in the plain formula.
    assert_eq!((found.work[0], found.work[1]), (1e200 * 1e-150, 1e-200 * 1e200));
    assert_eq!(found.total_work, found.work[0] + found.work[1]);
    let wide = Wear { slip: [&[-1e100, -1e-50], &none], ..wear };
    let found = frictional_wear(&wide).unwrap();
    assert_eq!((found.depth[0], found.depth[1]), (1e200 * 1e100, 1e-200 * 1e-50));
}
