//! The residuals of the contact conditions, recomputed from the returned pressures with the campaign's own matrix A.

use crate::call::Outputs;
use crate::case::Case;

/// The residuals of the contact conditions of one result, the scales that they are relative to, and their round-off. C is the returned contact area.
pub struct Measures {
    /// The 2-norm over C of `h - approach + A p`.
    pub residual: f64,
    /// The 2-norm over C of `h - approach`.
    pub distance: f64,
    /// The number of elements in C, as a float, for the norms.
    pub count: f64,
    /// The rms of `h - approach` over C and the elements at their pressure limit.
    pub rms: f64,
    /// The largest -e outside C, or e at an element at its pressure limit, whichever is larger.
    pub violation: f64,
    /// `sum of p |e|` over C.
    pub complementarity: f64,
    /// `sum of p |u|` over all elements with a surface: the scale of `complementarity`.
    pub elastic_work: f64,
    /// The possible round-off of one e.
    pub rounding: f64,
    /// The largest difference between the returned displacement and A p.
    pub error_of_u: f64,
    /// The largest amount by which `|returned e - (h - approach + returned u)|` exceeds its round-off; 0 if it never does.
    pub excess_error_of_e: f64,
}

impl Measures {
    /// Computes the measures of a result.
    pub fn of(case: &Case, found: &Outputs) -> Measures {
        let operator = case.operator();
        let u = operator.displace(&found.p);
        let approach = found.report.normal.approach;
        let (mut squares_of_e, mut squares_of_d, mut count) = (0.0, 0.0, 0.0);
        let (mut limited_squares_of_d, mut limited_count) = (0.0, 0.0);
        let (mut complementarity, mut elastic_work, mut violation) = (0.0, 0.0, 0.0f64);
        let (mut error_of_u, mut excess_error_of_e) = (0.0f64, 0.0f64);
        // The largest of the numbers whose sum e is.
        let mut largest_term = approach.abs();
        for (i, &u) in u.iter().enumerate() {
            let (h, p) = (case.h[i], found.p[i]);
            error_of_u = error_of_u.max((u - found.u[i]).abs());
            largest_term = largest_term.max(u.abs());
            if h.is_infinite() {
                continue;
            }
            let e = h - approach + u;
            // This and the library's e are the same sum of three numbers, perhaps added in another order.
            let e_by_returned_u = h - approach + found.u[i];
            let allowed = 4.0 * f64::EPSILON * (h.abs() + approach.abs() + u.abs()) + case.h_rounding;
            excess_error_of_e = excess_error_of_e.max((e_by_returned_u - found.e[i]).abs() - allowed);
            elastic_work += p * u.abs();
            match found.contact[i] {
                0 => violation = violation.max(-e),
                1 => {
                    squares_of_e += e * e;
                    squares_of_d += (h - approach).powi(2);
                    count += 1.0;
                    complementarity += p * e.abs();
                    largest_term = largest_term.max(h.abs());
                }
                _ => {
                    violation = violation.max(e);
                    limited_squares_of_d += (h - approach).powi(2);
                    limited_count += 1.0;
                    largest_term = largest_term.max(h.abs());
                }
            }
        }
        Measures {
            residual: squares_of_e.sqrt(),
            distance: squares_of_d.sqrt(),
            count,
            rms: ((squares_of_d + limited_squares_of_d) / f64::max(count + limited_count, 1.0)).sqrt(),
            violation,
            complementarity,
            elastic_work,
            rounding: operator.rounding(&found.p) + 8.0 * f64::EPSILON * largest_term + case.h_rounding,
            error_of_u,
            excess_error_of_e,
        }
    }

    /// The measures in one line.
    pub fn text(&self, found: &Outputs) -> String {
        let (status, cycles, units) =
            (found.status, found.report.statistics.cycles, found.report.statistics.work_units);
        let (residual, violation, rms) = (self.relative(), self.violation, self.rms);
        format!("status {status}, {cycles} cycles, {units:.1} units: residual {residual:.2e}, violation {violation:.2e} of {rms:.2e}")
    }

    /// The residual relative to `distance`.
    pub fn relative(&self) -> f64 {
        if self.residual == 0.0 {
            0.0
        } else {
            self.residual / self.distance
        }
    }

    /// Whether the residual is within a tolerance, relative to `distance`, up to round-off.
    pub fn residual_holds(&self, tolerance: f64) -> bool {
        // 1e-12: the library adds the squares in another order, so its norms differ in the last digits.
        self.residual <= tolerance * (1.0 + 1e-12) * self.distance + self.rounding * self.count.sqrt()
    }

    /// Whether the conditions hold to the tolerance plus round-off, so that no solver could do better. The round-off that is allowed is 10 + sqrt(n)
    /// times that of one e, where n is the number of elements in C. With a given force the approach is a mean over C, and has the errors of all its
    /// terms. In 60000 cases, results that stagnated needed a factor of 4 on small contact areas, and of 13 on some thousand elements.
    pub fn holds_to_rounding(&self, case: &Case, found: &Outputs) -> bool {
        let (tolerance, rounding) = (case.how.tolerance, (10.0 + self.count.sqrt()) * self.rounding);
        let pressures = found.p.iter().sum::<f64>();
        // A fixed contact area has neither of these two conditions.
        let holds_as_free_area = self.violation <= tolerance * self.rms + rounding
            && self.complementarity <= tolerance * self.elastic_work + rounding * pressures;
        self.residual <= tolerance * self.distance + rounding * self.count.sqrt()
            && (case.how.fixed.is_some() || holds_as_free_area)
    }
}

/// Pairwise summation. If n equal terms were added one by one, the relative error could be up to about n eps/4 (Higham, Accuracy and Stability of
/// Numerical Algorithms, chapter 4).
pub fn pairwise(values: &[f64]) -> f64 {
    match values.len() {
        0..=64 => values.iter().sum(),
        n => pairwise(&values[..n / 2]) + pairwise(&values[n / 2..]),
    }
}
