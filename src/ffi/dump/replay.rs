//! Makes the call of a dump again.

use std::ops::Range;
use std::ptr::null_mut;

use libc::c_void;

use super::{Dump, HISTORY, PARTICLES, PRESSURE_BEFORE, TANGENTIAL_ROW_TABLES, TANGENTIAL_TABLES};
use crate::ffi::arguments::within;
use crate::ffi::solver::InUse;
use crate::ffi::*;
use crate::friction::Particle;
use crate::solver::StepBefore;

/// The end of a call that was made again.
#[derive(Clone, Copy)]
pub struct Replayed {
    /// The status of the call.
    pub status: i32,
    /// The report. None: the call had no report. A report that the call did not write has its values from the file.
    pub report: Option<contact_normal_report>,
}

impl Dump {
    /// Makes the call again, on this thread. The callbacks of the calling program are not called; for a surface callback the file has the distances
    /// that the callback wrote. A solve that started from the last result of a handle takes the pressures of this result as an initial guess. The
    /// error names a part of the call that is not in the file. After a status other than OK `contact_normal_last_error` has the message.
    pub fn replay(self) -> Result<Replayed, String> {
        let options = self.pointer::<contact_normal_options>("options")?;
        // SAFETY: NULL or a struct of this dump, which no one else uses.
        if let Some(options) = unsafe { options.as_mut() } {
            options.dump = std::ptr::null();
        }
        let mut handle: *mut contact_normal_solver = null_mut();
        let mut ranges = self.ranges();
        ranges.push(range(&handle));
        // SAFETY: what a call reads and writes is within the memory of the file, or it is refused.
        let status = within(ranges, || unsafe { self.call_again(&mut handle) });
        // SAFETY: NULL or a handle that this call made.
        unsafe { contact_normal_solver_free(handle) };
        let report = self.pointer::<contact_normal_report>("report")?;
        // SAFETY: NULL or a struct of this dump.
        Ok(Replayed { status: status?, report: unsafe { report.as_ref() }.copied() })
    }

    /// Makes the call. `handle` receives the handle that it sets up, if any.
    unsafe fn call_again(&self, handle: *mut *mut contact_normal_solver) -> Result<i32, String> {
        let scene = self.pointer("scene")?;
        let options = self.pointer("options")?;
        // SAFETY (all): pointers to structs of the kinds that the functions take.
        unsafe {
            Ok(match self.call() {
                "contact_normal_solve" => {
                    contact_normal_solve(scene, options, self.pointer("fields")?, self.pointer("report")?)
                }
                "contact_normal_pull_off" => {
                    contact_normal_pull_off(scene, options, self.pointer("fields")?, self.pointer("report")?)
                }
                "contact_normal_solver_new" => contact_normal_solver_new(scene, options, handle),
                "contact_normal_solver_solve" => self.solve_with_handle(handle)?,
                "contact_normal_solve_tangential" => self.tangential_again(handle)?,
                "contact_normal_solve_to_accuracy" => {
                    let accuracy = self.accuracy()?;
                    contact_normal_solve_to_accuracy(scene, options, accuracy, null_mut(), self.pointer("report")?)
                }
                "contact_normal_cost_of_accuracy" => contact_normal_cost_of_accuracy(
                    scene,
                    options,
                    self.accuracy()?,
                    self.integer("quantity")?,
                    self.integer("n")?,
                    self.array("targets")?,
                    self.pointer("rows")?,
                ),
                "contact_normal_subsurface_stress" | "contact_normal_stress_at_points" => self.stress_again()?,
                other => return Err(format!("this version does not make the call {other} again")),
            })
        }
    }

    /// Solves tangential problems again, with a handle if the call had one.
    unsafe fn tangential_again(&self, handle: *mut *mut contact_normal_solver) -> Result<i32, String> {
        let had_handle = !self.pointer::<contact_normal_options>("handle.options").unwrap_or(null_mut()).is_null();
        let (scene, pressure) = (self.pointer::<contact_normal_scene>("scene")?, self.array::<f64>("pressure")?);
        // SAFETY (all): NULL, or structs of this dump; what a call reads and writes is within the ranges, or it is refused.
        unsafe {
            let mut options = self.pointer::<contact_normal_options>("options")?.as_ref().copied().unwrap_or_default();
            if had_handle {
                let status = self.set_up(handle)?;
                if status != CONTACT_NORMAL_OK {
                    return Ok(status);
                }
                self.start_friction(scene, &mut options)?;
                self.give_step(*handle)?;
            }
            let (n, entries) = (self.integer("n")?, self.array("entries")?);
            let (results, report) = (self.pointer("results")?, self.pointer("report")?);
            let mut ranges = self.ranges();
            ranges.push(range(&options));
            let call =
                || contact_normal_solve_tangential(*handle, scene, pressure, &options, n, entries, results, report);
            Ok(within(ranges, call))
        }
    }

