use super::*;
use crate::solver::quantities::Quantity;

/// A solve of one second for each reported iteration. It ends one second and one product after the last.
/// Iterations: the residual, and the seconds and products so far.
fn sample(iterations: Vec<(f64, f64, f64)>, tangential: f64) -> Sample {
    let &(_, seconds, products) = iterations.last().expect("an iteration");
    Sample {
        doublings: 0,
        cost: Cost { elements: 256.0, seconds: seconds + 1.0, setup: 0.0, products: products + 1.0 + tangential },
        solve: seconds + 1.0,
        tolerance: 1e-6,
        across: 16,
        values: Values { of_wanted: vec![], residual: 0.0, lack_estimates: false },
        outlook: Outlook::default(),
        quantity: Quantity::Force,
        bytes: 0.0,
        time_error: 0.0,
        iterations: iterations
            .into_iter()
            .map(|(residual, seconds, normal)| Iteration { residual, seconds, normal })
            .collect(),
        tangential,
        loose: None,
    }
}

#[test]
fn what_is_done_beyond_a_residual_goes() {
    let plain = sample(vec![(1e-1, 1.0, 1.0), (1e-2, 2.0, 2.0), (1e-4, 3.0, 3.0), (1e-6, 4.0, 4.0)], 0.0);
    assert_eq!(plain.cost_to(1e-2, 1e-2), (3.0, 3.0));
    assert_eq!(plain.cost_to(1e-6, 1e-6), (5.0, 5.0));
    // A direct solve reports a residual at its end only.
    let direct = sample(vec![(0.0, 1.0, 1.0), (0.0, 2.0, 1.0), (0.0, 3.0, 2.0)], 0.0);
    assert_eq!(direct.cost_to(1e-2, 1e-2), (4.0, 3.0));
}

/// With friction the normal problem is solved first, then the tangential one. The products of the latter are not reported; there are four between its
/// first iterations.
#[test]
fn normal_and_tangential_problems_end_at_their_tolerance() {
    let reached = vec![(1e-2, 1.0, 1.0), (1e-4, 2.0, 2.0), (1e-1, 3.0, 2.0), (1e-3, 4.0, 2.0), (1e-5, 5.0, 2.0)];
    // To this tolerance the last iteration of either problem is not needed: 1 s and one product of the normal one, 1 s and a third of 6 products of
    // the tangential one.
    assert_eq!(sample(reached, 6.0).cost_to(1e-2, 1e-2), (6.0 - 1.0 - 1.0, 9.0 - 1.0 - 2.0));
}

/// Turns of a coupled problem: a tangential problem without reports between two normal ones. Its time is needed for any residual.
#[test]
fn turns_are_needed_by_any_residual() {
    let turns = sample(vec![(1e-4, 1.0, 1.0), (1e-6, 2.0, 2.0), (1e-5, 12.0, 3.0), (1e-7, 13.0, 4.0)], 0.0);
    assert_eq!(turns.cost_to(1e-2, 1e-2), (14.0 - 2.0, 5.0 - 2.0));
}

/// To 1e-2 friction takes half of the seconds and a third of the 9 tangential products that it takes to 1e-6. At 1e-4, half way by the logarithm, it
/// takes 3/4 and 2/3.
#[test]
fn between_two_tolerances_costs_are_those_of_the_logarithm() {
    let mut sample = sample(vec![(1e-6, 1.0, 1.0)], 9.0);
    assert_eq!(sample.with_friction(1e-4), None);
    sample.loose = Some(Loose { tolerance: 1e-2, seconds: 0.5, tangential: 1.0 / 3.0, normal: 0.5 });
    let near = |found: Option<(f64, f64)>, (part, products): (f64, f64)| {
        let (a, b) = found.expect("known");
        assert!((a - part).abs() < 1e-12 && (b - products).abs() < 1e-12, "{a} {b}");
    };
    near(sample.with_friction(1e-4), (0.75, 6.0));
    // Beyond either end the values are those at the end.
    near(sample.with_friction(1e-8), (1.0, 9.0));
    near(sample.with_friction(1e-1), (0.5, 3.0));
    // The normal problem takes two products to 1e-6, and half of the reported ones to 1e-2.
    assert_eq!((sample.normal_products(1e-6, 1e-6), sample.normal_products(1e-2, 1e-2)), (2.0, 1.0));
}
