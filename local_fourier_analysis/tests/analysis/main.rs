//! Local Fourier analysis: symbols compared with sums of coefficients, cycles with matrices, and factors with actual sweeps and cycles.

mod antiperiodic;

use antiperiodic::{window, Antiperiodic};
use contact_normal::contact::Problem;
use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace, Kernel};
use contact_normal::methods::multigrid::smoother::Smoother;
use contact_normal::methods::multigrid::SmootherKind::{self, Fft, GaussSeidel, Jacobi, RedBlack};
use contact_normal::methods::multigrid::{CycleShape, Multigrid};
use contact_normal::operator::fft::Complex;
use contact_normal::operator::Operator;
use contact_normal::threads::Threads;
use local_fourier_analysis::{measured, Analysis, Symbol};

fn half_space(grid: &Grid) -> Coefficients {
    Coefficients::from(HalfSpace::new(grid.dx, grid.dy, 1.0))
}

fn shape(smoother: SmootherKind, relaxation: f64, (pre_sweeps, post_sweeps): (usize, usize)) -> CycleShape {
    CycleShape { smoother, relaxation, pre_sweeps, post_sweeps, coarsest: 4 }
}

/// The two-grid factor of the analysis for square elements.
fn two_grid(across: [usize; 2], shape: &CycleShape) -> f64 {
    Analysis::new(1.0, 1.0, across, 2).unwrap().convergence_factor(shape)
}

/// A(t) and L(t) as sums of coefficients with a smooth window.
fn windowed_sums(half_space: &HalfSpace, reach: i64, (tx, ty): (f64, f64)) -> (Complex<f64>, Complex<f64>) {
    let (mut whole, mut before) = (Complex::default(), Complex::default());
    for ky in -reach..=reach {
        for kx in -reach..=reach {
            let weight = window(kx, reach) * window(ky, reach);
            let term = Complex::from_polar(weight * half_space.at(kx, ky), -(kx as f64) * tx - ky as f64 * ty);
            whole += term;
            before += if ky > 0 || ky == 0 && kx > 0 { term } else { Complex::default() };
        }
    }
    (whole, before)
}

#[test]
fn the_symbols_are_the_sums_of_the_coefficients() {
    for (dx, dy) in [(1.0, 1.0), (1.0, 0.6), (0.5, 1.0)] {
        let (symbol, half_space) = (Symbol::new(dx, dy, 1.0), HalfSpace::new(dx, dy, 1.0));
        assert_eq!(symbol.diagonal(), half_space.at(0, 0));
        for t in [(3.0, 3.1), (1.0, -2.0), (-0.7, 0.9), (4.0, 1.0), (0.6, 3.0)] {
            let value = symbol.at(t.0, t.1);
            let (coarse, fine) = (windowed_sums(&half_space, 120, t), windowed_sums(&half_space, 240, t));
            for (exact, coarse, fine) in [(value.whole.into(), coarse.0, fine.0), (value.before, coarse.1, fine.1)] {
                // The error of a smooth window falls off faster than any power of its reach. So twice the reach more than halves it, and the
                // difference of the two sums bounds it. 1e-12 is the rounding of 2e5 terms.
                let tolerance = (coarse - fine).norm() + 1e-12;
                assert!(tolerance < 1e-4, "{t:?}: the sums are known to {tolerance}");
                assert!((exact - fine).norm() <= tolerance, "{t:?}: {exact} for {fine}, known to {tolerance}");
            }
        }
    }
}

