//! Steady rolling: the operator B, and the solution of its difference equation element by element from the leading edge on.
//!
//! A particle rolls a distance dq in the direction chi in each step. The displacement of a step is B q with
//!
//! ```text
//! B = A d,    (d q)(x) = q(x) - q(x + dq)        x and dq = (dq cos chi, dq sin chi): points of the plane
//! ```
//!
//! A preconditioner solves `d z = v`, from the leading edge on, with z = 0 ahead of C. If x + dq lies between centres, z is interpolated there
//! bilinearly. On slip z is a multiple of the tangent t of the circle, and the value ahead is weighted by E of the preconditioner (see
//! [`tangent`](super::tangent)):
//!
//! ```text
//! stick: z_i = z(ahead of i) + v_i
//! slip:  z_i = t t.(E_i z(ahead of i) + v_i)
//! ```

use super::plane::{plus, Vector};
use crate::grid::Grid;
use crate::threads::Threads;

/// A step of rolling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling {
    /// The distance dq that the bodies roll, a length.
    pub distance: f64,
    /// The step in elements: `(dq cos chi/dx, dq sin chi/dy)`.
    pub by: (f64, f64),
}

/// The bilinear interpolation at the point one step ahead of an element's centre.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The step in elements.
    by: (f64, f64),
    /// The neighbours of the element around that point: their offsets in x and y, and their weights.
    ahead: Vec<(isize, isize, f64)>,
    /// The weight of the element itself, which is not 0 if the step is shorter than an element.
    own: f64,
}

impl Rolling {
    /// The step on a coarser grid: as many elements of that grid, but at least one. A longer step is possible because the slip per length depends
    /// little on the length of the step.
    pub fn on(&self, fine: &Grid, coarse: &Grid) -> Rolling {
        let (is_along_x, length) = (self.by.0.abs() >= self.by.1.abs(), self.by.0.abs().max(self.by.1.abs()));
        let factor = if is_along_x { coarse.dx / fine.dx } else { coarse.dy / fine.dy } / length.min(1.0);
        let by = (self.by.0 * factor * fine.dx / coarse.dx, self.by.1 * factor * fine.dy / coarse.dy);
        Rolling { distance: self.distance * factor, by }
    }
}

impl Sweep {
    /// Computes the weights for a step.
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

    /// The weight of an element itself at the point one step ahead of its centre.
    pub fn own(&self) -> f64 {
        self.own
    }

    /// The neighbours around the point one step ahead of an element's centre: their offsets in x and y, and their weights.
    pub fn neighbours(&self) -> &[(isize, isize, f64)] {
        &self.ahead
    }

    /// Axx and Ayy at the point one step ahead of a loaded element's centre, interpolated from the coefficients `at(x, y)` at whole offsets.
    pub fn ahead_of(&self, at: impl Fn(f64, f64) -> [f64; 3]) -> Vector {
        let [xx, yy, _] = at(0.0, 0.0);
        self.ahead.iter().fold([self.own * xx, self.own * yy], |sum, &(x, y, weight)| {
            let [xx, yy, _] = at(x as f64, y as f64);
            plus(sum, weight, [xx, yy])
        })
    }

    /// Solves `d z = v` as in the module. `z` holds v on entry and the solution on return. `mixing(i)` is E of element i, `project(i, v)` is v on
    /// stick and t t.v on slip.
    pub fn solve(
        &self,
        grid: &Grid,
        mixing: impl Fn(usize) -> f64 + Sync + Send,
        project: impl Fn(usize, Vector) -> Vector + Sync + Send,
        threads: &Threads,
        z: &mut [Vector],
    ) {
        match self.ahead[..] {
            [(1, 0, _)] if self.own == 0.0 => each_row(grid, (mixing, project), threads, (z, true)),
            [(-1, 0, _)] if self.own == 0.0 => each_row(grid, (mixing, project), threads, (z, false)),
            _ => self.any_direction(grid, (mixing, project), z),
        }
    }

    /// [`Sweep::solve`] for any step, on one thread.
    fn any_direction(
        &self,
        grid: &Grid,
        (mixing, project): (impl Fn(usize) -> f64, impl Fn(usize, Vector) -> Vector),
        z: &mut [Vector],
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
                        ahead = plus(ahead, weight, z[jy * mx + jx]);
                    }
                }
                let sum = plus(z[i], mixing(i), ahead);
                z[i] = project(i, [factor * sum[0], factor * sum[1]]);
            }
        }
    }
}

/// [`Sweep::solve`] for steps of one element along x, towards larger x if `forward`. Rows are independent, so that threads share them.
fn each_row(
    grid: &Grid,
    (mixing, project): (impl Fn(usize) -> f64 + Sync + Send, impl Fn(usize, Vector) -> Vector + Sync + Send),
    threads: &Threads,
    (z, forward): (&mut [Vector], bool),
) {
    let mx = grid.mx;
    threads.for_each_row_pair((z, mx), (&mut vec![(); grid.my][..], 1), |iy, row, _| {
        let mut ahead = [0.0; 2];
        for k in 0..mx {
            let ix = if forward { mx - 1 - k } else { k };
            let i = iy * mx + ix;
            ahead = project(i, plus(row[ix], mixing(i), ahead));
            row[ix] = ahead;
        }
    });
}
