//! `contact_normal_adhesion`.

use super::arguments::{optional, switch, unknown, GivenEffect, Regions};
use super::ledger::copy;
use super::status::Refusal;
use super::structs::versioned;
use crate::adhesion::{Law, Report, Start};
use crate::grid::Grid;
use crate::scene::{Adhesion, Each};

/// `law`: sigma = w/rho exp(-e/rho).
pub const CONTACT_NORMAL_LAW_EXPONENTIAL: i32 = 0;
/// `law`: sigma = w/rho up to the range, 0 beyond, the edge smeared over `smear` of the range on both sides.
pub const CONTACT_NORMAL_LAW_DUGDALE: i32 = 1;
/// `law`: sigma = w/rho (1 - e/(3 rho))^2 up to three ranges.
pub const CONTACT_NORMAL_LAW_CUBIC: i32 = 2;
/// `law`: sigma = w/rho (1 + e/(2 rho))^-3.
pub const CONTACT_NORMAL_LAW_VAN_DER_WAALS: i32 = 3;

/// `start`: on coarser grids with longer ranges, from the contact without attraction.
pub const CONTACT_NORMAL_START_AUTO: i32 = 0;
/// `start`: from a larger approach: elements in contact stay in contact.
pub const CONTACT_NORMAL_START_FROM_CONTACT: i32 = 1;
/// `start`: from bodies apart: nothing snaps in before it must.
pub const CONTACT_NORMAL_START_FROM_APART: i32 = 2;

/// Effect: attraction across the gap, `p = q - sigma(e)` with contact pressures q >= 0. The scene's force may then be negative. Pressures
/// are total ones, negative where the bodies pull at each other; `contact` is 1 where e = 0. A work of 0 is no adhesion. Several states may
/// belong to one approach: `start` chooses one, and initial_guess PREVIOUS follows the one before. To a force belong unstable
/// states as well, which are refused, and maybe several stable ones, with dF/dapproach > 0; below the pull-off force none is found
/// (INFEASIBLE). See docs/adhesion.md.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_adhesion {
    /// Set by `contact_normal_adhesion_init`.
    pub struct_size: i64,
    /// CONTACT_NORMAL_LAW_...; default EXPONENTIAL.
    pub law: i32,
    /// CONTACT_NORMAL_START_...; default AUTO. Read where the approach is given and initial_guess is NONE.
    pub start: i32,
    /// w of all elements, an energy per area, >= 0; default 0. Not read if there are `works_of_adhesion`.
    pub work_of_adhesion: f64,
    /// That of each element, `[my][mx]`, or NULL (default).
    pub works_of_adhesion: *const f64,
    /// rho, a length; default 0: the shortest that the elements carry. `report->adhesion.range` says which was used.
    pub range: f64,
    /// DUGDALE: the part of the range over which its edge is smeared, in [1e-6, 1]; default 0.3.
    pub smear: f64,
    /// 1: dF/dapproach, in `report->adhesion.stiffness`; default 0.
    pub stiffness: i32,
    /// 1: how near the state is to a snap, in `report->adhesion.stability`, for 10 to 100 products; default 0.
    pub stability: i32,
    /// tau0, a traction >= 0, default 0: with friction the bound in contact is `mu q + tau0`, q being the contact pressure. Not read without
    /// friction.
    pub shear_strength: f64,
}

versioned! { contact_normal_adhesion, contact_normal_adhesion_init, 64, smear: 0.3 }

