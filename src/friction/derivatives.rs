//! Derivatives of the last result by the pressures and the rigid slip, on the whole grid.
//!
//! The slip area is kept constant. Its tractions stay on the circles, whose radii change with the pressures: `dq = mu dp n + z` with `P z = z` (see
//! [`sensitivity`]). With dw, the change of w (which includes the change of the tangential displacements by pressures),
//!
//! ```text
//! (P A P + D) z = -P (dw + A mu dp n)
//! ```

use super::plane::Vector;
use super::sensitivity;
use super::shift::Memory;
use super::solution::resultant;
use super::solver::Solver;
use super::tangent::Side;
use crate::effects::Friction;
use crate::error::Result;
use crate::grid::Grid;

impl Solver {
    /// Computes the [`Report::sensitivities`](super::Report::sensitivities) with fixed pressures. None if `watch` cancels.
    pub(super) fn sensitivities(
        &mut self,
        friction: &Friction<'_>,
        watch: &mut dyn FnMut(&Grid, f64) -> bool,
    ) -> Result<Option<[[f64; 3]; 3]>> {
        let mut derivatives = [[0.0; 3]; 3];
        let (Some(window), Some(level)) = (&self.window, self.levels.first_mut()) else { return Ok(Some(derivatives)) };
        let mut is_cancelled = false;
        for by in 0..3 {
            let Memory { tangent, fields, .. } = &mut level.memory;
            if by == 0 {
                sensitivity::predict(&mut level.problem, &level.state, tangent)?;
            }
            let mut change = fields.take(level.state.q.len())?;
            for (k, i) in window.elements(&self.grid) {
                change[k] = self.scales.change(friction.rigid_slip_by(&self.grid, i, by));
            }
            let mut goes_on = |residual: f64| {
                is_cancelled = is_cancelled || !watch(&self.grid, residual);
                !is_cancelled
            };
            sensitivity::solve(
                &mut level.problem,
                tangent,
                (fields, &mut change),
                sensitivity::TOLERANCE,
                &mut goes_on,
            )?;
            let changes = |iy: usize| window.columns(iy).map(|(k, ix)| (ix, change[k]));
            let (force, moment) = {
                let threads = level.problem.threads();
                resultant(&self.grid, threads, friction.spin_centre, changes, &mut self.sums)
            };
            for (row, value) in derivatives.iter_mut().zip([force[0], force[1], moment]) {
                row[by] = value;
            }
            fields.give(change);
        }
        Ok(Some(derivatives).filter(|_| !is_cancelled))
    }

    /// Computes the change dq of the last tractions by a change `dp` of the pressures and a change dw of w. `change` holds dw on entry and dq on
    /// return. All arrays are on the whole grid.
    pub fn change(&mut self, friction: &Friction<'_>, dp: &[f64], change: &mut [Vector]) -> Result<()> {
        let limits = self.limits(friction, &self.particles_before)?;
        let (Some(window), Some(level)) = (&self.window, self.levels.first_mut()) else {
            change.fill([0.0; 2]);
            return Ok(());
        };
        let (problem, Memory { tangent, fields, .. }) = (&mut level.problem, &mut level.memory);
        sensitivity::predict(problem, &level.state, tangent)?;
        let n = level.state.q.len();
        // `slip` holds dw, then z; `by_bound` is mu dp n.
        let (mut slip, mut by_bound, mut displaced) = (fields.take(n)?, fields.take(n)?, fields.take(n)?);
        for (k, i) in window.elements(&self.grid) {
            // Where an ideal layer yields, the bound does not depend on the pressure.
            let bound = || self.scales.callers_traction([problem.bound[k], 0.0])[0];
            let yields = limits.get(i).is_some_and(|limit| bound() >= *limit);
            let dg = match tangent.side[k] {
                Side::Slip if !yields => friction.coefficient.at(i) * dp[i],
                _ => 0.0,
            };
            (slip[k], by_bound[k]) =
                (self.scales.change(change[i]), tangent.normal[k].map(|n| if dg == 0.0 { 0.0 } else { dg * n }));
        }
        let largest = by_bound.iter().flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
        if largest > 0.0 {
            problem.operators.multiply(&by_bound, largest, &mut displaced);
            slip.iter_mut().zip(&displaced).for_each(|(w, u)| *w = [w[0] + u[0], w[1] + u[1]]);
        }
        sensitivity::solve(problem, tangent, (fields, &mut slip), sensitivity::TOLERANCE, &mut |_| true)?;
        change.fill([0.0; 2]);
        for (k, i) in window.elements(&self.grid) {
            change[i] = [slip[k][0] + by_bound[k][0], slip[k][1] + by_bound[k][1]];
        }
        [slip, by_bound, displaced].into_iter().for_each(|field| fields.give(field));
        Ok(())
    }

    /// Returns the number of products on the finest grid since the last call of this function.
    pub fn take_products(&mut self) -> f64 {
        self.levels.first_mut().map_or(0, |level| level.problem.take_products()) as f64
    }

    /// The force of a field of tractions on the whole grid, and its moment about `centre`.
    pub fn resultant(&mut self, centre: Vector, field: &[Vector]) -> [f64; 3] {
        let (grid, threads) = (&self.grid, &self.threads.suited_to(self.grid.len()));
        let row = |iy: usize| field[iy * grid.mx..(iy + 1) * grid.mx].iter().copied().enumerate();
        let (force, moment) = resultant(grid, threads, centre, row, &mut self.sums);
        [force[0], force[1], moment]
    }
}
