//! `contact_normal_flash_temperature`: the temperature of two surfaces that slide on each other.

use super::arguments::{copy_to, count, not_negative, reserved, Regions};
use super::guard::guard;
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::structs::{self, versioned};
use crate::grid::Grid;
use crate::heat::{flash_temperature, Heat};
use crate::solver::check_threads;
use crate::threads::Threads;

/// A steady flux of heat through the contact of two bodies whose surfaces move in x. Units of power, length, temperature and time are the
/// caller's, the same everywhere.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_heat {
    /// Set by `contact_normal_heat_init`.
    pub struct_size: i64,
    /// Elements in x. Default 0: to be set.
    pub mx: i32,
    /// Elements in y. Default 0: to be set.
    pub my: i32,
    /// Element size in x. Default 0: to be set.
    pub dx: f64,
    /// Element size in y. Default 0: to be set.
    pub dy: f64,
    /// The heat flux into both bodies, `[my][mx]`, a power per area: with friction |q| times the slip velocity. A negative flux cools. Default NULL:
    /// to be set.
    pub heat_flux: *const f64,
    /// The conductivity lambda of body 1 and of body 2, a power per length and temperature. Default 0: to be set.
    pub conductivity: [f64; 2],
    /// The diffusivity kappa = lambda/(density times heat capacity) of body 1 and of body 2, an area per time. Default 0: to be set.
    pub diffusivity: [f64; 2],
    /// The velocity with which each surface moves past the contact, positive towards +x, a length per time; 0 (default): the surface is at rest. For
    /// bodies that roll towards +x at V both are -V.
    pub speed: [f64; 2],
    /// The part of the heat that flows into body 1, 0 to 1. < 0 (default): the part with which the largest temperatures of both bodies are equal
    /// (Blok 1937), or one half if no part of the heat warms one of both bodies.
    pub share: f64,
    /// The number of threads; default 1; 0: all cores.
    pub threads: i32,
    /// Must be 0.
    pub reserved: i32,
}

versioned! { contact_normal_heat, contact_normal_heat_init, 104, share: -1.0, threads: 1 }

/// The results of `contact_normal_flash_temperature`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_flash {
    /// Set by `contact_normal_flash_init`.
    pub struct_size: i64,
    /// The part of the heat that flows into body 1.
    pub share: f64,
    /// The largest rise of the temperature of body 1 and of body 2.
    pub largest: [f64; 2],
    /// The place of the largest rise in x, from the middle of the grid, for body 1 and body 2.
    pub x: [f64; 2],
    /// The place of the largest rise in y, from the middle of the grid, for body 1 and body 2.
    pub y: [f64; 2],
}

versioned! { contact_normal_flash, contact_normal_flash_init, 64 }

/// Computes the steady flash temperature of both surfaces: the rise above the temperature far away. Each body is a half-space past which the sources
/// of heat move (Jaeger 1942); without motion the sources are at rest. `temperature` `[2][my][mx]` gets the rise of body 1, then that of body 2;
/// NULL: not wanted. `flash` NULL: not wanted. The grid must contain the whole flux; the rise downstream of the grid is not computed. The set-up
/// takes some hundred function values for each element and body; the products are made by FFT. INVALID_ARGUMENT, NOT_FINITE: numbers are out of their
/// range. NOT_FINITE: the temperatures are beyond the range of doubles. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_flash_temperature(
    heat: *const contact_normal_heat,
    temperature: *mut f64,
    flash: *mut contact_normal_flash,
) -> contact_normal_status {
    guard(|| {
        // SAFETY (all): NULL or as the conventions of the ABI say.
        unsafe {
            let given = structs::read(heat, "heat")?;
            let (mx, my) = (count("heat->mx", given.mx)?, count("heat->my", given.my)?);
            reserved("heat->reserved", given.reserved)?;
            let grid = Grid::new(mx, my, given.dx, given.dy)?;
            let given_flash = structs::read_optional(flash.cast_const(), "flash")?;
            let mut regions = Regions::default();
            regions.input_struct(heat, &given)?;
            if let Some(given_flash) = &given_flash {
                regions.output_struct(flash, given_flash)?;
            }
            regions.input("heat->heat_flux", given.heat_flux, grid.len())?;
            regions.output("temperature", temperature, 2 * grid.len())?;
            regions.check()?;
            let flux = super::arguments::required("heat->heat_flux", given.heat_flux, grid.len())?;
            let share = Some(given.share).filter(|share| !(*share < 0.0));
            let contact_normal_heat { conductivity, diffusivity, speed, .. } = given;
            let threads = not_negative("heat->threads", given.threads)?;
            check_threads("heat->threads", threads)?;
            let threads = Threads::new(threads)?;
            let found = flash_temperature(&Heat { grid, flux, conductivity, diffusivity, speed, share }, &threads)?;
            found.rise.iter().enumerate().for_each(|(b, rise)| copy_to(rise, temperature, b));
            if let Some(mut value) = given_flash {
                (value.share, value.largest) = (found.share, found.largest);
                for (b, i) in found.at.into_iter().enumerate() {
                    [value.x[b], value.y[b]] = grid.place(i);
                }
                structs::write(flash, &value)?;
            }
            Ok::<_, Refusal>(CONTACT_NORMAL_OK)
        }
    })
}
