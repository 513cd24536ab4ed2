//! The Prony series of a viscoelastic body, sorted by time.

/// The largest number of branches of a body.
pub const MOST_BRANCHES: usize = 32;

/// Sums of moduli are equal if they differ by at most this times G. The round-off of [`MOST_BRANCHES`] additions is 32 EPSILON = 7e-15.
const ROUNDING: f64 = 1e-14;
/// Branches whose times differ by at most this, relative to the longer time, become one branch.
const EQUAL_TIMES: f64 = 1e-9;

/// The branches of a body, the one with the longest time first. All moduli and times are positive, and no two times are equal to nine digits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// The moduli of the branches relative to the instantaneous modulus, `r_k = G_k/G`.
    pub fractions: Vec<f64>,
    /// The relaxation times `t_k`.
    pub times: Vec<f64>,
    /// The long-time modulus relative to the instantaneous one, `1 - sum of r_k`. It is 0 for a fluid.
    pub rest: f64,
}

impl Series {
    /// Sorts and joins the branches of a body with the instantaneous modulus G. None if their moduli add up to more than G.
    pub fn new(g: f64, modulus: &[f64], time: &[f64]) -> Option<Series> {
        // Smaller moduli are lost in the sum with G.
        let counts = |modulus: f64| modulus > f64::EPSILON * g;
        let mut branches: Vec<(f64, f64)> = time
            .iter()
            .zip(modulus)
            .filter(|(_, modulus)| counts(**modulus))
            .map(|(t, modulus)| (*t, modulus / g))
            .collect();
        branches.sort_by(|(one, _), (other, _)| other.total_cmp(one));
        let mut series = Series { rest: 1.0, ..Series::default() };
        for (t, r) in branches {
            series.rest -= r;
            match series.times.last() {
                Some(last) if last - t <= EQUAL_TIMES * last => *series.fractions.last_mut()? += r,
                _ => {
                    series.times.push(t);
                    series.fractions.push(r);
                }
            }
        }
        if series.rest < -ROUNDING {
            return None;
        }
        if series.rest < ROUNDING {
            series.rest = 0.0;
        }
        Some(series)
    }

    /// Whether bodies of this series and of the other one relax in the same way, up to the round-off of their moduli and times.
    pub fn is_like(&self, other: &Series) -> bool {
        let are = |a: &[f64], b: &[f64], near: fn(f64, f64) -> bool| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| near(*a, *b))
        };
        are(&self.fractions, &other.fractions, |a, b| (a - b).abs() <= ROUNDING)
            && are(&self.times, &other.times, |a, b| (a - b).abs() <= ROUNDING * a.max(b))
            && (self.rest == 0.0) == (other.rest == 0.0)
    }

    /// The number of branches.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there are no branches, so that the body is elastic.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }
}
