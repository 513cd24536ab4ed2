//! Marks: mistakes that the Fortran module finds. The procedures of the module that attach arrays and structures return no status. They write a
//! mistake in their arguments as a negative number, a mark, into the `struct_size` of the structure that they fill. The next call that reads the
//! structure refuses it with the text of the mark.
//!
//! The absolute value of a mark has 16 bits [`MARK`], 8 bits for the number of the procedure, 8 bits for the kind of the mistake, and 32 bits for the
//! number of the argument or for its value. Procedures and arguments count from 1.

/// The upper 16 bits of the absolute value of a mark.
const MARK: i64 = 0x2C4D;

// The kinds of mistakes.
const WRONG_BODY: i64 = 1;
const NOT_ASSOCIATED: i64 = 2;
const WRONG_SHAPE: i64 = 3;

/// The procedures, each with the names of its arguments, in the order of include/contact_normal.f90.
const PROCEDURES: [(&str, &str); 22] = [
    ("set_undeformed_distance", "scene h"),
    ("set_influence", "scene influence cx cy coefficients scale"),
    ("set_layer", "scene layer compliance compliances"),
    ("set_pressure_limit", "scene pressure_limit limit limits"),
    ("set_period", "scene period x y"),
    ("set_patches", "scene patches patch factors"),
    ("set_row_tables", "scene row_tables cx coefficients scale"),
    ("set_coating", "scene body coating thickness shear_modulus poisson_ratio"),
    ("set_cycle", "options cycle"),
    (
        "set_friction",
        "scene friction coefficient coefficients previous_x previous_y slip_x slip_y initial_x initial_y \
         compliances weight_x weight_y previous_coefficient previous_yield_limit",
    ),
    ("set_tangential_influence", "friction tables xx yy xy scale xz yz"),
    ("set_friction_fields", "fields traction_x traction_y slip_x slip_y stick_slip friction_coefficient yield_limit"),
    (
        "set_friction_results",
        "results force moment creepage residual gap products stick_count slip_count status traction slip \
         stick_slip friction_coefficient yield_limit",
    ),
    ("set_fields", "fields pressure contact displacement deformed_distance contact_pressure attraction"),
    (
        "set_stress_outputs",
        "outputs stress von_mises maximum_shear principal directions largest_von_mises largest_shear",
    ),
    ("set_ledger", "report ledger"),
    ("solver_solve_batch", "solver scenes options fields reports statuses"),
    ("set_tangential_row_tables", "friction tables cx xx yy xy scale"),
    ("set_adhesion", "scene adhesion work works range law"),
    ("set_visco", "scene visco modulus_1 time_1 modulus_2 time_2 time_step continues"),
    ("flash_temperature", "heat heat_flux temperature flash"),
    ("frictional_wear", "wear traction slip work depth passage worn pressure coefficients"),
];

/// The text of a mark. None: the declared `struct_size` is no mark.
pub fn read(declared: i64) -> Option<String> {
    let bits = declared.checked_neg()?;
    if bits >> 48 != MARK {
        return None;
    }
    let index = |number: i64| usize::try_from(number).ok()?.checked_sub(1);
    let (procedure, arguments) = PROCEDURES.get(index(bits >> 40 & 0xFF)?)?;
    // The low 32 bits are an integer of Fortran: the number of an argument, or the value of `body`.
    let about = bits as i32;
    let argument = || arguments.split(' ').nth(index(i64::from(about))?);
    let fault = match bits >> 32 & 0xFF {
        WRONG_BODY => format!("body is {about}; it must be 1 or 2"),
        NOT_ASSOCIATED => format!("{} is not associated (or not allocated)", argument()?),
        WRONG_SHAPE => format!("{} has another shape than it must have", argument()?),
        _ => return None,
    };
    Some(format!("contact_normal_{procedure}: {fault}"))
}

#[cfg(test)]
#[path = "../../tests/unit/marks.rs"]
mod tests;
