//! Stresses below the surface: `contact_normal_subsurface_stress`, `contact_normal_stress_at_points`.

use super::arguments::{not_negative, optional, required, Regions};
use super::conclusion::Conclusion;
use super::dump::{given, recorded, Recording};
use super::options::{self, contact_normal_options, Translated};
use super::scene::{contact_normal_scene, Named};
use super::status::{contact_normal_status, Refusal, CONTACT_NORMAL_OK};
use super::stress_outputs::{contact_normal_stress_maximum, contact_normal_stress_outputs};
use super::structs;
use super::watcher::{why, Watcher};
use crate::memory::zeros;
use crate::progress::{Outcome, ProgressCallback};
use crate::scene::Scene;
use crate::stress::{self, Body, Loads, Maximum};
use crate::threads::Threads;

/// Stresses in the half-space that is `body` 1 or 2 of a scene, at n depths below the centres of its elements: from pressures and tractions
/// `[my][mx]`, constant on each element. NULL: none; one of them at least must be given. Tractions are those that act on this body, in +x
/// and +y; depths, >= 0 and in any order, go into it. Of the scene the grid, the Poisson ratio of the body, a `period` in both directions,
/// and `patches` matter: below an element of a patch the loads on another one count times the factor between both, and below one of no patch
/// all loads in full. With a `coating` on this body, `influence`, `row_tables` or a period in one direction: UNSUPPORTED. Of the options (NULL:
/// the defaults) `threads`, `progress`, `max_seconds`, `stop` and `dump` matter; a cycle is a depth. CANCELLED, or ITERATION_LIMIT by `max_seconds`: the
/// depths done so far are written, others are left alone. Loads must lie below 1e304. Without a depth the largest stresses are left alone. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_subsurface_stress(
    scene: *const contact_normal_scene,
    body: i32,
    pressure: *const f64,
    traction_x: *const f64,
    traction_y: *const f64,
    depths: *const f64,
    n: i32,
    options: *const contact_normal_options,
    outputs: *mut contact_normal_stress_outputs,
) -> contact_normal_status {
    let arguments = given![scene, body, pressure, traction_x, traction_y, depths, n, options, outputs];
    let compute = |recording: &mut Recording<'_>| {
        // SAFETY (all): NULL or as the conventions of the ABI say.
        unsafe {
            let load = Load { scene, body, options, arrays: [pressure, traction_x, traction_y] };
            let n = not_negative("n", n)?;
            let written = structs::read(outputs.cast_const(), "outputs")?;
            let mut regions = Regions::default();
            let elements = load.add_to(&mut regions)?;
            regions.input("depths", depths, n)?;
            written.add_to(&mut regions, outputs, (n, elements))?;
            recording.keep(&regions);
            regions.check()?;
            let (scene, options) = load.read()?;
            let (body, loads) = load.on(&scene)?;
            let depths = if n == 0 { &[] } else { required("depths", depths, n)? };
            let watcher = Watcher::of(&options);
            let told = &mut watcher.told();
            let found = run(&body, &loads, depths, (&options, &written), watcher.callback(told))?;
            watcher.conclusion(found).conclude()
        }
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_subsurface_stress", options, arguments, compute) }
}

