//! `contact_normal_frictional_wear`: frictional work and wear from tractions and slips.

use super::arguments::{copy_to, count, optional, required, Regions};
use super::guard::guard;
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::structs::{self, versioned};
use crate::effects::Each;
use crate::grid::Grid;
use crate::wear::{frictional_wear, Wear, Worn};

/// The tractions and slips of a solve with friction, and the constants of wear. The depth of wear is K/H times the frictional work per area, or K/H p
/// |s|.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_wear {
    /// Set by `contact_normal_wear_init`.
    pub struct_size: i64,
    /// Elements in x. Default 0: to be set.
    pub mx: i32,
    /// Elements in y. Default 0: to be set.
    pub my: i32,
    /// Element size in x. Default 0: to be set.
    pub dx: f64,
    /// Element size in y. Default 0: to be set.
    pub dy: f64,
    /// The tractions q on body 1 in x and in y, `[my][mx]` each, as in `fields->traction`. Default NULL: to be set.
    pub traction: [*const f64; 2],
    /// The slip s of a step in x and in y, a length, `[my][mx]` each, as in `fields->slip`. Default NULL: to be set.
    pub slip: [*const f64; 2],
    /// The pressures, `[my][mx]`: the depth is K/H p |s| (Archard 1953). NULL (default): the depth is K/H times the frictional work.
    pub pressure: *const f64,
    /// The wear coefficient K, a number without a unit. Default 0: there is no wear, and only the work is computed.
    pub coefficient: f64,
    /// The wear coefficient K of each element, `[my][mx]`, in place of `coefficient`. Default NULL: K is uniform.
    pub coefficients: *const f64,
    /// The hardness H, a pressure. Default 1: `coefficient` is K/H, a volume per energy.
    pub hardness: f64,
    /// The number of steps to which `work` and `depth` refer, any number >= 0; default 1. L/dq: a length L that is rolled in steps of dq. V/dq, with
    /// the velocity V: work and depth per time.
    pub steps: f64,
    /// The length dq of a step of rolling along x, as `friction->rolling_distance` (whose 0 means dx); needed for `passage` only. Default 0: not set.
    pub rolling_distance: f64,
}

versioned! { contact_normal_wear, contact_normal_wear_init, 112, hardness: 1.0, steps: 1.0 }

/// The results of `contact_normal_frictional_wear`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_worn {
    /// Set by `contact_normal_worn_init`.
    pub struct_size: i64,
    /// The frictional work of all elements, an energy.
    pub work: f64,
    /// The volume of the worn material.
    pub volume: f64,
    /// The largest depth of wear, a length.
    pub largest_depth: f64,
    /// The place of the largest depth in x, from the middle of the grid.
    pub x: f64,
    /// The place of the largest depth in y, from the middle of the grid.
    pub y: f64,
}

versioned! { contact_normal_worn, contact_normal_worn_init, 48 }

/// The caller's arrays for the results; NULL: not wanted.
struct Wanted {
    work: *mut f64,
    depth: *mut f64,
    passage: *mut f64,
}

impl Wanted {
    /// Adds all arrays to the regions and checks these. Refuses `passage` without the length of a step.
    fn check(&self, mut regions: Regions, given: &contact_normal_wear, grid: &Grid) -> Result<(), Refusal> {
        let n = grid.len();
        regions.input("wear->traction[0]", given.traction[0], n)?;
        regions.input("wear->traction[1]", given.traction[1], n)?;
        regions.input("wear->slip[0]", given.slip[0], n)?;
        regions.input("wear->slip[1]", given.slip[1], n)?;
        regions.input("wear->pressure", given.pressure, n)?;
        regions.input("wear->coefficients", given.coefficients, n)?;
        regions.output("work", self.work, n)?;
        regions.output("depth", self.depth, n)?;
        regions.output("passage", self.passage, grid.my)?;
        regions.check()?;
        if !self.passage.is_null() && given.rolling_distance == 0.0 {
            return Err(Refusal::invalid(
                "wear->rolling_distance is 0; passages need the length of a step that rolls".to_owned(),
            ));
        }
        Ok(())
    }

    unsafe fn write(&self, worn: &Worn) {
        for (from, to) in [(&worn.work, self.work), (&worn.depth, self.depth), (&worn.passage, self.passage)] {
            // SAFETY: NULL, or one value per element, or per row, by the conventions of the ABI.
            unsafe { copy_to(from, to, 0) };
        }
    }
}

/// Computes the frictional work and the wear of each element from the result of a solve with friction. The calling program may remove `depth` from
/// its surface, or add it to the undeformed distance.
///
/// `work` and `depth` `[my][mx]`: the work, an energy per area, and the depth of wear, a length, of `steps` steps. `passage` `[my]`: the depth that a
/// point of a surface which rolls along x loses while it passes through the contact once. `worn`: the sums. NULL: not wanted. The work of an element
/// is -(q . s); the sum is the work of the motion minus the change of the stored energy. The work of an element that sticks is 0 to the tolerance, of
/// either sign. INVALID_ARGUMENT, NOT_FINITE: numbers are out of their range, or results beyond the range of doubles. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_frictional_wear(
    wear: *const contact_normal_wear,
    work: *mut f64,
    depth: *mut f64,
    passage: *mut f64,
    worn: *mut contact_normal_worn,
) -> contact_normal_status {
    guard(|| {
        // SAFETY (all): NULL or as the conventions of the ABI say.
        unsafe {
            let given = structs::read(wear, "wear")?;
            let (mx, my) = (count("wear->mx", given.mx)?, count("wear->my", given.my)?);
            let grid = Grid::new(mx, my, given.dx, given.dy)?;
            let given_worn = structs::read_optional(worn.cast_const(), "worn")?;
            let mut regions = Regions::default();
            regions.input_struct(wear, &given)?;
            if let Some(given_worn) = &given_worn {
                regions.output_struct(worn, given_worn)?;
            }
            let wanted = Wanted { work, depth, passage };
            wanted.check(regions, &given, &grid)?;
            let n = grid.len();
            let traction = [
                required("wear->traction[0]", given.traction[0], n)?,
                required("wear->traction[1]", given.traction[1], n)?,
            ];
            let slip = [required("wear->slip[0]", given.slip[0], n)?, required("wear->slip[1]", given.slip[1], n)?];
            let found = frictional_wear(&Wear {
                grid,
                traction,
                slip,
                pressure: optional(given.pressure, n),
                coefficient: Each::of(optional(given.coefficients, n), given.coefficient),
                hardness: given.hardness,
                steps: given.steps,
                rolling_distance: given.rolling_distance,
            })?;
            wanted.write(&found);
            if let Some(mut value) = given_worn {
                (value.work, value.volume, value.largest_depth) = (found.total_work, found.volume, found.largest);
                [value.x, value.y] = grid.place(found.at);
                structs::write(worn, &value)?;
            }
            Ok::<_, Refusal>(CONTACT_NORMAL_OK)
        }
    })
}
