//! Local Fourier analysis: the effect of sweeps and cycles on waves `e^(i k t)`, away from the boundary of the contact area.
//!
//! The paper names it first among its subjects for future work. The method is that of U. Trottenberg, C.W. Oosterlee and
//! A. Schueller, Multigrid (2001), chapter 4, and of R. Wienands and W. Joppich, Practical Fourier Analysis for Multigrid
//! Methods (2005). On an infinite grid with one set of coefficients every part of a cycle maps waves to waves:
//!
//! ```text
//! A        e^(i k t) -> A(t) e^(i k t)                  the symbol of A, and L(t) that of its part J < I: see `Symbol`
//! Jacobi                1 - omega A(t)/c(0,0)
//! Gauss-Seidel          1 - A(t)/(c(0,0)/omega + L(t))  the changes d of a sweep solve (c(0,0)/omega + L) d = r
//! FFT                   1 - omega                       M A = 1 and alpha = 1 where there is no boundary
//! red-black             (1 - G Q A)(1 - G P A)          P, Q = (1 + S)/2, (1 - S)/2: the red and the black elements
//!                       S: t -> t + (pi, pi),           1/G = c(0,0)/omega + (L(t) + L(t + (pi, pi)))/2
//! restriction           f(t) = (1 + e^(i tx))(1 + e^(i ty))/4, to frequency 2 t;    interpolation: its conjugate, back
//! coarse A              the symbol of elements 2 dx by 2 dy at 2 t, as the hierarchy computes its coefficients anew
//! ```
//!
//! (In 1/G only the offsets of L with kx + ky even count, as within a colour.) Four waves, t + (0 or pi, 0 or pi), are the same on the next grid. So
//! the two-grid cycle is a 4 x 4 matrix for each such set, V-cycles of more grids are larger matrices, and the factor is the largest spectral radius
//! over all sets. The smoothing factor is that of sweeps with an ideal correction, which removes only the wave with |tx|, |ty| < pi/2 of each set.
//!
//! # Roles are reversed
//!
//! For a differential operator short waves have the large eigenvalues, and relaxation removes them because they dominate the residual. Here A is an
//! integral operator of order -1: `A(t)` is near `2 pi c/|w|`, `w = (tx/dx, ty/dy)`. So *long* waves have the large eigenvalues, without bound as the
//! grid is refined. Those of the short waves stay within a factor of three of c(0,0). A smoother must still remove the short waves, which coarse
//! grids do not resolve. But it must not amplify the long ones, which dominate the residual:
//!
//! * *Jacobi* multiplies the longest wave on n elements by `1 - omega A/c(0,0)`, about `-0.8 omega n`. Its smoothing factor is better than that of
//!   Gauss-Seidel. Its two-grid factor of V(1,1) is good as well, because an exact coarse correction reduces long waves to |t|^2/8, which balances
//!   two sweeps. But a V-cycle corrects inexactly, and on each of its grids the remaining error is multiplied by the square of that number. The
//!   V-cycle diverges, the faster the more grids it has. A damping that prevents this is about 1/n, and then no longer smooths.
//! * *Gauss-Seidel* divides by c(0,0)/omega + L(t), which grows with A(t). As A = c(0,0) + 2 Re L, its symbol S has
//!   `|S|^2 = 1 - A c(0,0) (2/omega - 1)/|c(0,0)/omega + L|^2 < 1` for 0 < omega < 2: no wave is amplified, however long.
//! * *Red-black order* couples t with t + (pi, pi): the shortest wave with the longest.
//! * *The FFT smoother* divides by A(t) itself. It is not exact only because of the boundary, which this analysis does not contain.
//!
//! # The lowest frequency
//!
//! `A(t)` is infinite at t = 0 (1/r has no mean on an infinite plane), and L(t) on the whole line tx = 0: the displacement by a row of equal
//! pressures diverges, as a logarithm. A contact area has no such waves. A constant pressure on a square of side l has the mean displacement
//! `2.97 c l` (the mean of 1/r over all pairs of its points is `4 (asinh 1 - (sqrt 2 - 1)/3) l`), which is `2 pi c/|w|` at `|w| = 2.11/l`, that is
//! `1.5/l` in each direction. So the lowest frequency is taken as `pi/(2 n)` for n elements across, and all are `pi (2 j + 1)/(2 n)`: waves that
//! change sign after 2 n elements.
//!
//! The factors depend on it. Along tx -> 0 the imaginary part of L grows like log(1/tx), and the symbol of Gauss-Seidel tends to 1, for short waves
//! in y as well. So its smoothing factor has no bound below 1 for all grids, but approaches 1 only as slowly as a logarithm. The number of elements
//! in the direction of the rows determines it. `docs/local_fourier_analysis.md` has tables and measurements.
//!
//! ```
//! use local_fourier_analysis::Analysis;
//! use contact_normal::methods::multigrid::{CycleShape, SmootherKind};
//!
//! // Square elements, 32 x 32 across the contact area, two grids, V(1,1) with Gauss-Seidel and omega = 0.8.
//! let analysis = Analysis::new(1.0, 1.0, [32, 32], 2)?;
//! let smoothing = analysis.smoothing_factor(SmootherKind::GaussSeidel, 0.8, 1);
//! let factor = analysis.convergence_factor(&CycleShape::default());
//! assert!(factor < smoothing && smoothing < 0.8);
//! # Ok::<(), contact_normal::error::Error>(())
//! ```

