//! The scales of the numbers of a scene, and a limit of the pressures by them.

use crate::effects::{Effects, Values};
use crate::grid::{Grid, Load};
use crate::operator::Operator;
use crate::random::Random;

/// The scales of a scene's distances and pressures.
pub struct Scales {
    pub lowest: f64,
    /// The difference of the highest and the lowest point, or a length for a flat surface.
    pub depth: f64,
    pub pressure: f64,
}

impl Scales {
    pub fn of(h: &[f64], effects: &Effects, grid: &Grid, c: f64) -> Scales {
        let finite = || h.iter().copied().filter(|h| h.is_finite());
        let (lowest, highest) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        let own = Operator::new(grid, c, effects).diagonal();
        let size = (grid.mx as f64 * grid.dx).max(grid.my as f64 * grid.dy);
        let depth = if highest > lowest { highest - lowest } else { 1e-3 * size };
        Scales { lowest, depth, pressure: depth / (own * (grid.len() as f64).sqrt()) }
    }
}

/// A limit. With a force the limit is such that the force is a part of the greatest one, mostly nearly all of it.
pub fn limit(random: &mut Random, scales: &Scales, load: Load, h: &[f64], grid: &Grid) -> Values {
    let shape: Vec<f64> = match random.chance(0.5) {
        true => vec![1.0; grid.len()],
        false => (0..grid.len()).map(|_| random.between(0.5, 1.5)).collect(),
    };
    let uniform = shape.iter().all(|&s| s == 1.0);
    let size = match load {
        Load::Force(force) if force > 0.0 => {
            let carried: f64 = (0..h.len()).filter(|&i| h[i].is_finite()).map(|i| shape[i]).sum();
            let part = random.pick(&[0.05, 0.3, 0.7, 0.95, 0.9999, 1.0, 1.1]);
            force / (part * carried * grid.element_area())
        }
        _ => scales.pressure * random.decades(0.05, 20.0),
    };
    if uniform {
        return Values::Uniform(if random.chance(0.05) { f64::INFINITY } else { size });
    }
    Values::PerElement(shape.iter().map(|s| s * size).collect())
}
