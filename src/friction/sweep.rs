//! Steady rolling: the difference over a step of rolling, inverted element by element from the leading edge.
//!
//! A step of length dq in the direction chi displaces by `(bx, by)` elements, and the operator is a product,
//!
//! ```text
//! B = A d,    (d q)(x) = q(x) - q(x + dq)        dq = (dq cos chi, dq sin chi)
//! ```
//!
//! `d x = v` is solved from the leading edge on, with x = 0 ahead of each run of C. Between the centres x is interpolated bilinearly. On
//! slip the value ahead is weighted by E of the preconditioner (see [`disc`](super::disc)):
//!
//! ```text
//! stick: x_i = x(ahead of i) + v_i
//! slip:  x_i = t t.(E_i x(ahead of i) + v_i)
//! ```

use super::plane::{plus, Vector};
use crate::grid::Grid;
use crate::threads::Threads;

/// The length of a step of rolling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling {
    /// dq, a length.
    pub distance: f64,
    /// `(dq cos chi/dx, dq sin chi/dy)`.
    pub by: (f64, f64),
}

/// The neighbours ahead of an element, with their weights, and the element's own.
#[derive(Clone, Debug)]
pub struct Sweep {
    by: (f64, f64),
    ahead: Vec<(isize, isize, f64)>,
    own: f64,
}

impl Rolling {
    /// The step on a coarser grid: as many elements, but at least one. The slip per length depends little on the length
    /// of the step.
    pub fn on(&self, fine: &Grid, coarse: &Grid) -> Rolling {
        let (is_along_x, length) = (self.by.0.abs() >= self.by.1.abs(), self.by.0.abs().max(self.by.1.abs()));
        let factor = if is_along_x { coarse.dx / fine.dx } else { coarse.dy / fine.dy } / length.min(1.0);
        let by = (self.by.0 * factor * fine.dx / coarse.dx, self.by.1 * factor * fine.dy / coarse.dy);
        Rolling { distance: self.distance * factor, by }
    }
}

impl Sweep {
    /// The weights of a step.
    pub fn new(rolling: &Rolling) -> Sweep {
        let (x, y) = (rolling.by.0.floor(), rolling.by.1.floor());
        let (in_x, in_y) = (rolling.by.0 - x, rolling.by.1 - y);
        let mut sweep = Sweep { by: rolling.by, ahead: Vec::new(), own: 0.0 };
        for (row, of_row) in [(y, 1.0 - in_y), (y + 1.0, in_y)] {
            for (column, of_column) in [(x, 1.0 - in_x), (x + 1.0, in_x)] {
                let weight = of_row * of_column;
                match (column as isize, row as isize) {
                    (0, 0) => sweep.own = weight,
                    (column, row) if weight > 0.0 => sweep.ahead.push((column, row, weight)),
                    _ => (),
                }
            }
        }
        sweep
    }

    /// The weight of an element itself at its place after a step, between the centres.
    pub fn own(&self) -> f64 {
        self.own
    }

    /// The neighbours around an element's place after a step, with their weights.
    pub fn neighbours(&self) -> &[(isize, isize, f64)] {
        &self.ahead
    }

    /// Axx and Ayy ahead of a loaded element, interpolated from `at(x, y)`.
    pub fn ahead_of(&self, at: impl Fn(f64, f64) -> [f64; 3]) -> Vector {
        let own = at(0.0, 0.0);
        self.ahead.iter().fold([self.own * own[0], self.own * own[1]], |sum, &(x, y, weight)| {
            let [xx, yy, _] = at(x as f64, y as f64);
            plus(sum, weight, [xx, yy])
        })
    }

    /// Solves for x; `x` holds v on entry. `mixing(i)` is E, `project(i, v)` is P v of element i.
    pub fn solve(
        &self,
        grid: &Grid,
        mixing: impl Fn(usize) -> f64 + Sync + Send,
        project: impl Fn(usize, Vector) -> Vector + Sync + Send,
        threads: &Threads,
        x: &mut [Vector],
    ) {
        match self.ahead[..] {
            [(1, 0, _)] if self.own == 0.0 => each_row(grid, (mixing, project), threads, (x, true)),
            [(-1, 0, _)] if self.own == 0.0 => each_row(grid, (mixing, project), threads, (x, false)),
            _ => self.any_direction(grid, (mixing, project), x),
        }
    }

    fn any_direction(
        &self,
        grid: &Grid,
        (mixing, project): (impl Fn(usize) -> f64, impl Fn(usize, Vector) -> Vector),
        x: &mut [Vector],
    ) {
        let Grid { mx, my, .. } = *grid;
        let factor = 1.0 / (1.0 - self.own);
        let place = |k: usize, m: usize, towards: f64| if towards > 0.0 { m - 1 - k } else { k };
        for row in 0..my {
            let iy = place(row, my, self.by.1);
            for column in 0..mx {
                let ix = place(column, mx, self.by.0);
                let i = iy * mx + ix;
                let mut ahead = [0.0; 2];
                for &(in_x, in_y, weight) in &self.ahead {
                    let (jx, jy) = (ix.wrapping_add_signed(in_x), iy.wrapping_add_signed(in_y));
                    if jx < mx && jy < my {
                        ahead = plus(ahead, weight, x[jy * mx + jx]);
                    }
                }
                let sum = plus(x[i], mixing(i), ahead);
                x[i] = project(i, [factor * sum[0], factor * sum[1]]);
            }
        }
    }
}

/// Steps of one element along x, `forward` or backward: rows are independent.
fn each_row(
    grid: &Grid,
    (mixing, project): (impl Fn(usize) -> f64 + Sync + Send, impl Fn(usize, Vector) -> Vector + Sync + Send),
    threads: &Threads,
    (x, forward): (&mut [Vector], bool),
) {
    let mx = grid.mx;
    threads.for_each_row_pair((x, mx), (&mut vec![(); grid.my][..], 1), |iy, row, _| {
        let mut ahead = [0.0; 2];
        for k in 0..mx {
            let ix = if forward { mx - 1 - k } else { k };
            let i = iy * mx + ix;
            ahead = project(i, plus(row[ix], mixing(i), ahead));
            row[ix] = ahead;
        }
    });
}
