//! `contact_normal_init`: the exported function that the `_init` of every struct calls.

use libc::c_void;

use super::guard::guard;
use super::*;

/// `kind`: `contact_normal_scene`. Since 0.1.
pub const CONTACT_NORMAL_KIND_SCENE: i32 = 1;
/// `kind`: `contact_normal_options`. Since 0.1.
pub const CONTACT_NORMAL_KIND_OPTIONS: i32 = 2;
/// `kind`: `contact_normal_fields`. Since 0.1.
pub const CONTACT_NORMAL_KIND_FIELDS: i32 = 3;
/// `kind`: `contact_normal_report`. Since 0.1.
pub const CONTACT_NORMAL_KIND_REPORT: i32 = 4;
/// `kind`: `contact_normal_accuracy`. Since 0.1.
pub const CONTACT_NORMAL_KIND_ACCURACY: i32 = 5;
/// `kind`: `contact_normal_influence`. Since 0.1.
pub const CONTACT_NORMAL_KIND_INFLUENCE: i32 = 6;
/// `kind`: `contact_normal_row_tables`. Since 0.1.
pub const CONTACT_NORMAL_KIND_ROW_TABLES: i32 = 7;
/// `kind`: `contact_normal_layer`. Since 0.1.
pub const CONTACT_NORMAL_KIND_LAYER: i32 = 8;
/// `kind`: `contact_normal_pressure_limit`. Since 0.1.
pub const CONTACT_NORMAL_KIND_PRESSURE_LIMIT: i32 = 9;
/// `kind`: `contact_normal_period`. Since 0.1.
pub const CONTACT_NORMAL_KIND_PERIOD: i32 = 10;
/// `kind`: `contact_normal_patches`. Since 0.1.
pub const CONTACT_NORMAL_KIND_PATCHES: i32 = 11;
/// `kind`: `contact_normal_coating`. Since 0.2.
pub const CONTACT_NORMAL_KIND_COATING: i32 = 12;
/// `kind`: `contact_normal_friction`. Since 0.2.
pub const CONTACT_NORMAL_KIND_FRICTION: i32 = 13;
/// `kind`: `contact_normal_friction_results`. Since 0.2.
pub const CONTACT_NORMAL_KIND_FRICTION_RESULTS: i32 = 14;
/// `kind`: `contact_normal_stress_outputs`. Since 0.2.
pub const CONTACT_NORMAL_KIND_STRESS_OUTPUTS: i32 = 15;
/// `kind`: `contact_normal_stress_maximum`. Since 0.2.
pub const CONTACT_NORMAL_KIND_STRESS_MAXIMUM: i32 = 16;
/// `kind`: `contact_normal_ledger_row`, of the first row of an array. Since 0.2.
pub const CONTACT_NORMAL_KIND_LEDGER_ROW: i32 = 17;
/// `kind`: `contact_normal_price`, of the first row of an array. Since 0.2.
pub const CONTACT_NORMAL_KIND_PRICE: i32 = 18;
/// `kind`: `contact_normal_hertz_solution`. Since 0.2.
pub const CONTACT_NORMAL_KIND_HERTZ_SOLUTION: i32 = 19;
/// `kind`: `contact_normal_cycle`. Since 0.2.
pub const CONTACT_NORMAL_KIND_CYCLE: i32 = 20;
/// `kind`: `contact_normal_solver_info`. Since 0.2.
pub const CONTACT_NORMAL_KIND_SOLVER_INFO: i32 = 21;
/// `kind`: `contact_normal_quantity_row`, of the first row of an array. Since 0.2.
pub const CONTACT_NORMAL_KIND_QUANTITY_ROW: i32 = 22;
/// `kind`: `contact_normal_effects_row`, of the first row of an array. Since 0.2.
pub const CONTACT_NORMAL_KIND_EFFECTS_ROW: i32 = 23;
/// `kind`: `contact_normal_adhesion`. Since 0.2.
pub const CONTACT_NORMAL_KIND_ADHESION: i32 = 24;
/// `kind`: `contact_normal_visco`. Since 0.2.
pub const CONTACT_NORMAL_KIND_VISCO: i32 = 25;
/// `kind`: `contact_normal_heat`. Since 0.2.
pub const CONTACT_NORMAL_KIND_HEAT: i32 = 26;
/// `kind`: `contact_normal_flash`. Since 0.2.
pub const CONTACT_NORMAL_KIND_FLASH: i32 = 27;
/// `kind`: `contact_normal_wear`. Since 0.2.
pub const CONTACT_NORMAL_KIND_WEAR: i32 = 28;
/// `kind`: `contact_normal_worn`. Since 0.2.
pub const CONTACT_NORMAL_KIND_WORN: i32 = 29;

