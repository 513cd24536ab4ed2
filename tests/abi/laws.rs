//! Friction laws and plastic layers through the C ABI: refusals with messages that name the member, and the state of particles from call to call.

use std::ptr::{null, null_mut};

use crate::call::{last_error, Call, Through, MX, MY};
use contact_normal::ffi::*;

fn falling(friction: &mut contact_normal_friction) {
    (friction.law, friction.kinetic, friction.falling[0]) = (CONTACT_NORMAL_FRICTION_LAW_EXPONENTIAL, 0.1, 0.2);
    (friction.half_speed[0], friction.time_step, friction.speed) = (1e-2, 1.0, 100.0);
}

#[test]
fn what_is_no_law_or_not_solved_is_refused_by_name() {
    type Spoil = fn(&mut contact_normal_friction);
    let cases: [(Spoil, i32, &str); 17] = [
        (|f| f.law = 4, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->law is 4"),
        (|f| f.reserved_for_law = 1, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->reserved_for_law"),
        (|f| f.kinetic = -1.0, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->kinetic is -1"),
        (|f| f.half_speed[0] = 0.0, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->half_speed[0] is 0"),
        (|f| f.time_step = 0.0, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->time_step is 0"),
        (|f| f.memory_distance = f64::NAN, CONTACT_NORMAL_NOT_FINITE, "friction->memory_distance is NaN"),
        (|f| f.yield_limit = -2.0, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->yield_limit is -2"),
        (|f| f.hardening = 5.0, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->yield_limit is 0"),
        (
            |f| {
                f.prescribed[1] = CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE;
                f.branch = CONTACT_NORMAL_FRICTION_BRANCH_HIGH;
            },
            CONTACT_NORMAL_UNSUPPORTED,
            "friction->law is given: with a branch creepages",
        ),
        (|f| f.branch = 3, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->branch is 3"),
        // These values are refused because products with other values are infinite, or 0.
        (|f| f.half_speed[0] = 1e-158, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->half_speed[0] is 1e-158"),
        (|f| f.yield_limit = 1e-160, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->yield_limit is 1e-160"),
        (
            |f| (f.yield_limit, f.hardening) = (1.0, 1e303),
            CONTACT_NORMAL_INVALID_ARGUMENT,
            "friction->hardening is 1e303",
        ),
        (|f| f.reserved_for_branch = 1, CONTACT_NORMAL_INVALID_ARGUMENT, "friction->reserved_for_branch is 1"),
        (|f| f.sensitivities = 1, CONTACT_NORMAL_UNSUPPORTED, "friction->law is given: friction->sensitivities"),
        (
            |f| {
                f.motion = CONTACT_NORMAL_MOTION_STEADY_ROLLING;
                (f.memory_distance, f.rolling_distance) = (1e-3, 0.3);
            },
            CONTACT_NORMAL_UNSUPPORTED,
            "whole elements",
        ),
        (
            |f| {
                f.motion = CONTACT_NORMAL_MOTION_STEADY_ROLLING;
                f.speed = 0.0;
            },
            CONTACT_NORMAL_INVALID_ARGUMENT,
            "friction->speed is 0",
        ),
    ];
    for (spoil, status, words) in cases {
        let mut call = Call::new();
        falling(call.use_friction());
        spoil(call.use_friction());
        let before = call.outputs();
        let (got, message) = call.run(Through::Solve, null_mut());
        assert_eq!(got, status, "{words}: {message}");
        assert!(message.contains(words), "\"{message}\" does not say {words}");
        assert!(call.outputs() == before, "{words}: refused, but written");
    }
    let mut call = Call::new();
    falling(call.use_friction());
    call.scene.known.shear_modulus[1] = 41000.0;
    let (got, message) = call.run(Through::Solve, null_mut());
    assert!(got == CONTACT_NORMAL_UNSUPPORTED && message.contains("bodies must be alike"), "{message}");
}

/// Under a steep law a result without a certificate has a message with the slope of the law, and a result with status OK has the warning.
#[test]
fn a_steep_law_is_certified_or_named() {
    let (mut refused, mut limited) = (0, 0);
    for k in 0..24 {
        for max_cycles in [9, 1000] {
            let mut call = Call::new();
            falling(call.use_friction());
            let friction = call.use_friction();
            (friction.half_speed[0], friction.branch) = (1e-2 * 0.5f64.powi(k / 2), k % 3);
            call.options.known.max_cycles = max_cycles;
            let (status, message) = call.run(Through::Solve, null_mut());
            let report = &call.report.known;
            let slope = report.tangential.law_slope;
            assert!(
                [CONTACT_NORMAL_OK, CONTACT_NORMAL_STAGNATED, CONTACT_NORMAL_ITERATION_LIMIT].contains(&status),
                "{message}"
            );
            assert_eq!(report.warnings & CONTACT_NORMAL_WARNING_LAW != 0, slope >= 0.5, "{slope}");
            println!("{k} {max_cycles} {slope:.3} {status} {message}");
            if status != CONTACT_NORMAL_OK && slope >= 0.5 {
                assert!(message.contains(&format!("tangential.law_slope is {slope:.2}")), "{message}");
                refused += i32::from(status == CONTACT_NORMAL_STAGNATED);
                limited += i32::from(status == CONTACT_NORMAL_ITERATION_LIMIT);
            }
        }
    }
    assert!(refused + limited > 0 && limited > 0, "{refused} {limited}");
}

/// If a force is not reached, the message has its missing part, relative to mu N.
#[test]
fn a_force_that_is_missed_says_by_how_much() {
    let (n, mut told) = (MX * MY, 0);
    for part in [1.0, 0.4] {
        let mut call = Call::new();
        call.scene.known.shear_modulus[1] = part * call.scene.known.shear_modulus[0];
        assert_eq!(call.run(Through::Solve, null_mut()).0, CONTACT_NORMAL_OK);
        let mu = call.use_friction().coefficient;
        let wanted = 0.6 * mu * call.report.known.normal.force;
        let friction = call.use_friction();
        friction.prescribed = [CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE; 2];
        friction.force = [wanted, 0.0];
        let mut q = vec![0.0; 2 * n];
        call.fields.known.traction = [q.as_mut_ptr(), q[n..].as_mut_ptr()];
        for max_cycles in [1, 2, 3, 5, 8] {
            call.options.known.max_cycles = max_cycles;
            let (status, message) = call.run(Through::Solve, null_mut());
            assert!(status == CONTACT_NORMAL_OK || status == CONTACT_NORMAL_ITERATION_LIMIT, "{message}");
            let area = call.scene.known.dx * call.scene.known.dy;
            let force = |k: usize| q[k * n..(k + 1) * n].iter().sum::<f64>() * area;
            let missing = (force(0) - wanted).hypot(force(1)) / (mu * call.report.known.normal.force);
            let Some((_, rest)) = message.split_once("the tangential force is off by ") else {
                assert!(missing <= 1.01e-6, "{max_cycles}: {missing:e}, {message}");
                continue;
            };
            let said: f64 = rest.split(' ').next().unwrap().parse().unwrap();
            assert!((said - missing).abs() <= 1e-9 + 1e-6 * missing, "{max_cycles}: {missing:e}, {message}");
            told += 1;
        }
    }
    assert!(told > 0, "each force was reached");
}

/// Two shifts over a layer that hardens have the same result if a handle continues, and if the caller passes the previous fields.
#[test]
fn a_handle_carries_what_the_caller_would_hand_on() {
    let n = MX * MY;
    let mut call = Call::new();
    let harden = |call: &mut Call| {
        let friction = call.use_friction();
        falling(friction);
        (friction.memory_distance, friction.memory_speed) = (1e-4, 1e-4);
        (friction.yield_limit, friction.hardening) = (30.0, 2e4);
    };
    harden(&mut call);
    let handle = call.new_handle();
    let found = |call: &mut Call, handle: *mut contact_normal_solver| {
        let (mut q, mut mu, mut limit) = (vec![-1.0; 2 * n], vec![-1.0; n], vec![-1.0; n]);
        let fields = &mut call.fields.known;
        fields.traction = [q.as_mut_ptr(), q[n..].as_mut_ptr()];
        (fields.friction_coefficient, fields.yield_limit) = (mu.as_mut_ptr(), limit.as_mut_ptr());
        let through = if handle.is_null() { Through::Solve } else { Through::SolverSolve };
        let (status, message) = call.run(through, handle);
        assert_eq!(status, CONTACT_NORMAL_OK, "{message}");
        (q, mu, limit)
    };
    let (q, mu, limit) = found(&mut call, handle);
    assert!(mu.iter().any(|mu| *mu < 0.29) && limit.iter().any(|limit| *limit > 30.5), "{mu:?} {limit:?}");
    call.use_friction().continues = 1;
    let kept = found(&mut call, handle);
    // SAFETY: a handle of ours.
    unsafe { contact_normal_solver_free(handle) };
    let mut alone = Call::new();
    harden(&mut alone);
    let friction = alone.use_friction();
    friction.previous_traction = [q.as_ptr(), q[n..].as_ptr()];
    (friction.previous_coefficient, friction.previous_yield_limit) = (mu.as_ptr(), limit.as_ptr());
    assert!(found(&mut alone, null_mut()) == kept);
    let fresh = found(
        &mut {
            let mut call = Call::new();
            harden(&mut call);
            call
        },
        null_mut(),
    );
    assert!(fresh.2 != kept.2, "the second shift does not know of the first");
}

/// With Coulomb's friction the members of a law, and the state of particles, are not read.
#[test]
fn without_a_law_its_members_are_not_read() {
    let mut call = Call::new();
    let bad = vec![f64::NAN; MX * MY];
    let friction = call.use_friction();
    (friction.previous_coefficient, friction.previous_yield_limit) = (bad.as_ptr(), bad.as_ptr());
    (friction.half_speed, friction.kinetic) = ([f64::NAN; 2], f64::NAN);
    let (status, message) = call.run(Through::Solve, null_mut());
    assert_eq!(status, CONTACT_NORMAL_OK, "{message}");
}

/// With given pressures the warning LAW is that of a whole solve: with a handle and without one, for one problem and for several entries.
#[test]
fn a_steep_law_warns_of_pressures_that_are_given() {
    let mut said = [0; 2];
    for (half_speed, is_steep) in [(1.0, false), (1e-5, true)] {
        let mut call = Call::new();
        falling(call.use_friction());
        call.use_friction().half_speed[0] = half_speed;
        let handle = call.new_handle();
        let pressure: Vec<f64> = (0..MX * MY).map(|i| 50.0 + i as f64).collect();
        let entries = [1e-3, 0.0, 0.0, 2e-3, 0.0, 0.0];
        for (solver, n) in [(null_mut(), 1), (handle, 1), (null_mut(), 2), (handle, 2)] {
            call.report.known.warnings = -1;
            let (scene, report) = (&raw const call.scene.known, &raw mut call.report.known);
            let (given, table) = (pressure.as_ptr(), if n > 1 { entries.as_ptr() } else { null() });
            // SAFETY: structs with their arrays; a handle or NULL.
            let (status, message) = unsafe {
                let options = &raw const call.options.known;
                let status =
                    contact_normal_solve_tangential(solver, scene, given, options, n, table, null_mut(), report);
                (status, last_error())
            };
            assert!(status >= CONTACT_NORMAL_OK, "{message}");
            let report = &call.report.known;
            assert!(n > 1 || (report.tangential.law_slope >= 0.5) == is_steep, "{}", report.tangential.law_slope);
            assert_eq!(report.warnings, if is_steep { CONTACT_NORMAL_WARNING_LAW } else { 0 }, "{n} {half_speed}");
            assert_eq!(message.contains("several solutions"), is_steep, "{message}");
            said[usize::from(is_steep)] += 1;
        }
        // SAFETY: a handle of ours.
        unsafe { contact_normal_solver_free(handle) };
    }
    assert_eq!(said, [4; 2]);
}
