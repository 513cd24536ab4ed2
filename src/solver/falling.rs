//! The decrease of an error from grid to grid.

/// An error in parts, by their decrease with a doubling of the elements in both directions, and the part of the residual.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Falling {
    /// The part that falls by 16, from places of few elements.
    pub by_sixteen: f64,
    /// The part that falls by 4.
    pub by_four: f64,
    /// The part that falls by 2.
    pub by_two: f64,
    /// The part that stays, due to the residual.
    pub hidden: f64,
}

impl Falling {
    /// The error on this grid.
    pub fn now(&self) -> f64 {
        self.after(0)
    }

    /// The error after doublings, or before them if negative. On coarser grids errors grow at most by 4 a halving.
    pub fn after(&self, doublings: i32) -> f64 {
        let ratio = 0.5_f64.powi(doublings);
        let by_four = self.by_four + self.by_sixteen * (ratio * ratio).min(1.0);
        by_four * ratio * ratio + self.by_two * ratio + self.hidden
    }

    /// Each part times a factor.
    pub fn times(self, factor: f64) -> Falling {
        let [by_sixteen, by_four, by_two, hidden] =
            [self.by_sixteen, self.by_four, self.by_two, self.hidden].map(|part| part * factor);
        Falling { by_sixteen, by_four, by_two, hidden }
    }

    /// The error relative to a value, if that is finite and not 0. An error of exactly 0 is 0 of any value.
    pub fn over(self, whole: f64) -> Option<Falling> {
        if self.now() == 0.0 && whole == 0.0 {
            return Some(Falling::default());
        }
        Some(self.times(1.0 / whole.abs())).filter(|relative| relative.now().is_finite())
    }
}
