//! `contact_normal_solve_tangential` with a handle: the tractions that the handle keeps, refusals, and initial guesses.

use std::ptr::{null, null_mut};

use crate::call::{initialised, last_error};
use contact_normal::ffi::*;

const M: usize = 16;
const N: usize = M * M;

/// A ball's pressures on a grid, friction, and room for the results.
struct Call {
    scene: contact_normal_scene,
    friction: contact_normal_friction,
    options: contact_normal_options,
    tables: [contact_normal_influence; 3],
    values: [Vec<f64>; 3],
    pressure: Vec<f64>,
    before: [Vec<f64>; 2],
    traction: Vec<f64>,
    report: contact_normal_report,
}

impl Call {
    fn new() -> Box<Call> {
        let place = |i: usize| ((i % M) as f64 - 7.5, (i / M) as f64 - 7.5);
        let squared = |i: usize| place(i).0.powi(2) + place(i).1.powi(2);
        let mut call = Box::new(Call {
            scene: initialised(contact_normal_scene_init),
            friction: initialised(contact_normal_friction_init),
            options: initialised(contact_normal_options_init),
            tables: [initialised(contact_normal_influence_init); 3],
            values: Default::default(),
            pressure: (0..N).map(|i| (1.0 - squared(i) / 40.0).max(0.0).sqrt()).collect(),
            before: Default::default(),
            traction: vec![0.0; 2 * N],
            report: initialised(contact_normal_report_init),
        });
        let inner = &mut *call;
        (inner.scene.mx, inner.scene.my, inner.scene.dx, inner.scene.dy) = (M as i32, M as i32, 1.0, 1.0);
        (inner.scene.shear_modulus, inner.scene.poisson_ratio) = ([100.0; 2], [0.28; 2]);
        inner.friction.coefficient = 0.3;
        inner.friction.creepage = [-0.01, 0.002];
        inner.options.tolerance = 1e-9;
        inner.scene.friction = &raw const inner.friction;
        call
    }

    /// Sets the caller's tables: `factor` times a function that decays with the distance.
    fn use_tables(&mut self, factor: f64) {
        let offset = |k: usize| ((k % (2 * M)) as f64 - M as f64, (k / (2 * M)) as f64 - M as f64);
        let along = |k: usize| factor / (1.0 + offset(k).0.hypot(offset(k).1));
        let across = |k: usize| {
            let (x, y) = offset(k);
            0.1 * factor * x * y / (1.0 + x * x + y * y).powf(1.5)
        };
        self.values =
            [(0..4 * N).map(along).collect(), (0..4 * N).map(along).collect(), (0..4 * N).map(across).collect()];
        for (k, table) in self.tables.iter_mut().enumerate() {
            (table.cx, table.cy, table.coefficients) = (M as i32, M as i32, self.values[k].as_ptr());
            self.friction.influence[k] = table;
        }
    }

    /// Makes the last tractions the previous tractions of the next step.
    fn go_on(&mut self) {
        self.before = [self.traction[..N].to_vec(), self.traction[N..].to_vec()];
        self.friction.previous_traction = self.before.each_ref().map(|q| q.as_ptr());
    }

    fn run(&mut self, solver: *mut contact_normal_solver) -> (i32, String) {
        let mut results = initialised(contact_normal_friction_results_init);
        results.traction = self.traction.as_mut_ptr();
        // SAFETY: structs with their arrays; a handle or NULL.
        unsafe {
            let (scene, p, options) = (&raw const self.scene, self.pressure.as_ptr(), &raw const self.options);
            let report = &raw mut self.report;
            let status = contact_normal_solve_tangential(solver, scene, p, options, 1, null(), &mut results, report);
            (status, if status == CONTACT_NORMAL_OK { String::new() } else { last_error() })
        }
    }

    fn products(&self) -> f64 {
        self.report.statistics.tangential_products
    }
}

struct Handle(*mut contact_normal_solver);

impl Handle {
    fn of(call: &Call) -> Handle {
        let mut handle = null_mut();
        // SAFETY: structs with their arrays.
        let status = unsafe { contact_normal_solver_new(&call.scene, &call.options, &mut handle) };
        assert_eq!(status, CONTACT_NORMAL_OK);
        Handle(handle)
    }

    fn set_influence(&self, call: &Call) -> i32 {
        // SAFETY: a handle, structs with their arrays.
        unsafe { contact_normal_solver_set_influence(self.0, null(), &call.friction) }
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: a handle of the library's.
        unsafe { contact_normal_solver_free(self.0) };
    }
}

const OK: (i32, String) = (CONTACT_NORMAL_OK, String::new());

