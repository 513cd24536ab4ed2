//! Exact solutions, and tables of influence coefficients.

use super::arguments::{aligned, count, required};
use super::guard::guard;
use super::influence::table_size;
use super::ledger::copy;
use super::scene::load_of;
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::structs::{self, versioned};
use super::visco::contact_normal_visco;
use crate::analytic;
use crate::effects::Effect;
use crate::error::{positive, require, Error};
use crate::friction::rolling_tables;
use crate::grid::Grid;
use crate::influence::{HalfSpace, Kernel};
use crate::memory::zeros;
use crate::scene::{Bodies, Load};
use crate::visco::{rolling_table, RollingBody};

/// Hertz's exact solution for two bodies with an elliptical contact area.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_hertz_solution {
    /// Set by `contact_normal_hertz_solution_init`.
    pub struct_size: i64,
    /// Semi-axis of the contact ellipse in x.
    pub semi_axis_x: f64,
    /// Semi-axis of the contact ellipse in y.
    pub semi_axis_y: f64,
    /// Pressure at the centre of the ellipse.
    pub max_pressure: f64,
    /// Approach.
    pub approach: f64,
    /// Normal force.
    pub force: f64,
    /// Area of the contact ellipse.
    pub area: f64,
}

versioned! { contact_normal_hertz_solution, contact_normal_hertz_solution_init, 56 }

/// The bodies with two shear moduli and two Poisson ratios.
unsafe fn bodies(shear_modulus: *const f64, poisson_ratio: *const f64) -> Result<Bodies, Refusal> {
    // SAFETY: NULL or two values each, by the conventions of the ABI.
    let (moduli, ratios) =
        unsafe { (required("shear_modulus", shear_modulus, 2)?, required("poisson_ratio", poisson_ratio, 2)?) };
    let bodies = Bodies { shear_modulus: [moduli[0], moduli[1]], poisson_ratio: [ratios[0], ratios[1]] };
    bodies.check()?;
    Ok(bodies)
}

/// Computes Hertz's exact solution for two bodies with the undeformed distance `h = curvature_x x^2 + curvature_y y^2`; the curvatures are positive,
/// 1/length. `load` is PRESCRIBED_APPROACH or PRESCRIBED_FORCE, and `amount` the value of the approach or force. `shear_modulus` and `poisson_ratio`
/// have two values each. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_hertz(
    curvature_x: f64,
    curvature_y: f64,
    shear_modulus: *const f64,
    poisson_ratio: *const f64,
    load: i32,
    amount: f64,
    solution: *mut contact_normal_hertz_solution,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or a struct that declares its size.
        let mut value = unsafe { structs::read(solution.cast_const(), "solution")? };
        // SAFETY: NULL or two values each, by the conventions of the ABI.
        let compliance = unsafe { bodies(shear_modulus, poisson_ratio)? }.compliance();
        let (name, exact): (_, fn(f64, f64, f64, f64) -> _) = match load_of(load, amount, amount)? {
            Load::Approach(_) => ("amount, the approach,", analytic::hertz),
            Load::Force(_) => ("amount, the force,", analytic::hertz_by_force),
        };
        positive(name, amount)?;
        let found = exact(curvature_x, curvature_y, amount, compliance)?;
        copy!(found => value: semi_axis_x, semi_axis_y, max_pressure, approach, force, area);
        // SAFETY: it declares its size.
        unsafe { structs::write(solution, &value)? };
        Ok(CONTACT_NORMAL_OK)
    })
}

/// Computes the influence coefficients of the half-space for elements `dx` by `dy`, as a table over the offsets -cx to cx - 1 and -cy to cy - 1:
/// `coefficients[2 cy][2 cx]`, x fastest, as `contact_normal_influence` takes it. NOT_FINITE, INVALID_ARGUMENT: the coefficients are beyond the range
/// of doubles. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_influence_half_space(
    cx: i32,
    cy: i32,
    dx: f64,
    dy: f64,
    shear_modulus: *const f64,
    poisson_ratio: *const f64,
    coefficients: *mut f64,
) -> contact_normal_status {
    guard(|| {
        // SAFETY: NULL or two values each, by the conventions of the ABI.
        let compliance = unsafe { bodies(shear_modulus, poisson_ratio)? }.compliance();
        let (cx, cy) = (count("cx", cx)?, count("cy", cy)?);
        table_size(cx, cy)?;
        let grid = Grid { mx: cx, my: cy, ..Grid::new(1, 1, dx, dy)? };
        if coefficients.is_null() {
            return Err(Refusal::null("coefficients"));
        }
        aligned("coefficients", coefficients, 1)?;
        let half_space = HalfSpace::new(dx, dy, compliance);
        // The largest and the smallest coefficient.
        for value in [half_space.at(0, 0), half_space.at(cx as i64, cy as i64)] {
            let rule = "element sizes and moduli take it out of the range of numbers";
            require(value > 0.0 && value.is_normal(), "a coefficient", value, rule)?;
        }
        let mut half_row = zeros(grid.mx + 1, "a row of coefficients")?;
        for row in 0..2 * grid.my {
            half_space.fill_row(0, row as i64 - grid.my as i64, &mut half_row);
            for column in 0..2 * grid.mx {
                // SAFETY: the caller's table has 2 cy by 2 cx values.
                unsafe { coefficients.add(row * 2 * grid.mx + column).write(half_row[column.abs_diff(grid.mx)]) };
            }
        }
        Ok(CONTACT_NORMAL_OK)
    })
}