/// The FFT smoother's symbol 1 - omega assumes that M A is 1 away from the boundary. Its circulant ends the coefficients at half a period n, where
/// they are 2/n of c dx dy, with a kink of their slope. Relative to A(t) this is less than 4/n for the waves that it smooths, and less on a larger
/// grid.
#[test]
fn the_eigenvalues_of_the_circulant_are_near_the_symbol() {
    let deviation = |n: usize| {
        let grid = Grid::new(n, n, 1.0, 1.0).unwrap();
        let inverse = Operator::<f64>::inverse_circulant(&half_space(&grid), &grid, (n, n), &Threads::One).unwrap();
        let inverse = inverse.expect("a positive circulant");
        let mut workspace = inverse.workspace().unwrap();
        let symbol = Symbol::new(1.0, 1.0, 1.0);
        let mut worst: f64 = 0.0;
        for (jx, jy) in [(n / 2, n / 2), (n / 4, n / 4), (1, n / 2), (n / 2, 1), (n / 4, 3), (n / 3, n - n / 4)] {
            let t = |j: usize| 2.0 * std::f64::consts::PI * j as f64 / n as f64;
            let mut p: Vec<f64> = (0..n * n).map(|i| ((i % n) as f64 * t(jx) + (i / n) as f64 * t(jy)).cos()).collect();
            inverse.apply_in_place(&mut p, &mut workspace);
            // The wave is 1 at element 0.
            worst = worst.max((p[0] * symbol.at(t(jx), t(jy)).whole - 1.0).abs());
        }
        worst
    };
    let (coarse, fine) = (deviation(32), deviation(64));
    assert!(coarse <= 4.0 / 32.0 && fine <= 4.0 / 64.0 && fine < coarse, "{coarse} and {fine}");
}

/// Waves that change sign after eight elements, on two and three grids: matrices of 64 unknowns, from direct sums of the coefficients and the
/// transfers of the library, have the factors of the symbols.
#[test]
fn the_factors_are_the_spectral_radii_of_matrices() {
    for (dx, dy) in [(1.0, 1.0), (1.0, 0.6)] {
        let levels: Vec<Antiperiodic> = (0..3).map(|l| Antiperiodic::new(dx, dy, l, 8 >> l)).collect();
        for depth in [2, 3] {
            let analysis = Analysis::new(dx, dy, [4, 4], depth).unwrap();
            for kind in [GaussSeidel, RedBlack, Jacobi, Fft] {
                for (omega, sweeps) in [(1.0, (1, 1)), (0.7, (1, 0)), (0.5, (0, 2))] {
                    let shape = shape(kind, omega, sweeps);
                    let expected = antiperiodic::spectral_radius(&levels[..depth], &shape);
                    let factor = analysis.convergence_factor(&shape);
                    // The windowed sums have an error of 1e-6, Gelfand's formula of 1e-5. Another 1e-5 is the rounding of a nilpotent matrix.
                    let tolerance = 3e-5 * expected + 1e-5;
                    let what = format!("{kind:?} {omega} {sweeps:?}, {depth} grids");
                    assert!((factor - expected).abs() <= tolerance, "{what}: {factor} for {expected}");
                }
            }
        }
    }
}

