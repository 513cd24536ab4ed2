//! Times of subsurface stresses and of coatings: `cargo bench --bench coating_and_stress`.

mod coating;
mod stress;

use std::time::Instant;

/// The number of runs of which medians are taken.
const RUNS: usize = 9;

/// Runs all programs in turns, and returns the median of the seconds of each.
fn medians<const N: usize>(mut programs: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut seconds = [const { Vec::new() }; N];
    for _ in 0..RUNS {
        for (program, seconds) in programs.iter_mut().zip(&mut seconds) {
            let began = Instant::now();
            program();
            seconds.push(began.elapsed().as_secs_f64());
        }
    }
    seconds.map(|mut seconds: Vec<f64>| {
        seconds.sort_by(f64::total_cmp);
        seconds[RUNS / 2]
    })
}

fn main() {
    coating::report();
    stress::report();
}
