use super::{seconds_on, Cost, GROWTH};

/// The coefficients of a periodic scene take 1.2 ms on each small grid, while the time of the solve grows with the elements. On 256 times the
/// elements the solve is predicted to take 256 times as long or more, and the coefficients less than twice as long. (With the least power of .4 they
/// would take nine times as long.)
#[test]
fn a_set_up_that_stays_is_not_carried_on_as_a_solve() {
    let of = |m: f64| Cost { elements: m * m, seconds: 1.2e-3 + 1e-8 * m * m, setup: 1.2e-3, products: 4.0 };
    let costs = [of(16.0), of(32.0)];
    let solve = 1e-8 * 512.0 * 512.0;
    let found = seconds_on(&costs, 512.0 * 512.0);
    let most = 1.2e-3 * 256f64.powf(0.1) + solve * 256f64.powf(GROWTH - 1.0);
    assert!((1.2e-3 + solve..most * (1.0 + 1e-9)).contains(&found), "{found} {most}");
    assert_eq!(seconds_on(&[], 100.0), 0.0);
}

/// The number of products grows by a fifth with each doubling. The predicted seconds are 10 ns for each element and product, from whichever sample.
#[test]
fn products_that_grow_are_carried_on() {
    let of = |m: f64| {
        let products = 20.0 * 1.2f64.powf((m / 32.0).log2());
        Cost { elements: m * m, seconds: 1e-8 * m * m * products, setup: 0.0, products }
    };
    let found = seconds_on(&[of(32.0), of(64.0)], 256.0 * 256.0) / of(256.0).seconds;
    assert!((1.0 - 1e-9..16f64.powf(GROWTH - 1.0) * (1.0 + 1e-9)).contains(&found), "{found}");
}
