//! Compares Gauss-Seidel and the FFT smoother in V-cycles, and the method AUTO, on the ellipse of the paper and on a rough surface.
//!
//! The numbers are the cycles on the finest grid, the products on it, the work units on all grids, and the seconds of the whole call with set-up on
//! one thread (medians of runs in turns). Then the example shows why red-black order is worse.
//!
//! `cargo run --release --example smoothers [-- SIZE...]`; by default the sizes are 128 256 512 1024.

#[path = "../paper_tables/case.rs"]
#[allow(dead_code)] // This example uses only the scene of the module.
mod case;
mod red_black;
mod rough;

use std::time::Instant;

use contact_normal::methods::multigrid::{CycleShape, SmootherKind};
use contact_normal::scene::Scene;
use contact_normal::solver::{ActiveSet, Guess, Method, Options, Outcome, Report, Solver};

const CYCLES: [(usize, usize); 3] = [(1, 1), (1, 0), (0, 1)];
const SMOOTHERS: [SmootherKind; 2] = [SmootherKind::GaussSeidel, SmootherKind::Fft];

/// A way to solve a problem, with its times and its result.
struct Run {
    options: Options,
    seconds: Vec<f64>,
    result: Option<(Outcome, Report)>,
}

fn main() {
    let sizes: Vec<usize> = std::env::args().skip(1).map(|word| word.parse().expect("a size")).collect();
    let sizes = if sizes.is_empty() { vec![128, 256, 512, 1024] } else { sizes };
    println!("Cycles / products / work units / seconds, tolerance 1e-6");
    println!("{:<24} {:>28} {:>28} {:>28}", "", "Gauss-Seidel", "FFT smoother", "production method");
    for &m in &sizes {
        let h = case::undeformed_distance(m);
        problem("ellipse", &case::scene(m, &h), m);
    }
    for &m in &sizes {
        let h = rough::undeformed_distance(m);
        problem("rough", &rough::scene(m, &h), m);
    }
    red_black::study();
}

/// Compares the smoothers on the whole problem, and on the equations on the contact area of its solution, which are solved from p = 0.
fn problem(name: &str, scene: &Scene<'_>, m: usize) {
    let production = Options { max_cycles: 2000, ..Options::default() };
    let mut solver = Solver::new(scene, &production).expect("a valid scene");
    solver.solve(scene, &production, None, None).expect("a solvable scene");
    let contact = solver.state().contact.clone();
    compare(&format!("{name} {m}"), scene, None, production, m);
    compare(&format!("{name} {m}, C given"), scene, Some(&contact), production, m);
}

fn compare(name: &str, scene: &Scene<'_>, contact: Option<&[bool]>, production: Options, m: usize) {
    let active_set = if contact.is_some() { ActiveSet::Fixed } else { ActiveSet::Free };
    let production = Options { active_set, ..production };
    let by_cycles = |(pre_sweeps, post_sweeps)| {
        SMOOTHERS.map(|smoother| Options {
            method: Method::FullMultigrid,
            cycle: CycleShape { smoother, pre_sweeps, post_sweeps, ..CycleShape::default() },
            ..production
        })
    };
    let all = CYCLES.into_iter().flat_map(by_cycles).chain([production]);
    let mut runs: Vec<Run> = all.map(|options| Run { options, seconds: Vec::new(), result: None }).collect();

    let zero = vec![0.0; scene.undeformed_distance.len()];
    let guess = contact.map(|contact| Guess { pressure: &zero, contact });
    for _ in 0..if m < 1024 { 5 } else { 3 } {
        for run in &mut runs {
            let began = Instant::now();
            let mut solver = Solver::new(scene, &run.options).expect("a valid scene");
            run.result = Some(solver.solve(scene, &run.options, guess, None).expect("a solvable scene"));
            run.seconds.push(began.elapsed().as_secs_f64());
        }
    }

    let last = runs.len() - 1;
    let (cycles, production) = runs.split_at_mut(last);
    for (k, (shape, pair)) in CYCLES.iter().zip(cycles.chunks_exact_mut(2)).enumerate() {
        let label = format!("{name} V({},{})", shape.0, shape.1);
        let beside = if k == 0 { cell(&mut production[0]) } else { String::new() };
        println!("{label:<24} {:>28} {:>28} {beside:>28}", cell(&mut pair[0]), cell(&mut pair[1]));
    }
}

fn cell(run: &mut Run) -> String {
    run.seconds.sort_by(f64::total_cmp);
    let median = run.seconds[run.seconds.len() / 2];
    let Some((stop, report)) = &run.result else { return String::new() };
    let cycles = if *stop == Outcome::Converged { report.count.cycles.to_string() } else { format!("{stop:?}") };
    format!("{cycles} / {} / {:.1} / {median:.3}", report.count.matrix_products, report.count.work_units)
}
