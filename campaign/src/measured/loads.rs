//! Random loads, from one element in contact to full contact.

use std::f64::consts::PI;

use super::faults::sorted;
use crate::grid::{Grid, Load};
use crate::random::Random;

/// A random approach or force; `c = 1/(pi E*)`.
pub fn any(random: &mut Random, grid: &Grid, h: &[f64], c: f64, period: Option<(bool, bool)>) -> Load {
    let heights = sorted(h);
    if random.chance(0.5) {
        approach(random, grid, &heights, period)
    } else {
        force(random, grid, h, &heights, 1.0 / (PI * c))
    }
}

/// The difference between the largest and the smallest undeformed distance. For a flat surface: 1e-3 of an element.
fn depth(grid: &Grid, heights: &[f64]) -> f64 {
    let depth = heights[heights.len() - 1] - heights[0];
    if depth > 0.0 {
        depth
    } else {
        1e-3 * grid.dx
    }
}

/// A random approach; `heights` has the finite distances, sorted.
fn approach(random: &mut Random, grid: &Grid, heights: &[f64], period: Option<(bool, bool)>) -> Load {
    let (n, depth) = (heights.len(), depth(grid, heights));
    let lowest = heights[0];
    let second = heights.iter().copied().find(|h| *h > lowest).unwrap_or(lowest + depth);
    let mean = heights.iter().sum::<f64>() / n as f64;
    Load::Approach(match random.uniform() {
        // No contact, or one element in contact.
        u if u < 0.03 => lowest - random.pick(&[0.0, 0.1]) * depth,
        u if u < 0.13 => lowest + random.uniform() * (second - lowest),
        // Bodies that would overlap in a part of the elements.
        u if u < 0.55 => heights[(random.decades(1.0 / n as f64, 1.0) * (n - 1) as f64) as usize] + 1e-3 * depth,
        u if u < 0.65 => lowest + random.decades(1e-3, 1.0) * depth,
        // Full contact, or near it.
        _ if period == Some((true, true)) => mean - random.decades(1e-4, 1.0) * (mean - lowest),
        _ => lowest + random.between(0.5, 3.0) * depth,
    })
}

/// A random force, relative to the force of order `E*` times slope times area that flattens the surface, or to the force that presses spikes down.
fn force(random: &mut Random, grid: &Grid, h: &[f64], heights: &[f64], e_star: f64) -> Load {
    let Grid { mx, dx, dy, .. } = *grid;
    let (n, depth) = (heights.len(), depth(grid, heights));
    let (mut squares, mut count) = (0.0, 0.0);
    for i in 0..h.len() {
        for (has_neighbour, step, d) in [((i + 1) % mx != 0, 1, dx), (i + mx < h.len(), mx, dy)] {
            if has_neighbour && h[i].is_finite() && h[i + step].is_finite() {
                squares += ((h[i + step] - h[i]) / d).powi(2);
                count += 1.0;
            }
        }
    }
    let flat = depth / (dx * (n as f64).sqrt());
    let slope = if squares > 0.0 { f64::sqrt(2.0 * squares / count) } else { flat };
    let flattening_force = e_star * slope * n as f64 * grid.element_area();
    let second = heights.iter().copied().find(|h| *h > heights[0]).unwrap_or(heights[0] + depth);
    Load::Force(match random.uniform() {
        u if u < 0.01 => 0.0,
        // The force of a single element before the next one touches.
        u if u < 0.10 => e_star * (second - heights[0]) * dx.max(dy) * random.decades(1e-3, 1.0),
        u if u < 0.5 => flattening_force * random.decades(1e-3, 3.0),
        // The force that presses spikes down to the level of the other elements, and a part of the force that flattens these.
        u if u < 0.8 => {
            let (level, spread) = (heights[n / 4], heights[3 * n / 4] - heights[n / 4]);
            let spikes = heights.iter().take_while(|h| **h < level - spread).count() as f64;
            let down = 2.0 * e_star * (level - heights[0]) * dx.max(dy) * f64::max(spikes, 1.0);
            down + e_star * spread / dx.max(dy) * n as f64 * grid.element_area() * random.decades(1e-3, 1.0)
        }
        _ => flattening_force * random.decades(1e-5, 1e2),
    })
}