/// Stresses as `contact_normal_subsurface_stress` has them, at n `points` `[n][3]`: x and y from the middle of the grid, so that
/// element (ix, iy) has its centre at ((ix + 1/2 - mx/2) dx, (iy + 1/2 - my/2) dy), and the depth z >= 0. `stress` is `[n][6]`: xx, yy, zz, xy, xz,
/// yz of each point. A point at z = 0 on the edge of an element, to within rounding, is refused: stresses jump there or are infinite. With
/// `patches` a point must lie below the grid; it takes the factors of the patch of the element above, on an edge that of the larger index.
/// Time grows with n times the number of loaded elements. CANCELLED, or ITERATION_LIMIT by `max_seconds`: stresses of points that were not
/// reached are 0. With `period`: UNSUPPORTED. Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_stress_at_points(
    scene: *const contact_normal_scene,
    body: i32,
    pressure: *const f64,
    traction_x: *const f64,
    traction_y: *const f64,
    points: *const f64,
    n: i32,
    options: *const contact_normal_options,
    stress: *mut f64,
) -> contact_normal_status {
    let arguments = given![scene, body, pressure, traction_x, traction_y, points, n, options, stress];
    let compute = |recording: &mut Recording<'_>| {
        // SAFETY (all): NULL or as the conventions of the ABI say.
        unsafe {
            let load = Load { scene, body, options, arrays: [pressure, traction_x, traction_y] };
            let n = not_negative("n", n)?;
            let mut regions = Regions::default();
            load.add_to(&mut regions)?;
            regions.input("points", points.cast::<[f64; 3]>(), n)?;
            regions.output("stress", stress.cast::<[f64; 6]>(), n)?;
            recording.keep(&regions);
            regions.check()?;
            let (scene, options) = load.read()?;
            let (body, loads) = load.on(&scene)?;
            if n == 0 {
                return Ok(CONTACT_NORMAL_OK);
            }
            let points = required("points", points.cast::<[f64; 3]>(), n)?;
            if stress.is_null() {
                return Err(Refusal::null("stress"));
            }
            let mut found = zeros(n, "the stresses of points")?;
            let threads = Threads::new(options.options.threads)?;
            let watcher = Watcher::of(&options);
            let told = &mut watcher.told();
            let progress = watcher.callback(told);
            let all = stress::stress_at_points(&body, &loads, points, &threads, progress, &mut found)?;
            let outcome = if all { Outcome::Converged } else { Outcome::Cancelled };
            std::ptr::copy_nonoverlapping(found.as_ptr(), stress.cast::<[f64; 6]>(), n);
            let message = || format!("{}; stresses of points that were not reached are 0", why(outcome));
            watcher.conclusion(Conclusion::of(outcome, message)).conclude()
        }
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_stress_at_points", options, arguments, compute) }
}

/// The first arguments of both exports.
struct Load {
    scene: *const contact_normal_scene,
    body: i32,
    options: *const contact_normal_options,
    arrays: [*const f64; 3],
}

impl Load {
    /// The scene, which needs no load, and the options.
    unsafe fn read<'a>(&self) -> Result<(Scene<'a>, Translated), Refusal> {
        // SAFETY: by the caller.
        let scene = unsafe { Named::read(self.scene)?.load_or_none().with_distance(&[])? };
        // SAFETY: by the caller.
        Ok((scene, unsafe { options::translate(self.options)? }))
    }

    /// The half-space of that scene, and its loads.
    unsafe fn on<'a>(&self, scene: &'a Scene<'a>) -> Result<(Body, Loads<'a>), Refusal> {
        // SAFETY: NULL or one value per element, by the conventions of the ABI.
        let arrays = self.arrays.map(|array| unsafe { optional(array, scene.grid.len()) });
        Ok(stress::of_scene(scene, self.body, arrays)?)
    }

    /// Adds the regions that the call reads. Returns the number of elements.
    unsafe fn add_to(&self, regions: &mut Regions) -> Result<usize, Refusal> {
        // SAFETY (all): by the caller.
        let (named, options) = unsafe { (Named::read(self.scene)?, options::translate(self.options)?) };
        named.add_without_distance(regions, self.scene)?;
        options.add_to(regions, self.options)?;
        for (name, array) in ["pressure", "traction_x", "traction_y"].into_iter().zip(self.arrays) {
            regions.input(name, array, named.len())?;
        }
        Ok(named.len())
    }
}

/// Computes and writes the stresses while `progress` is told of each depth.
fn run(
    body: &Body,
    loads: &Loads<'_>,
    depths: &[f64],
    (options, outputs): (&Translated, &contact_normal_stress_outputs),
    progress: Option<ProgressCallback<'_>>,
) -> Result<Conclusion, Refusal> {
    let threads = Threads::new(options.options.threads)?;
    let (mut mises, mut shear) = (None, None);
    let all = stress::subsurface_stress(body, loads, depths, &outputs.wanted(), &threads, progress, |k, depth| {
        Maximum::join(&mut mises, &depth.von_mises, k, (&body.grid, loads));
        Maximum::join(&mut shear, &depth.maximum_shear, k, (&body.grid, loads));
        // SAFETY: the caller's arrays, which were checked.
        unsafe { outputs.write(k, depth) };
    })?;
    for (found, to) in [(mises, outputs.largest_von_mises), (shear, outputs.largest_shear)] {
        if let (Some(found), false) = (found, to.is_null()) {
            let largest = contact_normal_stress_maximum::new(&found, depths[found.depth], &body.grid);
            // SAFETY: not null: a struct that declares its size, which was checked.
            unsafe { structs::write(to, &largest)? };
        }
    }
    let outcome = if all { Outcome::Converged } else { Outcome::Cancelled };
    Ok(Conclusion::of(outcome, || format!("{}; the depths done so far are written", why(outcome))))
}
