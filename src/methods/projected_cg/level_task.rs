//! One run of the iteration on one grid.

use super::deflation::Last;
use super::inner::{in_either, Inner};
use super::level::Level;
use super::{Cycle, End};
use crate::contact::{AdmissibleSet, Freshness, State};
use crate::error::Result;
use crate::operator::Operator;
use crate::progress::{Goal, Monitor};

/// A state on one grid, and all that the iteration on it needs, except for the goal.
pub(super) struct LevelTask<'a, 'm, S> {
    pub(super) level: &'a mut Level,
    pub(super) state: &'a mut State,
    pub(super) set: S,
    /// The operator of the whole grid in double precision, if the problem has one.
    pub(super) whole: Option<&'a Operator<f64>>,
    /// The number of elements of the finest grid, which gives the work units of a product.
    pub(super) finest: usize,
    pub(super) monitor: &'a mut Monitor<'m>,
}

impl<S: AdmissibleSet> LevelTask<'_, '_, S> {
    /// Iterates on the window around the contact area. `displacement` tells how accurately the state's u equals A p. `last` is an earlier solution,
    /// which gives the deflation direction. Afterwards u is unknown outside the window.
    pub(super) fn run(&mut self, mut displacement: Freshness, last: Option<Last<'_>>, goal: &Goal) -> Result<End> {
        let LevelTask { level, state, set, whole, finest, monitor } = self;
        if displacement != Freshness::Exact {
            state.carry_force(*set, level.threads());
            if displacement == Freshness::Near && !state.has_displacements() {
                displacement = Freshness::Stale;
            }
        }
        let (grid, is_mean_free) = (state.grid, level.coefficients().is_mean_free());
        level.on_window((state, *set), displacement, *whole, |inner, window, units, state, set| {
            let work = state.grid.len() as f64 / *finest as f64;
            if displacement == Freshness::Near {
                in_either!(inner, inner => inner.correct(state, set));
            }
            if displacement != Freshness::Exact {
                in_either!(inner, inner => inner.displace(state));
                monitor.count_products(1, work);
            }
            let products = in_either!(inner, inner => inner.deflate_by_change(state, last, (window, grid.mx), units))?;
            monitor.count_products(products, work);
            let after_cycle = |cycle: &Cycle| {
                monitor.count_products(cycle.products, work);
                monitor.count.active_set_steps += 1;
                monitor.cycle_done(&grid, cycle.changes, cycle.update / units.pressure(), cycle.residual)
            };
            Ok(in_either!(inner, inner => inner.run(state, set, (goal, is_mean_free), after_cycle)))
        })?
    }

    /// Improves p by one step without a product, if u is known in all of the contact area. u must be near A p, and is unknown afterwards.
    pub(super) fn correct(&mut self) -> Result<()> {
        let LevelTask { level, state, set, whole, .. } = self;
        state.carry_force(*set, level.threads());
        if !state.has_displacements() {
            return Ok(());
        }
        level.on_window((state, *set), Freshness::Near, *whole, |inner, _, _, state, set| {
            in_either!(inner, inner => inner.correct(state, set));
        })
    }
}
