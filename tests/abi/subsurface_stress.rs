//! `contact_normal_subsurface_stress` and `contact_normal_stress_at_points`: outputs, refusals, bodies, and cancellation.

use std::ffi::c_void;
use std::ptr::{null, null_mut};

use crate::call::{initialised, last_error};
use contact_normal::ffi::*;

const MX: usize = 4;
const N: usize = 12;
const DEPTHS: [f64; 3] = [0.0, 0.5, 2.0];
/// No stress has this value.
const SENTINEL: f64 = -12345.678;

/// A call with all outputs wanted.
struct Call {
    scene: contact_normal_scene,
    options: contact_normal_options,
    body: i32,
    pressure: Vec<f64>,
    traction: Vec<f64>,
    depths: Vec<f64>,
    outputs: contact_normal_stress_outputs,
    stress: [Vec<f64>; 6],
    mises: Vec<f64>,
    shear: Vec<f64>,
    principal: [Vec<f64>; 3],
    directions: [Vec<f64>; 3],
    largest: [contact_normal_stress_maximum; 2],
}

impl Call {
    fn new() -> Box<Call> {
        let field = || vec![SENTINEL; DEPTHS.len() * N];
        let mut scene = initialised(contact_normal_scene_init);
        (scene.mx, scene.my, scene.dx, scene.dy) = (MX as i32, 3, 1.0, 0.5);
        scene.poisson_ratio = [0.3, 0.2];
        let mut call = Box::new(Call {
            scene,
            options: initialised(contact_normal_options_init),
            body: 1,
            pressure: (0..N).map(|i| 1.0 + (i % 5) as f64).collect(),
            traction: (0..N).map(|i| 0.1 * (i % 3) as f64).collect(),
            depths: DEPTHS.to_vec(),
            outputs: initialised(contact_normal_stress_outputs_init),
            stress: std::array::from_fn(|_| field()),
            mises: field(),
            shear: field(),
            principal: std::array::from_fn(|_| field()),
            directions: std::array::from_fn(|_| vec![SENTINEL; 3 * DEPTHS.len() * N]),
            largest: [contact_normal_stress_maximum::default(); 2],
        });
        let outputs = &mut call.outputs;
        outputs.stress = call.stress.each_mut().map(|v| v.as_mut_ptr());
        (outputs.von_mises, outputs.maximum_shear) = (call.mises.as_mut_ptr(), call.shear.as_mut_ptr());
        outputs.principal = call.principal.each_mut().map(|v| v.as_mut_ptr());
        outputs.directions = call.directions.each_mut().map(|v| v.as_mut_ptr());
        let at = call.largest.as_mut_ptr();
        // SAFETY: room for two.
        (outputs.largest_von_mises, outputs.largest_shear) = (at, unsafe { at.add(1) });
        call
    }

    fn run(&mut self) -> (i32, String) {
        let load = |values: &Vec<f64>| if values.is_empty() { null() } else { values.as_ptr() };
        // SAFETY: arrays as long as the call says.
        let status = unsafe {
            contact_normal_subsurface_stress(
                &self.scene,
                self.body,
                load(&self.pressure),
                load(&self.traction),
                null(),
                self.depths.as_ptr(),
                self.depths.len() as i32,
                &self.options,
                &mut self.outputs,
            )
        };
        (status, message(status))
    }

    /// The number of output values that the call wrote.
    fn written(&self) -> usize {
        let fields =
            self.stress.iter().chain(&self.principal).chain(&self.directions).chain([&self.mises, &self.shear]);
        fields.flatten().filter(|value| **value != SENTINEL).count()
    }
}

fn message(status: i32) -> String {
    match status {
        CONTACT_NORMAL_OK => String::new(),
        _ => last_error(),
    }
}

