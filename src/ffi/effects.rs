//! The structs of the effects period, layer, pressure limit and patches.

use super::arguments::{count, optional, required, reserved, switch, GivenEffect, Regions};
use super::status::Refusal;
use super::structs::versioned;
use crate::effects::MOST_PATCHES;
use crate::grid::Grid;
use crate::scene::{Each, Layer, Patches, Period, PressureLimit};

/// Effect: the scene is periodic in x with the period `mx dx`, in y with the period `my dy`, or in both directions: the grid is one period. With two
/// periods the mean displacement is zero, and the approach is relative to the mean planes of the bodies (docs/effects.md).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_period {
    /// Set by `contact_normal_period_init`.
    pub struct_size: i64,
    /// 1: the scene is periodic in x; 0 (default): it is not.
    pub x: i32,
    /// 1: the scene is periodic in y; 0 (default): it is not.
    pub y: i32,
}

versioned! { contact_normal_period, contact_normal_period_init, 16 }

/// Effect: a thin compliant layer between the bodies, `e = h - approach + A p + c p`. Displacements contain the compression of the layer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_layer {
    /// Set by `contact_normal_layer_init`.
    pub struct_size: i64,
    /// The compliance c of all elements, a length per pressure, >= 0; default 0. Not read if there are `compliances`.
    pub compliance: f64,
    /// The compliance c of each element, `[my][mx]`, or NULL (default).
    pub compliances: *const f64,
}

versioned! { contact_normal_layer, contact_normal_layer_init, 24 }

/// Effect: pressures do not exceed a limit, the hardness of the softer surface. Elements at the limit have `contact` 2 and a
/// `deformed_distance` <= 0, which is minus the depth of the plastic indentation. The indentation has no memory: unloading follows the same path as
/// loading.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_pressure_limit {
    /// Set by `contact_normal_pressure_limit_init`.
    pub struct_size: i64,
    /// The limit of all elements, a pressure > 0; +infinity (default): no limit. Not read if there are `limits`.
    pub limit: f64,
    /// The limit of each element, `[my][mx]`, or NULL (default).
    pub limits: *const f64,
}

versioned! { contact_normal_pressure_limit, contact_normal_pressure_limit_init, 24, limit: f64::INFINITY }

/// Effect: several contact patches on one grid, with a factor on the influence of each patch on each other one: for patches that lie in different
/// planes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_patches {
    /// Set by `contact_normal_patches_init`.
    pub struct_size: i64,
    /// The number of patches, 1 to 64; default 0: to be set. Each patch adds the cost of a product.
    pub count: i32,
    /// Always 0.
    pub reserved: i32,
    /// The patch of each element, `[my][mx]`: 0 to count - 1. -1: the element belongs to no patch and stays exterior; its displacement is that of an
    /// element of patch 0. Default NULL: to be set.
    pub patch: *const i32,
    /// The factor between each pair of patches, `[count][count]`, symmetric: 1 on the diagonal, elsewhere in [0, 1]. 0: the two patches do not
    /// influence each other; 1: their influence is unchanged. Default NULL: to be set.
    pub factors: *const f64,
}

versioned! { contact_normal_patches, contact_normal_patches_init, 32 }

impl contact_normal_period {
    pub(super) fn translate(&self) -> Result<Period, Refusal> {
        Ok(Period { x: switch("period->x", self.x)?, y: switch("period->y", self.y)? })
    }
}

impl GivenEffect for contact_normal_period {}

impl contact_normal_layer {
    /// The caller's array must live as long as the result is used.
    pub(super) unsafe fn translate<'a>(&self, grid: &Grid) -> Layer<'a> {
        // SAFETY: NULL or one value per element, by the conventions of the ABI.
        Layer(Each::of(unsafe { optional(self.compliances, grid.len()) }, self.compliance))
    }
}

impl GivenEffect for contact_normal_layer {
    fn add_to(&self, regions: &mut Regions, grid: &Grid) -> Result<(), Refusal> {
        regions.input("layer->compliances", self.compliances, grid.len())
    }
}

impl contact_normal_pressure_limit {
    /// The caller's array must live as long as the result is used.
    pub(super) unsafe fn translate<'a>(&self, grid: &Grid) -> PressureLimit<'a> {
        // SAFETY: NULL or one value per element, by the conventions of the ABI.
        PressureLimit(Each::of(unsafe { optional(self.limits, grid.len()) }, self.limit))
    }
}

impl GivenEffect for contact_normal_pressure_limit {
    fn add_to(&self, regions: &mut Regions, grid: &Grid) -> Result<(), Refusal> {
        regions.input("pressure_limit->limits", self.limits, grid.len())
    }
}

impl contact_normal_patches {
    /// The caller's arrays must live as long as the result is used.
    pub(super) unsafe fn translate<'a>(&self, grid: &Grid) -> Result<Patches<'a>, Refusal> {
        reserved("patches->reserved", self.reserved)?;
        let count = count("patches->count", self.count)?;
        // SAFETY: NULL or count by count values, and one per element, by the conventions of the ABI.
        let (factors, patch) = unsafe {
            (
                required("scene->patches->factors", self.factors, self.factor_count())?,
                required("scene->patches->patch", self.patch, grid.len())?,
            )
        };
        Ok(Patches { count, patch, factors })
    }

    /// The number of factors that are read: none for too many patches, whose count the core refuses.
    fn factor_count(&self) -> usize {
        usize::try_from(self.count).ok().filter(|count| *count <= MOST_PATCHES).map_or(0, |count| count * count)
    }
}

impl GivenEffect for contact_normal_patches {
    fn add_to(&self, regions: &mut Regions, grid: &Grid) -> Result<(), Refusal> {
        regions.input("patches->patch", self.patch, grid.len())?;
        regions.input("patches->factors", self.factors, self.factor_count())
    }
}
