//! The result of a tangential solve: fields on the grid ([`Solution`]), and numbers ([`Report`]).

use super::certificate::Certificate;
use super::law::Particle;
use super::plane::{dot, Vector};
use crate::grid::Grid;
use crate::threads::Threads;

/// The value of [`Solution::stick_slip`] for an element outside C.
pub const EXTERIOR: i32 = 0;
/// The value for an element that sticks.
pub const STICK: i32 = 1;
/// The value for an element that slips, with a traction of mu p.
pub const SLIP: i32 = 2;
/// The value for an element whose layer yields, with a traction below mu p.
pub const PLASTIC: i32 = 3;

/// Fields on the whole grid.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// The traction q on body 1; 0 outside C.
    pub traction: Vec<Vector>,
    /// The slip s of body 1 over body 2 in the step, a length; 0 outside C.
    pub slip: Vec<Vector>,
    /// The state of each element: [`EXTERIOR`], [`STICK`], [`SLIP`] or [`PLASTIC`].
    pub stick_slip: Vec<i32>,
    /// The state of the particles after the step; empty without a law of friction and without a yielding layer.
    pub particles: Vec<Particle>,
}

/// Forces, creepages, residuals and cost of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// The residual and the gap, which tell how well the conditions of friction hold, and the numbers of elements that stick and slip.
    pub certificate: Certificate,
    /// The force on body 1, `sum of q dx dy`.
    pub force: Vector,
    /// The moment on body 1, `sum of (x qy - y qx) dx dy`, about the centre of spin.
    pub moment: f64,
    /// The creepages in x and y: those given, or those found for given forces.
    pub creepage: Vector,
    /// If requested: derivatives of the force in x, in y and of the moment (rows) by xi, eta and phi (columns). Found creepages count as given.
    /// Pressures are fixed, except in solves of unlike bodies with the normal problem. None after a cancel.
    pub sensitivities: Option<[[f64; 3]; 3]>,
    /// The largest force that friction carries, mu N: the sum of the traction bounds times the area of an element.
    pub carried: f64,
    /// The rms over C of the last change of q; 0 if the iteration ended at its start.
    pub update: f64,
    /// The difference between the forces of the result and the given ones, relative to mu N; 0 if no force is given.
    pub missing: f64,
    /// Whether there were no tractions before the step.
    pub from_rest: bool,
    /// The force and the creepages on the next coarser grid. Known in steady rolling from rest, if estimates are requested.
    pub coarser: Option<(Vector, Vector)>,
    /// The estimated error of the force in each direction, or of the creepage if the force is prescribed; none if it is unknown.
    pub error: [Option<f64>; 2],
    /// The largest slope with which bounds fall with the slip, times an element's influence on itself; 0 without a law. From .5 on the iteration may
    /// stagnate; from 1 on a single element has several solutions.
    pub law_slope: f64,
    /// The number of products with both components on all grids, counted in products on the finest grid.
    pub products: f64,
    /// The seconds of the solve, including the set-up of operators.
    pub seconds: f64,
}

/// The force of tractions, and their moment about `centre`, a point relative to the middle of the grid. `row(iy)` iterates over the tractions of a
/// row, each with its column. `sums` is scratch with one element for each row.
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
