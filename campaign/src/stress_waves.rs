//! Stresses below periodic loads that are constant on elements, as sums over waves.
//!
//! A wave `e^(i k.x)` of the loads on a half-space causes these stresses, with `n` along k, `t` across k, and `d = e^(-k z)`:
//!
//! ```text
//! by p            nn: -(1 - k z) d     tt: -2 nu d       zz: -(1 + k z) d     nz: i k z d
//! by q along n    nn: i (2 - k z) d    tt: 2 i nu d      zz: i k z d          nz: -(1 - k z) d
//! by q along t    nt: i d              tz: -d
//! ```
//!
//! They follow from Airy's function `(A + B z) e^(-k z)`. The mean of p causes `xx = yy = -nu/(1 - nu) p` and `zz = -p`; the mean of q causes `xz =
//! -qx` and `yz = -qy`.

use std::f64::consts::PI;

use crate::grid::Grid;

type Complex = [f64; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn scaled(a: Complex, by: f64) -> Complex {
    [a[0] * by, a[1] * by]
}

/// The waves of periodic loads.
pub struct Waves {
    grid: Grid,
    /// The amplitudes of p, qx and qy of the waves `(i, j)` of the grid, row by row. Waves with i + mx, i + 2 mx, ... (aliases) have the same
    /// amplitude.
    amplitudes: Vec<[Complex; 3]>,
}

/// Waves decay with the depth as `e^(-k z)`. Waves with k z above this number are left out.
const NEGLIGIBLE: f64 = 36.0;

impl Waves {
    /// The waves of loads; `loads(element)` returns p, qx and qy.
    pub fn new(grid: Grid, loads: impl Fn(usize) -> [f64; 3]) -> Waves {
        let Grid { mx, my, .. } = grid;
        let amplitude = |wave: usize| {
            let mut sums = [[0.0; 2]; 3];
            for element in 0..mx * my {
                let turns = ((wave % mx) * (element % mx)) as f64 / mx as f64
                    + ((wave / mx) * (element / mx)) as f64 / my as f64;
                let (sine, cosine) = (-2.0 * PI * turns).sin_cos();
                let load = loads(element);
                (0..3).for_each(|k| sums[k] = [sums[k][0] + load[k] * cosine, sums[k][1] + load[k] * sine]);
            }
            sums.map(|sum| scaled(sum, 1.0 / (mx * my) as f64))
        };
        Waves { grid, amplitudes: (0..mx * my).map(amplitude).collect() }
    }

    /// The stresses xx, yy, zz, xy, xz, yz at a point. x and y are measured from the outer corner of element (0, 0).
    pub fn at(&self, nu: f64, [x, y, z]: [f64; 3]) -> [f64; 6] {
        let Grid { mx, my, dx, dy } = self.grid;
        let reach = |d: f64| (NEGLIGIBLE * d / (2.0 * PI * z)).ceil() as i64 + 1;
        let number = |i: usize, m: usize, alias: i64, d: f64| 2.0 * PI * (i as f64 / m as f64 + alias as f64) / d;
        let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
        let mut sum = [0.0; 6];
        for wave in 0..mx * my {
            for a in -reach(dx)..=reach(dx) {
                let kx = number(wave % mx, mx, a, dx);
                for b in -reach(dy)..=reach(dy) {
                    let ky = number(wave / mx, my, b, dy);
                    if kx.hypot(ky) * z > NEGLIGIBLE {
                        continue;
                    }
                    // Phases are relative to the middle of element (0, 0).
                    let (sine, cosine) = (kx * (x - 0.5 * dx) + ky * (y - 0.5 * dy)).sin_cos();
                    let mean = sinc(0.5 * kx * dx) * sinc(0.5 * ky * dy);
                    let loads = self.amplitudes[wave].map(|load| times(scaled(load, mean), [cosine, sine]));
                    let stresses = of_wave(nu, [kx, ky], z, loads);
                    sum.iter_mut().zip(stresses).for_each(|(sum, stress)| *sum += stress);
                }
            }
        }
        sum
    }
}

/// The real parts of the stresses by one wave of p, qx and qy.
fn of_wave(nu: f64, [kx, ky]: [f64; 2], z: f64, [p, qx, qy]: [Complex; 3]) -> [f64; 6] {
    let k = kx.hypot(ky);
    if k == 0.0 {
        let sideways = -nu / (1.0 - nu) * p[0];
        return [sideways, sideways, -p[0], 0.0, -qx[0], -qy[0]];
    }
    let (c, s, kz, d) = (kx / k, ky / k, k * z, (-k * z).exp());
    let across = |x: Complex, y: Complex, c: f64, s: f64| [c * x[0] + s * y[0], c * x[1] + s * y[1]];
    let (along, cross) = (across(qx, qy, c, s), across(qx, qy, -s, c));
    // The real parts of `v d` and of `i v d`.
    let (re, im) = (|v: Complex| v[0] * d, |v: Complex| -v[1] * d);
    let nn = -(1.0 - kz) * re(p) + (2.0 - kz) * im(along);
    let tt = -2.0 * nu * re(p) + 2.0 * nu * im(along);
    let zz = -(1.0 + kz) * re(p) + kz * im(along);
    let nz = kz * im(p) - (1.0 - kz) * re(along);
    let (nt, tz) = (im(cross), -re(cross));
    let xx = c * c * nn + s * s * tt - 2.0 * c * s * nt;
    let yy = s * s * nn + c * c * tt + 2.0 * c * s * nt;
    let xy = c * s * (nn - tt) + (c * c - s * s) * nt;
    [xx, yy, zz, xy, c * nz - s * tz, s * nz + c * tz]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks one wave at an angle: the equilibrium of its stresses by differences, and the loads at the surface.
    #[test]
    fn a_wave_is_in_equilibrium_and_meets_its_loads() {
        let (k, loads) = ([0.7, -0.4], [1.0, 0.6, -0.3]);
        let at = |[x, y, z]: [f64; 3]| {
            let (sine, cosine) = (k[0] * x + k[1] * y).sin_cos();
            of_wave(0.3, k, z, loads.map(|load| [load * cosine, load * sine]))
        };
        let (place, step) = ([0.3, 0.2, 0.9], 1e-4);
        let slope = |axis: usize, c: usize| {
            let moved = |by: f64| {
                let mut moved = place;
                moved[axis] += by;
                at(moved)[c]
            };
            (moved(step) - moved(-step)) / (2.0 * step)
        };
        for row in [[0, 3, 4], [3, 1, 5], [4, 5, 2]] {
            let sum: f64 = row.into_iter().enumerate().map(|(axis, c)| slope(axis, c)).sum();
            assert!(sum.abs() <= 1e-7, "{row:?}: {sum:e}");
        }
        let [_, _, zz, _, xz, yz] = at([0.0; 3]);
        let wrong = (zz + loads[0]).abs() + (xz + loads[1]).abs() + (yz + loads[2]).abs();
        assert!(wrong <= 1e-14, "{zz} {xz} {yz}");
    }
}
