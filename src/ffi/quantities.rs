//! `contact_normal_quantities`: quantities of a scene on several grids, with estimated errors.

use super::arguments::{count, required, Regions};
use super::conclusion::Conclusion;
use super::guard::guard;
use super::options::{self, contact_normal_options};
use super::price_list::quantity_of;
use super::scene::{contact_normal_scene, Named};
use super::status::{contact_normal_status, Refusal};
use super::structs::{versioned, Rows};
use super::watcher::{why, Watcher};
use crate::solver::{self, Lack, Quantity, QuantityRow};

/// `lack`: nothing is missing.
pub const CONTACT_NORMAL_LACK_NONE: i32 = 0;
/// `lack`: there is no value, because the scene has no friction.
pub const CONTACT_NORMAL_LACK_NO_FRICTION: i32 = 1;
/// `lack`: there is no value, because the scene prescribes the quantity.
pub const CONTACT_NORMAL_LACK_PRESCRIBED: i32 = 2;
/// `lack`: there is no value, because an effect of the scene excludes it: stresses are those of half-spaces.
pub const CONTACT_NORMAL_LACK_EFFECT: i32 = 3;
/// `lack`: there is no value, because there is no contact; or a value of 0 has no error, because on the coarse grid nothing touches.
pub const CONTACT_NORMAL_LACK_NO_CONTACT: i32 = 4;
/// `lack`: there is no error, because the value grows from grid to grid.
pub const CONTACT_NORMAL_LACK_SINGULAR: i32 = 5;
/// `lack`: there is no error, because only one grid was solved.
pub const CONTACT_NORMAL_LACK_ONE_GRID: i32 = 6;
/// `lack`: a grid was not solved.
pub const CONTACT_NORMAL_LACK_UNSOLVED: i32 = 7;
/// `lack`: there is no error, because the changes from grid to grid do not decrease yet. One more grid shows whether the value converges.
pub const CONTACT_NORMAL_LACK_UNSETTLED: i32 = 8;
const _: () = assert!(Lack::NoFriction as i32 == CONTACT_NORMAL_LACK_NO_FRICTION);
const _: () = assert!(Lack::Prescribed as i32 == CONTACT_NORMAL_LACK_PRESCRIBED);
const _: () = assert!(Lack::Effect as i32 == CONTACT_NORMAL_LACK_EFFECT);
const _: () = assert!(Lack::NoContact as i32 == CONTACT_NORMAL_LACK_NO_CONTACT);
const _: () = assert!(Lack::Singular as i32 == CONTACT_NORMAL_LACK_SINGULAR);
const _: () = assert!(Lack::OneGrid as i32 == CONTACT_NORMAL_LACK_ONE_GRID);
const _: () = assert!(Lack::Unsolved as i32 == CONTACT_NORMAL_LACK_UNSOLVED);
const _: () = assert!(Lack::Unsettled as i32 == CONTACT_NORMAL_LACK_UNSETTLED);

/// The value of a quantity on one grid, and its error.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_quantity_row {
    /// Set by `contact_normal_quantity_row_init`, which the first row of an array needs, and by the call.
    pub struct_size: i64,
    /// CONTACT_NORMAL_QUANTITY_...
    pub quantity: i32,
    /// CONTACT_NORMAL_LACK_...: why there is no value or no error.
    pub lack: i32,
    /// Elements in x of the grid.
    pub mx: i32,
    /// Elements in y of the grid.
    pub my: i32,
    /// The value of the quantity; NaN: there is no value.
    pub value: f64,
    /// The estimated error of the value, in the same unit; < 0: not known.
    pub error: f64,
    /// Seconds of set-up and solve on this grid, without stresses and stiffness; the same for all quantities.
    pub seconds: f64,
    /// Work units of the solve on this grid. The unit is one product on this grid.
    pub work_units: f64,
}

versioned! { contact_normal_quantity_row, contact_normal_quantity_row_init, 56, error: -1.0 }

