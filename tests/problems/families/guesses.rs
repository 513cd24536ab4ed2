//! Initial guesses. A bad guess may cost time, but leads to the same result.

use contact_normal::scene::Load;

use super::case::{distance, grid, Case, Random};

pub fn cases() -> Vec<Case> {
    let grid = grid(53, 44, 0.1, 0.1);
    let h = distance(&grid, |x, y| 0.05 * x * x + 0.08 * y * y + 0.004 * (6.0 * x).sin() * (4.0 * y).cos());
    [Load::Approach(0.12), Load::Force(0.3)].map(|load| Case::new("a guess", grid, h.clone(), load)).to_vec()
}

/// Wrong pressures and contact areas for `case`, by name.
fn guesses(case: &Case) -> Vec<(&'static str, Vec<f64>, Vec<bool>)> {
    let n = case.grid.len();
    let mut random = Random(11);
    let mut noise = |scale: f64| (0..n).map(|_| scale * (random.next() - 0.5)).collect::<Vec<f64>>();
    let one = |i: usize, value: f64| {
        let mut p = vec![0.0; n];
        p[i] = value;
        p
    };
    let everywhere = vec![true; n];
    let all = |p: Vec<f64>| (p, everywhere.clone());
    let mut guesses = Vec::new();
    let mut add = |name, (p, contact): (Vec<f64>, Vec<bool>)| guesses.push((name, p, contact));
    add("nothing", (vec![0.0; n], vec![false; n]));
    add("all in contact", all(vec![0.0; n]));
    add("all in contact, all pressed", all(vec![1.0; n]));
    add("noise of either sign", all(noise(1.0)));
    add("noise, far too large", all(noise(1e12)));
    add("noise, hopelessly too large", all(noise(1e200)));
    add("the largest numbers there are", all(vec![f64::MAX; n]));
    add("the smallest numbers there are", all(vec![5e-324; n]));
    add("one element in the middle", (one(n / 2, 0.1), one(n / 2, 1.0).iter().map(|&p| p != 0.0).collect()));
    add("one element in a corner", (one(0, 1e3), one(0, 1.0).iter().map(|&p| p != 0.0).collect()));
    add("pressures outside the contact area", (vec![1.0; n], vec![false; n]));
    add("every other element", (noise(1.0), (0..n).map(|i| i % 2 == 0).collect()));
    guesses
}

#[cfg(test)]
mod promises {
    use super::super::case::paraboloid;
    use super::super::certificate::{assert_certified, assert_solved_or_told, found, run_with};
    use super::*;
    use contact_normal::solver::{Criterion, Guess, InitialGuess, Method, Options, Solver};

    const METHODS: [Method; 5] =
        [Method::Auto, Method::FullMultigrid, Method::Multigrid, Method::Norm, Method::ProjectedCg];

    /// Solves from each guess by every method, and asserts that the pressures are those of a solve without a guess.
    fn no_guess_changes_the_answer(case: &Case, guesses: &[(&str, Vec<f64>, Vec<bool>)]) {
        for method in METHODS {
            let options = Options { method, tolerance: 1e-9, max_cycles: 5000, ..Options::default() };
            let cold = run_with(case, &options).expect("a solve");
            let largest = cold.p.iter().copied().fold(0.0, f64::max);
            let options = Options { initial_guess: InitialGuess::Given, ..options };
            for (name, pressure, contact) in guesses {
                let mut solver = Solver::new(&case.scene(), &options).expect("a solver");
                let (stop, report) =
                    solver.solve(&case.scene(), &options, Some(Guess { pressure, contact }), None).expect("a solve");
                let found = found(&solver, stop, report);
                // The certificate must hold even if no iteration was needed.
                assert_certified(case, &format!("{method:?} from {name}"), &found, options.tolerance);
                for (p, q) in found.p.iter().zip(&cold.p) {
                    // Both residuals are at most 1e-9; the condition number of A on this grid is below 100.
                    assert!((p - q).abs() <= 1e-7 * largest, "{method:?} from {name}: {p} and {q}");
                }
            }
        }
    }

    #[test]
    fn bad_guesses_do_not_change_the_answer() {
        assert_solved_or_told(&cases());
        for case in cases() {
            no_guess_changes_the_answer(&case, &guesses(&case));
        }
    }

    #[test]
    fn the_solution_of_another_problem_is_only_a_guess() {
        for case in cases() {
            let mut others = Vec::new();
            for (name, h) in [
                ("a flat punch", vec![0.0; case.grid.len()]),
                ("the other way up", case.h.iter().map(|h| 1.0 - h).collect()),
                ("a sharper ball", paraboloid(&case.grid, 0.5)),
            ] {
                let other = Case { h, ..case.clone() };
                let found = run_with(&other, &Options::default()).expect("a solve");
                others.push((name, found.p, found.contact));
            }
            no_guess_changes_the_answer(&case, &others);
        }
    }

    #[test]
    fn the_exact_solution_needs_no_cycles_and_a_little_less_needs_some() {
        for case in cases() {
            for method in METHODS {
                let options = Options { method, tolerance: 1e-9, ..Options::default() };
                let exact = run_with(&case, &options).expect("a solve");
                for criterion in [Criterion::Residual, Criterion::Update] {
                    let options = Options { initial_guess: InitialGuess::Given, tolerance: 1e-8, criterion, ..options };
                    let mut solver = Solver::new(&case.scene(), &options).expect("a solver");
                    let mut from = |pressure: &[f64]| {
                        let guess = Guess { pressure, contact: &exact.contact };
                        let (stop, report) = solver.solve(&case.scene(), &options, Some(guess), None).expect("a solve");
                        found(&solver, stop, report)
                    };
                    let again = from(&exact.p);
                    // With the UPDATE criterion at 1e-8 the residual is about 1e-8 or less, because A is well scaled on the solution. 1e-7 is ample.
                    assert_certified(&case, &format!("{method:?} from the solution"), &again, 1e-7);
                    // Multigrid needs one or two V-cycles to measure the update. Conjugate gradients measure the residual first.
                    assert!(again.report.count.cycles <= 4, "{method:?}: {} cycles", again.report.count.cycles);
                    let bent: Vec<f64> = exact.p.iter().enumerate().map(|(i, p)| p * [1.01, 0.99][i % 2]).collect();
                    let other = from(&bent);
                    assert!(other.report.count.cycles > 0, "{method:?}: returned what was put in");
                    assert_certified(&case, &format!("{method:?} from nearly the solution"), &other, 1e-7);
                }
            }
        }
    }
}