mod harmonics;
mod level;
pub mod measured;
mod spectral_radius;
mod symbol;

pub use symbol::{Symbol, Value};

use contact_normal::error::{Error, Result};
use contact_normal::methods::multigrid::{CycleShape, SmootherKind};
use harmonics::Cycle;
use level::{frequency, Level};

/// More levels have too many waves that are the same on the coarsest grid for a matrix of them: 4^(levels - 1).
const MOST_LEVELS: usize = 5;

/// Sizes that can be analysed in seconds to minutes.
const MOST_ACROSS: usize = 4096;

fn invalid<T>(message: String) -> Result<T> {
    Err(Error::InvalidArgument(message))
}

/// The analysis on one element size and one size of the contact area.
pub struct Analysis {
    levels: Vec<Level>,
}

impl Analysis {
    /// The analysis of elements `dx` by `dy`, `across` of them across the contact area in x and in y, with `levels` grids; 2 give the two-grid
    /// factor. All are coarsened in both directions. There are `2 across` frequencies in each direction, rounded up to a multiple of `2^levels`.
    pub fn new(dx: f64, dy: f64, across: [usize; 2], levels: usize) -> Result<Analysis> {
        for (name, d) in [("dx", dx), ("dy", dy)] {
            if !(d > 0.0 && d.is_finite()) {
                return invalid(format!("{name} is {d}; an element size must be positive and finite"));
            }
        }
        if !(0.5..=2.0).contains(&(dx / dy)) {
            return invalid(format!("dx/dy is {}; both directions are coarsened between 1/2 and 2 only", dx / dy));
        }
        if !(2..=MOST_LEVELS).contains(&levels) {
            return invalid(format!("levels is {levels}; the analysis is of 2 to {MOST_LEVELS} grids"));
        }
        if across.iter().any(|across| !(1..=MOST_ACROSS).contains(across)) {
            return invalid(format!("across is {across:?}; the analysis is of 1 to {MOST_ACROSS} elements"));
        }
        let n = across.map(|across| (2 * across).next_multiple_of(1 << levels));
        let on = |l: usize| {
            let size = (1 << l) as f64;
            Level::new(size * dx, size * dy, n.map(|n| n >> l))
        };
        Ok(Analysis { levels: (0..levels).map(on).collect() })
    }

    /// The frequencies of the finest grid in x and in y, between 0 and 2 pi.
    pub fn frequencies(&self) -> [Vec<f64>; 2] {
        self.levels[0].n.map(|n| (0..n).map(|j| frequency(j, n)).collect())
    }

    /// A(t)/c(0,0) on the finest grid, `[jy][jx]`.
    pub fn symbol(&self) -> Vec<f64> {
        self.levels[0].values.iter().map(|value| value.whole / self.levels[0].diagonal).collect()
    }

    /// The 2-norm, after one sweep, of each wave of the finest grid (red-black: of it and the wave that it is coupled with), `[jy][jx]`.
    pub fn amplification(&self, smoother: SmootherKind, relaxation: f64) -> Vec<f64> {
        let left = self.levels[0].sweep(smoother, relaxation);
        left.iter().map(|(own, crossed)| own.norm().hypot(crossed.norm())).collect()
    }

    /// The smoothing factor: the reduction per sweep of `sweeps` sweeps before each ideal correction.
    pub fn smoothing_factor(&self, smoother: SmootherKind, relaxation: f64, sweeps: usize) -> f64 {
        let left = [self.levels[0].sweep(smoother, relaxation)];
        let cycle = Cycle { levels: &self.levels[..2], sweeps: &left, pre: sweeps, post: 0 };
        self.worst(1, |base| cycle.smoothing(base)).powf(1.0 / sweeps as f64)
    }

    /// The convergence factor of a V-cycle on the levels of the analysis; `shape.coarsest` is not used.
    pub fn convergence_factor(&self, shape: &CycleShape) -> f64 {
        let coarsest = self.levels.len() - 1;
        let on = |level: &Level| level.sweep(shape.smoother, shape.relaxation);
        let sweeps: Vec<_> = self.levels[..coarsest].iter().map(on).collect();
        let cycle = Cycle { levels: &self.levels, sweeps: &sweeps, pre: shape.pre_sweeps, post: shape.post_sweeps };
        self.worst(coarsest, |base| cycle.factor(base))
    }

    /// The largest factor over the frequencies of level `coarsest`. The factors at t and -t are equal.
    fn worst(&self, coarsest: usize, factor: impl Fn([usize; 2]) -> f64) -> f64 {
        let [nx, ny] = self.levels[coarsest].n;
        (0..nx / 2 * ny).map(|i| factor([i % (nx / 2), i / (nx / 2)])).fold(0.0, f64::max)
    }
}