    /// If the call started from the tractions of the handle, makes the tractions of the file the initial guess.
    unsafe fn start_friction(
        &self,
        scene: *mut contact_normal_scene,
        options: &mut contact_normal_options,
    ) -> Result<(), String> {
        let traction = [self.array::<f64>("handle.traction_x"), self.array("handle.traction_y")];
        // SAFETY: NULL, or structs of this dump, which no one else uses.
        let friction = unsafe { scene.as_ref().and_then(|scene| scene.friction.cast_mut().as_mut()) };
        let goes_on = options.initial_guess == CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
        if let (true, Some(friction), [Ok(x), Ok(y)]) = (goes_on, friction, traction) {
            if !x.is_null() {
                options.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_NONE;
                friction.initial_traction = [x.cast_const(), y.cast_const()];
            }
        }
        Ok(())
    }

    /// Computes stresses again.
    unsafe fn stress_again(&self) -> Result<i32, String> {
        let (scene, options, n) = (self.pointer("scene")?, self.pointer("options")?, self.integer("n")?);
        let (body, pressure) = (self.integer("body")?, self.array("pressure")?);
        let (x, y): (*mut f64, *mut f64) = (self.array("traction_x")?, self.array("traction_y")?);
        // SAFETY (both): as above.
        unsafe {
            if self.call() == "contact_normal_stress_at_points" {
                let (points, stress) = (self.array("points")?, self.array("stress")?);
                return Ok(contact_normal_stress_at_points(scene, body, pressure, x, y, points, n, options, stress));
            }
            let (depths, outputs) = (self.array("depths")?, self.pointer("outputs")?);
            Ok(contact_normal_subsurface_stress(scene, body, pressure, x, y, depths, n, options, outputs))
        }
    }

    /// The `accuracy` of the call. A surface callback is replaced by the distances in the file.
    fn accuracy(&self) -> Result<*mut contact_normal_accuracy, String> {
        let accuracy = self.pointer::<contact_normal_accuracy>("accuracy")?;
        // SAFETY: NULL or a struct of this dump, which no one else uses.
        if let Some(accuracy) = unsafe { accuracy.as_mut() }.filter(|_| self.of_the_host().contains(&"surface")) {
            accuracy.surface = Some(surface);
            accuracy.user = (&raw const *self).cast_mut().cast();
        }
        Ok(accuracy)
    }

    /// Sets up a handle as that of the call was, and solves.
    unsafe fn solve_with_handle(&self, handle: *mut *mut contact_normal_solver) -> Result<i32, String> {
        // SAFETY: what a call reads and writes is within these ranges, or it is refused.
        let status = unsafe { self.set_up(handle)? };
        if status != CONTACT_NORMAL_OK {
            return Ok(status);
        }
        let scene = self.pointer::<contact_normal_scene>("scene")?;
        let report = self.pointer("report")?;
        // SAFETY: NULL, or structs of this dump.
        let (mut fields, mut options) = unsafe {
            let fields = self.pointer::<contact_normal_fields>("fields")?.as_ref();
            let options = self.pointer::<contact_normal_options>("options")?.as_ref();
            (fields.copied().unwrap_or_default(), options.copied().unwrap_or_default())
        };
        let pressure = self.array::<f64>("handle.pressure")?;
        if options.initial_guess == CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS && !pressure.is_null() {
            options.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_GIVEN;
            fields.pressure = pressure;
            if options.active_set == CONTACT_NORMAL_ACTIVE_SET_FREE {
                fields.contact = self.array("handle.contact")?;
            }
        }
        if let Some(history) = self.doubles(HISTORY) {
            // SAFETY: a handle that was set up above.
            let mut held = unsafe { InUse::begin(*handle) }.map_err(|_| "the handle is in use")?;
            held.held().solver.take_history(&history).map_err(|error| error.to_string())?;
        }
        let mut ranges = self.ranges();
        ranges.extend([range(&fields), range(&options)]);
        // SAFETY: as above.
        unsafe {
            self.give_step(*handle)?;
            Ok(within(ranges, || contact_normal_solver_solve(*handle, scene, &options, &mut fields, report)))
        }
    }

