//! `contact_normal_effects_bill`: which effects of a scene change a result by more than a target, and what they cost.

use super::arguments::{self, not_negative, required, switch, Regions};
use super::conclusion::Conclusion;
use super::guard::guard;
use super::options::{self, contact_normal_options};
use super::quantities::{quantities_of, CONTACT_NORMAL_LACK_NONE};
use super::scene::{contact_normal_scene, Named};
use super::status::{contact_normal_status, CONTACT_NORMAL_OK};
use super::structs::{versioned, Rows};
use super::watcher::{why, Watcher};
use crate::solver::{effects_bill, BillOptions, BillRow, Omission, Verdict};

/// `omitted`: nothing is left out.
pub const CONTACT_NORMAL_OMIT_NONE: i32 = 0;
/// `omitted`: the coatings. The bodies consist of the material below.
pub const CONTACT_NORMAL_OMIT_COATING: i32 = 1;
/// `omitted`: the period. The scene is not repeated.
pub const CONTACT_NORMAL_OMIT_PERIOD: i32 = 2;
/// `omitted`: the patches. All elements influence each other in full.
pub const CONTACT_NORMAL_OMIT_PATCHES: i32 = 3;
/// `omitted`: the thin compliant layer.
pub const CONTACT_NORMAL_OMIT_LAYER: i32 = 4;
/// `omitted`: the pressure limit.
pub const CONTACT_NORMAL_OMIT_PRESSURE_LIMIT: i32 = 5;
/// `omitted`: friction, and for unlike bodies the influence of the tractions on the pressures.
pub const CONTACT_NORMAL_OMIT_FRICTION: i32 = 6;
/// `omitted`: the coupling of unlike bodies. Like bodies of the same compliances replace them, so that pressures and tractions do not
/// influence each other.
pub const CONTACT_NORMAL_OMIT_COUPLING: i32 = 7;
/// `omitted`: the spin.
pub const CONTACT_NORMAL_OMIT_SPIN: i32 = 8;
/// `omitted`: the tangential compliance of the layer between the bodies (`friction->compliance`).
pub const CONTACT_NORMAL_OMIT_FRICTION_COMPLIANCE: i32 = 9;
/// `omitted`: the coatings. A thin layer replaces them, which is their limit for pressure waves much longer than their thickness. This is for
/// coatings that are softer than the body below.
pub const CONTACT_NORMAL_OMIT_COATING_AS_LAYER: i32 = 10;
/// `omitted`: adhesion. There is no attraction.
pub const CONTACT_NORMAL_OMIT_ADHESION: i32 = 11;
/// `omitted`: the law of friction. The coefficient is the one at rest everywhere.
pub const CONTACT_NORMAL_OMIT_FRICTION_LAW: i32 = 12;
/// `omitted`: the yielding of the layer between the bodies (`friction->yield_limit`), but not its compliance.
pub const CONTACT_NORMAL_OMIT_FRICTION_LAYER: i32 = 13;
/// `omitted`: the relaxation of the bodies. They have their instantaneous moduli.
pub const CONTACT_NORMAL_OMIT_VISCO: i32 = 14;

/// `verdict`: the change is too near to the target, or its error is not known. With more time the call may decide.
pub const CONTACT_NORMAL_VERDICT_NOT_DECIDED: i32 = 0;
/// `verdict`: the quantity changes by less than the target, with the error of the change.
pub const CONTACT_NORMAL_VERDICT_NEGLIGIBLE: i32 = 1;
/// `verdict`: the quantity changes by more than the target.
pub const CONTACT_NORMAL_VERDICT_NEEDED: i32 = 2;
const _: () = assert!(Verdict::NotDecided as i32 == CONTACT_NORMAL_VERDICT_NOT_DECIDED);
const _: () = assert!(Verdict::Negligible as i32 == CONTACT_NORMAL_VERDICT_NEGLIGIBLE);
const _: () = assert!(Verdict::Needed as i32 == CONTACT_NORMAL_VERDICT_NEEDED);

/// The change of a quantity if one or two effects are left out, and the cost with and without them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_effects_row {
    /// Set by `contact_normal_effects_row_init`, which the first row of an array needs, and by the call.
    pub struct_size: i64,
    /// CONTACT_NORMAL_OMIT_...: the effect that is left out.
    pub omitted: i32,
    /// CONTACT_NORMAL_OMIT_...: the second effect that is left out; NONE: there is no second one.
    pub also_omitted: i32,
    /// CONTACT_NORMAL_QUANTITY_...
    pub quantity: i32,
    /// CONTACT_NORMAL_VERDICT_...
    pub verdict: i32,
    /// CONTACT_NORMAL_LACK_...: why a value, a change or its error is not known.
    pub lack: i32,
    /// Always 0.
    pub reserved: i32,
    /// The quantity for the whole scene, on the last of the small grids; NaN: there is no value.
    pub value: f64,
    /// The change of the quantity without the effects that are left out, on the last of the small grids; NaN: not known, for instance because that
    /// grid was not solved.
    pub change: f64,
    /// The estimated error of the change; < 0: not known.
    pub change_error: f64,
    /// The predicted seconds of a whole call for the scene on its own grid, with one thread.
    pub seconds: f64,
    /// The predicted seconds without the effects that are left out.
    pub seconds_without: f64,
    /// The predicted bytes of the solver for the scene on its own grid.
    pub bytes: f64,
    /// The predicted bytes without the effects that are left out.
    pub bytes_without: f64,
}

