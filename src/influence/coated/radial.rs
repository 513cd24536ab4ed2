//! What a layer adds to the half-space, by the distance: the radial functions of one pair of materials.
//!
//! ```text
//! F_b(rho) = integral from 0 to infinity of (B(s) - b) J0(s rho) ds,    M_b(rho) = integral from 0 to rho of F_b rho' drho'
//! F_B0(rho) = F_1(rho) + (1 - B0)/rho
//! ```
//!
//! with b = 1, the layer's own half-space, or b = B0 = B(0), the substrate's. F_1 is smooth at 0; F_B0 falls off as `1/rho^3`. Of both,
//! all singularities lie at `w = 4 + rho^2 <= 0`. So on `[2^k, 1.5 2^k]` and `[1.5 2^k, 2^(k+1)]` of w polynomials of degree 17 have
//! `(5 + sqrt 24)^-18 = 1e-18`, of a function that is `w^-5/2` near 0; which one is in the bits of w, and M is an integral of it, `rho drho = dw/2`. Below rho = 2 they are those of
//! F_1, beyond of F_B0.
//!
//! The values come from coarser panels, in `v = asinh(rho/2)`: near 0 by Gauss-Legendre in s, beyond by Ogata's rule. At
//! `rho > 100 L`, with L the distance of the nearest pole of B, 1/s say, the Taylor coefficients of B serve:
//!
//! ```text
//! F_B0 = -B2/rho^3 + 9 B4/rho^5 - 225 B6/rho^7 + 11025 B8/rho^9 - 893025 B10/rho^11
//! M_B0 = B1 + B2/rho - 3 B4/rho^3 + 45 B6/rho^5 - 1575 B8/rho^7 + 99225 B10/rho^9
//! ```
//!
//! L is about `1.75 mu` for stiff layers: the length over which they spread a load as membranes.

use super::quadrature::{gauss_legendre, hankel_rule};
use super::transfer::{Transfer, TERMS};

/// Coefficients of a polynomial in w, of degree 17, and nodes of a panel in v.
const P: usize = 18;
const N: usize = 16;
/// Panels in v are at most that wide: singularities at `Im v = pi/2` are six half-widths away.
const PANEL: f64 = 0.5;
/// B - 1 is below 1e-16 from there on, for layers up to 1e4 times stiffer: `4 s^2 exp(-2 s)`.
const S_MAX: f64 = 22.0;
/// w at rho = 2.
const SMOOTH: f64 = 8.0;

/// The base b of a radial function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// b = 1: the half-space of the layer's material.
    Layer,
    /// b = B(0): the half-space of the substrate.
    Substrate,
}

/// The radial functions of a layer of unit thickness.
#[derive(Clone, Debug, PartialEq)]
pub struct Radial {
    /// B.
    pub transfer: Transfer,
    taylor: [f64; TERMS],
    /// Polynomials in [-1, 1] of F and of M, of the panels of w from 4 on.
    panels: Vec<([f64; P], [f64; P + 1])>,
    /// Where they end.
    far: f64,
    /// B at [`FIRST`] and on, eight values an octave.
    roughly: Vec<f64>,
}

/// Where the rough values of B begin and how many octaves they take.
const FIRST: f64 = 1.0 / (1u64 << 32) as f64;
const OCTAVES: usize = 38;

