//! Whole solves have the same bits for any number of threads: pressures, displacements, contact area, approach, and iterations.

#[allow(dead_code)] // some of the benchmark's cases are used
use crate::performance as case;

use case::{ellipse, rough, wheel_rail, Case};
use contact_normal::methods::multigrid::{CycleShape, SmootherKind};
use contact_normal::scene::{Load, Scene};
use contact_normal::solver::{solve, Criterion, InitialGuess, Method, Options, Outcome, Precision, Solver};

/// The result of a solve as bits: p, u and the approach; the contact area; the number of cycles.
type Found = (Vec<u64>, Vec<bool>, u64);

fn found(solver: &Solver, cycles: u64) -> Found {
    let state = solver.state();
    let values = state.p.iter().chain(&state.u).chain([&state.approach]);
    (values.map(|value| value.to_bits()).collect(), state.contact.clone(), cycles)
}

/// The results of a solve without a guess, and of a next one from its result with 1 % more load.
fn cold_and_next(scene: &Scene<'_>, options: &Options) -> [Found; 2] {
    let (mut solver, stop, report) = solve(scene, options).expect("a solve");
    assert_eq!(stop, Outcome::Converged, "{options:?}");
    let cold = found(&solver, report.count.cycles);
    let load = match scene.load {
        Load::Approach(approach) => Load::Approach(1.01 * approach),
        Load::Force(force) => Load::Force(1.01 * force),
    };
    let next = Options { initial_guess: InitialGuess::Previous, ..*options };
    let (_, report) = solver.solve(&Scene { load, ..scene.clone() }, &next, None, None).expect("a step");
    [cold, found(&solver, report.count.cycles)]
}

/// Asserts equal bits for a given approach and a given force, for all methods with 1 and 3 threads, and for AUTO also with 2.
fn same_for_any_number_of_threads(case: &Case) {
    let (solver, _, report) = solve(&case.scene(), &Options::default()).expect("a solve");
    let loads = [Load::Approach(solver.state().approach), Load::Force(report.measures.force)];
    let all = Options { max_cycles: 5000, ..Options::default() };
    let fft = CycleShape { smoother: SmootherKind::Fft, ..CycleShape::default() };
    let ways = [
        all,
        Options { precision: Precision::Double, criterion: Criterion::Update, ..all },
        Options { method: Method::ProjectedCg, ..all },
        Options { method: Method::Norm, ..all },
        Options { method: Method::Multigrid, ..all },
        Options { method: Method::Multigrid, cycle: fft, ..all },
        Options { method: Method::FullMultigrid, ..all },
        Options { method: Method::FullMultigrid, cycle: fft, ..all },
    ];
    for load in loads {
        for (k, way) in ways.into_iter().enumerate() {
            let one = cold_and_next(&case.scene_with(load), &way);
            for threads in if k == 0 { 2..=3 } else { 3..=3 } {
                let several = cold_and_next(&case.scene_with(load), &Options { threads, ..way });
                assert!(several == one, "{}, {load:?}, {threads} threads: {way:?}", case.name);
            }
        }
    }
}

/// With this number of elements passes over the elements are shared between threads, also on the window around C.
#[test]
fn the_ellipse() {
    same_for_any_number_of_threads(&ellipse(280));
}

/// With this number of elements passes are shared on the whole grid, and there is no window.
#[test]
fn the_rough_surface() {
    same_for_any_number_of_threads(&rough(160));
}

/// With this number of elements passes are shared on the whole grid only.
#[test]
fn wheel_and_rail() {
    same_for_any_number_of_threads(&wheel_rail("y0_10kN", 2));
}
