//! Coefficients of bodies with a coating: a bonded elastic layer of thickness t on a half-space.
//!
//! ```text
//! A(X, Y) = sum over bodies of c_b [b L(X, Y) + (1/t) integral over the element of F_b(r/t) dA],   c_b = (1 - nu1)/(2 pi G1)
//! ```
//!
//! with L the integral of 1/r ([`HalfSpace`]), and a radial correction F_b ([`Radial`]) to a half-space of the layer's material, b = 1, at
//! distances below t, to one of the substrate's, b = B0, beyond. With one of them alone, either digits are lost or a singularity is left
//! under the integral. A body without a coating has b = 1 and no correction.
//!
//! The integral over an element, by the larger of its distance and t, in longer sides of an element:
//!
//! * beyond [`FAR`] from the values at the centres of the element and its neighbours (see [`means`](super::means)): one evaluation per element;
//! * before, by tensor Gauss, or up to [`CORNERS`] diagonals by corner differences of `S(x, y) = integral from 0 to x and 0 to y of F`,
//!
//! ```text
//! S(x, y) = t^2 (T(x, y) + T(y, x)),    T(a, b) = integral from 0 to asinh(b/a) of M(a cosh(u)/t)/cosh(u) du
//! ```
//!
//! which is smooth for any ratio of element and thickness.

mod periodic;
mod quadrature;
mod radial;
mod transfer;

use std::f64::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

pub use periodic::CoatedPeriodic;
pub use radial::{Base, Radial};
pub use transfer::Transfer;

use super::{means, HalfSpace, Kernel};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;
use quadrature::gauss_legendre;

/// Beyond this the stencil serves.
const FAR: f64 = 32.0;
/// Diagonals of an element up to which corner differences serve.
const CORNERS: f64 = 2.5;
/// Points a side of tensor Gauss, below these distances.
const POINTS: [(f64, usize); 2] = [(12.0, 9), (FAR, 5)];
/// What memory is for.
const COATED: &str = "the coefficients of a coating";

/// One body: its coating, or none.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedBody {
    /// `(1 - nu)/(2 pi G)` of what is at the surface.
    pub compliance: f64,
    /// Thickness, and radial functions.
    pub layer: Option<(f64, Arc<Radial>)>,
}

/// A layer's materials: G1/G2 and both Poisson ratios.
type Materials = [f64; 3];

/// Tables that were made, the latest last: scenes of the same materials share them.
static KNOWN: Mutex<Vec<(Materials, Arc<Radial>)>> = Mutex::new(Vec::new());
/// Tables that are kept: some 20 kB each.
const MOST_KNOWN: usize = 16;

/// The radial functions of a layer of `mu` times the substrate's shear modulus: made once for each pair of materials.
pub fn radial(mu: f64, [nu1, nu2]: [f64; 2]) -> Arc<Radial> {
    let materials = [mu, nu1, nu2];
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, radial)) = known().iter().find(|(of, _)| *of == materials) {
        return radial.clone();
    }
    let radial = Arc::new(Radial::new(Transfer::new(mu, [nu1, nu2])));
    let mut known = known();
    if known.len() == MOST_KNOWN {
        known.remove(0);
    }
    known.push((materials, radial.clone()));
    radial
}

/// Coefficients of two bodies of which one or both have a coating, on one grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Coated {
    bodies: [CoatedBody; 2],
    half_space: HalfSpace,
    mx: usize,
    /// `[ky][kx]`, offsets >= 0.
    table: Arc<Vec<f64>>,
}

impl Coated {
    /// The coefficients of a grid.
    pub fn new(bodies: [CoatedBody; 2], grid: &Grid) -> Result<Coated> {
        // A compliance of 1/pi E* = 1: the integral of 1/r.
        Coated::with_half_space(bodies, HalfSpace::new(grid.dx, grid.dy, PI), grid)
    }

