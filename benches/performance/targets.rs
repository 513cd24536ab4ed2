//! The tables of targets: what a solve costs in products A p, compared with the limit of this cost.

use std::process::Command;

use contact_normal::grid::Grid;
use contact_normal::influence::Table;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{InitialGuess, Method, Options, Outcome, Problem, Report, Solver};

use crate::case::{by_name, ellipse, rough, wheel_rail, Case};
use crate::measure::{by_processor, cold, in_turns, median, seconds, shown, size, Product};
use crate::{old, summary};

/// The time in seconds that a solve on a small grid may take in addition to its products.
const SMALL_GRID_EXTRA: f64 = 50e-6;

fn mark(measured: f64, at_most: f64) -> &'static str {
    if measured <= at_most {
        "met"
    } else {
        "MISSED"
    }
}

fn options(threads: usize) -> Options {
    Options { threads, ..Options::default() }
}

/// Prints the times of cold calls, and their ratio to the time of a product.
pub fn cold_calls(threads: usize, sizes: &[usize]) {
    println!("\n### Cold calls, {threads} thread(s)\n");
    println!("| case | elements | in contact | call | product | products | of 9fd3772 | of them counted | at most | |");
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let ellipses = sizes.iter().map(|&m| (ellipse(m), 12.0));
    let roughs = sizes.iter().map(|&m| (rough(m), 24.0));
    let as_given = ["y0_10kN", "y4_82kN", "y10_10kN"].map(|name| (wheel_rail(name, 1), 20.0));
    let refined = [2, 4].map(|by| (wheel_rail("y4_82kN", by), 20.0));
    for (case, at_most) in ellipses.chain(roughs).chain(as_given).chain(refined) {
        cold_row(&case, threads, |product| at_most * product, at_most);
    }
    for m in [16, 32, 64] {
        cold_row(&ellipse(m), threads, |product| 25.0 * product + SMALL_GRID_EXTRA, 25.0);
    }
    println!("\n16, 32, 64: the limit is 25 products and 50 microseconds.");
}

/// Prints the row of one case in the table of cold calls. `limit` computes the largest allowed time of the call from the time of a product.
pub fn cold_row(case: &Case, threads: usize, limit: impl Fn(f64) -> f64, at_most: f64) {
    let (scene, options) = (case.scene(), options(threads));
    let mut product = Product::new(&scene, threads);
    let (stop, report) = cold(&scene, &options);
    assert_eq!(stop, Outcome::Converged, "{}", case.name);
    let call = &mut || _ = cold(&scene, &options);
    let times = in_turns(&mut [call, &mut || product.run()]);
    let (call, product) = (median(&times[0]), median(&times[1]));
    let old = old::product(&case.name, threads);
    match (case.name.split_once(' '), threads) {
        (Some(("ellipse", "16")), 1) => summary::note(summary::SMALL_16, 1e6 * call),
        (Some(("ellipse", "64")), 1) => summary::note(summary::SMALL_64, 1e6 * call),
        (Some(("ellipse", m)), 1) if m != "32" => {
            summary::note_products([summary::ELLIPSE, summary::ELLIPSE_OLD], call, [Some(product), old])
        }
        (Some(("rough", _)), 1) => {
            summary::note_products([summary::ROUGH, summary::ROUGH_OLD], call, [Some(product), old])
        }
        _ => {}
    }
    println!(
        "| {} | {} | {:.1} % | {} | {} | {:.1} | {} | {:.1} | {at_most} | {} |",
        case.name,
        size(&case.grid),
        100.0 * report.measures.contact_count as f64 / case.grid.len() as f64,
        shown(call),
        shown(product),
        call / product,
        old::in_products(call, &case.name, threads),
        report.count.work_units,
        mark(call, limit(product))
    );
}

/// The number of time steps, of 1 % of the approach each, that increase the approach before as many decrease it again.
const CLIMB: i32 = 20;

