//! The start of a solve without a state.

/// The start of a solve without a state: several states may belong to one approach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// On coarser grids with longer ranges, from the contact without attraction.
    #[default]
    Auto,
    /// From a larger approach: elements in contact stay so.
    Contact,
    /// From bodies apart: elements do not snap in before they must.
    Apart,
}
