//! Calls of the C ABI for scenes without friction and adhesion.

use std::ffi::{c_void, CStr};
use std::ptr::null_mut;

use contact_normal::ffi::*;

use crate::case::{Case, How};
use crate::effect_structs::{effect_structs, EffectStructs};
use crate::effects::UserCoefficients;
use crate::grid::{Grid, Load};
use crate::init::initialised;

/// The value of outputs of type double before a call.
pub const SENTINEL: f64 = -12345.678;
/// The value of integer outputs before a call.
const SENTINEL_CONTACT: i32 = -77;

/// A scene that points to the arrays of a case.
struct Scene {
    scene: contact_normal_scene,
    // The scene points to these structs. They are boxed, so that their address stays the same.
    _effects: Box<EffectStructs>,
}

/// A scene without effects, of bodies with these shear moduli and Poisson ratios.
pub fn bare_scene(grid: &Grid, h: &[f64], (moduli, ratios): ([f64; 2], [f64; 2]), load: Load) -> contact_normal_scene {
    let mut scene = initialised(contact_normal_scene_init);
    (scene.mx, scene.my) = (grid.mx as i32, grid.my as i32);
    (scene.dx, scene.dy) = (grid.dx, grid.dy);
    scene.undeformed_distance = h.as_ptr();
    (scene.shear_modulus, scene.poisson_ratio) = (moduli, ratios);
    match load {
        Load::Approach(approach) => (scene.load, scene.approach) = (CONTACT_NORMAL_PRESCRIBED_APPROACH, approach),
        Load::Force(force) => (scene.load, scene.force) = (CONTACT_NORMAL_PRESCRIBED_FORCE, force),
    }
    scene
}

impl Scene {
    /// The scene of a case.
    fn of(case: &Case) -> Scene {
        let structs = effect_structs(&case.effects);
        let mut scene = bare_scene(&case.grid, &case.h, (case.shear_modulus, case.poisson_ratio), case.load);
        structs.point_from(&mut scene, &case.effects);
        Scene { scene, _effects: structs }
    }
}

/// The state of a callback that cancels a solve once.
pub struct Canceller {
    /// The number of calls of the callback so far.
    pub calls: u32,
    /// The number of the call that cancels; 0: none.
    pub at: u32,
}

impl Canceller {
    /// The number of calls after the one that cancelled. It must be 0. None if no call cancelled.
    pub fn overrun(&self) -> Option<u32> {
        (self.at > 0).then(|| self.calls.checked_sub(self.at)).flatten()
    }
}

/// The callback: counts its calls, and cancels at one of them.
///
/// # Safety
///
/// `user` is a canceller that no one else uses.
pub unsafe extern "C" fn cancel(_progress: *const contact_normal_progress, user: *mut c_void) -> i32 {
    // SAFETY: `user` is the canceller of this call.
    let canceller = unsafe { &mut *user.cast::<Canceller>() };
    canceller.calls += 1;
    i32::from(canceller.calls == canceller.at)
}

/// The options of multigrid cycles.
fn cycle(how: &How) -> contact_normal_cycle {
    contact_normal_cycle { smoother: how.smoother, coarsest: how.coarsest, ..Default::default() }
}

/// The options of a solve. If `previous` is true, it starts from the last result of the handle. The options point to `cycle` and `canceller`, which
/// must live as long.
fn options(
    how: &How,
    previous: bool,
    cycle: &contact_normal_cycle,
    canceller: &mut Canceller,
) -> contact_normal_options {
    let mut options = initialised(contact_normal_options_init);
    (options.method, options.cycle, options.criterion) = (how.method, cycle, how.criterion);
    (options.tolerance, options.precision, options.threads) = (how.tolerance, how.precision, how.threads);
    options.max_cycles = how.max_cycles;
    options.active_set = i32::from(how.fixed.is_some());
    options.initial_guess = match (previous, &how.given) {
        (true, _) => CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS,
        (_, Some(_)) => CONTACT_NORMAL_INITIAL_GUESS_GIVEN,
        _ => CONTACT_NORMAL_INITIAL_GUESS_NONE,
    };
    if let Some(at) = how.cancel_at {
        *canceller = Canceller { calls: 0, at };
        options.progress = Some(cancel);
        options.user = (&raw mut *canceller).cast();
    }
    options
}