/// Measures time steps: the next solve of a handle after the approach changed by 1 %.
pub fn time_steps(threads: usize) {
    println!(
        "\n### Time stepping: the approach changes by 1 % a step, {CLIMB} steps up, {CLIMB} down; {threads} thread(s)\n"
    );
    println!("| case | first step | later steps | product | products, first / later | later, of 9fd3772 | at most | |");
    println!("|---|---|---|---|---|---|---|---|");
    let cases = [ellipse(64), ellipse(256), ellipse(512), ellipse(1024), rough(256), rough(512), rough(1024)];
    for case in cases.into_iter().chain([wheel_rail("y4_82kN", 1), wheel_rail("y4_82kN", 2)]) {
        let mut first = Solver::new(&case.scene(), &options(threads)).expect("a solver");
        first.solve(&case.scene(), &options(threads), None, None).expect("a solvable scene");
        let approach = first.state().approach;
        drop(first);
        let next = Options { initial_guess: InitialGuess::Previous, ..options(threads) };
        let at = |step: i32| case.scene_with(Load::Approach(approach * 1.01f64.powi(step)));
        let solve = |solver: &mut Solver, step: i32| {
            let (stop, _) = solver.solve(&at(step), &next, None, None).expect("a solvable scene");
            assert_eq!(stop, Outcome::Converged, "{}", case.name);
        };
        let mut stepping = Solver::new(&at(0), &next).expect("a solver");
        let mut step = 0;
        solve(&mut stepping, step);
        let mut product = Product::new(&at(0), threads);
        let times = in_turns(&mut [
            &mut || {
                step += 1;
                solve(&mut stepping, CLIMB - (step % (2 * CLIMB) - CLIMB).abs());
            },
            &mut || product.run(),
        ]);
        let mut first_steps = Vec::new();
        for _ in 0..5 {
            let mut starting = Solver::new(&at(0), &next).expect("a solver");
            solve(&mut starting, 0);
            first_steps.push(seconds(|| solve(&mut starting, 1)));
        }
        let [later, product] = [0, 1].map(|i| median(&times[i]));
        let first = median(&first_steps);
        if threads == 1 {
            let old = old::product(&case.name, threads);
            summary::note_products([summary::STEPS, summary::STEPS_OLD], later, [Some(product), old]);
        }
        println!(
            "| {} | {} | {} | {} | {:.1} / {:.1} | {} | 5 | {} |",
            case.name,
            shown(first),
            shown(later),
            shown(product),
            first / product,
            later / product,
            old::in_products(later, &case.name, threads),
            mark(first.max(later), 5.0 * product)
        );
    }
}

/// Compares cold calls with several threads and with one.
pub fn speed_up(threads: usize, sizes: &[usize]) {
    println!("\n### {threads} threads against one, cold\n");
    println!("| case | one thread | {threads} threads | ratio | at least | |");
    println!("|---|---|---|---|---|---|");
    for case in sizes.iter().filter(|m| **m >= 512).flat_map(|&m| [ellipse(m), rough(m)]) {
        let [one, several] = [1, threads].map(options);
        let times = in_turns(&mut [&mut || _ = cold(&case.scene(), &one), &mut || _ = cold(&case.scene(), &several)]);
        let (one, several) = (median(&times[0]), median(&times[1]));
        let ratio = one / several;
        summary::note(summary::SPEED_UP, ratio);
        println!("| {} | {} | {} | {ratio:.2} | 1.75 | {} |", case.name, shown(one), shown(several), mark(1.75, ratio));
    }
}

/// Compares single products with several threads and with one. A call makes some products on each of its grids.
pub fn speed_up_of_products(threads: usize, sizes: &[usize]) {
    println!("\n### {threads} threads against one, a product alone\n");
    println!("| elements | one thread | {threads} threads | ratio |");
    println!("|---|---|---|---|");
    for &m in [64, 128].iter().chain(sizes) {
        let case = ellipse(m);
        let [mut one, mut several] = [1, threads].map(|threads| Product::new(&case.scene(), threads));
        let times = in_turns(&mut [&mut || one.run(), &mut || several.run()]);
        let (one, several) = (median(&times[0]), median(&times[1]));
        println!("| {m} x {m} | {} | {} | {:.2} |", shown(one), shown(several), one / several);
    }
}

