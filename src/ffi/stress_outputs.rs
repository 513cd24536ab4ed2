//! The caller's arrays for stresses below the surface, and the largest stresses with their places.

use super::arguments::{copy_to, Regions};
use super::status::Refusal;
use super::structs::{self, versioned};
use crate::grid::Grid;
use crate::stress::{Depth, Maximum, Wanted};

/// The largest value of a stress over all depths, and its place: below the centre of an element, at one of the depths.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_stress_maximum {
    /// Set by `contact_normal_stress_maximum_init`.
    pub struct_size: i64,
    /// The largest value of the stress.
    pub value: f64,
    /// The place of the largest value in x, from the middle of the grid: (ix + 1/2 - mx/2) dx.
    pub x: f64,
    /// The place in y, from the middle of the grid: (iy + 1/2 - my/2) dy.
    pub y: f64,
    /// The depth of the place.
    pub z: f64,
    /// The element above the place: its number in x, from 0.
    pub ix: i32,
    /// The element above the place: its number in y, from 0.
    pub iy: i32,
    /// The number of the depth in `depths`, from 0.
    pub depth: i32,
    /// Always 0.
    pub reserved: i32,
}

versioned! { contact_normal_stress_maximum, contact_normal_stress_maximum_init, 56 }

/// The caller's arrays for stresses. NULL: not wanted, and not computed. Stresses are positive in tension.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_stress_outputs {
    /// Set by `contact_normal_stress_outputs_init`.
    pub struct_size: i64,
    /// The components xx, yy, zz, xy, xz, yz at n depths, `[n][my][mx]` each; default NULL.
    pub stress: [*mut f64; 6],
    /// The von Mises stress, `[n][my][mx]`, or NULL (default).
    pub von_mises: *mut f64,
    /// The largest shear stress, half of the difference between the first and the third principal stress, `[n][my][mx]`, or NULL (default).
    pub maximum_shear: *mut f64,
    /// The principal stresses, the largest first, `[n][my][mx]` each; default NULL.
    pub principal: [*mut f64; 3],
    /// The unit vectors of the directions of the principal stresses, `[n][my][mx][3]` each; default NULL.
    pub directions: [*mut f64; 3],
    /// The largest von Mises stress of all depths and its place, or NULL (default).
    pub largest_von_mises: *mut contact_normal_stress_maximum,
    /// The largest shear stress of all depths and its place, or NULL (default).
    pub largest_shear: *mut contact_normal_stress_maximum,
}

versioned! { contact_normal_stress_outputs, contact_normal_stress_outputs_init, 136 }

impl contact_normal_stress_maximum {
    /// Translates a maximum, which is at the depth z.
    pub(super) fn new(found: &Maximum, z: f64, grid: &Grid) -> contact_normal_stress_maximum {
        let Maximum { value, depth, ix, iy } = *found;
        let place = |k: usize, m: usize, d: f64| (k as f64 + 0.5 - 0.5 * m as f64) * d;
        contact_normal_stress_maximum {
            struct_size: size_of::<contact_normal_stress_maximum>() as i64,
            value,
            x: place(ix, grid.mx, grid.dx),
            y: place(iy, grid.my, grid.dy),
            z,
            ix: ix as i32,
            iy: iy as i32,
            depth: depth as i32,
            reserved: 0,
        }
    }
}

impl contact_normal_stress_outputs {
    /// The stresses that have to be computed.
    pub(super) fn wanted(&self) -> Wanted {
        Wanted {
            components: self.stress.map(|stress| !stress.is_null()),
            von_mises: !self.von_mises.is_null() || !self.largest_von_mises.is_null(),
            maximum_shear: !self.maximum_shear.is_null() || !self.largest_shear.is_null(),
            principal: self.principal.iter().any(|stress| !stress.is_null()),
            directions: self.directions.iter().any(|direction| !direction.is_null()),
        }
    }

    /// Adds the struct at `address`, and the arrays for n depths below `elements` elements, to the regions.
    pub(super) fn add_to(
        &self,
        regions: &mut Regions,
        address: *const contact_normal_stress_outputs,
        (n, elements): (usize, usize),
    ) -> Result<(), Refusal> {
        let count = n.saturating_mul(elements);
        regions.input_struct(address, self)?;
        for stress in self.stress {
            regions.output("stress", stress, count)?;
        }
        regions.output("von_mises", self.von_mises, count)?;
        regions.output("maximum_shear", self.maximum_shear, count)?;
        for (stress, direction) in self.principal.into_iter().zip(self.directions) {
            regions.output("principal", stress, count)?;
            regions.output("directions", direction, count.saturating_mul(3))?;
        }
        let largest = [("largest_von_mises", self.largest_von_mises), ("largest_shear", self.largest_shear)];
        for (name, maximum) in largest {
            // SAFETY: NULL or a struct that declares its size, by the conventions of the ABI.
            if let Some(given) = unsafe { structs::read_optional(maximum.cast_const(), name)? } {
                regions.output_struct(maximum, &given)?;
            }
        }
        Ok(())
    }

    /// Writes the wanted stresses of depth k.
    pub(super) unsafe fn write(&self, k: usize, depth: &Depth) {
        // SAFETY (all): by the caller.
        unsafe {
            for c in 0..6 {
                copy_to(&depth.stress[c], self.stress[c], k);
            }
            copy_to(&depth.von_mises, self.von_mises, k);
            copy_to(&depth.maximum_shear, self.maximum_shear, k);
            for i in 0..3 {
                copy_to(&depth.principal[i], self.principal[i], k);
                copy_to(&depth.directions[i], self.directions[i], k);
            }
        }
    }
}
