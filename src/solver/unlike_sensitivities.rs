//! Derivatives of the tangential forces of unlike bodies by the creepages and the spin, from the linearised normal and tangential problems.
//!
//! The contact area C, the slip area and the load are fixed. A change dw of the rigid slip changes tractions and pressures by dq and dp:
//!
//! ```text
//! (P A P + D) z = -P (dw + T dp + A mu dp n),    dq = z + mu dp n     the tangential problem; where elements slip, q follows its bound
//! Azz dp + L dq - d = 0 on C,    dp = 0 outside and at a limit         the normal problem; d = 0 with a given approach, else sum dp = 0
//! ```
//!
//! P, D, z and n are those of the derivatives with fixed pressures (modules `derivatives` and `sensitivity` of `friction`). A and Azz are the
//! tangential and the normal influence, and d is the change of the approach. T dp is the sideways displacement by pressures, less that before the
//! step. L dq is the displacement along the normal by tractions.
//!
//! Each problem has a solver: the tangential one with fixed pressures, and the normal one on a given contact area with the undeformed distance L dq.
//! One after the other they define a map `dp -> M dp + b`. Its fixed point is computed by minimising the residual over all directions so far
//! (Eisenstat, Elman and Schultz 1983). Each turn reduces the residual by a factor of 4 to 30.

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

/// Relative residual at which the fixed point is accepted.
const TOLERANCE: f64 = 1e-6;
/// Relative residual of each normal problem.
const NORMAL_TOLERANCE: f64 = 1e-7;
/// Most directions, that is, turns after the first.
const MOST_TURNS: usize = 30;
/// The name of these arrays in messages.
const FIELDS: &str = "the sensitivities of unlike bodies";

/// The normal and the tangential problem, linearised about the last result.
struct Linear<'a> {
    solver: &'a mut Solver,
    tangential: &'a mut friction::Solver,
    unlike: &'a mut UnlikeBodies,
    turn: &'a Turn<'a>,
    /// The unknowns of the normal problem: its h is L dq, and its p is dp.
    state: State,
    /// dw + T dp before the tangential problem is solved, dq afterwards.
    tractions: Vec<Vector>,
    /// Products of the normal problem so far.
    products: f64,
}

/// A direction dp of the pressures, scaled so that `reduction = dp - M dp` has norm 1. A step of s along dp reduces the residual of the fixed point
/// by s times `reduction`.
struct Direction {
    dp: Vec<f64>,
    reduction: Vec<f64>,
}

impl Solver {
    /// Computes the derivatives of the forces and the moment by the creepages and the spin, and adds them to the report `found`. See
    /// [`Report::sensitivities`](friction::Report::sensitivities).
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
        // dw is scaled to the displacement of an element by the largest p, so that dp is of the order of p.
        let largest = self.state.p.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        let unit = largest * self.problem.self_influence();
        let tractions = zeros(n, FIELDS)?;
        let mut linear = Linear { solver: self, tangential, unlike, turn, state, tractions, products: 0.0 };
        let mut derivatives = [[0.0; 3]; 3];
        for motion in 0..3 {
            let Some(column) = linear.column(motion, unit, monitor)? else { break };
            derivatives.iter_mut().zip(column).for_each(|(row, value)| row[motion] = value);
        }
        // Products of the tangential problem have two components, so one of the normal problem counts as half.
        found.products += 0.5 * linear.products + linear.tangential.take_products();
        found.seconds += began.elapsed().as_secs_f64();
        self.methods.projected_cg.go_back_to(window);
        found.sensitivities = Some(derivatives).filter(|_| !monitor.is_cancelled());
        Ok(())
    }
}

