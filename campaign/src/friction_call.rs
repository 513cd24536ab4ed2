//! Calls of the C ABI for scenes with friction.

use std::ptr::{null, null_mut};

use contact_normal::ffi::*;

use crate::call::{bare_scene, cancel, last_error, Canceller, SENTINEL};
use crate::effect_structs::{effect_structs, EffectStructs};
use crate::friction_found::Found;
use crate::friction_place::{Place, Stop};
use crate::init::initialised;
use crate::own_tractions::Structs;
use crate::slide::Slide;

/// A scene that points to the arrays of a place and a slide.
struct Scene {
    scene: contact_normal_scene,
    // The scene points to these structs. They are boxed, so that their addresses stay the same.
    _effects: Box<EffectStructs>,
    _friction: Option<Box<contact_normal_friction>>,
    _tables: Option<Box<Structs>>,
}

/// Where the tractions before a step come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum From {
    /// The slide has them; if it has none, the step starts from rest.
    Slide,
    /// The handle has them: the step continues its last one.
    Handle,
}

/// The scene of a place, with friction if there is a slide.
fn scene(place: &Place, slide: Option<(&Slide, From)>) -> Scene {
    let mut scene = bare_scene(&place.grid, &place.h, (place.shear_modulus, place.poisson_ratio), place.load);
    let effects = effect_structs(&place.effects);
    effects.point_from(&mut scene, &place.effects);
    let mut friction = slide.map(|(slide, from)| Box::new(friction(slide, from)));
    let structs = place.traction_tables.as_ref().map(|tables| Structs::new(tables));
    if let (Some(friction), Some(structs), Some(tables)) = (&mut friction, &structs, &place.traction_tables) {
        structs.put(tables, friction);
    }
    scene.friction = friction.as_ref().map_or(null(), |friction| &raw const **friction);
    Scene { scene, _effects: effects, _friction: friction, _tables: structs }
}

/// The struct of the C ABI for a slide.
fn friction(slide: &Slide, from: From) -> contact_normal_friction {
    let mut friction = initialised(contact_normal_friction_init);
    if slide.uniform {
        friction.coefficient = slide.mu[0];
    } else {
        friction.coefficients = slide.mu.as_ptr();
    }
    (friction.motion, friction.prescribed) = (slide.motion, slide.prescribed);
    (friction.creepage, friction.force) = (slide.amount, slide.amount);
    (friction.spin, friction.spin_centre) = (slide.spin, slide.spin_centre);
    (friction.rolling_distance, friction.rolling_direction) = (slide.distance, slide.direction);
    let pointers = |arrays: &Option<[Vec<f64>; 2]>| {
        arrays.as_ref().map_or([null(); 2], |arrays| [arrays[0].as_ptr(), arrays[1].as_ptr()])
    };
    friction.rigid_slip = pointers(&slide.rigid);
    (friction.continues, friction.sensitivities) = (i32::from(from == From::Handle), i32::from(slide.sensitivities));
    if from == From::Slide {
        friction.previous_traction = pointers(&slide.previous);
    }
    friction
}

/// The options of a solve, which point to `canceller`.
fn options(stop: &Stop, canceller: &mut Canceller) -> contact_normal_options {
    let mut options = initialised(contact_normal_options_init);
    (options.tolerance, options.precision, options.threads) = (stop.tolerance, stop.precision, stop.threads);
    options.max_cycles = stop.max_cycles;
    if let Some(at) = stop.cancel_at {
        *canceller = Canceller { calls: 0, at };
        options.progress = Some(cancel);
        options.user = (&raw mut *canceller).cast();
    }
    options
}

/// The outputs of a call.
struct Arrays {
    /// p, u, e, q in x and y, and the slip in x and y.
    numbers: Vec<Vec<f64>>,
    /// `contact` and `stick_slip`.
    integers: [Vec<i32>; 2],
    report: contact_normal_report,
}

impl Arrays {
    /// Outputs for n elements, filled with sentinels.
    fn new(n: usize) -> Arrays {
        let mut report = initialised(contact_normal_report_init);
        report.normal.force = SENTINEL;
        Arrays { numbers: vec![vec![SENTINEL; n]; 7], integers: [vec![-77; n], vec![-77; n]], report }
    }