impl Radial {
    /// The table of a layer: takes milliseconds.
    pub fn new(transfer: Transfer) -> Radial {
        let taylor = transfer.taylor();
        let scale = transfer.substrate.max(1.0);
        let pole = (6..TERMS).map(|k| (taylor[k].abs() / scale).powf(1.0 / k as f64)).fold(0.5, f64::max);
        let coarse = Coarse::new(&transfer, pole);
        let far2 = (100.0 * pole).powi(2) + 4.0;
        let (mut panels, mut low) = (Vec::new(), 4.0);
        let less = 1.0 - transfer.substrate;
        // M at the lower end: M_1, and from rho = 2 on M_B0.
        let mut before = 0.0;
        while low < far2 {
            for (low, high) in [(low, 1.5 * low), (1.5 * low, 2.0 * low)] {
                let f = polynomial(|x| {
                    let rho = (0.5 * (low + high) + 0.5 * (high - low) * x - 4.0).max(0.0).sqrt();
                    if high <= SMOOTH {
                        coarse.layer(rho)
                    } else {
                        coarse.substrate(rho)
                    }
                });
                if low == SMOOTH {
                    before += 2.0 * less;
                }
                let m = integral(&f, 0.25 * (high - low), before);
                before = evaluate(&m, 1.0);
                panels.push((f, m));
            }
            low *= 2.0;
        }
        let roughly =
            (0..=8 * OCTAVES).map(|k| transfer.at(FIRST * (1u64 << (k / 8)) as f64 * (1.0 + (k % 8) as f64 / 8.0)));
        Radial { transfer, taylor, panels, far: low, roughly: roughly.collect() }
    }

    /// B(s) to three digits, for preconditioners: linear between places an eighth of an octave apart.
    pub fn roughly(&self, s: f64) -> f64 {
        let eighths = (s / FIRST).to_bits() >> 49;
        let first = 1023 << 3;
        if eighths < first {
            return self.transfer.substrate;
        }
        let k = (eighths - first) as usize;
        let Some([low, high]) = self.roughly.get(k..k + 2) else { return 1.0 };
        let place = f64::from_bits(eighths << 49) * FIRST;
        let width = f64::from_bits((eighths + 1) << 49) * FIRST - place;
        low + (high - low) * (s - place) / width
    }

    /// F at a distance rho in thicknesses; for the substrate as base rho > 0.
    pub fn f(&self, rho: f64, base: Base) -> f64 {
        let w = 4.0 + rho * rho;
        let (value, of) = if w < self.far {
            let (panel, (low, high)) = panel_of(w);
            let x = (w - 0.5 * (low + high)) * (2.0 / (high - low));
            (evaluate(&self.panels[panel].0, x), if w < SMOOTH { Base::Layer } else { Base::Substrate })
        } else {
            (self.far_f(rho), Base::Substrate)
        };
        match (of, base) {
            (Base::Layer, Base::Substrate) => value + (1.0 - self.transfer.substrate) / rho,
            (Base::Substrate, Base::Layer) => value - (1.0 - self.transfer.substrate) / rho,
            _ => value,
        }
    }

    /// `out[k]` is F at distance `sqrt((x + k dx)^2 + y^2)`, all in thicknesses, x and y >= 0: a run of places at a time that have
    /// their polynomial in common.
    pub fn fill_f(&self, (x, dx, y): (f64, f64, f64), base: Base, out: &mut [f64]) {
        let w = |k: usize| {
            let x = x + k as f64 * dx;
            4.0 + (x * x + y * y)
        };
        let less = 1.0 - self.transfer.substrate;
        let mut first = 0;
        while first < out.len() {
            let start = w(first);
            if start >= self.far {
                for (k, value) in out.iter_mut().enumerate().skip(first) {
                    let rho = (w(k) - 4.0).sqrt();
                    *value = self.far_f(rho) - if base == Base::Layer { less / rho } else { 0.0 };
                }
                return;
            }
            let (panel, (low, high)) = panel_of(start);
            // The first place beyond the panel, to within rounding: its polynomial holds there, too.
            let beyond = ((high - 4.0 - y * y).max(0.0).sqrt() - x) / dx;
            let end = if beyond < out.len() as f64 { (beyond as usize).max(first) + 1 } else { out.len() };
            let (polynomial, middle, scale) = (&self.panels[panel].0, 0.5 * (low + high), 2.0 / (high - low));
            let end = end.min(out.len());
            let run = &mut out[first..end];
            fill_run(polynomial, (x + first as f64 * dx, dx, 4.0 + y * y - middle, scale), run);
            let change = match (start < SMOOTH, base) {
                (true, Base::Substrate) => less,
                (false, Base::Layer) => -less,
                _ => 0.0,
            };
            if change != 0.0 {
                run.iter_mut().enumerate().for_each(|(k, value)| *value += change / (w(first + k) - 4.0).sqrt());
            }
            first += run.len();
        }
    }

