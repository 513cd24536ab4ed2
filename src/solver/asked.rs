//! The request of a solve.

use super::{Guess, Options};
use crate::error::Result;
use crate::scene::Scene;
use crate::threads::Threads;

/// The request of a solve.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'a> {
    /// The scene, which is checked.
    pub scene: &'a Scene<'a>,
    /// Its least undeformed distance.
    pub lowest: f64,
    /// The options.
    pub options: &'a Options,
    /// The caller's pressures and contact area.
    pub guess: Option<Guess<'a>>,
    /// For estimates: whether all edges of the surface are at edges of elements.
    pub exact_edges: bool,
    /// For estimates: whether it has no jumps.
    pub exact_jumps: bool,
}

impl<'a> Asked<'a> {
    /// A solve without a guess, of a surface that may end anywhere.
    pub fn new((scene, lowest): (&'a Scene<'a>, f64), options: &'a Options) -> Asked<'a> {
        Asked { scene, lowest, options, guess: None, exact_edges: false, exact_jumps: false }
    }

    /// The guess, if it gives the contact area.
    pub fn area(&self) -> Option<Guess<'a>> {
        self.guess.filter(|_| self.options.is_fixed())
    }

    /// The request with `scene`, whose undeformed distance differs and is checked here. Without a scene, the request is unchanged.
    pub fn on<'s>(self, scene: Option<&'s Scene<'s>>, threads: &Threads) -> Result<Asked<'s>>
    where
        'a: 's,
    {
        let Some(scene) = scene else { return Ok(self) };
        Ok(Asked { scene, lowest: scene.check_distance_and_load(threads)?, ..self })
    }
}
