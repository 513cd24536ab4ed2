//! The diagonal of A: a thin compliant layer. Under a pressure `p_I` it adds `c_I p_I` to the displacement of element I, so that u = A p + c p.
//! It is an elastic foundation (Johnson, Contact Mechanics, section 4.3), here in series with the half-space.
//!
//! The coefficient at offset (0, 0) contains min(c); the operator adds the remaining `c - min(c)` as a diagonal. A preconditioner is a circulant
//! and has one c: see `typical`, and [`Layer::levels`] for a layer that needs several preconditioners.

use std::sync::Arc;

use crate::error::Result;
use crate::grid::Grid;
use crate::memory::collected;

/// The name of the memory of layers in messages.
const LAYER: &str = "the layer";

/// A typical c follows from the geometric mean of `c + s`, where s is MEAN_RESPONSE times the self-influence and stands for the response of the
/// bodies. The smallest eigenvalue of the bodies' A is 0.3 times the self-influence. Measured: with 2 an iteration needs up to a third fewer
/// products than with 0.3, and fewer levels; 1 to 4 differ little.
const MEAN_RESPONSE: f64 = 2.0;
/// The largest ratio of `c + s` at neighbouring levels, unless this takes more than MOST_LEVELS levels. Then the ratio is larger.
const LEVEL_RATIO: f64 = 6.0;
const MOST_LEVELS: f64 = 4.0;

/// A compliant layer: its compliance c on each element, as displacement over pressure.
#[derive(Clone, Debug)]
pub struct Layer {
    /// The smallest c. The coefficient at offset (0, 0) contains it.
    pub(super) least: f64,
    /// The compliance of each element less the smallest one. `None` if c is uniform.
    beyond_least: Option<Arc<Vec<f64>>>,
    /// The c that preconditioners use for all elements.
    pub(super) typical: f64,
    /// The mean of c: the mean displacement of the layer by a uniform pressure of 1.
    pub(super) mean: f64,
}

impl Layer {
    /// A layer with the same compliance c everywhere.
    pub fn uniform(c: f64) -> Layer {
        Layer { least: c, beyond_least: None, typical: c, mean: c }
    }

    /// A layer with one c per element, on bodies with this `self_influence`.
    pub fn per_element(c: &[f64], self_influence: f64) -> Result<Layer> {
        let least = c.iter().copied().fold(f64::INFINITY, f64::min);
        let beyond_least = Some(Arc::new(collected(c.iter().map(|c| c - least), LAYER)?));
        // The geometric mean of the responses of bodies and layer together.
        let response = MEAN_RESPONSE * self_influence;
        let n = c.len() as f64;
        let geometric = (c.iter().map(|c| (c + response).ln()).sum::<f64>() / n).exp();
        Ok(Layer { least, beyond_least, typical: (geometric - response).max(0.0), mean: c.iter().sum::<f64>() / n })
    }

    /// The diagonal `c - min(c)` that the operator adds. `None` if c is uniform.
    pub fn beyond_least(&self) -> Option<&[f64]> {
        self.beyond_least.as_ref().map(|values| &values[..])
    }

    /// The largest c.
    pub fn largest(&self) -> f64 {
        self.least + self.beyond_least().map_or(0.0, |values| values.iter().copied().fold(0.0, f64::max))
    }

    /// Several layers for several preconditioners, each with its own `typical` compliance `c_l`, and the weights of the elements in each:
    ///
    /// ```text
    /// w = sqrt((c_l + s)/(c + s)) sqrt(share),    s the response of the bodies
    /// ```
    ///
    /// The shares of an element on the two levels next to it are linear in log(c + s), and add up to 1. If c is large compared with s, the
    /// bodies' response is negligible, and the sum of `w^2/c_l` over the levels is the wanted `1/c`. A uniform layer is one level, and its
    /// weights are empty.
    pub fn levels(&self, self_influence: f64) -> Result<Vec<(Layer, Vec<f64>)>> {
        let Some(beyond_least) = self.beyond_least() else { return Ok(vec![(self.clone(), Vec::new())]) };
        let response = MEAN_RESPONSE * self_influence;
        let logs = collected(beyond_least.iter().map(|c| (self.least + c + response).ln()), LAYER)?;
        let (low, high) = logs.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), m| (l.min(*m), h.max(*m)));
        let steps = ((high - low) / LEVEL_RATIO.ln()).ceil().min(MOST_LEVELS - 1.0);
        let step = if steps > 0.0 { (high - low) / steps } else { 1.0 };
        let level = |l: usize| {
            let log_here = low + l as f64 * step;
            let typical = (log_here.exp() - response).max(0.0);
            let weight = |m: &f64| (0.5 * (log_here - m)).exp() * (1.0 - (m - log_here).abs() / step).max(0.0).sqrt();
            Ok((Layer { typical, ..self.clone() }, collected(logs.iter().map(weight), LAYER)?))
        };
        (0..=steps as usize).map(level).collect()
    }

    /// The layer on a coarser grid: c is the mean over the fine elements in a coarse one.
    pub fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Layer> {
        let Some(beyond_least) = self.beyond_least() else { return Ok(self.clone()) };
        let mean = |i: usize| {
            let (sum, count) =
                coarse.children(fine, i).fold((0.0, 0.0), |(sum, count), i| (sum + beyond_least[i], count + 1.0));
            sum / count
        };
        Ok(Layer { beyond_least: Some(Arc::new(collected((0..coarse.len()).map(mean), LAYER)?)), ..*self })
    }
}
