//! The multigrid-based algorithm (section 4.1 of the paper) as a [`Step`] of the loop: one V-cycle.
//!
//! Here are step 2 of the paper, which restricts the equations to C, and step 3, the cycle. The loop makes steps (4.1) and (4.2), and decides whether
//! to go on.

use super::Multigrid;
use crate::contact::{AdmissibleSet, Freshness, State};
use crate::error::Result;
use crate::memory::reserve;
use crate::methods::{Change, Policy, Step, Task};
use crate::scene::Load;

/// The memory of cycles, which the next solve reuses.
#[derive(Default)]
pub struct Workspace {
    /// -e on C, 0 outside.
    residual: Vec<f64>,
    unit: UnitApproach,
}

/// V-cycles that start on level `level` of the grids.
pub struct Cycles<'a> {
    /// The grids.
    pub multigrid: &'a mut Multigrid,
    /// The level of the state's grid; 0 is the finest.
    pub level: usize,
    /// The memory of the cycles.
    pub workspace: &'a mut Workspace,
}

impl<S: AdmissibleSet> Step<S> for Cycles<'_> {
    fn name(&self) -> &'static str {
        "MULTIGRID"
    }

    fn policy(&self) -> Policy {
        Policy { exchanged_by_loop: true, step_is_cycle: true, chatter: 5, patience: 50, progress: 1.0 }
    }

    fn begin(&mut self, state: &State) -> Result<()> {
        let Workspace { residual, unit } = &mut self.workspace;
        for values in [residual, &mut unit.response, &mut unit.product, &mut unit.ones] {
            reserve(values, state.p.len(), "multigrid's workspace")?;
        }
        reserve(&mut unit.contact, state.p.len(), "multigrid's workspace")?;
        unit.forget();
        Ok(())
    }

    fn step(&mut self, task: &mut Task<'_, '_, S>) -> Result<Change> {
        let Task { state, monitor, .. } = task;
        let (multigrid, l) = (&mut *self.multigrid, self.level);
        let Workspace { residual, unit } = &mut *self.workspace;
        // 2. p = 0 in the exterior area, and the equations are restricted to C.
        residual.clear();
        residual.extend((0..state.p.len()).map(|i| if state.contact[i] { -state.deformed_distance(i) } else { 0.0 }));
        // 3. One multigrid cycle is made.
        if let Load::Force(force) = state.load {
            if unit.contact != state.contact {
                unit.find(multigrid, l, &state.contact);
            }
            let correction = multigrid.cycle(l, residual, &state.contact);
            let carried: f64 = state.p.iter().zip(correction).map(|(p, v)| p + v).sum();
            unit.amount = (force / state.grid.element_area() - carried) / unit.response.iter().sum::<f64>();
        } else {
            multigrid.cycle(l, residual, &state.contact);
        }
        let correction = multigrid.correction(l);
        let unit_response = |i: usize| if unit.amount.is_finite() { unit.amount * unit.response[i] } else { 0.0 };
        let mut update = 0.0;
        for (i, (p, v)) in state.p.iter_mut().zip(correction).enumerate() {
            let change = if unit.response.is_empty() { *v } else { v + unit_response(i) };
            *p += change;
            update += change * change;
        }
        let recursive = unit.displace(multigrid.correction_product(l), &mut state.u);
        state.u_is = if recursive { Freshness::Near } else { Freshness::Stale };
        for level in 0..multigrid.depth() {
            let (products, work) = (multigrid.take_products(level), multigrid.levels[level].work);
            if level == l {
                monitor.count_products(products, work);
            } else {
                monitor.count_work(products as f64 * work);
            }
        }
        monitor.count_work(multigrid.take_eliminations());
        let update = (update / state.contact_count().max(1) as f64).sqrt();
        Ok(Change { update, ..Change::default() })
    }
}

/// With a prescribed force: how one cycle responds to a unit change of the approach.
///
/// Let B be the cycle; the response is `B 1`. The approach changes by the `amount` with which p + B r + amount * response carries the prescribed
/// force, which is a Newton step for the approach. A nonlinear cycle is homogeneous, so amount * response is its response to that change. The cycle
/// lowers the energy (v, A v)/2 - (1, v) from v = 0, so the sum of the response is positive, and the step exists.
#[derive(Default)]
struct UnitApproach {
    /// The contact area to which the response belongs. Empty: there is no response yet.
    contact: Vec<bool>,
    /// The response B 1. Empty with a prescribed approach.
    response: Vec<f64>,
    /// A times the response. Empty unless the cycle computes it as a by-product.
    product: Vec<f64>,
    /// The right-hand side 1.
    ones: Vec<f64>,
    /// The change of the approach.
    amount: f64,
}

impl UnitApproach {
    /// Discards the response.
    fn forget(&mut self) {
        self.contact.clear();
        self.response.clear();
        self.product.clear();
    }

    /// Computes the response on a contact area by one cycle.
    fn find(&mut self, multigrid: &mut Multigrid, l: usize, contact: &[bool]) {
        fn copy<A: Copy>(from: &[A], to: &mut Vec<A>) {
            to.clear();
            to.extend_from_slice(from);
        }
        copy(contact, &mut self.contact);
        self.ones.resize(contact.len(), 1.0);
        copy(multigrid.cycle(l, &self.ones, contact), &mut self.response);
        copy(multigrid.correction_product(l).unwrap_or_default(), &mut self.product);
    }

    /// Sets u = u + A v + amount * A response, if `product` = A v is known. Returns whether it is.
    fn displace(&self, product: Option<&[f64]>, u: &mut [f64]) -> bool {
        let Some(product) = product else { return false };
        u.iter_mut().zip(product).for_each(|(u, value)| *u += value);
        if !self.response.is_empty() && self.amount.is_finite() {
            u.iter_mut().zip(&self.product).for_each(|(u, value)| *u += self.amount * value);
        }
        true
    }
}
