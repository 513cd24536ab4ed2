//! What couples the normal and the tangential problem of unlike bodies, on one grid: see [`Coupling`].

use crate::contact::State;
use crate::effects::{Friction, Motion, Previous};
use crate::error::Result;
use crate::friction::{Coupling, Source, Vector};
use crate::grid::Grid;
use crate::memory::zeros;
use crate::threads::Threads;

/// What memory is for.
const FIELDS: &str = "the coupling of unlike bodies";

/// Both products, and what they displace.
pub struct Coupled {
    source: Source,
    here: Coupling,
    /// Of rolling: at the places before the step, which are so many elements away.
    there: Option<((f64, f64), Coupling)>,
    sideways: Vec<Vector>,
    along_normal: Vec<f64>,
    /// The scene's own undeformed distance, a copy, and the one with what tractions displace.
    own: Vec<f64>,
    displaced: Vec<f64>,
    /// Pressures of the last step.
    last_pressure: Vec<f64>,
}

/// Which pressures there were before a step.
enum Before {
    /// None: from rest.
    None,
    /// Those of now: in steady rolling, and where tractions are given.
    Same,
    /// Those of the last result.
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

impl Coupled {
    /// On a grid.
    pub fn new(grid: &Grid, source: Source, threads: &Threads) -> Result<Coupled> {
        let n = grid.len();
        Ok(Coupled {
            here: Coupling::new(grid, &source, (0.0, 0.0), threads)?,
            source,
            there: None,
            sideways: zeros(n, FIELDS)?,
            along_normal: zeros(n, FIELDS)?,
            own: zeros(n, FIELDS)?,
            displaced: zeros(n, FIELDS)?,
            last_pressure: zeros(n, FIELDS)?,
        })
    }

    /// The last pressures are those of another one.
    pub fn take_last_of(&mut self, other: &mut Coupled) {
        std::mem::swap(&mut self.last_pressure, &mut other.last_pressure);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let there = self.there.as_ref().map_or(0, |(_, there)| there.bytes());
        let fields = size_of::<Vector>() + 4 * size_of::<f64>();
        self.source.bytes() + self.here.bytes() + there + self.own.len() * fields
    }

    /// What the last pressures displace sideways.
    pub fn sideways(&self) -> &[Vector] {
        &self.sideways
    }

    /// The sideways displacements by pressures p, less those before the step: from rest none; where tractions are given, the pressures
    /// before were the same.
    pub fn displace(&mut self, grid: &Grid, friction: &Friction<'_>, p: &[f64], threads: &Threads) -> Result<()> {
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

    /// Adds by how much the last [sideways displacements](Coupled::displace) change where the pressures change by dp.
    pub fn add_change(&mut self, friction: &Friction<'_>, dp: &[f64], to: &mut [Vector]) {
        match (Before::of(friction), friction.motion) {
            // Both changes are the same.
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

    /// The displacements along the normal by tractions.
    pub fn along_normal(&mut self, traction: &[Vector], to: &mut [f64]) {
        self.here.along_normal(traction, to);
    }

    /// The distance of a scene whose normal problem is solved: a copy, for a callback may change the caller's.
    pub fn take_distance(&mut self, h: &[f64]) {
        self.own.copy_from_slice(h);
    }

    /// The undeformed distance with what the tractions displace along the normal, and by how much that has changed where pressures act (in C and
    /// at a limit): rms relative to `h - approach`. No change at all: none on the whole grid.
    pub fn distance(&mut self, traction: &[Vector], state: &State) -> (&[f64], Option<f64>) {
        let Coupled { here, along_normal, own, displaced, .. } = self;
        here.along_normal(traction, along_normal);
        let (mut changes, mut distances, mut differs) = (0.0, 0.0, false);
        for i in 0..along_normal.len() {
            displaced[i] = own[i] + along_normal[i];
            // One element alone displaces others, not itself.
            differs |= displaced[i] != state.h[i];
            if state.touches(i) {
                changes += (displaced[i] - state.h[i]).powi(2);
                distances += (state.h[i] - state.approach).powi(2);
            }
        }
        let change = if changes == 0.0 { 0.0 } else { (changes / distances).sqrt() };
        (&displaced[..], differs.then_some(change))
    }

    /// The step is done: the next one may continue from its pressures.
    pub fn keep_pressures(&mut self, p: &[f64]) {
        self.last_pressure.copy_from_slice(p);
    }
}