    fn with_half_space(bodies: [CoatedBody; 2], half_space: HalfSpace, grid: &Grid) -> Result<Coated> {
        let mut table = zeros(grid.len(), COATED)?;
        for (ky, row) in table.chunks_exact_mut(grid.mx).enumerate() {
            half_space.fill_row(0, ky as i64, row);
            let [one, two] = bodies.each_ref().map(|body| body.first_of_substrate(grid, ky));
            // Each body changes its base where its thickness is reached.
            let ends = [0, one.min(two), one.max(two), row.len()];
            for ends in ends.windows(2) {
                let factor: f64 =
                    bodies.iter().map(|body| body.base(ends[0] >= body.first_of_substrate(grid, ky))).sum();
                row[ends[0]..ends[1]].iter_mut().for_each(|value| *value *= factor);
            }
        }
        for body in &bodies {
            if let Some((thickness, radial)) = &body.layer {
                let layer = Layer { radial, t: *thickness, grid: *grid, half_space: &half_space };
                layer.add(body.compliance, &mut table)?;
            }
        }
        Ok(Coated { bodies, half_space, mx: grid.mx, table: Arc::new(table) })
    }
}

/// The first offset in a row whose distance is not below this, or the row's end.
fn first_beyond(distance: f64, grid: &Grid, ky: usize) -> usize {
    let y = ky as f64 * grid.dy;
    if y >= distance {
        return 0;
    }
    let x = ((distance - y) * (distance + y)).sqrt();
    ((x / grid.dx).ceil() as usize).min(grid.mx)
}

impl CoatedBody {
    /// c B(k t), to three digits.
    fn roughly(&self, k: f64) -> f64 {
        self.layer.as_ref().map_or(self.compliance, |(t, radial)| self.compliance * radial.roughly(k * t))
    }

    /// c b, near or far.
    fn base(&self, of_substrate: bool) -> f64 {
        match &self.layer {
            Some((_, radial)) if of_substrate => self.compliance * radial.transfer.substrate,
            _ => self.compliance,
        }
    }

    /// The first offset in a row whose distance is not below the thickness, or the row's end.
    fn first_of_substrate(&self, grid: &Grid, ky: usize) -> usize {
        self.layer.as_ref().map_or(grid.mx, |(t, _)| first_beyond(*t, grid, ky))
    }

    /// `u/p` of a wave: `2 pi c/k B(k t)`.
    pub fn of_wave(&self, k: f64) -> f64 {
        let layer = self.layer.as_ref().map_or(1.0, |(t, radial)| radial.transfer.at(k * t));
        2.0 * PI * self.compliance / k * layer
    }
}

impl Kernel for Coated {
    fn at(&self, kx: i64, ky: i64) -> f64 {
        let (x, y) = (kx.unsigned_abs() as usize, ky.unsigned_abs() as usize);
        match x < self.mx && y < self.table.len() / self.mx {
            true => self.table[y * self.mx + x],
            // Beyond the grid.
            false => self.beyond(x, y),
        }
    }

    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        let (x, y, n) = (kx as usize, ky.unsigned_abs() as usize, out.len());
        if kx >= 0 && x + n <= self.mx && y < self.table.len() / self.mx {
            return out.copy_from_slice(&self.table[y * self.mx + x..][..n]);
        }
        out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = self.at(kx, ky));
    }

    // The aliases that matter: k and k - 2 pi/d in each direction. Of all of them sin(k d/2) is the same, but for its sign.
    fn wave(&self, grid: &Grid, kx: f64, ky: f64) -> Option<f64> {
        let aliases = |k: f64, d: f64| {
            let half = 0.5 * k * d;
            let sine = half.sin();
            let mean = if half == 0.0 { 1.0 } else { sine / half };
            [(k, mean), (k - 2.0 * PI / d, -sine / (half - PI))]
        };
        let mut sum = 0.0;
        let in_y = aliases(ky, grid.dy);
        for (kx, mean_x) in aliases(kx, grid.dx) {
            for (ky, mean_y) in in_y {
                let k = (kx * kx + ky * ky).sqrt();
                sum += mean_x * mean_y / k * self.bodies.iter().map(|body| body.roughly(k)).sum::<f64>();
            }
        }
        Some(2.0 * PI * sum)
    }

    fn coarsen(&self, _fine: &Grid, coarse: &Grid) -> Result<Arc<dyn Kernel>> {
        let half_space = self.half_space.for_element(coarse.dx, coarse.dy);
        Ok(Arc::new(Coated::with_half_space(self.bodies.clone(), half_space, coarse)?))
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.table[..])
    }
}

