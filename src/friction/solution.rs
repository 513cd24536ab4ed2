//! The result of a tangential solve.

use super::certificate::Certificate;
use super::law::Particle;
use super::plane::{dot, Vector};
use crate::grid::Grid;
use crate::threads::Threads;

/// An element outside C: see [`Solution::stick_slip`].
pub const EXTERIOR: i32 = 0;
/// An element that sticks.
pub const STICK: i32 = 1;
/// An element that slips.
pub const SLIP: i32 = 2;
/// An element that slips within a yielding layer, below mu p.
pub const PLASTIC: i32 = 3;

/// Fields on the whole grid.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// q, on body 1: 0 outside C.
    pub traction: Vec<Vector>,
    /// s of the step, body 1 over body 2, a length: 0 outside C.
    pub slip: Vec<Vector>,
    /// The state of each element: exterior 0, stick 1, slip 2, in a yielding layer 3.
    pub stick_slip: Vec<i32>,
    /// The state of the particles after the step: empty without a law or a yielding layer.
    pub particles: Vec<Particle>,
}

/// The measures of a result, and its cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// How well the conditions of friction hold.
    pub certificate: Certificate,
    /// `sum of q dx dy`, on body 1.
    pub force: Vector,
    /// `sum of (x qy - y qx) dx dy` about the centre of spin.
    pub moment: f64,
    /// Creepages: given, or found.
    pub creepage: Vector,
    /// If requested: derivatives of the force in x, in y and of the moment (rows) by xi, eta and phi (columns). Found creepages count as given.
    /// Pressures are fixed, except in solves of unlike bodies with the normal problem. None after a cancel.
    pub sensitivities: Option<[[f64; 3]; 3]>,
    /// mu N: the sum of the traction bounds, times the area of an element.
    pub carried: f64,
    /// rms over C of the last change of q; 0 if the iteration ended at its start.
    pub update: f64,
    /// The error of given forces, relative to mu N.
    pub missing: f64,
    /// Whether there were no tractions before the step.
    pub from_rest: bool,
    /// Force and creepages of the next coarser grid, in steady rolling from rest.
    pub coarser: Option<(Vector, Vector)>,
    /// Estimated errors of the force in each direction, or of the creepage if the force is prescribed; none: unknown.
    pub error: [Option<f64>; 2],
    /// The largest slope with which bounds fall with the slip, times an element's influence on itself; 0 without a law. From .5 on the iteration may
    /// stagnate; from 1 on a single element has several solutions.
    pub law_slope: f64,
    /// Products of two components on all grids, in products on the finest.
    pub products: f64,
    /// Seconds, with the set-up of operators.
    pub seconds: f64,
}

/// The force of tractions, and their moment about `centre`, relative to the middle of the grid. `row(iy)` gives the tractions of a row, each with
/// its column; `sums` has one value for each row.
pub fn resultant<I: Iterator<Item = (usize, Vector)>>(
    grid: &Grid,
    threads: &Threads,
    centre: Vector,
    row: impl Fn(usize) -> I + Sync + Send,
    sums: &mut [[f64; 3]],
) -> (Vector, f64) {
    let (Grid { mx, my, dx, dy }, area) = (*grid, grid.element_area());
    sums.fill([0.0; 3]);
    threads.for_each_plain_row(sums, 1, |iy, sum| {
        let y = (iy as f64 - 0.5 * (my as f64 - 1.0)) * dy - centre[1];
        for (ix, q) in row(iy) {
            let x = (ix as f64 - 0.5 * (mx as f64 - 1.0)) * dx - centre[0];
            let terms = [q[0], q[1], dot([-y, x], q)];
            sum[0] = [0, 1, 2].map(|k| sum[0][k] + area * terms[k]);
        }
    });
    let [x, y, moment] = sums.iter().fold([0.0; 3], |all, sum| [0, 1, 2].map(|k| all[k] + sum[k]));
    ([x, y], moment)
}
