//! Writes the result of a solve: fields on the whole grid, in the caller's units, and the report.

use super::certificate::is_on_circle;
use super::forces::Forces;
use super::levels::Level;
use super::plane::{against, length, Vector};
use super::request::Request;
use super::solution::{resultant, Report, Solution, EXTERIOR, SLIP, STICK};
use super::solver::Solver;
use crate::effects::{Friction, Prescribed};
use crate::error::Result;
use crate::sums::in_blocks;

impl Solver {
    /// Writes the fields of the solution, and forces, moment, creepages and counts of the report.
    pub(super) fn write(&mut self, request: &Request<'_>, report: &mut Report) {
        let Request { pressure, friction, .. } = *request;
        let Solution { traction, slip, stick_slip, .. } = &mut self.solution;
        let (grid, scales, threads) = (self.grid, self.scales, self.threads.suited_to(self.grid.len()));
        let distance = friction.distance(&grid);
        let mut offset = [0.0; 2];
        if let (Some(window), Some(Level { problem, state, .. })) = (&self.window, self.levels.first()) {
            offset = scales.callers_displacement(problem.offset);
            self.offset = offset;
            // The elements of a row that carry pressure: their indices in the box, and their columns.
            let touching = |iy: usize| window.columns(iy).filter(move |(_, ix)| pressure[iy * grid.mx + ix] > 0.0);
            threads.for_each_row_pair((traction, grid.mx), (slip, grid.mx), |iy, traction, slip| {
                traction.fill([0.0; 2]);
                slip.fill([0.0; 2]);
                for (k, ix) in touching(iy) {
                    slip[ix] = scales.callers_displacement(problem.slip_at(k, &state.u));
                    traction[ix] = if problem.bound[k] > 0.0 {
                        scales.callers_traction(state.q[k])
                    } else {
                        against(slip[ix], request.bound(iy * grid.mx + ix))
                    };
                }
            });
            threads.for_each_plain_row(stick_slip, grid.mx, |iy, stick_slip| {
                stick_slip.fill(EXTERIOR);
                for (k, ix) in touching(iy) {
                    let i = iy * grid.mx + ix;
                    // A negligible bound was solved as 0, so that q = 0 is on its circle. Such an element sticks if its slip is 0.
                    let rests = problem.bound[k] == 0.0 && request.bound(i) > 0.0 && slip[i] == [0.0; 2];
                    stick_slip[ix] = if is_on_circle(state.q[k], problem.bound[k]) && !rests { SLIP } else { STICK };
                }
            });
            threads.for_each(&mut self.sums, |iy, sum| {
                let row = &stick_slip[iy * grid.mx..(iy + 1) * grid.mx];
                let count = |mark: i32| row.iter().filter(|each| **each == mark).count() as f64;
                (sum[0], sum[1]) = (count(STICK), count(SLIP));
            });
            let count = |k: usize| self.sums.iter().map(|sum| sum[k] as usize).sum();
            (report.certificate.stick_count, report.certificate.slip_count) = (count(0), count(1));
        } else {
            traction.fill([0.0; 2]);
            slip.fill([0.0; 2]);
            stick_slip.fill(EXTERIOR);
        }
        for (k, prescribed) in friction.prescribed.iter().enumerate() {
            report.creepage[k] = match prescribed {
                Prescribed::Creepage(creepage) => *creepage,
                Prescribed::Force(_) => offset[k] / distance,
            };
        }
        let tractions = |iy: usize| traction[iy * grid.mx..(iy + 1) * grid.mx].iter().copied().enumerate();
        (report.force, report.moment) = resultant(&grid, &threads, friction.spin_centre, tractions, &mut self.sums);
    }

    /// The error of given forces relative to mu N: see [`Report::missing`].
    pub(super) fn missing(&self, friction: &Friction<'_>, report: &Report) -> f64 {
        if report.carried > 0.0 {
            length(self.excess(friction, report)) / report.carried
        } else {
            0.0
        }
    }

    /// The forces of the last result less the given ones; 0 in directions with a given creepage. With weights forces are sums of weighted tractions.
    pub fn excess(&self, friction: &Friction<'_>, report: &Report) -> Vector {
        let force = |k: usize| match friction.weights {
            None => report.force[k],
            Some(weights) => {
                let terms = self.solution.traction.iter().zip(weights[k]).map(|(q, weight)| weight * q[k]);
                in_blocks(terms) * self.grid.element_area()
            }
        };
        [0, 1].map(|k| match friction.prescribed[k] {
            Prescribed::Force(given) => force(k) - given,
            Prescribed::Creepage(_) => 0.0,
        })
    }

    /// The largest factor by which the given forces can be multiplied so that tractions within the bounds still carry them. Below 1 the
    /// bounds do not carry the forces.
    pub fn part_in_reach(&self, request: &Request<'_>) -> Result<f64> {
        let limits = self.limits_before(request)?;
        let request = Request { limits: &limits, ..*request };
        Forces::part(request.friction, &self.grid, |i| request.bound(i))
    }
}
