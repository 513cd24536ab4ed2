//! The families of hard cases. Each file has its cases, for docs/reliability.md as well, and what is promised of them.

pub mod case;
pub mod certificate;
pub mod contact_areas;
pub mod grids;
pub mod surfaces;

pub use case::Case;

/// Every case of every family.
pub fn all() -> Vec<(&'static str, Vec<Case>)> {
    vec![
        ("contact areas", contact_areas::cases()),
        ("surfaces", surfaces::cases()),
        ("grids", grids::cases()),
    ]
}