impl Coated {
    /// A coefficient that is not in the table.
    fn beyond(&self, kx: usize, ky: usize) -> f64 {
        let (dx, dy) = (self.half_space.dx, self.half_space.dy);
        let (x, y) = (kx as f64 * dx, ky as f64 * dy);
        let grid = Grid { mx: kx + 1, my: ky + 1, dx, dy };
        let is_far = |body: &CoatedBody| kx >= body.first_of_substrate(&grid, ky);
        let base: f64 = self.bodies.iter().map(|body| body.base(is_far(body))).sum();
        let mut sum = self.half_space.at(kx as i64, ky as i64) * base;
        for body in &self.bodies {
            if let Some((t, radial)) = &body.layer {
                let layer = Layer { radial, t: *t, grid, half_space: &self.half_space };
                let base = if is_far(body) { Base::Substrate } else { Base::Layer };
                sum += body.compliance * layer.gauss(&gauss_legendre(5), (x, y), base);
            }
        }
        sum
    }
}

/// The correction of one layer on a grid.
struct Layer<'a> {
    radial: &'a Radial,
    t: f64,
    grid: Grid,
    /// The integral of 1/r.
    half_space: &'a HalfSpace,
}

impl Layer<'_> {
    /// Adds `(c/t) integral of F`, with the base that suits each offset.
    fn add(&self, c: f64, table: &mut [f64]) -> Result<()> {
        let Grid { mx, my, dx, dy } = self.grid;
        let far = FAR * dx.max(dy);
        let scale = c * dx * dy / self.t;
        let fill = |base: Base| {
            move |ky: usize, row: &mut [f64]| {
                let y = ky as f64 * dy / self.t;
                let skipped = usize::from(ky == 0 && base == Base::Substrate);
                // No mean is asked for near 0.
                row[..skipped].fill(0.0);
                self.radial.fill_f((skipped as f64 * dx / self.t, dx / self.t, y), base, &mut row[skipped..]);
            }
        };
        let mut add_row = |ky: usize, means: &[f64], from: usize, to: usize| {
            let row = table[ky * mx..(ky + 1) * mx].iter_mut().zip(means);
            row.take(to).skip(from).for_each(|(value, mean)| *value += scale * mean);
        };
        let last = ((mx - 1) as f64 * dx).hypot((my - 1) as f64 * dy);
        if self.t >= far {
            // Offsets nearer than t lie in this box.
            let count = |d: f64, m: usize| ((self.t / d) as usize).saturating_add(1).min(m);
            means::means((count(dx, mx), count(dy, my)), fill(Base::Layer), |ky, means| {
                add_row(ky, means, 0, first_beyond(self.t, &self.grid, ky));
            })?;
        }
        if last >= self.t {
            means::means((mx, my), fill(Base::Substrate), |ky, means| {
                add_row(ky, means, first_beyond(self.t.max(far), &self.grid, ky), mx);
            })?;
        }
        if self.t < far {
            self.add_near(c, table)?;
        }
        Ok(())
    }

    /// The offsets that are not far.
    fn add_near(&self, c: f64, table: &mut [f64]) -> Result<()> {
        let Grid { mx, my, dx, dy } = self.grid;
        let h = dx.max(dy);
        let count = |d: f64, distance: f64, m: usize| ((distance / d) as usize).saturating_add(2).min(m);
        let by_corners = CORNERS * dx.hypot(dy);
        let base = if h < self.t { Base::Layer } else { Base::Substrate };
        let corners = Corners::new(self, base, (count(dx, by_corners, mx), count(dy, by_corners, my)))?;
        let rules = POINTS.map(|(_, n)| gauss_legendre(n));
        for ky in 0..count(dy, FAR * h, my) {
            let first_of_substrate = first_beyond(self.t, &self.grid, ky);
            for kx in 0..first_beyond(FAR * h, &self.grid, ky) {
                let (x, y) = (kx as f64 * dx, ky as f64 * dy);
                let r = x.hypot(y);
                let here = if kx >= first_of_substrate { Base::Substrate } else { Base::Layer };
                let value = &mut table[ky * mx + kx];
                if r > by_corners {
                    let rule = &rules[usize::from(r.max(self.t) > POINTS[0].0 * h)];
                    *value += c * self.gauss(rule, (x, y), here);
                    continue;
                }
                // The half-space has the base that is usual here.
                let less = 1.0 - self.radial.transfer.substrate;
                let other = match (base, here) {
                    (Base::Layer, Base::Substrate) => less,
                    (Base::Substrate, Base::Layer) => -less,
                    _ => 0.0,
                };
                let half_space = if other == 0.0 { 0.0 } else { other * self.half_space.at(kx as i64, ky as i64) };
                *value += c * (corners.difference(kx, ky) + half_space);
            }
        }
        Ok(())
    }

    /// `(1/t) integral of F` by tensor Gauss.
    fn gauss(&self, rule: &[(f64, f64)], (x, y): (f64, f64), base: Base) -> f64 {
        let Grid { dx, dy, .. } = self.grid;
        let mut sum = 0.0;
        for (sx, wx) in rule {
            for (sy, wy) in rule {
                let r = (x + (sx - 0.5) * dx).hypot(y + (sy - 0.5) * dy);
                sum += wx * wy * self.radial.f(r / self.t, base);
            }
        }
        sum * dx * dy / self.t
    }
}