/// Measures a cold call of one element with a table of influence coefficients.
pub fn one_element() {
    let grid = Grid::new(1, 1, 1.0, 1.0).expect("a grid");
    let table = || Table::new(1, 1, &[1.0; 4], &grid).expect("a table");
    let scene = Scene::new(grid, &[0.0], Bodies::same(1.0, 0.3), Load::Approach(0.1));
    let call = || {
        let scene = Scene { influence: Some(table()), ..scene.clone() };
        (0..100).for_each(|_| _ = cold(&scene, &options(1)));
    };
    let took = 1e4 * median(&in_turns(&mut [&mut { call }])[0]);
    summary::note(summary::ONE, took);
    println!("\n### One element with a table of its own, cold\n\n{took:.2} us, at most 4: {}.", mark(took, 4.0));
}

/// Compares solves with a prescribed force and with the approach that this force leads to.
pub fn force_against_approach(threads: usize) {
    println!("\n### Prescribed force against prescribed approach, cold, {threads} thread(s)\n");
    println!("| case | approach | force | ratio | at most | |");
    println!("|---|---|---|---|---|---|");
    let cases = [ellipse(64), ellipse(512), ellipse(1024), rough(512), rough(1024), wheel_rail("y4_82kN", 1)];
    for case in cases {
        let options = options(threads);
        let (_, report) = cold(&case.scene(), &options);
        let by_approach = case.scene_with(Load::Approach(report.measures.approach));
        let by_force = case.scene_with(Load::Force(report.measures.force));
        let times = in_turns(&mut [&mut || _ = cold(&by_approach, &options), &mut || _ = cold(&by_force, &options)]);
        let (approach, force) = (median(&times[0]), median(&times[1]));
        let ratio = force / approach;
        println!(
            "| {} | {} | {} | {ratio:.2} | 1.3 | {} |",
            case.name,
            shown(approach),
            shown(force),
            mark(ratio, 1.3)
        );
    }
}

/// Measures what the estimates of errors cost, and what is saved if a solve stops at a part of the discretisation error.
pub fn accuracy(threads: usize) {
    println!("\n### What estimates cost, cold, {threads} thread(s)\n");
    println!("| case | without | with estimates | more | at most | |");
    println!("|---|---|---|---|---|---|");
    let with = |threads| Options { estimates: true, ..options(threads) };
    for case in [ellipse(64), ellipse(512), ellipse(1024), rough(512), rough(1024), wheel_rail("y4_82kN", 1)] {
        let (scene, plain, with) = (case.scene(), options(threads), with(threads));
        let times = in_turns(&mut [&mut || _ = cold(&scene, &plain), &mut || _ = cold(&scene, &with)]);
        let (plain, with) = (median(&times[0]), median(&times[1]));
        let more = 100.0 * (with / plain - 1.0);
        println!("| {} | {} | {} | {more:.1} % | 2 % | {} |", case.name, shown(plain), shown(with), mark(more, 2.0));
    }
    println!("\n### error_ratio 0.1 against tolerance 1e-8, {threads} thread(s)\n");
    println!("| case | method | tolerance 1e-8 | error_ratio 0.1 | ratio | work units | at most | |");
    println!("|---|---|---|---|---|---|---|---|");
    for method in [Method::Auto, Method::FullMultigrid] {
        let case = ellipse(1024);
        let tight = Options { method, tolerance: 1e-8, ..options(threads) };
        let enough = Options { error_ratio: 0.1, ..tight };
        let work = [&tight, &enough].map(|options| cold(&case.scene(), options).1.count.work_units);
        let times = in_turns(&mut [&mut || _ = cold(&case.scene(), &tight), &mut || _ = cold(&case.scene(), &enough)]);
        let (tight, enough) = (median(&times[0]), median(&times[1]));
        let ratio = enough / tight;
        println!(
            "| {} | {method:?} | {} | {} | {ratio:.2} | {:.1} and {:.1} | 0.5 | {} |",
            case.name,
            shown(tight),
            shown(enough),
            work[0],
            work[1],
            mark(ratio, 0.5)
        );
    }
}

