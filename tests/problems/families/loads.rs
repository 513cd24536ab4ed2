//! Prescribed forces of every size, and pairs of approach and force that belong together.

use contact_normal::scene::Load;

use super::case::{grid, paraboloid, Case};

pub fn cases() -> Vec<Case> {
    let odd = grid(61, 51, 0.1, 0.1);
    let h = paraboloid(&odd, 0.05);
    let forces = [
        ("no force", 0.0),
        ("the smallest force", 1e-100),
        ("a force for one element", 1e-9),
        ("a usual force", 0.5),
        ("a force for full contact", 1e3),
        ("a huge force", 1e60),
    ];
    forces.iter().map(|&(name, force)| Case::new(name, odd, h.clone(), Load::Force(force))).collect()
}

#[cfg(test)]
mod promises {
    use super::super::certificate::{assert_certified, assert_solved_or_told, run, run_with};
    use super::*;
    use contact_normal::error::Error;
    use contact_normal::solver::{ActiveSet, Guess, Method, Options, Solver};

    const METHODS: [Method; 4] = [Method::Auto, Method::FullMultigrid, Method::Multigrid, Method::Norm];

    #[test]
    fn forces_of_every_size() {
        assert_solved_or_told(&cases());
        let counts: Vec<usize> = cases()
            .iter()
            .map(|case| run(case, Method::Auto).expect("a solve").report.measures.contact_count)
            .collect();
        let n = 61 * 51;
        assert_eq!((counts[0], counts[1], counts[2], counts[4], counts[5]), (0, 1, 1, n, n));
        assert!(1 < counts[3] && counts[3] < n);
    }

    #[test]
    fn a_force_that_nothing_can_carry_is_infeasible() {
        let grid = grid(20, 10, 0.1, 0.1);
        let nowhere = vec![f64::INFINITY; grid.len()];
        for method in METHODS {
            let refused = run(&Case::new("no surface", grid, nowhere.clone(), Load::Force(1.0)), method).err();
            assert!(matches!(refused, Some(Error::Infeasible(_))), "{method:?}: {refused:?}");
            // A single element that is not excluded carries any force.
            let mut h = nowhere.clone();
            h[77] = 0.0;
            let case = Case::new("one element", grid, h, Load::Force(1.0));
            let found = run(&case, method).expect("a solve");
            assert_certified(&case, "one element", &found, 1e-6);
            // A quotient and a product: two rounding errors.
            assert!((found.p[77] * grid.element_area() - 1.0).abs() <= 2.0 * f64::EPSILON);
        }
    }

    #[test]
    fn a_force_on_distances_that_overflow_is_refused() {
        let grid = grid(9, 8, 1.0, 1.0);
        let contact = vec![true; 72];
        for far in [f64::MAX, -f64::MAX, 1e150] {
            let case = Case::new("far away", grid, vec![far; 72], Load::Force(1.0));
            for method in [Method::Auto, Method::Norm, Method::Multigrid, Method::FullMultigrid] {
                for active_set in [ActiveSet::Free, ActiveSet::Fixed] {
                    let options = Options { method, active_set, ..Options::default() };
                    let mut solver = Solver::new(&case.scene(), &options).expect("a solver");
                    let guess = Guess { pressure: &[0.0; 72], contact: &contact };
                    let refused = solver.solve(&case.scene(), &options, Some(guess), None).err();
                    assert!(matches!(refused, Some(Error::InvalidArgument(_))), "{far:e}, {method:?}: {refused:?}");
                }
            }
        }
    }

    #[test]
    fn the_approach_found_for_a_force_gives_the_same_pressures() {
        let odd = grid(61, 51, 0.1, 0.1);
        let h = paraboloid(&odd, 0.05);
        for method in METHODS {
            for force in [1e-9, 1e-3, 0.5, 1e3] {
                let options = Options { method, tolerance: 1e-10, ..Options::default() };
                let by_force = Case::new("by force", odd, h.clone(), Load::Force(force));
                let found = run_with(&by_force, &options).expect("a solve");
                assert_certified(&by_force, "by force", &found, options.tolerance);
                let by_approach = Case { load: Load::Approach(found.approach), ..by_force };
                let again = run_with(&by_approach, &options).expect("a solve");
                assert_certified(&by_approach, "by approach", &again, options.tolerance);
                let largest = found.p.iter().copied().fold(0.0, f64::max);
                for (p, q) in found.p.iter().zip(&again.p) {
                    // Two residuals of 1e-10, times the condition number of A on this grid (below 100).
                    assert!((p - q).abs() <= 1e-8 * largest, "{method:?} {force}: {p} and {q}");
                }
            }
        }
    }
}
