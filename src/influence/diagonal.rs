//! The diagonal of A: a thin compliant layer, `A p + c p`, whose displacement at element I is `c_I p_I` (Johnson, Contact Mechanics,
//! section 4.3: an elastic foundation, here in series with the half-space).
//!
//! min(c) is added to the coefficient at offset (0, 0); the operator adds `c - min(c)` as a diagonal. A preconditioner has one c: see
//! `typical` and [`Layer::levels`].

use std::sync::Arc;

use crate::error::Result;
use crate::grid::Grid;
use crate::memory::collected;

/// The name of this memory in messages.
const LAYER: &str = "the layer";

/// Means over c are geometric means of c plus this response of A, in units of the self-influence. The smallest
/// eigenvalue of A is 0.3. Measured: with 2 an iteration needs up to a third fewer products than with 0.3, and fewer
/// levels; 1 to 4 differ little.
const MEAN_RESPONSE: f64 = 2.0;
/// The ratio of neighbouring levels of c for preconditioners, and the most levels.
const LEVEL_RATIO: f64 = 6.0;
const MOST_LEVELS: f64 = 4.0;

/// A compliant layer.
#[derive(Clone, Debug)]
pub struct Layer {
    /// The least c, which the coefficient at offset (0, 0) contains.
    pub(super) least: f64,
    /// The compliance beyond the least, per element; none if c is uniform.
    more: Option<Arc<Vec<f64>>>,
    /// The c of preconditioners.
    pub(super) typical: f64,
    /// The mean c, the response to a uniform pressure.
    pub(super) mean: f64,
}

impl Layer {
    /// A layer of uniform compliance c.
    pub fn uniform(c: f64) -> Layer {
        Layer { least: c, more: None, typical: c, mean: c }
    }

    /// A layer of one c per element, on coefficients with this `self_influence`.
    pub fn per_element(c: &[f64], self_influence: f64) -> Result<Layer> {
        let least = c.iter().copied().fold(f64::INFINITY, f64::min);
        let more = Some(Arc::new(collected(c.iter().map(|c| c - least), LAYER)?));
        // The geometric mean of the responses of A and the layer together.
        let short = MEAN_RESPONSE * self_influence;
        let n = c.len() as f64;
        let geometric = (c.iter().map(|c| (c + short).ln()).sum::<f64>() / n).exp();
        Ok(Layer { least, more, typical: (geometric - short).max(0.0), mean: c.iter().sum::<f64>() / n })
    }

    /// The diagonal that the operator adds to the displacements of single elements.
    pub fn more(&self) -> Option<&[f64]> {
        self.more.as_ref().map(|more| &more[..])
    }

    /// The largest compliance.
    pub fn most(&self) -> f64 {
        self.least + self.more().map_or(0.0, |more| more.iter().copied().fold(0.0, f64::max))
    }

    /// Levels c_l of c, each as the `typical` c of a layer, with the weights `w = sqrt((c_l + s)/(c + s)) sqrt(share)` of the elements. s is
    /// the response of A; the shares of neighbouring levels are linear in log(c + s). If c is large, A is negligible and the first factor
    /// makes `w^2/c_l` the wanted 1/c. A uniform layer is one level without weights.
    pub fn levels(&self, self_influence: f64) -> Result<Vec<(Layer, Vec<f64>)>> {
        let Some(more) = self.more() else { return Ok(vec![(self.clone(), Vec::new())]) };
        let short = MEAN_RESPONSE * self_influence;
        let meets = collected(more.iter().map(|more| (self.least + more + short).ln()), LAYER)?;
        let (low, high) = meets.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), m| (l.min(*m), h.max(*m)));
        let steps = ((high - low) / LEVEL_RATIO.ln()).ceil().min(MOST_LEVELS - 1.0);
        let step = if steps > 0.0 { (high - low) / steps } else { 1.0 };
        let level = |l: usize| {
            let meets_here = low + l as f64 * step;
            let typical = (meets_here.exp() - short).max(0.0);
            let weight =
                |m: &f64| (0.5 * (meets_here - m)).exp() * (1.0 - (m - meets_here).abs() / step).max(0.0).sqrt();
            Ok((Layer { typical, ..self.clone() }, collected(meets.iter().map(weight), LAYER)?))
        };
        (0..=steps as usize).map(level).collect()
    }

    /// The layer of a coarser grid: c is the mean over the finer elements.
    pub fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Layer> {
        let Some(more) = self.more() else { return Ok(self.clone()) };
        let mean = |i: usize| {
            let (sum, count) =
                coarse.children(fine, i).fold((0.0, 0.0), |(sum, count), i| (sum + more[i], count + 1.0));
            sum / count
        };
        Ok(Layer { more: Some(Arc::new(collected((0..coarse.len()).map(mean), LAYER)?)), ..*self })
    }
}
