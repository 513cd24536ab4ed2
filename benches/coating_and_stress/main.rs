//! Times of subsurface stresses and of coatings: `cargo bench --bench coating_and_stress`.

mod coating;
mod stress;

use std::time::Instant;

/// Runs that medians are taken of.
const RUNS: usize = 9;

/// The medians of the seconds that each of these takes, in turns.
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