/// The largest difference between two fields of tractions, relative to the largest traction of `one`.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    let largest = one.iter().fold(0.0f64, |most, q| most.max(q.abs()));
    one.iter().zip(other).fold(0.0f64, |most, (a, b)| most.max((a - b).abs())) / largest
}

/// The tractions of `contact_normal_solve_tangential` are the last tractions of the handle, also for a whole solve that continues.
#[test]
fn a_solve_continues_from_tractions_without_a_normal_problem() {
    let mut call = Call::new();
    let handle = Handle::of(&call);
    assert_eq!(call.run(handle.0), OK);
    let h: Vec<f64> =
        (0..N).map(|i| 1e-3 * ((i % M) as f64 - 7.5).powi(2) + 1e-3 * ((i / M) as f64 - 7.5).powi(2)).collect();
    call.friction.continues = 1;
    let inner = &mut *call;
    (inner.scene.load, inner.scene.approach) = (CONTACT_NORMAL_PRESCRIBED_APPROACH, 0.05);
    inner.scene.undeformed_distance = h.as_ptr();
    // SAFETY: a handle, structs with their arrays.
    let status = unsafe { contact_normal_solver_solve(handle.0, &inner.scene, &inner.options, null_mut(), null_mut()) };
    assert_eq!(status, CONTACT_NORMAL_OK);
}

#[test]
fn a_handle_has_the_bits_of_single_calls() {
    for motion in
        [CONTACT_NORMAL_MOTION_SHIFT, CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING, CONTACT_NORMAL_MOTION_STEADY_ROLLING]
    {
        for own in [false, true] {
            let (mut alone, mut kept) = (Call::new(), Call::new());
            for call in [&mut alone, &mut kept] {
                call.friction.motion = motion;
                if own {
                    call.use_tables(0.01);
                }
            }
            // The scene has neither an undeformed distance nor a load.
            let handle = Handle::of(&kept);
            for step in 0..3 {
                for call in [&mut alone, &mut kept] {
                    call.friction.creepage[0] *= 1.1;
                }
                // Later scenes may leave the tables out.
                if step > 0 {
                    kept.friction.influence = [null(); 3];
                }
                assert_eq!(alone.run(null_mut()), OK);
                assert_eq!(kept.run(handle.0), OK);
                assert_eq!(alone.traction, kept.traction, "motion {motion}, own {own}, step {step}");
                assert!(kept.report.tangential.force[0] > 0.0);
                alone.go_on();
                kept.go_on();
            }
        }
    }
}

#[test]
fn tractions_of_the_step_before_are_kept() {
    let (mut alone, mut kept) = (Call::new(), Call::new());
    let handle = Handle::of(&kept);
    let mut early = Call::new();
    early.friction.continues = 1;
    let refused = early.run(handle.0);
    assert!(refused.0 == CONTACT_NORMAL_INVALID_ARGUMENT && refused.1.contains("no tractions"), "{refused:?}");
    assert_eq!(alone.run(null_mut()), OK);
    assert_eq!(kept.run(handle.0), OK);
    alone.go_on();
    kept.friction.continues = 1;
    for call in [&mut alone, &mut kept] {
        call.friction.creepage = [0.004, 0.0];
        for p in &mut call.pressure {
            *p *= 1.1;
        }
    }
    assert_eq!(alone.run(null_mut()), OK);
    assert_eq!(kept.run(handle.0), OK);
    assert_eq!(alone.traction, kept.traction);
    // A call with several entries does not change the last tractions.
    let entries = [[0.001, 0.0, 0.0], [0.002, 0.0, 0.0]];
    kept.friction.continues = 0;
    // SAFETY: structs with their arrays, and two entries.
    let status = unsafe {
        let (scene, p, options) = (&raw const kept.scene, kept.pressure.as_ptr(), &raw const kept.options);
        let entries = entries.as_ptr().cast();
        contact_normal_solve_tangential(handle.0, scene, p, options, 2, entries, null_mut(), null_mut())
    };
    assert_eq!(status, CONTACT_NORMAL_OK);
    alone.go_on();
    kept.friction.continues = 1;
    assert_eq!(alone.run(null_mut()), OK);
    assert_eq!(kept.run(handle.0), OK);
    assert_eq!(alone.traction, kept.traction);
}