/// Measures how the time of a solve grows with the number of elements N, as the exponent of N.
pub fn growth(threads: usize, sizes: &[usize]) {
    println!("\n### Growth of the time on the rough surface, {threads} thread(s)\n");
    println!("| size | call | exponent from the size before | from the first | at most | |");
    println!("|---|---|---|---|---|---|");
    let mut calls: Vec<(usize, f64)> = Vec::new();
    for &m in sizes {
        let (case, options) = (rough(m), options(threads));
        let times = in_turns(&mut [&mut || _ = cold(&case.scene(), &options)]);
        let call = median(&times[0]);
        let exponent = |&(m0, call0): &(usize, f64)| (call / call0).ln() / (2.0 * (m as f64 / m0 as f64).ln());
        match (calls.last(), calls.first()) {
            (Some(last), Some(first)) => println!(
                "| {m} | {} | {:.2} | {:.2} | 1.15 | {} |",
                shown(call),
                exponent(last),
                exponent(first),
                mark(exponent(first), 1.15)
            ),
            _ => println!("| {m} | {} | | | | |", shown(call)),
        }
        calls.push((m, call));
    }
    if let [(first_size, first_call), .., (last_size, last_call)] = &calls[..] {
        let exponent = (last_call / first_call).ln() / (2.0 * (*last_size as f64 / *first_size as f64).ln());
        summary::note(summary::GROWTH, exponent);
    }
}

/// Measures a batch of small problems with one worker and with two.
pub fn batch() {
    const COUNT: usize = 1000;
    println!("\n### Batch of {COUNT} problems of 64 x 64 elements: two workers against one, by the clock\n");
    println!("| one worker | problems per second | two workers | problems per second | ratio | at least | |");
    println!("|---|---|---|---|---|---|---|");
    // The problems have bodies of different curvatures, pressed together by different approaches.
    let case = ellipse(64);
    let scaled = |k: usize| case.h.iter().map(|h| (0.8 + 0.4 * k as f64 / COUNT as f64) * h).collect();
    let surfaces: Vec<Vec<f64>> = (0..COUNT).map(scaled).collect();
    let load = |k: usize| Load::Approach(0.06 + 0.01 * (k % 6) as f64);
    let scene = |k: usize| Scene::new(case.grid, &surfaces[k], case.bodies, load(k));
    let problems: Vec<Problem<'_>> = (0..COUNT).map(|k| Problem { scene: scene(k), guess: None }).collect();
    let mut solvers = [1, 2].map(|workers| Solver::new(&case.scene(), &options(workers)).expect("a solver"));
    let solve = |solver: &mut Solver, workers: usize| {
        let stops = solver.solve_batch(&problems, &options(workers), |_, outcome, _| outcome.expect("a solve").0);
        assert!(stops.expect("a batch").iter().all(|&stop| stop == Outcome::Converged));
    };
    let [one, two] = &mut solvers;
    let times = in_turns(&mut [&mut || solve(one, 1), &mut || solve(two, 2)]);
    let (one, two) = (median(&times[0]), median(&times[1]));
    let rate = |seconds: f64| COUNT as f64 / seconds;
    summary::note(summary::BATCH, rate(two));
    println!(
        "| {} | {:.0} | {} | {:.0} | {:.2} | 1.8 | {} |",
        shown(one),
        rate(one),
        shown(two),
        rate(two),
        one / two,
        mark(1.8, one / two)
    );
}

/// Compares the methods NORM and AUTO.
pub fn norm_against_auto(threads: usize) {
    println!("\n### NORM (by FFT) against AUTO at 512, {threads} thread(s)\n");
    println!("| case | NORM | AUTO | ratio | at least | |");
    println!("|---|---|---|---|---|---|");
    for case in [ellipse(512), rough(512)] {
        let auto = options(threads);
        let norm = Options { method: Method::Norm, ..auto };
        let times = in_turns(&mut [&mut || _ = cold(&case.scene(), &norm), &mut || _ = cold(&case.scene(), &auto)]);
        let (norm, auto) = (median(&times[0]), median(&times[1]));
        println!(
            "| {} | {} | {} | {:.1} | 15 | {} |",
            case.name,
            shown(norm),
            shown(auto),
            norm / auto,
            mark(15.0, norm / auto)
        );
    }
}

/// The first argument of a process of this program that only calls [`solve_once`].
pub const SOLVE_ONCE: &str = "--solve-once";

