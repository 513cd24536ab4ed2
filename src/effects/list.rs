//! The one list of all effects, with one line for each.

/// Passes the list to the macro `$then`. The order matters: the first effect of a scene that has a kernel determines the influence coefficients. Then
/// patches and the layer change these coefficients, in the order of the list.
macro_rules! with_effects {
    ($then:ident) => {
        $then! {
            /// Effect: the caller's influence coefficients instead of the half-space's.
            influence: $crate::influence::Table,
            /// Effect: the caller's influence coefficients, one table per loaded row.
            row_tables: $crate::influence::RowTables,
            /// Effect: bonded elastic layers on the bodies.
            coating: $crate::effects::Coating,
            /// Effect: the scene is periodic in x, in y or in both.
            period: $crate::effects::Period,
            /// Effect: several contact patches, with factors on the influence of each patch on the others.
            patches: $crate::effects::Patches<'a>,
            /// Effect: a thin compliant layer between the bodies.
            layer: $crate::effects::Layer<'a>,
            /// Effect: pressures do not exceed a limit.
            pressure_limit: $crate::effects::PressureLimit<'a>,
            /// Effect: friction between the bodies.
            friction: $crate::effects::Friction<'a>,
            /// Effect: attraction between the bodies.
            adhesion: $crate::effects::Adhesion<'a>,
            /// Effect: viscoelastic bodies, and a step in time.
            visco: $crate::effects::Visco<'a>,
            /// Effect, in tests only: a foundation whose displacements depend on earlier steps.
            #[cfg(test)]
            foundation: $crate::effects::Foundation,
        }
    };
}
pub(crate) use with_effects;
