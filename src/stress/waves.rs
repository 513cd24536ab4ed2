//! Sums of the waves of a periodic load over their aliases, computed in lanes. The formulas are in [`periodic`](super::periodic).

use std::f64::consts::PI;

use super::body::{Body, Loaded};
use super::exponential::exp_of_minus;
use super::point_force::{Lanes, Values};
use crate::blocks::LANES;
use crate::error::Result;
use crate::memory::zeros;

/// The k z beyond which waves are dropped: `exp(-37) = 9e-17`.
const FADED: f64 = 37.0;
/// The largest number of aliases of a bin at depths of at least an element's longer side: `2 FADED/(2 pi) + 1`, rounded up.
const MOST_ALIASES: usize = (2.0 * FADED / (2.0 * PI)) as usize + 2;
/// The number of nodes of the extrapolation of a kernel to the surface: the depths of 1, 2, ... sides.
pub const NODES: usize = 10;

/// The decay of waves with the depth: `exp(-k z)`, or nearer to the surface than a side, Lagrange's polynomial in z through the values at the
/// nodes.
pub enum Fading {
    /// A depth z of at least one side.
    Deep(f64),
    /// The weights of the nodes at a smaller depth.
    Near([f64; NODES]),
}

impl Fading {
    /// The decay at the depth z, in longer sides of an element.
    pub fn new(z: f64) -> Fading {
        if z >= 1.0 {
            return Fading::Deep(z);
        }
        let node = |j: usize| j as f64 + 1.0;
        Fading::Near(std::array::from_fn(|j| {
            let others = (0..NODES).filter(|&i| i != j);
            others.map(|i| (z - node(i)) / (node(j) - node(i))).product()
        }))
    }

    /// The wave number beyond which waves are dropped.
    fn most(&self) -> f64 {
        match self {
            Fading::Deep(z) => FADED / z,
            Fading::Near(_) => FADED,
        }
    }

    /// `E = exp(-k z)` and `z E`, or their extrapolations, for wave numbers k of which none is below `least`.
    #[inline(always)]
    fn of(&self, k: &Lanes, least: f64) -> (Lanes, Lanes) {
        match self {
            Fading::Deep(z) => {
                let e = exp_of_minus(&k.map(|k| k * z));
                (e, e.map(|e| z * e))
            }
            Fading::Near(weights) => {
                let x = exp_of_minus(k);
                let (mut e, mut ze) = ([0.0; LANES], [0.0; LANES]);
                // Deeper nodes contribute less than exp(-FADED), since weights are at most 252 = exp(5.6).
                let nodes = ((FADED + 5.6) / least.max(1.0)) as usize + 1;
                for (j, weight) in weights.iter().enumerate().take(nodes).rev() {
                    let of_depth = (j as f64 + 1.0) * weight;
                    for i in 0..LANES {
                        e[i] = (e[i] + weight) * x[i];
                        ze[i] = (ze[i] + of_depth) * x[i];
                    }
                }
                (e, ze)
            }
        }
    }
}

/// The waves of one direction: the wave numbers of the bins and of their aliases, and the mean of each wave over an element.
struct Direction {
    /// The difference of the wave numbers of two successive aliases: `2 pi` over an element's side.
    period: f64,
    /// The number of elements.
    m: usize,
    /// The number of bins.
    bins: usize,
    /// The wave numbers `[alias][bin]`. The bins fill whole lanes, for which the last one is repeated.
    numbers: Vec<f64>,
    /// The means of the waves over an element, `[alias][bin]`.
    means: Vec<f64>,
    /// The number of aliases that are left at the current depth.
    aliases: usize,
}

impl Direction {
    /// Memory for the waves of m elements with this side.
    fn new(m: usize, side: f64) -> Result<Direction> {
        let bins = m / 2 + 1;
        let n = MOST_ALIASES * bins.next_multiple_of(LANES);
        let what = "the waves of a depth";
        let (numbers, means) = (zeros(n, what)?, zeros(n, what)?);
        Ok(Direction { period: 2.0 * PI / side, m, bins, numbers, means, aliases: 0 })
    }

