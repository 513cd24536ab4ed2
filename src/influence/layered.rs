//! Coefficients with a thin compliant layer: `A p + c p`, the layer of element I giving way by `c_I p_I` (Johnson, Contact Mechanics,
//! section 4.3: an elastic foundation, here in series with the half-space).
//!
//! A uniform c is one more coefficient at offset (0, 0). Of one c per element the least is that, and what is more a diagonal that the
//! operator adds. A preconditioner knows one c: see [`Layered::typical`].

use std::sync::Arc;

use super::Influence;
use crate::error::Result;
use crate::grid::Grid;

/// What a compliance is measured against, in self-influences: a layer of less hardly matters. The smallest eigenvalue of A is 0.3.
/// Measured: with 2 an iteration needs up to a third fewer products than with that, and fewer levels; 1 to 4 are much alike.
const SHORT: f64 = 2.0;
/// Levels of c for preconditioners: this factor apart, and so many at most.
const FACTOR: f64 = 6.0;
const MOST_LEVELS: f64 = 4.0;

/// Coefficients and a layer.
#[derive(Clone, Debug)]
pub struct Layered {
    base: Box<Influence>,
    /// The least c.
    least: f64,
    /// What is more, per element; none when c is uniform.
    more: Option<Arc<[f64]>>,
    typical: f64,
}

impl Layered {
    /// Coefficients with a layer of uniform compliance c.
    pub fn uniform(base: Influence, c: f64) -> Layered {
        Layered { base: Box::new(base), least: c, more: None, typical: c }
    }

    /// Coefficients with a layer of one c per element.
    pub fn per_element(base: Influence, c: &[f64]) -> Layered {
        let least = c.iter().copied().fold(f64::INFINITY, f64::min);
        let more: Arc<[f64]> = c.iter().map(|c| c - least).collect();
        // The geometric mean of what waves meet of both.
        let short = SHORT * base.at(0, 0);
        let mean = c.iter().map(|c| (c + short).ln()).sum::<f64>() / c.len() as f64;
        let typical = (mean.exp() - short).max(0.0);
        Layered { base: Box::new(base), least, more: Some(more), typical }
    }

    /// The same layer on other coefficients.
    pub fn on(&self, base: Influence) -> Layered {
        match &self.more {
            None => Layered::uniform(base, self.least),
            Some(more) => {
                let c: Vec<f64> = more.iter().map(|more| more + self.least).collect();
                Layered::per_element(base, &c)
            }
        }
    }

    /// The coefficients without the layer.
    pub fn base(&self) -> &Influence {
        &self.base
    }

    /// What the layer adds to the coefficient at offset (0, 0), everywhere.
    pub fn least(&self) -> f64 {
        self.least
    }

    /// The one c of preconditioners.
    pub fn typical(&self) -> f64 {
        self.typical
    }

    /// What the layer adds to the displacements of single elements: for the operator.
    pub fn more(&self) -> Option<&[f64]> {
        self.more.as_deref()
    }

    /// Levels of c, as coefficients of which each is the [`typical`](Self::typical) one, and the weights of the elements:
    /// `w = sqrt((c_l + s)/(c + s)) sqrt(share)`, with s what waves meet of A and the shares of neighbouring levels linear in
    /// log(c + s). Where c is large A hardly matters, and the first factor makes `w^2/c_l` the 1/c that is asked for.
    pub fn levels(&self) -> Vec<(Influence, Vec<f64>)> {
        let Some(more) = &self.more else { return Vec::new() };
        let short = SHORT * self.base.at(0, 0);
        let meets: Vec<f64> = more.iter().map(|more| (self.least + more + short).ln()).collect();
        let (low, high) = meets.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), m| (l.min(*m), h.max(*m)));
        let steps = ((high - low) / FACTOR.ln()).ceil().min(MOST_LEVELS - 1.0);
        let step = if steps > 0.0 { (high - low) / steps } else { 1.0 };
        let level = |l: usize| {
            let meets_here = low + l as f64 * step;
            let typical = (meets_here.exp() - short).max(0.0);
            let weight =
                |m: &f64| (0.5 * (meets_here - m)).exp() * (1.0 - (m - meets_here).abs() / step).max(0.0).sqrt();
            (Influence::Layered(Layered { typical, ..self.clone() }), meets.iter().map(weight).collect())
        };
        (0..=steps as usize).map(level).collect()
    }

    /// The coefficients times `factor`.
    pub fn times(&self, factor: f64) -> Result<Layered> {
        let more = self.more.as_ref().map(|more| more.iter().map(|more| factor * more).collect());
        let base = Box::new(self.base.times(factor)?);
        Ok(Layered { base, least: factor * self.least, more, typical: factor * self.typical })
    }

    /// The largest compliance.
    pub fn most(&self) -> f64 {
        self.least + self.more().map_or(0.0, |more| more.iter().copied().fold(0.0, f64::max))
    }

    /// The coefficients on a coarser grid: c is the mean over the finer elements.
    pub fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Layered> {
        let base = Box::new(self.base.coarsen(fine, coarse)?);
        let more = self.more.as_ref().map(|more| {
            let span = |i: usize, fine: usize, coarse: usize| {
                let factor = if coarse < fine { 2 } else { 1 };
                factor * i..(factor * (i + 1)).min(fine)
            };
            let mean = |i: usize| {
                let (columns, rows) =
                    (span(i % coarse.mx, fine.mx, coarse.mx), span(i / coarse.mx, fine.my, coarse.my));
                let count = (columns.len() * rows.len()) as f64;
                rows.flat_map(|y| columns.clone().map(move |x| y * fine.mx + x)).map(|i| more[i]).sum::<f64>() / count
            };
            (0..coarse.len()).map(mean).collect()
        });
        Ok(Layered { base, more, ..*self })
    }
}
