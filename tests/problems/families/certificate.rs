//! The measures of the certificate, recomputed from the returned arrays with the test's own product.

use contact_normal::contact::State;
use contact_normal::error::Result;
use contact_normal::influence::Coefficients;
use contact_normal::operator::Operator;
use contact_normal::scene::Load;
use contact_normal::solver::{solve, Method, Options, Outcome, Report, Solver};
use contact_normal::threads::Threads;

use super::case::Case;
use crate::dense;

/// The product of grids of at most this many elements is a direct sum, that of larger ones an FFT in double precision (tests/problems/operator.rs
/// compares both).
const SUMMED: usize = 1600;

/// The result of a solve.
pub struct Found {
    pub stop: Outcome,
    pub report: Report,
    pub p: Vec<f64>,
    pub contact: Vec<bool>,
    pub approach: f64,
}

impl Found {
    pub fn of(stop: Outcome, report: Report, state: &State) -> Found {
        Found { stop, report, p: state.p.clone(), contact: state.contact.clone(), approach: state.approach }
    }
}

/// The measures of the certificate, recomputed from a result.
#[derive(Clone, Copy, Debug)]
pub struct Recomputed {
    /// `||h - approach + A p|| / ||h - approach||` over C.
    pub residual: f64,
    /// Largest `-e` outside C, over the rms of `h - approach` in C.
    pub violation: f64,
    /// `sum of p |e| / sum of p |u|`.
    pub complementarity: f64,
    #[allow(dead_code)] // for tests/problems/properties.rs
    /// The energy `(p, A p)/2 + (p, h - approach)`; if the force is given, `(p, A p)/2 + (p, h)`.
    pub energy: f64,
    /// The round-off that the first two measures may have.
    pub round_off: f64,
}

/// Solves a case by one method, with the default options otherwise.
pub fn run(case: &Case, method: Method) -> Result<Found> {
    run_with(case, &Options { method, ..Options::default() })
}

/// Solves a case with these options.
pub fn run_with(case: &Case, options: &Options) -> Result<Found> {
    let (solver, stop, report) = solve(&case.scene(), options)?;
    Ok(found(&solver, stop, report))
}

/// The last result of a solver.
pub fn found(solver: &Solver, stop: Outcome, report: Report) -> Found {
    Found::of(stop, report, solver.state())
}

/// The displacements u = A p of a case, by a product of the test.
pub fn displace(case: &Case, p: &[f64]) -> Vec<f64> {
    let influence: Coefficients = case.scene().coefficients().unwrap();
    let mut u = vec![0.0; p.len()];
    if p.len() <= SUMMED {
        dense::apply(&influence, &case.grid, p, &mut u);
    } else {
        let operator = Operator::<f64>::new(&influence, &case.grid, &Threads::One).expect("an operator");
        operator.apply(p, &mut u, &mut operator.workspace().expect("memory"));
    }
    u
}

/// Recomputes the measures of a result. Asserts that exterior elements carry no pressure and that elements in contact have a surface.
pub fn recompute(case: &Case, found: &Found) -> Recomputed {
    let u = displace(case, &found.p);
    let (mut r2, mut h2, mut outside, mut gaps, mut work, mut count) = (0.0, 0.0, 0.0f64, 0.0, 0.0, 0.0f64);
    let (mut energy, mut largest) = (0.0, 0.0f64);
    for (i, &u) in u.iter().enumerate() {
        largest = largest.max(u.abs());
        let (h, p) = (case.h[i], found.p[i]);
        let e = h - found.approach + u;
        if found.contact[i] {
            assert!(h.is_finite(), "{}: contact where there is no surface", case.name);
            (r2, h2, count) = (r2 + e * e, h2 + (h - found.approach).powi(2), count + 1.0);
            largest = largest.max(h.abs());
        } else {
            assert_eq!(p, 0.0, "{}: an exterior element carries a pressure", case.name);
            outside = outside.max(-e);
        }
        if p != 0.0 {
            (gaps, work) = (gaps + p * e.abs(), work + p * u.abs());
            energy += p * (0.5 * u + if let Load::Force(_) = case.load { h } else { h - found.approach });
        }
    }
    let part = |value: f64, whole: f64| if value == 0.0 { 0.0 } else { value / whole };
    let scale = (h2 / count.max(1.0)).sqrt();
    Recomputed {
        residual: part(r2.sqrt(), h2.sqrt()),
        violation: part(outside, scale),
        complementarity: part(gaps, work),
        energy,
        // A product has an error of some units of round-off of its largest value, and so has the difference h - approach; 64 units are ample.
        round_off: part(64.0 * f64::EPSILON * (largest + found.approach.abs()), scale),
    }
}

