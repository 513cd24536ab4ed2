//! `contact_normal_has`: the features of this library, by name.

use std::ffi::CStr;

use libc::c_char;

use crate::effects;

/// The names of all features except effects: members of structs, and tasks of functions.
const NAMES: &str =
    "accuracy batch branch coating_compliance compliance constant creepage_weight cycle dump effects_bill error_ratio \
    flash_temperature frictional_wear influence_rolling influence_rolling_tangential initial_traction keep law \
    max_seconds neglect_below previous_coefficient price_list product pull_off quantities release sensitivities \
    set_option solve_tangential stick_slip stiffness stop stress tangential_row_tables warnings yield_limit";

/// Returns 1 if this library has the feature `name`, else 0, also for names of later versions. A feature is an effect of a scene ("friction",
/// "adhesion", ...), an option ("max_seconds", "stop", "cycle", "error_ratio", "neglect_below"), a field ("stick_slip"), a member of
/// `contact_normal_friction` ("initial_traction", "compliance", "creepage_weight", "tangential_row_tables", "law", "branch",
/// "previous_coefficient", "yield_limit"), or a task of functions ("batch", "accuracy", "price_list", "quantities", "effects_bill",
/// "stress", "coating_compliance", "flash_temperature", "frictional_wear", "influence_rolling", "influence_rolling_tangential",
/// "solve_tangential", "pull_off", "sensitivities", "warnings", "keep", "release", "dump", "set_option", "constant", "product", "stiffness").
/// Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_has(name: *const c_char) -> i32 {
    if name.is_null() {
        return 0;
    }
    // SAFETY: not NULL, so a text that ends with 0, by the conventions of the ABI.
    let name = unsafe { CStr::from_ptr(name) }.to_str().unwrap_or_default();
    i32::from(NAMES.split(' ').any(|known| known == name) || effects::place(name).is_some())
}
