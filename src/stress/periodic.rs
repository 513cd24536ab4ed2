//! Kernels of a load that repeats itself in both directions.
//!
//! *Below an element's side* the spectrum: a wave `(kx, ky)`, `k = |(kx, ky)|`, of the load fades with the depth as `E = exp(-k z)`, so that
//! few aliases of the waves of the grid are left. With `h = 1 - 2 nu`, per unit wave of pressure and of traction in x:
//!
//! ```text
//!       pressure                                   traction in x
//! xx    -(2 nu + h kx^2/k^2 - z kx^2/k) E          i kx/k (2 (1 + nu) - 2 nu kx^2/k^2 - z kx^2/k) E
//! yy    -(2 nu + h ky^2/k^2 - z ky^2/k) E          i kx/k (2 nu - 2 nu ky^2/k^2 - z ky^2/k) E
//! zz    -(1 + k z) E                               i kx z E
//! xy    -kx ky/k^2 (h - k z) E                     i ky/k (1 - 2 nu kx^2/k^2 - z kx^2/k) E
//! xz    i kx z E                                   -(1 - z kx^2/k) E
//! yz    i ky z E                                   z kx ky/k E
//! ```
//!
//! each times `sinc(kx dx/2) sinc(ky dy/2)`. The mean of the load, k = 0, gives `szz = -p`, `sxz = -qx`, `syz = -qy`, and
//! `sxx = syy = -nu/(1 - nu) p`: a half-space whose mean does not stretch sideways.
//!
//! *Nearer the surface* too many aliases would be left. There the kernel is carried on from depths `z_j = 1, 2, ..., 10` sides by a
//! polynomial in z, and what that misses is summed over images in space:
//!
//! ```text
//! K(z) = sum over j of w_j K(z_j)  +  sum over images of [k(z) - sum over j of w_j k(z_j)],    w_j Lagrange's weights at z
//! ```
//!
//! The bracket is a tenth difference of a function of z/r: it falls off as `10!/r^12`, and is gone at [`REACH`] sides.

use std::f64::consts::PI;

use super::kernels::{is_odd, Asked, Kernels};
use super::{Body, Loaded};
use crate::error::{Error, Result};
use crate::memory::zeros;

/// Depths that a kernel is carried on from.
const NODES: usize = 10;
/// Beyond this distance, in longer sides, images differ from the polynomial by `10!/10/r^10 = 1e-14`.
const REACH: f64 = 90.0;
/// `exp(-40) = 4e-18`: waves that have faded.
const FADED: f64 = 40.0;
/// Of a bin, at depths of at least an element's longer side: `2 FADED/(2 pi) + 1`.
const MOST_ALIASES: usize = 14;
/// Elements more slender than this have too many images within reach.
const MOST_SLENDER: f64 = 64.0;

/// Kernels of one depth on a grid that is one period.
pub struct Waves {
    asked: Asked,
    /// Of each kernel asked for, `[bin in x][bin in y]`, both >= 0: what is real of its spectrum.
    spectrum: Vec<f64>,
    bins: (usize, usize),
    /// Of each bin in y.
    in_y: Vec<Aliases>,
    /// Near the surface: kernels of single elements, and the sum over images at offsets up to half the period. Set up when needed.
    images: Option<Images>,
}

struct Images {
    kernels: Kernels,
    reach: (usize, usize),
    /// Of each kernel, `[ky][kx]`.
    folded: Vec<f64>,
}

impl Waves {
    /// Memory for the kernels asked for, where `asked.offsets` are those up to half the period; `near`: of depths near the surface, too.
    pub fn new(body: &Body, asked: Asked, near: bool) -> Result<Waves> {
        let grid = &body.grid;
        let bins = (grid.mx / 2 + 1, grid.my / 2 + 1);
        let what = "the waves of a depth";
        let images = match near {
            false => None,
            true => {
                let (dx, dy) = body.element();
                let reach = ((REACH / dx) as usize + 2, (REACH / dy) as usize + 2);
                let kernels = Kernels::new(Asked { offsets: reach, ..asked })?;
                let (x, y) = asked.offsets;
                Some(Images { kernels, reach, folded: zeros(asked.count() * x * y, what)? })
            }
        };
        let spectrum = zeros(asked.count() * bins.0 * bins.1, what)?;
        Ok(Waves { asked, spectrum, bins, in_y: zeros(bins.1, what)?, images })
    }