    /// The number of bins, rounded up to whole lanes.
    fn width(&self) -> usize {
        self.bins.next_multiple_of(LANES)
    }

    /// Sets up the waves with wave numbers up to `most`. Returns the number of bins, from 0 on, that have any.
    fn enter(&mut self, most: f64) -> usize {
        let width = self.width();
        let fraction = |bin: usize| bin.min(self.bins - 1) as f64 / self.m as f64;
        // The bins lie between 0 and half the period.
        let first = (-most / self.period - 0.5).ceil() as i64;
        let last = (most / self.period).floor() as i64;
        self.aliases = 0;
        let rows = self.numbers.chunks_exact_mut(width).zip(self.means.chunks_exact_mut(width));
        for (alias, (numbers, means)) in (first..=last).zip(rows) {
            for bin in 0..width {
                let part = PI * (fraction(bin) + alias as f64);
                numbers[bin] = self.period * (fraction(bin) + alias as f64);
                means[bin] = if part == 0.0 { 1.0 } else { part.sin() / part };
            }
            self.aliases += 1;
        }
        // If there are several aliases, no bin is left out.
        match (most / self.period * self.m as f64).floor() as usize {
            whole if self.aliases == 1 => self.bins.min(whole + 1),
            _ => self.bins,
        }
    }

    /// The wave number and the mean of an alias of a bin.
    fn of_bin(&self, alias: usize, bin: usize) -> (f64, f64) {
        let index = alias * self.width() + bin;
        (self.numbers[index], self.means[index])
    }

    /// The wave numbers and the means of an alias of the [`LANES`] bins from `first` on.
    fn of_lanes(&self, alias: usize, first: usize) -> (Lanes, Lanes) {
        let index = alias * self.width() + first;
        let lanes = |values: &[f64]| std::array::from_fn(|i| values[index + i]);
        (lanes(&self.numbers), lanes(&self.means))
    }
}

/// The spectra of the kernels of one depth, as sums over aliases.
pub struct Aliased {
    /// The waves in x and in y.
    directions: [Direction; 2],
    /// The numbers of bins in x and in y, from 0 on, with waves that are not dropped. The spectra in all other bins are 0.
    pub left: (usize, usize),
}

impl Aliased {
    /// Allocates memory for the waves of a body.
    pub fn new(body: &Body) -> Result<Aliased> {
        let (dx, dy) = body.element();
        let directions = [Direction::new(body.grid.mx, dx)?, Direction::new(body.grid.my, dy)?];
        Ok(Aliased { directions, left: (0, 0) })
    }

    /// Computes the spectra, and calls `store(bin in x, first bin in y, spectra)` for all bins in `left`, [`LANES`] bins in y at a time.
    pub fn compute(
        &mut self,
        body: &Body,
        loaded: Loaded,
        fading: &Fading,
        mut store: impl FnMut(usize, usize, &Values),
    ) {
        let most = fading.most();
        let [x, y] = &mut self.directions;
        self.left = (x.enter(most), y.enter(most));
        let nu = body.poisson_ratio;
        let cpu = pulp::Arch::new();
        for i in 0..self.left.0 {
            for first in (0..self.left.1).step_by(LANES) {
                let mut sum: Values = [[[0.0; LANES]; 6]; 3];
                cpu.dispatch(AddAliases { nu, loaded, x: (x, i), y: (y, first), fading, sum: &mut sum });
                if i == 0 && first == 0 {
                    // The mean of the load causes no lateral strain, which changes sxx and syy.
                    let correction = 2.0 * nu - nu / (1.0 - nu);
                    (sum[0][0][0], sum[0][1][0]) = (sum[0][0][0] + correction, sum[0][1][0] + correction);
                }
                store(i, first, &sum);
            }
        }
    }
}

