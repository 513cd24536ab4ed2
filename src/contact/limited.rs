//! The certificate of a scene with a pressure limit.

use super::{State, Survey};

impl Survey {
    /// Surveys a state some elements of which are at the limit: they are neither in C nor exterior, their e must not be positive, and
    /// that counts like a penetration.
    pub(super) fn of_limited(state: &State) -> Survey {
        let mut survey = Survey::nothing();
        for i in 0..state.p.len() {
            let (p, e) = (state.p[i], state.deformed_distance(i));
            survey.range = (survey.range.0.min(p), survey.range.1.max(p));
            survey.pressures += p;
            if p != 0.0 {
                survey.work.1 += p * state.u[i].abs();
            }
            if state.at_limit[i] {
                survey.contact_count += 1;
                // What is at its limit touches: its distance is part of the scale.
                survey.distance += (state.h[i] - state.approach).powi(2);
                survey.penetration = survey.penetration.max(e);
                survey.work.0 += p * e.max(0.0);
            } else if state.contact[i] {
                survey.contact_count += 1;
                survey.residual += e * e;
                survey.distance += (state.h[i] - state.approach).powi(2);
                survey.work.0 += p * e.abs();
            } else {
                survey.penetration = survey.penetration.max(-e);
            }
        }
        (survey.residual, survey.distance) = (survey.residual.sqrt(), survey.distance.sqrt());
        survey
    }
}
