//! Whichever allocation fails, the handle then holds its previous result, or none, and its next call works.

use std::ptr::{null, null_mut};

use super::call::initialised;
use super::limited_memory::{self, release, until_enough};
use super::{alone, Handle};
use contact_normal::ffi::*;

/// The number of elements in each direction. It is such that arrays of the grid in single precision count as large, but no array of a row does.
const M: usize = 64;
const N: usize = M * M;
/// The factors of two patches.
static FACTORS: [f64; 4] = [1.0, 0.5, 0.5, 1.0];

/// A ball on a plane, with the structs of its effects.
struct Ball {
    h: Vec<f64>,
    scene: contact_normal_scene,
    compliances: Vec<f64>,
    layer: contact_normal_layer,
    patch: Vec<i32>,
    patches: contact_normal_patches,
    limit: contact_normal_pressure_limit,
    coating: contact_normal_coating,
    period: contact_normal_period,
    friction: contact_normal_friction,
}

impl Ball {
    fn new() -> Box<Ball> {
        let centre = |i: usize| (i as f64 + 0.5 - 0.5 * M as f64) / M as f64;
        let mut ball = Box::new(Ball {
            h: (0..N).map(|i| centre(i % M).powi(2) + centre(i / M).powi(2)).collect(),
            scene: initialised(contact_normal_scene_init),
            compliances: (0..N).map(|i| if i % M < M / 2 { 0.01 } else { 0.02 }).collect(),
            layer: initialised(contact_normal_layer_init),
            patch: (0..N).map(|i| i32::from(i % M < M / 2)).collect(),
            patches: initialised(contact_normal_patches_init),
            limit: initialised(contact_normal_pressure_limit_init),
            coating: initialised(contact_normal_coating_init),
            period: initialised(contact_normal_period_init),
            friction: initialised(contact_normal_friction_init),
        });
        let scene = &mut ball.scene;
        (scene.mx, scene.my, scene.dx, scene.dy) = (M as i32, M as i32, 1.0 / M as f64, 1.0 / M as f64);
        (scene.shear_modulus, scene.poisson_ratio) = ([1.0; 2], [0.3; 2]);
        (scene.approach, scene.undeformed_distance) = (0.1, ball.h.as_ptr());
        ball.layer.compliances = ball.compliances.as_ptr();
        (ball.patches.count, ball.patches.patch) = (2, ball.patch.as_ptr());
        ball.patches.factors = FACTORS.as_ptr();
        ball.limit.limit = 0.2;
        let coating = &mut ball.coating;
        // A stiff coating that is thicker than an element is wide, so that all kinds of coefficients occur.
        (coating.thickness, coating.shear_modulus, coating.poisson_ratio) = (0.4, 3.0, 0.2);
        (ball.period.x, ball.period.y) = (1, 1);
        (ball.friction.coefficient, ball.friction.creepage) = (0.3, [-0.01, 0.0]);
        ball
    }

    /// Gives the scene the effects that the text `effect` names, or none.
    fn set_effect(&mut self, effect: &str) {
        let (layer, patches, limit) = (&raw const self.layer, &raw const self.patches, &raw const self.limit);
        let (coating, period) = (&raw const self.coating, &raw const self.period);
        let friction = &raw const self.friction;
        self.friction.motion = if effect.ends_with("rolling") { CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING } else { 0 };
        let scene = &mut self.scene;
        (scene.layer, scene.patches, scene.pressure_limit) = (null(), null(), null());
        (scene.coating, scene.period, scene.friction) = ([null(); 2], null(), null());
        scene.shear_modulus[1] = if effect.starts_with("unlike") { 2.0 } else { 1.0 };
        match effect {
            "none" => {}
            "layer" => scene.layer = layer,
            "patches" => scene.patches = patches,
            "pressure_limit" => scene.pressure_limit = limit,
            "coating" => scene.coating[0] = coating,
            "coating with a period" => (scene.coating[0], scene.period) = (coating, period),
            "period" => scene.period = period,
            "friction" | "friction rolling" | "unlike friction" | "unlike friction rolling" => {
                scene.friction = friction
            }
            _ => panic!("{effect}"),
        }
        (scene.load, scene.force) = match effect.contains("period") {
            // With two periods the force is prescribed, otherwise the approach.
            true => (CONTACT_NORMAL_PRESCRIBED_FORCE, 0.02),
            false => (CONTACT_NORMAL_PRESCRIBED_APPROACH, 0.0),
        };
    }

