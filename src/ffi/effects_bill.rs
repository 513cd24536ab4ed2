//! `contact_normal_effects_bill`: which effects a scene calls for, and what they cost.

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

/// `omitted`: nothing.
pub const CONTACT_NORMAL_OMIT_NONE: i32 = 0;
/// `omitted`: the coatings; the bodies are all of the material below.
pub const CONTACT_NORMAL_OMIT_COATING: i32 = 1;
/// `omitted`: the period; the scene stands alone.
pub const CONTACT_NORMAL_OMIT_PERIOD: i32 = 2;
/// `omitted`: the patches; all feel each other.
pub const CONTACT_NORMAL_OMIT_PATCHES: i32 = 3;
/// `omitted`: the thin compliant layer.
pub const CONTACT_NORMAL_OMIT_LAYER: i32 = 4;
/// `omitted`: the limit of pressures.
pub const CONTACT_NORMAL_OMIT_PRESSURE_LIMIT: i32 = 5;
/// `omitted`: friction, with what tractions of unlike bodies do to pressures.
pub const CONTACT_NORMAL_OMIT_FRICTION: i32 = 6;
/// `omitted`: that bodies are unlike; in their place there are like bodies of the same compliances, so that pressures and tractions do not
/// feel each other.
pub const CONTACT_NORMAL_OMIT_COUPLING: i32 = 7;
/// `omitted`: the spin.
pub const CONTACT_NORMAL_OMIT_SPIN: i32 = 8;
/// `omitted`: the tangential compliance of a third body.
pub const CONTACT_NORMAL_OMIT_FRICTION_COMPLIANCE: i32 = 9;
/// `omitted`: the coatings; a thin layer stands for them, which is their limit for waves much longer than their thickness. Only of coatings
/// that are softer than the body below.
pub const CONTACT_NORMAL_OMIT_COATING_AS_LAYER: i32 = 10;
/// `omitted`: adhesion; nothing attracts.
pub const CONTACT_NORMAL_OMIT_ADHESION: i32 = 11;
/// `omitted`: the law of friction; the coefficient is that at rest everywhere.
pub const CONTACT_NORMAL_OMIT_FRICTION_LAW: i32 = 12;
/// `omitted`: the yield of a third body, not its compliance.
pub const CONTACT_NORMAL_OMIT_FRICTION_LAYER: i32 = 13;
/// `omitted`: that bodies relax; they give way as at once.
pub const CONTACT_NORMAL_OMIT_VISCO: i32 = 14;

/// `verdict`: the change is too near to the target, or its error is not known; more time decides.
pub const CONTACT_NORMAL_VERDICT_NOT_DECIDED: i32 = 0;
/// `verdict`: the quantity changes by less than the target, the error of the change included.
pub const CONTACT_NORMAL_VERDICT_NEGLIGIBLE: i32 = 1;
/// `verdict`: it changes by more than the target.
pub const CONTACT_NORMAL_VERDICT_NEEDED: i32 = 2;
const _: () = assert!(Verdict::NotDecided as i32 == CONTACT_NORMAL_VERDICT_NOT_DECIDED);
const _: () = assert!(Verdict::Negligible as i32 == CONTACT_NORMAL_VERDICT_NEGLIGIBLE);
const _: () = assert!(Verdict::Needed as i32 == CONTACT_NORMAL_VERDICT_NEEDED);

/// The change of a quantity without an effect, or without two, and the cost that this saves.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_effects_row {
    /// Set by `contact_normal_effects_row_init`, which the first row of an array needs, and by the call.
    pub struct_size: i64,
    /// CONTACT_NORMAL_OMIT_...: the effect that is left out.
    pub omitted: i32,
    /// The second effect that is left out; NONE: only one is.
    pub also_omitted: i32,
    /// CONTACT_NORMAL_QUANTITY_...
    pub quantity: i32,
    /// CONTACT_NORMAL_VERDICT_...
    pub verdict: i32,
    /// CONTACT_NORMAL_LACK_...: why a value, a change or its error is not known.
    pub lack: i32,
    /// 0.
    pub reserved: i32,
    /// The value of the scene as it is, on the last of the small grids; NaN: there is none.
    pub value: f64,
    /// The change of the quantity by leaving out, on the last of the small grids; NaN: not known, as where that grid is not solved.
    pub change: f64,
    /// How far the change may be off; < 0: not known.
    pub change_error: f64,
    /// Predicted seconds of a whole call for the scene on its own grid, with one thread.
    pub seconds: f64,
    /// The same without the effects that are left out.
    pub seconds_without: f64,
    /// Predicted bytes of its solver.
    pub bytes: f64,
    /// The same without the effects that are left out.
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

/// Computes the bill of the effects that the scene names, and of the refinements that it has without naming them (the coupling of unlike
/// bodies, the spin, a coating instead of a thin layer). For each of them, and each of the `n` `quantities` (CONTACT_NORMAL_QUANTITY_...),
/// a row has the change of the quantity without the effect, the error of this change, and the cost on the scene's own grid. The verdict is by
/// the relative accuracy `target`, between 0 and 1. `pairs` 1: pairs are left out, too; 0: they are not. The scene is solved on small grids,
/// for at most 5 % of its own predicted seconds or 100 ms, or `options->max_seconds` where that is given.
///
/// `*count` is the number of rows: n for each effect, in the order of the constants, then n for each pair. `rows` has room for the first
/// `capacity` of them; rows NULL asks for the count alone, which takes no time. ITERATION_LIMIT: `max_cycles` ended a solve of the last grid, and
/// rows that need it have no change (LACK_UNSOLVED); or `max_seconds` was reached. Then, and after CANCELLED, rows have the results of the last
/// grid that was solved with and without all effects. UNSUPPORTED: own coefficients, tractions kept by a handle, FIXED contact. Since 0.2.
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
        let write_count = |found: usize| {
            if !count.is_null() {
                // SAFETY: not NULL: an integer of the caller's.
                unsafe { count.write(found as i32) };
            }
        };
        let Some(to) = to else {
            write_count(Omission::left_out_of(&scene, asked.pairs).len() * n);
            return Ok(CONTACT_NORMAL_OK);
        };
        let watcher = Watcher::of(&translated);
        let told = &mut watcher.told();
        let (stop, found) = effects_bill(&scene, &translated.options, &asked, &wanted, watcher.callback(told))?;
        // SAFETY: the caller's array holds `capacity` rows.
        found.iter().take(capacity).enumerate().for_each(|(i, row)| unsafe { to.write(i, &row.into()) });
        write_count(found.len());
        watcher.conclusion(Conclusion::of(stop, || why(stop).into())).conclude()
    })
}