/// Asserts what the library promises for any status: finite values, no tension, the prescribed force, and a report that agrees with the arrays.
pub fn assert_sound(case: &Case, what: &str, found: &Found) -> Recomputed {
    let name = format!("{}, {what}, {:?}", case.name, found.stop);
    assert!(found.p.iter().all(|p| p.is_finite() && *p >= 0.0), "{name}: pressures");
    assert!(found.approach.is_finite(), "{name}: approach {}", found.approach);
    let measures = recompute(case, found);
    let force = found.p.iter().sum::<f64>() * case.grid.element_area();
    if let Load::Force(prescribed) = case.load {
        // The tolerance is the round-off of a sum of n terms of one sign, in any order.
        let rounding = f64::EPSILON * case.grid.len() as f64;
        assert!((force - prescribed).abs() <= rounding * prescribed, "{name}: force {force} for {prescribed}");
    }
    let reported = found.report.measures;
    let certificate = reported.certificate;
    // The test's and the library's products of the same pressures differ by round-off.
    let agree = |a: f64, b: f64| (a - b).abs() <= measures.round_off + 1e-9 * a.abs();
    assert!(agree(certificate.residual, measures.residual), "{name}: reported {certificate:?}, found {measures:?}");
    assert!(agree(certificate.complementarity, measures.complementarity), "{name}: {certificate:?}, {measures:?}");
    let (mx, my) = (case.grid.mx, case.grid.my);
    let at_edge = |i: &usize| [0, mx - 1].contains(&(i % mx)) || [0, my - 1].contains(&(i / mx));
    let touching = (0..found.p.len()).filter(|&i| found.contact[i]).filter(at_edge).count();
    assert_eq!(reported.edge_count, touching, "{name}");
    assert_eq!(reported.contact_count, found.contact.iter().filter(|&&inside| inside).count(), "{name}");
    measures
}

/// Asserts what status OK promises: residual, violation and complementarity are at most `tolerance`, but for round-off.
pub fn assert_certified(case: &Case, what: &str, found: &Found, tolerance: f64) -> Recomputed {
    assert_eq!(found.stop, Outcome::Converged, "{}, {what}: {:?}", case.name, found.report);
    let measures = assert_sound(case, what, found);
    let allowed = tolerance + measures.round_off;
    let worst = measures.residual.max(measures.violation).max(measures.complementarity);
    assert!(worst <= allowed, "{}, {what}: {measures:?}", case.name);
    measures
}

/// Solves every case by every method. AUTO must solve it; the other methods must either solve it or return another status.
pub fn assert_solved_or_told(cases: &[Case]) {
    for case in cases {
        for method in [Method::Auto, Method::FullMultigrid, Method::Multigrid, Method::Norm] {
            let found = run(case, method).unwrap_or_else(|e| panic!("{}, {method:?}: {e}", case.name));
            if found.stop == Outcome::Converged || method == Method::Auto {
                assert_certified(case, &format!("{method:?}"), &found, Options::default().tolerance);
            } else {
                assert_sound(case, &format!("{method:?}"), &found);
            }
        }
    }
}