    /// Solves with the handle. Returns the status and the pressures.
    fn solve(&self, handle: &Handle, method: i32) -> (i32, Vec<f64>) {
        let mut options = initialised(contact_normal_options_init);
        (options.method, options.tolerance) = (method, 1e-3);
        let (mut p, mut fields) = (vec![-7.0; N], initialised(contact_normal_fields_init));
        fields.pressure = p.as_mut_ptr();
        // SAFETY: a handle, and structs with their arrays.
        let status = unsafe { contact_normal_solver_solve(handle.0, &self.scene, &options, &mut fields, null_mut()) };
        (status, p)
    }

    fn new_handle(&self) -> Handle {
        let mut handle = null_mut();
        // SAFETY: structs with their arrays.
        let status = unsafe { contact_normal_solver_new(&self.scene, null(), &mut handle) };
        assert_eq!(status, CONTACT_NORMAL_OK);
        Handle(handle)
    }
}

/// Solves the tangential problem alone. Returns the status and the tractions.
fn solve_tangential(ball: &Ball, pressure: &[f64]) -> (i32, Vec<f64>) {
    let mut traction = vec![-7.0; 2 * N];
    let mut results = initialised(contact_normal_friction_results_init);
    results.traction = traction.as_mut_ptr();
    let (scene, p) = (&raw const ball.scene, pressure.as_ptr());
    // SAFETY: structs with their arrays, and one pressure an element.
    let status =
        unsafe { contact_normal_solve_tangential(null_mut(), scene, p, null(), 1, null(), &mut results, null_mut()) };
    (status, traction)
}

/// The pressures that the handle holds, or `None` if it has no result.
fn held(handle: &Handle) -> Option<Vec<f64>> {
    let (mut p, mut fields) = (vec![-7.0; N], initialised(contact_normal_fields_init));
    fields.pressure = p.as_mut_ptr();
    // SAFETY: a handle, and a struct with its array.
    let status = unsafe { contact_normal_solver_fields(handle.0, &mut fields) };
    (status == CONTACT_NORMAL_OK).then_some(p)
}

/// Lets one allocation after the other fail, until a solve by `method` succeeds. If `first` is given, the handle has made a solve by this method
/// before.
fn fails_everywhere(ball: &Ball, first: Option<i32>, method: i32, what: &str) {
    let expected = ball.solve(&ball.new_handle(), method);
    assert_eq!(expected.0, CONTACT_NORMAL_OK, "{what}");
    until_enough(what, |allowed| {
        let handle = ball.new_handle();
        if let Some(first) = first {
            assert_eq!(ball.solve(&handle, first).0, CONTACT_NORMAL_OK, "{what}");
        }
        let before = held(&handle);
        assert_eq!(before.is_some(), first.is_some());
        release();
        // The first of the allowed allocations is the test's own array. Windows are smaller than the grid, so that arrays of half its elements count
        // as large.
        let (status, _) = limited_memory::with(2 * N, 1 + allowed, || ball.solve(&handle, method));
        if status != CONTACT_NORMAL_OK {
            let after = held(&handle);
            assert!(after.is_none() || after == before, "{what}, {allowed} allocations: half of a result");
            assert!(ball.solve(&handle, method) == expected, "{what}, {allowed} allocations: the next call");
        }
        status
    });
}

#[test]
fn after_a_lack_of_memory_the_handle_works() {
    let _alone = alone();
    let mut ball = Ball::new();
    for effect in ["none", "pressure_limit", "layer", "patches", "coating"] {
        ball.set_effect(effect);
        let methods = if effect == "none" { &[0, 1, 2, 3][..] } else { &[0, 1] };
        for &method in methods {
            for first in [None, Some(1 - method.min(1))] {
                fails_everywhere(&ball, first, method, &format!("{effect}, method {method} after {first:?}"));
            }
        }
    }
}

