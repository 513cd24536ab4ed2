//! The request of a solve: scene, options and start.

use super::{Guess, Options};
use crate::error::Result;
use crate::scene::Scene;
use crate::threads::Threads;

/// What a solve is asked for.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'a> {
    /// The scene. Its effects, distance and load are checked.
    pub scene: &'a Scene<'a>,
    /// The least undeformed distance of the scene; infinite if no element has a surface.
    pub lowest: f64,
    /// The options.
    pub options: &'a Options,
    /// The caller's pressures and contact area, if given.
    pub guess: Option<Guess<'a>>,
    /// Whether the surface ends exactly on edges of elements. Read by error estimates only.
    pub exact_edges: bool,
    /// Whether the surface has no jumps between two centres. Read by error estimates only.
    pub exact_jumps: bool,
}

impl<'a> Asked<'a> {
    /// A request without a guess. The surface may end and jump anywhere between the centres of elements.
    pub fn new((scene, lowest): (&'a Scene<'a>, f64), options: &'a Options) -> Asked<'a> {
        Asked { scene, lowest, options, guess: None, exact_edges: false, exact_jumps: false }
    }

    /// The guess, if the caller prescribes its contact area (FIXED).
    pub fn area(&self) -> Option<Guess<'a>> {
        self.guess.filter(|_| self.options.is_fixed())
    }

    /// Replaces the scene of the request by one with another undeformed distance, which is checked here. None: the request is unchanged.
    pub fn on<'s>(self, scene: Option<&'s Scene<'s>>, threads: &Threads) -> Result<Asked<'s>>
    where
        'a: 's,
    {
        let Some(scene) = scene else { return Ok(self) };
        Ok(Asked { scene, lowest: scene.check_distance_and_load(threads)?, ..self })
    }
}
