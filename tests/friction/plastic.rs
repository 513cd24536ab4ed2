//! A plastic layer between the bodies, compared with the output of CONTACT (its examples carter_plast, catt2d_plast and plastic_3bl; eve70a/CONTACT).

use contact_normal::friction::{Report, Solution, PLASTIC, SLIP, STICK};
use contact_normal::grid::Grid;
use contact_normal::scene::{
    Branch, Coefficient, Fall, Friction, FrictionLaw, Motion, PlasticLayer, Prescribed, Previous,
};

use super::laws::{pressures, solver, steel};
use super::support::run;

const FORCE: f64 = 35_780.0;

fn along(xi: f64) -> [Prescribed; 2] {
    [Prescribed::Creepage(xi), Prescribed::Creepage(0.0)]
}

/// The numbers of elements in stick, in slip, and at the yield limit of the layer.
fn counts(solution: &Solution) -> [usize; 3] {
    [STICK, SLIP, PLASTIC].map(|what| solution.stick_slip.iter().filter(|side| **side == what).count())
}

fn cylinder(mx: usize, dx: f64, first: f64) -> (Grid, Vec<f64>) {
    let grid = Grid::new(mx, 1, dx, 200.0).unwrap();
    let h: Vec<f64> = (0..mx).map(|i| 1e-3 * (first + i as f64 * dx).powi(2)).collect();
    (grid, pressures(grid, &h, FORCE))
}

#[test]
fn steady_rolling_over_a_layer_that_yields_is_that_of_contact() {
    let printed = [
        (4_018_000.0, [(0.6562, [12, 11, 3]), (0.6478, [25, 21, 5]), (0.6436, [52, 41, 8])]),
        (123_000.0, [(0.6420, [11, 8, 7]), (0.6340, [22, 15, 14]), (0.6299, [46, 29, 26])]),
        (0.0, [(0.5959, [9, 4, 13]), (0.5896, [19, 7, 25]), (0.5864, [39, 12, 50])]),
        (-20_500.0, [(0.5509, [8, 3, 15]), (0.5457, [17, 4, 30]), (0.5430, [34, 5, 62])]),
    ];
    for (k, (mx, dx, first)) in [(30, 0.08, -1.16), (55, 0.04, -1.08), (105, 0.02, -1.04)].into_iter().enumerate() {
        let (grid, pressure) = cylinder(mx, dx, first);
        for (hardening, of_grids) in printed {
            let (force, counted) = of_grids[k];
            let layer = Some(PlasticLayer { yield_limit: 35.0, hardening });
            let friction =
                Friction { motion: Motion::SteadyRolling, prescribed: along(-4e-4), layer, ..Friction::new(0.5) };
            let (report, solution) = run(&mut solver(&grid), &pressure, &friction, 1e-8);
            let part = report.force[0] / (0.5 * FORCE);
            println!(
                "{dx} {hardening} {part:.5} ({force}) {:?} {counted:?} products {}",
                counts(&solution),
                report.products
            );
            assert!((part - force).abs() <= 5e-5, "{dx} {hardening}: {part} {force}");
            assert_eq!(counts(&solution), counted, "{dx} {hardening}");
        }
    }
}

/// What CONTACT printed for each step: `Fx/(.5 N)`, and the numbers of elements in stick, in slip, and at the yield limit. (.6366 is the printed
/// value, not 2/pi.)
#[allow(clippy::approx_constant)]
#[rustfmt::skip]
const STEPS: [(f64, [usize; 3]); 49] = [
    (0.6051, [17, 4, 5]), (0.6100, [16, 4, 6]), (0.6146, [14, 4, 8]), (0.6189, [13, 4, 9]), (0.6230, [12, 4, 10]), (0.6264, [9, 5, 12]),
    (0.6284, [7, 6, 13]), (0.6303, [8, 6, 12]), (0.6319, [9, 6, 11]), (0.6332, [10, 7, 9]), (0.6344, [10, 7, 9]), (0.6349, [11, 8, 7]),
    (0.6352, [11, 9, 6]), (0.6347, [12, 9, 5]), (0.6341, [12, 9, 5]), (0.6338, [12, 9, 5]), (0.6336, [12, 9, 5]), (0.6336, [11, 9, 6]),
    (0.6337, [11, 8, 7]), (0.6338, [11, 8, 7]), (0.6340, [11, 8, 7]), (0.6343, [11, 8, 7]), (0.6345, [11, 8, 7]), (0.6347, [11, 8, 7]),
    (0.6349, [11, 8, 7]), (0.6351, [11, 8, 7]), (0.6353, [11, 8, 7]), (0.6354, [11, 8, 7]), (0.6356, [11, 8, 7]), (0.6358, [11, 8, 7]),
    (0.6359, [11, 8, 7]), (0.6360, [11, 8, 7]), (0.6361, [11, 8, 7]), (0.6363, [11, 8, 7]), (0.6364, [11, 8, 7]), (0.6365, [11, 8, 7]),
    (0.6366, [11, 8, 7]), (0.6367, [11, 8, 7]), (0.6369, [11, 8, 7]), (0.6370, [11, 8, 7]), (0.6371, [11, 8, 7]), (0.6372, [11, 8, 7]),
    (0.6373, [11, 8, 7]), (0.6374, [11, 8, 7]), (0.6375, [11, 8, 7]), (0.6376, [11, 8, 7]), (0.6377, [11, 8, 7]), (0.6378, [11, 8, 7]),
    (0.6379, [11, 8, 7]),
];