#[test]
fn other_tables_have_a_status_of_their_own() {
    let mut call = Call::new();
    call.use_tables(0.01);
    let handle = Handle::of(&call);
    assert_eq!(call.run(handle.0), OK);
    call.use_tables(0.02);
    let before = call.traction.clone();
    let (status, message) = call.run(handle.0);
    assert_eq!(status, CONTACT_NORMAL_INFLUENCE_CHANGED, "{message}");
    assert!(
        message.contains("friction->influence") && message.contains("contact_normal_solver_set_influence"),
        "{message}"
    );
    assert_eq!(call.traction, before);
    assert_eq!(handle.set_influence(&call), CONTACT_NORMAL_OK);
    assert_eq!(call.run(handle.0), OK);
    let found = call.traction.clone();
    assert_eq!(call.run(null_mut()), OK);
    assert_eq!(found, call.traction);
    // An invalid table is refused. It changes nothing.
    call.values[2][(M + 1) * 2 * M + M + 1] += 1.0;
    assert_eq!(handle.set_influence(&call), CONTACT_NORMAL_UNSUPPORTED);
    call.friction.influence = [null(); 3];
    assert_eq!(handle.set_influence(&call), CONTACT_NORMAL_INVALID_ARGUMENT);
    assert_eq!(call.run(handle.0), OK);
    assert_eq!(found, call.traction);
    // Coefficients of the half-space cannot be exchanged for tables.
    let mut plain = Call::new();
    let half_space = Handle::of(&plain);
    assert_eq!(plain.run(half_space.0), OK);
    plain.use_tables(0.01);
    assert_eq!(plain.run(half_space.0).0, CONTACT_NORMAL_INFLUENCE_CHANGED);
    assert_eq!(half_space.set_influence(&plain), CONTACT_NORMAL_INVALID_ARGUMENT);
}

#[test]
fn the_last_tractions_outlive_other_tables() {
    let (mut alone, mut kept) = (Call::new(), Call::new());
    for call in [&mut alone, &mut kept] {
        call.use_tables(0.01);
    }
    let handle = Handle::of(&kept);
    assert_eq!(alone.run(null_mut()), OK);
    assert_eq!(kept.run(handle.0), OK);
    alone.go_on();
    for call in [&mut alone, &mut kept] {
        call.use_tables(0.012);
        call.friction.creepage[0] = 0.01;
    }
    kept.friction.continues = 1;
    assert_eq!(handle.set_influence(&kept), CONTACT_NORMAL_OK);
    assert_eq!(kept.run(handle.0), OK);
    assert_eq!(alone.run(null_mut()), OK);
    assert_eq!(alone.traction, kept.traction);
}

#[test]
fn a_start_near_the_solution_saves_products_and_changes_nothing() {
    for motion in
        [CONTACT_NORMAL_MOTION_SHIFT, CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING, CONTACT_NORMAL_MOTION_STEADY_ROLLING]
    {
        for by_force in [false, true] {
            let mut call = Call::new();
            call.friction.motion = motion;
            if by_force {
                call.friction.prescribed[0] = CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE;
                call.friction.force[0] = 10.0;
            }
            assert_eq!(call.run(null_mut()), OK);
            let (cold, found) = (call.products(), call.traction.clone());
            // A start from the solution takes one product, that of the certificate.
            let start = [found[..N].to_vec(), found[N..].to_vec()];
            call.friction.initial_traction = start.each_ref().map(|q| q.as_ptr());
            assert_eq!(call.run(null_mut()), OK);
            assert!(
                call.products() < 0.5 * cold,
                "motion {motion}, by force {by_force}: {} of {cold}",
                call.products()
            );
            // A residual of 1e-9 leaves an error of some 1e-8 in the tractions, of which 1e-6 is ample.
            assert!(apart(&found, &call.traction) < 1e-6, "{motion} {by_force}: {}", apart(&found, &call.traction));
            // The library drops an initial guess that is far from the solution.
            let far = [vec![-1e3; N], vec![7.0; N]];
            call.friction.initial_traction = far.each_ref().map(|q| q.as_ptr());
            assert_eq!(call.run(null_mut()), OK);
            assert!(apart(&found, &call.traction) < 1e-6);
            assert!(
                call.products() <= cold + 2.0,
                "motion {motion}, by force {by_force}: {} of {cold}",
                call.products()
            );
            // The option PREVIOUS does the same with the last tractions of the handle.
            call.friction.initial_traction = [null(); 2];
            let handle = Handle::of(&call);
            assert_eq!(call.run(handle.0), OK);
            call.options.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
            assert_eq!(call.run(handle.0), OK);
            assert!(call.products() < 0.5 * cold);
            assert!(apart(&found, &call.traction) < 1e-6);
        }
    }
    let mut call = Call::new();
    let start = vec![f64::NAN; N];
    call.friction.initial_traction = [start.as_ptr(); 2];
    let (status, message) = call.run(null_mut());
    assert!(status == CONTACT_NORMAL_NOT_FINITE && message.contains("initial_traction"), "{status} {message}");
    call.friction.initial_traction[1] = null();
    assert_eq!(call.run(null_mut()).0, CONTACT_NORMAL_NULL_POINTER);
}

