//! `contact_normal_solve_tangential` for several entries: results, refused entries, cancellation, and memory that overlaps.

use std::ptr::{null, null_mut};

use crate::call::{initialised, last_error};
use contact_normal::ffi::*;

const M: usize = 8;
const N: usize = M * M;
const COUNT: usize = 5;
/// No result has these values.
const SENTINEL: f64 = -12345.678;
const UNTOUCHED: i32 = -12345;

struct Call {
    scene: contact_normal_scene,
    friction: contact_normal_friction,
    options: contact_normal_options,
    h: Vec<f64>,
    pressure: Vec<f64>,
    entries: Vec<[f64; 3]>,
    results: contact_normal_friction_results,
    report: contact_normal_report,
    force: Vec<[f64; 2]>,
    numbers: [Vec<f64>; 4],
    creepage: Vec<[f64; 2]>,
    counts: [Vec<i64>; 2],
    status: Vec<i32>,
    fields: [Vec<f64>; 2],
    stick_slip: Vec<i32>,
}

impl Call {
    fn new() -> Box<Call> {
        let place = |i: usize| ((i % M) as f64 - 3.5, (i / M) as f64 - 3.5);
        let squared = |i: usize| place(i).0.powi(2) + place(i).1.powi(2);
        let mut call = Box::new(Call {
            scene: initialised(contact_normal_scene_init),
            friction: initialised(contact_normal_friction_init),
            options: initialised(contact_normal_options_init),
            h: (0..N).map(|i| 0.001 * squared(i)).collect(),
            pressure: (0..N).map(|i| (1.0 - squared(i) / 12.0).max(0.0).sqrt()).collect(),
            entries: (0..COUNT).map(|i| [-1e-6 * (i + 1) as f64, 2e-7, 1e-8]).collect(),
            results: initialised(contact_normal_friction_results_init),
            report: initialised(contact_normal_report_init),
            force: vec![[SENTINEL; 2]; COUNT],
            numbers: std::array::from_fn(|_| vec![SENTINEL; COUNT]),
            creepage: vec![[SENTINEL; 2]; COUNT],
            counts: std::array::from_fn(|_| vec![-1; COUNT]),
            status: vec![UNTOUCHED; COUNT],
            fields: std::array::from_fn(|_| vec![SENTINEL; 2 * N * COUNT]),
            stick_slip: vec![UNTOUCHED; N * COUNT],
        });
        let inner = &mut *call;
        let (scene, results) = (&mut inner.scene, &mut inner.results);
        (scene.mx, scene.my, scene.dx, scene.dy) = (M as i32, M as i32, 1.0, 1.0);
        (scene.shear_modulus, scene.poisson_ratio) = ([82000.0; 2], [0.28; 2]);
        (scene.load, scene.force) = (CONTACT_NORMAL_PRESCRIBED_FORCE, 20.0);
        inner.friction.coefficient = 0.3;
        (scene.undeformed_distance, scene.friction) = (inner.h.as_ptr(), &raw const inner.friction);
        (results.force, results.creepage) = (inner.force.as_mut_ptr().cast(), inner.creepage.as_mut_ptr().cast());
        let [moment, residual, gap, products] = inner.numbers.each_mut().map(|v| v.as_mut_ptr());
        (results.moment, results.residual, results.gap, results.products) = (moment, residual, gap, products);
        [results.stick_count, results.slip_count] = inner.counts.each_mut().map(|v| v.as_mut_ptr());
        [results.traction, results.slip] = inner.fields.each_mut().map(|v| v.as_mut_ptr());
        (results.status, results.stick_slip) = (inner.status.as_mut_ptr(), inner.stick_slip.as_mut_ptr());
        call
    }

    fn run_with(&mut self, pressure: *const f64, n: i32, entries: *const f64) -> (i32, String) {
        // SAFETY: arrays as long as the call says.
        unsafe {
            let (scene, options) = (&raw const self.scene, &raw const self.options);
            let status = contact_normal_solve_tangential(
                null_mut(),
                scene,
                pressure,
                options,
                n,
                entries,
                &mut self.results,
                &mut self.report,
            );
            (status, if status == CONTACT_NORMAL_OK { String::new() } else { last_error() })
        }
    }

    fn run(&mut self) -> (i32, String) {
        self.run_with(self.pressure.as_ptr(), self.entries.len() as i32, self.entries.as_ptr().cast())
    }

