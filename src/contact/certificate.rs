//! How well the contact conditions hold: everything here is computed from p, h and a fresh u = A p.

use super::State;

/// The measures of a solution. Status OK means that they hold to the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certificate {
    /// `||h - approach + A p|| / ||h - approach||`, 2-norms over C.
    pub residual: f64,
    /// Largest `-e` over the exterior area, 0 when the bodies penetrate nowhere: a length.
    pub penetration: f64,
    /// `sum of p |e| / sum of p |u|` over all elements: pressures times gaps, against the elastic energy.
    pub complementarity: f64,
    /// Smallest pressure.
    pub min_pressure: f64,
}

/// What one pass over a state whose u is A p tells.
#[derive(Clone, Copy, Debug)]
pub struct Survey {
    /// 2-norm over C of `e = h - approach + u`.
    pub residual: f64,
    /// 2-norm over C of `h - approach`: what residuals are compared with.
    pub distance: f64,
    /// Largest `-e` over the exterior area, 0 when the bodies penetrate nowhere.
    pub penetration: f64,
    /// Elements in contact.
    pub contact_count: usize,
    /// Sum of p.
    pub pressures: f64,
    /// Smallest and largest p.
    pub range: (f64, f64),
    /// `sum of p |e|` and `sum of p |u|`.
    pub work: (f64, f64),
}

impl Survey {
    /// Surveys a state.
    pub fn of(state: &State) -> Survey {
        if !state.at_limit.is_empty() {
            return Survey::of_limited(state);
        }
        let mut survey = Survey::nothing();
        let mx = state.grid.mx;
        for start in (0..state.grid.len()).step_by(mx) {
            let row = start..start + mx;
            let (h, u) = (&state.h[row.clone()], &state.u[row.clone()]);
            let (p, contact) = (&state.p[row.clone()], &state.contact[row]);
            // Most rows have no element that penetrates, and many none in contact: both the compiler can vectorise.
            let (mut penetrates, mut loaded) = (false, false);
            for i in 0..mx {
                penetrates |= !contact[i] & (h[i] - state.approach + u[i] < 0.0);
                loaded |= contact[i] | (p[i] != 0.0);
            }
            if penetrates {
                for i in (0..mx).filter(|&i| !contact[i]) {
                    survey.penetration = survey.penetration.max(state.approach - h[i] - u[i]);
                }
            }
            if loaded {
                survey.add_row(state.approach, h, u, p, contact);
            } else {
                survey.range = (survey.range.0.min(0.0), survey.range.1.max(0.0));
            }
        }
        (survey.residual, survey.distance) = (survey.residual.sqrt(), survey.distance.sqrt());
        survey
    }

    pub(super) fn nothing() -> Survey {
        Survey {
            residual: 0.0,
            distance: 0.0,
            penetration: 0.0,
            contact_count: 0,
            pressures: 0.0,
            range: (f64::INFINITY, f64::NEG_INFINITY),
            work: (0.0, 0.0),
        }
    }

    fn add_row(&mut self, approach: f64, h: &[f64], u: &[f64], p: &[f64], contact: &[bool]) {
        let (mut rr, mut hh, mut count) = (0.0, 0.0, 0);
        let (mut pressures, mut gaps, mut energy) = (0.0, 0.0, 0.0);
        for i in 0..h.len() {
            self.range = (self.range.0.min(p[i]), self.range.1.max(p[i]));
            if !contact[i] && p[i] == 0.0 {
                continue;
            }
            let distance = h[i] - approach;
            let e = distance + u[i];
            if contact[i] {
                rr += e * e;
                hh += distance * distance;
                count += 1;
            }
            pressures += p[i];
            gaps += p[i] * e.abs();
            energy += p[i] * u[i].abs();
        }
        self.residual += rr;
        self.distance += hh;
        self.contact_count += count;
        self.pressures += pressures;
        self.work = (self.work.0 + gaps, self.work.1 + energy);
    }

    /// The measures of the solution.
    pub fn certificate(&self) -> Certificate {
        let relative = |value: f64, scale: f64| if value == 0.0 { 0.0 } else { value / scale };
        Certificate {
            residual: relative(self.residual, self.distance),
            penetration: self.penetration,
            complementarity: relative(self.work.0, self.work.1),
            min_pressure: self.range.0,
        }
    }
}

/// 2-norm over C of `h - approach`.
pub fn norm_of_distance(state: &State) -> f64 {
    over_contact(state, |i| state.h[i] - state.approach)
}

/// 2-norm over C of `h - approach + u`.
pub fn residual_norm(state: &State) -> f64 {
    over_contact(state, |i| state.deformed_distance(i))
}

fn over_contact(state: &State, value: impl Fn(usize) -> f64) -> f64 {
    let mut sum = 0.0;
    for (i, _) in state.contact.iter().enumerate().filter(|(_, &inside)| inside) {
        sum += value(i) * value(i);
    }
    sum.sqrt()
}

/// Measures a state whose u is A p.
pub fn certify(state: &State) -> Certificate {
    Survey::of(state).certificate()
}
