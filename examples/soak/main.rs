//! A long test, `make soak`: a wheel rolls over a wavy rail, and each step is solved from the solution of the step before.
//!
//! Every result is certified. The sequence is solved twice, each time with a new handle, and must give the same bits. From one lap to the next
//! approaches must not drift, and memory must not grow. The program prints its results, and fails if a condition is violated.

use std::process::ExitCode;

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{InitialGuess, Options, Outcome, Solver};

const M: usize = 48;
/// The number of steps of a lap, after which the wheel is at the place where it began.
const LAP: usize = 500;
const TOLERANCE: f64 = 1e-6;

/// The undeformed distance and the force at a step of a lap.
fn step(grid: &Grid, step: usize, h: &mut [f64]) -> Load {
    let phase = std::f64::consts::TAU * step as f64 / LAP as f64;
    for (i, h) in h.iter_mut().enumerate() {
        let x = ((i % M) as f64 + 0.5 - 0.5 * M as f64) * grid.dx - 0.5 * phase.sin();
        let y = ((i / M) as f64 + 0.5 - 0.5 * M as f64) * grid.dy;
        *h = x * x / 920.0 + y * y / 600.0 + 1e-4 * (8.0 * x + 5.0 * phase).cos() * (3.0 * y).cos();
    }
    Load::Force(10_000.0 * (1.0 + 0.3 * (3.0 * phase).sin()))
}

/// The results of one lap: the sum of all approaches, a hash of the bits of all pressures, and the number of products.
#[derive(Clone, Copy, PartialEq)]
struct Lap {
    approaches: f64,
    hash: u64,
    products: u64,
}

fn lap(grid: &Grid, solver: &mut Solver, options: &Options, h: &mut [f64]) -> Result<Lap, String> {
    let mut lap = Lap { approaches: 0.0, hash: 0xcbf2_9ce4_8422_2325, products: 0 };
    for k in 0..LAP {
        let load = step(grid, k, h);
        let scene = Scene::new(*grid, h, Bodies::same(82_000.0, 0.28), load);
        let (stop, report) = solver.solve(&scene, options, None, None).map_err(|e| e.to_string())?;
        let certificate = report.measures.certificate;
        if stop != Outcome::Converged || !(certificate.residual <= TOLERANCE && certificate.min_pressure >= 0.0) {
            return Err(format!("step {k}: {stop:?}, {certificate:?}"));
        }
        lap.approaches += report.measures.approach;
        lap.products += report.count.matrix_products;
        for p in &solver.state().p {
            lap.hash = (lap.hash ^ p.to_bits()).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    Ok(lap)
}

/// The number of memory pages that this process holds.
fn pages() -> u64 {
    let statm = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    statm.split_whitespace().nth(1).and_then(|pages| pages.parse().ok()).unwrap_or(0)
}

fn run(solves: usize) -> Result<(), String> {
    let grid = Grid::new(M, M, 0.25, 0.2).map_err(|e| e.to_string())?;
    let mut h = vec![0.0; grid.len()];
    let options = Options { initial_guess: InitialGuess::Previous, tolerance: TOLERANCE, ..Options::default() };
    let load = step(&grid, 0, &mut h);
    let new = |h: &[f64]| Solver::new(&Scene::new(grid, h, Bodies::same(82_000.0, 0.28), load), &options);
    let laps = (solves / (2 * LAP)).max(3);
    let mut runs = Vec::new();
    for _ in 0..2 {
        let mut solver = new(&h).map_err(|e| e.to_string())?;
        let (mut results, mut held) = (Vec::new(), 0);
        for number in 0..laps {
            results.push(lap(&grid, &mut solver, &options, &mut h)?);
            // After two laps the process must hold all the memory that it ever needs.
            match number {
                1 => held = pages(),
                _ if number > 1 && pages() > held + 64 => {
                    return Err(format!("lap {number}: {} pages, {held} after the second lap", pages()))
                }
                _ => {}
            }
        }
        runs.push(results);
    }
    if runs[0] != runs[1] {
        return Err("the second run differs from the first".into());
    }
    // The first lap starts without a solution, so the second one is the reference. Later laps may differ by the tolerance of each step.
    let (first, last) = (runs[0][1], runs[0][laps - 1]);
    let drift = (last.approaches - first.approaches).abs() / first.approaches.abs();
    if !(drift <= TOLERANCE) {
        return Err(format!("the approaches drift by {drift:e}"));
    }
    println!("{} solves, each certified; the same bits in both runs", 2 * laps * LAP);
    println!("drift of the mean approach from lap 2 to lap {laps}: {drift:.1e}");
    println!("products a solve: {:.2} in lap 2, {:.2} in lap {laps}", mean(first), mean(last));
    println!("memory: {} pages, no more than after the second lap", pages());
    Ok(())
}

fn mean(lap: Lap) -> f64 {
    lap.products as f64 / LAP as f64
}

fn main() -> ExitCode {
    let solves = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(100_000);
    match run(solves) {
        Ok(()) => ExitCode::SUCCESS,
        Err(what) => {
            eprintln!("{what}");
            ExitCode::FAILURE
        }
    }
}
