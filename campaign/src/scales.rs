//! The scales of a scene's distances and pressures, and random pressure limits relative to these scales.

use crate::effects::{Effects, Values};
use crate::grid::{Grid, Load};
use crate::operator::Operator;
use crate::random::Random;

/// The scales of a scene's distances and pressures.
pub struct Scales {
    /// The smallest undeformed distance.
    pub lowest: f64,
    /// The difference between the largest and the smallest undeformed distance. For a flat surface: 1e-3 of the grid's size.
    pub depth: f64,
    /// A pressure whose displacements are of the order of `depth`.
    pub pressure: f64,
}

impl Scales {
    /// The scales of a surface on bodies with the compliance `c = 1/(pi E*)`.
    pub fn of(h: &[f64], effects: &Effects, grid: &Grid, c: f64) -> Scales {
        let finite = || h.iter().copied().filter(|h| h.is_finite());
        let (lowest, highest) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        let self_influence = Operator::new(grid, c, effects).diagonal();
        let size = (grid.mx as f64 * grid.dx).max(grid.my as f64 * grid.dy);
        let depth = if highest > lowest { highest - lowest } else { 1e-3 * size };
        Scales { lowest, depth, pressure: depth / (self_influence * (grid.len() as f64).sqrt()) }
    }
}

/// A random pressure limit: one for all elements, or one for each. If a force is prescribed, the limit is chosen so that the force is 5 % to 110 % of
/// the largest force that the limit allows.
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
