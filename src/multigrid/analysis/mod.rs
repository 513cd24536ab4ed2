//! Local Fourier analysis.

mod harmonics;
mod level;
mod spectral_radius;
mod symbol;

pub use symbol::{Symbol, Value};

use super::{CycleShape, SmootherKind};
use crate::error::{invalid, require, Result};
use harmonics::Cycle;
use level::{frequency, Level};

/// The analysis of cycles on the inner part of a contact area.
pub struct Analysis {
    levels: Vec<Level>,
}

impl Analysis {
    /// Elements `dx` by `dy`, `across` of them across the contact area in x and y; `levels` grids: 2 for the two-grid
    /// factor. The frequencies are `pi (2 j + 1)/n` with `n = 2 across`, rounded up to a multiple of `2^levels`.
    pub fn new(dx: f64, dy: f64, across: [usize; 2], levels: usize) -> Result<Analysis> {
        for (name, d) in [("dx", dx), ("dy", dy)] {
            require(d > 0.0 && d.is_finite(), name, d, "an element size must be positive and finite")?;
        }
        if !(0.5..=2.0).contains(&(dx / dy)) {
            return invalid(format!("dx/dy is {}; between 1/2 and 2 both directions are coarsened", dx / dy));
        }
        if !(2..=6).contains(&levels) {
            return invalid(format!("levels is {levels}; the analysis needs 2 grids at least, and 6 at most"));
        }
        if across.iter().any(|&across| across == 0 || across > 1 << 12) {
            return invalid(format!("across is {across:?}; from 1 to 4096 elements can be analysed"));
        }
        let n = across.map(|across| (2 * across).next_multiple_of(1 << levels));
        let on = |l: usize| {
            let scale = (1 << l) as f64;
            Level::new(scale * dx, scale * dy, n.map(|n| n >> l))
        };
        Ok(Analysis { levels: (0..levels).map(on).collect() })
    }

    /// The frequencies of the finest grid in x and in y, from 0 to 2 pi.
    pub fn frequencies(&self) -> [Vec<f64>; 2] {
        self.levels[0].n.map(|n| (0..n).map(|j| frequency(j, n)).collect())
    }

    /// A(t) over c(0, 0) on the finest grid, `[jy][jx]`.
    pub fn symbol(&self) -> Vec<f64> {
        self.levels[0].values.iter().map(|value| value.whole / self.levels[0].diagonal).collect()
    }

    /// The norm of what one sweep leaves of each wave of the finest grid, `[jy][jx]`.
    pub fn amplification(&self, smoother: SmootherKind, relaxation: f64) -> Vec<f64> {
        let left = self.levels[0].sweep(smoother, relaxation);
        left.iter().map(|(own, crossed)| own.norm().hypot(crossed.norm())).collect()
    }

    /// The smoothing factor: the reduction, per sweep, of what the next grid does not see, if what it sees is removed
    /// exactly after every `sweeps` sweeps.
    pub fn smoothing_factor(&self, smoother: SmootherKind, relaxation: f64, sweeps: usize) -> f64 {
        let sweep = [self.levels[0].sweep(smoother, relaxation)];
        let cycle = Cycle { levels: &self.levels[..2], sweeps: &sweep, pre: sweeps, post: 0 };
        self.worst(1, |base| cycle.smoothing(base, sweeps)).powf(1.0 / sweeps as f64)
    }

    /// The convergence factor of a cycle, `shape.coarsest` apart: it has the levels of the analysis.
    pub fn convergence_factor(&self, shape: &CycleShape) -> f64 {
        let (_, finer) = self.levels.split_last().expect("two levels at least");
        let sweeps: Vec<_> = finer.iter().map(|level| level.sweep(shape.smoother, shape.relaxation)).collect();
        let cycle =
            Cycle { levels: &self.levels, sweeps: &sweeps, pre: shape.pre_sweeps, post: shape.post_sweeps };
        self.worst(self.levels.len() - 1, |base| cycle.factor(base))
    }

    /// The largest factor over the frequencies of level `coarsest`. That of -t is that of t.
    fn worst(&self, coarsest: usize, factor: impl Fn([usize; 2]) -> f64) -> f64 {
        let [nx, ny] = self.levels[coarsest].n;
        (0..nx / 2 * ny).map(|i| factor([i % (nx / 2), i / (nx / 2)])).fold(0.0, f64::max)
    }
}