    /// Sets up a handle for the scene of the call, with the options of the call's handle and the tables that the scene left out.
    unsafe fn set_up(&self, handle: *mut *mut contact_normal_solver) -> Result<i32, String> {
        let mut scene = *self.scene().ok_or("there is no scene")?;
        let values = [self.doubles("handle.influence"), self.doubles("handle.row_tables")];
        let at = |k: usize| values[k].as_ref().map_or(std::ptr::null(), |values| values.as_ptr());
        let (mx, my) = (scene.mx, scene.my);
        let influence = contact_normal_influence { cx: mx, cy: my, coefficients: at(0), ..Default::default() };
        let row_tables = contact_normal_row_tables { cx: mx, rows: my, coefficients: at(1), ..Default::default() };
        if values[0].is_some() {
            scene.influence = &influence;
        }
        if values[1].is_some() {
            scene.row_tables = &row_tables;
        }
        let mut ranges = self.ranges();
        // SAFETY: the caller's.
        ranges.extend([range(&scene), range(&influence), range(&row_tables), range(unsafe { &*handle })]);
        ranges.extend(
            values
                .iter()
                .flatten()
                .map(|values| values.as_ptr_range())
                .map(|Range { start, end }| start as usize..end as usize),
        );
        // SAFETY: NULL, or a struct of this dump, which no one else uses.
        if let Some(friction) = unsafe { scene.friction.cast_mut().as_mut() } {
            for (k, name) in TANGENTIAL_TABLES.into_iter().enumerate() {
                let table = self.pointer::<contact_normal_influence>(name).unwrap_or(null_mut());
                if !table.is_null() {
                    let to = if k < 3 { &mut friction.influence[k] } else { &mut friction.influence_cross[k - 3] };
                    *to = table;
                }
            }
            for (to, name) in friction.row_tables.iter_mut().zip(TANGENTIAL_ROW_TABLES) {
                let tables = self.pointer::<contact_normal_row_tables>(name).unwrap_or(null_mut());
                if !tables.is_null() {
                    *to = tables;
                }
            }
        }
        let options = self.pointer("handle.options")?;
        // SAFETY: what a call reads and writes is within these ranges, or it is refused.
        Ok(within(ranges, || unsafe { contact_normal_solver_new(&scene, options, handle) }))
    }

    /// If the file has tractions and particles of an earlier step, gives them to the handle, so that friction can continue from there.
    unsafe fn give_step(&self, handle: *mut contact_normal_solver) -> Result<(), String> {
        let array = |name: &str| self.doubles(name);
        let (Some(x), Some(y)) = (array("handle.traction_x"), array("handle.traction_y")) else { return Ok(()) };
        let (coefficients, limits) = (array(PARTICLES[0]).unwrap_or_default(), array(PARTICLES[1]).unwrap_or_default());
        let limit = |i: usize| limits.get(i).copied().unwrap_or(0.0);
        let particle = |(i, coefficient): (usize, &f64)| Particle { coefficient: *coefficient, yield_limit: limit(i) };
        let particles: Vec<Particle> = coefficients.iter().enumerate().map(particle).collect();
        let pressure = array(PRESSURE_BEFORE);
        // SAFETY: a handle that was set up before.
        let mut held = unsafe { InUse::begin(handle) }.map_err(|_| "the handle is in use")?;
        let solver = &mut held.held().solver;
        let lengths =
            [Some(x.len()), Some(y.len()), pressure.as_ref().map(Vec::len), Some(particles.len()).filter(|n| *n > 0)];
        if lengths.into_iter().flatten().any(|length| length != solver.grid().len()) {
            return Err("the step of the file is not on the grid of the handle".into());
        }
        let traction = x.into_iter().zip(y).map(|(x, y)| [x, y]).collect();
        solver.take_step(StepBefore { traction, particles, pressure });
        Ok(())
    }
}

/// The addresses that a value takes.
fn range<T>(value: &T) -> Range<usize> {
    let start = (&raw const *value) as usize;
    start..start + size_of::<T>()
}

/// A surface callback that writes the distances of the file for this grid. It cancels the call if the file has none.
unsafe extern "C" fn surface(mx: i32, my: i32, _dx: f64, _dy: f64, h: *mut f64, user: *mut c_void) -> i32 {
    // SAFETY: the dump that is replayed.
    let dump = unsafe { &*user.cast::<Dump>() };
    let values = dump.doubles(&format!("surface.{mx}x{my}"));
    let count = usize::try_from(mx).unwrap_or(0) * usize::try_from(my).unwrap_or(0);
    match values.filter(|values| values.len() == count) {
        Some(values) => {
            // SAFETY: room for all values.
            unsafe { std::ptr::copy_nonoverlapping(values.as_ptr(), h, count) };
            0
        }
        None => 1,
    }
}