/// If a set-up lacks memory, there is no handle, and the next set-up is not affected.
#[test]
fn a_set_up_without_memory_makes_no_handle() {
    let _alone = alone();
    let mut ball = Ball::new();
    for effect in ["none", "layer", "patches", "period", "coating", "coating with a period"] {
        ball.set_effect(effect);
        let expected = ball.solve(&ball.new_handle(), 0);
        assert_eq!(expected.0, CONTACT_NORMAL_OK, "{effect}");
        until_enough(effect, |allowed| {
            let mut handle = null_mut();
            // SAFETY: structs with their arrays.
            let new = || unsafe { contact_normal_solver_new(&ball.scene, null(), &mut handle) };
            let status = limited_memory::with(4 * N, allowed, new);
            if status == CONTACT_NORMAL_OK {
                assert!(ball.solve(&Handle(handle), 0) == expected, "{effect} after {allowed} failures");
            } else {
                assert!(handle.is_null(), "{effect}, {allowed} allocations");
            }
            status
        });
    }
}

const FRICTION: [&str; 4] = ["friction", "friction rolling", "unlike friction", "unlike friction rolling"];

/// If a step that continues lacks memory, the handle keeps the previous tractions.
#[test]
fn after_a_lack_of_memory_in_a_step_that_continues_the_handle_works() {
    let _alone = alone();
    let mut ball = Ball::new();
    for effect in FRICTION {
        ball.set_effect(effect);
        for first in [None, Some(0)] {
            fails_everywhere(&ball, first, 1, &format!("{effect} after {first:?}"));
        }
        let step = |ball: &mut Ball, handle: &Handle, continues: i32| {
            (ball.friction.continues, ball.friction.creepage) = (continues, [-0.01, 0.002 * f64::from(continues)]);
            ball.solve(handle, 1)
        };
        let expected = {
            let handle = ball.new_handle();
            assert_eq!(step(&mut ball, &handle, 0).0, CONTACT_NORMAL_OK, "{effect}");
            step(&mut ball, &handle, 1)
        };
        assert_eq!(expected.0, CONTACT_NORMAL_OK, "{effect}");
        until_enough(effect, |allowed| {
            ball.friction.continues = 0;
            let handle = ball.new_handle();
            assert_eq!(step(&mut ball, &handle, 0).0, CONTACT_NORMAL_OK, "{effect}");
            release();
            let (status, _) = limited_memory::with(4 * N, 1 + allowed, || step(&mut ball, &handle, 1));
            if status != CONTACT_NORMAL_OK {
                // The handle still holds the tractions before the failed step, and the next call continues from them.
                assert!(held(&handle).is_some(), "{effect}, {allowed} allocations: the result before is lost");
                let next = step(&mut ball, &handle, 1);
                assert!(next == expected, "{effect}, {allowed} allocations: {}", next.0);
            }
            status
        });
        ball.friction.continues = 0;
    }
}

#[test]
fn a_tangential_solve_without_memory_is_refused() {
    let _alone = alone();
    let mut ball = Ball::new();
    for effect in FRICTION {
        ball.set_effect(effect);
        let (_, pressure) = ball.solve(&ball.new_handle(), 1);
        let expected = solve_tangential(&ball, &pressure);
        assert_eq!(expected.0, CONTACT_NORMAL_OK, "{effect}");
        until_enough(effect, |allowed| {
            // The first of the allowed allocations is the test's own array.
            let (status, q) = limited_memory::with(4 * N, 1 + allowed, || solve_tangential(&ball, &pressure));
            if status == CONTACT_NORMAL_OK {
                assert!(q == expected.1, "{effect} after {allowed} failures");
            } else {
                assert!(q.iter().all(|value| *value == -7.0), "{effect}, {allowed} allocations: outputs were written");
            }
            status
        });
    }
}
