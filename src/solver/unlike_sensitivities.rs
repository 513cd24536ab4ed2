//! Derivatives of the tangential forces of unlike bodies by the creepages and the spin: both problems, linearised.
//!
//! At fixed C and slip area, with the load given, a change dw of the rigid slip changes tractions and pressures by
//!
//! ```text
//! (P A P + D) z = -P (dw + T dp + A mu dp n),    dq = z + mu dp n     on slip q follows its bound
//! Azz dp + L dq - d = 0 on C,    dp = 0 elsewhere, at a limit too       d = 0 with an approach given; else sum dp = 0
//! ```
//!
//! T dp is the sideways displacement by pressures, less that before the step; L dq is the displacement along the normal by tractions. Each
//! problem has a solver: the tangential one [with its pressures held](crate::friction::Report::sensitivities), the normal one on a given
//! contact area with the undeformed distance L dq. One after the other they make a map `dp -> M dp + b`. Its fixed point is found by
//! minimising the residual over all directions so far (Eisenstat, Elman and Schultz 1983): each turn reduces it by a factor of 4 to 30.

use super::options::Method;
use super::stages;
use super::tangential::{Tangent, Turn};
use super::unlike_bodies::UnlikeBodies;
use super::Solver;
use crate::contact::{Fixed, Freshness, State, Survey};
use crate::error::Result;
use crate::friction::{self, Vector};
use crate::memory::{copied, zeros};
use crate::methods::{Start, Task};
use crate::progress::{Criterion, Goal, Monitor};
use crate::scene::Load;
use crate::sums::dot;

/// Relative residual of the fixed point.
const TOLERANCE: f64 = 1e-6;
/// Relative residual of each normal problem.
const NORMAL_TOLERANCE: f64 = 1e-7;
/// Most turns.
const MOST_TURNS: usize = 30;
/// The name of this memory in messages.
const FIELDS: &str = "the sensitivities of unlike bodies";

/// Both problems, linear about the last result.
struct Linear<'a> {
    solver: &'a mut Solver,
    tangential: &'a mut friction::Solver,
    unlike: &'a mut UnlikeBodies,
    turn: &'a Turn<'a>,
    /// The state of the normal problem: h is L dq, p is dp.
    state: State,
    /// dw with T dp on entry, dq on return.
    tractions: Vec<Vector>,
    /// Products of one component.
    products: f64,
}

/// A direction dp of the pressures, and `left = dp - M dp`, which has norm 1: a step of s along dp reduces the residual by s times `left`.
struct Direction {
    dp: Vec<f64>,
    left: Vec<f64>,
}

impl Solver {
    /// See [`Report::sensitivities`](friction::Report::sensitivities).
    pub(super) fn add_sensitivities(
        &mut self,
        tangent: &mut Tangent,
        turn: &Turn<'_>,
        found: &mut friction::Report,
        monitor: &mut Monitor<'_>,
    ) -> Result<()> {
        let began = std::time::Instant::now();
        let Some((tangential, unlike)) = tangent.both() else { return Ok(()) };
        let window = self.methods.projected_cg.current_window();
        let (grid, n) = (self.problem.grid, self.problem.grid.len());
        let load = match self.state.load {
            Load::Approach(_) => Load::Approach(0.0),
            Load::Force(_) => Load::Force(0.0),
        };
        let mut state = State::new(grid, (load, 0.0), &self.problem.threads)?;
        state.contact.copy_from_slice(&self.state.contact);
        state.round_off = self.state.round_off;
        // dw is of the order of an element's displacement by the largest p, so that dp is of the order of p.
        let largest = self.state.p.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        let unit = largest * self.problem.self_influence();
        let tractions = zeros(n, FIELDS)?;
        let mut linear = Linear { solver: self, tangential, unlike, turn, state, tractions, products: 0.0 };
        let mut derivatives = [[0.0; 3]; 3];
        for by in 0..3 {
            let Some(column) = linear.column(by, unit, monitor)? else { break };
            derivatives.iter_mut().zip(column).for_each(|(row, value)| row[by] = value);
        }
        found.products += 0.5 * linear.products + linear.tangential.take_products();
        found.seconds += began.elapsed().as_secs_f64();
        self.methods.projected_cg.go_back_to(window);
        found.sensitivities = Some(derivatives).filter(|_| !monitor.is_cancelled());
        Ok(())
    }
}

