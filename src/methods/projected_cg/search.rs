//! The state between two iterations: the forecast of the step length, and the slope of the last direction.

/// The forecast of the first alpha: the first step of fixed length leaves smooth errors, with eigenvalues near 1.
pub(super) const FIRST_FORECAST: f64 = 0.9;
/// The usual range of later forecasts, each of which is the last alpha.
const FORECASTS: (f64, f64) = (0.3, 1.0);
/// Factor between forecast and alpha beyond which the forecast failed.
const FAR_OFF: f64 = 3.0;

/// Step lengths and slopes passed from one iteration to the next.
pub(super) struct Search {
    /// alpha', if there is one.
    pub(super) forecast: Option<f64>,
    /// Whether steps may be clipped. Clipped directions may fail to descend; then the next one is neither clipped nor conjugate to this one.
    pub(super) may_clip: bool,
    /// (t, q); 0 if the next direction is conjugate to none.
    pub(super) tq: f64,
    pub(super) is_first: bool,
    /// Products not yet counted.
    pub(super) products: u64,
}

impl Search {
    /// The state before the first iteration.
    pub(super) fn new(forecast: Option<f64>) -> Search {
        Search { forecast, may_clip: true, tq: 0.0, is_first: true, products: 0 }
    }

    /// The forecast, if alpha is within the factor [`FAR_OFF`] of it. If not, the next direction is neither clipped nor conjugate to this one.
    pub(super) fn believed(&mut self, alpha: f64) -> Option<f64> {
        let good = self.forecast.filter(|forecast| self.may_clip && within_factor(alpha, *forecast, FAR_OFF));
        self.may_clip = !self.may_clip || good.is_some();
        if !self.may_clip {
            self.tq = 0.0;
        }
        good
    }

    /// Makes this alpha the next forecast, clamped to the usual range if it is near that.
    pub(super) fn expect(&mut self, alpha: f64, preconditioned: bool) {
        let usual = alpha.clamp(FORECASTS.0, FORECASTS.1);
        let near = preconditioned && within_factor(alpha, usual, FAR_OFF);
        self.forecast = Some(if near { usual } else { alpha }).filter(|_| alpha > 0.0);
    }
}

fn within_factor(value: f64, other: f64, factor: f64) -> bool {
    value * factor > other && value < factor * other
}