/// S/t at the corners of the elements next to the loaded one.
struct Corners {
    columns: usize,
    values: Vec<f64>,
}

impl Corners {
    fn new(layer: &Layer<'_>, base: Base, (columns, rows): (usize, usize)) -> Result<Corners> {
        let rule = gauss_legendre(40);
        let (dx, dy) = (layer.grid.dx / layer.t, layer.grid.dy / layer.t);
        let side = |a: f64, b: f64| {
            let end = (b / a).asinh();
            let at = |(u, w): &(f64, f64)| {
                let cosh = (end * u).cosh();
                w * layer.radial.m(a * cosh, base) / cosh
            };
            end * rule.iter().map(at).sum::<f64>()
        };
        let mut values = zeros((columns + 1) * (rows + 1), COATED)?;
        for (i, value) in values.iter_mut().enumerate() {
            // Corners at half-integer offsets, from 1/2 on; those at -1/2 are their opposites.
            let (x, y) = ((i % (columns + 1)) as f64 + 0.5, (i / (columns + 1)) as f64 + 0.5);
            *value = layer.t * (side(x * dx, y * dy) + side(y * dy, x * dx));
        }
        Ok(Corners { columns: columns + 1, values })
    }

    /// The integral over the element at an offset.
    fn difference(&self, kx: usize, ky: usize) -> f64 {
        let corner = |kx: i64, ky: i64| {
            let place = |k: i64| if k < 0 { (0, -1.0) } else { (k as usize, 1.0) };
            let ((x, sx), (y, sy)) = (place(kx), place(ky));
            sx * sy * self.values[y * self.columns + x]
        };
        let (kx, ky) = (kx as i64, ky as i64);
        corner(kx, ky) - corner(kx - 1, ky) - corner(kx, ky - 1) + corner(kx - 1, ky - 1)
    }
}
