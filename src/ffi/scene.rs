//! `contact_normal_scene` and its effects.

use super::effects::{
    self, contact_normal_layer, contact_normal_patches, contact_normal_period, contact_normal_pressure_limit,
    contact_normal_row_tables, Effects,
};
use super::status::Refusal;
use super::structs::{self, Versioned};
use crate::grid::Grid;
use crate::influence::Table;
use crate::scene::{Bodies, Load, Scene};

/// `load`: the approach of the bodies is given.
pub const CONTACT_NORMAL_PRESCRIBED_APPROACH: i32 = 0;
/// `load`: the normal force is given, the approach is found.
pub const CONTACT_NORMAL_PRESCRIBED_FORCE: i32 = 1;

/// Effect: the caller's own influence coefficients instead of the half-space. Nothing is assumed of them but that a pressure
/// displaces its own element inwards: they need be neither symmetric nor positive.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_influence {
    /// Set by `contact_normal_influence_init`.
    pub struct_size: i64,
    /// The table covers offsets -cx..cx-1; cx >= mx.
    pub cx: i32,
    /// And -cy..cy-1; cy >= my.
    pub cy: i32,
    /// `[2 cy][2 cx]`, x fastest: the bytes of a Fortran `cf(-cx:cx-1, -cy:cy-1)`. `A_IJ = cf(ix - jx, iy - jy)`: the displacement
    /// of element I by a unit pressure on element J (length per pressure). Row -cy and column -cx are never read.
    pub coefficients: *const f64,
}

// SAFETY: integers and raw pointers only, struct_size first.
unsafe impl Versioned for contact_normal_influence {
    const NAME: &'static str = "contact_normal_influence";
    const FIRST_SIZE: usize = 24;
    fn defaults() -> Self {
        Self { struct_size: size_of::<Self>() as i64, cx: 0, cy: 0, coefficients: std::ptr::null() }
    }
}

/// What is simulated: `e = h - approach + A p`, with e = 0 and p >= 0 in contact, e > 0 and p = 0 outside. Any consistent
/// system of units.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_scene {
    /// Set by `contact_normal_scene_init`.
    pub struct_size: i64,
    /// Elements in x, >= 1.
    pub mx: i32,
    /// Elements in y, >= 1.
    pub my: i32,
    /// Element size in x: a length.
    pub dx: f64,
    /// Element size in y.
    pub dy: f64,
    /// h, `[my][mx]`, x fastest: a length. +infinity: no surface there, the element stays exterior.
    pub undeformed_distance: *const f64,
    /// G of the two bodies: a pressure, positive; +infinity: rigid (one of them at most).
    pub shear_modulus: [f64; 2],
    /// nu of the two bodies, in (-1, 0.5].
    pub poisson_ratio: [f64; 2],
    /// CONTACT_NORMAL_PRESCRIBED_APPROACH or _FORCE.
    pub load: i32,
    /// Always 0.
    pub reserved: i32,
    /// Prescribed approach (penetration): a length.
    pub approach: f64,
    /// Prescribed force, the sum of p dx dy: >= 0.
    pub force: f64,
    /// Effect, or NULL: own coefficients instead of the half-space. The elastic constants are then not used.
    pub influence: *const contact_normal_influence,
    /// Effect, or NULL: a thin compliant layer.
    pub layer: *const contact_normal_layer,
    /// Effect, or NULL: pressures do not exceed a limit.
    pub pressure_limit: *const contact_normal_pressure_limit,
    /// Effect, or NULL: the scene repeats itself.
    pub period: *const contact_normal_period,
    /// Effect, or NULL: several contact patches, whose interaction is scaled.
    pub patches: *const contact_normal_patches,
    /// Effect, or NULL: own coefficients, one table per loaded row. The elastic constants are then not used.
    pub row_tables: *const contact_normal_row_tables,
}

// SAFETY: integers, floats and raw pointers only, struct_size first.
unsafe impl Versioned for contact_normal_scene {
    const NAME: &'static str = "contact_normal_scene";
    const FIRST_SIZE: usize = 104;
    fn defaults() -> Self {
        Self {
            struct_size: size_of::<Self>() as i64,
            mx: 0,
            my: 0,
            dx: 0.0,
            dy: 0.0,
            undeformed_distance: std::ptr::null(),
            shear_modulus: [0.0; 2],
            poisson_ratio: [0.0; 2],
            load: CONTACT_NORMAL_PRESCRIBED_APPROACH,
            reserved: 0,
            approach: 0.0,
            force: 0.0,
            influence: std::ptr::null(),
            layer: std::ptr::null(),
            pressure_limit: std::ptr::null(),
            period: std::ptr::null(),
            patches: std::ptr::null(),
            row_tables: std::ptr::null(),
        }
    }
}