/// The packet `e^(i k t) exp(-|k|^2/(2 sigma^2))` in the middle of a full grid contains frequencies of variance 1/sigma^2 about t. One sweep
/// multiplies its centre by S(t) + (S_xx + S_yy)/(2 sigma^2) + .. The grid ends after 4 sigma, where the packet is e^-8. Neither t nor t + (pi, pi)
/// is within 4/sigma of 0, where the symbols have a singularity.
#[test]
fn a_sweep_of_the_library_does_to_a_wave_what_the_analysis_says() {
    const M: usize = 128;
    const SIGMA: f64 = 16.0;
    let grid = Grid::new(M, M, 1.0, 0.6).unwrap();
    let influence = half_space(&grid);
    let mut multigrid =
        Multigrid::new(&mut Problem::new(grid, influence.clone(), &Threads::One).unwrap(), CycleShape::default())
            .unwrap();
    let analysis = Analysis::new(1.0, 0.6, [16, 16], 2).unwrap();
    let [tx, ty] = analysis.frequencies();
    let (n, at) = (tx.len(), |i: i64| i.rem_euclid(32) as usize);
    assert_eq!(n, 32);
    for kind in [GaussSeidel, RedBlack, Jacobi] {
        let mut smoother = Smoother::new(kind, &influence, &grid, &Threads::One).unwrap();
        for omega in [1.0, 0.7] {
            let symbol = analysis.amplification(kind, omega);
            for (jx, jy) in [(13, 18), (8, 3), (8, 28), (24, 9), (5, 12)] {
                // Even and odd elements next to the centre have the real and the imaginary part of the wave.
                let (mut left, centre) = ([Complex::<f64>::default(); 2], M / 2 * M + M / 2);
                for part in 0..2 {
                    let wave = |i: usize| {
                        let (x, y) = ((i % M) as f64 - (M / 2) as f64, (i / M) as f64 - (M / 2) as f64);
                        let phase = Complex::from_polar(1.0, x * tx[jx] + y * ty[jy]);
                        phase * (-(x * x + y * y) / (2.0 * SIGMA * SIGMA)).exp()
                    };
                    let mut p: Vec<f64> = (0..M * M).map(|i| if part == 0 { wave(i).re } else { wave(i).im }).collect();
                    let mut residual = vec![0.0; M * M];
                    multigrid.displace(0, &p, &mut residual);
                    residual.iter_mut().for_each(|r| *r = -*r);
                    let displace = |p: &[f64], u: &mut [f64]| multigrid.displace(0, p, u);
                    smoother.sweep(&mut p, &mut residual, &[true; M * M], omega, displace);
                    for (k, left) in left.iter_mut().enumerate() {
                        let unit = if part == 0 { Complex::new(1.0, 0.0) } else { Complex::i() };
                        *left += unit * p[centre + k] / wave(centre + k);
                    }
                }
                let measured = (0.5 * (left[0].norm_sqr() + left[1].norm_sqr())).sqrt();
                let s = |dx: i64, dy: i64| symbol[at(jy as i64 + dy) * n + at(jx as i64 + dx)];
                let (expected, spacing) = (s(0, 0), tx[1] - tx[0]);
                let curvature = [(1, 0), (0, 1)].map(|(x, y)| (s(x, y) - 2.0 * expected + s(-x, -y)).abs());
                // The second differences of the modulus differ from those of the complex symbol by S_x^2/|S|, so slopes count as well.
                let slope = [(1, 0), (0, 1)].map(|(x, y)| (0.5 * (s(x, y) - s(-x, -y))).powi(2) / expected);
                let bend = curvature.iter().chain(&slope).sum::<f64>() / (spacing * spacing);
                let tolerance = bend / (2.0 * SIGMA * SIGMA) + (-8f64).exp();
                let off = (measured - expected).abs();
                assert!(off <= tolerance, "{kind:?} {omega} ({jx}, {jy}): {measured} for {expected} +- {tolerance}");
            }
        }
    }
}

/// Gauss-Seidel's sums along a row end where the contact area ends: a quarter of a row away in the mean, and never farther than a row. So the factors
/// lie between those for a quarter of the elements across and for all of them. 2%: the area contains waves up to pi (1 - 1/n) only, which changes an
/// even function about pi by about (pi/n)^2/2. Red-black order leaves 1 - const/A of the longest wave, which on a square may be 1.25 times as large
/// as in the analysis (see the test of Jacobi).
#[test]
fn cycles_converge_by_the_factors_of_the_analysis() {
    let grid = Grid::new(32, 32, 1.0, 1.0).unwrap();
    let influence = half_space(&grid);
    for kind in [GaussSeidel, RedBlack] {
        for omega in [0.5, 0.8, 1.0, 1.1] {
            for sweeps in [(1, 1), (1, 0), (0, 1)] {
                let shape = shape(kind, omega, sweeps);
                let (least, most) = (two_grid([8, 8], &shape), two_grid([32, 32], &shape));
                let most = if kind == RedBlack { 1.0 - (1.0 - most) / 1.25 } else { most };
                for coarsest in [16, 4] {
                    let shape = CycleShape { coarsest, ..shape };
                    let factor = measured::factor(&grid, &influence, &[true; 1024], shape, (60, 20));
                    let inside = 0.98 * least <= factor && factor <= most;
                    assert!(inside, "{kind:?} {omega} {sweeps:?}: {factor}, expected {least} to {most}");
                }
            }
        }
    }
}