#[test]
fn all_outputs_are_written_and_agree() {
    let mut call = Call::new();
    assert_eq!(call.run(), (CONTACT_NORMAL_OK, String::new()));
    assert_eq!(call.written(), (6 + 3 + 9 + 2) * N * DEPTHS.len());
    for i in 0..N * DEPTHS.len() {
        let [xx, yy, zz, ..] = std::array::from_fn::<f64, 6, _>(|c| call.stress[c][i]);
        let [one, two, three] = std::array::from_fn::<f64, 3, _>(|k| call.principal[k][i]);
        assert!((xx + yy + zz - one - two - three).abs() <= 1e-13);
        assert_eq!(call.shear[i], 0.5 * (one - three));
        // The first principal direction n belongs to the first principal stress: n . sigma n.
        let n = &call.directions[0][3 * i..3 * i + 3];
        let s = |c: usize| call.stress[c][i];
        let along = n[0] * n[0] * s(0)
            + n[1] * n[1] * s(1)
            + n[2] * n[2] * s(2)
            + 2.0 * (n[0] * n[1] * s(3) + n[0] * n[2] * s(4) + n[1] * n[2] * s(5));
        assert!((along - one).abs() <= 1e-13, "{along} {one}");
        if i < N {
            assert!((zz + call.pressure[i]).abs() <= 1e-13 && (s(4) + call.traction[i]).abs() <= 1e-13);
        }
    }
    for (found, field) in call.largest.iter().zip([&call.mises, &call.shear]) {
        let largest = field.iter().copied().fold(0.0, f64::max);
        assert_eq!(found.value, largest);
        assert_eq!(field[(found.depth as usize) * N + (found.iy as usize) * MX + found.ix as usize], largest);
        let place = (f64::from(found.ix) - 1.5, 0.5 * (f64::from(found.iy) - 1.0), DEPTHS[found.depth as usize]);
        assert_eq!((found.x, found.y, found.z), place);
    }
}

#[test]
fn what_is_null_is_not_written_and_bodies_have_their_own_ratio() {
    let mut only = Call::new();
    only.outputs = initialised(contact_normal_stress_outputs_init);
    only.outputs.stress[1] = only.stress[1].as_mut_ptr();
    assert_eq!(only.run().0, CONTACT_NORMAL_OK);
    assert_eq!(only.written(), N * DEPTHS.len());
    let (mut one, mut two, mut swapped) = (Call::new(), Call::new(), Call::new());
    two.body = 2;
    (swapped.body, swapped.scene.poisson_ratio) = (2, [0.2, 0.3]);
    assert_eq!([one.run().0, two.run().0, swapped.run().0], [CONTACT_NORMAL_OK; 3]);
    assert_eq!(one.stress, swapped.stress);
    assert_eq!(one.stress[1], only.stress[1]);
    assert_ne!(one.stress[1], two.stress[1]);
    // A call without depths is allowed.
    one.depths.clear();
    assert_eq!(one.run().0, CONTACT_NORMAL_OK);
}

type Spoil = fn(&mut Call);