    /// The struct of the C ABI that points to these outputs.
    fn fields(&mut self) -> contact_normal_fields {
        let mut fields = initialised(contact_normal_fields_init);
        let at: Vec<*mut f64> = self.numbers.iter_mut().map(|values| values.as_mut_ptr()).collect();
        (fields.pressure, fields.displacement, fields.deformed_distance) = (at[0], at[1], at[2]);
        (fields.traction, fields.slip) = ([at[3], at[4]], [at[5], at[6]]);
        [fields.contact, fields.stick_slip] = self.integers.each_mut().map(|integers| integers.as_mut_ptr());
        fields
    }

    /// Whether the call wrote any output.
    fn is_written(&self) -> bool {
        self.numbers.iter().flatten().any(|value| value.to_bits() != SENTINEL.to_bits())
            || self.integers.iter().flatten().any(|&integer| integer != -77)
            || self.report.normal.force.to_bits() != SENTINEL.to_bits()
    }

    /// The results of a call with this status.
    fn found(self, status: i32, overrun: Option<u32>) -> Found {
        let written = self.is_written();
        let message = if status == CONTACT_NORMAL_OK { String::new() } else { last_error() };
        let [p, u, e, qx, qy, sx, sy]: [Vec<f64>; 7] = self.numbers.try_into().expect("seven arrays");
        let pairs = |x: Vec<f64>, y: Vec<f64>| x.into_iter().zip(y).map(|(x, y)| [x, y]).collect();
        let [contact, stick_slip] = self.integers;
        let (q, slip, report) = (pairs(qx, qy), pairs(sx, sy), self.report);
        Found { status, message, p, e, contact, u, q, slip, stick_slip, report, overrun, written }
    }
}

/// Makes one call, with outputs filled with sentinels.
fn run(
    (place, slide, stop): (&Place, Option<(&Slide, From)>, &Stop),
    call: impl FnOnce(
        *const contact_normal_scene,
        *const contact_normal_options,
        *mut contact_normal_fields,
        *mut contact_normal_report,
    ) -> i32,
) -> Found {
    let mut canceller = Canceller { calls: 0, at: 0 };
    let (scene, options) = (scene(place, slide), options(stop, &mut canceller));
    let mut arrays = Arrays::new(place.grid.len());
    let mut fields = arrays.fields();
    let status = call(&scene.scene, &options, &mut fields, &mut arrays.report);
    arrays.found(status, canceller.overrun())
}

/// Solves a place without friction.
pub fn frictionless(place: &Place, stop: &Stop) -> Found {
    run((place, None, stop), |scene, options, fields, report| {
        // SAFETY: structs with the arrays that they declare.
        unsafe { contact_normal_solve(scene, options, fields, report) }
    })
}

/// Solves a place with friction, without a handle.
pub fn call(place: &Place, slide: &Slide, stop: &Stop) -> Found {
    run((place, Some((slide, From::Slide)), stop), |scene, options, fields, report| {
        // SAFETY: structs with the arrays that they declare.
        unsafe { contact_normal_solve(scene, options, fields, report) }
    })
}

/// Solves a place with friction, whose struct is changed by `change`, with or without a handle.
pub fn call_changed(
    handle: Option<&mut Handle>,
    (place, slide, from): (&Place, &Slide, From),
    stop: &Stop,
    change: impl FnOnce(&mut contact_normal_friction),
) -> Found {
    let mut changed = friction(slide, from);
    let structs = place.traction_tables.as_ref().map(|tables| Structs::new(tables));
    if let (Some(structs), Some(tables)) = (&structs, &place.traction_tables) {
        structs.put(tables, &mut changed);
    }
    change(&mut changed);
    run((place, None, stop), |scene, options, fields, report| {
        // SAFETY (all): structs with the arrays that they declare, and a handle that no one else uses.
        unsafe {
            let mut scene = *scene;
            scene.friction = &changed;
            match handle {
                Some(handle) => contact_normal_solver_solve(handle.0, &scene, options, fields, report),
                None => contact_normal_solve(&scene, options, fields, report),
            }
        }
    })
}

