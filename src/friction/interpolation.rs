//! The start of a grid of nested iteration: tractions interpolated from the coarser one.
//!
//! ```text
//! start of the next grid: q per area in C, interpolated between the centres of elements in C, projected onto the disc;
//!                         if all of these slip, g times the direction of q/g; in steady rolling g times q/g
//! ```
//!
//! In steady rolling a traction of large slip is turned towards -s. With the interpolated q/g as d, s = w + u with w of the finer grid and u
//! interpolated, and k = |s|/(a0 g), the start is `d - 0.3 k^2 s/|s|`, projected onto the disc. With spin the direction of slip varies within
//! a coarse element, which interpolation cannot represent; at small slip s is a difference of large numbers.

use super::certificate::ON_THE_CIRCLE;
use super::plane::{add, onto_disc, plus, square, Vector};
use super::problem::{Problem, State};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{collected, zeros};

/// Weight of the turn of tractions against the slip. With it 22 of 204 cases of rolling take too many products, without it 30
/// (docs/notes/2026-11-friction.md).
const TURN_WEIGHT: f64 = 0.3;

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
                mean.add(weight, bound, shares[k], from_state.q[k], from_state.u[k]);
            }
        }
        if mean.weights == 0.0 {
            return [0.0; 2];
        }
        let direction = mean.direction();
        if is_rolling && mean.any_slip {
            let s = plus(add(fine.slip[i], fine.weighted(i, fine.offset)), shorter / mean.weights, mean.displaced);
            let stiff = fine.operators.self_influence * g;
            onto_disc(turned_against(direction, s, stiff).map(|v| g * v), g)
        } else if is_rolling || mean.all_slip {
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
    /// The sum of u.
    displaced: Vector,
    weights: f64,
    all_slip: bool,
    any_slip: bool,
}

impl Default for Mean {
    fn default() -> Mean {
        let none = [0.0; 2];
        Mean { direction: none, traction: none, displaced: none, weights: 0.0, all_slip: true, any_slip: false }
    }
}

impl Mean {
    fn add(&mut self, weight: f64, bound: f64, share: f64, q: Vector, u: Vector) {
        let slips = square(q).sqrt() >= ON_THE_CIRCLE * bound;
        (self.all_slip, self.any_slip) = (self.all_slip && slips, self.any_slip || slips);
        self.direction = plus(self.direction, weight / bound, q);
        self.traction = plus(self.traction, weight * share, q);
        self.displaced = plus(self.displaced, weight, u);
        self.weights += weight;
    }

    /// q/g; of length 1 if all slip.
    fn direction(&self) -> Vector {
        let length = square(self.direction).sqrt();
        let by = if self.all_slip && length > 0.0 { length } else { self.weights };
        self.direction.map(|v| v / by)
    }
}

/// `d - TURN_WEIGHT k^2 s/|s|` with k = |s|/stiff, projected onto the disc of radius 1; k may be infinite.
fn turned_against(d: Vector, s: Vector, stiff: f64) -> Vector {
    let length = s[0].hypot(s[1]);
    if length == 0.0 {
        return onto_disc(d, 1.0);
    }
    let weight = TURN_WEIGHT * (length / stiff).powi(2);
    let (share, rest) = (1.0 / (1.0 + 1.0 / weight), 1.0 / (1.0 + weight));
    let turned = plus(d.map(|v| rest * v), -share, s.map(|s| s / length));
    let by = square(turned).sqrt().max(rest);
    turned.map(|v| v / by)
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