impl Linear<'_> {
    /// The derivatives of both forces and of the moment by one creepage; none: the caller cancelled.
    fn column(&mut self, by: usize, unit: f64, monitor: &mut Monitor<'_>) -> Result<Option<[f64; 3]>> {
        let (grid, n, friction) = (self.turn.scene.grid, self.tractions.len(), self.turn.friction);
        let slip = |i: usize| friction.rigid_slip_by(&grid, i, by);
        let largest = (0..n).flat_map(slip).fold(0.0, |most: f64, w| most.max(w.abs()));
        let scale = unit / largest;
        if !(scale > 0.0 && scale.is_finite()) {
            return Ok(Some([0.0; 3]));
        }
        let rigid = Some((by, scale));
        let mut dp: Vec<f64> = zeros(n, FIELDS)?;
        let mut left: Vec<f64> = zeros(n, FIELDS)?;
        self.turn(rigid, &dp, &mut left)?;
        let first = norm(&left);
        let mut directions: Vec<Direction> = Vec::new();
        while directions.len() < MOST_TURNS && norm(&left) > TOLERANCE * first {
            if !monitor.uncounted_done(&grid, norm(&left) / first) {
                return Ok(None);
            }
            let Some(direction) = self.direction(&left, &directions)? else { break };
            let along = dot(&left, &direction.left);
            add(&mut dp, along, &direction.dp);
            add(&mut left, -along, &direction.left);
            directions.push(direction);
        }
        self.tractions(rigid, &dp)?;
        Ok(Some(self.tangential.resultant(friction.spin_centre, &self.tractions).map(|value| value / scale)))
    }

    /// The next direction, from the residual; none at round-off.
    fn direction(&mut self, residual: &[f64], directions: &[Direction]) -> Result<Option<Direction>> {
        let mut new = Direction { dp: copied(residual, FIELDS)?, left: zeros(residual.len(), FIELDS)? };
        self.turn(None, residual, &mut new.left)?;
        new.left.iter_mut().zip(residual).for_each(|(left, dp)| *left = dp - *left);
        for Direction { dp, left } in directions {
            let share = dot(&new.left, left);
            add(&mut new.left, -share, left);
            add(&mut new.dp, -share, dp);
        }
        let length = norm(&new.left);
        if !(length > 0.0 && length.is_finite()) {
            return Ok(None);
        }
        new.left.iter_mut().chain(&mut new.dp).for_each(|value| *value /= length);
        Ok(Some(new))
    }

    /// Solves both problems in turn: dq from a change `rigid` of the slip and from dp, then the change of the pressures from dq, written to `to`.
    fn turn(&mut self, rigid: Option<(usize, f64)>, dp: &[f64], to: &mut [f64]) -> Result<()> {
        self.tractions(rigid, dp)?;
        self.unlike.along_normal(&self.tractions, &mut self.state.h);
        self.pressures()?;
        to.copy_from_slice(&self.state.p);
        Ok(())
    }

    /// dq by a change of a creepage, if any, and by dp.
    fn tractions(&mut self, rigid: Option<(usize, f64)>, dp: &[f64]) -> Result<()> {
        let Turn { scene, friction, .. } = self.turn;
        self.tractions.fill([0.0; 2]);
        if let Some((by, scale)) = rigid {
            let slip = |i: usize| friction.rigid_slip_by(&scene.grid, i, by).map(|w| scale * w);
            self.tractions.iter_mut().enumerate().for_each(|(i, w)| *w = slip(i));
        }
        self.unlike.add_change(friction, dp, &mut self.tractions);
        self.tangential.change(friction, dp, &mut self.tractions)
    }

    /// dp on C, with the undeformed distance of the state.
    fn pressures(&mut self) -> Result<()> {
        let Linear { solver: Solver { problem, methods, set_up, .. }, state, turn, .. } = self;
        state.p.fill(0.0);
        state.u.fill(0.0);
        state.u_is = Freshness::Exact;
        let loaded = state.contact_count() > 0 && state.h.iter().any(|h| *h != 0.0);
        if !loaded {
            return Ok(());
        }
        state.fit_approach(&problem.threads);
        let survey = Survey::by(state, &problem.threads);
        let max_cycles = turn.options.max_cycles as u64;
        let goal = Goal { criterion: Criterion::Residual, tolerance: NORMAL_TOLERANCE, max_cycles };
        let mut own = Monitor::silent();
        let stages = stages::stages::<Fixed>(Method::Auto, problem.symmetric, set_up.without_multigrid.is_none());
        let mut task = Task { problem, state, lowest: 0.0, set: Fixed, goal, monitor: &mut own };
        methods.projected_cg.forget_windows();
        methods.solve(&mut task, (Start::Given, Some(survey)), stages, 0.0)?;
        task.count_products();
        self.products += own.count.work_units;
        Ok(())
    }
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn add(to: &mut [f64], share: f64, a: &[f64]) {
    to.iter_mut().zip(a).for_each(|(to, a)| *to += share * a);
}