/// Adds the waves of all aliases of a bin in x and of [`LANES`] bins in y. pulp compiles this, with all functions that it calls, for the vector
/// instructions of the machine.
struct AddAliases<'a> {
    nu: f64,
    loaded: Loaded,
    x: (&'a Direction, usize),
    y: (&'a Direction, usize),
    fading: &'a Fading,
    sum: &'a mut Values,
}

impl pulp::NullaryFnOnce for AddAliases<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let ((x, bin), (y, first)) = (self.x, self.y);
        let most = self.fading.most();
        for alias in 0..x.aliases {
            let (kx, mean_x) = x.of_bin(alias, bin);
            for alias in 0..y.aliases {
                let (ky, means) = y.of_lanes(alias, first);
                let least = ky[0].abs().min(ky[LANES - 1].abs());
                let least = (kx * kx + least * least).sqrt();
                if least <= most {
                    let loads = means.map(|mean| mean_x * mean);
                    add(self.nu, self.loaded, (kx, &ky), &loads, (self.fading, least), self.sum);
                }
            }
        }
    }
}

/// Adds the stresses of waves with the amplitudes `loads`: the formulas of [`periodic`](super::periodic) without their factors i, of which two
/// make -1.
#[inline(always)]
fn add(
    nu: f64,
    loaded: Loaded,
    (kx, ky): (f64, &Lanes),
    loads: &Lanes,
    (fading, least): (&Fading, f64),
    sum: &mut Values,
) {
    let k: Lanes = std::array::from_fn(|i| (kx * kx + ky[i] * ky[i]).sqrt());
    let (mut e, ze) = fading.of(&k, least);
    let [mut l, mut m, mut kz] = [[0.0; LANES]; 3];
    for i in 0..LANES {
        // The mean of the load, k = 0, has no direction.
        let inverse = 1.0 / k[i].max(f64::MIN_POSITIVE);
        (l[i], m[i]) = (kx * inverse, ky[i] * inverse);
        (e[i], kz[i]) = (loads[i] * e[i], loads[i] * k[i] * ze[i]);
    }
    if loaded[0] {
        let h = 1.0 - 2.0 * nu;
        let sum = &mut sum[0];
        for i in 0..LANES {
            let (l, m, e, kz) = (l[i], m[i], e[i], kz[i]);
            let both = h * e - kz;
            sum[0][i] -= 2.0 * nu * e + l * l * both;
            sum[1][i] -= 2.0 * nu * e + m * m * both;
            sum[2][i] -= e + kz;
            sum[3][i] += l * m * both;
            sum[4][i] += l * kz;
            sum[5][i] += m * kz;
        }
    }
    if loaded[1] {
        by_traction(nu, (&l, &m, &e, &kz), [0, 1, 2, 3, 4, 5], &mut sum[1]);
    }
    if loaded[2] {
        by_traction(nu, (&m, &l, &e, &kz), [1, 0, 2, 3, 5, 4], &mut sum[2]);
    }
}

/// Adds the stresses of a traction along the first of two lateral directions, with the direction cosines l, m of the wave vector. `index` has the
/// index in `sum` of each component.
#[inline(always)]
fn by_traction(nu: f64, (l, m, e, kz): (&Lanes, &Lanes, &Lanes, &Lanes), index: [usize; 6], sum: &mut [Lanes; 6]) {
    for i in 0..LANES {
        let (l, m, e, kz) = (l[i], m[i], e[i], kz[i]);
        let both = 2.0 * nu * e + kz;
        sum[index[0]][i] += l * (2.0 * (1.0 + nu) * e - l * l * both);
        sum[index[1]][i] += l * (2.0 * nu * e - m * m * both);
        sum[index[2]][i] += l * kz;
        sum[index[3]][i] += m * (e - l * l * both);
        sum[index[4]][i] += l * l * kz - e;
        sum[index[5]][i] -= l * m * kz;
    }
}

#[cfg(test)]
#[path = "../../tests/unit/stress_waves.rs"]
mod tests;
