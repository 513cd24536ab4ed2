//! `contact_normal_adhesion`, and the results of adhesion.

use super::arguments::{optional, switch, unknown, GivenEffect, Regions};
use super::ledger::copy;
use super::status::Refusal;
use super::structs::versioned;
use crate::adhesion::{Law, Report, Start};
use crate::grid::Grid;
use crate::scene::{Adhesion, Each};

/// `law`: sigma = w/rho exp(-e/rho).
pub const CONTACT_NORMAL_LAW_EXPONENTIAL: i32 = 0;
/// `law`: sigma = w/rho up to e = (1 - smear) rho, then linear to 0 at e = (1 + smear) rho.
pub const CONTACT_NORMAL_LAW_DUGDALE: i32 = 1;
/// `law`: sigma = w/rho (1 - e/(3 rho))^2 up to e = 3 rho, then 0.
pub const CONTACT_NORMAL_LAW_CUBIC: i32 = 2;
/// `law`: sigma = w/rho (1 + e/(2 rho))^-3.
pub const CONTACT_NORMAL_LAW_VAN_DER_WAALS: i32 = 3;

/// `start`: the solve begins on coarser grids, on which the range is longer, with the contact without attraction.
pub const CONTACT_NORMAL_START_AUTO: i32 = 0;
/// `start`: the solve begins at a larger approach and then decreases it, so that elements in contact tend to stay in contact.
pub const CONTACT_NORMAL_START_FROM_CONTACT: i32 = 1;
/// `start`: the solve begins with separated bodies, so that elements come into contact only if no separated state exists nearby.
pub const CONTACT_NORMAL_START_FROM_APART: i32 = 2;

/// Effect: adhesion. The surfaces attract each other across the gap, `p = q - sigma(e)`, with contact pressures q >= 0. Then the scene's force may be
/// negative (a pull). Pressures p are total ones, negative where the attraction is the larger part; `contact` is 1 where e = 0. A work of adhesion of
/// 0 is no adhesion. Several states may belong to one approach: `start` chooses one, and initial_guess PREVIOUS follows the state before. Unstable
/// states may belong to a force; these are not returned. There may also be several stable states of a force, with dF/dapproach > 0. No state is found
/// for a pull stronger than the pull-off force (INFEASIBLE). See docs/adhesion.md.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_adhesion {
    /// Set by `contact_normal_adhesion_init`.
    pub struct_size: i64,
    /// CONTACT_NORMAL_LAW_...; default EXPONENTIAL.
    pub law: i32,
    /// CONTACT_NORMAL_START_...; default AUTO. Read only if the approach is prescribed and initial_guess is NONE.
    pub start: i32,
    /// The work of adhesion w of all elements, an energy per area, >= 0; default 0. Not read if there are `works_of_adhesion`.
    pub work_of_adhesion: f64,
    /// The work of adhesion of each element, `[my][mx]`, or NULL (default).
    pub works_of_adhesion: *const f64,
    /// The range rho of the attraction, a length; default 0: the shortest range that the elements resolve. `report->adhesion.range` has the range
    /// used.
    pub range: f64,
    /// DUGDALE: sigma falls to 0 between (1 - smear) rho and (1 + smear) rho, in [1e-6, 1]; default 0.3.
    pub smear: f64,
    /// 1: `report->adhesion.stiffness` gets dF/dapproach; default 0.
    pub stiffness: i32,
    /// 1: `report->adhesion.stability` gets the stability margin of the state, which takes 10 to 100 products; default 0.
    pub stability: i32,
    /// The shear strength tau0, a traction >= 0; default 0. With friction the traction bound in contact is `mu q + tau0`, where q is the contact
    /// pressure. Not read without friction.
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
    /// The sum of q dx dy, the contact pressures.
    pub repulsive_force: f64,
    /// The sum of -sigma dx dy, <= 0. `repulsive_force` and `adhesive_force` add up to `normal.force`.
    pub adhesive_force: f64,
    /// The sum of 1/2 p u dx dy.
    pub elastic_energy: f64,
    /// The energy of the attraction, <= 0: minus the work that the attraction has done. The derivative of both energies together by the approach is
    /// the force.
    pub adhesive_energy: f64,
    /// `||p + sigma(e)|| / ||p||`, 2-norms with a fresh product, the numerator over the elements outside C. If the status is OK it is at most the
    /// tolerance. If contact pressures and attraction almost cancel, 1e-3 `||q||` replaces the denominator.
    pub law_residual: f64,
    /// The range rho that was used, a length.
    pub range: f64,
    /// kappa: the largest stiffness of the attraction, times an element's influence on itself. Above 1/2 the elements are too coarse for the range,
    /// and the bits of `accuracy.untrusted` are set. Above 1 a single element is unstable and snaps.
    pub resolution: f64,
    /// The part of the attraction that acts on the border of the grid. Above 0.001 the grid is too small for the attraction.
    pub border_share: f64,
    /// dF/dapproach if `adhesion->stiffness` is 1 and the status is OK, else 0. In a scene with two periods it is infinite if all elements are in
    /// contact.
    pub stiffness: f64,
    /// The stability margin 1 - lambda if `adhesion->stability` is 1 and the status is OK, else 0. A change of the attraction outside the contact
    /// moves the surfaces there, which changes the attraction again; lambda is the largest eigenvalue of this feedback. The margin is positive in a
    /// stable state (of a given approach), and near 0 if a small step may cause a snap.
    pub stability: f64,
    /// 1: the bodies have snapped: the branch of the state before (initial_guess PREVIOUS or GIVEN) could not be followed, and the number of elements
    /// in contact has changed by more than a quarter. Else 0.
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
