//! The kernels of one depth: stresses at the offsets `(kx, ky) >= 0` by a unit load on one element.
//!
//! The method depends on the distance from the centre of the loaded element, in longer sides of an element:
//!
//! * below [`CLOSED_FORM_DISTANCE`], the closed form of [`element`](super::element), whose corner differences lose digits with the distance;
//! * below [`LEAST_DISTANCE`], concentrated forces at 4 x 4 Gauss points of the element;
//! * beyond, concentrated forces at the centres of elements, from which means over elements follow (see [`means`](crate::influence::means)). This
//!   takes one evaluation per element, without cancellation at any distance.

use super::body::{Body, Loaded};
use super::element;
use super::point_force::{self, Lanes, Values};
use crate::blocks::LANES;
use crate::error::Result;
use crate::influence::means::{in_x, in_y, HALO, LEAST_DISTANCE, ROWS};
use crate::influence::rule;
use crate::memory::zeros;

/// The distance below which the closed form is used, in longer sides of an element.
const CLOSED_FORM_DISTANCE: f64 = 12.0;

/// Whether the kernel of a load and a stress component is odd in x and in y.
pub fn is_odd(load: usize, component: usize) -> (bool, bool) {
    let (x, y) = match component {
        0..=2 => (false, false),
        3 => (true, true),
        4 => (true, false),
        _ => (false, true),
    };
    (x != (load == 1), y != (load == 2))
}

/// The kernels that are wanted, and the number of offsets.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// The loads that act.
    pub loaded: Loaded,
    /// The stress components that are wanted.
    pub components: [bool; 6],
    /// The number of offsets, from 0 on, in x and in y.
    pub offsets: (usize, usize),
}

impl Asked {
    /// The pairs (load, component) of all kernels, in the order in which they are stored.
    pub fn list(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let loads = (0..3).filter(|&load| self.loaded[load]);
        loads.flat_map(|load| (0..6).filter(|&c| self.components[c]).map(move |c| (load, c)))
    }

    /// The number of kernels.
    pub fn count(&self) -> usize {
        self.list().count()
    }

    /// The position of a kernel in the list; `None` if it is not wanted.
    pub fn place(&self, load: usize, component: usize) -> Option<usize> {
        self.list().position(|of| of == (load, component))
    }
}

/// The kernels of one depth, and the memory for their computation.
pub struct Kernels {
    /// The kernels that are wanted.
    asked: Asked,
    /// The tables of all kernels, `[kernel][ky][kx]`.
    tables: Vec<f64>,
    /// The stresses by concentrated forces along one row, `[kernel][place]`.
    points: Vec<f64>,
    /// The means in x of the last [`ROWS`] rows, `[kernel][row % ROWS][kx]`.
    means: Vec<f64>,
}

impl Kernels {
    /// Allocates memory for the wanted kernels.
    pub fn new(asked: Asked) -> Result<Kernels> {
        let (what, (mx, my)) = ("the kernels of a depth", asked.offsets);
        Ok(Kernels {
            asked,
            tables: zeros(asked.count() * mx * my, what)?,
            points: zeros(asked.count() * width(mx), what)?,
            means: zeros(asked.count() * ROWS * mx, what)?,
        })
    }

    /// The table `[ky][kx]` of a kernel; `None` if it is not wanted.
    pub fn table(&self, load: usize, component: usize) -> Option<&[f64]> {
        let n = self.asked.offsets.0 * self.asked.offsets.1;
        self.asked.place(load, component).map(|k| &self.tables[k * n..(k + 1) * n])
    }

    /// Computes all kernels at the depth z, in units of `body.unit()`.
    pub fn compute(&mut self, body: &Body, z: f64) {
        self.combine(body, &[(z, 1.0)]);
    }

    /// Computes weighted sums of kernels at several depths. `depths` has pairs of a depth, in units of `body.unit()`, and its weight.
    pub fn combine(&mut self, body: &Body, depths: &[(f64, f64)]) {
        self.fill_far(body, depths);
        let least = depths.iter().fold(f64::INFINITY, |least, (z, _)| z.min(least));
        if least < LEAST_DISTANCE {
            self.fill_near(body, depths, least);
        }
    }

    /// Fills the tables at all offsets with means from concentrated forces.
    fn fill_far(&mut self, body: &Body, depths: &[(f64, f64)]) {
        let ((mx, my), halo) = (self.asked.offsets, HALO as i64);
        for row in 0..my + 2 * HALO {
            self.fill_points(body, row as i64 - halo, depths);
            let (points, slot) = (self.points.chunks_exact(width(mx)), row % ROWS);
            for (points, means) in points.zip(self.means.chunks_exact_mut(ROWS * mx)) {
                in_x(points, &mut means[slot * mx..(slot + 1) * mx]);
            }
            if row >= 2 * HALO {
                let ky = row - 2 * HALO;
                for (table, means) in self.tables.chunks_exact_mut(mx * my).zip(self.means.chunks_exact(ROWS * mx)) {
                    in_y(means, ky + HALO, &mut table[ky * mx..(ky + 1) * mx]);
                }
            }
        }
    }

