//! The effects that a scene may name beside `contact_normal_influence`: one struct each, NULL in the scene: not simulated.

use super::scene::contact_normal_scene;
use super::status::Refusal;
use super::structs::{self, Versioned};
use crate::grid::Grid;
use crate::influence::RowTables;
use crate::scene::{Layer, Patches, Period, PressureLimit};

/// Effect: the scene repeats itself after `mx dx` in x, after `my dy` in y, or after both: the grid is one period. With both, mean
/// displacements are zero and the approach is relative to the mean planes of the bodies (docs/effects.md).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_period {
    /// Set by `contact_normal_period_init`.
    pub struct_size: i64,
    /// 1: it repeats itself in x; 0: it does not.
    pub x: i32,
    /// The same in y.
    pub y: i32,
}

// SAFETY: integers only, struct_size first.
unsafe impl Versioned for contact_normal_period {
    const NAME: &'static str = "contact_normal_period";
    const FIRST_SIZE: usize = 16;
    fn defaults() -> Self {
        Self { struct_size: size_of::<Self>() as i64, x: 0, y: 0 }
    }
}

/// Effect: a thin compliant layer, `e = h - approach + A p + c p`. Displacements contain what the layer gives way.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_layer {
    /// Set by `contact_normal_layer_init`.
    pub struct_size: i64,
    /// c of all elements, a length per pressure, >= 0. Not read if there are `compliances`.
    pub compliance: f64,
    /// c of each element, `[my][mx]`, or NULL.
    pub compliances: *const f64,
}

// SAFETY: integers, floats and raw pointers only, struct_size first.
unsafe impl Versioned for contact_normal_layer {
    const NAME: &'static str = "contact_normal_layer";
    const FIRST_SIZE: usize = 24;
    fn defaults() -> Self {
        Self { struct_size: size_of::<Self>() as i64, compliance: 0.0, compliances: std::ptr::null() }
    }
}

/// Effect: pressures do not exceed a limit, the hardness of the softer surface. Elements at the limit have `contact` 2 and a
/// `deformed_distance` <= 0: the plastic penetration, with its sign turned.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_pressure_limit {
    /// Set by `contact_normal_pressure_limit_init`.
    pub struct_size: i64,
    /// The limit of all elements, a pressure > 0; +infinity: none. Not read if there are `limits`.
    pub limit: f64,
    /// That of each element, `[my][mx]`, or NULL.
    pub limits: *const f64,
}

// SAFETY: integers, floats and raw pointers only, struct_size first.
unsafe impl Versioned for contact_normal_pressure_limit {
    const NAME: &'static str = "contact_normal_pressure_limit";
    const FIRST_SIZE: usize = 24;
    fn defaults() -> Self {
        Self { struct_size: size_of::<Self>() as i64, limit: f64::INFINITY, limits: std::ptr::null() }
    }
}

/// Effect: several contact patches on one grid, whose interaction is scaled: for patches on planes of their own.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_patches {
    /// Set by `contact_normal_patches_init`.
    pub struct_size: i64,
    /// Number of patches, 1 to 64. Each costs a product.
    pub count: i32,
    /// Always 0.
    pub reserved: i32,
    /// The patch of each element, `[my][mx]`: 0 to count - 1.
    pub patch: *const i32,
    /// `[count][count]`, symmetric: 1 on the diagonal, elsewhere in [0, 1]. 0: independent, 1: as if there were no patches.
    pub factors: *const f64,
}

// SAFETY: integers and raw pointers only, struct_size first.
unsafe impl Versioned for contact_normal_patches {
    const NAME: &'static str = "contact_normal_patches";
    const FIRST_SIZE: usize = 32;
    fn defaults() -> Self {
        let (patch, factors) = (std::ptr::null(), std::ptr::null());
        Self { struct_size: size_of::<Self>() as i64, count: 0, reserved: 0, patch, factors }
    }
}

/// Effect: own coefficients that differ per loaded row, instead of the half-space: conformal contact, an inclination that varies along
/// y. Nothing is assumed of them but that a pressure displaces its own element inwards. Memory and time of a product grow with
/// my * my * mx.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_row_tables {
    /// Set by `contact_normal_row_tables_init`.
    pub struct_size: i64,
    /// The tables cover offsets -cx..cx-1 in x; cx >= mx.
    pub cx: i32,
    /// Number of tables, and rows of each: my.
    pub rows: i32,
    /// `[rows][rows][2 cx]`, x fastest: the bytes of a Fortran `cf(-cx:cx-1, my, my)`. `A_IJ = cf(ix - jx, iy, jy)`: the displacement of
    /// element (ix, iy) by a unit pressure on element (jx, jy). Column -cx is never read.
    pub coefficients: *const f64,
}

// SAFETY: integers and raw pointers only, struct_size first.
unsafe impl Versioned for contact_normal_row_tables {
    const NAME: &'static str = "contact_normal_row_tables";
    const FIRST_SIZE: usize = 24;
    fn defaults() -> Self {
        Self { struct_size: size_of::<Self>() as i64, cx: 0, rows: 0, coefficients: std::ptr::null() }
    }
}

/// Fills row tables with nothing. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_row_tables_init(tables: *mut contact_normal_row_tables) {
    // SAFETY: NULL or a whole struct, by the conventions of the ABI.
    unsafe { structs::init(tables) }
}

/// Fills patches with none. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_patches_init(patches: *mut contact_normal_patches) {
    // SAFETY: NULL or a whole struct, by the conventions of the ABI.
    unsafe { structs::init(patches) }
}

