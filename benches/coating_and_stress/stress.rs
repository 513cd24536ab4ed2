//! Times of subsurface stresses on 128 x 128 elements at 32 depths, with one thread: by pressures alone and with tractions, on a half-space and
//! with two periods.

use contact_normal::grid::Grid;
use contact_normal::stress::{subsurface_stress, Body, Loads, Wanted};
use contact_normal::threads::Threads;

use crate::{medians, RUNS};

const M: usize = 128;
const DEPTHS: usize = 32;

/// Prints the table.
pub fn report() {
    let free = Body { grid: Grid::new(M, M, 1.0, 1.0).unwrap(), poisson_ratio: 0.3, periodic: false };
    let periodic = Body { periodic: true, ..free };
    let place = |k: usize| (k as f64 - 63.5) / 48.0;
    let p: Vec<f64> = (0..M * M).map(|i| (1.0 - place(i % M).powi(2) - place(i / M).powi(2)).max(0.0).sqrt()).collect();
    let q: Vec<f64> = p.iter().map(|p| 0.2 * p).collect();
    let depths: Vec<f64> = (0..DEPTHS).map(|k| 1.5 * k as f64).collect();
    let tensor = Wanted { components: [true; 6], ..Wanted::default() };
    let mises = Wanted { von_mises: true, ..Wanted::default() };
    let principal = Wanted { principal: true, ..Wanted::default() };
    let one = Wanted { components: [false, false, true, false, false, false], ..Wanted::default() };
    let all = Loads { pressure: Some(&p), traction_x: Some(&q), traction_y: Some(&q), ..Loads::default() };
    println!("Subsurface stresses, {M} x {M} elements, {DEPTHS} depths, one thread; medians of {RUNS} runs\n");
    println!("| loads | wanted | s | ms a depth | with two periods, s | ms a depth |\n|---|---|---:|---:|---:|---:|");
    for (loads, of) in [(Loads::pressure(&p), "p"), (all, "p, qx, qy")] {
        for (wanted, what) in
            [(tensor, "six components"), (mises, "von Mises"), (principal, "principal stresses"), (one, "zz")]
        {
            let compute = |body: &Body| {
                subsurface_stress(body, &loads, &depths, &wanted, &Threads::One, None, |_, _| {}).unwrap();
            };
            let of_a_depth = |seconds: f64| format!("{seconds:.3} | {:.2}", 1e3 * seconds / DEPTHS as f64);
            let [one, other] = medians([&mut || compute(&free), &mut || compute(&periodic)]).map(of_a_depth);
            println!("| {of} | {what} | {one} | {other} |");
        }
    }
}