#[test]
fn gauss_seidel_is_slower_along_longer_rows_only() {
    let shape = shape(GaussSeidel, 0.8, (1, 1));
    let along = |mx: usize, my: usize| {
        let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
        measured::factor(&grid, &half_space(&grid), &vec![true; mx * my], shape, (60, 20))
    };
    // Measured 0.46 and 0.38 for 128 x 32. The difference is that of the analysis, to half of it.
    let predicted = two_grid([128, 32], &shape) - two_grid([32, 128], &shape);
    let found = along(128, 32) - along(32, 128);
    assert!(predicted > 0.05 && (found / predicted - 1.0).abs() <= 0.5, "{found} for {predicted}");

    // The smoothing factor grows with log n: from 64 to 256 by as much as from 16 to 64, to within a half.
    let smoothing = |across| Analysis::new(1.0, 1.0, [across, 16], 2).unwrap().smoothing_factor(GaussSeidel, 0.8, 1);
    let (small, middle, large) = (smoothing(16), smoothing(64), smoothing(256));
    let growth = (large - middle) / (middle - small);
    assert!(0.5 < growth && growth < 1.0 && large < 1.0, "{small}, {middle}, {large}");
}

/// On a square of side l the largest eigenvalue of A lies between the mean of 1/r over pairs of points, 2.973 c l, and the largest mean over one of
/// them, 4 asinh(1) c l = 3.525 c l. The analysis has 2 pi/(pi/sqrt 2) c l = 2.828 c l, so that the ratio is 1.05 to 1.25.
#[test]
fn jacobi_diverges_by_the_factor_of_the_analysis() {
    let n = 32;
    let grid = Grid::new(n, n, 1.0, 1.0).unwrap();
    let influence = half_space(&grid);
    for omega in [1.0, 0.5] {
        let two = Analysis::new(1.0, 1.0, [n, n], 2).unwrap();
        let predicted = two.amplification(Jacobi, omega).into_iter().fold(0.0, f64::max);
        let mut multigrid =
            Multigrid::new(&mut Problem::new(grid, influence.clone(), &Threads::One).unwrap(), CycleShape::default())
                .unwrap();
        let (mut p, mut r, mut growth) = (vec![1.0; n * n], vec![0.0; n * n], 0.0);
        let mut smoother = Smoother::new(Jacobi, &influence, &grid, &Threads::One).unwrap();
        for _ in 0..20 {
            multigrid.displace(0, &p, &mut r);
            r.iter_mut().for_each(|r| *r = -*r);
            smoother.sweep(&mut p, &mut r, &[true; 1024], omega, |_, _| {});
            growth = p.iter().map(|p| p * p).sum::<f64>().sqrt();
            p.iter_mut().for_each(|p| *p /= growth);
        }
        let ratio = (growth + 1.0) / (predicted + 1.0);
        // 1%: there are elements instead of points.
        assert!((1.04..=1.26).contains(&ratio), "omega {omega}: {growth} for {predicted}");

        // Two grids converge. With three, V(1,1) has four sweeps over long waves on two grids. Each of them differs by the ratio (and a little more,
        // because 1 is subtracted): 1 to 1.3^4.
        let shape = shape(Jacobi, omega, (1, 1));
        assert!(two.convergence_factor(&shape) < 0.7);
        let predicted = Analysis::new(1.0, 1.0, [n, n], 3).unwrap().convergence_factor(&shape);
        let three = CycleShape { coarsest: 8, ..shape };
        let found = measured::factor(&grid, &influence, &[true; 1024], three, (60, 20));
        assert!(predicted > 2.0 && found > predicted && found < 1.3f64.powi(4) * predicted, "{found} for {predicted}");
    }
    // It is nevertheless a better smoother than Gauss-Seidel, as its smoothing factor shows.
    let smoothing = |kind| Analysis::new(1.0, 1.0, [n, n], 2).unwrap().smoothing_factor(kind, 0.8, 1);
    assert!(smoothing(Jacobi) < smoothing(GaussSeidel));
}

#[test]
fn what_cannot_be_analysed_is_refused() {
    for (dx, dy, across, levels) in [
        (0.0, 1.0, [8, 8], 2),
        (1.0, f64::NAN, [8, 8], 2),
        (1.0, 0.4, [8, 8], 2),
        (1.0, 1.0, [0, 8], 2),
        (1.0, 1.0, [8, usize::MAX], 2),
        (1.0, 1.0, [8, 8], 1),
        (1.0, 1.0, [8, 8], 9),
    ] {
        assert!(Analysis::new(dx, dy, across, levels).is_err(), "{dx} {dy} {across:?} {levels}");
    }
}
