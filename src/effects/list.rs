//! The one list of effects: a line for each.

/// Passes the list to the macro `$then`. The first effect with a kernel determines the kernel. The effects after those with a kernel change its
/// coefficients in the order of the list.
macro_rules! with_effects {
    ($then:ident) => {
        $then! {
            /// Effect: own coefficients instead of the half-space.
            influence: $crate::influence::Table,
            /// Effect: own coefficients, one table per loaded row.
            row_tables: $crate::influence::RowTables,
            /// Effect: bonded elastic layers on the bodies.
            coating: $crate::effects::Coating,
            /// Effect: the scene repeats itself.
            period: $crate::effects::Period,
            /// Effect: several contact patches, whose interaction is scaled.
            patches: $crate::effects::Patches<'a>,
            /// Effect: a thin compliant layer.
            layer: $crate::effects::Layer<'a>,
            /// Effect: pressures do not exceed a limit.
            pressure_limit: $crate::effects::PressureLimit<'a>,
            /// Effect: friction between the bodies.
            friction: $crate::effects::Friction<'a>,
            /// Effect: attraction between the bodies.
            adhesion: $crate::effects::Adhesion<'a>,
            /// Effect: bodies that relax.
            visco: $crate::effects::Visco<'a>,
            /// Effect, in tests only: a foundation with memory.
            #[cfg(test)]
            foundation: $crate::effects::Foundation,
        }
    };
}
pub(crate) use with_effects;