    /// Whether a depth, in longer sides of an element, is near the surface.
    pub fn is_near(z: f64) -> bool {
        z < 1.0
    }

    /// Refuses what has too many images.
    pub fn check(body: &Body, depth: f64) -> Result<()> {
        let (dx, dy) = body.element();
        if Waves::is_near(body.in_units(depth)) && dx.min(dy) < 1.0 / MOST_SLENDER {
            return Err(Error::Unsupported(format!(
                "a depth is {depth} and elements are {} x {}: with a period, depths of less than the longer side need elements less \
                 slender than 1:{MOST_SLENDER}",
                body.grid.dx, body.grid.dy
            )));
        }
        Ok(())
    }

    /// Computes all at depth z, in longer sides.
    pub fn compute(&mut self, body: &Body, z: f64) {
        self.spectrum.fill(0.0);
        if !Waves::is_near(z) {
            return self.add_waves(body, z, 1.0);
        }
        let node = |j: usize| j as f64 + 1.0;
        let weight = |j: usize| {
            let others = (0..NODES).filter(|&i| i != j);
            others.map(|i| (z - node(i)) / (node(j) - node(i))).product::<f64>()
        };
        if let Some(images) = &mut self.images {
            images.folded.fill(0.0);
            images.add(body, &self.asked, z, 1.0);
            (0..NODES).for_each(|j| images.add(body, &self.asked, node(j), -weight(j)));
        }
        (0..NODES).for_each(|j| self.add_waves(body, node(j), weight(j)));
    }

    /// What is real of a spectrum, `[bin in x][bin in y]`, and the sum over images in space if there is one, `[ky][kx]`.
    pub fn kernel(&self, load: usize, component: usize) -> Option<(&[f64], Option<&[f64]>)> {
        let k = self.asked.list().position(|of| of == (load, component))?;
        let part = |n: usize| k * n..(k + 1) * n;
        let (x, y) = self.asked.offsets;
        let folded = self.images.as_ref().map(|images| &images.folded[part(x * y)]);
        Some((&self.spectrum[part(self.bins.0 * self.bins.1)], folded))
    }

    /// Adds the waves of depth z >= 1, times a factor: those that have not faded.
    fn add_waves(&mut self, body: &Body, z: f64, factor: f64) {
        let (dx, dy) = body.element();
        let (rows, n) = (self.bins.1, self.bins.0 * self.bins.1);
        let most = FADED / z;
        for (j, aliases) in self.in_y.iter_mut().enumerate() {
            aliases.fill(j, body.grid.my, dy, most);
        }
        let mut in_x = Aliases::default();
        for i in 0..self.bins.0 {
            in_x.fill(i, body.grid.mx, dx, most);
            for (j, in_y) in self.in_y.iter().enumerate() {
                let mut sum = [[0.0; 6]; 3];
                for (kx, mean_x) in in_x.list() {
                    for (ky, mean_y) in in_y.list() {
                        let k2 = kx * kx + ky * ky;
                        if k2 <= most * most {
                            let wave = (*kx, *ky, k2.sqrt());
                            add_wave(body.poisson_ratio, self.asked.loaded, wave, z, mean_x * mean_y, &mut sum);
                        }
                    }
                }
                let spectra = self.spectrum[i * rows + j..].iter_mut().step_by(n);
                spectra.zip(self.asked.list()).for_each(|(value, (load, c))| *value += factor * sum[load][c]);
            }
        }
    }
}

/// The wave numbers of a bin and of its aliases, and what an element makes of them.
#[derive(Clone, Copy, Default)]
struct Aliases {
    count: usize,
    waves: [(f64, f64); MOST_ALIASES],
}