#[test]
fn refusals_name_the_argument_and_write_nothing() {
    let cases: [(Spoil, i32, &str); 14] = [
        (|c| c.body = 0, CONTACT_NORMAL_INVALID_ARGUMENT, "body is 0"),
        (|c| c.body = 3, CONTACT_NORMAL_INVALID_ARGUMENT, "body is 3"),
        (|c| c.depths[1] = -1.0, CONTACT_NORMAL_INVALID_ARGUMENT, "depths[1] is -1"),
        (|c| c.depths[2] = f64::INFINITY, CONTACT_NORMAL_NOT_FINITE, "depths[2] is inf"),
        (|c| c.pressure[5] = f64::NAN, CONTACT_NORMAL_NOT_FINITE, "pressure of element (1, 1) is NaN"),
        (|c| c.traction[0] = f64::INFINITY, CONTACT_NORMAL_NOT_FINITE, "traction_x of element (0, 0) is inf"),
        (|c| c.scene.poisson_ratio[0] = 0.6, CONTACT_NORMAL_INVALID_ARGUMENT, "poisson_ratio"),
        (
            |c| (c.pressure, c.traction) = (vec![], vec![]),
            CONTACT_NORMAL_INVALID_ARGUMENT,
            "neither a pressure nor a traction",
        ),
        (|c| c.scene.mx = 0, CONTACT_NORMAL_INVALID_ARGUMENT, "mx is 0"),
        (|c| c.options.threads = -1, CONTACT_NORMAL_INVALID_ARGUMENT, "threads is -1"),
        (|c| c.outputs.struct_size = 8, CONTACT_NORMAL_STRUCT_SIZE, "outputs->struct_size is 8"),
        (|c| c.outputs.von_mises = c.outputs.stress[0], CONTACT_NORMAL_INVALID_ARGUMENT, "overlap"),
        (|c| c.outputs.maximum_shear = c.pressure.as_mut_ptr(), CONTACT_NORMAL_INVALID_ARGUMENT, "overlap"),
        (|c| c.outputs.directions[2] = c.depths.as_mut_ptr(), CONTACT_NORMAL_INVALID_ARGUMENT, "overlap"),
    ];
    for (spoil, status, words) in cases {
        let mut call = Call::new();
        spoil(&mut call);
        let (got, message) = call.run();
        assert_eq!(got, status, "{words}: {message}");
        assert!(message.contains(words), "\"{message}\" does not say {words}");
        assert_eq!(call.written(), 0, "{words}");
    }
}

