//! A layer between the bodies whose compliance differs between elements. The influence coefficients contain its least compliance. Each element has an
//! excess r, which is its compliance less the least one, and this file adds the displacements by it:
//!
//! ```text
//! u_I += r_I q_I
//! u_I += (d (r q))_I           in steady rolling; (d v)(x) = v(x) - v(x + dq), interpolated between the centres
//! ```

use super::plane::Vector;
use super::sweep::Sweep;
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::zeros;

/// The excess r of the elements of a grid.
pub struct Excess {
    mx: usize,
    my: usize,
    values: Vec<f64>,
}

impl Excess {
    /// Stores the excess `of(i)` of each element i of a grid.
    pub fn new(grid: &Grid, of: impl Fn(usize) -> f64) -> Result<Excess> {
        let mut values: Vec<f64> = zeros(grid.len(), "the layer between the bodies")?;
        values.iter_mut().enumerate().for_each(|(i, value)| *value = of(i));
        Ok(Excess { mx: grid.mx, my: grid.my, values })
    }

    /// r of element i.
    pub fn at(&self, i: usize) -> f64 {
        self.values[i]
    }

    /// Calls `add(i, displacement)` for each element, with the displacement by tractions q, or with a sweep that of a step of steady rolling.
    pub fn add(&self, q: impl Fn(usize) -> Vector, sweep: Option<&Sweep>, mut add: impl FnMut(usize, Vector)) {
        for i in 0..self.values.len() {
            let here = self.displaced(&q, i);
            let there = sweep.map_or([0.0; 2], |sweep| self.ahead(&q, sweep, i));
            add(i, [here[0] - there[0], here[1] - there[1]]);
        }
    }

    /// For a step of transient rolling: subtracts the displacements by the previous tractions q from w, each at the place where the particle of an
    /// element was before the step.
    pub fn subtract_ahead(&self, q: &[Vector], sweep: &Sweep, w: &mut [Vector]) {
        for (i, w) in w.iter_mut().enumerate() {
            let there = self.ahead(&|i| q[i], sweep, i);
            *w = [w[0] - there[0], w[1] - there[1]];
        }
    }

    /// `r q` of element i.
    fn displaced(&self, q: &impl Fn(usize) -> Vector, i: usize) -> Vector {
        q(i).map(|q| self.values[i] * q)
    }

    /// `r q` at the point one step ahead of the centre of element i.
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
