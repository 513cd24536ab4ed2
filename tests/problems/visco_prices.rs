//! Price lists, and the bill of effects, of a step of viscoelastic bodies.

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Branches, Coating, Load, Scene, Visco};
use contact_normal::solver::{
    cost_of_accuracy, effects_bill, solve, solve_to_accuracy, Accuracy, BillOptions, Neglected, Obstacle, Omission,
    Options, Outcome, Quantity, Verdict,
};

use crate::bill::{ball, bill, plain, WANTED};
use crate::families::case::distance;
use crate::visco::{G, MODULI, TIMES};

/// The relative difference between the forms RELAXATION and CREEP for a step dt from rest. In contact A p is h - approach over the compliance of the
/// form, on any grid. So the difference is that of two compliances: those of `1/(G_inf + sum of G_k g_k)` and of `J_0 + sum of J_k (1 - g_k)`. Here
/// `g = (1 - exp(-x))/x`, x is the step over the relaxation or creep time, and creep times are the zeros of `G_inf + sum of G_k s t_k/(1 + s t_k)`.
fn by_hand(dt: f64) -> f64 {
    let g = |x: f64| -(-x).exp_m1() / x;
    let rest = G - MODULI.iter().sum::<f64>();
    let branches = || MODULI.into_iter().zip(TIMES);
    let stiffness = rest + branches().map(|(modulus, t)| modulus * g(dt / t)).sum::<f64>();
    let of = |s: f64| rest + branches().map(|(modulus, t)| modulus * s * t / (1.0 + s * t)).sum::<f64>();
    let slope = |s: f64| branches().map(|(modulus, t)| modulus * t / (1.0 + s * t).powi(2)).sum::<f64>();
    let mut rates: Vec<f64> = TIMES.iter().map(|t| 1.0 / t).collect();
    rates.sort_by(f64::total_cmp);
    let mut compliance = 1.0 / G;
    for k in 0..rates.len() {
        // There is one zero between two poles in -s, where the sum falls from + to - infinity. Below the first pole the sum falls from the modulus at
        // rest.
        let (mut low, mut high) = (if k == 0 { 0.0 } else { rates[k - 1] }, rates[k]);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if of(-middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let time = 1.0 / low;
        compliance += time / slope(-low) * (1.0 - g(dt / time));
    }
    (compliance * stiffness - 1.0).abs()
}

/// A step from rest may be solved on any grid. Its price list, and a solve to an accuracy, include the error by the length of the step.
#[test]
fn prices_of_a_step_from_rest_have_the_error_of_the_step() {
    let (m, side) = (48, 0.05);
    let grid = Grid::new(m, m, side, side).unwrap();
    let h = distance(&grid, |x, y| 0.5 * (x * x + y * y) / 10.0);
    let solid = Branches { modulus: &MODULI, time: &TIMES };
    let step = Visco { bodies: [solid, solid], time_step: 0.4, ..Visco::default() };
    let bodies = Bodies::same(G, 0.4);
    let scene = Scene { visco: Some(step), ..Scene::new(grid, &h, bodies, Load::Approach(0.06)) };
    let error = |scene: &Scene<'_>| solve(scene, &Options::default()).unwrap().2.visco.unwrap().time_error;
    // Gaps in contact are within the tolerance relative to h - approach, ten times of which is ample.
    let tolerance = 10.0 * Options::default().tolerance;
    let exact = by_hand(0.4);
    assert!((error(&scene) / exact - 1.0).abs() <= tolerance, "{} {exact}", error(&scene));
    let targets = [4.0 * exact, 0.25 * exact];
    let accuracy = Accuracy::new(targets[0]);
    let priced = (Quantity::Force, &targets[..]);
    let (stop, prices) = cost_of_accuracy(&scene, &Options::default(), &accuracy, priced, None, None).unwrap();
    assert_eq!(stop, Outcome::Converged);
    println!("{exact} {prices:?}");
    for price in &prices {
        assert!((price.time_error / exact - 1.0).abs() <= tolerance, "{} {exact}", price.time_error);
        assert!(price.grid.is_some());
    }
    assert_eq!(prices[0].obstacle, None);
    assert_eq!(prices[1].obstacle, Some(Obstacle::Step));
    // The step from rest has half the length.
    let half = Scene { visco: Some(Visco { time_step: 0.2, ..step }), ..scene.clone() };
    assert!((error(&half) / by_hand(0.2) - 1.0).abs() <= tolerance, "{} {}", error(&half), by_hand(0.2));
    let found = solve_to_accuracy(&scene, &Options::default(), &accuracy, None, None).unwrap();
    assert_eq!(found.stop, Outcome::Converged);
    assert!((found.report.visco.unwrap().time_error / exact - 1.0).abs() <= tolerance);
    let elastic = Scene { visco: None, ..scene };
    let (_, prices) = cost_of_accuracy(&elastic, &Options::default(), &accuracy, priced, None, None).unwrap();
    assert!(prices.iter().all(|price| price.time_error == 0.0 && price.obstacle != Some(Obstacle::Step)));
}

/// Equal viscoelastic bodies carry less force at the same approach, over the same area: 1/s of the elastic force, with a known s for an approach that
/// grows linearly. Steps that are short relative to the relaxation time have no effect.
#[test]
fn relaxation_is_in_the_bill_of_a_step_from_rest() {
    let h = ball();
    let step = |time_step: f64, continues: bool| {
        let branches = Branches { modulus: &[5e4], time: &[2.0] };
        let visco = Visco { bodies: [branches; 2], time_step, continues, ..Visco::default() };
        Scene { visco: Some(visco), bodies: Bodies::same(8e4, 0.28), ..plain(&h) }
    };
    for (dt, verdict) in [(1.0, Verdict::Needed), (1e-3, Verdict::Negligible)] {
        let (scene, x) = (step(dt, false), dt / 2.0);
        let rows = bill(&scene, 1e-2, &WANTED);
        assert_eq!(rows.len(), 3, "{rows:?}");
        assert!(rows.iter().all(|row| row.omission == Omission::Visco && row.omission.name() == "visco"));
        // The approach rises linearly from rest during the step, so that G_k has the mean of exp(-t/t_k) as a factor.
        let s = 1.0 / (1.0 - 5.0 / 8.0 * (1.0 - (1.0 - f64::exp(-x)) / x));
        let (value, change) = (rows[0].value.expect("a value"), rows[0].change.expect("a change"));
        // The solves of the bill have a tolerance of a hundredth of the target.
        assert!((change / value - (s - 1.0)).abs() <= 2e-4 * s, "{dt}: {change} {value} {s}");
        assert_eq!((rows[0].verdict, rows[2].change), (verdict, Some(0.0)), "{rows:?}");
        let neglected = Neglected::of(&scene, &Options::default(), 1e-2, None).expect("a scene");
        assert_eq!(neglected, Neglected::default());
    }
    // A viscoelastic layer that is the only elastic part of its body is never left out.
    let coated = Scene {
        coating: Some(Coating::of_body_1(0.5, 8e4, 0.3)),
        bodies: Bodies { shear_modulus: [f64::INFINITY, 8e4], poisson_ratio: [0.0, 0.3] },
        ..step(1.0, false)
    };
    assert!(bill(&coated, 1e-2, &WANTED).iter().all(|row| row.omission == Omission::Visco));
    let refused = effects_bill(&step(1.0, true), &Options::default(), &BillOptions::new(0.1), &WANTED, None);
    assert!(matches!(refused, Err(Error::Unsupported(message)) if message.contains("visco")));
}
