//! The radial functions of one pair of materials: what a layer adds to the coefficients of a half-space, as a function of the distance rho in
//! thicknesses.
//!
//! ```text
//! F_b(rho) = integral from 0 to infinity of (B(s) - b) J0(s rho) ds,    M_b(rho) = integral from 0 to rho of F_b rho' drho'
//! F_B0(rho) = F_1(rho) + (1 - B0)/rho
//! ```
//!
//! with b = 1, the half-space of the layer's material, or b = B0 = B(0), that of the substrate. F_1 is smooth at 0; F_B0 decays as `1/rho^3`. All
//! singularities of both lie at `w = 4 + rho^2 <= 0`. Therefore both are polynomials of degree 13 on panels of w, each a quarter of an octave,
//! such as `[2^k, 1.25 2^k]`. The error is `(9 + sqrt 80)^-14 = 3e-18` for a function like `w^-5/2` near 0. The bits of w give the number of the
//! panel. M is an integral of the polynomial, by `rho drho = dw/2`. Below rho = 2 the polynomials are those of F_1, beyond those of F_B0.
//!
//! The values at the nodes come from quadrature ([`Hankel`]). Beyond `rho = 100 L`, with 1/L the distance of the nearest pole of B from s = 0,
//! asymptotic series with the Taylor coefficients of B are used:
//!
//! ```text
//! F_B0 = -B2/rho^3 + 9 B4/rho^5 - 225 B6/rho^7 + 11025 B8/rho^9 - 893025 B10/rho^11
//! M_B0 = B1 + B2/rho - 3 B4/rho^3 + 45 B6/rho^5 - 1575 B8/rho^7 + 99225 B10/rho^9
//! ```
//!
//! For stiff layers L is about `1.75 mu`, the length over which they spread a load as membranes.

use super::base::{Base, SMOOTH};
use super::hankel::Hankel;
use super::polynomial::{chebyshev, evaluate, integral, node, powers, terms};
use super::response::{Response, TERMS};
use super::transfer::Transfer;
use crate::blocks::LANES;
use crate::influence::gauss;

/// The number of coefficients of a polynomial of degree 13.
pub const P: usize = 14;
/// The bound on the omitted terms of a polynomial, relative to the half-space's `b/rho`.
const LEFT_OUT: f64 = 1e-15;

/// The radial functions F and M of a layer of unit thickness, as tables of polynomials.
#[derive(Clone, Debug, PartialEq)]
pub struct Radial<R = Transfer> {
    /// The response B.
    pub transfer: R,
    /// The Taylor coefficients of B.
    taylor: [f64; TERMS],
    /// The panels of w from 4 on.
    panels: Vec<Panel>,
    /// The polynomial of `M_1/rho^2` on the first panel, where rho may be 0.
    mean: [f64; P],
    /// The w at which the panels end. Beyond, the asymptotic series hold.
    far: f64,
    /// Values of B at s = [`FIRST`] and larger, eight for each octave.
    roughly: Vec<f64>,
}

/// F and M on one panel of w, as polynomials on [-1, 1].
#[derive(Clone, Debug, PartialEq)]
struct Panel {
    /// The coefficients of F.
    f: [f64; P],
    /// The number of coefficients of F that are used. The rest is below [`LEFT_OUT`]. Far from the load, where F is small compared with the
    /// half-space, fewer are needed.
    terms: usize,
    /// The coefficients of M.
    m: [f64; P + 1],
}

impl Panel {
    fn f(&self) -> &[f64] {
        &self.f[..self.terms]
    }
}

/// The first s at which a rough value of B is stored.
const FIRST: f64 = 1.0 / (1u64 << 32) as f64;
/// The number of octaves of s over which rough values are stored.
const OCTAVES: usize = 38;

impl<R: Response> Radial<R> {
    /// Computes the tables of a layer with this response. This takes milliseconds.
    pub fn new(transfer: R) -> Radial<R> {
        let taylor = transfer.taylor();
        let scale = transfer.substrate().max(1.0);
        let pole = (6..TERMS).map(|k| (taylor[k].abs() / scale).powf(1.0 / k as f64)).fold(0.5, f64::max);
        // Octaves of w up to rho = 100 L.
        let octaves = ((50.0 * pole).powi(2) + 1.0).log2().ceil() as usize;
        let far = 4.0 * (1u64 << octaves) as f64;
        let hankel = Hankel::new(&transfer, pole, (far - 4.0).sqrt());
        let mut panels = Vec::new();
        // M at the lower end of the panel. It is M_1 below rho = 2 and M_B0 beyond; they differ by (1 - B0) rho.
        let mut before = 0.0;
        for panel in 0..4 * octaves {
            let (low, high) = ends_of(panel);
            if low == SMOOTH {
                before += 2.0 * (1.0 - transfer.substrate());
            }
            let panel = Radial::<R>::panel(&hankel, &transfer, (low, high), before);
            before = evaluate(&panel.m, 1.0);
            panels.push(panel);
        }
        let mean = Radial::<R>::mean(&panels[0]);
        let s_of = |k: usize| FIRST * (1u64 << (k / 8)) as f64 * (1.0 + (k % 8) as f64 / 8.0);
        let roughly = (0..=8 * OCTAVES).map(|k| transfer.at(s_of(k))).collect();
        Radial { transfer, taylor, panels, mean, far, roughly }
    }