#[test]
fn steps_from_a_shift_to_rolling_are_those_of_contact() {
    let (grid, pressure) = cylinder(30, 0.08, -1.16);
    let layer = Some(PlasticLayer { yield_limit: 35.0, hardening: 123_000.0 });
    let shift = |xi: f64| Friction { prescribed: along(xi), layer, ..Friction::new(0.5) };
    let part = |report: &Report| report.force[0] / (0.5 * FORCE);
    // The shift whose force is .6 mu N, found by bisection. CONTACT printed -1.976e-3.
    let (mut low, mut high) = (-2.1e-3, -1.8e-3);
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        let (report, _) = run(&mut solver(&grid), &pressure, &shift(middle), 1e-8);
        (low, high) = if part(&report) > 0.6 { (middle, high) } else { (low, middle) };
    }
    assert!((low + 1.976e-3).abs() <= 6e-7, "{low}");
    let mut solver = solver(&grid);
    let (_, solution) = run(&mut solver, &pressure, &shift(low), 1e-8);
    assert_eq!(counts(&solution), [14, 8, 4]);
    let friction = Friction {
        motion: Motion::TransientRolling,
        prescribed: along(-4e-4),
        layer,
        previous: Previous::Kept,
        ..Friction::new(0.5)
    };
    let mut products = 0.0;
    for (step, (force, counted)) in STEPS.into_iter().enumerate() {
        let (report, solution) = run(&mut solver, &pressure, &friction, 1e-8);
        products += report.products;
        assert!((part(&report) - force).abs() <= 5.1e-5, "{step}: {} {force}", part(&report));
        assert_eq!(counts(&solution), counted, "{step}");
    }
    println!("{} products a step", products / STEPS.len() as f64);
}

