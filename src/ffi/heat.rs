//! `contact_normal_flash_temperature`.

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
    /// Length of an element in x. Default 0: to be set.
    pub dx: f64,
    /// In y. Default 0: to be set.
    pub dy: f64,
    /// The flux, `[my][mx]`, a power per area: of friction |q| times the speed of slip; below 0 it cools. Default NULL: to be set.
    pub heat_flux: *const f64,
    /// lambda of body 1 and 2, power per length and temperature. Default 0: to be set.
    pub conductivity: [f64; 2],
    /// kappa = lambda/(density times heat capacity) of both, area per time. Default 0: to be set.
    pub diffusivity: [f64; 2],
    /// How fast each surface moves past the contact in +x, length per time, of any sign; 0 (default): it stands still. Of bodies that roll towards
    /// +x at V both are -V.
    pub speed: [f64; 2],
    /// The part of the heat that goes into body 1, 0 to 1; < 0 (default): that for which the largest temperatures of both are the same (Blok 1937),
    /// and one half where no heat makes one of both warmer.
    pub share: f64,
    /// Threads; 1: one (default), 0: all cores.
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
    /// The part of the heat that goes into body 1.
    pub share: f64,
    /// The largest rise of body 1 and 2, a temperature.
    pub largest: [f64; 2],
    /// Where that is in x, from the middle of the grid, of body 1 and 2.
    pub x: [f64; 2],
    /// And in y.
    pub y: [f64; 2],
}

versioned! { contact_normal_flash, contact_normal_flash_init, 64 }

/// The steady flash temperature of both surfaces, above the temperature far away: each body is a half-space past which the sources of heat move
/// (Jaeger 1942). Without motion it is that of a source at rest. `temperature`: `[2][my][mx]`, of body 1, then of body 2; NULL: not wanted.
/// `flash` NULL: not wanted. The grid must hold all of the flux; downstream of it a rise beyond the grid is not computed. Products are FFTs; the
/// set-up takes some hundred function values an element and body. INVALID_ARGUMENT, NOT_FINITE: numbers out of their range; NOT_FINITE: temperatures
/// beyond the range of numbers. Since 0.2.
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
            let written = structs::read_optional(flash.cast_const(), "flash")?;
            let mut regions = Regions::default();
            regions.input_struct(heat, &given)?;
            if let Some(written) = &written {
                regions.output_struct(flash, written)?;
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
            if let Some(mut value) = written {
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