    /// Computes the stresses by concentrated forces at the offsets `-HALO..` of row ky.
    fn fill_points(&mut self, body: &Body, ky: i64, depths: &[(f64, f64)]) {
        let ((dx, dy), width) = (body.element(), width(self.asked.offsets.0));
        let y = ky as f64 * dy;
        for first in (0..width).step_by(LANES) {
            let x: Lanes = std::array::from_fn(|i| ((first + i) as f64 - HALO as f64) * dx);
            let mut values: Values = [[[0.0; LANES]; 6]; 3];
            for (z, factor) in depths {
                point_force::add(body, self.asked.loaded, (&x, y, *z), dx * dy * factor, &mut values);
            }
            for ((load, c), points) in self.asked.list().zip(self.points.chunks_exact_mut(width)) {
                points[first..first + LANES].copy_from_slice(&values[load][c]);
            }
        }
    }

    /// Replaces the values at offsets that are near at the smallest depth, `least`, by those of Gauss points and of the closed form.
    fn fill_near(&mut self, body: &Body, depths: &[(f64, f64)], least: f64) {
        let ((mx, my), (dx, dy)) = (self.asked.offsets, body.element());
        // The number of offsets in x with a distance below `distance`.
        let within = |distance: f64, y: f64, z: f64| {
            let x2 = distance * distance - y * y - z * z;
            if x2 > 0.0 {
                ((x2.sqrt() / dx).ceil() as usize).min(mx)
            } else {
                0
            }
        };
        for ky in 0..my {
            let y = ky as f64 * dy;
            let far = within(LEAST_DISTANCE, y, least);
            if far == 0 {
                break;
            }
            self.tables.chunks_exact_mut(mx * my).for_each(|table| table[ky * mx..ky * mx + far].fill(0.0));
            for &(z, factor) in depths {
                let near = within(CLOSED_FORM_DISTANCE, y, z);
                for kx in 0..near {
                    let values = element::stresses(body, self.asked.loaded, (kx as f64 * dx, y, z), (dx, dy));
                    self.add((kx, ky), |load, c| factor * values[load][c]);
                }
                for first in (near..far).step_by(LANES) {
                    let values = by_gauss(body, self.asked.loaded, (first as f64 * dx, y, z));
                    for kx in first..far.min(first + LANES) {
                        self.add((kx, ky), |load, c| factor * values[load][c][kx - first]);
                    }
                }
            }
        }
    }

    /// Adds `value(load, component)` to each table at one offset.
    fn add(&mut self, (kx, ky): (usize, usize), value: impl Fn(usize, usize) -> f64) {
        let (mx, my) = self.asked.offsets;
        for ((load, c), table) in self.asked.list().zip(self.tables.chunks_exact_mut(mx * my)) {
            table[ky * mx + kx] += value(load, c);
        }
    }
}

/// The number of places of a row with its halo, rounded up to whole lanes.
fn width(mx: usize) -> usize {
    (mx + 2 * HALO).next_multiple_of(LANES)
}

/// Stresses by unit loads on an element, by concentrated forces at its Gauss points. The positions are `(x, y, z)` and the following ones, one
/// element apart in x.
pub(super) fn by_gauss(body: &Body, loaded: Loaded, (x, y, z): (f64, f64, f64)) -> Values {
    let (dx, dy) = body.element();
    let mut values: Values = [[[0.0; LANES]; 6]; 3];
    for (sx, wx) in rule(4) {
        let x: Lanes = std::array::from_fn(|i| x + (i as f64 - (sx - 0.5)) * dx);
        for (sy, wy) in rule(4) {
            point_force::add(body, loaded, (&x, y - (sy - 0.5) * dy, z), dx * dy * wx * wy, &mut values);
        }
    }
    values
}

/// Stresses by unit loads on an element, at one position `(x, y, z)` relative to its centre.
pub(super) fn at(body: &Body, loaded: Loaded, (x, y, z): (f64, f64, f64)) -> [[f64; 6]; 3] {
    if x * x + y * y + z * z < CLOSED_FORM_DISTANCE * CLOSED_FORM_DISTANCE {
        return element::stresses(body, loaded, (x, y, z), body.element());
    }
    by_gauss(body, loaded, (x, y, z)).map(|of_load| of_load.map(|lanes| lanes[0]))
}

#[cfg(test)]
#[path = "../../tests/unit/stress_kernels.rs"]
mod tests;
