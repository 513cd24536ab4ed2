//! What one iteration leaves for the next: the forecast of the step length, and (t, q) of the last direction.

/// The forecast of the first alpha. The first step of fixed length leaves smooth errors, whose eigenvalues of M A are near 1.
pub(super) const FIRST_FORECAST: f64 = 0.9;
/// The usual range of forecasts. Each forecast is the last alpha, clamped to this range if alpha is near the range.
const FORECASTS: (f64, f64) = (0.3, 1.0);
/// A forecast has failed if it and alpha differ by more than this factor.
const FAR_OFF: f64 = 3.0;

/// What one iteration leaves for the next.
pub(super) struct Search {
    /// The forecast alpha' of the step length, if there is one.
    pub(super) forecast: Option<f64>,
    /// Whether steps may be clipped. A clipped direction may fail to descend; then the next direction is neither clipped nor conjugate to it.
    pub(super) may_clip: bool,
    /// (t, q) of the last direction; 0 if the next direction is not to be conjugate to it.
    pub(super) tq: f64,
    /// Whether the next iteration is the first.
    pub(super) is_first: bool,
    /// Products before the first iteration, which are not yet counted.
    pub(super) products: u64,
}

impl Search {
    /// The values before the first iteration.
    pub(super) fn new(forecast: Option<f64>) -> Search {
        Search { forecast, may_clip: true, tq: 0.0, is_first: true, products: 0 }
    }

    /// Returns the forecast if steps are clipped and alpha is within the factor [`FAR_OFF`] of the forecast. Otherwise None; if steps were clipped,
    /// the next direction is then neither clipped nor conjugate to this one.
    pub(super) fn believed(&mut self, alpha: f64) -> Option<f64> {
        let good = self.forecast.filter(|forecast| self.may_clip && within_factor(alpha, *forecast, FAR_OFF));
        self.may_clip = !self.may_clip || good.is_some();
        if !self.may_clip {
            self.tq = 0.0;
        }
        good
    }

    /// Makes alpha the next forecast. With a preconditioner alpha is clamped to the usual range if it is near this range. Without a positive alpha
    /// there is no forecast.
    pub(super) fn expect(&mut self, alpha: f64, preconditioned: bool) {
        let usual = alpha.clamp(FORECASTS.0, FORECASTS.1);
        let near = preconditioned && within_factor(alpha, usual, FAR_OFF);
        self.forecast = Some(if near { usual } else { alpha }).filter(|_| alpha > 0.0);
    }
}

/// Whether two positive values differ by less than a factor.
fn within_factor(value: f64, other: f64, factor: f64) -> bool {
    value * factor > other && value < factor * other
}
