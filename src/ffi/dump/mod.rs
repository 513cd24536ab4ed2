//! Dumps: the arguments of a call that fails are written to the file that `options->dump` names. `contact-normal-replay` reads the file and makes the
//! call again. docs/dump.md has the format.
//!
//! Structs are written by the list of their members (`members.rs`), which is made from the header. Arrays are written with the lengths that the call
//! has registered in `Regions`. So a new effect or member gets into the file without a change here.

mod argument;
mod file;
mod image;
mod parse;
mod read;
mod replay;

pub use read::Dump;
pub use replay::Replayed;

use std::ffi::CStr;

use super::arguments::Regions;
use super::guard::{caught, status_of, Inside};
use super::influence::{contact_normal_influence, contact_normal_row_tables};
use super::options::{contact_normal_cycle, contact_normal_options};
use super::status::{
    contact_normal_status, last_error_text, set_last_error, Refusal, CONTACT_NORMAL_CANCELLED, CONTACT_NORMAL_OK,
};
use super::structs::{self, Versioned};
use crate::effects::TangentialInfluence;
use crate::solver::Solver;
pub(super) use argument::{Argument, Given};
use image::Image;

/// The first line of a file: the format and its version.
const FIRST_LINE: &str = "contact-normal dump 1";

// Names in the file of arrays that a handle has from earlier steps.

/// The coefficients of friction and the yield limits of the particles of the interface.
const PARTICLES: [&str; 2] = ["handle.friction_coefficient", "handle.yield_limit"];

/// The history of viscoelastic bodies.
const HISTORY: &str = "handle.history";

/// The pressures of the last step of unlike bodies.
const PRESSURE_BEFORE: &str = "handle.pressure_before";

/// The caller's tangential influence coefficients.
const TANGENTIAL_TABLES: [&str; 5] = [
    "handle.tangential_xx",
    "handle.tangential_yy",
    "handle.tangential_xy",
    "handle.tangential_xz",
    "handle.tangential_yz",
];

/// The caller's tangential influence coefficients per loaded row.
const TANGENTIAL_ROW_TABLES: [&str; 3] =
    ["handle.tangential_rows_xx", "handle.tangential_rows_yy", "handle.tangential_rows_xy"];

/// Lists the arguments of a call, each with its name.
macro_rules! given {
    ($($name:ident),+ $(,)?) => {
        &[$((stringify!($name), $crate::ffi::dump::Given::given($name))),+]
    };
}
pub(super) use given;

/// A copy of the arguments of a call, which exists until the call ends.
pub(super) struct Recording<'a> {
    /// The name of the function that is called.
    call: &'static str,
    arguments: &'a [(&'static str, Argument)],
    /// The path in the caller's options. None: no dump is wanted, and nothing is copied.
    path: Option<Vec<u8>>,
    /// The copy. None: nothing is copied yet.
    image: Option<Image>,
}

impl<'a> Recording<'a> {
    /// Reads the path from `options`, which is NULL or a struct that declares its size. If the options cannot be read, the call itself reports that.
    pub unsafe fn new(
        call: &'static str,
        options: *const contact_normal_options,
        arguments: &'a [(&'static str, Argument)],
    ) -> Recording<'a> {
        // SAFETY: by the caller.
        let given = unsafe { structs::read_optional(options, "options") }.ok().flatten();
        let path = given.map(|given| given.dump).filter(|path| !path.is_null());
        // SAFETY: not NULL: a text that ends with 0, by the conventions of the ABI.
        let path = path.map(|path| unsafe { CStr::from_ptr(path) }.to_bytes().to_vec());
        Recording { call, arguments, path, image: None }
    }

    /// Whether the caller wants a dump if the call fails.
    pub fn is_wanted(&self) -> bool {
        self.path.is_some()
    }

    /// Copies the arguments of the call; `regions` has the lengths of the arrays. Later calls of this method change nothing.
    pub fn keep(&mut self, regions: &Regions) {
        if self.is_wanted() && self.image.is_none() {
            // SAFETY: the caller's structs and arrays, by the conventions of the ABI.
            self.image = Some(unsafe { Image::of(self.arguments, regions) });
        }
    }

    /// As [`keep`](Self::keep), with the set-up of the handle that solves. If the call `goes_on` from the handle's last result, copies that as well.
    pub fn keep_with(&mut self, regions: &Regions, solver: &Solver, goes_on: bool) {
        if !self.is_wanted() || self.image.is_some() {
            return;
        }
        self.keep(regions);
        let Some(image) = &mut self.image else { return };
        let set_up = solver.set_up_options();
        let cycle = contact_normal_cycle::from(&set_up.cycle);
        let options = contact_normal_options { cycle: &cycle, ..contact_normal_options::of_set_up(set_up) };
        // SAFETY: structs of this function.
        unsafe { image.add(&[("handle.options", (&raw const options).given())], &Regions::default()) };
        if let Some((name, table)) = solver.own_tables() {
            image.add_doubles(&format!("handle.{name}"), &table);
        }
        if let Some(kept) = solver.own_tangential_tables() {
            image.add_tables(&kept.view());
        }
        if goes_on {
            image.add_result(solver);
        }
    }

    /// Copies the undeformed distance that the caller's surface callback has written for a grid.
    pub fn keep_surface(&mut self, mx: usize, my: usize, h: &[f64]) {
        if let Some(image) = &mut self.image {
            image.add_doubles(&format!("surface.{mx}x{my}"), h);
        }
    }

    /// Called at the end of a call. If the call failed, writes the file and adds the path to the message.
    fn end(&mut self, ended: Result<contact_normal_status, Refusal>) -> Result<contact_normal_status, Refusal> {
        match ended {
            Ok(status) if self.is_wanted() && status != CONTACT_NORMAL_OK => {
                let message = last_error_text();
                let about_dump = self.finish(status, &message);
                if !about_dump.is_empty() {
                    set_last_error(&(message + &about_dump));
                }
                Ok(status)
            }
            Ok(status) => Ok(status),
            Err(mut refusal) => {
                refusal.message += &self.finish(refusal.status, &refusal.message);
                Err(refusal)
            }
        }
    }

    /// Writes the file of a call that failed. Returns a sentence for the message of the call; an empty one if no file is wanted.
    pub fn finish(&mut self, status: contact_normal_status, message: &str) -> String {
        let Some(path) = self.path.take() else { return String::new() };
        if status == CONTACT_NORMAL_OK || status == CONTACT_NORMAL_CANCELLED {
            return String::new();
        }
        self.path = Some(path.clone());
        // The call may have been refused before its arrays were known.
        self.keep(&Regions::default());
        let head = format!(
            "{FIRST_LINE}\nlibrary {}\ncall {}\nstatus {status}\nmessage {}\n",
            env!("CARGO_PKG_VERSION"),
            self.call,
            message.replace('\\', "\\\\").replace('\n', "\\n")
        );
        let image = self.image.take().unwrap_or_default();
        match file::write(&path, &head, &image) {
            Ok(path) => format!("; what the call was given is in {path}"),
            Err(why) => format!("; there is no dump: {why}"),
        }
    }
}

