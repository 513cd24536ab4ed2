//! The kernels of loads that are periodic in both directions.
//!
//! *At depths of at least the longer side of an element* the kernel is a sum over waves. A wave `(kx, ky)`, `k = |(kx, ky)|`, of the load decays
//! with the depth as `E = exp(-k z)`, so that only few aliases of the grid's waves remain. With `h = 1 - 2 nu`, a unit wave of the pressure and
//! of the traction in x has the stresses
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
//! each times `sinc(kx dx/2) sinc(ky dy/2)`. The mean of the load, k = 0, has the stresses `szz = -p`, `sxz = -qx`, `syz = -qy`, and `sxx = syy =
//! -nu/(1 - nu) p`: the mean lateral strain is 0.
//!
//! *Nearer the surface* too many aliases would remain. There the kernel K is extrapolated from the depths `z_j = 1, 2, ..., 10` sides by a
//! polynomial in z. The error of this polynomial is a sum over images in space, with the kernel k of a single element:
//!
//! ```text
//! K(z) = sum over j of w_j K(z_j)  +  sum over images of [k(z) - sum over j of w_j k(z_j)],    w_j Lagrange's weights at z
//! ```
//!
//! The bracket is a tenth difference of a function of z/r. It decays as `10!/r^12`, and is negligible beyond [`REACH`] sides. Both sums over j
//! are evaluated first: the waves decay by `sum w_j exp(-k z_j)`, and one table of brackets is summed over the images.

use super::body::Body;
use super::kernels::{is_odd, Asked, Kernels};
use super::waves::{Aliased, Fading, NODES};
use crate::blocks::LANES;
use crate::error::{Error, Number, Result};
use crate::memory::zeros;

/// The distance, in longer sides, beyond which images are left out. The brackets there are `10!/10/r^10 = 1e-14`.
const REACH: f64 = 90.0;
/// The largest ratio of the sides of an element. More slender elements have too many images within reach.
pub const MOST_SLENDER: f64 = 64.0;

/// The kernels of one depth on a grid that is one period.
pub struct Waves {
    /// The kernels that are wanted.
    asked: Asked,
    /// The sums of waves over their aliases.
    aliased: Aliased,
    /// The spectra of all kernels, `[kernel][bin in x][bin in y]`, at bins >= 0. Imaginary spectra are stored without the factor i.
    spectrum: Vec<f64>,
    /// The numbers of bins in x and in y.
    bins: (usize, usize),
    /// The sums over images for depths near the surface. `None` if no depth is near the surface.
    images: Option<Images>,
}

/// The sums over images for depths near the surface.
struct Images {
    /// The brackets of a single element.
    brackets: Kernels,
    /// The number of offsets in x and in y at which brackets are computed.
    reach: (usize, usize),
    /// The sums over images, `[kernel][ky][kx]`, at offsets up to half the period.
    folded: Vec<f64>,
}

impl Waves {
    /// Allocates memory for the wanted kernels, with `asked.offsets` up to half the period. `near`: whether some depth is near the surface.
    pub fn new(body: &Body, asked: Asked, near: bool) -> Result<Waves> {
        let grid = &body.grid;
        let bins = (grid.mx / 2 + 1, grid.my / 2 + 1);
        let what = "the waves of a depth";
        let images = match near {
            false => None,
            true => {
                let (dx, dy) = body.element();
                let reach = ((REACH / dx) as usize + 2, (REACH / dy) as usize + 2);
                let brackets = Kernels::new(Asked { offsets: reach, ..asked })?;
                let (x, y) = asked.offsets;
                Some(Images { brackets, reach, folded: zeros(asked.count() * x * y, what)? })
            }
        };
        let spectrum = zeros(asked.count() * bins.0 * bins.1, what)?;
        Ok(Waves { asked, aliased: Aliased::new(body)?, spectrum, bins, images })
    }

    /// Whether a depth, in longer sides of an element, is near the surface.
    pub fn is_near(z: f64) -> bool {
        z < 1.0
    }