/// Solves the tangential problem for given pressures p.
pub fn tangential(place: &Place, slide: &Slide, stop: &Stop, p: &[f64]) -> Found {
    run((place, Some((slide, From::Slide)), stop), |scene, options, fields, report| {
        // SAFETY: the struct of this call.
        let fields = unsafe { &*fields };
        let n = p.len();
        let (mut q, mut s) = (vec![0.0; 2 * n], vec![0.0; 2 * n]);
        let mut results = contact_normal_friction_results::default();
        (results.traction, results.slip, results.stick_slip) = (q.as_mut_ptr(), s.as_mut_ptr(), fields.stick_slip);
        // SAFETY (all): structs with the arrays that they declare, and a pressure for each element.
        let status = unsafe {
            let p = p.as_ptr();
            contact_normal_solve_tangential(null_mut(), scene, p, options, 1, null(), &mut results, report)
        };
        if status >= 0 {
            for k in 0..2 {
                for (from, to) in [(&q, fields.traction[k]), (&s, fields.slip[k])] {
                    // SAFETY: one value an element.
                    unsafe { std::ptr::copy_nonoverlapping(from[k * n..].as_ptr(), to, n) };
                }
            }
        }
        status
    })
}

/// A handle of the library.
pub struct Handle(*mut contact_normal_solver);

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: made by `contact_normal_solver_new`.
        unsafe { contact_normal_solver_free(self.0) };
    }
}

impl Handle {
    /// Makes a handle for a place. If the library refuses it, returns the status and the message.
    pub fn new(place: &Place, stop: &Stop) -> Result<Handle, (i32, String)> {
        let mut canceller = Canceller { calls: 0, at: 0 };
        // Tables of tractions belong to the set-up of a handle, so the scene of the set-up has friction with these tables.
        let nothing = place.traction_tables.as_ref().map(|tables| Slide::nothing(&tables.kind, place.grid.len()));
        let slide = nothing.as_ref().map(|slide| (slide, From::Slide));
        let (scene, options) = (scene(place, slide), options(stop, &mut canceller));
        let mut handle = null_mut();
        // SAFETY: structs with the arrays that they declare.
        let status = unsafe { contact_normal_solver_new(&scene.scene, &options, &mut handle) };
        match status {
            CONTACT_NORMAL_OK => Ok(Handle(handle)),
            _ => Err((status, last_error())),
        }
    }

    /// Solves a place with this handle, with friction if there is a slide.
    pub fn solve(&mut self, place: &Place, slide: Option<(&Slide, From)>, stop: &Stop) -> Found {
        run((place, slide, stop), |scene, options, fields, report| {
            // SAFETY: structs with the arrays that they declare, and a handle that no one else uses.
            unsafe { contact_normal_solver_solve(self.0, scene, options, fields, report) }
        })
    }

    /// The fields of the handle's last result, without a report.
    pub fn fields(&self, n: usize) -> Found {
        let mut arrays = Arrays::new(n);
        let mut fields = arrays.fields();
        // SAFETY: room for n values.
        let status = unsafe { contact_normal_solver_fields(self.0, &mut fields) };
        arrays.found(status, None)
    }

    /// Solves several places with the same slide in one call. Returns its status and the results.
    pub fn solve_batch(&mut self, places: &[Place], slide: (&Slide, From), stop: &Stop) -> (i32, Vec<Found>) {
        let mut canceller = Canceller { calls: 0, at: 0 };
        let options = options(stop, &mut canceller);
        let scenes: Vec<Scene> = places.iter().map(|place| scene(place, Some(slide))).collect();
        let list: Vec<contact_normal_scene> = scenes.iter().map(|scene| scene.scene).collect();
        let mut arrays: Vec<Arrays> = places.iter().map(|place| Arrays::new(place.grid.len())).collect();
        let mut fields: Vec<contact_normal_fields> = arrays.iter_mut().map(Arrays::fields).collect();
        let mut reports: Vec<contact_normal_report> = arrays.iter().map(|arrays| arrays.report).collect();
        let mut statuses = vec![-77; places.len()];
        let (count, scenes_at, fields_at) = (places.len() as i32, list.as_ptr(), fields.as_mut_ptr());
        let (reports_at, statuses_at) = (reports.as_mut_ptr(), statuses.as_mut_ptr());
        // SAFETY: arrays of as many structs, each with the arrays that it declares.
        let status = unsafe {
            contact_normal_solver_solve_batch(self.0, count, scenes_at, &options, fields_at, reports_at, statuses_at)
        };
        let found = arrays.into_iter().zip(reports).zip(statuses);
        let found = found.map(|((arrays, report), status)| Arrays { report, ..arrays }.found(status, None));
        (status, found.collect())
    }
}
