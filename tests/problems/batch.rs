//! A batch has the bits of the same solves one after the other, for any number of workers and any order. A problem that fails does not affect the
//! others.

use std::ptr::{null, null_mut};

use contact_normal::contact::State;
use contact_normal::error::Error;
use contact_normal::ffi::*;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{ActiveSet, Guess, InitialGuess, Method, Options, Outcome, Problem, Solver};

/// The grid is large enough for products on a window around the contact.
const M: usize = 72;
const STEEL: Bodies = Bodies { shear_modulus: [82000.0; 2], poisson_ratio: [0.28; 2] };

fn grid() -> Grid {
    Grid::new(M, M, 0.25, 0.2).expect("a grid")
}

/// Balls of several sizes, some of them wavy. Four successive ones have the same place, so that the window of one fits the next.
fn surface(k: usize) -> Vec<f64> {
    let place = (k / 4) as f64;
    let (centre_x, centre_y) = (M as f64 * (0.4 + 0.1 * place), M as f64 * (0.6 - 0.05 * place));
    (0..M * M)
        .map(|i| {
            let (x, y) = ((i % M) as f64 - centre_x, (i / M) as f64 - centre_y);
            let waves = if k % 3 == 0 { 0.002 * (0.9 * x).sin() * (0.7 * y).cos() } else { 0.0 };
            (1.0 + 0.3 * (k % 4) as f64) * 1e-4 * (x * x + y * y) + waves
        })
        .collect()
}

fn load(k: usize) -> Load {
    if k % 2 == 0 {
        Load::Approach(0.01 + 0.003 * (k % 6) as f64)
    } else {
        Load::Force(500.0 * (1 + k % 6) as f64)
    }
}

/// The result of a solve, in bits.
type Found = (Outcome, Vec<u64>, Vec<u64>, Vec<bool>, u64, u64);

fn found(state: &State, stop: Outcome, cycles: u64) -> Found {
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect();
    (stop, bits(&state.p), bits(&state.u), state.contact.clone(), state.approach.to_bits(), cycles)
}