/// Fills a scene with nothing: sizes, elastic constants and the undeformed distance have to be set. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_scene_init(scene: *mut contact_normal_scene) {
    // SAFETY: NULL or a whole struct, by the conventions of the ABI.
    unsafe { structs::init(scene) }
}

/// Fills an influence table with nothing. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_influence_init(influence: *mut contact_normal_influence) {
    // SAFETY: as above.
    unsafe { structs::init(influence) }
}

/// A positive count from a C integer.
pub(super) fn count(name: &str, value: i32) -> Result<usize, Refusal> {
    match usize::try_from(value) {
        Ok(value) if value > 0 => Ok(value),
        _ => Err(Refusal::invalid(format!("{name} is {value}; it must be positive"))),
    }
}

/// Translates a scene. The caller's arrays must live as long as the result is used.
pub(super) unsafe fn translate<'a>(scene: *const contact_normal_scene) -> Result<Scene<'a>, Refusal> {
    // SAFETY: by the caller.
    let scene = unsafe { translate_for(scene, Known::default())? };
    scene.check()?;
    Ok(scene)
}

/// What is known from elsewhere: that is not read.
#[derive(Clone, Copy, Default)]
pub(super) struct Known {
    /// A solver has a table of its own.
    pub influence: bool,
    /// Or one per loaded row.
    pub row_tables: bool,
    /// The undeformed distance comes from a callback: that of the scene is empty.
    pub distance: bool,
}

/// The same without what is known. The caller checks the rest.
pub(super) unsafe fn translate_for<'a>(scene: *const contact_normal_scene, known: Known) -> Result<Scene<'a>, Refusal> {
    // SAFETY: NULL or a struct that declares its size.
    let scene = unsafe { structs::read(scene, "scene")? };
    let grid = Grid::new(count("mx", scene.mx)?, count("my", scene.my)?, scene.dx, scene.dy)?;
    if scene.reserved != 0 {
        return Err(Refusal::invalid(format!("scene->reserved is {}; it must be 0", scene.reserved)));
    }
    let load = match scene.load {
        CONTACT_NORMAL_PRESCRIBED_APPROACH => Load::Approach(scene.approach),
        CONTACT_NORMAL_PRESCRIBED_FORCE => Load::Force(scene.force),
        other => {
            return Err(Refusal::invalid(format!(
                "load is {other}; it must be PRESCRIBED_APPROACH (0) or PRESCRIBED_FORCE (1)"
            )))
        }
    };
    let h: &[f64] = match (known.distance, scene.undeformed_distance.is_null()) {
        (false, true) => return Err(Refusal::null("scene->undeformed_distance")),
        // SAFETY: the caller passes my * mx values, by the conventions of the ABI.
        (false, false) => unsafe { std::slice::from_raw_parts(scene.undeformed_distance, grid.len()) },
        (true, _) => &[],
    };
    let bodies = Bodies { shear_modulus: scene.shear_modulus, poisson_ratio: scene.poisson_ratio };
    let influence = if scene.influence.is_null() || known.influence {
        None
    } else {
        // SAFETY: not null: a struct that declares its size.
        Some(unsafe { translate_influence(scene.influence, &grid)? })
    };
    // SAFETY: as for the scene.
    let Effects { period, layer, pressure_limit, patches, row_tables } =
        unsafe { effects::translate(&scene, &grid, known.row_tables)? };
    let undeformed_distance = h;
    Ok(Scene { grid, undeformed_distance, bodies, load, influence, period, layer, pressure_limit, patches, row_tables })
}

/// Number of values in a table of coefficients.
pub(super) fn table_size(cx: usize, cy: usize) -> Result<usize, Refusal> {
    let size = cx.checked_mul(cy).and_then(|n| n.checked_mul(4)).filter(|n| *n <= isize::MAX as usize / 8);
    size.ok_or_else(|| Refusal::invalid(format!("cx * cy is {cx} * {cy}; no influence table is that large")))
}

unsafe fn translate_influence(influence: *const contact_normal_influence, grid: &Grid) -> Result<Table, Refusal> {
    // SAFETY: by the caller.
    let influence = unsafe { structs::read(influence, "scene->influence")? };
    let (cx, cy) = (count("influence->cx", influence.cx)?, count("influence->cy", influence.cy)?);
    if influence.coefficients.is_null() {
        return Err(Refusal::null("scene->influence->coefficients"));
    }
    let size = table_size(cx, cy)?;
    // SAFETY: the caller passes 2 cy by 2 cx values, by the conventions of the ABI.
    let values = unsafe { std::slice::from_raw_parts(influence.coefficients, size) };
    Ok(Table::new(cx, cy, values, grid)?)
}