/// The results of a call.
pub struct Outputs {
    pub status: i32,
    pub message: String,
    /// Pressures.
    pub p: Vec<f64>,
    /// Displacements.
    pub u: Vec<f64>,
    /// Deformed distances.
    pub e: Vec<f64>,
    /// 0: exterior, 1: in contact, 2: at a pressure limit.
    pub contact: Vec<i32>,
    pub report: contact_normal_report,
    /// The number of callbacks after the one that cancelled, if one did.
    pub overrun: Option<u32>,
    /// Whether the call wrote any output.
    pub written: bool,
}

impl Outputs {
    /// The bits of the results, which must be the same for equal calls.
    pub fn bits(&self) -> Vec<u64> {
        let numbers = self.p.iter().chain(&self.u).chain(&self.e).map(|value| value.to_bits());
        let counts = [self.report.normal.approach.to_bits(), self.report.statistics.cycles as u64, self.status as u64];
        numbers.chain(self.contact.iter().map(|&c| c as u64)).chain(counts).collect()
    }
}

/// The arrays of a call before it: outputs are filled with sentinels; a guess or a fixed contact area are inputs.
fn outputs(case: &Case) -> (Outputs, contact_normal_fields) {
    let n = case.grid.len();
    let given = case.how.given.clone();
    let fixed = case.how.fixed.clone();
    // With a guess the library reads the contact area as well.
    let of_guess = |p: &Vec<f64>| p.iter().map(|&p| i32::from(p > 0.0)).collect();
    let contact = fixed.or_else(|| given.as_ref().map(of_guess)).unwrap_or_else(|| vec![SENTINEL_CONTACT; n]);
    let mut outputs = Outputs {
        status: 0,
        message: String::new(),
        p: given.unwrap_or_else(|| vec![SENTINEL; n]),
        u: vec![SENTINEL; n],
        e: vec![SENTINEL; n],
        contact,
        report: initialised(contact_normal_report_init),
        overrun: None,
        written: false,
    };
    let mut fields = initialised(contact_normal_fields_init);
    (fields.pressure, fields.displacement) = (outputs.p.as_mut_ptr(), outputs.u.as_mut_ptr());
    (fields.deformed_distance, fields.contact) = (outputs.e.as_mut_ptr(), outputs.contact.as_mut_ptr());
    (outputs.report.normal.force, outputs.report.statistics.cycles) = (SENTINEL, -1);
    (outputs, fields)
}

/// A handle of the library.
pub struct Handle(*mut contact_normal_solver);

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: made by `contact_normal_solver_new`, or NULL.
        unsafe { contact_normal_solver_free(self.0) };
    }
}

/// The message of the last refused call.
pub fn last_error() -> String {
    // SAFETY: never NULL, valid until the next call.
    unsafe { CStr::from_ptr(contact_normal_last_error()) }.to_string_lossy().into_owned()
}

impl Handle {
    /// Makes a handle for a case. If the library refuses it, returns the status and the message.
    pub fn new(case: &Case) -> Result<Handle, (i32, String)> {
        let mut canceller = Canceller { calls: 0, at: 0 };
        let cycle = cycle(&case.how);
        let (scene, options) = (Scene::of(case), options(&case.how, false, &cycle, &mut canceller));
        let mut handle = null_mut();
        // SAFETY: structs with the arrays that they declare.
        let status = unsafe { contact_normal_solver_new(&scene.scene, &options, &mut handle) };
        match status {
            CONTACT_NORMAL_OK => Ok(Handle(handle)),
            _ => Err((status, last_error())),
        }
    }

    /// Solves a case with this handle. If `previous` is true, the solve starts from the last result.
    pub fn solve(&mut self, case: &Case, previous: bool) -> Outputs {
        run(case, previous, |scene, options, fields, report| {
            // SAFETY: structs with the arrays that they declare, and a handle that no one else uses.
            unsafe { contact_normal_solver_solve(self.0, scene, options, fields, report) }
        })
    }

    /// Computes the product A p with the handle's coefficients.
    pub fn product(&mut self, p: &[f64]) -> Vec<f64> {
        let mut u = vec![SENTINEL; p.len()];
        // SAFETY: as many values as the grid has elements.
        let status = unsafe { contact_normal_solver_product(self.0, p.as_ptr(), u.as_mut_ptr()) };
        assert_eq!(status, CONTACT_NORMAL_OK, "{}", last_error());
        u
    }

    /// Sets another table of coefficients. Returns the status.
    pub fn set_influence(&mut self, table: &UserCoefficients) -> i32 {
        let mut influence = initialised(contact_normal_influence_init);
        (influence.cx, influence.cy, influence.coefficients) =
            (table.cx as i32, table.cy as i32, table.values.as_ptr());
        // SAFETY: a struct with a table of the size that it says.
        unsafe { contact_normal_solver_set_influence(self.0, &influence, std::ptr::null()) }
    }

