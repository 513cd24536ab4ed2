//! The multigrid-based algorithm (section 4.1 of the paper): one V-cycle per active-set step.

use super::Multigrid;
use crate::contact::{admit, certify, norm_of_distance, residual_norm, truncate, State};
use crate::error::Result;
use crate::operator::reserve;
use crate::progress::{Monitor, Rule};
use crate::scene::Load;
use crate::solver::Stop;

/// Cycles without a new smallest residual after which the method is given up.
const PATIENCE: u32 = 50;
/// Cycles in which the criterion holds but elements still change sides, after which the certificate decides.
const CHATTER: u32 = 5;

/// Memory for solves, kept from one to the next.
#[derive(Default)]
pub struct Workspace {
    residual: Vec<f64>,
    best: Best,
    unit: UnitApproach,
}

impl Workspace {
    /// Room for all that a solve on n elements needs.
    pub fn reserve(&mut self, n: usize) -> Result<()> {
        let Workspace { residual, best, unit } = self;
        for values in [residual, &mut best.p, &mut unit.response, &mut unit.product, &mut unit.ones] {
            reserve(values, n, "multigrid's workspace")?;
        }
        reserve(&mut best.contact, n, "multigrid's workspace")?;
        reserve(&mut unit.contact, n, "multigrid's workspace")
    }
}

/// Steps 2 to 6 on level `l`, from a state whose contact area is chosen (step 1) and whose u is A p.
pub fn solve(
    multigrid: &mut Multigrid,
    l: usize,
    state: &mut State,
    rule: &Rule,
    workspace: &mut Workspace,
    monitor: &mut Monitor<'_>,
) -> Stop {
    let Workspace { residual, best, unit } = workspace;
    residual.resize(state.p.len(), 0.0);
    best.begin(state);
    unit.begin();
    let mut chatter = 0;
    loop {
        if monitor.cycles >= rule.max_cycles {
            best.restore(state, multigrid, l);
            return Stop::IterationLimit;
        }
        // 2. p = 0 in E, and the system restricted to C.
        for (i, r) in residual.iter_mut().enumerate() {
            *r = if state.contact[i] { -state.deformed_distance(i) } else { 0.0 };
        }
        // 3. One multigrid cycle.
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
        let update = (update / state.contact_count().max(1) as f64).sqrt();
        // 4.1 Elements with p < 0 leave, then u = A p: in this order, or the loop cycles for ever.
        let mut changed = if rule.fixed { 0 } else { truncate(state) };
        let recursive = changed == 0 && unit.displace(multigrid.correction_product(l), &mut state.u);
        if !recursive {
            refresh(state, multigrid, l);
        }
        state.fit_approach();
        // Only a fresh product certifies.
        if recursive && rule.holds(state, update) {
            refresh(state, multigrid, l);
            state.fit_approach();
        }
        // 4.2 Elements with e <= 0 enter.
        changed += if rule.fixed { 0 } else { admit(state) };

        for level in 0..multigrid.depth() {
            let (products, work) = (multigrid.take_products(level), multigrid.hierarchy.work(level));
            if level == l {
                monitor.count_products(products, work);
            } else {
                monitor.count_work(products as f64 * work);
            }
        }
        monitor.active_set_steps += 1;
        let (r, h) = (residual_norm(state), norm_of_distance(state));
        let stuck = best.without_progress(state, r / h);
        if !monitor.cycle_done(&state.grid, changed as u64, update, r / h) {
            best.restore(state, multigrid, l);
            return Stop::Cancelled;
        }
        // 5. Go on if C has changed. 6. Go on if the accuracy is not reached.
        if rule.holds(state, update) {
            chatter += u32::from(changed > 0);
            let scale = h / (state.contact_count().max(1) as f64).sqrt();
            if changed == 0 || (chatter > CHATTER && certify(state).penetration <= rule.tolerance * scale) {
                return Stop::Converged;
            }
        }
        if stuck {
            best.restore(state, multigrid, l);
            return Stop::Stagnated;
        }
    }
}

/// u = A p, of pressures that carry the prescribed force.
fn refresh(state: &mut State, multigrid: &mut Multigrid, l: usize) {
    state.balance_force();
    multigrid.displace(l, &state.p, &mut state.u);
}

/// With a prescribed force: what one cycle makes of a unit approach, `response = B 1` with B the cycle. The change of
/// the approach that gives p + B r + amount * response the prescribed force is then a Newton step. A cycle that is not
/// linear is at least homogeneous, so amount * response is what it makes of that change; and where it lowers the
/// energy (v, A v)/2 - (1, v) from v = 0, the sum of the response is positive, so the step exists.
#[derive(Default)]
struct UnitApproach {
    /// The contact area that the response is for; empty: none yet.
    contact: Vec<bool>,
    /// Empty with a prescribed approach.
    response: Vec<f64>,
    /// A response; empty unless it is a by-product of the cycle.
    product: Vec<f64>,
    ones: Vec<f64>,
    amount: f64,
}

impl UnitApproach {
    fn begin(&mut self) {
        self.contact.clear();
        self.response.clear();
        self.product.clear();
    }

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

    /// u = u + A v + amount * A response, from `A v` if that is known; whether it is.
    fn displace(&self, product: Option<&[f64]>, u: &mut [f64]) -> bool {
        let Some(product) = product else { return false };
        u.iter_mut().zip(product).for_each(|(u, value)| *u += value);
        if self.amount.is_finite() {
            u.iter_mut().zip(&self.product).for_each(|(u, value)| *u += self.amount * value);
        }
        true
    }
}

/// The best iterate so far.
#[derive(Default)]
struct Best {
    residual: f64,
    since: u32,
    p: Vec<f64>,
    contact: Vec<bool>,
}

impl Best {
    fn begin(&mut self, state: &State) {
        (self.residual, self.since) = (f64::INFINITY, 0);
        self.p.clone_from(&state.p);
        self.contact.clone_from(&state.contact);
    }

    /// Notes an iterate; true when there has been no better one for too long, or this one is no longer a number.
    fn without_progress(&mut self, state: &State, residual: f64) -> bool {
        if residual < self.residual {
            self.residual = residual;
            self.since = 0;
            self.p.copy_from_slice(&state.p);
            self.contact.copy_from_slice(&state.contact);
        } else {
            self.since += 1;
        }
        self.since > PATIENCE || !residual.is_finite()
    }

    fn restore(&self, state: &mut State, multigrid: &mut Multigrid, l: usize) {
        state.p.copy_from_slice(&self.p);
        state.contact.copy_from_slice(&self.contact);
        multigrid.displace(l, &state.p, &mut state.u);
        state.fit_approach();
    }
}