    /// Whether all results of entry i were written. Asserts that otherwise none was.
    fn is_written(&self, i: usize) -> bool {
        let fields = self.fields.iter().flat_map(|field| &field[2 * N * i..2 * N * (i + 1)]);
        let values = self.numbers.iter().map(|numbers| &numbers[i]).chain(&self.force[i]).chain(&self.creepage[i]);
        let floats: Vec<bool> = fields.chain(values).map(|value| *value != SENTINEL).collect();
        let counts = self.counts.iter().map(|counts| counts[i] >= 0);
        let stick_slip = self.stick_slip[N * i..N * (i + 1)].iter().map(|stick_slip| *stick_slip != UNTOUCHED);
        let all: Vec<bool> = floats.into_iter().chain(counts).chain(stick_slip).collect();
        assert!(all.iter().all(|written| *written == all[0]), "entry {i} is written in part");
        all[0]
    }
}

/// The status of an entry is that which the call has, also if the time limit ends the entry.
#[test]
fn entries_that_time_ends_have_reached_a_limit() {
    let mut call = Call::new();
    call.options.max_seconds = 1e-9;
    let (status, message) = call.run();
    assert!(status == CONTACT_NORMAL_ITERATION_LIMIT && message.contains("max_seconds was reached"), "{message}");
    assert!(call.status.iter().all(|status| [0, CONTACT_NORMAL_ITERATION_LIMIT].contains(status)), "{:?}", call.status);
    assert!(call.status.contains(&CONTACT_NORMAL_ITERATION_LIMIT));
    // A single problem uses all threads.
    let mut call = Call::new();
    (call.options.max_seconds, call.friction.creepage) = (1e-9, [-1e-6, 2e-7]);
    let (status, message) = call.run_with(call.pressure.as_ptr(), 1, null());
    assert_eq!((status, call.status[0]), (CONTACT_NORMAL_ITERATION_LIMIT, CONTACT_NORMAL_ITERATION_LIMIT), "{message}");
}

#[test]
fn all_results_are_written_and_agree() {
    let mut call = Call::new();
    assert_eq!(call.run(), (CONTACT_NORMAL_OK, String::new()));
    for i in 0..COUNT {
        assert!(call.is_written(i) && call.status[i] == CONTACT_NORMAL_OK);
        let traction = &call.fields[0][2 * N * i..2 * N * (i + 1)];
        let mut moment = 0.0;
        for k in 0..2 {
            let sum: f64 = traction[k * N..(k + 1) * N].iter().sum();
            assert!((call.force[i][k] - sum).abs() <= 1e-12, "{i} {k}: {} {sum}", call.force[i][k]);
            assert_eq!(call.creepage[i][k], call.entries[i][k]);
        }
        for e in 0..N {
            let (x, y) = ((e % M) as f64 - 3.5, (e / M) as f64 - 3.5);
            moment += x * traction[N + e] - y * traction[e];
        }
        assert!((call.numbers[0][i] - moment).abs() <= 1e-12);
        assert!(call.numbers[1][i] <= 1e-6 && call.numbers[3][i] > 0.0);
        let stick_slip = &call.stick_slip[N * i..N * (i + 1)];
        let count = |of: i32| stick_slip.iter().filter(|stick_slip| **stick_slip == of).count() as i64;
        let found = [call.counts[0][i], call.counts[1][i]];
        assert_eq!(found, [count(CONTACT_NORMAL_STICK_SLIP_STICK), count(CONTACT_NORMAL_STICK_SLIP_SLIP)]);
        for e in (0..N).filter(|e| stick_slip[*e] == CONTACT_NORMAL_STICK_SLIP_SLIP) {
            let (q, s) = (&call.fields[0][2 * N * i..], &call.fields[1][2 * N * i..]);
            assert!(q[e] * s[e] + q[N + e] * s[N + e] <= 0.0, "slip is opposite to traction");
        }
    }
    assert!((call.report.normal.force - call.pressure.iter().sum::<f64>()).abs() <= 1e-12);
    let given = call.force.clone();
    // The results are the same without fields, and with the pressures of the normal problem.
    call.results = contact_normal_friction_results {
        force: call.results.force,
        ..initialised(contact_normal_friction_results_init)
    };
    assert_eq!(call.run(), (CONTACT_NORMAL_OK, String::new()));
    assert_eq!(call.force, given);
    let (n, entries) = (COUNT as i32, call.entries.as_ptr().cast());
    assert_eq!(call.run_with(null(), n, entries), (CONTACT_NORMAL_OK, String::new()));
    assert!((call.report.normal.force - 20.0).abs() <= 1e-4 && call.force != given);
    assert_eq!(call.run_with(null(), 0, null()), (CONTACT_NORMAL_OK, String::new()));
}