impl Image {
    /// Adds the caller's tangential influence coefficients, which a handle keeps.
    fn add_tables(&mut self, tables: &TangentialInfluence<'_>) {
        let (cx, cy, scale) = (tables.cx as i32, tables.cy as i32, tables.scale);
        let values: Vec<_> = tables.coefficients.into_iter().chain(tables.cross.into_iter().flatten()).collect();
        if tables.by_row {
            let with =
                |coefficients| contact_normal_row_tables { cx, rows: cy, coefficients, scale, ..Default::default() };
            self.add_structs(&TANGENTIAL_ROW_TABLES, &values, with);
        } else {
            let with = |coefficients| contact_normal_influence { cx, cy, coefficients, scale, ..Default::default() };
            self.add_structs(&TANGENTIAL_TABLES, &values, with);
        }
    }

    /// Adds each table, and the struct `with(address of the table)` that points to the table.
    fn add_structs<S: Versioned>(&mut self, names: &[&str], tables: &[&[f64]], with: impl Fn(*const f64) -> S) {
        let structs: Vec<S> = tables.iter().map(|values| with(values.as_ptr())).collect();
        let mut regions = Regions::default();
        for values in tables {
            let name = "the tangential coefficients of the handle";
            self.lacks_memory |= regions.input(name, values.as_ptr(), values.len()).is_err();
        }
        let pointers = structs.iter().map(|each| (&raw const *each).given());
        let named: Vec<_> = names.iter().copied().zip(pointers).collect();
        // SAFETY: structs of this function, and arrays of their sizes.
        unsafe { self.add(&named, &regions) };
    }

    /// Adds the last result of a handle: pressures, contact area, history and tractions.
    fn add_result(&mut self, solver: &Solver) {
        if solver.has_solved() {
            let state = solver.state();
            self.add_doubles("handle.pressure", &state.p);
            // With the elements at their pressure limit: an initial guess takes the pressures of these elements only.
            self.add_integers("handle.contact", &mut (0..state.p.len()).map(|i| i32::from(state.touches(i))));
        }
        if let Some(history) = solver.history() {
            self.add_doubles(HISTORY, &history);
        }
        if let Some(solution) = solver.tractions() {
            for (k, name) in ["handle.traction_x", "handle.traction_y"].into_iter().enumerate() {
                let traction: Vec<f64> = solution.traction.iter().map(|q| q[k]).collect();
                self.add_doubles(name, &traction);
            }
            if let Some(pressure) = solver.pressures_before() {
                self.add_doubles(PRESSURE_BEFORE, pressure);
            }
            if !solution.particles.is_empty() {
                let coefficient: Vec<f64> = solution.particles.iter().map(|particle| particle.coefficient).collect();
                let yield_limit: Vec<f64> = solution.particles.iter().map(|particle| particle.yield_limit).collect();
                self.add_doubles(PARTICLES[0], &coefficient);
                if yield_limit.iter().all(|limit| *limit > 0.0) {
                    self.add_doubles(PARTICLES[1], &yield_limit);
                }
            }
        }
    }
}

/// Calls `body` in a guard, as [`guard`](super::guard::guard) does. If the call fails, writes the `arguments` to the file that `options` names.
pub(super) unsafe fn recorded(
    call: &'static str,
    options: *const contact_normal_options,
    arguments: &[(&'static str, Argument)],
    body: impl FnOnce(&mut Recording<'_>) -> Result<contact_normal_status, Refusal>,
) -> contact_normal_status {
    let _inside = Inside::enter();
    // SAFETY: by the caller.
    let mut recording = unsafe { Recording::new(call, options, arguments) };
    let ended = caught(|| body(&mut recording));
    status_of(caught(|| recording.end(ended)))
}
