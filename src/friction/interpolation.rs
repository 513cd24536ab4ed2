//! The start of a grid of nested iteration: tractions interpolated from the coarser one.
//!
//! ```text
//! start of the next grid: q per area in C, interpolated between the centres of elements in C, projected onto the disc;
//!                         if all of these slip, g times the direction of q/g; in steady rolling g times q/g
//! ```

use super::certificate::ON_THE_CIRCLE;
use super::plane::{onto_disc, plus, square, Vector};
use super::problem::{Problem, State};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{collected, zeros};

/// Elements of a grid in one of the next coarser.
pub fn children(fine: &Grid, coarse: &Grid) -> usize {
    (1 + usize::from(coarse.dx > fine.dx)) * (1 + usize::from(coarse.dy > fine.dy))
}

/// The ratio of the steps of steady rolling on the coarse and the fine grid.
pub fn step_ratio(coarse: &Problem, fine: &Problem) -> f64 {
    match (coarse.operators.step(), fine.operators.step()) {
        (Some(coarse), Some(fine)) => coarse.distance / fine.distance,
        _ => 1.0,
    }
}
/// q on the next finer grid, from the coarser one.
pub fn interpolate((coarse, from_state): (&Problem, &State), (fine, state): (&mut Problem, &mut State)) -> Result<()> {
    let (from, to) = (coarse.grid, fine.grid);
    // The number of all fine elements in a coarse one, over the number of those in C. So q on the latter carries the force of the coarse element.
    let mut shares: Vec<f64> = zeros(from.len(), "the start from a coarser grid")?;
    fine.threads().for_each_plain_row(&mut shares, from.mx, |iy, row| {
        for (ix, share) in row.iter_mut().enumerate() {
            let all = from.children(&to, iy * from.mx + ix);
            let in_contact = all.filter(|&child| fine.bound[child] > 0.0).count();
            *share = children(&to, &from) as f64 / in_contact.max(1) as f64;
        }
    });
    // Behind the leading edge tractions of steady rolling grow like their bound. So q/g is interpolated.
    let is_rolling = fine.operators.rolling.is_some();
    let shorter = 1.0 / step_ratio(coarse, fine);
    fine.offset = coarse.offset.map(|w| shorter * w);
    let (x, y) = (places(to.mx, from.mx)?, places(to.my, from.my)?);
    let between = |i: usize| {
        let g = fine.bound[i];
        if !(g > 0.0) {
            return [0.0; 2];
        }
        let mut mean = Mean::default();
        for (column, in_x) in x[i % to.mx] {
            for (row, in_y) in y[i / to.mx] {
                let k = row * from.mx + column;
                let (bound, weight) = (coarse.bound[k], in_x * in_y);
                if !(bound > 0.0) || weight == 0.0 {
                    continue;
                }
                mean.add(weight, bound, shares[k], from_state.q[k]);
            }
        }
        if mean.weights == 0.0 {
            return [0.0; 2];
        }
        let direction = mean.direction();
        if is_rolling || mean.all_slip {
            onto_disc(direction.map(|v| g * v), g)
        } else {
            onto_disc(mean.traction.map(|v| v / mean.weights), g)
        }
    };
    fine.threads().for_each_plain_row(&mut state.q, to.mx, |iy, row| {
        row.iter_mut().enumerate().for_each(|(ix, q)| *q = between(iy * to.mx + ix));
    });
    state.is_exact = false;
    Ok(())
}

/// Weighted sums over the coarse elements around a fine one.
struct Mean {
    /// The sum of q/g.
    direction: Vector,
    /// The sum of q, with the shares.
    traction: Vector,
    weights: f64,
    all_slip: bool,
}

impl Default for Mean {
    fn default() -> Mean {
        let none = [0.0; 2];
        Mean { direction: none, traction: none, weights: 0.0, all_slip: true }
    }
}

impl Mean {
    fn add(&mut self, weight: f64, bound: f64, share: f64, q: Vector) {
        self.all_slip &= square(q).sqrt() >= ON_THE_CIRCLE * bound;
        self.direction = plus(self.direction, weight / bound, q);
        self.traction = plus(self.traction, weight * share, q);
        self.weights += weight;
    }

    /// q/g; of length 1 if all slip.
    fn direction(&self) -> Vector {
        let length = square(self.direction).sqrt();
        let by = if self.all_slip && length > 0.0 { length } else { self.weights };
        self.direction.map(|v| v / by)
    }
}

/// The two coarse places around each fine one, with their weights.
fn places(fine: usize, coarse: usize) -> Result<Vec<[(usize, f64); 2]>> {
    let of = |i: usize| if fine == coarse { [(i, 1.0), (i, 0.0)] } else { neighbours(i, coarse) };
    Ok(collected((0..fine).map(of), "the start from a coarser grid")?)
}

/// The two coarse places around a fine one, with their weights.
fn neighbours(fine: usize, coarse: usize) -> [(usize, f64); 2] {
    let own = fine / 2;
    let other = if fine % 2 == 0 { own.checked_sub(1) } else { Some(own + 1).filter(|k| *k < coarse) };
    other.map_or([(own, 1.0), (own, 0.0)], |other| [(own, 0.75), (other, 0.25)])
}
