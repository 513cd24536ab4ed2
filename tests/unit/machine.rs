use super::{growth, growth_by, seconds_on, Cost, GROWTH, POWERS};

/// Powers of 1.1 up to 4096 elements and of 1.15 from there on, in arbitrary seconds.
const TIMED: [(f64, f64); 3] = [(1024.0, 3e-5), (4096.0, 3e-5 * 4.594_793_419_988_14), (16384.0, 0.0)];

fn timed() -> [(f64, f64); 3] {
    let [a, b, mut c] = TIMED;
    c.1 = b.1 * 4f64.powf(1.15);
    [a, b, c]
}

/// The powers are exact up to round-off, like the seconds above.
fn assert_near(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} and {expected}");
}

#[test]
fn growth_is_that_of_the_sizes_that_it_passes() {
    let timed = timed();
    assert_near(growth_by(&timed, 2000.0, 3000.0), 1.5f64.powf(1.1));
    assert_near(growth_by(&timed, 5000.0, 10000.0), 2f64.powf(1.15));
    assert_near(growth_by(&timed, 1024.0, 16384.0), 4f64.powf(1.1) * 4f64.powf(1.15));
    // Before the first size and beyond the last one, the power of the nearest interval.
    assert_near(growth_by(&timed, 256.0, 1024.0), 4f64.powf(1.1));
    assert_near(growth_by(&timed, 16384.0, 65536.0), 4f64.powf(1.15));
    assert_near(growth_by(&timed, 9000.0, 9000.0), 1.0);
    // Back again.
    assert_near(growth_by(&timed, 65536.0, 256.0) * growth_by(&timed, 256.0, 65536.0), 1.0);
}

#[test]
fn a_busy_machine_spoils_little() {
    let busy = [(1024.0, 1.0), (4096.0, 0.1), (16384.0, 50.0)];
    assert_near(growth_by(&busy, 1024.0, 16384.0), 4f64.powf(POWERS.0) * 4f64.powf(POWERS.1));
    for nothing in [&[][..], &[(1024.0, 1.0)], &[(1024.0, 0.0), (4096.0, 0.0)]] {
        assert_near(growth_by(nothing, 1000.0, 8000.0), 8f64.powf(GROWTH));
    }
}

#[test]
fn the_machine_is_timed_once_and_by_any_thread() {
    let found: Vec<f64> = std::thread::scope(|scope| {
        let all: Vec<_> = (0..4).map(|_| scope.spawn(|| growth(1024.0, 65536.0))).collect();
        all.into_iter().map(|one| one.join().expect("no panic")).collect()
    });
    assert!(found.iter().all(|one| one.to_bits() == found[0].to_bits()), "{found:?}");
    assert!((64f64.powf(POWERS.0)..=64f64.powf(POWERS.1) * (1.0 + 1e-12)).contains(&found[0]), "{}", found[0]);
}

/// The set-up of a periodic scene takes 1.2 ms on each small grid, and the solve grows with the elements. On 256 times the elements the solve takes at least 256
/// times as long, the set-up less than twice as long.
#[test]
fn a_set_up_that_stays_is_not_carried_on_as_a_solve() {
    let of = |m: f64| Cost { elements: m * m, seconds: 1.2e-3 + 1e-8 * m * m, setup: 1.2e-3, products: 4.0 };
    let costs = [of(16.0), of(32.0)];
    let solve = 1e-8 * 512.0 * 512.0;
    let found = seconds_on(&costs, 512.0 * 512.0);
    let most = 1.2e-3 * 256f64.powf(0.1) + solve * 256f64.powf(POWERS.1 - 1.0);
    assert!((1.2e-3 + solve..most * (1.0 + 1e-9)).contains(&found), "{found} {most}");
    assert_eq!(seconds_on(&[], 100.0), 0.0);
}

/// Products that grow by a fifth with a doubling: 10 ns for each element and product, from whichever sample seconds are extrapolated.
#[test]
fn products_that_grow_are_carried_on() {
    let of = |m: f64| {
        let products = 20.0 * 1.2f64.powf((m / 32.0).log2());
        Cost { elements: m * m, seconds: 1e-8 * m * m * products, setup: 0.0, products }
    };
    let found = seconds_on(&[of(32.0), of(64.0)], 256.0 * 256.0) / of(256.0).seconds;
    assert!((1.0 - 1e-9..16f64.powf(POWERS.1 - 1.0)).contains(&found), "{found}");
}