/// Solves all problems on one handle in the order given.
fn one_by_one(problems: &[Problem<'_>], options: &Options, order: &[usize]) -> Vec<Found> {
    let mut solver = Solver::new(&problems[0].scene, options).expect("a solver");
    let mut results = vec![None; problems.len()];
    for &i in order {
        let (stop, report) = solver.solve(&problems[i].scene, options, problems[i].guess, None).expect("a solve");
        results[i] = Some(found(solver.state(), stop, report.count.cycles));
    }
    results.into_iter().map(|result| result.expect("all in order")).collect()
}

#[test]
fn a_batch_has_the_bits_of_one_solve_after_the_other() {
    let count = 12;
    let h: Vec<Vec<f64>> = (0..count).map(surface).collect();
    let pressure = vec![100.0; M * M];
    // The guess has contact in the middle of the grid, where all balls penetrate.
    let contact: Vec<bool> = (0..M * M).map(|i| (i % M).abs_diff(M / 2) < 9 && (i / M).abs_diff(M / 2) < 7).collect();
    let guess = Guess { pressure: &pressure, contact: &contact };
    let cold = Options::default();
    let cases = [
        cold,
        Options { initial_guess: InitialGuess::Given, ..cold },
        Options { method: Method::Norm, max_cycles: 5000, ..cold },
        Options { method: Method::FullMultigrid, ..cold },
        Options { active_set: ActiveSet::Fixed, ..cold },
    ];
    for options in cases {
        let guess =
            (options.initial_guess == InitialGuess::Given || options.active_set == ActiveSet::Fixed).then_some(guess);
        let problem = |k: usize| Problem { scene: Scene::new(grid(), &h[k], STEEL, load(k)), guess };
        let problems: Vec<Problem<'_>> = (0..count).map(problem).collect();
        let forwards: Vec<usize> = (0..count).collect();
        let backwards: Vec<usize> = (0..count).rev().collect();
        let expected = one_by_one(&problems, &options, &forwards);
        assert!(expected.iter().all(|found| found.0 == Outcome::Converged), "{options:?}");
        assert!(one_by_one(&problems, &options, &backwards) == expected, "the order changes results: {options:?}");
        for threads in [1, 2, 3] {
            let options = Options { threads, ..options };
            let mut solver = Solver::new(&problems[0].scene, &options).expect("a solver");
            // Solved twice: in the second batch the workers already have solved other problems.
            for _ in 0..2 {
                let batch = solver
                    .solve_batch(&problems, &options, |_, outcome, state| {
                        let (stop, report) = outcome.expect("a solve");
                        found(state, stop, report.count.cycles)
                    })
                    .expect("a batch");
                assert!(batch == expected, "{threads} threads: {options:?}");
            }
        }
    }
}

#[test]
fn a_batch_leaves_the_solver_its_last_result() {
    let (h, other) = (surface(1), surface(2));
    let scene = Scene::new(grid(), &h, STEEL, Load::Force(1000.0));
    let options = Options::default();
    let mut solver = Solver::new(&scene, &options).expect("a solver");
    solver.solve(&scene, &options, None, None).expect("a solve");
    let p = solver.state().p.clone();
    let problems = [Problem { scene: Scene::new(grid(), &other, STEEL, Load::Force(10.0)), guess: None }];
    solver.solve_batch(&problems, &options, |_, outcome, _| outcome.expect("a solve")).expect("a batch");
    assert!(solver.state().p == p);
    let (_, again) = solver
        .solve(&scene, &Options { initial_guess: InitialGuess::Previous, ..options }, None, None)
        .expect("a solve");
    assert!(again.count.cycles <= 1, "{} cycles from its own result", again.count.cycles);
    let previous = Options { initial_guess: InitialGuess::Previous, ..options };
    let refused = solver.solve_batch(&problems, &previous, |_, _, _| ());
    assert!(matches!(refused, Err(Error::InvalidArgument(message)) if message.contains("PREVIOUS")));
}

/// A batch through the C ABI.
struct Batch {
    h: Vec<Vec<f64>>,
    p: Vec<Vec<f64>>,
    scenes: Vec<contact_normal_scene>,
    fields: Vec<contact_normal_fields>,
    reports: Vec<contact_normal_report>,
    statuses: Vec<i32>,
    options: contact_normal_options,
    solver: *mut contact_normal_solver,
}

const UNTOUCHED: f64 = -77.0;

/// A `T` with the defaults that its `_init` function writes.
fn initialised<T>(init: unsafe extern "C" fn(*mut T)) -> T {
    let mut value = std::mem::MaybeUninit::uninit();
    // SAFETY: `_init` fills a whole struct.
    unsafe {
        init(value.as_mut_ptr());
        value.assume_init()
    }
}

impl Batch {
    fn new(count: usize, threads: i32) -> Batch {
        let h: Vec<Vec<f64>> = (0..count).map(surface).collect();
        let mut p = vec![vec![UNTOUCHED; M * M]; count];
        let scene = |h: &Vec<f64>| {
            let mut scene = initialised(contact_normal_scene_init);
            (scene.mx, scene.my, scene.dx, scene.dy) = (M as i32, M as i32, 0.25, 0.2);
            (scene.shear_modulus, scene.poisson_ratio) = (STEEL.shear_modulus, STEEL.poisson_ratio);
            (scene.undeformed_distance, scene.approach) = (h.as_ptr(), 0.02);
            scene
        };
        let scenes: Vec<_> = h.iter().map(scene).collect();
        let fields = p
            .iter_mut()
            .map(|p| contact_normal_fields { pressure: p.as_mut_ptr(), ..initialised(contact_normal_fields_init) })
            .collect();
        let reports = vec![initialised(contact_normal_report_init); count];
        let options = contact_normal_options { threads, ..initialised(contact_normal_options_init) };
        let mut solver = null_mut();
        // SAFETY: structs that declare their size.
        assert_eq!(unsafe { contact_normal_solver_new(&scenes[0], &options, &mut solver) }, CONTACT_NORMAL_OK);
        Batch { h, p, scenes, fields, reports, statuses: vec![-77; count], options, solver }
    }

    fn solve(&mut self) -> i32 {
        let (fields, reports) = (self.fields.as_mut_ptr(), self.reports.as_mut_ptr());
        let (count, scenes, statuses) = (self.h.len() as i32, self.scenes.as_ptr(), self.statuses.as_mut_ptr());
        // SAFETY: arrays of `count` structs or values.
        unsafe {
            contact_normal_solver_solve_batch(self.solver, count, scenes, &self.options, fields, reports, statuses)
        }
    }
}

impl Drop for Batch {
    fn drop(&mut self) {
        // SAFETY: made by `new`, freed once.
        unsafe { contact_normal_solver_free(self.solver) };
    }
}

fn last_error() -> String {
    // SAFETY: never NULL, valid until the next call.
    unsafe { std::ffi::CStr::from_ptr(contact_normal_last_error()) }.to_str().expect("UTF-8").to_owned()
}

#[test]
fn a_problem_that_fails_harms_no_other() {
    for threads in [1, 2, 3] {
        let count = 9;
        let mut good = Batch::new(count, threads);
        assert_eq!(good.solve(), CONTACT_NORMAL_OK, "{}", last_error());
        assert!(good.statuses.iter().all(|&status| status == CONTACT_NORMAL_OK));

        let mut batch = Batch::new(count, threads);
        batch.h[4][11] = f64::NAN;
        batch.scenes[6].mx = 3;
        batch.scenes[7].struct_size -= 1;
        assert_eq!(batch.solve(), CONTACT_NORMAL_NOT_FINITE);
        assert!(
            last_error().starts_with("problem 4: undeformed_distance of element (11, 0) is NaN"),
            "{}",
            last_error()
        );
        let problems: Vec<String> =
            last_error().lines().map(|line| line.split(": ").next().unwrap().to_owned()).collect();
        assert_eq!(problems, ["problem 4", "problem 6", "problem 7"]);
        for i in 0..count {
            let expected = match i {
                4 => CONTACT_NORMAL_NOT_FINITE,
                6 => CONTACT_NORMAL_INVALID_ARGUMENT,
                7 => CONTACT_NORMAL_STRUCT_SIZE,
                _ => CONTACT_NORMAL_OK,
            };
            assert_eq!(batch.statuses[i], expected, "problem {i}");
            if expected == CONTACT_NORMAL_OK {
                assert!(
                    batch.p[i] == good.p[i] && batch.reports[i].normal.force == good.reports[i].normal.force,
                    "problem {i}"
                );
            } else {
                assert!(
                    batch.p[i].iter().all(|&p| p == UNTOUCHED) && batch.reports[i].normal.force == 0.0,
                    "problem {i}"
                );
            }
        }
    }
}

#[test]
fn stopping_early_counts_less_than_a_refusal() {
    let mut batch = Batch::new(5, 2);
    (batch.options.max_cycles, batch.options.tolerance) = (1, 1e-13);
    assert_eq!(batch.solve(), CONTACT_NORMAL_ITERATION_LIMIT);
    assert!(last_error().starts_with("problem 0: max_cycles was reached"), "{}", last_error());
    assert!(batch.statuses.iter().all(|&status| status == CONTACT_NORMAL_ITERATION_LIMIT));
    assert!(batch.p.iter().flatten().all(|&p| p >= 0.0), "the best iterates are written");
    batch.scenes[3].load = 9;
    assert_eq!(batch.solve(), CONTACT_NORMAL_INVALID_ARGUMENT);
    assert!(last_error().starts_with("problem 3: load is 9"), "{}", last_error());
    assert_eq!(batch.statuses, [1, 1, 1, CONTACT_NORMAL_INVALID_ARGUMENT, 1]);
    let problems: Vec<String> = last_error().lines().map(|line| line[.."problem 3".len()].to_owned()).collect();
    assert_eq!(problems, ["problem 3", "problem 0", "problem 1", "problem 2", "problem 4"]);
}

#[test]
fn one_array_for_two_problems_is_refused() {
    let mut batch = Batch::new(4, 2);
    batch.fields[3].pressure = batch.fields[1].pressure;
    assert_eq!(batch.solve(), CONTACT_NORMAL_INVALID_ARGUMENT);
    assert!(last_error().contains("pressure of problem 1 and pressure of problem 3 overlap"), "{}", last_error());
    assert!(batch.statuses.iter().all(|&status| status == -77), "the call is refused, not its problems");
    assert!(batch.p.iter().flatten().all(|&p| p == UNTOUCHED));
    // An overlap with a part of another array. The undeformed distance may be shared.
    batch.fields[3].pressure = batch.p[2][5..].as_mut_ptr();
    assert_eq!(batch.solve(), CONTACT_NORMAL_INVALID_ARGUMENT);
    batch.fields[3].pressure = batch.p[3].as_mut_ptr();
    batch.scenes.iter_mut().for_each(|scene| scene.undeformed_distance = batch.h[0].as_ptr());
    assert_eq!(batch.solve(), CONTACT_NORMAL_OK, "{}", last_error());
    assert!(batch.p.iter().all(|p| *p == batch.p[0]));
}

#[test]
fn arrays_of_outputs_may_be_null() {
    let batch = Batch::new(3, 2);
    let (none, no_reports, no_statuses) = (null_mut(), null_mut(), null_mut());
    // SAFETY: an array of 3 scenes; NULL elsewhere.
    let status = unsafe {
        contact_normal_solver_solve_batch(
            batch.solver,
            3,
            batch.scenes.as_ptr(),
            &batch.options,
            none,
            no_reports,
            no_statuses,
        )
    };
    assert_eq!(status, CONTACT_NORMAL_OK);
    // The options must be those of the set-up; the defaults have another number of threads.
    // SAFETY: as above.
    let status = unsafe {
        let (solver, scenes) = (batch.solver, batch.scenes.as_ptr());
        contact_normal_solver_solve_batch(solver, 3, scenes, null(), none, no_reports, no_statuses)
    };
    assert_eq!((status, last_error().contains("threads")), (CONTACT_NORMAL_INVALID_ARGUMENT, true));
}