#[test]
fn an_entry_that_is_refused_is_named() {
    let mut call = Call::new();
    (call.friction.prescribed[0], call.options.threads) = (CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE, 2);
    call.entries[1][0] = 1e9;
    call.entries[3][2] = f64::NAN;
    let (status, message) = call.run();
    assert_eq!(status, CONTACT_NORMAL_INFEASIBLE);
    let lines: Vec<&str> = message.lines().collect();
    assert!(lines.len() == 2 && lines[0].starts_with("entry 1: ") && lines[1].starts_with("entry 3: "), "{message}");
    let expected = [0, CONTACT_NORMAL_INFEASIBLE, 0, CONTACT_NORMAL_NOT_FINITE, 0];
    assert_eq!(call.status, expected);
    (0..COUNT).for_each(|i| assert_eq!(call.is_written(i), expected[i] == 0));
}

#[test]
fn the_call_itself_is_refused_by_name() {
    let refused = |change: &dyn Fn(&mut Call), status: i32, word: &str| {
        let mut call = Call::new();
        change(&mut call);
        let (got, message) = call.run();
        assert!(got == status && message.contains(word), "{word}: {got} {message}");
        assert!((0..COUNT).all(|i| !call.is_written(i)), "{word}");
        // The status is not among the overlapping outputs here, so that it must be untouched.
        assert!(call.status[0] == UNTOUCHED);
    };
    refused(&|call| call.scene.friction = null(), CONTACT_NORMAL_INVALID_ARGUMENT, "friction");
    refused(&|call| call.friction.continues = 1, CONTACT_NORMAL_INVALID_ARGUMENT, "continues");
    refused(&|call| call.friction.coefficient = -1.0, CONTACT_NORMAL_INVALID_ARGUMENT, "coefficient");
    refused(&|call| call.pressure[3] = f64::NAN, CONTACT_NORMAL_NOT_FINITE, "pressure");
    refused(&|call| call.results.moment = call.results.force, CONTACT_NORMAL_INVALID_ARGUMENT, "overlap");
    refused(&|call| call.results.gap = call.pressure.as_mut_ptr(), CONTACT_NORMAL_INVALID_ARGUMENT, "overlap");
    refused(&|call| call.results.gap = call.entries.as_mut_ptr().cast(), CONTACT_NORMAL_INVALID_ARGUMENT, "overlap");
    refused(&|call| call.results.struct_size = 96, CONTACT_NORMAL_STRUCT_SIZE, "results");
    let mut call = Call::new();
    let pressure = call.pressure.as_ptr();
    let (status, message) = call.run_with(pressure, -1, null());
    assert!(status == CONTACT_NORMAL_INVALID_ARGUMENT && message.contains("n is -1"));
    let (status, message) = call.run_with(pressure, 2, null());
    assert!(status == CONTACT_NORMAL_NULL_POINTER && message.contains("entries"));
}

/// A callback that cancels when `user` entries are done.
unsafe extern "C" fn cancel(progress: *const contact_normal_progress, user: *mut libc::c_void) -> i32 {
    // SAFETY: the library's progress, and our count.
    let (done, limit) = unsafe { ((*progress).cycles, *user.cast::<i64>()) };
    i32::from(done >= limit)
}

#[test]
fn cancelling_leaves_what_is_not_done() {
    let mut call = Call::new();
    let mut limit = 2i64;
    call.options.progress = Some(cancel);
    call.options.user = (&raw mut limit).cast();
    let (status, message) = call.run();
    assert_eq!((status, message.lines().count()), (CONTACT_NORMAL_CANCELLED, 3));
    assert_eq!(call.status, [0, 0, CONTACT_NORMAL_CANCELLED, CONTACT_NORMAL_CANCELLED, CONTACT_NORMAL_CANCELLED]);
    (0..COUNT).for_each(|i| assert_eq!(call.is_written(i), i < 2));
}
