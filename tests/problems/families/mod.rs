//! The families of hard cases. Each file has the cases of one family, which docs/reliability_table.md lists, too, and the tests of what the library
//! promises for them.

pub mod case;
pub mod certificate;
pub mod coefficients;
pub mod contact_areas;
pub mod cycling;
pub mod grids;
pub mod guesses;
pub mod loads;
pub mod materials;
pub mod stops;
pub mod surfaces;
pub mod units;

pub use case::Case;

/// Every case of every family.
#[allow(dead_code)] // for docs/reliability_table.md
pub fn all() -> Vec<(&'static str, Vec<Case>)> {
    vec![
        ("contact areas", contact_areas::cases()),
        ("surfaces", surfaces::cases()),
        ("grids", grids::cases()),
        ("materials", materials::cases()),
        ("units", units::cases()),
        ("loads", loads::cases()),
        ("guesses and stops", [guesses::cases(), stops::cases()].concat()),
        ("the caller's coefficients", coefficients::cases()),
        ("an exchange that cycles", cycling::cases()),
        ("coefficients of no elastic body", coefficients::indefinite()),
    ]
}
