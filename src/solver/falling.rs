//! Errors of which the decrease from grid to grid is known.

/// An error on one grid, in parts. Each part decreases by another factor if the number of elements doubles in both directions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Falling {
    /// The part that decreases by a factor of 16: of contact on few elements.
    pub by_sixteen: f64,
    /// The part that decreases by a factor of 4: of second order.
    pub by_four: f64,
    /// The part that decreases by a factor of 2: of first order.
    pub by_two: f64,
    /// The part that does not decrease: that of the residual.
    pub hidden: f64,
}

impl Falling {
    /// The error on this grid.
    pub fn now(&self) -> f64 {
        self.after(0)
    }

    /// The error on the grid with the elements doubled `doublings` times in both directions; negative numbers are halvings. With a halving no part
    /// grows by more than a factor of 4.
    pub fn after(&self, doublings: i32) -> f64 {
        let ratio = 0.5_f64.powi(doublings);
        let by_four = self.by_four + self.by_sixteen * (ratio * ratio).min(1.0);
        by_four * ratio * ratio + self.by_two * ratio + self.hidden
    }

    /// The error times a factor.
    pub fn times(self, factor: f64) -> Falling {
        let [by_sixteen, by_four, by_two, hidden] =
            [self.by_sixteen, self.by_four, self.by_two, self.hidden].map(|part| part * factor);
        Falling { by_sixteen, by_four, by_two, hidden }
    }

    /// The error relative to the value `whole`. None if the result is not finite. An error of 0 relative to a value of 0 is 0.
    pub fn over(self, whole: f64) -> Option<Falling> {
        if self.now() == 0.0 && whole == 0.0 {
            return Some(Falling::default());
        }
        Some(self.times(1.0 / whole.abs())).filter(|relative| relative.now().is_finite())
    }
}
