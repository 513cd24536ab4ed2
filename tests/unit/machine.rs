use super::{growth, growth_by, GROWTH, POWERS};

/// Powers of 1.1 up to 4096 elements and of 1.15 from there on, in whatever seconds.
const TIMED: [(f64, f64); 3] = [(1024.0, 3e-5), (4096.0, 3e-5 * 4.594_793_419_988_14), (16384.0, 0.0)];

fn timed() -> [(f64, f64); 3] {
    let [a, b, mut c] = TIMED;
    c.1 = b.1 * 4f64.powf(1.15);
    [a, b, c]
}

/// The powers are exact but for round-off, as the seconds above are.
fn assert_near(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} and {expected}");
}

#[test]
fn growth_is_that_of_the_sizes_that_it_passes() {
    let timed = timed();
    assert_near(growth_by(&timed, 2000.0, 3000.0), 1.5f64.powf(1.1));
    assert_near(growth_by(&timed, 5000.0, 10000.0), 2f64.powf(1.15));
    assert_near(growth_by(&timed, 1024.0, 16384.0), 4f64.powf(1.1) * 4f64.powf(1.15));
    // Before the first size and beyond the last one that of their neighbours.
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
