//! The scene: grid, distance, bodies and load, and one optional field for each effect.

use super::{Bodies, Load, Plain};
use crate::effects::list::with_effects;
use crate::effects::Adhesion;
use crate::grid::Grid;

/// Defines the scene with a field for each effect of the [list](crate::effects).
macro_rules! define_scene {
    ($($(#[doc = $doc:literal])+ $(#[cfg($when:meta)])? $name:ident: $effect:ty,)+) => {
        /// One contact problem: `e = h - approach + A p`.
        #[derive(Clone, Debug)]
        pub struct Scene<'a> {
            /// The potential contact area.
            pub grid: Grid,
            /// h, `[my][mx]`. An element with `+infinity` has no surface and is never in contact.
            pub undeformed_distance: &'a [f64],
            /// Elasticity of the two bodies.
            pub bodies: Bodies,
            /// Prescribed approach or prescribed force.
            pub load: Load,
            $($(#[doc = $doc])+ $(#[cfg($when)])? pub $name: Option<$effect>,)+
        }

        impl<'a> Scene<'a> {
            /// A scene without effects.
            pub fn new(grid: Grid, undeformed_distance: &'a [f64], bodies: Bodies, load: Load) -> Scene<'a> {
                Scene { grid, undeformed_distance, bodies, load, $($(#[cfg($when)])? $name: None,)+ }
            }
        }
    };
}

with_effects!(define_scene);

impl<'a> Scene<'a> {
    /// The adhesion, if its work is not 0 everywhere.
    pub fn attraction(&self) -> Option<&Adhesion<'a>> {
        self.adhesion.as_ref().filter(|adhesion| adhesion.attracts())
    }

    /// The scene without its effects.
    pub fn plain(&self) -> Plain<'a> {
        let Scene { grid, undeformed_distance, bodies, load, .. } = *self;
        Plain { grid, undeformed_distance, bodies, load }
    }
}