    /// F and M on the panel between the w `low` and `high`. `before` is M at its lower end.
    fn panel(hankel: &Hankel, transfer: &R, (low, high): (f64, f64), before: f64) -> Panel {
        let rho = |x: f64| (0.5 * (low + high) + 0.5 * (high - low) * x - 4.0).max(0.0).sqrt();
        let is_near = high <= SMOOTH;
        let value = |x: f64| if is_near { hankel.layer(rho(x)) } else { hankel.substrate(rho(x)) };
        let coefficients: [f64; P] = chebyshev(&std::array::from_fn(|i| value(node(i, P))));
        let half_space = if is_near { 1.0 } else { transfer.substrate() } / rho(1.0);
        let terms = terms(&coefficients, LEFT_OUT * half_space);
        let f = powers(&coefficients[..terms]);
        Panel { f, terms, m: integral(&f, 0.25 * (high - low), before) }
    }

    /// `M_1/rho^2 = integral from 0 to 1 of F_1(rho sqrt(x)) dx/2` on the first panel. F_1 is the panel's polynomial, which the Gauss rule
    /// integrates exactly.
    fn mean(first: &Panel) -> [f64; P] {
        let rule = gauss::rule(P.div_ceil(2));
        let value = |node: f64| {
            // The part of the panel between w = 4, where rho^2 is 0, and the node.
            let part = 0.5 * (1.0 + node);
            let f = |(x, weight): &(f64, f64)| weight * evaluate(first.f(), 2.0 * part * x - 1.0);
            0.5 * rule.iter().map(f).sum::<f64>()
        };
        powers(&chebyshev(&std::array::from_fn::<f64, P, _>(|i| value(node(i, P)))))
    }

    /// The number of panels.
    pub(super) fn panels(&self) -> usize {
        self.panels.len()
    }

    /// B(s) to three digits, for preconditioners: linear interpolation between stored values, which are an eighth of an octave apart.
    pub fn roughly(&self, s: f64) -> f64 {
        let eighths = (s / FIRST).to_bits() >> 49;
        let first = 1023 << 3;
        if eighths < first {
            return self.transfer.substrate();
        }
        let k = (eighths - first) as usize;
        let Some([low, high]) = self.roughly.get(k..k + 2) else { return 1.0 };
        let s_low = f64::from_bits(eighths << 49) * FIRST;
        let width = f64::from_bits((eighths + 1) << 49) * FIRST - s_low;
        low + (high - low) * (s - s_low) / width
    }

    /// F at the distance rho in thicknesses. rho must be positive if the substrate is the base.
    pub fn f(&self, rho: f64, base: Base) -> f64 {
        self.f_at_square(rho * rho, base)
    }

    /// F at the distance whose square is `rho2`.
    pub fn f_at_square(&self, rho2: f64, base: Base) -> f64 {
        let w = 4.0 + rho2;
        let value = self.on_panel(w, Panel::f).unwrap_or_else(|| self.far_f(rho2.sqrt()));
        self.change(w, base).map_or(value, |change| value + change / rho2.sqrt())
    }

    /// The value at w of F or M, whichever polynomial `of` takes from the panel; `None` beyond the panels.
    fn on_panel(&self, w: f64, of: impl Fn(&Panel) -> &[f64]) -> Option<f64> {
        (w < self.far).then(|| {
            let (panel, (low, high)) = panel_of(w);
            evaluate(of(&self.panels[panel]), (w - 0.5 * (low + high)) * (2.0 / (high - low)))
        })
    }

    /// What has to be added to `F rho` and to `M/rho` if `base` is not the base of the panel at w; `None` if it is.
    fn change(&self, w: f64, base: Base) -> Option<f64> {
        let change = Base::at(w).to(base) * (1.0 - self.transfer.substrate());
        (change != 0.0).then_some(change)
    }