/// Fills a period with none. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_period_init(period: *mut contact_normal_period) {
    // SAFETY: NULL or a whole struct, by the conventions of the ABI.
    unsafe { structs::init(period) }
}

/// Fills a layer with a compliance of 0. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_layer_init(layer: *mut contact_normal_layer) {
    // SAFETY: as above.
    unsafe { structs::init(layer) }
}

/// Fills a pressure limit with +infinity. Since 0.1.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_pressure_limit_init(limit: *mut contact_normal_pressure_limit) {
    // SAFETY: as above.
    unsafe { structs::init(limit) }
}

/// The effects of a scene. The caller's arrays must live as long as the result is used.
pub(super) struct Effects<'a> {
    pub period: Option<Period>,
    pub layer: Option<Layer<'a>>,
    pub pressure_limit: Option<PressureLimit<'a>>,
    pub patches: Option<Patches<'a>>,
    pub row_tables: Option<RowTables>,
}

/// `has_row_tables`: a solver has them already, and those of the scene are not read.
pub(super) unsafe fn translate<'a>(
    scene: &contact_normal_scene,
    grid: &Grid,
    has_row_tables: bool,
) -> Result<Effects<'a>, Refusal> {
    // SAFETY (all): NULL or structs that declare their size, with arrays of one value per element, by the conventions of the ABI.
    unsafe {
        let period = named(scene.period, "scene->period")?;
        let layer = named(scene.layer, "scene->layer")?;
        let limit = named(scene.pressure_limit, "scene->pressure_limit")?;
        let patches = named(scene.patches, "scene->patches")?;
        let row_tables = if has_row_tables { None } else { named(scene.row_tables, "scene->row_tables")? };
        Ok(Effects {
            period: period.map(translate_period).transpose()?,
            layer: layer.map(|layer| match per_element(layer.compliances, grid) {
                Some(compliances) => Layer::PerElement(compliances),
                None => Layer::Uniform(layer.compliance),
            }),
            pressure_limit: limit.map(|limit| match per_element(limit.limits, grid) {
                Some(limits) => PressureLimit::PerElement(limits),
                None => PressureLimit::Uniform(limit.limit),
            }),
            patches: patches.map(|patches| translate_patches(patches, grid)).transpose()?,
            row_tables: row_tables.map(|tables| translate_row_tables(tables, grid)).transpose()?,
        })
    }
}

/// An effect, or none.
unsafe fn named<T: Versioned>(effect: *const T, name: &str) -> Result<Option<T>, Refusal> {
    // SAFETY: by the caller.
    (!effect.is_null()).then(|| unsafe { structs::read(effect, name) }).transpose()
}

/// The caller's array, or none.
unsafe fn per_element<'a, T>(values: *const T, grid: &Grid) -> Option<&'a [T]> {
    // SAFETY: by the caller.
    (!values.is_null()).then(|| unsafe { std::slice::from_raw_parts(values, grid.len()) })
}

fn translate_period(period: contact_normal_period) -> Result<Period, Refusal> {
    let yes = |name: &str, value: i32| match value {
        0 => Ok(false),
        1 => Ok(true),
        other => Err(Refusal::invalid(format!("{name} is {other}; it must be 0 or 1"))),
    };
    Ok(Period { x: yes("period->x", period.x)?, y: yes("period->y", period.y)? })
}

/// SAFETY: arrays of one value per element, and of count by count values.
unsafe fn translate_patches<'a>(patches: contact_normal_patches, grid: &Grid) -> Result<Patches<'a>, Refusal> {
    if patches.reserved != 0 {
        return Err(Refusal::invalid(format!("patches->reserved is {}; it must be 0", patches.reserved)));
    }
    let count = super::scene::count("patches->count", patches.count)?;
    if patches.factors.is_null() {
        return Err(Refusal::null("scene->patches->factors"));
    }
    // SAFETY: by the caller.
    let patch = unsafe { per_element(patches.patch, grid) }.ok_or_else(|| Refusal::null("scene->patches->patch"))?;
    // What there are too many of is refused before it is looked at.
    let values = if count <= 1024 { count * count } else { 0 };
    // SAFETY: by the caller.
    let factors = unsafe { std::slice::from_raw_parts(patches.factors, values) };
    Ok(Patches { count, patch, factors })
}

/// SAFETY: rows by rows by 2 cx coefficients.
unsafe fn translate_row_tables(tables: contact_normal_row_tables, grid: &Grid) -> Result<RowTables, Refusal> {
    let cx = super::scene::count("row_tables->cx", tables.cx)?;
    let rows = super::scene::count("row_tables->rows", tables.rows)?;
    if tables.coefficients.is_null() {
        return Err(Refusal::null("scene->row_tables->coefficients"));
    }
    // What is not that of the grid is refused before it is looked at.
    let rows_read = if rows == grid.my && cx >= grid.mx { rows } else { 0 };
    let size = rows_read.checked_mul(rows_read).and_then(|n| n.checked_mul(2)).and_then(|n| n.checked_mul(cx));
    let size = size.filter(|n| *n <= isize::MAX as usize / 8).ok_or_else(|| {
        Refusal::invalid(format!("rows * rows * 2 cx is {rows} * {rows} * 2 * {cx}; no row tables are that large"))
    })?;
    // SAFETY: by the caller.
    let values = unsafe { std::slice::from_raw_parts(tables.coefficients, size) };
    Ok(RowTables::new(cx, rows, values, grid)?)
}