    /// M at a distance rho in thicknesses.
    pub fn m(&self, rho: f64, base: Base) -> f64 {
        let w = 4.0 + rho * rho;
        let (value, of) = if w < self.far {
            let (panel, (low, high)) = panel_of(w);
            let x = (w - 0.5 * (low + high)) * (2.0 / (high - low));
            (evaluate(&self.panels[panel].1, x), if w < SMOOTH { Base::Layer } else { Base::Substrate })
        } else {
            (self.far_m(rho), Base::Substrate)
        };
        match (of, base) {
            (Base::Layer, Base::Substrate) => value + (1.0 - self.transfer.substrate) * rho,
            (Base::Substrate, Base::Layer) => value - (1.0 - self.transfer.substrate) * rho,
            _ => value,
        }
    }

    fn far_f(&self, rho: f64) -> f64 {
        let (b, q) = (&self.taylor, 1.0 / (rho * rho));
        let sum = -b[2] + q * (9.0 * b[4] + q * (-225.0 * b[6] + q * (11025.0 * b[8] - q * 893_025.0 * b[10])));
        sum * q / rho
    }

    fn far_m(&self, rho: f64) -> f64 {
        let (b, q) = (&self.taylor, 1.0 / (rho * rho));
        let sum = b[2] + q * (-3.0 * b[4] + q * (45.0 * b[6] + q * (-1575.0 * b[8] + q * 99225.0 * b[10])));
        b[1] + sum / rho
    }
}