    /// Fills `out[k]` with F at the distance `sqrt((x + k dx)^2 + y^2)`; x and y are not negative, and all lengths are in thicknesses. Places on
    /// one panel are computed together.
    pub fn fill_f(&self, (x, dx, y): (f64, f64, f64), base: Base, out: &mut [f64]) {
        let w = |k: usize| {
            let x = x + k as f64 * dx;
            4.0 + (x * x + y * y)
        };
        let mut first = 0;
        while first < out.len() {
            let start = w(first);
            if start >= self.far {
                for (k, value) in out.iter_mut().enumerate().skip(first) {
                    let rho = (w(k) - 4.0).sqrt();
                    let far = self.far_f(rho);
                    *value = self.change(start, base).map_or(far, |change| far + change / rho);
                }
                return;
            }
            let (panel, (low, high)) = panel_of(start);
            // The first place beyond the panel is included: it may be on the panel up to round-off, and the polynomial still holds there.
            let beyond = ((high - 4.0 - y * y).max(0.0).sqrt() - x) / dx;
            let end = if beyond < out.len() as f64 { (beyond as usize).max(first) + 1 } else { out.len() };
            let (polynomial, middle, scale) = (self.panels[panel].f(), 0.5 * (low + high), 2.0 / (high - low));
            let end = end.min(out.len());
            let run = &mut out[first..end];
            fill_run(polynomial, (x + first as f64 * dx, dx, 4.0 + y * y - middle, scale), run);
            if let Some(change) = self.change(start, base) {
                run.iter_mut().enumerate().for_each(|(k, value)| *value += change / (w(first + k) - 4.0).sqrt());
            }
            first += run.len();
        }
    }

    /// M at the distance rho in thicknesses.
    pub fn m(&self, rho: f64, base: Base) -> f64 {
        let w = 4.0 + rho * rho;
        let value = self.on_panel(w, |panel| &panel.m).unwrap_or_else(|| self.far_m(rho));
        self.change(w, base).map_or(value, |change| value + change * rho)
    }

    /// `M/rho^2` at the distance whose square is `rho2`, which may be 0 if the layer is the base.
    pub fn mean_at_square(&self, rho2: f64, base: Base) -> f64 {
        let (w, (low, high), rho) = (4.0 + rho2, ends_of(0), rho2.sqrt());
        let one_minus_substrate = 1.0 - self.transfer.substrate();
        if w < high {
            let mean = evaluate(&self.mean, (w - 0.5 * (low + high)) * (2.0 / (high - low)));
            return if base == Base::Layer { mean } else { mean + one_minus_substrate / rho };
        }
        match (w < self.far, base) {
            (true, _) => self.m(rho, base) / rho2,
            (false, Base::Substrate) => self.far_m(rho) / rho2,
            (false, Base::Layer) => self.far_m(rho) / rho2 - one_minus_substrate / rho,
        }
    }

    /// F_B0 beyond the panels, by its asymptotic series.
    fn far_f(&self, rho: f64) -> f64 {
        let (b, q) = (&self.taylor, 1.0 / (rho * rho));
        let sum = -b[2] + q * (9.0 * b[4] + q * (-225.0 * b[6] + q * (11025.0 * b[8] - q * 893_025.0 * b[10])));
        sum * q / rho
    }

    /// M_B0 beyond the panels, by its asymptotic series.
    fn far_m(&self, rho: f64) -> f64 {
        let (b, q) = (&self.taylor, 1.0 / (rho * rho));
        let sum = b[2] + q * (-3.0 * b[4] + q * (45.0 * b[6] + q * (-1575.0 * b[8] + q * 99225.0 * b[10])));
        b[1] + sum / rho
    }
}

/// The numbers of the places that are computed at a time.
const OFFSETS: [f64; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// Fills `run[k]` with `polynomial(((x + k dx)^2 + shift) scale)`.
#[allow(clippy::needless_range_loop)] // indices, as a vector has them
fn fill_run(polynomial: &[f64], (x, dx, shift, scale): (f64, f64, f64, f64), run: &mut [f64]) {
    for (block, out) in run.chunks_mut(LANES).enumerate() {
        let start = x + (block * LANES) as f64 * dx;
        let (mut at, mut sum) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let x = start + OFFSETS[i] * dx;
            at[i] = (x * x + shift) * scale;
        }
        for c in polynomial.iter().rev() {
            for i in 0..LANES {
                sum[i] = sum[i] * at[i] + c;
            }
        }
        out.copy_from_slice(&sum[..out.len()]);
    }
}

/// The panel that contains w >= 4, and its ends. The exponent and the first two bits of the mantissa of w are its number.
pub(super) fn panel_of(w: f64) -> (usize, (f64, f64)) {
    let panel = (w.to_bits() >> 50) as usize - FIRST_PANEL;
    (panel, ends_of(panel))
}

/// The exponent and the first two bits of the mantissa of 4.
const FIRST_PANEL: usize = (4f64.to_bits() >> 50) as usize;

/// The values of w at the ends of a panel.
pub(super) fn ends_of(panel: usize) -> (f64, f64) {
    let end = |panel: usize| f64::from_bits(((panel + FIRST_PANEL) as u64) << 50);
    (end(panel), end(panel + 1))
}