    /// Refuses a depth near the surface if the elements are so slender that too many images are within reach.
    pub fn check(body: &Body, depth: f64) -> Result<()> {
        let (dx, dy) = body.element();
        if Waves::is_near(body.in_units(depth)) && dx.min(dy) < 1.0 / MOST_SLENDER {
            return Err(Error::Unsupported(format!(
                "a depth is {} and elements are {} x {}: with a period, depths of less than the longer side need elements less slender than \
                 1:{MOST_SLENDER}",
                Number(depth),
                Number(body.grid.dx),
                Number(body.grid.dy)
            )));
        }
        Ok(())
    }

    /// Computes all kernels at the depth z, in longer sides.
    pub fn compute(&mut self, body: &Body, z: f64) {
        let fading = Fading::new(z);
        if let (Fading::Near(weights), Some(images)) = (&fading, &mut self.images) {
            let mut bracket = [(z, 1.0); NODES + 1];
            for (j, ((place, factor), weight)) in bracket[1..].iter_mut().zip(weights).enumerate() {
                (*place, *factor) = (j as f64 + 1.0, -weight);
            }
            images.compute(body, &self.asked, &bracket);
        }
        let Waves { asked, aliased, spectrum, bins: (columns, rows), .. } = self;
        let n = *columns * *rows;
        aliased.compute(body, asked.loaded, &fading, |i, first, values| {
            let lanes = LANES.min(*rows - first);
            for ((load, c), spectrum) in asked.list().zip(spectrum.chunks_exact_mut(n)) {
                spectrum[i * *rows + first..][..lanes].copy_from_slice(&values[load][c][..lanes]);
            }
        });
    }

    /// The numbers of bins in x and in y, from 0 on, with waves that remain at the computed depth. In the other bins all waves have decayed.
    pub fn left(&self) -> (usize, usize) {
        self.aliased.left
    }

    /// The spectrum of a kernel, `[bin in x][bin in y]`, without the factor i if it is imaginary. Only the bins with remaining waves are
    /// computed.
    pub fn spectrum(&self, load: usize, component: usize) -> Option<&[f64]> {
        let n = self.bins.0 * self.bins.1;
        let k = self.asked.place(load, component)?;
        Some(&self.spectrum[k * n..(k + 1) * n])
    }

    /// The sum over images of a kernel near the surface, `[ky][kx]`.
    pub fn images(&self, load: usize, component: usize) -> Option<&[f64]> {
        let n = self.asked.offsets.0 * self.asked.offsets.1;
        let k = self.asked.place(load, component)?;
        self.images.as_ref().map(|images| &images.folded[k * n..(k + 1) * n])
    }
}

impl Images {
    /// Computes the sums over images of a bracket, which is given by pairs of a depth and its weight.
    fn compute(&mut self, body: &Body, asked: &Asked, bracket: &[(f64, f64)]) {
        self.brackets.combine(body, bracket);
        self.folded.fill(0.0);
        let ((x, y), (reach_x, reach_y)) = (asked.offsets, self.reach);
        for ((load, c), out) in asked.list().zip(self.folded.chunks_exact_mut(x * y)) {
            let Some(table) = self.brackets.table(load, c) else { continue };
            let (odd_x, odd_y) = is_odd(load, c);
            for (ky, out) in out.chunks_exact_mut(x).enumerate() {
                for (place_y, sign_y) in images(ky, body.grid.my, reach_y, odd_y) {
                    let table = &table[place_y * reach_x..(place_y + 1) * reach_x];
                    for (kx, value) in out.iter_mut().enumerate() {
                        let line = images(kx, body.grid.mx, reach_x, odd_x);
                        let sum: f64 = line.map(|(place_x, sign_x)| sign_x * table[place_x]).sum();
                        *value += sign_y * sum;
                    }
                }
            }
        }
    }
}

/// The offsets `|k + n m| < reach` of all images, and the sign of a kernel at each.
fn images(k: usize, m: usize, reach: usize, odd: bool) -> impl Iterator<Item = (usize, f64)> {
    let above = (k..reach).step_by(m).map(|place| (place, 1.0));
    // k <= m/2 < m.
    let below = (m - k..reach).step_by(m).map(move |place| (place, if odd { -1.0 } else { 1.0 }));
    above.chain(below)
}
