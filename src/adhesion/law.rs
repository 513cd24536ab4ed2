//! Laws of attraction: the traction sigma between two surfaces at a distance e. Positive sigma attracts.
//!
//! ```text
//! w = integral_0^inf sigma(e) de      the work of adhesion
//! W(e) = integral_e^inf sigma         the work left at a distance e, W(0) = w
//! s(e) = -sigma'(e) >= 0              the stiffness
//!
//! t = e/rho       sigma rho/w            s rho^2/w                      W/w
//! EXPONENTIAL     exp(-t)                exp(-t)                        exp(-t)
//! DUGDALE         1 up to 1 - eta,       1/(2 eta) from 1 - eta         1 - t up to 1 - eta,
//!                 0 from 1 + eta on      to 1 + eta                     (1 + eta - t)^2/(4 eta) up to 1 + eta
//! CUBIC           (1 - t/3)^2, t < 3     2/3 (1 - t/3)                  (1 - t/3)^3
//! VAN_DER_WAALS   (1 + t/2)^-3           3/2 (1 + t/2)^-4               (1 + t/2)^-2
//! ```
//!
//! All laws have sigma(0) = w/rho. EXPONENTIAL is the law of the contact-mechanics challenge (Muser et al. 2017). DUGDALE is that of Maugis 1992
//! with an edge that is smeared over eta. VAN_DER_WAALS is that of two half-spaces, w/rho = A_H/(6 pi (2 rho)^3), with Hamaker's constant A_H.

/// How the attraction falls with the distance t = e/rho.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Law {
    /// `exp(-t)`.
    #[default]
    Exponential,
    /// Constant up to t = 1 - eta, then linear down to 0 at t = 1 + eta. The number is eta.
    Dugdale(f64),
    /// A parabola in t that ends at three ranges.
    Cubic,
    /// The inverse third power of `e + 2 rho`.
    VanDerWaals,
}

/// The number of ranges beyond which the exponential law counts as 0. There it is at most a rounding error of sigma(0), 2.3e-16.
const EXPONENTIAL_REACH: f64 = 36.0;

impl Law {
    /// The largest s(e) rho^2/w. It determines the shortest range that an element resolves.
    pub fn steepness(self) -> f64 {
        match self {
            Law::Exponential => 1.0,
            Law::Dugdale(smear) => 0.5 / smear,
            Law::Cubic => 2.0 / 3.0,
            Law::VanDerWaals => 1.5,
        }
    }

    /// The shortest range that elements with the self-influence a0 resolve: the range at which the largest `s a0` is `kappa`.
    pub fn shortest_range(self, work: f64, self_influence: f64, kappa: f64) -> f64 {
        (self.steepness() * work * self_influence / kappa).sqrt()
    }

    /// sigma rho/w as a function of t = e/rho.
    #[inline]
    fn traction(self, t: f64) -> f64 {
        match self {
            Law::Exponential if t < EXPONENTIAL_REACH => (-t).exp(),
            Law::Exponential => 0.0,
            Law::Dugdale(smear) => ((1.0 + smear - t) / (2.0 * smear)).clamp(0.0, 1.0),
            Law::Cubic => (1.0 - t / 3.0).max(0.0).powi(2),
            Law::VanDerWaals => (1.0 + 0.5 * t).powi(-3),
        }
    }

    /// s rho^2/w as a function of t.
    #[inline]
    fn slope(self, t: f64) -> f64 {
        match self {
            Law::Exponential => self.traction(t),
            Law::Dugdale(smear) if (t - 1.0).abs() < smear => 0.5 / smear,
            Law::Dugdale(_) => 0.0,
            Law::Cubic => 2.0 / 3.0 * (1.0 - t / 3.0).max(0.0),
            Law::VanDerWaals => 1.5 * (1.0 + 0.5 * t).powi(-4),
        }
    }

    /// W/w as a function of t.
    #[inline]
    fn work_left(self, t: f64) -> f64 {
        match self {
            Law::Exponential => self.traction(t),
            Law::Dugdale(smear) if t < 1.0 - smear => 1.0 - t,
            Law::Dugdale(smear) => (1.0 + smear - t).max(0.0).powi(2) / (4.0 * smear),
            Law::Cubic => (1.0 - t / 3.0).max(0.0).powi(3),
            Law::VanDerWaals => (1.0 + 0.5 * t).powi(-2),
        }
    }
}

/// A law of attraction with its range.
#[derive(Clone, Copy, Debug, Default)]
pub struct Attraction {
    /// The law.
    pub law: Law,
    /// The range rho, a length.
    pub range: f64,
}

impl Attraction {
    /// sigma at a distance e, with the work of adhesion w. A negative distance counts as 0.
    #[inline]
    pub fn traction(&self, w: f64, e: f64) -> f64 {
        w / self.range * self.law.traction(self.ranges(e))
    }

    /// The stiffness s at a distance e.
    #[inline]
    pub fn stiffness(&self, w: f64, e: f64) -> f64 {
        w / self.range / self.range * self.law.slope(self.ranges(e))
    }

    /// The work W that is left at a distance e.
    #[inline]
    pub fn work_left(&self, w: f64, e: f64) -> f64 {
        w * self.law.work_left(self.ranges(e))
    }

    /// The distance at which the exponential law has the traction sigma; infinite if sigma is not positive.
    #[inline]
    pub fn distance_of(&self, w: f64, sigma: f64) -> f64 {
        if sigma > 0.0 {
            -self.range * (sigma * self.range / w).ln()
        } else {
            f64::INFINITY
        }
    }

    /// kappa, the largest stiffness times an element's influence on itself. Above 1 a single element snaps.
    pub fn resolution(&self, work: f64, self_influence: f64) -> f64 {
        self.law.steepness() * work / self.range / self.range * self_influence
    }

    /// The distance in ranges; a negative one counts as 0.
    #[inline]
    fn ranges(&self, e: f64) -> f64 {
        e.max(0.0) / self.range
    }
}