#[test]
fn own_tables_may_end_with_the_grid_in_rolling() {
    for motion in [CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING, CONTACT_NORMAL_MOTION_STEADY_ROLLING] {
        let mut call = Call::new();
        call.use_tables(0.01);
        call.friction.motion = motion;
        assert_eq!(call.run(null_mut()), OK);
        assert!(call.report.tangential.force[0] > 0.0);
        // The contact area together with this step needs larger tables.
        call.friction.rolling_distance = 5.0;
        let (status, message) = call.run(null_mut());
        assert!(status == CONTACT_NORMAL_INVALID_ARGUMENT && message.contains("cx is 16"), "{status} {message}");
    }
}

#[test]
fn what_a_handle_needs_is_said() {
    let mut call = Call::new();
    let handle = Handle::of(&call);
    // SAFETY (both): structs with their arrays; no pressures.
    unsafe {
        let (scene, options) = (&raw const call.scene, &raw const call.options);
        let status =
            contact_normal_solve_tangential(handle.0, scene, null(), options, 1, null(), null_mut(), null_mut());
        assert_eq!(status, CONTACT_NORMAL_NULL_POINTER);
        assert!(last_error().contains("pressure"));
    }
    call.scene.mx = 8;
    assert_eq!(call.run(handle.0).0, CONTACT_NORMAL_INVALID_ARGUMENT);
}

#[test]
fn previous_forgets_creepages_that_are_given_now() {
    let mut call = Call::new();
    let handle = Handle::of(&call);
    call.friction.prescribed[0] = CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE;
    call.friction.force[0] = 10.0;
    assert_eq!(call.run(handle.0), OK);
    call.friction.prescribed[0] = CONTACT_NORMAL_PRESCRIBED_CREEPAGE;
    call.options.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
    assert_eq!(call.run(handle.0), OK);
    let found = call.traction.clone();
    assert_eq!(call.run(null_mut()), OK);
    assert!(apart(&call.traction, &found) < 1e-6, "{}", apart(&call.traction, &found));
}

#[test]
fn a_table_of_entries_has_the_tables_of_its_handle() {
    let mut call = Call::new();
    call.use_tables(0.01);
    let with_tables = Handle::of(&call);
    let forces = |call: &Call, solver: *mut contact_normal_solver| {
        let (entries, mut force) = ([[-0.01, 0.0, 0.0], [-0.02, 0.0, 0.0]], [0.0; 4]);
        let mut results = initialised(contact_normal_friction_results_init);
        results.force = force.as_mut_ptr();
        let (scene, p, options) = (&raw const call.scene, call.pressure.as_ptr(), &raw const call.options);
        let entries = entries.as_ptr().cast();
        // SAFETY: structs with their arrays, and two entries.
        let status =
            unsafe { contact_normal_solve_tangential(solver, scene, p, options, 2, entries, &mut results, null_mut()) };
        (status, force)
    };
    let expected = forces(&call, null_mut());
    assert_eq!(expected.0, CONTACT_NORMAL_OK);
    assert_eq!(forces(&call, with_tables.0), expected);
    // Later scenes may leave the tables out.
    call.friction.influence = [null(); 3];
    assert_eq!(forces(&call, with_tables.0), expected);
    // A handle that was set up without tables does not accept any later, whatever it has solved before.
    let without = Handle::of(&call);
    let of_half_space = forces(&call, without.0);
    assert!(of_half_space.0 == CONTACT_NORMAL_OK && of_half_space != expected);
    call.use_tables(0.01);
    assert_eq!(forces(&call, without.0).0, CONTACT_NORMAL_INFLUENCE_CHANGED);
}

/// If a later scene leaves out the tables of the handle, they exclude the same effects as if the scene had them.
#[test]
fn coefficients_that_are_left_out_exclude_what_they_exclude() {
    let mut call = Call::new();
    call.use_tables(0.01);
    let normal = call.tables[0];
    call.scene.influence = &raw const normal;
    let handle = Handle::of(&call);
    // The constants of the bodies are not read if the caller gives coefficients.
    call.scene.shear_modulus = [1.0, 7.0];
    assert_eq!(call.run(handle.0), OK);
    call.scene.influence = null();
    assert_eq!(call.run(handle.0), OK);
    let mut plain = Call::new();
    plain.use_tables(0.01);
    plain.scene.influence = &raw const normal;
    plain.friction.influence = [null(); 3];
    plain.scene.friction = null();
    let handle = Handle::of(&plain);
    plain.scene.influence = null();
    plain.scene.friction = &raw const plain.friction;
    let (status, message) = plain.run(handle.0);
    assert!(status == CONTACT_NORMAL_UNSUPPORTED && message.contains("influence"), "{status} {message}");
}