impl Aliases {
    /// Of bin i of m, up to `most` of either sign.
    fn fill(&mut self, i: usize, m: usize, d: f64, most: f64) {
        let (place, period) = (i as f64 / m as f64, 2.0 * PI / d);
        let (first, last) = ((-most / period - place).ceil(), (most / period - place).floor());
        self.count = 0;
        for (alias, wave) in (first as i64..=last as i64).zip(&mut self.waves) {
            let k = period * (place + alias as f64);
            *wave = (k, sinc(0.5 * k * d));
            self.count += 1;
        }
    }

    fn list(&self) -> &[(f64, f64)] {
        &self.waves[..self.count]
    }
}

impl Images {
    /// Adds the sums over images of depth z, times a factor.
    fn add(&mut self, body: &Body, asked: &Asked, z: f64, factor: f64) {
        self.kernels.compute(body, z);
        let ((x, y), (reach_x, reach_y)) = (asked.offsets, self.reach);
        for (k, (load, c)) in asked.list().enumerate() {
            let Some(table) = self.kernels.table(load, c) else { continue };
            let (odd_x, odd_y) = is_odd(load, c);
            let out = &mut self.folded[k * x * y..(k + 1) * x * y];
            for (ky, out) in out.chunks_exact_mut(x).enumerate() {
                for (place_y, sign_y) in images(ky, body.grid.my, reach_y, odd_y) {
                    let table = &table[place_y * reach_x..(place_y + 1) * reach_x];
                    for (kx, value) in out.iter_mut().enumerate() {
                        let line = images(kx, body.grid.mx, reach_x, odd_x);
                        let sum: f64 = line.map(|(place_x, sign_x)| sign_x * table[place_x]).sum();
                        *value += factor * sign_y * sum;
                    }
                }
            }
        }
    }
}

/// Offsets `|k + n m| < reach` of all images, and the sign of a kernel there.
fn images(k: usize, m: usize, reach: usize, odd: bool) -> impl Iterator<Item = (usize, f64)> {
    let above = (k..reach).step_by(m).map(|place| (place, 1.0));
    // k <= m/2 < m.
    let below = (m - k..reach).step_by(m).map(move |place| (place, if odd { -1.0 } else { 1.0 }));
    above.chain(below)
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 {
        1.0
    } else {
        x.sin() / x
    }
}

/// Adds one wave: the spectra above without their factors i, two of which make -1.
fn add_wave(nu: f64, loaded: Loaded, (kx, ky, k): (f64, f64, f64), z: f64, load: f64, sum: &mut [[f64; 6]; 3]) {
    if k == 0.0 {
        let sideways = -nu / (1.0 - nu) * load;
        (sum[0][0], sum[0][1]) = (sum[0][0] + sideways, sum[0][1] + sideways);
        sum[0][2] -= load;
        sum[1][4] -= load;
        sum[2][5] -= load;
        return;
    }
    let (l, m, kz, e) = (kx / k, ky / k, k * z, load * (-k * z).exp());
    let h = 1.0 - 2.0 * nu;
    let mut add = |load: usize, of_load: [f64; 6]| {
        sum[load].iter_mut().zip(of_load).for_each(|(sum, value)| *sum += e * value);
    };
    if loaded[0] {
        let xx = -(2.0 * nu + (h - kz) * l * l);
        let yy = -(2.0 * nu + (h - kz) * m * m);
        add(0, [xx, yy, -(1.0 + kz), l * m * (h - kz), l * kz, m * kz]);
    }
    // Along the traction and across it.
    let of_traction = |l: f64, m: f64| {
        [
            l * (2.0 * (1.0 + nu) - (2.0 * nu + kz) * l * l),
            l * (2.0 * nu - (2.0 * nu + kz) * m * m),
            l * kz,
            m * (1.0 - (2.0 * nu + kz) * l * l),
            -(1.0 - kz * l * l),
            -kz * l * m,
        ]
    };
    if loaded[1] {
        add(1, of_traction(l, m));
    }
    if loaded[2] {
        let [yy, xx, zz, xy, yz, xz] = of_traction(m, l);
        add(2, [xx, yy, zz, xy, xz, yz]);
    }
}
