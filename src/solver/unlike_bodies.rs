//! The coupling of the normal and the tangential problem of unlike bodies: pressures displace the surfaces sideways, tractions displace them along
//! the normal. [`Coupling`] has the products.

use crate::effects::{Friction, Motion, Previous};
use crate::error::Result;
use crate::friction::{Coupling, Source, Vector};
use crate::grid::Grid;
use crate::memory::zeros;
use crate::threads::Threads;

/// The name of these arrays in messages.
const FIELDS: &str = "the coupling of unlike bodies";

/// The products of the coupling, and the displacements that they give.
pub struct UnlikeBodies {
    /// The coefficients of the coupling.
    source: Source,
    /// The product at the centres of the elements.
    here: Coupling,
    /// In rolling, the product at the places of the particles before the step, and the offset of these places in elements.
    there: Option<((f64, f64), Coupling)>,
    /// The last sideways displacements.
    sideways: Vec<Vector>,
    /// The last displacements along the normal.
    along_normal: Vec<f64>,
    /// The pressures at the end of the last step.
    last_pressure: Vec<f64>,
}

/// Which pressures acted before a step.
enum Before {
    /// None: the step starts from rest.
    None,
    /// The same as in the step: in steady rolling, and if the caller gives the previous tractions.
    Same,
    /// Those at the end of the last step.
    Last,
}

impl Before {
    fn of(friction: &Friction<'_>) -> Before {
        match (friction.motion, friction.previous) {
            (Motion::SteadyRolling, _) | (_, Previous::Given(_)) => Before::Same,
            (_, Previous::None) => Before::None,
            (_, Previous::Kept) => Before::Last,
        }
    }
}

impl UnlikeBodies {
    /// Sets up the coupling on a grid.
    pub fn new(grid: &Grid, source: Source, threads: &Threads) -> Result<UnlikeBodies> {
        let n = grid.len();
        Ok(UnlikeBodies {
            here: Coupling::new(grid, &source, (0.0, 0.0), threads)?,
            source,
            there: None,
            sideways: zeros(n, FIELDS)?,
            along_normal: zeros(n, FIELDS)?,
            last_pressure: zeros(n, FIELDS)?,
        })
    }

    /// Takes over the pressures of the last step from a coupling with other coefficients.
    pub fn take_last_of(&mut self, other: &mut UnlikeBodies) {
        std::mem::swap(&mut self.last_pressure, &mut other.last_pressure);
    }

    /// The pressures of the last step.
    pub fn last_pressure(&self) -> &[f64] {
        &self.last_pressure
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let there = self.there.as_ref().map_or(0, |(_, there)| there.bytes());
        let fields = size_of::<Vector>() + 2 * size_of::<f64>();
        self.source.bytes() + self.here.bytes() + there + self.along_normal.len() * fields
    }

    /// The result of the last [`displace_sideways`](UnlikeBodies::displace_sideways).
    pub fn sideways(&self) -> &[Vector] {
        &self.sideways
    }

    /// Computes how far the surfaces are displaced sideways in a step: the displacements by pressures p, less those by the pressures before the step.
    /// In rolling the latter are taken at the places of the particles before the step.
    pub fn displace_sideways(
        &mut self,
        grid: &Grid,
        friction: &Friction<'_>,
        p: &[f64],
        threads: &Threads,
    ) -> Result<()> {
        self.sideways.fill([0.0; 2]);
        self.here.add_sideways(p, 1.0, &mut self.sideways);
        let before = match Before::of(friction) {
            Before::None => return Ok(()),
            Before::Same => p,
            Before::Last => &self.last_pressure,
        };
        if friction.motion == Motion::Shift {
            self.here.add_sideways(before, -1.0, &mut self.sideways);
            return Ok(());
        }
        let by = friction.elements_rolled(grid);
        if !self.there.as_ref().is_some_and(|(known, _)| *known == by) {
            self.there = Some((by, Coupling::new(grid, &self.source, by, threads)?));
        }
        if let Some((_, there)) = &mut self.there {
            there.add_sideways(before, -1.0, &mut self.sideways);
        }
        Ok(())
    }

    /// Adds to `to` the change of the [sideways displacements](UnlikeBodies::displace_sideways) if the pressures of the step change by dp.
    pub fn add_change(&mut self, friction: &Friction<'_>, dp: &[f64], to: &mut [Vector]) {
        match (Before::of(friction), friction.motion) {
            // The pressures before the step change by dp as well, so both changes cancel.
            (Before::Same, Motion::Shift) => {}
            (Before::Same, _) => {
                self.here.add_sideways(dp, 1.0, to);
                if let Some((_, there)) = &mut self.there {
                    there.add_sideways(dp, -1.0, to);
                }
            }
            (Before::None | Before::Last, _) => self.here.add_sideways(dp, 1.0, to),
        }
    }

    /// Writes the displacements along the normal by tractions to `to`.
    pub fn along_normal(&mut self, traction: &[Vector], to: &mut [f64]) {
        self.here.along_normal(traction, to);
    }

    /// Adds the displacements along the normal by tractions to an undeformed distance.
    pub fn displace(&mut self, traction: &[Vector], distance: &mut [f64]) {
        let UnlikeBodies { here, along_normal, .. } = self;
        here.along_normal(traction, along_normal);
        distance.iter_mut().zip(along_normal).for_each(|(distance, displaced)| *distance += *displaced);
    }

    /// Keeps the pressures of a finished step for the next one.
    pub fn keep_pressures(&mut self, p: &[f64]) {
        self.last_pressure.copy_from_slice(p);
    }
}
