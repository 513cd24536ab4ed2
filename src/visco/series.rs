//! A Prony series, sorted by time.

/// Most branches of a body.
pub const MOST_BRANCHES: usize = 32;

/// Relative round-off of a sum of moduli: [`MOST_BRANCHES`] additions, 32 EPSILON = 7e-15.
const ROUNDING: f64 = 1e-14;
/// Relative difference below which times are equal.
const EQUAL_TIMES: f64 = 1e-9;

/// `r_k` and `t_k`, the longest time first, all of them positive, no two times equal to nine digits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// `r_k`.
    pub fractions: Vec<f64>,
    /// `t_k`.
    pub times: Vec<f64>,
    /// `1 - sum of r_k`: the long-time modulus, relative; 0: a fluid.
    pub rest: f64,
}

impl Series {
    /// Branches of these moduli and times of a body of instantaneous modulus G. None if they add up to more than G.
    pub fn new(g: f64, modulus: &[f64], time: &[f64]) -> Option<Series> {
        let counts = |modulus: f64| modulus > f64::EPSILON * g;
        let mut branches: Vec<(f64, f64)> = time
            .iter()
            .zip(modulus)
            .filter(|(_, modulus)| counts(**modulus))
            .map(|(t, modulus)| (*t, modulus / g))
            .collect();
        branches.sort_by(|a, b| b.0.total_cmp(&a.0));
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

    /// Whether bodies of both series relax alike, to the round-off of their moduli and times.
    pub fn is_like(&self, other: &Series) -> bool {
        let are = |a: &[f64], b: &[f64], near: fn(f64, f64) -> bool| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| near(*a, *b))
        };
        are(&self.fractions, &other.fractions, |a, b| (a - b).abs() <= ROUNDING)
            && are(&self.times, &other.times, |a, b| (a - b).abs() <= ROUNDING * a.max(b))
            && (self.rest == 0.0) == (other.rest == 0.0)
    }

    /// Number of branches.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether the body is elastic.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }
}
