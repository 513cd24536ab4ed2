//! The equations on waves that change sign after n elements, as dense matrices: coefficients summed over all images.

use contact_normal::grid::Grid;
use contact_normal::influence::{HalfSpace, Kernel};
use contact_normal::methods::multigrid::{transfer, CycleShape, SmootherKind};
use faer::linalg::solvers::Solve;
use faer::Mat;

/// A smooth window: 1 up to 0.3 of the reach, 0 beyond it.
pub fn window(k: i64, reach: i64) -> f64 {
    let s = (k.abs() as f64 / reach as f64 - 0.3) / 0.7;
    if s <= 0.0 {
        1.0
    } else if s >= 1.0 {
        0.0
    } else {
        1.0 / (1.0 + (1.0 / (1.0 - s) - 1.0 / s).exp())
    }
}

/// One grid: A, and its part J < I.
pub struct Antiperiodic {
    grid: Grid,
    whole: Mat<f64>,
    before: Mat<f64>,
    diagonal: f64,
}

impl Antiperiodic {
    /// The equations on n x n elements of level `l` of a hierarchy.
    pub fn new(dx: f64, dy: f64, l: usize, n: usize) -> Antiperiodic {
        const REACH: i64 = 400;
        let size = (1 << l) as f64;
        let grid = Grid::new(n, n, size * dx, size * dy).unwrap();
        let half_space = HalfSpace::new(grid.dx, grid.dy, 1.0);
        let period = n as i64;
        let mut sums = vec![[0.0; 2]; n * n];
        for ky in -REACH..=REACH {
            for kx in -REACH..=REACH {
                let image = kx.div_euclid(period) + ky.div_euclid(period);
                let sign = if image % 2 == 0 { 1.0 } else { -1.0 };
                let value = sign * window(kx, REACH) * window(ky, REACH) * half_space.at(kx, ky);
                let sum = &mut sums[(ky.rem_euclid(period) * period + kx.rem_euclid(period)) as usize];
                sum[0] += value;
                sum[1] += if ky > 0 || ky == 0 && kx > 0 { value } else { 0.0 };
            }
        }
        let matrix = |part: usize| {
            Mat::from_fn(n * n, n * n, |i, j| {
                let (x, y) = ((i % n) as i64 - (j % n) as i64, (i / n) as i64 - (j / n) as i64);
                let sign = if (x < 0) == (y < 0) { 1.0 } else { -1.0 };
                sign * sums[(y.rem_euclid(period) * period + x.rem_euclid(period)) as usize][part]
            })
        };
        Antiperiodic { grid, whole: matrix(0), before: matrix(1), diagonal: half_space.at(0, 0) }
    }

    /// The matrix that maps an error to the error after one sweep.
    fn sweep(&self, kind: SmootherKind, omega: f64) -> Mat<f64> {
        let n = self.grid.len();
        let one = Mat::<f64>::identity(n, n);
        let colour = |i: usize| (i % self.grid.mx + i / self.grid.mx) % 2;
        let divided = |same_colour: bool| {
            let lower = Mat::from_fn(n, n, |i, j| {
                let kept = !same_colour || colour(i) == colour(j);
                self.before[(i, j)] * if kept { 1.0 } else { 0.0 } + self.diagonal / omega * one[(i, j)]
            });
            lower.partial_piv_lu().solve(&self.whole)
        };
        match kind {
            SmootherKind::Jacobi => Mat::from_fn(n, n, |i, j| one[(i, j)] - omega / self.diagonal * self.whole[(i, j)]),
            SmootherKind::Fft => Mat::from_fn(n, n, |i, j| (1.0 - omega) * one[(i, j)]),
            SmootherKind::GaussSeidel => &one - divided(false),
            SmootherKind::RedBlack => {
                let divided = divided(true);
                let half = |wanted: usize| {
                    Mat::from_fn(n, n, |i, j| one[(i, j)] - if colour(i) == wanted { divided[(i, j)] } else { 0.0 })
                };
                half(1) * half(0)
            }
        }
    }
}

/// The matrix that maps an error to the error after a cycle.
fn cycle(levels: &[Antiperiodic], shape: &CycleShape) -> Mat<f64> {
    let (level, coarser) = (&levels[0], &levels[1..]);
    let n = level.grid.len();
    let Some(coarse) = coarser.first() else { return Mat::zeros(n, n) };
    let mut restriction = Mat::zeros(coarse.grid.len(), n);
    let mut interpolation = Mat::zeros(n, coarse.grid.len());
    for j in 0..n {
        let mut column = vec![0.0; coarse.grid.len()];
        let unit = |i: usize| if i == j { 1.0 } else { 0.0 };
        transfer::restrict_mean(&level.grid, &coarse.grid, unit, &mut column);
        column.iter().enumerate().for_each(|(i, value)| restriction[(i, j)] = *value);
    }
    for j in 0..coarse.grid.len() {
        let mut column = vec![0.0; n];
        let mut unit = vec![0.0; coarse.grid.len()];
        unit[j] = 1.0;
        transfer::interpolate(&level.grid, &coarse.grid, &unit, &mut column, |to, value| *to = value);
        column.iter().enumerate().for_each(|(i, value)| interpolation[(i, j)] = *value);
    }
    let solution = coarse.whole.partial_piv_lu().solve(&(restriction * &level.whole));
    let missing = cycle(coarser, shape) * &solution;
    let corrected = Mat::<f64>::identity(n, n) - interpolation * (solution - missing);
    let sweep = level.sweep(shape.smoother, shape.relaxation);
    let several = |count: usize| (0..count).fold(Mat::<f64>::identity(n, n), |power, _| &sweep * power);
    several(shape.post_sweeps) * corrected * several(shape.pre_sweeps)
}

/// The spectral radius of a cycle.
pub fn spectral_radius(levels: &[Antiperiodic], shape: &CycleShape) -> f64 {
    let eigenvalues = cycle(levels, shape).eigenvalues().expect("eigenvalues");
    eigenvalues.iter().map(|value| value.re.hypot(value.im)).fold(0.0, f64::max)
}