/// Measures the peak memory of cold solves with two threads, each case in a process of its own. `cases`: the name of a case, its size, and the
/// limit in bytes per element. Each case is solved twice: on a virtual machine the first call may wait for memory that the host has not provided yet.
pub fn memory(cases: &[(&str, usize, f64)]) {
    println!("\n### Peak memory of one cold solve with two threads, bytes per element\n");
    println!("| case | before the call (h, the program) | peak | in all | first call | second call | at most | |");
    println!("|---|---|---|---|---|---|---|---|");
    for (name, m, at_most) in cases {
        let program = std::env::current_exe().expect("this program's path");
        let out = Command::new(program).args([SOLVE_ONCE, name, &m.to_string()]).output().expect("a process");
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        let text = String::from_utf8_lossy(&out.stdout);
        let numbers: Vec<f64> = text.split_whitespace().map(|x| x.parse().expect("a number")).collect();
        let [before, peak] = [numbers[0], numbers[1]].map(|bytes| bytes / (m * m) as f64);
        let (all, [first, second]) = (numbers[1] / 1e9, [numbers[2], numbers[3]]);
        match m {
            8192 => {
                summary::note(summary::BYTES_8192, all);
                summary::note(summary::SECONDS_8192, second);
            }
            16384 => {
                summary::note(summary::BYTES_16384, all);
                summary::note(summary::SECONDS_16384, second);
            }
            _ => {}
        }
        println!(
            "| {name} {m} | {before:.0} | {peak:.1} | {all:.2} GB | {} | {} | {at_most:.1} | {} |",
            shown(first),
            shown(second),
            mark(peak, *at_most)
        );
    }
}

/// The first argument of a process of this program that only calls [`solve_again`], for a profiler.
pub const SOLVE_AGAIN: &str = "--solve-again";

/// Repeats cold solves, or time steps up and down again, for at least `at_least` seconds. Time steps end when the approach is that of the beginning.
pub fn solve_again(name: &str, m: usize, steps: bool, at_least: f64, threads: usize) {
    by_processor(true);
    let case = by_name(name, m);
    let began = std::time::Instant::now();
    let next = Options { initial_guess: InitialGuess::Previous, ..options(threads) };
    let approach = cold(&case.scene(), &options(threads)).1.measures.approach;
    let mut solver = Solver::new(&case.scene(), &next).expect("a solver");
    let (mut solves, mut iterations, mut work, mut took) = (0, 0, 0.0, 0.0);
    while began.elapsed().as_secs_f64() < at_least || steps && solves % (2 * CLIMB) != 0 {
        if steps {
            let climbed = CLIMB - (solves % (2 * CLIMB) - CLIMB).abs();
            let scene = case.scene_with(Load::Approach(approach * 1.01f64.powi(climbed)));
            let mut solve = || solver.solve(&scene, &next, None, None).expect("a solvable scene").1;
            let mut report = Report::default();
            took += seconds(|| report = solve());
            iterations += report.count.active_set_steps;
            work += report.count.work_units;
        } else {
            cold(&case.scene(), &options(threads));
        }
        solves += 1;
    }
    if steps {
        let each = f64::from(solves);
        println!(
            "{solves} steps, each {:.2} iterations, {:.2} products by elements, {} of the processor",
            iterations as f64 / each,
            work / each,
            shown(took / each)
        );
    }
}

/// Makes two cold solves. Prints the memory of the process before them in bytes, its peak, and the seconds of each solve.
pub fn solve_once(name: &str, m: usize) {
    let case = by_name(name, m);
    // The peak is reset, so that the memory for making the surface does not count.
    std::fs::write("/proc/self/clear_refs", "5").expect("the peak can be reset (Linux)");
    let before = status_of_memory("VmRSS:");
    let took = || {
        seconds(|| {
            let (stop, _) = cold(&case.scene(), &options(2));
            assert_eq!(stop, Outcome::Converged);
        })
    };
    let (first, second) = (took(), took());
    println!("{before} {} {first} {second}", status_of_memory("VmHWM:"));
}

/// A quantity of memory in bytes from the entry `what` of Linux' status of this process.
fn status_of_memory(what: &str) -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux");
    let line = status.lines().find(|line| line.starts_with(what)).expect("its line");
    1024 * line.split_whitespace().nth(1).and_then(|kib| kib.parse::<u64>().ok()).expect("a number")
}
