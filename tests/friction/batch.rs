//! Batches of tangential problems: each entry has the result of a single solve, for any number of workers. An entry that fails does not affect the
//! others. A batch reports its progress and may be cancelled.

use std::sync::Mutex;

use contact_normal::error::Error;
use contact_normal::friction::{Report, Vector};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Scene};
use contact_normal::solver::{
    solve, solve_friction_batch, solve_tangential, Ended, Entry, Options, Outcome, Progress, ProgressCallback, RUN,
};

const M: usize = 24;
const D: f64 = 0.08;
const BODIES: Bodies = Bodies { shear_modulus: [82000.0; 2], poisson_ratio: [0.28; 2] };

/// A semi-ellipsoid of pressures over an ellipse whose axes are of the ratio 0.7.
fn pressure() -> Vec<f64> {
    let centre = 0.5 * (M as f64 - 1.0);
    let part = |i: usize| {
        let (x, y) = ((i % M) as f64 - centre, ((i / M) as f64 - centre) / 0.7);
        1.0 - (x * x + y * y) / (0.45 * M as f64).powi(2)
    };
    (0..M * M).map(|i| 1000.0 * part(i).max(0.0).sqrt()).collect()
}

fn scene<'a>(h: &'a [f64], friction: Friction<'a>) -> Scene<'a> {
    let grid = Grid::new(M, M, D, D).unwrap();
    Scene { friction: Some(friction), ..Scene::new(grid, h, BODIES, Load::Force(1000.0)) }
}

/// Entries with creepages or forces: two full runs and a part of a third one (a run is the sequence of entries that one worker solves).
fn table(friction: &Friction<'_>) -> Vec<Entry> {
    let unit = |k: usize| match (friction.motion, friction.prescribed[k]) {
        (_, Prescribed::Force(_)) => 80.0,
        (Motion::Shift, _) => 1e-3,
        _ => 2e-3,
    };
    let spin = if friction.motion == Motion::Shift { 1e-4 } else { 5e-4 };
    let entry = |i: usize| {
        let (x, y) = ((i % 7) as f64 - 3.0, (i / 7) as f64 - 2.0);
        Entry { amount: [0.5 * unit(0) * x, 0.4 * unit(1) * y], spin: spin * (i % 5) as f64 }
    };
    (0..2 * RUN + 5).map(entry).collect()
}

fn frictions() -> Vec<Friction<'static>> {
    let free = [Prescribed::Creepage(0.0); 2];
    let with = |motion, prescribed| Friction { motion, prescribed, ..Friction::new(0.3) };
    vec![
        with(Motion::Shift, free),
        with(Motion::Shift, [Prescribed::Force(0.0), Prescribed::Creepage(0.0)]),
        with(Motion::TransientRolling, free),
        with(Motion::SteadyRolling, free),
        with(Motion::SteadyRolling, [Prescribed::Force(0.0), Prescribed::Force(0.0)]),
    ]
}

fn options(threads: usize) -> Options {
    Options { threads, tolerance: 1e-6, ..Options::default() }
}

type Found = (Ended, Option<Vec<Vector>>);

/// Solves the entries. Returns the outcome of the batch, and the report and the tractions of each entry, in the order of the entries.
fn batch(
    scene: &Scene<'_>,
    pressure: Option<&[f64]>,
    entries: &[Entry],
    options: &Options,
    progress: Option<ProgressCallback<'_>>,
) -> (Outcome, Vec<Found>) {
    let found: Mutex<Vec<Option<Found>>> = Mutex::new(entries.iter().map(|_| None).collect());
    let (stop, _) = solve_friction_batch(scene, pressure, entries, options, progress, |i, ended, solution| {
        let tractions = solution.map(|solution| solution.traction.clone());
        assert!(found.lock().unwrap()[i].replace((ended, tractions)).is_none(), "entry {i} twice");
    })
    .unwrap();
    (stop, found.into_inner().unwrap().into_iter().map(|entry| entry.expect("all entries")).collect())
}

fn report(ended: &Ended) -> Report {
    let (stop, report) = ended.as_ref().expect("an entry that is solved");
    assert_eq!(*stop, Outcome::Converged);
    *report
}