versioned! { contact_normal_effects_row, contact_normal_effects_row_init, 88, change_error: -1.0 }

impl From<&BillRow> for contact_normal_effects_row {
    fn from(row: &BillRow) -> Self {
        contact_normal_effects_row {
            struct_size: size_of::<contact_normal_effects_row>() as i64,
            omitted: row.omission.number() as i32,
            also_omitted: row.other.map_or(CONTACT_NORMAL_OMIT_NONE, |other| other.number() as i32),
            quantity: row.quantity.number() as i32,
            verdict: row.verdict as i32,
            lack: row.lack.map_or(CONTACT_NORMAL_LACK_NONE, |lack| lack as i32),
            reserved: 0,
            value: row.value.unwrap_or(f64::NAN),
            change: row.change.unwrap_or(f64::NAN),
            change_error: row.error.unwrap_or(-1.0),
            seconds: row.seconds[0],
            seconds_without: row.seconds[1],
            bytes: row.bytes[0],
            bytes_without: row.bytes[1],
        }
    }
}

/// Computes the bill: how much a result changes if an effect of the scene is left out, and what the effect costs. Besides the effects of the scene
/// the bill has refinements that a scene has without a struct of their own: the coupling of unlike bodies, the spin, a coating in place of a thin
/// layer.
///
/// For each of these, and each of the `n` `quantities` (CONTACT_NORMAL_QUANTITY_...), a row has the change of the quantity, the error of this change,
/// and the cost on the scene's own grid. The verdict compares the change with the relative accuracy `target`, between 0 and 1. `pairs` 1: pairs of
/// effects are left out as well; 0: they are not. The scene is solved on small grids, for at most 5 % of its own predicted seconds or 100 ms, or for
/// `options->max_seconds` if that is given.
///
/// `*count` is the number of rows: n for each effect, in the order of the constants, then n for each pair. `rows` has room for the first `capacity`
/// rows. With `rows` NULL the call only writes the count, which takes no time. ITERATION_LIMIT: `max_cycles` ended a solve of the last grid, and rows
/// that need this solve have no change (LACK_UNSOLVED); or `max_seconds` was reached. After `max_seconds` and CANCELLED rows have the results of the
/// last grid that was solved with and without all effects. UNSUPPORTED: influence coefficients of your own, tractions kept by a handle, FIXED
/// contact. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_effects_bill(
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    target: f64,
    pairs: i32,
    n: i32,
    quantities: *const i32,
    capacity: i32,
    rows: *mut contact_normal_effects_row,
    count: *mut i32,
) -> contact_normal_status {
    guard(|| {
        let n = arguments::count("n", n)?;
        let capacity = not_negative("capacity", capacity)?;
        let pairs = switch("pairs", pairs)?;
        // SAFETY: each pointer is NULL or points to what it says, by the conventions of the ABI.
        let (translated, named, wanted) =
            unsafe { (options::translate(options)?, Named::read(scene)?, required("quantities", quantities, n)?) };
        // SAFETY: NULL, or rows of which the first declares its size.
        let to = if rows.is_null() { None } else { Some(unsafe { Rows::of(rows, "rows")? }) };
        let mut regions = Regions::default();
        named.add_to(&mut regions, scene)?;
        translated.add_to(&mut regions, options)?;
        regions.input("quantities", wanted.as_ptr(), n)?;
        if let Some(to) = &to {
            regions.output_rows("rows", rows, to, capacity)?;
        }
        regions.output("count", count, 1)?;
        regions.check()?;
        let wanted = quantities_of(wanted)?;
        // SAFETY: as above.
        let scene = unsafe { named.translate()? };
        let asked = BillOptions { target, max_seconds: translated.given.max_seconds, pairs };
        let write_count = |rows: usize| {
            if !count.is_null() {
                // SAFETY: not NULL, so an integer of the caller.
                unsafe { count.write(rows as i32) };
            }
        };
        let Some(to) = to else {
            write_count(Omission::left_out_of(&scene, asked.pairs).len() * n);
            return Ok(CONTACT_NORMAL_OK);
        };
        let watcher = Watcher::of(&translated);
        let told = &mut watcher.told();
        let (outcome, bill) = effects_bill(&scene, &translated.options, &asked, &wanted, watcher.callback(told))?;
        // SAFETY: the caller's array holds `capacity` rows.
        bill.iter().take(capacity).enumerate().for_each(|(i, row)| unsafe { to.write(i, &row.into()) });
        write_count(bill.len());
        watcher.conclusion(Conclusion::of(outcome, || why(outcome).into())).conclude()
    })
}