impl contact_normal_adhesion {
    /// The caller's arrays must live as long as the result is used.
    pub(super) unsafe fn translate<'a>(&self, grid: &Grid) -> Result<Adhesion<'a>, Refusal> {
        let law = match self.law {
            CONTACT_NORMAL_LAW_EXPONENTIAL => Law::Exponential,
            CONTACT_NORMAL_LAW_DUGDALE => Law::Dugdale(self.smear),
            CONTACT_NORMAL_LAW_CUBIC => Law::Cubic,
            CONTACT_NORMAL_LAW_VAN_DER_WAALS => Law::VanDerWaals,
            other => return unknown("adhesion->law", other, "EXPONENTIAL 0, DUGDALE 1, CUBIC 2 or VAN_DER_WAALS 3"),
        };
        let start = match self.start {
            CONTACT_NORMAL_START_AUTO => Start::Auto,
            CONTACT_NORMAL_START_FROM_CONTACT => Start::Contact,
            CONTACT_NORMAL_START_FROM_APART => Start::Apart,
            other => return unknown("adhesion->start", other, "AUTO 0, FROM_CONTACT 1 or FROM_APART 2"),
        };
        let stiffness = switch("adhesion->stiffness", self.stiffness)?;
        let stability = switch("adhesion->stability", self.stability)?;
        // SAFETY: NULL or one value per element, by the conventions of the ABI.
        let works = unsafe { optional(self.works_of_adhesion, grid.len()) };
        let work = Each::of(works, self.work_of_adhesion);
        let (range, shear_strength) = (self.range, self.shear_strength);
        Ok(Adhesion { law, work, range, start, stiffness, stability, shear_strength })
    }
}

impl GivenEffect for contact_normal_adhesion {
    fn add_to(&self, regions: &mut Regions, grid: &Grid) -> Result<(), Refusal> {
        regions.input("adhesion->works_of_adhesion", self.works_of_adhesion, grid.len())
    }
}

/// The results of adhesion: a group of `contact_normal_report`. Without adhesion all is 0.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct contact_normal_report_adhesion {
    /// The sum of contact pressures q dx dy.
    pub repulsive_force: f64,
    /// The sum of -sigma dx dy: <= 0. Both together are `normal.force`.
    pub adhesive_force: f64,
    /// The sum of 1/2 p u dx dy.
    pub elastic_energy: f64,
    /// Less the work that the attraction has done: <= 0. The change of both energies by the approach is the force.
    pub adhesive_energy: f64,
    /// `||p + sigma(e)|| / ||p||`, the first outside C, 2-norms, with a fresh product. It is at most the tolerance, as the
    /// residual is. Where contact pressures and attraction cancel, the scale is 1e-3 `||q||`.
    pub law_residual: f64,
    /// rho as it was used, a length.
    pub range: f64,
    /// kappa: the largest stiffness of the attraction, times what an element displaces itself by. Above 1/2 the elements are too coarse for
    /// the range, and the bits of `accuracy.untrusted` are set; above 1 an element snaps alone.
    pub resolution: f64,
    /// The part of the attraction that acts on the border of the grid: the grid does not contain it where that is more than 0.001.
    pub border_share: f64,
    /// dF/dapproach if `adhesion->stiffness` is 1 and the status is OK, else 0. Infinite where all elements of two periods are in contact.
    pub stiffness: f64,
    /// 1 - lambda if `adhesion->stability` is 1 and the status is OK, else 0; lambda is the largest eigenvalue of how a change of the attraction outside the
    /// contact comes back to itself. Positive in a stable state (of a given approach), near 0 where a small step may snap.
    pub stability: f64,
    /// 1: the bodies have snapped: the state before (initial_guess PREVIOUS or GIVEN) could not be followed, and the elements in contact
    /// are more, or fewer, by more than a quarter; else 0.
    pub jumped: i32,
    /// Always 0.
    pub reserved_integer: i32,
    /// Room for later versions: 0.
    pub reserved: [f64; 5],
}

impl contact_normal_report_adhesion {
    pub(super) fn set(&mut self, found: &Report) {
        copy!(found => self: repulsive_force, adhesive_force, elastic_energy, adhesive_energy);
        copy!(found => self: law_residual, range, resolution, border_share);
        (self.stiffness, self.stability) = (found.stiffness.unwrap_or(0.0), found.stability.unwrap_or(0.0));
        self.jumped = i32::from(found.jumped);
    }
}
