//! A layer between the bodies whose compliance differs between elements. The coefficients contain its least compliance; the displacements by the
//! rest, r, are added here.
//!
//! ```text
//! u_I += r_I q_I                             r: the compliance less the least
//! u_I += d (r q)_I                           in steady rolling; d v = v - v(x + dq), interpolated between the centres
//! ```

use super::plane::Vector;
use super::sweep::Sweep;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;

/// r on the elements of a grid.
pub struct Excess {
    mx: usize,
    my: usize,
    values: Vec<f64>,
}

impl Excess {
    /// The excess `of(i)` of each element of a grid.
    pub fn new(grid: &Grid, of: impl Fn(usize) -> f64) -> Result<Excess> {
        let mut values: Vec<f64> = zeros(grid.len(), "the layer between the bodies")?;
        values.iter_mut().enumerate().for_each(|(i, value)| *value = of(i));
        Ok(Excess { mx: grid.mx, my: grid.my, values })
    }

    /// r of element i.
    pub fn at(&self, i: usize) -> f64 {
        self.values[i]
    }

    /// Calls `add(i, displacement by q)` for each element; with a sweep, in a step of steady rolling.
    pub fn add(&self, q: impl Fn(usize) -> Vector, sweep: Option<&Sweep>, mut add: impl FnMut(usize, Vector)) {
        for i in 0..self.values.len() {
            let here = self.displaced(&q, i);
            let there = sweep.map_or([0.0; 2], |sweep| self.ahead(&q, sweep, i));
            add(i, [here[0] - there[0], here[1] - there[1]]);
        }
    }

    /// For a step of transient rolling: subtracts from w the displacements by the previous tractions q, at the old place of each particle.
    pub fn subtract_ahead(&self, q: &[Vector], sweep: &Sweep, w: &mut [Vector]) {
        for (i, w) in w.iter_mut().enumerate() {
            let there = self.ahead(&|i| q[i], sweep, i);
            *w = [w[0] - there[0], w[1] - there[1]];
        }
    }

    fn displaced(&self, q: &impl Fn(usize) -> Vector, i: usize) -> Vector {
        q(i).map(|q| self.values[i] * q)
    }

    /// `r q` at the place of element i after a step.
    fn ahead(&self, q: &impl Fn(usize) -> Vector, sweep: &Sweep, i: usize) -> Vector {
        let mut sum = self.displaced(q, i).map(|v| sweep.own() * v);
        for &(in_x, in_y, weight) in sweep.neighbours() {
            let (x, y) = ((i % self.mx).wrapping_add_signed(in_x), (i / self.mx).wrapping_add_signed(in_y));
            if x < self.mx && y < self.my {
                let v = self.displaced(q, y * self.mx + x);
                sum = [sum[0] + weight * v[0], sum[1] + weight * v[1]];
            }
        }
        sum
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
    }
}