impl From<&QuantityRow> for contact_normal_quantity_row {
    fn from(row: &QuantityRow) -> Self {
        contact_normal_quantity_row {
            struct_size: size_of::<contact_normal_quantity_row>() as i64,
            quantity: row.quantity.number() as i32,
            lack: row.lack.map_or(CONTACT_NORMAL_LACK_NONE, |lack| lack as i32),
            mx: row.grid.mx as i32,
            my: row.grid.my as i32,
            value: row.value.unwrap_or(f64::NAN),
            error: row.error.unwrap_or(-1.0),
            seconds: row.seconds,
            work_units: row.work_units,
        }
    }
}

/// The quantities with these numbers.
pub(super) fn quantities_of(numbers: &[i32]) -> Result<Vec<Quantity>, Refusal> {
    let quantity = |(i, number): (usize, &i32)| quantity_of(&format!("quantities[{i}]"), *number);
    numbers.iter().enumerate().map(quantity).collect()
}

/// The largest `coarser`. The coarsest grid then has 1/4096 of the elements in each direction.
const MOST_COARSER: i32 = 12;

/// Solves the scene on its own grid and on `coarser` coarser grids (0 to 12). Each grid has half the elements of the next one in both directions, and
/// each solve has no initial guess. The call writes `n` rows for each grid, coarsest first: `rows[k n + i]` has `quantities[i]`
/// (CONTACT_NORMAL_QUANTITY_...) on grid k. There are `(coarser + 1) n` rows, or fewer if a grid of few elements cannot be halved any more.
/// `*written` (NULL: not wanted) is the number of rows.
///
/// Errors of force, largest pressure and area are the estimates of the report. Errors of all other quantities follow from the coarser grids, so the
/// coarsest grid has none. If nothing touches on the scene's own grid, values of 0 have the error 0. Arrays of one value per element are averaged on
/// coarser grids. ITERATION_LIMIT, STAGNATED: the scene's own grid was not solved. UNSUPPORTED: influence coefficients of your own, tractions kept by
/// a handle, FIXED contact. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_quantities(
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    n: i32,
    quantities: *const i32,
    coarser: i32,
    rows: *mut contact_normal_quantity_row,
    written: *mut i32,
) -> contact_normal_status {
    guard(|| {
        let n = count("n", n)?;
        if !(0..=MOST_COARSER).contains(&coarser) {
            return Err(Refusal::invalid(format!("coarser is {coarser}; it must lie in 0..{MOST_COARSER}")));
        }
        // SAFETY: each pointer is NULL or points to what it says, by the conventions of the ABI.
        let (translated, named, wanted) =
            unsafe { (options::translate(options)?, Named::read(scene)?, required("quantities", quantities, n)?) };
        // SAFETY: NULL or rows of which the first declares its size.
        let to = unsafe { Rows::of(rows, "rows")? };
        let mut regions = Regions::default();
        named.add_to(&mut regions, scene)?;
        translated.add_to(&mut regions, options)?;
        regions.input("quantities", wanted.as_ptr(), n)?;
        regions.output_rows("rows", rows, &to, n * (coarser as usize + 1))?;
        regions.output("written", written, 1)?;
        regions.check()?;
        let wanted = quantities_of(wanted)?;
        // SAFETY: as above.
        let scene = unsafe { named.translate()? };
        let watcher = Watcher::of(&translated);
        let told = &mut watcher.told();
        let progress = watcher.callback(told);
        let (outcome, computed) = solver::quantities(&scene, &translated.options, &wanted, coarser as usize, progress)?;
        // SAFETY: the caller has room for all rows.
        computed.iter().enumerate().for_each(|(i, row)| unsafe { to.write(i, &row.into()) });
        if !written.is_null() {
            // SAFETY: not NULL, so an integer of the caller.
            unsafe { written.write(computed.len() as i32) };
        }
        watcher.conclusion(Conclusion::of(outcome, || why(outcome).into())).conclude()
    })
}
