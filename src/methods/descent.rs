//! Projected descent: what takes over where a faster method goes round in circles. Every cycle lowers the energy
//! `(p, A p)/2 + (p, h - approach)`, so no state comes back.
//!
//! ```text
//! free elements: p > 0, or e < 0
//! r = -e on them               (prescribed force: of mean zero; the approach is the mean of h + u where p > 0)
//! t = r + beta t               conjugate to the last direction while the free elements stay the same
//! alpha = (r, t)/(t, A t)
//! p = p + alpha t              if that is nowhere negative; otherwise whichever of these has less energy:
//!     max(p + alpha t, 0)      scaled to carry a prescribed force
//!     p + alpha' t             alpha' < alpha: as far as p stays >= 0
//! ```
//!
//! The last of these always lowers the energy; the one before it moves many elements at once.

use super::norm::step::Displace;
use crate::contact::{norm_of_distance, State, Survey};
use crate::error::{Error, Result};
use crate::operator::reserve;
use crate::progress::{Monitor, Rule};
use crate::scene::Load;
use crate::solver::Stop;

/// Cycles without a new least residual after which round-off is reached.
const PATIENCE: u32 = 100;

/// Memory for solves, kept from one to the next.
#[derive(Default)]
pub struct Workspace {
    free: Vec<bool>,
    free_before: Vec<bool>,
    residual: Vec<f64>,
    t: Vec<f64>,
    /// A t.
    q: Vec<f64>,
    /// The change of p by a truncated step, and its product.
    change: Vec<f64>,
    product: Vec<f64>,
}

/// Solves from the state's pressures, if there are any; A must be symmetric.
pub fn solve(
    state: &mut State,
    mut by: Displace<'_>,
    rule: &Rule,
    workspace: &mut Workspace,
    monitor: &mut Monitor<'_>,
) -> Result<Stop> {
    let Workspace { free, free_before, residual, t, q, change, product } = workspace;
    for values in [&mut *residual, t, q, change, product] {
        values.clear();
        reserve(values, state.p.len(), "the workspace of projected descent")?;
        values.resize(state.p.len(), 0.0);
    }
    for elements in [&mut *free, free_before] {
        reserve(elements, state.p.len(), "the workspace of projected descent")?;
    }
    free_before.clear();
    refresh(state, &mut by, monitor);
    let mut u_is_product = true;
    let (mut least, mut since_least) = (f64::INFINITY, 0);
    // (r, r) of the last direction; 0: the next is conjugate to none.
    let mut last_rr = 0.0;
    let mut update = f64::INFINITY;
    loop {
        let ends = monitor.is_cancelled() || monitor.cycles >= rule.max_cycles || since_least > PATIENCE;
        if !u_is_product && (ends || holds(state, rule, update)) {
            refresh(state, &mut by, monitor);
            (u_is_product, last_rr) = (true, 0.0);
        }
        if u_is_product && holds(state, rule, update) {
            return Ok(Stop::Converged);
        }
        if ends {
            return Ok(if since_least > PATIENCE { Stop::Stagnated } else { Stop::interrupted(monitor) });
        }

        find_free(state, free, residual);
        if free != free_before {
            last_rr = 0.0;
            free_before.clone_from(free);
        }
        let rr = dot(residual, residual);
        let beta = if last_rr > 0.0 { rr / last_rr } else { 0.0 };
        t.iter_mut().zip(&*residual).for_each(|(t, r)| *t = r + beta * *t);
        (by.product)(t, q);
        monitor.count_products(1, by.work);
        let (rt, tq) = (dot(residual, t), dot(t, q));
        if rr > 0.0 && !(tq > 0.0) {
            return Err(Error::NotPositiveDefinite(format!(
                "influence coefficients: p'Ap is {tq} for some pressures p; it must be positive"
            )));
        }
        let alpha = if rr > 0.0 { rt / tq } else { 0.0 };

        let pairs = t.iter().zip(&state.p).filter(|(t, _)| **t < 0.0);
        let limit = pairs.map(|(t, p)| -p / t).fold(f64::INFINITY, f64::min);
        let full = limit >= alpha;
        last_rr = if full { rr } else { 0.0 };
        let mut length = alpha.min(limit);
        if !full {
            truncated_step(state, t, alpha, change);
            (by.product)(change, product);
            monitor.count_products(1, by.work);
            let feasible = length * (0.5 * length * tq - rt);
            // A change without force does not see the approach.
            let gain = |i: usize| change[i] * (state.deformed_distance(i) + 0.5 * product[i]);
            if (0..t.len()).map(gain).sum::<f64>() < feasible {
                std::mem::swap(t, change);
                std::mem::swap(q, product);
                length = 1.0;
            }
        }
        let changes = take_step(state, t, q, length);
        u_is_product = false;
        monitor.active_set_steps += 1;

        let relative = rr.sqrt() / norm_of_distance(state);
        since_least += 1;
        if relative < least {
            (least, since_least) = (relative, 0);
        }
        update = length * (dot(t, t) / state.contact_count().max(1) as f64).sqrt();
        monitor.cycle_done(&state.grid, changes, update, relative);
    }
}