/// Fills a struct of a `kind` (CONTACT_NORMAL_KIND_...), which has `size` bytes in the caller's header, with its defaults. Programs in C
/// and C++ call the function that the header has for each struct, as `contact_normal_scene_init(&scene)`. Other programs call this function with
/// the size of their own struct. It writes no more than `size` bytes, and 0 into members that this library does not know. `to` NULL is ignored.
/// Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_init(kind: i32, to: *mut c_void, size: i64) {
    guard(|| {
        // SAFETY: NULL or `size` bytes, by the conventions of the ABI.
        unsafe { init_kind(kind, to, size) };
        Ok(CONTACT_NORMAL_OK)
    });
}

/// The structs of the ABI, each with its `kind`.
macro_rules! kinds {
    ($($kind:ident => $name:ident),+ $(,)?) => {
        unsafe fn init_kind(kind: i32, to: *mut c_void, size: i64) {
            // SAFETY (all): by the caller.
            unsafe {
                match kind {
                    $($kind => structs::init::<$name>(to.cast(), size),)+
                    // A kind of a newer header. If the program attaches the struct to a member that this library does not know, calls refuse it.
                    _ => structs::init_unknown(to.cast(), size),
                }
            }
        }

        #[cfg(test)]
        fn check_kinds() {
            $(tests::has_grown_by_zeros::<$name>();)+
        }
    };
}

kinds! {
    CONTACT_NORMAL_KIND_SCENE => contact_normal_scene,
    CONTACT_NORMAL_KIND_OPTIONS => contact_normal_options,
    CONTACT_NORMAL_KIND_FIELDS => contact_normal_fields,
    CONTACT_NORMAL_KIND_REPORT => contact_normal_report,
    CONTACT_NORMAL_KIND_ACCURACY => contact_normal_accuracy,
    CONTACT_NORMAL_KIND_INFLUENCE => contact_normal_influence,
    CONTACT_NORMAL_KIND_ROW_TABLES => contact_normal_row_tables,
    CONTACT_NORMAL_KIND_LAYER => contact_normal_layer,
    CONTACT_NORMAL_KIND_PRESSURE_LIMIT => contact_normal_pressure_limit,
    CONTACT_NORMAL_KIND_PERIOD => contact_normal_period,
    CONTACT_NORMAL_KIND_PATCHES => contact_normal_patches,
    CONTACT_NORMAL_KIND_COATING => contact_normal_coating,
    CONTACT_NORMAL_KIND_FRICTION => contact_normal_friction,
    CONTACT_NORMAL_KIND_FRICTION_RESULTS => contact_normal_friction_results,
    CONTACT_NORMAL_KIND_STRESS_OUTPUTS => contact_normal_stress_outputs,
    CONTACT_NORMAL_KIND_STRESS_MAXIMUM => contact_normal_stress_maximum,
    CONTACT_NORMAL_KIND_LEDGER_ROW => contact_normal_ledger_row,
    CONTACT_NORMAL_KIND_PRICE => contact_normal_price,
    CONTACT_NORMAL_KIND_HERTZ_SOLUTION => contact_normal_hertz_solution,
    CONTACT_NORMAL_KIND_CYCLE => contact_normal_cycle,
    CONTACT_NORMAL_KIND_SOLVER_INFO => contact_normal_solver_info,
    CONTACT_NORMAL_KIND_QUANTITY_ROW => contact_normal_quantity_row,
    CONTACT_NORMAL_KIND_EFFECTS_ROW => contact_normal_effects_row,
    CONTACT_NORMAL_KIND_ADHESION => contact_normal_adhesion,
    CONTACT_NORMAL_KIND_VISCO => contact_normal_visco,
    CONTACT_NORMAL_KIND_HEAT => contact_normal_heat,
    CONTACT_NORMAL_KIND_FLASH => contact_normal_flash,
    CONTACT_NORMAL_KIND_WEAR => contact_normal_wear,
    CONTACT_NORMAL_KIND_WORN => contact_normal_worn,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ffi::structs::Versioned;

    /// The defaults of members beyond the first size are 0: a newer program that does not set them asks nothing of an older library.
    pub(super) fn has_grown_by_zeros<T: Versioned>() {
        let defaults = T::defaults();
        // SAFETY: a Versioned is bytes.
        let bytes = unsafe { std::slice::from_raw_parts((&raw const defaults).cast::<u8>(), size_of::<T>()) };
        assert!(bytes[T::FIRST_SIZE..].iter().all(|byte| *byte == 0), "{}: a default that is not 0", T::NAME);
    }

    #[test]
    fn members_that_came_after_the_first_version_have_the_default_0() {
        check_kinds();
    }
}
