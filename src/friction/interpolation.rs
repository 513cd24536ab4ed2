//! The start on a grid of the nested iteration: tractions interpolated from the next coarser grid.
//!
//! The values of the coarse elements in C around a fine element are interpolated bilinearly between their centres:
//!
//! * in a shift q, times the number of all children of the coarse element over the number of those in C, so that the force stays the same;
//! * if all of these coarse elements slip, the direction of q/g instead, times g of the fine element;
//! * in steady rolling q/g, times g of the fine element.
//!
//! The result is projected onto the disc. In steady rolling a traction of large slip is also turned towards -s: with the interpolated q/g as d,
//! s = w + u with w of the finer grid and u interpolated, and k = |s|/(a0 g), the start is `g (d - 0.3 k^2 s/|s|)`. With spin the direction of slip
//! varies within a coarse element, which interpolation cannot represent. At small slip s is a difference of large numbers, so that k^2 gives s little
//! weight.

use super::certificate::ON_THE_CIRCLE;
use super::plane::{add, onto_disc, plus, square, Vector};
use super::problem::{Problem, State};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::{collected, zeros};

/// The weight of k^2 in the turn of tractions towards -s. With it 22 of 204 cases of rolling take too many products, without it 30
/// (docs/notes/2026-11-friction.md).
const TURN_WEIGHT: f64 = 0.3;

/// The number of fine elements in an element of the next coarser grid.
pub fn children(fine: &Grid, coarse: &Grid) -> usize {
    (1 + usize::from(coarse.dx > fine.dx)) * (1 + usize::from(coarse.dy > fine.dy))
}

/// The length of a step of steady rolling on the coarse grid over that on the fine grid; 1 for other motions.
pub fn step_ratio(coarse: &Problem, fine: &Problem) -> f64 {
    match (coarse.operators.step(), fine.operators.step()) {
        (Some(coarse), Some(fine)) => coarse.distance / fine.distance,
        _ => 1.0,
    }
}

/// Sets q and the creepages on a grid from the solution on the next coarser grid, as the module describes. u is left undefined.
pub fn interpolate((coarse, from_state): (&Problem, &State), (fine, state): (&mut Problem, &mut State)) -> Result<()> {
    let (from, to) = (coarse.grid, fine.grid);
    // For each coarse element: the number of its children over the number of those in C.
    let mut shares: Vec<f64> = zeros(from.len(), "the start from a coarser grid")?;
    fine.threads().for_each_plain_row(&mut shares, from.mx, |iy, row| {
        for (ix, share) in row.iter_mut().enumerate() {
            let of_element = from.children(&to, iy * from.mx + ix);
            let in_contact = of_element.filter(|&child| fine.bound[child] > 0.0).count();
            *share = children(&to, &from) as f64 / in_contact.max(1) as f64;
        }
    });
    // In steady rolling q/g is interpolated, because behind the leading edge tractions grow like their bound.
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

/// Sums over the coarse elements in C around a fine element, with the weights of the interpolation.
struct Mean {
    /// The sum of q/g.
    direction: Vector,
    /// The sum of q, times the share of each coarse element.
    traction: Vector,
    /// The sum of u.
    displaced: Vector,
    /// The sum of the weights.
    weights: f64,
    /// Whether all of the coarse elements slip.
    all_slip: bool,
    /// Whether any of the coarse elements slips.
    any_slip: bool,
}

impl Default for Mean {
    fn default() -> Mean {
        let none = [0.0; 2];
        Mean { direction: none, traction: none, displaced: none, weights: 0.0, all_slip: true, any_slip: false }
    }
}

impl Mean {
    /// Adds a coarse element with its bound, share, traction and displacement.
    fn add(&mut self, weight: f64, bound: f64, share: f64, q: Vector, u: Vector) {
        let slips = square(q).sqrt() >= ON_THE_CIRCLE * bound;
        (self.all_slip, self.any_slip) = (self.all_slip && slips, self.any_slip || slips);
        self.direction = plus(self.direction, weight / bound, q);
        self.traction = plus(self.traction, weight * share, q);
        self.displaced = plus(self.displaced, weight, u);
        self.weights += weight;
    }

    /// The interpolated q/g. If all of the coarse elements slip, it is scaled to the length 1.
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

/// For each fine element along one direction: the two coarse elements around its centre, with the weights of linear interpolation.
fn places(fine: usize, coarse: usize) -> Result<Vec<[(usize, f64); 2]>> {
    let of = |i: usize| if fine == coarse { [(i, 1.0), (i, 0.0)] } else { neighbours(i, coarse) };
    Ok(collected((0..fine).map(of), "the start from a coarser grid")?)
}

/// The coarse element that contains the fine element number `fine`, and the nearer neighbour of that, with their weights.
fn neighbours(fine: usize, coarse: usize) -> [(usize, f64); 2] {
    let parent = fine / 2;
    let other = if fine % 2 == 0 { parent.checked_sub(1) } else { Some(parent + 1).filter(|k| *k < coarse) };
    other.map_or([(parent, 1.0), (parent, 0.0)], |other| [(parent, 0.75), (other, 0.25)])
}
