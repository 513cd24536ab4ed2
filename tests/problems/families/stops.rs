//! Solves that stop early. The result is sound, and the status names the cause.

use contact_normal::scene::Load;

use super::case::{distance, grid, Case};

pub fn cases() -> Vec<Case> {
    let grid = grid(66, 52, 0.1, 0.1);
    let h = distance(&grid, |x, y| 0.05 * (x * x + y * y) + 0.004 * (7.0 * x).sin() * (5.0 * y).cos());
    [Load::Approach(0.12), Load::Force(0.3)].map(|load| Case::new("a stop", grid, h.clone(), load)).to_vec()
}

#[cfg(test)]
mod promises {
    use super::super::certificate::{assert_certified, assert_sound, found, recompute, run_with};
    use super::*;
    use contact_normal::solver::{Criterion, Method, Options, Outcome, Progress, Solver};

    const METHODS: [Method; 5] =
        [Method::Auto, Method::FullMultigrid, Method::Multigrid, Method::Norm, Method::ProjectedCg];

    #[test]
    fn a_tolerance_below_round_off_stagnates_at_the_floor() {
        for case in cases() {
            for method in METHODS {
                for criterion in [Criterion::Residual, Criterion::Update] {
                    let options =
                        Options { method, criterion, tolerance: 1e-30, max_cycles: 3000, ..Options::default() };
                    let found = run_with(&case, &options).expect("a solve");
                    let what = format!("{method:?} {criterion:?}");
                    let measures = assert_sound(&case, &what, &found);
                    // The round-off of one product is about 1e-15 u. That of p is larger by up to the condition number of A, about a hundred, and a
                    // few hundred products add their round-off: 1e-12 in all.
                    assert!(measures.residual <= 1e-12, "{what}: {measures:?}");
                    let floor_or_exact = found.stop == Outcome::Stagnated
                        || criterion == Criterion::Update && found.stop == Outcome::Converged;
                    assert!(floor_or_exact, "{what}: {:?} after {}", found.stop, found.report.count.cycles);
                }
            }
        }
    }

    #[test]
    fn norm_below_round_off_ends_with_the_contact_area_found() {
        // Among the cases are periodic scenes, whose search directions have a mean by round-off, and unsymmetric tables.
        let shaped = [super::super::surfaces::cases(), super::super::coefficients::cases()].concat();
        let shaped =
            shaped.into_iter().chain(super::super::contact_areas::cases()).filter(|case| case.grid.len() < 4000);
        let (mut stagnated, mut total) = (0, 0);
        for case in shaped.chain(cases()) {
            total += 1;
            let options = Options { method: Method::Norm, tolerance: 1e-30, max_cycles: 20_000, ..Options::default() };
            let found = run_with(&case, &options).expect("a solve");
            let measures = assert_sound(&case, "NORM below round-off", &found);
            // If the contact area has few elements, the solve reaches the last bit and converges.
            assert!(
                [Outcome::Stagnated, Outcome::Converged].contains(&found.stop),
                "{}: {:?}",
                case.name,
                found.report
            );
            stagnated += usize::from(found.stop == Outcome::Stagnated);
            assert!(measures.residual <= 1e-12 && measures.violation <= 1e-12, "{}: {measures:?}", case.name);
        }
        // Most cases stagnate at round-off. For some it depends on the order of sums whether they do.
        assert!(4 * stagnated > 3 * total, "{stagnated} of {total} stagnated");
    }

    #[test]
    fn the_energy_of_the_fast_method_falls_from_cycle_to_cycle() {
        let shaped = [super::super::surfaces::cases(), super::super::contact_areas::cases(), cases()].concat();
        let (mut count, mut risen) = (0, Vec::new());
        for case in shaped.into_iter().filter(|case| case.grid.len() < 20_000) {
            let mut last = f64::INFINITY;
            for max_cycles in 1..25 {
                let options = Options { method: Method::ProjectedCg, max_cycles, ..Options::default() };
                let found = run_with(&case, &options).expect("a solve");
                let energy = recompute(&case, &found).energy;
                // The energy is a sum of thousands of terms of similar size, with a round-off of about 1e-14.
                if energy - last > 1e-12 * energy.abs() {
                    // With a given approach a truncation of negative pressures may cost more energy than its line search gains, up to 1e-6; the next
                    // step regains it. With a given force p is scaled after each truncation, which costs up to 3.5e-3 in an early iteration on the
                    // needle. The latter number depends on the preconditioner.
                    let is_force = matches!(case.load, Load::Force(_));
                    risen.push((case.name.clone(), is_force));
                    let most = if is_force { 4e-3 } else { 1e-5 };
                    assert!(energy - last <= most * energy.abs(), "{}: {last} to {energy}", case.name);
                }
                last = energy;
                if found.stop != Outcome::IterationLimit {
                    break;
                }
            }
            count += 1;
        }
        // Measured: one increase by approach, of 1e-6 of the energy, and three by force, all on the needle.
        let (by_force, by_approach): (Vec<_>, Vec<_>) = risen.into_iter().partition(|(_, is_force)| *is_force);
        assert!(count > 50 && by_approach.len() <= 2, "of {count}: {by_approach:?}");
        let is_needle = |name: &str| name.contains("needle");
        assert!(by_force.len() <= 3 && by_force.iter().all(|(name, _)| is_needle(name)), "of {count}: {by_force:?}");
    }

    #[test]
    fn a_few_cycles_return_the_best_there_is() {
        for case in cases() {
            for method in METHODS {
                for max_cycles in [1, 2, 3] {
                    let options = Options { method, max_cycles, tolerance: 1e-12, ..Options::default() };
                    let found = run_with(&case, &options).expect("a solve");
                    assert_eq!(
                        (found.stop, found.report.count.cycles),
                        (Outcome::IterationLimit, max_cycles as u64),
                        "{method:?}"
                    );
                    assert_sound(&case, &format!("{method:?}, {max_cycles} cycles"), &found);
                }
            }
        }
    }

    #[test]
    fn a_cancel_at_any_call_of_the_callback_returns_what_there_is() {
        for case in cases() {
            for method in METHODS {
                let options = Options { method, tolerance: 1e-9, ..Options::default() };
                let mut solver = Solver::new(&case.scene(), &options).expect("a solver");
                let mut calls = 0;
                let mut count = |_: &Progress| {
                    calls += 1;
                    false
                };
                solver.solve(&case.scene(), &options, None, Some(&mut count)).expect("a solve");
                let all = calls;
                assert!(all > 5, "{method:?}: {all} calls");
                for at in 1..=all {
                    let mut calls = 0;
                    let mut cancel = |_: &Progress| {
                        calls += 1;
                        calls == at
                    };
                    let (stop, report) =
                        solver.solve(&case.scene(), &options, None, Some(&mut cancel)).expect("a solve");
                    assert_eq!(calls, at, "{method:?}: called after the cancellation");
                    let (what, found) = (format!("{method:?}, cancelled at {at}"), found(&solver, stop, report));
                    // At the cancellation the iterate may already satisfy the certificate.
                    if stop == Outcome::Converged {
                        assert_certified(&case, &what, &found, options.tolerance);
                    } else {
                        assert_eq!(stop, Outcome::Cancelled, "{what}");
                        assert_sound(&case, &what, &found);
                    }
                }
                // The handle can still solve after cancellations.
                let (stop, report) = solver.solve(&case.scene(), &options, None, None).expect("a solve");
                assert_certified(&case, "after cancellations", &found(&solver, stop, report), options.tolerance);
            }
        }
    }
}
