//! NORM (section 3 of the paper): an active set around an inner solve by conjugate gradients.

use super::{conjugate_gradients, minimal_residual, Inner, InnerStop};
use crate::contact::{admit, certify, norm_of_distance, residual_norm, truncate, ExchangeGuard, State};
use crate::error::Result;
use crate::operator::reserve;
use crate::progress::{Monitor, Rule};
use crate::scene::Load;
use crate::solver::Stop;

/// Restarts of an inner solve whose recursive residual was met but the true one was not.
const RESTARTS: u32 = 8;
/// Where an inner solve ends at round-off, violations of this size are round-off too.
const FLOOR: f64 = 1e-12;

/// Memory for solves, kept from one to the next.
#[derive(Default)]
pub struct Workspace {
    inner: super::Workspace,
    p: Vec<f64>,
    u: Vec<f64>,
    contact: Vec<bool>,
}

impl Workspace {
    /// Room for all that a solve on n elements needs.
    fn reserve(&mut self, n: usize) -> Result<()> {
        const NORM: &str = "NORM's workspace";
        reserve(&mut self.p, n, NORM)?;
        reserve(&mut self.u, n, NORM)?;
        reserve(&mut self.contact, n, NORM)?;
        self.inner.reserve(n)
    }
}

/// The operator as NORM sees it.
pub struct Displace<'a> {
    /// `product(p, u)`: u = A p.
    pub product: &'a mut dyn FnMut(&[f64], &mut [f64]),
    /// Work units of one product.
    pub work: f64,
    /// Whether A is symmetric: conjugate gradients, or else GMRES.
    pub symmetric: bool,
}

impl Displace<'_> {
    fn displace(&mut self, state: &mut State, monitor: &mut Monitor<'_>) {
        (self.product)(&state.p, &mut state.u);
        monitor.count_products(1, self.work);
        state.fit_approach();
    }
}

/// Solves from the state's contact area (step 1). If the state holds pressures (and u = A p), the first inner solve starts
/// from them; every further one starts from p = 0, as in the paper.
pub fn solve(
    state: &mut State,
    mut by: Displace<'_>,
    rule: &Rule,
    workspace: &mut Workspace,
    monitor: &mut Monitor<'_>,
) -> Result<Stop> {
    workspace.reserve(state.p.len())?;
    let mut guard = ExchangeGuard::default();
    let mut warm = state.p.iter().any(|p| *p != 0.0);
    // Restarts of this inner solve, and the true residual before the last.
    let (mut restarts, mut last_residual) = (0, f64::INFINITY);
    loop {
        // 2. The equations on the contact area.
        if !warm {
            state.p.fill(0.0);
            state.u.fill(0.0);
            if let Load::Force(_) = state.load {
                state.balance_force();
                by.displace(state, monitor);
            }
        }
        let inner = inner_solve(state, &mut by, rule, &mut workspace.inner, monitor)?;
        // Directions of mean zero leave the force as it is but for rounding, which many of them add up.
        state.balance_force();
        by.displace(state, monitor);
        monitor.active_set_steps += 1;
        if monitor.is_cancelled() || (monitor.cycles >= rule.max_cycles && !inner.met) {
            give_up(state, &mut by, rule, monitor);
            return Ok(Stop::interrupted(monitor));
        }

        // The recursive residual certifies nothing: if the true one is not met, go on from here.
        let holds = rule.holds(state, inner.update);
        let residual = residual_norm(state);
        let gains = residual < 0.5 * last_residual || rule.by_update;
        if !holds && gains && restarts < RESTARTS {
            (restarts, last_residual) = (restarts + 1, residual);
            warm = true;
            continue;
        }
        (restarts, last_residual) = (0, f64::INFINITY);
        // At the floor of round-off the contact area is found all the same, as well as it can be.
        let done = if holds { Stop::Converged } else { Stop::Stagnated };
        let tolerance = if holds { rule.tolerance } else { rule.tolerance.max(FLOOR) };
        if rule.fixed {
            return Ok(done);
        }

        // 3. The contact conditions.
        let violates = |state: &State, i: usize| {
            if state.contact[i] {
                state.p[i] < 0.0
            } else {
                state.deformed_distance(i) <= 0.0
            }
        };
        let violators = (0..state.p.len()).filter(|&i| violates(state, i)).count();
        // 4. Done if all hold.
        if violators == 0 {
            return Ok(done);
        }
        monitor.active_set_changes += violators as u64;
        if guard.allows_all(violators) {
            admit(state);
            truncate(state);
        } else if settled(state, &mut by, tolerance, workspace, monitor) {
            return Ok(done);
        } else if let Some(i) = (0..state.p.len()).rfind(|&i| violates(state, i)) {
            state.contact[i] = !state.contact[i];
            state.p[i] = 0.0;
        }
        if monitor.cycles >= rule.max_cycles {
            give_up(state, &mut by, rule, monitor);
            return Ok(Stop::IterationLimit);
        }
        warm = false;
    }
}

/// What is returned has no tension, carries the prescribed force, and has u = A p.
fn give_up(state: &mut State, by: &mut Displace<'_>, rule: &Rule, monitor: &mut Monitor<'_>) {
    if !rule.fixed {
        truncate(state);
    }
    state.balance_force();
    by.displace(state, monitor);
}

/// Whether the violations are within the tolerance: p truncated satisfies the equations, and nothing penetrates. If so the
/// truncated state stays; if not, the state is as it was.
fn settled(
    state: &mut State,
    by: &mut Displace<'_>,
    tolerance: f64,
    before: &mut Workspace,
    monitor: &mut Monitor<'_>,
) -> bool {
    before.p.clone_from(&state.p);
    before.u.clone_from(&state.u);
    before.contact.clone_from(&state.contact);
    let approach = state.approach;
    truncate(state);
    state.balance_force();
    by.displace(state, monitor);
    let h = norm_of_distance(state);
    let scale = h / (state.contact_count().max(1) as f64).sqrt();
    if residual_norm(state) <= tolerance * h && certify(state).penetration <= tolerance * scale {
        return true;
    }
    state.p.copy_from_slice(&before.p);
    state.u.copy_from_slice(&before.u);
    state.contact.copy_from_slice(&before.contact);
    state.approach = approach;
    false
}

fn inner_solve(
    state: &mut State,
    by: &mut Displace<'_>,
    rule: &Rule,
    workspace: &mut super::Workspace,
    monitor: &mut Monitor<'_>,
) -> Result<Inner> {
    if state.contact_count() == 0 {
        return Ok(Inner { met: true, ..Inner::default() });
    }
    let h = norm_of_distance(state);
    let stop = InnerStop {
        residual: if rule.by_update { 0.0 } else { rule.tolerance * h },
        update: if rule.by_update { rule.tolerance } else { 0.0 },
        iterations: (rule.max_cycles - monitor.cycles.min(rule.max_cycles)) as usize,
    };
    let (grid, mut products) = (state.grid, 0);
    let product = |p: &[f64], u: &mut [f64]| {
        products += 1;
        (by.product)(p, u);
    };
    let go_on = |update: f64, residual: f64| monitor.cycle_done(&grid, 0, update, residual / h);
    let inner = if by.symmetric {
        conjugate_gradients(state, stop, workspace, product, go_on)?
    } else {
        minimal_residual(state, stop, workspace, product, go_on)?
    };
    monitor.count_products(products, by.work);
    monitor.update = inner.update;
    Ok(inner)
}
