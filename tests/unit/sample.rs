use super::*;
use crate::solver::quantities::Quantity;

/// A solve of one second for each told iteration, that ends one second and one product after the last.
fn sample(reached: Vec<Told>, tangential: f64) -> Sample {
    let &(_, seconds, products) = reached.last().expect("an iteration");
    Sample {
        doublings: 0,
        elements: 256.0,
        across: 16,
        values: Values { of: vec![], residual: 0.0, lack_estimates: false },
        outlook: Outlook::default(),
        quantity: Quantity::Force,
        bytes: 0.0,
        time_error: 0.0,
        reached,
        products: products + 1.0 + tangential,
        tangential,
        seconds: seconds + 1.0,
        setup: 0.0,
    }
}

#[test]
fn what_is_done_beyond_a_residual_goes() {
    let plain = sample(vec![(1e-1, 1.0, 1.0), (1e-2, 2.0, 2.0), (1e-4, 3.0, 3.0), (1e-6, 4.0, 4.0)], 0.0);
    assert_eq!(plain.to(1e-2), (3.0, 3.0));
    assert_eq!(plain.to(1e-6), (5.0, 5.0));
    // A direct solve tells a residual at its end only.
    let direct = sample(vec![(0.0, 1.0, 1.0), (0.0, 2.0, 1.0), (0.0, 3.0, 2.0)], 0.0);
    assert_eq!(direct.to(1e-2), (4.0, 3.0));
}

/// With friction the normal problem is solved to its end, then the tangential one, of which no products are told: four between its first iterations.
#[test]
fn both_problems_of_friction_end_there() {
    let reached = vec![(1e-2, 1.0, 1.0), (1e-4, 2.0, 2.0), (1e-1, 3.0, 2.0), (1e-3, 4.0, 2.0), (1e-5, 5.0, 2.0)];
    // 1 s and one product of the normal problem, 1 s and a third of 6 products of the tangential one.
    assert_eq!(sample(reached, 6.0).to(1e-2), (6.0 - 1.0 - 1.0, 9.0 - 1.0 - 2.0));
}

/// Tangential problems that tell nothing, between two of the normal one: the time of them stays.
#[test]
fn turns_are_needed_by_any_residual() {
    let turns = sample(vec![(1e-4, 1.0, 1.0), (1e-6, 2.0, 2.0), (1e-5, 12.0, 3.0), (1e-7, 13.0, 4.0)], 0.0);
    assert_eq!(turns.to(1e-2), (14.0 - 2.0, 5.0 - 2.0));
}
