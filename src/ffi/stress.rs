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

/// Computes the stresses in body 1 or 2 (`body`) of a scene, a half-space, at n depths below the centres of the elements. The loads are pressures and
/// tractions, `[my][mx]` each and constant on each element; NULL: none, but one array must be given. They must be below 1e304. Tractions are those on
/// this body, positive towards +x and +y. Depths are >= 0, positive into the body, in any order.
///
/// Of the scene the call uses the grid, the Poisson ratio of the body, a `period` in both directions, and `patches`. Below an element of a patch the
/// loads on another patch count times the factor between both patches; below an element of no patch all loads count in full. UNSUPPORTED: a `coating`
/// on this body, `influence`, `row_tables`, or a period in one direction only.
///
/// Of the options (NULL: the defaults) the call uses `threads`, `progress` (with depths in place of cycles), `max_seconds`, `stop` and `dump`.
/// CANCELLED, or ITERATION_LIMIT after `max_seconds`: the depths so far are written, the outputs of the others stay unchanged. With n = 0 the largest
/// stresses are not written. Since 0.2.
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
            let wanted = structs::read(outputs.cast_const(), "outputs")?;
            let mut regions = Regions::default();
            let elements = load.add_to(&mut regions)?;
            regions.input("depths", depths, n)?;
            wanted.add_to(&mut regions, outputs, (n, elements))?;
            recording.keep(&regions);
            regions.check()?;
            let (scene, options) = load.read()?;
            let (body, loads) = load.on(&scene)?;
            let depths = if n == 0 { &[] } else { required("depths", depths, n)? };
            let watcher = Watcher::of(&options);
            let told = &mut watcher.told();
            let conclusion = compute_depths(&body, &loads, depths, (&options, &wanted), watcher.callback(told))?;
            watcher.conclusion(conclusion).conclude()
        }
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_subsurface_stress", options, arguments, compute) }
}

/// Computes the stresses of `contact_normal_subsurface_stress` at n `points` `[n][3]`. A point has the coordinates x and y from the middle of the
/// grid, where element (ix, iy) has its centre at ((ix + 1/2 - mx/2) dx, (iy + 1/2 - my/2) dy), and the depth z >= 0. `stress` is `[n][6]`: xx, yy,
/// zz, xy, xz, yz of each point. A point at z = 0 on the edge of an element, to within rounding, is refused, because stresses jump there or are
/// infinite. With `patches` a point must lie below the grid, and has the factors of the patch of the element above (on an edge, of the element with
/// the larger index). The time grows with n times the number of loaded elements. CANCELLED, or ITERATION_LIMIT after `max_seconds`: the stresses of
/// points that were not reached are 0. UNSUPPORTED: a `period`. Since 0.2.
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
            let mut computed = zeros(n, "the stresses of points")?;
            let threads = Threads::new(options.options.threads)?;
            let watcher = Watcher::of(&options);
            let told = &mut watcher.told();
            let progress = watcher.callback(told);
            let is_complete = stress::stress_at_points(&body, &loads, points, &threads, progress, &mut computed)?;
            let outcome = if is_complete { Outcome::Converged } else { Outcome::Cancelled };
            std::ptr::copy_nonoverlapping(computed.as_ptr(), stress.cast::<[f64; 6]>(), n);
            let message = || format!("{}; stresses of points that were not reached are 0", why(outcome));
            watcher.conclusion(Conclusion::of(outcome, message)).conclude()
        }
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_stress_at_points", options, arguments, compute) }
}

/// The arguments that both exported functions have.
struct Load {
    scene: *const contact_normal_scene,
    body: i32,
    options: *const contact_normal_options,
    /// The pressures, and the tractions in x and in y.
    arrays: [*const f64; 3],
}

impl Load {
    /// Reads the scene, which needs no undeformed distance and no load, and the options.
    unsafe fn read<'a>(&self) -> Result<(Scene<'a>, Translated), Refusal> {
        // SAFETY: by the caller.
        let scene = unsafe { Named::read(self.scene)?.load_or_none().with_distance(&[])? };
        // SAFETY: by the caller.
        Ok((scene, unsafe { options::translate(self.options)? }))
    }

    /// The half-space that is the body, and the loads on it.
    unsafe fn on<'a>(&self, scene: &'a Scene<'a>) -> Result<(Body, Loads<'a>), Refusal> {
        // SAFETY: NULL or one value per element, by the conventions of the ABI.
        let arrays = self.arrays.map(|array| unsafe { optional(array, scene.grid.len()) });
        Ok(stress::of_scene(scene, self.body, arrays)?)
    }

    /// Adds the structs and arrays that the call reads. Returns the number of elements.
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

/// Computes and writes the stresses depth by depth. Calls `progress` after each depth.
fn compute_depths(
    body: &Body,
    loads: &Loads<'_>,
    depths: &[f64],
    (options, outputs): (&Translated, &contact_normal_stress_outputs),
    progress: Option<ProgressCallback<'_>>,
) -> Result<Conclusion, Refusal> {
    let threads = Threads::new(options.options.threads)?;
    let (mut mises, mut shear) = (None, None);
    let wanted = outputs.wanted();
    let is_complete = stress::subsurface_stress(body, loads, depths, &wanted, &threads, progress, |k, depth| {
        Maximum::join(&mut mises, &depth.von_mises, k, (&body.grid, loads));
        Maximum::join(&mut shear, &depth.maximum_shear, k, (&body.grid, loads));
        // SAFETY: the caller's arrays, which were checked.
        unsafe { outputs.write(k, depth) };
    })?;
    for (maximum, to) in [(mises, outputs.largest_von_mises), (shear, outputs.largest_shear)] {
        if let (Some(maximum), false) = (maximum, to.is_null()) {
            let largest = contact_normal_stress_maximum::new(&maximum, depths[maximum.depth], &body.grid);
            // SAFETY: not null: a struct that declares its size, which was checked.
            unsafe { structs::write(to, &largest)? };
        }
    }
    let outcome = if is_complete { Outcome::Converged } else { Outcome::Cancelled };
    Ok(Conclusion::of(outcome, || format!("{}; the depths done so far are written", why(outcome))))
}