    /// Solves cases that differ in surface and load only, in one call. Returns its status and the results.
    pub fn solve_batch(&mut self, cases: &[Case]) -> (i32, Vec<Outputs>) {
        let mut canceller = Canceller { calls: 0, at: 0 };
        let cycle = cycle(&cases[0].how);
        let options = options(&cases[0].how, false, &cycle, &mut canceller);
        let scenes: Vec<Scene> = cases.iter().map(Scene::of).collect();
        let list: Vec<contact_normal_scene> = scenes.iter().map(|scene| scene.scene).collect();
        let (mut outputs, mut fields): (Vec<_>, Vec<_>) = cases.iter().map(outputs).unzip();
        let before: Vec<_> = outputs.iter().map(Outputs::bits).collect();
        let mut reports: Vec<_> = outputs.iter().map(|outputs| outputs.report).collect();
        let mut statuses = vec![-77; cases.len()];
        let (count, statuses_at) = (cases.len() as i32, statuses.as_mut_ptr());
        let (fields_at, reports_at) = (fields.as_mut_ptr(), reports.as_mut_ptr());
        // SAFETY: arrays of as many structs, each with the arrays that it declares.
        let status = unsafe {
            contact_normal_solver_solve_batch(
                self.0,
                count,
                list.as_ptr(),
                &options,
                fields_at,
                reports_at,
                statuses_at,
            )
        };
        for (k, outputs) in outputs.iter_mut().enumerate() {
            outputs.written = outputs.bits() != before[k]
                || reports[k].normal.force.to_bits() != outputs.report.normal.force.to_bits();
            outputs.report = reports[k];
            outputs.status = statuses[k];
            outputs.message = if statuses[k] == CONTACT_NORMAL_OK { String::new() } else { last_error() };
        }
        (status, outputs)
    }

    /// The pressures of the handle's last result. None if it has none.
    pub fn pressures(&self, n: usize) -> Option<Vec<f64>> {
        let mut p = vec![SENTINEL; n];
        let mut fields = initialised(contact_normal_fields_init);
        fields.pressure = p.as_mut_ptr();
        // SAFETY: room for n values.
        let status = unsafe { contact_normal_solver_fields(self.0, &mut fields) };
        (status == CONTACT_NORMAL_OK).then_some(p)
    }
}

/// Solves a step of viscoelastic bodies with a handle. The first step makes the handle.
pub fn step(handle: &mut Option<Handle>, case: &Case, visco: &contact_normal_visco) -> Outputs {
    run(case, false, |scene, options, fields, report| {
        // SAFETY (all): structs with the arrays that they declare, and a handle that no one else uses.
        unsafe {
            let scene = contact_normal_scene { visco, ..*scene };
            if handle.is_none() {
                let mut new = null_mut();
                let status = contact_normal_solver_new(&scene, options, &mut new);
                if status != CONTACT_NORMAL_OK {
                    return status;
                }
                *handle = Some(Handle(new));
            }
            let handle = handle.as_ref().map_or(null_mut(), |handle| handle.0);
            contact_normal_solver_solve(handle, &scene, options, fields, report)
        }
    })
}

/// Solves a case without a handle.
pub fn solve(case: &Case) -> Outputs {
    run(case, false, |scene, options, fields, report| {
        // SAFETY: structs with the arrays that they declare.
        unsafe { contact_normal_solve(scene, options, fields, report) }
    })
}

/// Makes one call for a case, with outputs filled with sentinels.
fn run(
    case: &Case,
    previous: bool,
    call: impl FnOnce(
        *const contact_normal_scene,
        *const contact_normal_options,
        *mut contact_normal_fields,
        *mut contact_normal_report,
    ) -> i32,
) -> Outputs {
    let (mut outputs, mut fields) = outputs(case);
    let mut canceller = Canceller { calls: 0, at: 0 };
    let cycle = cycle(&case.how);
    let (scene, options) = (Scene::of(case), options(&case.how, previous, &cycle, &mut canceller));
    let before = outputs.bits();
    let force = outputs.report.normal.force.to_bits();
    let status = call(&scene.scene, &options, &mut fields, &mut outputs.report);
    outputs.written = outputs.bits() != before || outputs.report.normal.force.to_bits() != force;
    (outputs.status, outputs.overrun) = (status, canceller.overrun());
    outputs.message = if status == CONTACT_NORMAL_OK { String::new() } else { last_error() };
    outputs
}
