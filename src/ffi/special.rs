//! Closed forms and coefficient tables.

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

/// The exact Hertz solution.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_hertz_solution {
    /// Set by `contact_normal_hertz_solution_init`.
    pub struct_size: i64,
    /// Semi-axis of the contact ellipse in x.
    pub semi_axis_x: f64,
    /// Semi-axis in y.
    pub semi_axis_y: f64,
    /// Pressure at the centre.
    pub max_pressure: f64,
    /// Approach.
    pub approach: f64,
    /// Normal force.
    pub force: f64,
    /// Area of the ellipse.
    pub area: f64,
}

versioned! { contact_normal_hertz_solution, contact_normal_hertz_solution_init, 56 }

/// The bodies from two shear moduli and two Poisson's ratios.
unsafe fn bodies(shear_modulus: *const f64, poisson_ratio: *const f64) -> Result<Bodies, Refusal> {
    // SAFETY: NULL or two values each, by the conventions of the ABI.
    let (moduli, ratios) =
        unsafe { (required("shear_modulus", shear_modulus, 2)?, required("poisson_ratio", poisson_ratio, 2)?) };
    let bodies = Bodies { shear_modulus: [moduli[0], moduli[1]], poisson_ratio: [ratios[0], ratios[1]] };
    bodies.check()?;
    Ok(bodies)
}

/// Exact contact of two bodies with `h = curvature_x x^2 + curvature_y y^2` (1/length, positive), for `load`
/// PRESCRIBED_APPROACH or PRESCRIBED_FORCE with the value `amount`. `shear_modulus` and `poisson_ratio`: two values. Since 0.1.
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

/// The influence coefficients of the half-space for elements `dx` by `dy`, as a table over offsets -cx..cx-1 by -cy..cy-1:
/// `coefficients[2 cy][2 cx]`, x fastest, as `contact_normal_influence` takes it. NOT_FINITE, INVALID_ARGUMENT: coefficients beyond the range of
/// doubles. Since 0.1.
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
        // The largest and the smallest one.
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

/// The influence coefficients of bodies that relax and roll steadily, without a change in time, as a table over offsets -cx..cx-1 by -cy..cy-1:
/// `coefficients[2 cy][2 cx]`, x fastest, as `contact_normal_influence` takes it. `shear_modulus` and `poisson_ratio`: two values each, the moduli those at
/// once; of `visco` the branches, moduli and times are read. `speed`: how fast the bodies roll towards +x; < 0: towards -x. The table is not even in x, so
/// it serves the normal problem. UNSUPPORTED: a body of whose modulus nothing is left in the end. NOT_FINITE, INVALID_ARGUMENT: coefficients
/// beyond the range of doubles. Since 0.2.
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

/// The tangential influence coefficients of bodies that relax and roll steadily, as tables that `friction->influence` takes in steady rolling: `xx`, `yy` and
/// `xy`, one after the other, each over the offsets of `contact_normal_influence_rolling`: `coefficients[3][2 cy][2 cx]`. The other arguments are those of that
/// function. UNSUPPORTED: unlike bodies, at once or as they relax, and a body of whose modulus nothing is left in the end. NOT_FINITE, INVALID_ARGUMENT:
/// coefficients beyond the range of doubles. Since 0.2.
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

/// Writes K tables of bodies that relax and roll steadily, one after the other. `make` takes the numbers of offsets, Poisson's ratios and the bodies.
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