/// p >= 0 that carries a prescribed force, C where p > 0, u = A p.
fn refresh(state: &mut State, by: &mut Displace<'_>, monitor: &mut Monitor<'_>) {
    state.p.iter_mut().for_each(|p| *p = if p.is_finite() { p.max(0.0) } else { 0.0 });
    state.balance_force();
    find_contact(state);
    (by.product)(&state.p, &mut state.u);
    monitor.count_products(1, by.work);
    state.fit_approach();
}

/// C = {p > 0}; returns how many elements changed sides.
fn find_contact(state: &mut State) -> u64 {
    let mut changes = 0;
    for (p, inside) in state.p.iter().zip(&mut state.contact) {
        changes += u64::from(*inside != (*p > 0.0));
        *inside = *p > 0.0;
    }
    changes
}

/// Whether the criterion holds and nothing penetrates, to the tolerance.
fn holds(state: &State, rule: &Rule, update: f64) -> bool {
    let survey = Survey::of(state);
    let scale = survey.distance / (survey.contact_count.max(1) as f64).sqrt();
    rule.holds(state, update) && survey.penetration <= rule.tolerance * scale
}

/// The free elements and r; r = 0 on the others.
fn find_free(state: &State, free: &mut Vec<bool>, residual: &mut [f64]) {
    free.clear();
    free.extend((0..state.p.len()).map(|i| state.p[i] > 0.0 || state.deformed_distance(i) < 0.0));
    loop {
        let (mut mean, mut count) = (0.0, 0.0);
        if let Load::Force(_) = state.load {
            for i in (0..free.len()).filter(|&i| free[i]) {
                mean -= state.deformed_distance(i);
                count += 1.0;
            }
            mean /= f64::max(count, 1.0);
        }
        let mut dropped = false;
        for i in 0..free.len() {
            residual[i] = if free[i] { -state.deformed_distance(i) - mean } else { 0.0 };
            // What would pull is not free, and the mean another one.
            if free[i] && state.p[i] == 0.0 && residual[i] <= 0.0 {
                (free[i], residual[i], dropped) = (false, 0.0, true);
            }
        }
        if !dropped || matches!(state.load, Load::Approach(_)) {
            return;
        }
    }
}

/// The change from p to max(p + alpha t, 0), scaled to carry a prescribed force.
fn truncated_step(state: &State, t: &[f64], alpha: f64, change: &mut [f64]) {
    let moved = |i: usize| (state.p[i] + alpha * t[i]).max(0.0);
    let factor = match state.load {
        Load::Approach(_) => 1.0,
        Load::Force(force) => force / state.grid.element_area() / (0..t.len()).map(moved).sum::<f64>(),
    };
    let factor = if factor.is_finite() { factor } else { 1.0 };
    change.iter_mut().enumerate().for_each(|(i, change)| *change = factor * moved(i) - state.p[i]);
}