#[test]
fn each_entry_is_what_a_solve_of_its_own_finds() {
    let (p, h) = (pressure(), vec![0.0; M * M]);
    let all: f64 = 0.3 * p.iter().sum::<f64>() * D * D;
    let unlike = Bodies { shear_modulus: [82000.0, 41000.0], poisson_ratio: [0.28, 0.4] };
    let all_bodies = |friction| [BODIES, unlike].map(|bodies| (friction, bodies));
    for (friction, bodies) in frictions().into_iter().flat_map(all_bodies) {
        let scene = Scene { bodies, ..scene(&h, friction) };
        let entries = table(&friction);
        let (stop, found) = batch(&scene, Some(&p), &entries, &options(1), None);
        assert_eq!(stop, Outcome::Converged);
        for (entry, (ended, tractions)) in entries.iter().zip(&found) {
            let mut alone = friction;
            alone.spin = entry.spin;
            for k in 0..2 {
                alone.prescribed[k] = match friction.prescribed[k] {
                    Prescribed::Force(_) => Prescribed::Force(entry.amount[k]),
                    Prescribed::Creepage(_) => Prescribed::Creepage(entry.amount[k]),
                };
            }
            let one = Scene { friction: Some(alone), ..scene.clone() };
            let (stop, solution, single) = solve_tangential(&one, &p, &options(1), None).unwrap();
            assert_eq!(stop, Outcome::Converged);
            let (found, single) = (report(ended), single.friction.unwrap());
            assert!(found.certificate.residual <= 1e-6);
            // A residual of 1e-6 leaves errors of some 1e-7 in the forces and 1e-5 in the tractions of a shift (docs/friction.md).
            for k in 0..2 {
                let off = (found.force[k] - single.force[k]).abs();
                assert!(off <= 1e-5 * all, "{entry:?}: {:?} {:?}", found.force, single.force);
                // Creepages are compared relative to the rigid slip at the rim of the contact, which has a radius of 0.45 M elements.
                let scale = single.creepage[0].hypot(single.creepage[1]) + entry.spin * 0.45 * M as f64 * D;
                assert!((found.creepage[k] - single.creepage[k]).abs() <= 1e-4 * scale, "{entry:?}");
            }
            let off = |(q, other): (&Vector, &Vector)| (q[0] - other[0]).powi(2) + (q[1] - other[1]).powi(2);
            let tractions = tractions.as_ref().expect("tractions");
            let squares: f64 = tractions.iter().zip(&solution.traction).map(off).sum();
            let norm: f64 = p.iter().map(|p| (0.3 * p).powi(2)).sum();
            assert!((squares / norm).sqrt() <= 1e-3, "{entry:?}: {:e}", (squares / norm).sqrt());
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (p, h) = (pressure(), vec![0.0; M * M]);
    for friction in frictions() {
        let entries = table(&friction);
        let of = |threads| {
            let (_, found) = batch(&scene(&h, friction), Some(&p), &entries, &options(threads), None);
            let bits = |(ended, tractions): &Found| {
                let Report { force, moment, creepage, products, .. } = report(ended);
                let tractions = tractions.as_ref().expect("tractions");
                let q: Vec<u64> = tractions.iter().flatten().map(|q| q.to_bits()).collect();
                ([force[0], force[1], moment, creepage[0], creepage[1], products].map(f64::to_bits), q)
            };
            found.iter().map(bits).collect::<Vec<_>>()
        };
        let one = of(1);
        for threads in [2, 3] {
            assert!(one == of(threads), "{threads} threads, {friction:?}");
        }
    }
}

#[test]
fn an_entry_starts_from_its_neighbour() {
    let (p, h) = (pressure(), vec![0.0; M * M]);
    let friction = frictions()[0];
    let entries: Vec<Entry> = (0..RUN).map(|i| Entry { amount: [1e-3 + 1e-7 * i as f64, 2e-4], spin: 0.0 }).collect();
    let (_, found) = batch(&scene(&h, friction), Some(&p), &entries, &options(1), None);
    let products: Vec<f64> = found.iter().map(|(ended, _)| report(ended).products).collect();
    let warm = products[1..].iter().sum::<f64>() / (RUN - 1) as f64;
    assert!(warm < 0.8 * products[0], "{products:?}");
}

#[test]
fn an_entry_far_from_its_neighbour_starts_from_nothing() {
    let (p, h) = (pressure(), vec![0.0; M * M]);
    for friction in frictions() {
        let near = |x: f64| if matches!(friction.prescribed[0], Prescribed::Force(_)) { 100.0 * x } else { 1e-3 * x };
        let far = Entry { amount: [near(-1.5), 0.0], spin: 1e-4 };
        let of = |entries: &[Entry]| {
            let (_, found) = batch(&scene(&h, friction), Some(&p), entries, &options(1), None);
            let Report { force, products, .. } = report(&found.last().expect("an entry").0);
            [force[0], force[1], products].map(f64::to_bits)
        };
        assert_eq!(of(&[Entry { amount: [near(0.5), 0.0], spin: 1e-4 }, far]), of(&[far]), "{friction:?}");
    }
}

#[test]
fn an_entry_that_is_refused_harms_no_other() {
    let (p, h) = (pressure(), vec![0.0; M * M]);
    let friction = frictions()[1];
    let mut entries = table(&friction);
    // One force exceeds the friction bound, and one spin is NaN.
    entries[3].amount[0] = 1e6;
    entries[RUN].spin = f64::NAN;
    let (_, found) = batch(&scene(&h, friction), Some(&p), &entries, &options(2), None);
    for (i, (ended, tractions)) in found.iter().enumerate() {
        match i {
            3 => assert!(matches!(ended, Err(Error::Infeasible(_))) && tractions.is_none()),
            RUN => assert!(matches!(ended, Err(Error::NotFinite(_))) && tractions.is_none()),
            _ => assert!(report(ended).certificate.residual <= 1e-6),
        }
    }
}

#[test]
fn pressures_are_those_of_the_normal_problem() {
    let h: Vec<f64> = (0..M * M)
        .map(|i| {
            let (x, y) = ((i % M) as f64 - 11.5, (i / M) as f64 - 11.5);
            (x * x + y * y) * D * D / 60.0
        })
        .collect();
    let friction = frictions()[0];
    let entries = [Entry { amount: [1e-3, 0.0], spin: 0.0 }];
    let scene = Scene { load: Load::Force(600.0), ..scene(&h, friction) };
    let (_, found) = batch(&scene, None, &entries, &options(1), None);
    let alone = Friction { prescribed: [Prescribed::Creepage(1e-3), Prescribed::Creepage(0.0)], ..friction };
    let (_, _, single) = solve(&Scene { friction: Some(alone), ..scene }, &options(1)).unwrap();
    assert_eq!(report(&found[0].0).force.map(f64::to_bits), single.friction.unwrap().force.map(f64::to_bits));
}

#[test]
fn progress_is_told_on_the_calling_thread_and_may_cancel() {
    let (p, h) = (pressure(), vec![0.0; M * M]);
    let friction = frictions()[0];
    let (scene, entries) = (scene(&h, friction), table(&friction));
    let caller = std::thread::current().id();
    for (threads, cancel_at) in [(1, u64::MAX), (2, u64::MAX), (1, 1), (1, RUN as u64 + 3), (2, 5)] {
        let (mut told, mut last, mut work) = (0, 0, 0.0);
        let mut watch = |progress: &Progress| {
            assert_eq!(std::thread::current().id(), caller);
            assert!(progress.cycles >= last && progress.work_units >= work);
            assert!(progress.residual <= 1e-6);
            (told, last, work) = (told + 1, progress.cycles, progress.work_units);
            progress.cycles >= cancel_at
        };
        let (stop, found) = batch(&scene, Some(&p), &entries, &options(threads), Some(&mut watch));
        let cancelled = found.iter().filter(|(ended, _)| matches!(ended, Ok((Outcome::Cancelled, _)))).count();
        let done = entries.len() - cancelled;
        found.iter().for_each(|(ended, tractions)| {
            let (stop, _) = ended.as_ref().unwrap();
            assert_eq!(tractions.is_some(), *stop == Outcome::Converged);
        });
        if cancel_at == u64::MAX {
            assert_eq!((stop, cancelled), (Outcome::Converged, 0));
            assert!(told >= 1, "{told}");
        } else {
            // Another worker may have finished one more entry.
            assert_eq!(stop, Outcome::Cancelled);
            assert!(done as u64 >= cancel_at && done < entries.len(), "{done} {cancel_at}");
            assert!(threads > 1 || done as u64 == cancel_at, "{done} {cancel_at}");
        }
    }
}

/// Negative pressures count as no contact. For unlike bodies they cause no tangential displacements either.
#[test]
fn pressures_that_pull_are_none() {
    let h = vec![0.0; M * M];
    let positive = pressure();
    let pulls: Vec<f64> =
        positive.iter().enumerate().map(|(i, p)| if *p > 0.0 { *p } else { -((i % 7) as f64) * 100.0 }).collect();
    let unlike = Bodies { shear_modulus: [82000.0, 20000.0], poisson_ratio: [0.1, 0.4] };
    for (friction, bodies) in frictions().into_iter().flat_map(|friction| [(friction, BODIES), (friction, unlike)]) {
        let entries = &table(&friction)[..3];
        let scene = Scene { bodies, ..scene(&h, friction) };
        let alone = |p: &[f64]| {
            let (_, solution, report) = solve_tangential(&scene, p, &options(1), None).unwrap();
            let force = report.friction.unwrap().force.map(f64::to_bits);
            (force, solution.traction, solution.slip, report.measures)
        };
        assert!(alone(&pulls) == alone(&positive), "{friction:?}");
        let all = |p: &[f64]| -> Vec<_> {
            let (_, found) = batch(&scene, Some(p), entries, &options(1), None);
            found.into_iter().map(|(ended, tractions)| (report(&ended).force.map(f64::to_bits), tractions)).collect()
        };
        assert!(all(&pulls) == all(&positive), "{friction:?}");
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut wrong = pulls.clone();
            wrong[5] = bad;
            let refusal = solve_tangential(&scene, &wrong, &options(1), None).map(|_| ());
            assert!(matches!(refusal, Err(Error::NotFinite(_))), "{bad}");
        }
    }
}
