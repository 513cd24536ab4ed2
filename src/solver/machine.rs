//! How the seconds of a product grow with the number of elements on this machine.
//!
//! A product of n elements takes `n log n` operations, but its arrays leave one cache after the other, at other sizes on each machine. So a
//! few products of half-spaces are timed, in a process once (by each of the threads that ask first), when seconds are first predicted: 32 x 32 to 256 x 256 elements, the least of some
//! times each, together some milliseconds on one thread. Between these sizes growth is that of a power, beyond them that of the last two. A machine
//! that is busy at the time cannot spoil much: powers are kept between bounds. No solve depends on it.

use std::sync::OnceLock;
use std::time::Instant;

use super::{Options, Solver};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;
use crate::scene::{Bodies, Load, Scene};

/// Elements in a direction of the grids that are timed.
const SIZES: [usize; 4] = [32, 64, 128, 256];
/// Products on each; the first ones are slow.
const TIMES: usize = 4;
/// Powers of the number of elements that are believed.
const POWERS: (f64, f64) = (1.0, 1.2);
/// The power where nothing could be timed (docs/performance.md).
const GROWTH: f64 = 1.08;

/// Elements, and the seconds of a product.
type Timed = (f64, f64);

/// By how much longer products take on `to` than on `from` elements.
pub fn growth(from: f64, to: f64) -> f64 {
    static MACHINE: OnceLock<Vec<Timed>> = OnceLock::new();
    if MACHINE.get().is_none() {
        // Nobody waits for the thread that measures: a child that is forked meanwhile would wait for ever. The first one to end counts.
        let timed: Result<Vec<Timed>> = SIZES.into_iter().map(time).collect();
        if let Ok(timed) = timed {
            let _ = MACHINE.set(timed);
        }
    }
    growth_by(MACHINE.get().map_or(&[], Vec::as_slice), from, to)
}

/// The seconds of a product on m x m elements.
fn time(m: usize) -> Result<Timed> {
    let grid = Grid::new(m, m, 1.0, 1.0)?;
    let scene = Scene::new(grid, &[], Bodies::same(1.0, 0.3), Load::Approach(1.0));
    let mut solver = Solver::new(&scene, &Options { threads: 1, ..Options::default() })?;
    let (mut p, mut u) = (zeros(grid.len(), "pressures")?, zeros(grid.len(), "displacements")?);
    p[grid.len() / 2] = 1.0;
    let mut least = f64::INFINITY;
    for _ in 0..TIMES {
        let began = Instant::now();
        solver.product(&p, &mut u)?;
        least = least.min(began.elapsed().as_secs_f64());
    }
    Ok((grid.len() as f64, least))
}

fn growth_by(timed: &[Timed], from: f64, to: f64) -> f64 {
    if to < from {
        return 1.0 / growth_by(timed, to, from);
    }
    let last = timed.len().saturating_sub(2);
    let (mut at, mut factor) = (from, 1.0);
    for (k, pair) in timed.windows(2).enumerate() {
        let end = if k == last { to } else { to.min(pair[1].0) };
        if end > at {
            factor *= (end / at).powf(power(pair[0], pair[1]));
            at = end;
        }
    }
    factor * (to / at).powf(GROWTH)
}

fn power(before: Timed, behind: Timed) -> f64 {
    let power = (behind.1 / before.1).ln() / (behind.0 / before.0).ln();
    if power.is_finite() {
        power.clamp(POWERS.0, POWERS.1)
    } else {
        GROWTH
    }
}

#[cfg(test)]
#[path = "../../tests/unit/machine.rs"]
mod tests;
