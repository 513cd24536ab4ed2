//! `contact_normal_flash_temperature`: memory that overlaps with one of its structs is refused.

use crate::call::{initialised, last_error};
use contact_normal::ffi::*;

const N: usize = 16;

#[test]
fn results_that_overlap_with_a_struct_are_refused() {
    let mut heat: contact_normal_heat = initialised(contact_normal_heat_init);
    let mut flash: contact_normal_flash = initialised(contact_normal_flash_init);
    let flux = [1.0; N];
    (heat.mx, heat.my, heat.dx, heat.dy) = (4, 4, 0.1, 0.1);
    (heat.heat_flux, heat.conductivity, heat.diffusivity) = (flux.as_ptr(), [1.0; 2], [1.0; 2]);
    let mut temperature = vec![7.0; 2 * N];
    let mut at_heat = [heat; 3];
    let own: *mut contact_normal_flash = &raw mut flash;
    let cases: [(*const contact_normal_heat, *mut f64, *mut contact_normal_flash, &str); 3] = [
        (&raw const heat, temperature.as_mut_ptr(), own, ""),
        (&raw const at_heat[0], (&raw mut at_heat[0]).cast(), own, "heat"),
        (&raw const heat, own.cast(), own, "flash"),
    ];
    for (heat, to, flash, name) in cases {
        // SAFETY: structs and arrays of this test; room for 32 values, or refused.
        let status = unsafe { contact_normal_flash_temperature(heat, to, flash) };
        if name.is_empty() {
            assert_eq!(status, CONTACT_NORMAL_OK);
            continue;
        }
        let message = last_error();
        assert!(status == CONTACT_NORMAL_INVALID_ARGUMENT && message.contains("overlap"), "{name}: {status} {message}");
        assert!(message.contains(name), "{message}");
    }
    assert!(temperature.iter().all(|rise| *rise > 0.0 && *rise < 7.0), "{temperature:?}");
}
