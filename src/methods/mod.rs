//! The methods, each whole in its folder.

pub mod descent;
pub mod direct;
pub mod multigrid;
pub mod norm;
pub mod projected_cg;