impl Linear<'_> {
    /// The derivatives of both forces and of the moment by one `motion`: the creepages (0, 1) or the spin (2). None: the caller cancelled. `unit` is
    /// the size of dw during the computation.
    fn column(&mut self, motion: usize, unit: f64, monitor: &mut Monitor<'_>) -> Result<Option<[f64; 3]>> {
        let (grid, n, friction) = (self.turn.scene.grid, self.tractions.len(), self.turn.friction);
        let slip = |i: usize| friction.rigid_slip_by(&grid, i, motion);
        let largest = (0..n).flat_map(slip).fold(0.0, |most: f64, w| most.max(w.abs()));
        let scale = unit / largest;
        if !(scale > 0.0 && scale.is_finite()) {
            return Ok(Some([0.0; 3]));
        }
        let rigid = Some((motion, scale));
        // From dp = 0 the residual of the fixed point is b.
        let mut dp: Vec<f64> = zeros(n, FIELDS)?;
        let mut residual: Vec<f64> = zeros(n, FIELDS)?;
        self.turn(rigid, &dp, &mut residual)?;
        let first = norm(&residual);
        let mut directions: Vec<Direction> = Vec::new();
        while directions.len() < MOST_TURNS && norm(&residual) > TOLERANCE * first {
            if !monitor.uncounted_done(&grid, norm(&residual) / first) {
                return Ok(None);
            }
            let Some(direction) = self.direction(&residual, &directions)? else { break };
            let along = dot(&residual, &direction.reduction);
            add(&mut dp, along, &direction.dp);
            add(&mut residual, -along, &direction.reduction);
            directions.push(direction);
        }
        self.tractions(rigid, &dp)?;
        Ok(Some(self.tangential.resultant(friction.spin_centre, &self.tractions).map(|value| value / scale)))
    }

    /// The next direction: the residual, with its reduction made orthogonal to those of the directions so far. None if nothing remains but round-off.
    fn direction(&mut self, residual: &[f64], directions: &[Direction]) -> Result<Option<Direction>> {
        let mut new = Direction { dp: copied(residual, FIELDS)?, reduction: zeros(residual.len(), FIELDS)? };
        self.turn(None, residual, &mut new.reduction)?;
        new.reduction.iter_mut().zip(residual).for_each(|(reduction, dp)| *reduction = dp - *reduction);
        for Direction { dp, reduction } in directions {
            let share = dot(&new.reduction, reduction);
            add(&mut new.reduction, -share, reduction);
            add(&mut new.dp, -share, dp);
        }
        let length = norm(&new.reduction);
        if !(length > 0.0 && length.is_finite()) {
            return Ok(None);
        }
        new.reduction.iter_mut().chain(&mut new.dp).for_each(|value| *value /= length);
        Ok(Some(new))
    }

    /// Computes `M dp`, plus b if `rigid` is a change of the rigid slip: solves for dq from dp and that change, then for the pressures from dq.
    fn turn(&mut self, rigid: Option<(usize, f64)>, dp: &[f64], to: &mut [f64]) -> Result<()> {
        self.tractions(rigid, dp)?;
        self.unlike.along_normal(&self.tractions, &mut self.state.h);
        self.pressures()?;
        to.copy_from_slice(&self.state.p);
        Ok(())
    }

    /// Computes dq from dp and from a change of the rigid slip: `scale` times that of a unit of the motion (a creepage or the spin), if any.
    fn tractions(&mut self, rigid: Option<(usize, f64)>, dp: &[f64]) -> Result<()> {
        let Turn { scene, friction, .. } = self.turn;
        self.tractions.fill([0.0; 2]);
        if let Some((motion, scale)) = rigid {
            let slip = |i: usize| friction.rigid_slip_by(&scene.grid, i, motion).map(|w| scale * w);
            self.tractions.iter_mut().enumerate().for_each(|(i, w)| *w = slip(i));
        }
        self.unlike.add_change(friction, dp, &mut self.tractions);
        self.tangential.change(friction, dp, &mut self.tractions)
    }

    /// Solves the normal problem on C with the undeformed distance in the state.
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
        let mut inner_monitor = Monitor::silent();
        let stages = stages::stages::<Fixed>(Method::Auto, problem.symmetric, set_up.without_multigrid.is_none());
        let mut task = Task { problem, state, lowest: 0.0, set: Fixed, goal, monitor: &mut inner_monitor };
        methods.projected_cg.forget_windows();
        methods.solve(&mut task, (Start::Given, Some(survey)), stages, 0.0)?;
        task.count_products();
        self.products += inner_monitor.count.work_units;
        Ok(())
    }
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn add(to: &mut [f64], share: f64, a: &[f64]) {
    to.iter_mut().zip(a).for_each(|(to, a)| *to += share * a);
}
