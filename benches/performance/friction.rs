//! Times of a shift with friction: compared with the normal problem alone, and with one and several threads.

use std::time::Instant;

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Prescribed, Scene};
use contact_normal::solver::{solve, solve_tangential, Options, Solver};

use super::case::{ellipse, rough, Case};
use super::measure::{cold, in_turns, median, shown};

const MU: f64 = 0.3;
const TOLERANCE: f64 = 1e-4;

/// Measures whole cold calls of a shift to half of mu N, with `threads` threads and with one, in turns.
pub fn shifts(threads: usize, sizes: &[usize]) {
    println!(
        "\n## A shift to half of mu N, tolerance {TOLERANCE:.0e}, whole cold calls, 1 and {threads} threads in turns"
    );
    println!(
        "| problem | products | normal alone | with friction | {threads} threads | times faster: friction alone |"
    );
    println!("|---|---:|---:|---:|---:|---:|");
    for &m in sizes {
        row(&ellipse(m), threads);
        row(&like_bodies(m), threads);
    }
}

/// Repeats cold solves of a shift with `threads` threads for `time` seconds, for a profiler.
pub fn shift_again(case: &Case, threads: usize, time: f64) {
    let (shifted, began) = (shifted(case), Instant::now());
    while began.elapsed().as_secs_f64() < time {
        cold(&shifted, &options(threads));
    }
}

fn options(threads: usize) -> Options {
    Options { tolerance: TOLERANCE, threads, ..Options::default() }
}

/// The scene of a case with the shift at which the tangential force is half of mu N.
fn shifted(case: &Case) -> Scene<'_> {
    let plain = case.scene();
    let (_, _, normal) = solve(&plain, &options(1)).expect("a solution");
    let force = 0.5 * MU * normal.measures.force;
    let with = |friction| Scene { friction: Some(friction), ..plain.clone() };
    let pushed = Friction { prescribed: [Prescribed::Force(force), Prescribed::Force(0.0)], ..Friction::new(MU) };
    let (_, _, report) = solve(&with(pushed), &options(1)).expect("a solution");
    let creepage = report.friction.expect("friction").creepage;
    with(Friction { prescribed: creepage.map(Prescribed::Creepage), ..Friction::new(MU) })
}

/// The rough surface on bodies with equal elastic constants and the same E*. With different constants the normal and the tangential problem
/// would be solved in turns.
pub fn like_bodies(m: usize) -> Case {
    Case { bodies: Bodies::same(0.7, 0.3), ..rough(m) }
}

fn row(case: &Case, threads: usize) {
    let (plain, shifted) = (case.scene(), shifted(case));
    let products = solve(&shifted, &options(1)).expect("a solution").2.friction.expect("friction").products;
    let call = |scene: &Scene<'_>, threads: usize| {
        cold(scene, &options(threads));
    };
    let times =
        in_turns(&mut [&mut || call(&plain, 1), &mut || call(&shifted, 1), &mut || call(&plain, threads), &mut || {
            call(&shifted, threads)
        }]);
    let [alone, one, alone_by_more, more] = [0, 1, 2, 3].map(|k| median(&times[k]));
    let ratio = (one - alone) / (more - alone_by_more);
    let columns = [alone, one, more].map(shown).join(" | ");
    println!("| {} | {products:.1} | {columns} | {ratio:.2} |", case.name);
}

/// Measures the tangential problem of given pressures on small grids, a shift to a residual of 1e-6: single calls and calls of a solver handle,
/// in turns.
pub fn given_pressures() {
    println!("\n## The tangential problem of given pressures, a shift, 1e-6, one thread: single calls and those of a handle, in turns");
    println!("| elements | products | single | handle | times faster |");
    println!("|---|---:|---:|---:|---:|");
    for (mx, my) in [(1, 1), (10, 10), (19, 19), (33, 33), (30, 1), (92, 1)] {
        let (dx, dy) = (2.2 / mx as f64, if my > 1 { 2.2 / my as f64 } else { 100.0 });
        let grid = Grid::new(mx, my, dx, dy).expect("a grid");
        let place = |k: usize, m: usize| if m > 1 { (k as f64 + 0.5) / m as f64 * 2.2 - 1.1 } else { 0.0 };
        let squared = |i: usize| place(i % mx, mx).powi(2) + place(i / mx, my).powi(2);
        let pressure: Vec<f64> = (0..grid.len()).map(|i| 1000.0 * (1.0 - squared(i)).max(0.0).sqrt()).collect();
        let prescribed = [Prescribed::Creepage(-4e-3), Prescribed::Creepage(0.0)];
        let friction = Some(Friction { prescribed, spin: 1e-4, ..Friction::new(MU) });
        let scene = Scene { friction, ..Scene::new(grid, &[], Bodies::same(82000.0, 0.28), Load::Approach(0.0)) };
        let options = Options { threads: 1, ..Options::default() };
        let mut handle = Solver::new(&scene, &options).expect("a handle");
        let (_, _, report) = solve_tangential(&scene, &pressure, &options, None).expect("a solution");
        let mut single = || _ = solve_tangential(&scene, &pressure, &options, None).expect("a solution");
        let mut kept = || _ = handle.solve_tangential(&scene, &pressure, &options, None).expect("a solution");
        let times = in_turns(&mut [&mut single, &mut kept]);
        let [single, kept] = [0, 1].map(|k| median(&times[k]));
        let products = report.friction.expect("friction").products;
        let (of, columns) = (format!("{mx} x {my}"), [single, kept].map(shown).join(" | "));
        println!("| {of} | {products:.1} | {columns} | {:.1} |", single / kept);
    }
}