/// A layer of .02 mm: its shear modulus, yield limit and hardening, and its steps. A step is a shift and the traction that CONTACT printed.
type Sheared = (f64, f64, f64, &'static [(f64, f64)]);

/// One element of 1 mm x 1 mm under 900 N with mu = .7: a shift without a layer, and the traction that CONTACT printed to four digits.
const BARE: (f64, f64) = (-0.001, 84.97);
/// The same element on four layers.
#[rustfmt::skip]
const SHEARED: [Sheared; 4] = [
    (176.63, 560.0, 0.0, &[
        (-0.035, 280.0), (-0.035, 560.0), (-0.03, 560.0), (-0.05, 560.0), (-0.05, 560.0), (-0.05, 560.0), (-0.05, 560.0),
        (-0.05, 560.0), (-0.05, 560.0), (-0.05, 560.0), (-0.05, 560.0), (-0.05, 560.0), (-0.05, 560.0),
    ]),
    (106.25, 200.0, 435.0, &[
        (-0.04, 200.0), (-0.04, 216.0), (-0.04, 232.0), (-0.04, 248.0), (-0.036, 262.4), (0.0, 262.4), (0.036, 82.43),
        (0.0, 82.43), (-0.046, 266.4), (-0.044, 284.0), (-0.05, 304.0), (-0.05, 324.1), (-0.05, 344.1), (-0.05, 364.1),
        (-0.05, 384.1), (-0.05, 404.1), (-0.05, 424.1),
    ]),
    (176.63, 400.0, -195.0, &[
        (-0.025, 200.0), (-0.025, 400.0), (-0.05, 390.0), (-0.05, 380.0), (-0.05, 370.0), (-0.05, 360.0), (-0.05, 350.0),
        (-0.05, 340.0), (-0.05, 330.0), (-0.05, 320.1), (-0.05, 310.1), (-0.05, 300.1), (-0.05, 290.1),
    ]),
    (20.238, 20.0, 20.4, &[
        (-0.02, 20.0), (-0.04, 20.8), (-0.04, 21.6), (-0.05, 22.6), (-0.05, 23.6), (-0.05, 24.6), (-0.05, 25.6),
        (-0.05, 26.6), (-0.05, 27.6), (-0.05, 28.6), (-0.05, 29.6), (-0.05, 30.6), (-0.05, 31.6),
    ]),
];

/// Half a unit of the last digit of a number that is printed to four digits.
fn half_a_digit(printed: f64) -> f64 {
    if printed < 100.0 {
        0.005
    } else {
        0.05
    }
}

#[test]
fn one_element_on_a_layer_that_hardens_or_softens_is_that_of_contact() {
    let grid = Grid::new(1, 1, 1.0, 1.0).unwrap();
    let own = steel(&grid).at(0.0, 0.0)[0];
    let bare = Friction { prescribed: along(BARE.0), ..Friction::new(0.7) };
    let (_, found) = run(&mut solver(&grid), &[900.0], &bare, 1e-12);
    assert!((found.traction[0][0] - BARE.1).abs() <= half_a_digit(BARE.1), "{:?}", found.traction);
    let mut steps = 1;
    for (modulus, yield_limit, hardening, shifts) in SHEARED {
        let (mut solver, compliance) = (solver(&grid), 0.02 / modulus);
        let layer = Some(PlasticLayer { yield_limit, hardening });
        let (mut q, mut limit) = (0.0f64, yield_limit);
        for (step, &(xi, printed)) in shifts.iter().enumerate() {
            let friction = Friction {
                prescribed: along(xi),
                layer,
                compliance: Coefficient::Uniform(compliance),
                previous: if step == 0 { Previous::None } else { Previous::Kept },
                ..Friction::new(0.7)
            };
            let (_, solution) = run(&mut solver, &[900.0], &friction, 1e-12);
            let found = solution.traction[0][0];
            // The solution in closed form: q = q' - xi/(a0 + c) in stick, with the influence a0 of the element on itself and the compliance c of the
            // layer; otherwise q is the limit of the layer after its slip.
            let (stiff, elastic) = (own + compliance, q - xi / (own + compliance));
            if elastic.abs() > limit {
                let slip = (elastic.abs() - limit) * stiff / (1.0 + hardening * stiff);
                limit += hardening * slip;
                q = limit * elastic.signum();
            } else {
                q = elastic;
            }
            assert!((found - q).abs() <= 1e-9 * q.abs(), "{hardening} {step}: {found} {q}");
            assert!((solution.particles[0].yield_limit - limit).abs() <= 1e-9 * limit);
            assert!((found - printed).abs() <= half_a_digit(printed), "{hardening} {step}: {found} {printed}");
            steps += 1;
        }
    }
    assert_eq!(steps, 57);
}

/// One element under a pressure of 350, with a coefficient that falls from .3, on a layer that yields at 70 and softens. The layer yields before the
/// element slips (70 is below .3 times 350), and goes on softening when friction has fallen below 70. So the traction never rises with the shift,
/// after yield.
#[test]
fn a_layer_softens_where_friction_falls_below_its_limit() {
    let grid = Grid::new(1, 1, 0.25, 0.25).unwrap();
    let law = FrictionLaw { time_step: 0.25e-3, ..FrictionLaw::new(Fall::Exponential, (0.5, 0.5), 10.0, 1000.0) };
    let layer = PlasticLayer { yield_limit: 70.0, hardening: -2e4 };
    for branch in [Branch::Near, Branch::Low, Branch::High] {
        let mut before = 70.0;
        for step in 1..=60 {
            let shift = 1e-4 * f64::from(step);
            let friction = Friction {
                prescribed: along(-shift),
                law: Some(law),
                layer: Some(layer),
                branch,
                ..Friction::new(0.3)
            };
            let (report, solution) = run(&mut solver(&grid), &[350.0], &friction, 1e-8);
            let [x, y] = solution.traction[0];
            let traction = x.hypot(y);
            assert!(report.law_slope < 1.0, "{}", report.law_slope);
            // Until the layer yields, the element sticks and the traction grows with the shift.
            if shift > 70.0 * steel(&grid).at(0.0, 0.0)[0] {
                assert!(traction <= before * (1.0 + 1e-6), "{branch:?} {shift}: {traction} after {before}");
                before = traction;
            }
        }
        // The library keeps the limit of a layer that softens at a thousandth of that of fresh material, or more.
        assert!((before - 0.07).abs() <= 1e-6, "{branch:?}: {before}");
    }
}

/// A layer that softens by almost nothing is the ideal layer: where friction falls below its limit, the limit of a particle stays.
#[test]
fn a_layer_that_softens_by_nothing_keeps_its_limit_below_friction_that_falls() {
    let grid = Grid::new(1, 1, 0.25, 0.25).unwrap();
    let law = FrictionLaw { time_step: 0.25e-3, ..FrictionLaw::new(Fall::Exponential, (0.5, 0.5), 10.0, 1000.0) };
    let steps = |hardening: f64| {
        let layer = PlasticLayer { yield_limit: 70.0, hardening };
        let mut solver = solver(&grid);
        // A large shift, below which friction falls to 52.5, and a small one.
        [(0.05, Previous::None), (0.0015, Previous::Kept)].map(|(shift, previous)| {
            let friction = Friction {
                prescribed: along(-shift),
                law: Some(law),
                layer: Some(layer),
                previous,
                ..Friction::new(0.3)
            };
            let (_, solution) = run(&mut solver, &[350.0], &friction, 1e-9);
            [solution.traction[0][0].abs(), solution.particles[0].yield_limit]
        })
    };
    let ideal = steps(0.0);
    assert!(ideal[0][0] < 60.0 && ideal[0][1] == 70.0 && ideal[1][0] > 60.0, "{ideal:?}");
    for (softened, ideal) in steps(-1e-6).as_flattened().iter().zip(ideal.as_flattened()) {
        // 1e-6 times slips below .1, and two solves to 1e-9.
        assert!((softened - ideal).abs() <= 1e-6, "{softened} {ideal}");
    }
}