/// Computes the influence coefficients of pressures for viscoelastic bodies in steady rolling, as a table over the offsets -cx to cx - 1 and -cy to
/// cy - 1: `coefficients[2 cy][2 cx]`, x fastest, as `contact_normal_influence` takes it. `shear_modulus` (the instantaneous moduli) and
/// `poisson_ratio` have two values each; of `visco` the branches, the moduli and the times are read. `speed` is the speed of rolling, positive
/// towards +x and negative towards -x. The table is not even in x. It is for the normal problem;
/// `contact_normal_influence_rolling_tangential` has the tables for friction. UNSUPPORTED: the modulus of a body relaxes to 0. NOT_FINITE,
/// INVALID_ARGUMENT: the coefficients are beyond the range of doubles. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_influence_rolling(
    cx: i32,
    cy: i32,
    dx: f64,
    dy: f64,
    shear_modulus: *const f64,
    poisson_ratio: *const f64,
    visco: *const contact_normal_visco,
    speed: f64,
    coefficients: *mut f64,
) -> contact_normal_status {
    guard(|| {
        let (materials, size) = ((shear_modulus, poisson_ratio), (dx, dy));
        let compliance = |bodies: &Bodies, b: usize| bodies.compliance_of(b);
        // SAFETY: NULL, or as many values as the comment says, by the conventions of the ABI.
        unsafe {
            write_rolling((cx, cy), size, materials, visco, compliance, coefficients, |offsets, _, bodies| {
                rolling_table(offsets, size, bodies, speed).map(|table| [table])
            })
        }
    })
}

/// Computes the tangential influence coefficients of viscoelastic bodies in steady rolling, as tables that `friction->influence` takes in steady
/// rolling: xx, yy and xy, one after the other, each over the offsets of `contact_normal_influence_rolling`: `coefficients[3][2 cy][2 cx]`. The
/// other arguments are those of that function. UNSUPPORTED: the bodies are unlike, at once or as they relax, or the modulus of a body relaxes to 0.
/// NOT_FINITE, INVALID_ARGUMENT: the coefficients are beyond the range of doubles. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_influence_rolling_tangential(
    cx: i32,
    cy: i32,
    dx: f64,
    dy: f64,
    shear_modulus: *const f64,
    poisson_ratio: *const f64,
    visco: *const contact_normal_visco,
    speed: f64,
    coefficients: *mut f64,
) -> contact_normal_status {
    guard(|| {
        let (materials, size) = ((shear_modulus, poisson_ratio), (dx, dy));
        let compliance = |bodies: &Bodies, b: usize| 0.5 / bodies.shear_modulus[b];
        // SAFETY: NULL, or as many values as the comment says, by the conventions of the ABI.
        unsafe {
            write_rolling(
                (cx, cy),
                size,
                materials,
                visco,
                compliance,
                coefficients,
                |offsets, poisson_ratio, bodies| rolling_tables(offsets, size, (bodies, poisson_ratio), speed),
            )
        }
    })
}

/// Writes the K tables that `make` computes for viscoelastic bodies in steady rolling, one after the other. `make` takes cx and cy, the Poisson
/// ratios and the bodies.
unsafe fn write_rolling<const K: usize>(
    (cx, cy): (i32, i32),
    (dx, dy): (f64, f64),
    (shear_modulus, poisson_ratio): (*const f64, *const f64),
    visco: *const contact_normal_visco,
    compliance: impl Fn(&Bodies, usize) -> f64,
    coefficients: *mut f64,
    make: impl FnOnce((usize, usize), [f64; 2], &[RollingBody; 2]) -> Result<[Vec<f64>; K], Error>,
) -> Result<contact_normal_status, Refusal> {
    // SAFETY (all): NULL, or as many values as the ABI says.
    unsafe {
        let bodies = bodies(shear_modulus, poisson_ratio)?;
        let given = structs::read(visco, "visco")?;
        let visco = given.translate()?;
        visco.check(&Grid::new(1, 1, dx, dy)?)?;
        let [one, other] = visco.series(&bodies)?;
        let (cx, cy) = (count("cx", cx)?, count("cy", cy)?);
        let size = table_size(cx, cy)?;
        if coefficients.is_null() {
            return Err(Refusal::null("coefficients"));
        }
        aligned("coefficients", coefficients, 1)?;
        let body = |b: usize, series| RollingBody { compliance: compliance(&bodies, b), series };
        let tables = make((cx, cy), bodies.poisson_ratio, &[body(0, one), body(1, other)])?;
        for (k, table) in tables.iter().enumerate() {
            std::ptr::copy_nonoverlapping(table.as_ptr(), coefficients.add(k * size), size);
        }
        Ok(CONTACT_NORMAL_OK)
    }
}