#[test]
fn bodies_that_are_no_half_spaces_are_refused_by_name() {
    let table = vec![1.0; 4 * N * N];
    let mut influence = initialised(contact_normal_influence_init);
    (influence.cx, influence.cy, influence.coefficients) = (MX as i32, 3, table.as_ptr());
    let mut row_tables = initialised(contact_normal_row_tables_init);
    (row_tables.cx, row_tables.rows, row_tables.coefficients) = (MX as i32, 3, table.as_ptr());
    let periods = [(1, 0), (0, 1), (1, 1)].map(|(x, y)| contact_normal_period {
        x,
        y,
        ..initialised(contact_normal_period_init)
    });
    let layer = |thickness, shear_modulus| {
        let of = initialised(contact_normal_coating_init);
        contact_normal_coating { thickness, shear_modulus, poisson_ratio: 0.3, ..of }
    };
    let (coating, none, same) = (layer(0.1, 2.0), layer(0.0, 2.0), layer(0.1, 1.0));
    let points = [0.25, 0.25, 1.0];
    let ask = |change: &dyn Fn(&mut contact_normal_scene)| {
        let mut call = Call::new();
        call.scene.shear_modulus = [1.0; 2];
        change(&mut call.scene);
        let found = call.run();
        assert!(found.0 == CONTACT_NORMAL_OK || call.written() == 0, "{}", found.1);
        let (p, mut stress) = (call.pressure.as_ptr(), [SENTINEL; 6]);
        // SAFETY: arrays as long as the call says.
        let status = unsafe {
            let (points, to) = (points.as_ptr(), stress.as_mut_ptr());
            contact_normal_stress_at_points(&call.scene, 1, p, null(), null(), points, 1, null(), to)
        };
        let at_points = (status, message(status));
        assert!(status == CONTACT_NORMAL_OK || stress == [SENTINEL; 6]);
        (found, at_points)
    };
    type Change<'a> = &'a dyn Fn(&mut contact_normal_scene);
    let refused: [(Change<'_>, &str); 5] = [
        (&|scene| scene.influence = &influence, "influence"),
        (&|scene| scene.row_tables = &row_tables, "row_tables"),
        (&|scene| scene.period = &periods[0], "period"),
        (&|scene| scene.period = &periods[1], "period"),
        (&|scene| scene.coating[0] = &coating, "coating"),
    ];
    for (change, name) in refused {
        let (on_grid, at_points) = ask(change);
        for (status, message) in [on_grid, at_points] {
            assert!(status == CONTACT_NORMAL_UNSUPPORTED && message.contains(name), "{name}: {status} {message}");
        }
    }
    // Two periods are allowed for stresses on the grid. Also allowed are a coating of thickness 0 or of the substrate's material, and a coating of
    // the other body.
    let (on_grid, (status, message)) = ask(&|scene| scene.period = &periods[2]);
    assert_eq!(on_grid.0, CONTACT_NORMAL_OK);
    assert!(status == CONTACT_NORMAL_UNSUPPORTED && message.contains("period"), "{message}");
    let solved: [Change<'_>; 3] =
        [&|scene| scene.coating[0] = &none, &|scene| scene.coating[0] = &same, &|scene| scene.coating[1] = &coating];
    for change in solved {
        let ((on_grid, message), (at_points, _)) = ask(change);
        assert_eq!((on_grid, at_points), (CONTACT_NORMAL_OK, CONTACT_NORMAL_OK), "{message}");
    }
}

#[test]
fn null_pointers_are_refused() {
    let mut call = Call::new();
    let (scene, outputs, p) = (&raw const call.scene, &raw mut call.outputs, call.pressure.as_ptr());
    let ask = |scene, depths: *const f64, outputs| {
        // SAFETY: NULL, or as the call says.
        let status =
            unsafe { contact_normal_subsurface_stress(scene, 1, p, null(), null(), depths, 1, null(), outputs) };
        (status, message(status))
    };
    for (got, name) in [
        (ask(null(), p, outputs), "scene"),
        (ask(scene, null(), outputs), "depths"),
        (ask(scene, p, null_mut()), "outputs"),
    ] {
        assert!(got.0 == CONTACT_NORMAL_NULL_POINTER && got.1.contains(name), "{got:?}");
    }
}

/// A callback that counts its calls, and cancels at the second depth.
unsafe extern "C" fn cancel(progress: *const contact_normal_progress, user: *mut c_void) -> i32 {
    // SAFETY: as the library calls it, with the counter below.
    unsafe {
        *user.cast::<i64>() += 1;
        i32::from((*progress).cycles == 2)
    }
}

#[test]
fn a_cancelled_call_has_written_the_depths_before() {
    let mut call = Call::new();
    let mut told = 0i64;
    call.options.progress = Some(cancel);
    call.options.user = (&raw mut told).cast();
    let (status, message) = call.run();
    assert!(status == CONTACT_NORMAL_CANCELLED && message.contains("cancelled"), "{status} {message}");
    assert_eq!((told, call.written()), (2, 20 * N * 2));
}

#[test]
fn points_at_the_centres_have_the_stresses_of_the_grid() {
    let mut call = Call::new();
    assert_eq!(call.run().0, CONTACT_NORMAL_OK);
    let centre = |i: usize| [(i % MX) as f64 - 1.5, 0.5 * ((i / MX) as f64 - 1.0)];
    let points: Vec<[f64; 3]> =
        DEPTHS.iter().flat_map(|z| (0..N).map(move |i| [centre(i)[0], centre(i)[1], *z])).collect();
    let mut stress = vec![[SENTINEL; 6]; points.len()];
    let at = |points: *const [f64; 3], stress: *mut [f64; 6]| {
        // SAFETY: NULL or arrays as long as the call says.
        let status = unsafe {
            contact_normal_stress_at_points(
                &call.scene,
                1,
                call.pressure.as_ptr(),
                call.traction.as_ptr(),
                null(),
                points.cast(),
                3 * N as i32,
                null(),
                stress.cast(),
            )
        };
        (status, message(status))
    };
    assert_eq!(at(points.as_ptr(), stress.as_mut_ptr()), (CONTACT_NORMAL_OK, String::new()));
    for (i, stress) in stress.iter().enumerate() {
        for (stress, of_grid) in stress.iter().zip(&call.stress) {
            assert!((stress - of_grid[i]).abs() <= 1e-13, "point {i}");
        }
    }
    let mut on_edge = points.clone();
    on_edge[4] = [-1.0, -0.5, 0.0];
    let mut untouched = vec![[SENTINEL; 6]; points.len()];
    let refused = at(on_edge.as_ptr(), untouched.as_mut_ptr());
    assert!(
        refused.0 == CONTACT_NORMAL_INVALID_ARGUMENT && refused.1.contains("point 4 is (-1, -0.5, 0)"),
        "{refused:?}"
    );
    assert!(untouched.iter().flatten().all(|s| *s == SENTINEL));
    assert_eq!(at(null(), stress.as_mut_ptr()).0, CONTACT_NORMAL_NULL_POINTER);
    assert_eq!(at(points.as_ptr(), null_mut()).0, CONTACT_NORMAL_NULL_POINTER);
}

/// The stresses below a patch do not depend on the loads of an independent patch, on planes and at points.
#[test]
fn patches_of_the_scene_scale_the_loads() {
    let patch: Vec<i32> = (0..N).map(|i| i32::from(i % MX >= 2)).collect();
    let mut patches = initialised(contact_normal_patches_init);
    let factors = [1.0, 0.0, 0.0, 1.0];
    (patches.count, patches.patch, patches.factors) = (2, patch.as_ptr(), factors.as_ptr());
    let (mut with, mut alone) = (Call::new(), Call::new());
    with.scene.patches = &patches;
    for i in (0..N).filter(|&i| patch[i] == 1) {
        (alone.pressure[i], alone.traction[i]) = (0.0, 0.0);
    }
    assert_eq!([with.run().0, alone.run().0], [CONTACT_NORMAL_OK; 2]);
    for (k, i) in (0..DEPTHS.len()).flat_map(|k| (0..N).map(move |i| (k, i))).filter(|(_, i)| patch[*i] == 0) {
        let (a, b) = (with.mises[k * N + i], alone.mises[k * N + i]);
        assert!((a - b).abs() <= 1e-13, "{k} {i}: {a} {b}");
    }
    let mut stress = [[0.0; 6]; 2];
    for (call, stress) in [&with, &alone].into_iter().zip(&mut stress) {
        // SAFETY: arrays as long as the call says.
        let status = unsafe {
            contact_normal_stress_at_points(
                &call.scene,
                1,
                call.pressure.as_ptr(),
                call.traction.as_ptr(),
                null(),
                [-0.7, 0.05, 0.6].as_ptr(),
                1,
                null(),
                stress.as_mut_ptr(),
            )
        };
        assert_eq!(status, CONTACT_NORMAL_OK);
    }
    assert!(stress[0].iter().zip(stress[1]).all(|(a, b)| (a - b).abs() <= 1e-13), "{stress:?}");
    patches.count = 65;
    with.scene.patches = &patches;
    let (status, message) = with.run();
    assert!(status == CONTACT_NORMAL_INVALID_ARGUMENT && message.contains("patches->count is 65"), "{message}");
}

/// The time limit ends the computation of stresses at points as it ends that at depths. 40000 points are more than one block.
#[test]
fn points_keep_to_a_limit_of_time() {
    let mut call = Call::new();
    let n = 40_000;
    let points: Vec<[f64; 3]> = (0..n).map(|i| [0.25, 0.25, 1.0 + 1e-4 * f64::from(i)]).collect();
    for max_seconds in [0.0, 1e-9] {
        call.options.max_seconds = max_seconds;
        let mut stress = vec![[SENTINEL; 6]; points.len()];
        // SAFETY: arrays as long as the call says.
        let status = unsafe {
            let (at, options) = (points.as_ptr().cast(), &raw const call.options);
            let (p, to) = (call.pressure.as_ptr(), stress.as_mut_ptr().cast());
            contact_normal_stress_at_points(&call.scene, 1, p, null(), null(), at, n, options, to)
        };
        let (first, last) = (stress[0][2], stress[points.len() - 1][2]);
        assert!(first < 0.0, "{first}");
        if max_seconds > 0.0 {
            let message = message(status);
            assert!(status == CONTACT_NORMAL_ITERATION_LIMIT && message.contains("max_seconds"), "{status} {message}");
            assert_eq!(last, 0.0);
        } else {
            assert!(status == CONTACT_NORMAL_OK && last < 0.0, "{status} {last}");
        }
    }
}