/// Places that are computed at a time: a loop over them is vectorised.
const LANES: usize = 8;
const OFFSETS: [f64; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// `polynomial(((x + k dx)^2 + shift) scale)`.
#[allow(clippy::needless_range_loop)] // indices, as a vector has them
fn fill_run(polynomial: &[f64; P], (x, dx, shift, scale): (f64, f64, f64, f64), run: &mut [f64]) {
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

/// The panel of w >= 4, and its ends: exponent and first digit are its number.
fn panel_of(w: f64) -> (usize, (f64, f64)) {
    let half = w.to_bits() >> 51;
    let (low, high) = (f64::from_bits(half << 51), f64::from_bits((half + 1) << 51));
    (half as usize - ((1023 + 2) << 1), (low, high))
}

#[inline]
fn evaluate<const M: usize>(polynomial: &[f64; M], x: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The polynomial through the Chebyshev nodes of [-1, 1], as coefficients of powers.
fn polynomial(value: impl Fn(f64) -> f64) -> [f64; P] {
    let chebyshev: [f64; P] = chebyshev(value);
    // T_k by its recursion, added up.
    let (mut before, mut now) = ([0.0; P], [0.0; P]);
    (before[0], now[1]) = (1.0, 1.0);
    let mut sum = [0.0; P];
    sum[0] = chebyshev[0];
    for c in &chebyshev[1..] {
        for (sum, now) in sum.iter_mut().zip(now) {
            *sum += c * now;
        }
        let mut next = [0.0; P];
        for k in 0..P {
            next[k] = if k > 0 { 2.0 * now[k - 1] } else { 0.0 } - before[k];
        }
        (before, now) = (now, next);
    }
    sum
}

/// `start + factor * integral from -1 to x`.
fn integral(polynomial: &[f64; P], factor: f64, start: f64) -> [f64; P + 1] {
    let mut integral = [0.0; P + 1];
    for k in 0..P {
        integral[k + 1] = factor * polynomial[k] / (k + 1) as f64;
    }
    integral[0] = start - evaluate(&integral, -1.0);
    integral
}

fn chebyshev<const M: usize>(value: impl Fn(f64) -> f64) -> [f64; M] {
    let angle = |i: usize| std::f64::consts::PI * (i as f64 + 0.5) / M as f64;
    let values: [f64; M] = std::array::from_fn(|i| value(angle(i).cos()));
    std::array::from_fn(|k| {
        let sum: f64 = (0..M).map(|i| values[i] * (k as f64 * angle(i)).cos()).sum();
        sum * if k == 0 { 1.0 } else { 2.0 } / M as f64
    })
}

/// F on panels in v: Chebyshev coefficients of `F_1 sqrt(1 + rho^2/4)` where s-quadrature serves, and of `F_B0 rho`.
struct Coarse {
    width: f64,
    layer: Vec<[f64; N]>,
    substrate: Vec<[f64; N]>,
}

impl Coarse {
    fn new(transfer: &Transfer, pole: f64) -> Coarse {
        // To the end of the last panel of w.
        let v_max = (100.0 * pole).asinh() + PANEL;
        let count = (v_max / PANEL).ceil();
        let width = v_max / count;
        let near = 12.0 * f64::max(1.0, transfer.substrate.cbrt());
        let less = 1.0 - transfer.substrate;
        let mut coarse = Coarse { width, layer: Vec::new(), substrate: Vec::new() };
        for panel in 0..count as usize {
            let rho = |x: f64| 2.0 * ((panel as f64 + 0.5 + 0.5 * x) * width).sinh();
            let is_near = rho(-1.0) < near;
            let in_s = if is_near { near_rule(transfer, pole, rho(1.0)) } else { Vec::new() };
            let by_s = |rho: f64| in_s.iter().map(|(s, value)| value * libm::j0(s * rho)).sum::<f64>();
            let by_rule = |rho: f64| {
                hankel_rule(rho / pole)
                    .iter()
                    .map(|(x, w)| w * (transfer.at(x / rho) - transfer.substrate))
                    .sum::<f64>()
                    / rho
            };
            if is_near {
                let values = chebyshev(|x| by_s(rho(x)) * (1.0 + 0.25 * rho(x).powi(2)).sqrt());
                coarse.layer.push(values);
            }
            let f = |rho: f64| if is_near { by_s(rho) * rho + less } else { by_rule(rho) * rho };
            coarse.substrate.push(chebyshev(|x| f(rho(x))));
        }
        coarse
    }

    fn at(&self, panels: &[[f64; N]], rho: f64) -> f64 {
        let v = (0.5 * rho).asinh() / self.width;
        let panel = (v as usize).min(panels.len() - 1);
        let x = 2.0 * (v - panel as f64) - 1.0;
        // Clenshaw.
        let (mut one, mut two) = (0.0, 0.0);
        for c in panels[panel][1..].iter().rev() {
            (one, two) = (2.0 * x * one - two + c, one);
        }
        x * one - two + panels[panel][0]
    }

    /// F_1.
    fn layer(&self, rho: f64) -> f64 {
        self.at(&self.layer, rho) / (1.0 + 0.25 * rho * rho).sqrt()
    }

    /// F_B0.
    fn substrate(&self, rho: f64) -> f64 {
        self.at(&self.substrate, rho) / rho
    }
}

/// Nodes s, and weights times B - 1, for distances up to `rho_max`: composite 12-point Gauss-Legendre, finer towards 0.
fn near_rule(transfer: &Transfer, pole: f64, rho_max: f64) -> Vec<(f64, f64)> {
    let gauss = gauss_legendre(12);
    let width = f64::min(0.5, 10.0 / rho_max);
    let mut ends = vec![0.0, width];
    while ends[1] > 0.02 / pole {
        let half = 0.5 * ends[1];
        ends.insert(1, half);
    }
    while ends[ends.len() - 1] < S_MAX {
        ends.push(ends[ends.len() - 1] + width);
    }
    let panel = |ends: &[f64]| {
        let (low, length) = (ends[0], ends[1] - ends[0]);
        gauss.iter().map(move |(x, w)| (low + length * x, length * w)).collect::<Vec<_>>()
    };
    ends.windows(2).flat_map(panel).map(|(s, w)| (s, w * transfer.less_one(s))).collect()
}
