//! Measures the times of several calls in turns, and their medians: other programs on a shared machine then disturb all calls alike.

use std::hint::black_box;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use contact_normal::grid::Grid;
use contact_normal::operator::{Operator, Workspace};
use contact_normal::scene::Scene;
use contact_normal::solver::{solve, Options, Outcome, Report};
use contact_normal::threads::Threads;

/// Repeats for one row of a table end after this number of seconds.
const SECONDS_PER_ROW: f64 = 3.0;
/// The least number of repeats for a row.
const FEWEST: usize = 5;
/// The largest number of repeats for a row.
const MOST: usize = 400;

/// Whether times are processor times, of all threads together, instead of wall-clock times.
static PROCESSOR: AtomicBool = AtomicBool::new(false);

/// Chooses whether later times are processor times, which are meant for work of one thread. On a machine that other programs use, wall-clock
/// times also contain the time of these programs, in long calls more than in short ones.
pub fn by_processor(yes: bool) {
    PROCESSOR.store(yes, Ordering::Relaxed);
}

/// Seconds since a fixed moment, of the chosen kind of time.
fn now() -> f64 {
    let which = if PROCESSOR.load(Ordering::Relaxed) { libc::CLOCK_PROCESS_CPUTIME_ID } else { libc::CLOCK_MONOTONIC };
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the call writes to `time`, which lives.
    unsafe { libc::clock_gettime(which, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Does some work, and returns its seconds.
pub fn seconds(work: impl FnOnce()) -> f64 {
    let began = now();
    work();
    now() - began
}

/// Makes all calls in turns, first once without measuring. Returns the times of each call.
pub fn in_turns(calls: &mut [&mut dyn FnMut()]) -> Vec<Vec<f64>> {
    let mut times = vec![Vec::new(); calls.len()];
    calls.iter_mut().for_each(|call| call());
    let began = Instant::now();
    for turn in 0..MOST {
        if turn >= FEWEST && began.elapsed().as_secs_f64() > SECONDS_PER_ROW {
            break;
        }
        for (call, times) in calls.iter_mut().zip(&mut times) {
            times.push(seconds(call));
        }
    }
    times
}

/// The median of some times.
pub fn median(times: &[f64]) -> f64 {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 {
        sorted[middle]
    } else {
        0.5 * (sorted[middle - 1] + sorted[middle])
    }
}

/// The unit of the targets: one u = A p in double precision, pressures on all of the grid.
pub struct Product {
    operator: Operator<f64>,
    workspace: Workspace<f64>,
    p: Vec<f64>,
    u: Vec<f64>,
}

impl Product {
    /// Sets up the operator of a scene, with a number of threads.
    pub fn new(scene: &Scene<'_>, threads: usize) -> Product {
        let threads = Threads::new(threads).expect("threads");
        let operator =
            Operator::new(&scene.coefficients().expect("coefficients"), &scene.grid, &threads).expect("an operator");
        let workspace = operator.workspace().expect("a workspace");
        let p = (0..scene.grid.len()).map(|i| 1.0 + (i % 7) as f64).collect();
        Product { operator, workspace, p, u: vec![0.0; scene.grid.len()] }
    }

    /// Makes one product.
    pub fn run(&mut self) {
        self.operator.apply(black_box(&self.p), &mut self.u, &mut self.workspace);
        black_box(&self.u);
    }
}

/// Makes one cold call, which includes the set-up and the release of memory.
pub fn cold(scene: &Scene<'_>, options: &Options) -> (Outcome, Report) {
    let (solver, stop, report) = solve(black_box(scene), options).expect("a solvable scene");
    black_box(solver.state().p.first());
    (stop, report)
}

/// A time as text, in s, ms or us.
pub fn shown(seconds: f64) -> String {
    match seconds {
        s if s >= 1.0 => format!("{s:.3} s"),
        s if s >= 1e-3 => format!("{:.3} ms", s * 1e3),
        s => format!("{:.1} us", s * 1e6),
    }
}

/// The elements of a grid as text, as "512 x 512".
pub fn size(grid: &Grid) -> String {
    format!("{} x {}", grid.mx, grid.my)
}
