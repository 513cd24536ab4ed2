//! The measures of a result, recomputed.

use crate::call::Outputs;
use crate::case::Case;

/// The measures of a result, recomputed.
pub struct Measures {
    /// 2-norms over C of `h - approach + A p` and of `h - approach`.
    pub residual: f64,
    pub distance: f64,
    /// The number of elements in C.
    pub count: f64,
    /// The rms of `h - approach` over C and the elements at their limit.
    pub rms: f64,
    /// The largest -e outside C, and e at a limit.
    pub violation: f64,
    /// `sum of p |e|` over C, and `sum of p |u|`.
    pub work: (f64, f64),
    /// The possible round-off of one e.
    pub rounding: f64,
    /// The largest difference between the returned displacements and A p, and between the returned distances and those by the displacements.
    pub wrong_u: f64,
    pub wrong_e: f64,
}

impl Measures {
    pub fn of(case: &Case, found: &Outputs) -> Measures {
        let operator = case.operator();
        let u = operator.displace(&found.p);
        let approach = found.report.normal.approach;
        let mut m = Measures {
            residual: 0.0,
            distance: 0.0,
            count: 0.0,
            rms: 0.0,
            violation: 0.0,
            work: (0.0, 0.0),
            rounding: 0.0,
            wrong_u: 0.0,
            wrong_e: 0.0,
        };
        let mut limited = (0.0, 0.0);
        let mut largest = approach.abs();
        for (i, &u) in u.iter().enumerate() {
            let (h, p) = (case.h[i], found.p[i]);
            m.wrong_u = m.wrong_u.max((u - found.u[i]).abs());
            largest = largest.max(u.abs());
            if h.is_infinite() {
                continue;
            }
            let e = h - approach + u;
            // Both are sums of three numbers.
            let by_u = h - approach + found.u[i];
            let allowed = 4.0 * f64::EPSILON * (h.abs() + approach.abs() + u.abs()) + case.h_rounding;
            m.wrong_e = m.wrong_e.max((by_u - found.e[i]).abs() - allowed);
            m.work.1 += p * u.abs();
            match found.contact[i] {
                0 => m.violation = m.violation.max(-e),
                1 => {
                    m.residual += e * e;
                    m.distance += (h - approach).powi(2);
                    m.count += 1.0;
                    m.work.0 += p * e.abs();
                    largest = largest.max(h.abs());
                }
                _ => {
                    m.violation = m.violation.max(e);
                    limited = (limited.0 + (h - approach).powi(2), limited.1 + 1.0);
                    largest = largest.max(h.abs());
                }
            }
        }
        m.rms = ((m.distance + limited.0) / f64::max(m.count + limited.1, 1.0)).sqrt();
        (m.residual, m.distance) = (m.residual.sqrt(), m.distance.sqrt());
        m.rounding = operator.rounding(&found.p) + 8.0 * f64::EPSILON * largest + case.h_rounding;
        m
    }

    /// The measures in one line.
    pub fn text(&self, found: &Outputs) -> String {
        let (status, cycles, work) = (found.status, found.report.statistics.cycles, found.report.statistics.work_units);
        let (residual, violation, rms) = (self.relative(), self.violation, self.rms);
        format!("status {status}, {cycles} cycles, {work:.1} units: residual {residual:.2e}, violation {violation:.2e} of {rms:.2e}")
    }

    /// The residual over C, relative to the distances.
    pub fn relative(&self) -> f64 {
        if self.residual == 0.0 {
            0.0
        } else {
            self.residual / self.distance
        }
    }

    /// Whether the residual is within a tolerance.
    pub fn residual_holds(&self, tolerance: f64) -> bool {
        // The tolerance is rounded, and the norms are sums of n squares.
        self.residual <= tolerance * (1.0 + 1e-12) * self.distance + self.rounding * self.count.sqrt()
    }

    /// Whether the conditions hold up to their possible round-off: no solver could do better. With a prescribed force the approach is a mean over C,
    /// a sum of many numbers. In 60000 cases results that stagnate are within 4 times the round-off of one e on small contact areas, and within 13
    /// times on some thousand elements.
    pub fn holds_to_rounding(&self, case: &Case, found: &Outputs) -> bool {
        let (tolerance, rounding) = (case.how.tolerance, (10.0 + self.count.sqrt()) * self.rounding);
        let pressures = found.p.iter().sum::<f64>();
        let free = self.violation <= tolerance * self.rms + rounding
            && self.work.0 <= tolerance * self.work.1 + rounding * pressures;
        self.residual <= tolerance * self.distance + rounding * self.count.sqrt() && (case.how.fixed.is_some() || free)
    }
}

/// The sum by halves: a sum of n equal terms one by one would have an error of some n eps/4.
pub fn pairwise(values: &[f64]) -> f64 {
    match values.len() {
        0..=64 => values.iter().sum(),
        n => pairwise(&values[..n / 2]) + pairwise(&values[n / 2..]),
    }
}