/// p = p + length t, u = u + length A t, and the contact area with them. Returns how many elements changed sides.
fn take_step(state: &mut State, t: &[f64], q: &[f64], length: f64) -> u64 {
    for i in 0..t.len() {
        // What ends the step is at 0, whatever the rounding.
        let blocked = t[i] < 0.0 && state.p[i] <= -length * t[i];
        state.p[i] = if blocked { 0.0 } else { state.p[i] + length * t[i] };
        state.u[i] += length * q[i];
    }
    let changes = find_contact(state);
    state.fit_approach();
    changes
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::influence::{Coefficients, HalfSpace};
    use crate::operator::dense;

    /// A wavy punch, that makes elements leave and enter.
    fn state(load: Load, wave: f64) -> (Coefficients, State) {
        let grid = Grid::new(14, 11, 0.1, 0.1).expect("a grid");
        let h = |i: usize| 0.02 * (wave * (i % 14) as f64).sin() * (1.3 * (i / 14) as f64).cos();
        let h = (0..grid.len()).map(h).collect();
        let influence = Coefficients::from(HalfSpace::new(0.1, 0.1, 1.0));
        (influence, State::new(grid, h, load, 0.0).expect("a state"))
    }

    #[test]
    fn every_cycle_lowers_the_energy_until_the_conditions_hold() {
        let waves = (0..20).map(|k| 0.1 + 0.15 * f64::from(k));
        for (load, wave) in waves.flat_map(|wave| [(Load::Approach(0.015), wave), (Load::Force(0.02), wave)]) {
            let (influence, mut state) = state(load, wave);
            let grid = state.grid;
            let mut last = f64::INFINITY;
            let mut workspace = Workspace::default();
            for cycle in 0.. {
                assert!(cycle < 200, "{load:?}: no end");
                let mut product = |p: &[f64], u: &mut [f64]| dense::apply(&influence, &grid, p, u);
                let by = Displace { product: &mut product, work: 1.0, symmetric: true };
                let rule = Rule { tolerance: 1e-9, by_update: false, fixed: false, max_cycles: 1 };
                let mut monitor = Monitor::new(None, Vec::new(), false);
                let stop = solve(&mut state, by, &rule, &mut workspace, &mut monitor).expect("a solve");
                let distance = |i: usize| state.h[i] - if let Load::Approach(a) = load { a } else { 0.0 };
                let energy: f64 = (0..grid.len()).map(|i| state.p[i] * (0.5 * state.u[i] + distance(i))).sum();
                assert!(state.p.iter().all(|p| *p >= 0.0));
                if stop == Stop::Converged {
                    break;
                }
                // Some round-off of sums of 154 terms where the decrease is below that.
                assert!(energy < last + 1e-13 * last.abs(), "{load:?}, cycle {cycle}: {energy:e} after {last:e}");
                last = energy;
            }
            let survey = Survey::of(&state);
            assert!(survey.residual <= 1e-9 * survey.distance && survey.penetration <= 1e-9, "{survey:?}");
            assert!(state.contact_count() > 10 && state.contact_count() < 154, "{}", state.contact_count());
        }
    }

    #[test]
    fn it_takes_over_from_any_pressures() {
        for start in [0.0, -1.0, 1e6, f64::NAN] {
            let (influence, mut state) = state(Load::Force(0.05), 2.1);
            let grid = state.grid;
            state.p.fill(start);
            let mut product = |p: &[f64], u: &mut [f64]| dense::apply(&influence, &grid, p, u);
            let by = Displace { product: &mut product, work: 1.0, symmetric: true };
            let rule = Rule { tolerance: 1e-9, by_update: false, fixed: false, max_cycles: 1000 };
            let mut monitor = Monitor::new(None, Vec::new(), false);
            let stop = solve(&mut state, by, &rule, &mut Workspace::default(), &mut monitor).expect("a solve");
            assert_eq!(stop, Stop::Converged, "from {start}");
            assert!((state.force() - 0.05).abs() <= 1e-15);
        }
    }
}
