//! The caller's coefficients: any of them lead to the right answer or to a status.

use contact_normal::influence::Kernel;
use contact_normal::scene::Load;

use super::case::{distance, grid, table, Case};

/// A name, and a function of the offset in elements and of the half-space's coefficient there, which returns the changed coefficient.
type Change = (&'static str, fn(i64, i64, f64) -> f64);

fn radius(kx: i64, ky: i64) -> f64 {
    (kx as f64).hypot(ky as f64)
}

/// Changes that keep the operator positive definite.
const DEFINITE: &[Change] = &[
    ("not symmetric", |kx, _, c| c * (1.0 + 0.05 * kx.signum() as f64)),
    ("far from symmetric", |kx, ky, c| c * (1.0 + 0.5 * kx.signum() as f64 - 0.3 * ky.signum() as f64)),
    ("one-sided", |kx, ky, c| if ky < 0 || (ky == 0 && kx < 0) { 0.0 } else { c }),
    // Full contact on 4 x 3.2 has a compliance of about 1/(2.2 * 1.8) per force. An element of area 0.01 has 0.0025 per pressure, more than 0.001, so
    // that A - 0.001 * 1 1' is still positive definite.
    ("negative far entries", |_, _, c| c - 0.001),
    // A is the sum of 1 1' and a multiple of the identity.
    ("hardly decaying", |kx, ky, _| if (kx, ky) == (0, 0) { 1.1 } else { 1.0 }),
    // r^-a and exp(-r) have positive Fourier transforms in the plane.
    ("decaying slowly", |kx, ky, _| (1.0 + radius(kx, ky)).powf(-0.3)),
    ("decaying fast", |kx, ky, _| (-2.0 * radius(kx, ky)).exp()),
    ("diagonal", |kx, ky, c| if (kx, ky) == (0, 0) { c } else { 0.0 }),
    // As for normals that rotate along x. The product c cos(angle) is positive definite because both factors are.
    ("conformal", |kx, _, c| c * (0.06 * kx as f64).cos()),
    ("conformal, and stiffer to one side", |kx, ky, c| c * (0.06 * kx as f64).cos() * (1.0 + 0.02 * ky as f64 / 40.0)),
    ("of single precision", |_, _, c| f64::from(c as f32)),
    ("huge", |_, _, c| 1e100 * c),
    ("minute", |_, _, c| 1e-100 * c),
];

/// Changes that make the energy unbounded below in some direction, at least on some contact areas.
const INDEFINITE: &[Change] = &[
    ("negative neighbours", |kx, ky, _| match radius(kx, ky) {
        0.0 => 1.0,
        1.0 => -0.5,
        _ => 0.0,
    }),
    ("strong neighbours", |kx, ky, _| match radius(kx, ky) {
        0.0 => 1.0,
        1.0 => 0.8,
        _ => 0.0,
    }),
    ("a repelling ring", |kx, ky, c| if (3.0..6.0).contains(&radius(kx, ky)) { -c } else { c }),
    ("far entries below the compliance", |_, _, c| c - 0.02),
    ("negative neighbours, not symmetric", |kx, ky, _| match (kx, ky) {
        (0, 0) => 1.0,
        (1, 0) | (0, 1) => -2.0,
        _ => 0.0,
    }),
    ("noise", |kx, ky, _| if (kx, ky) == (0, 0) { 1.0 } else { (12.9 * kx as f64 + 78.2 * ky as f64).sin() }),
];

fn of(changes: &[Change]) -> Vec<Case> {
    let grid = grid(40, 32, 0.1, 0.1);
    let h = distance(&grid, |x, y| 0.05 * (x * x + y * y) + 0.003 * (7.0 * x).sin() * (5.0 * y).cos());
    let mut cases = Vec::new();
    for (name, change) in changes {
        let influence = table(&grid, change);
        // Coefficients of order 1e100 need forces of order 1e-100.
        let unit = influence.at(0, 0) / 0.1;
        let unit = if (1e-50..=1e50).contains(&unit) { 1.0 } else { unit };
        for load in [Load::Approach(0.04), Load::Force(0.1 / unit)] {
            cases.push(Case { influence: Some(influence.clone()), ..Case::new(name, grid, h.clone(), load) });
        }
    }
    cases
}

pub fn cases() -> Vec<Case> {
    of(DEFINITE)
}

/// Cases with coefficients that no elastic body has. They must end with a certified answer or with a status.
pub fn indefinite() -> Vec<Case> {
    of(INDEFINITE)
}

#[cfg(test)]
mod promises {
    use super::super::certificate::{assert_certified, assert_solved_or_told, assert_sound, run_with};
    use super::*;
    use contact_normal::error::Error;
    use contact_normal::influence::Table;
    use contact_normal::solver::{Method, Options, Outcome};

    #[test]
    fn coefficients_of_elastic_bodies() {
        assert_solved_or_told(&cases());
    }

    #[test]
    fn indefinite_coefficients_end_with_an_answer_or_a_status() {
        let mut refused = 0;
        for case in indefinite() {
            for method in [Method::Auto, Method::FullMultigrid, Method::Multigrid, Method::Norm, Method::ProjectedCg] {
                for max_cycles in [3, 1000] {
                    let options = Options { method, max_cycles, ..Options::default() };
                    let what = format!("{method:?}");
                    match run_with(&case, &options) {
                        Ok(found) if found.stop == Outcome::Converged => {
                            assert_certified(&case, &what, &found, options.tolerance);
                        }
                        Ok(found) => {
                            assert_sound(&case, &what, &found);
                        }
                        Err(Error::NotPositiveDefinite(_)) => refused += 1,
                        Err(Error::Unsupported(_)) if method == Method::ProjectedCg => {}
                        Err(error) => panic!("{}, {what}: {error}", case.name),
                    }
                }
            }
        }
        assert!(refused > 0);
    }

    #[test]
    fn coefficients_out_of_range_are_refused() {
        let grid = grid(9, 8, 1.0, 1.0);
        for own in [1e300, f64::MAX] {
            let influence = Some(table(&grid, |kx, ky, _| if (kx, ky) == (0, 0) { own } else { 0.1 }));
            let case = Case { influence, ..Case::new("out of range", grid, vec![0.0; 72], Load::Approach(1.0)) };
            let refused = run_with(&case, &Options::default()).err();
            assert!(matches!(refused, Some(Error::InvalidArgument(_))), "{own:e}: {refused:?}");
        }
    }

    #[test]
    fn coefficients_of_zero_are_refused() {
        let grid = grid(5, 4, 1.0, 1.0);
        for own in [0.0, -1.0] {
            let mut values = vec![0.0; 4 * 5 * 4];
            values[4 * 10 + 5] = own;
            let refused = Table::new(5, 4, &values, &grid).err();
            assert!(matches!(refused, Some(Error::NotPositiveDefinite(_))), "{own}: {refused:?}");
        }
    }
}
