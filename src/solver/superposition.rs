//! Where a shift from rest starts if nu = 0: at the pressures p* of a smaller load.
//!
//! ```text
//! q = mu (p - p*) t       p* by the approach less |w|/mu, or by the force less |F|/mu;   t: opposite to the shift w, or along F
//! ```
//!
//! With nu = 0 tractions along t displace along t as pressures do along the normal. Where p* touches, p and p* displace by the same but
//! for a constant, which q makes of it: that sticks. The rest of C has `q = mu p t`, and it slips. So this is the solution, for any surface (Cattaneo
//! 1938 and Mindlin 1949 for balls; Jager 1998 and Ciavarella 1998), and a certificate as any other decides on it. With another nu
//! the residual is some 5 % of nu, and the coarser grids find a better start for the same work.
//!
//! What p leaves of its own conditions goes into the distance, so that it leaves nothing in the slip. What q displaces is a fresh product of the
//! normal problem's operator.

use std::time::Instant;

use super::tangential::Turn;
use super::{Outcome, Solver};
use crate::contact::{lowest, NonNegative, State};
use crate::effects::{Coefficient, Motion, Prescribed, Previous};
use crate::error::{Error, Result};
use crate::friction::{rest, Compliance, Start, Superposed, Vector};
use crate::grid::Grid;
use crate::memory::blank;
use crate::methods::{Step, Task};
use crate::progress::{Criterion, Goal, Monitor, Progress};
use crate::scene::Load;

/// A shift that takes less than this part of the depth away is not worth it: p - p* loses digits.
const LEAST: f64 = 0.01;
/// The residual of the smaller load is relative to its displacements, which are this part of its depth or less.
const DISPLACED: f64 = 0.8;
/// Where the shift's residual is above the tolerance all the same, the smaller load goes on to such a part of it.
const MARGIN: f64 = 0.5;
/// And at most so large: a coarse solution tells nothing.
const COARSEST: f64 = 0.01;
/// Iterations at most.
const MOST: u64 = 60;

/// p is reached but for this part: whichever way q is rounded, it is within its bound.
const ROUNDED: f64 = 16.0 * f64::EPSILON;

/// What the smaller load leaves, and what it cost.
pub struct Smaller {
    /// `p - p*`, within -p and p.
    carried: Vec<f64>,
    /// What these pressures displace.
    displaced: Vec<f64>,
    along: Vector,
    offset: Vector,
    /// In products of two components: two of one component count as one.
    pub products: f64,
    pub seconds: f64,
}

impl Smaller {
    /// The start that they make.
    pub fn start(&self) -> Start<'_> {
        let Smaller { carried, displaced, along, offset, .. } = self;
        Start::Superposed(Superposed { carried, displaced, along: *along, offset: *offset })
    }
}

/// What a scene shifts by.
struct Push {
    mu: f64,
    /// t.
    direction: Vector,
    /// `|w|/mu`, or `|F|/mu`.
    less: f64,
    by_force: bool,
}

impl Push {
    /// Of a shift from rest in one direction, with nothing that the superposition does not know.
    fn of(turn: &Turn<'_>) -> Option<Push> {
        let (scene, friction) = (turn.scene, turn.friction);
        let Coefficient::Uniform(mu) = friction.coefficient else { return None };
        let is_known = friction.motion == Motion::Shift
            && friction.previous == Previous::None
            && friction.spin == 0.0
            && friction.initial.is_none()
            && friction.weights.is_none()
            && friction.rigid_slip.is_none()
            && friction.influence.is_none()
            && friction.compliance == Coefficient::Uniform(0.0)
            && scene.influence.is_none()
            && scene.layer.is_none()
            && scene.pressure_limit.is_none()
            && !turn.options.is_fixed()
            && Compliance::of(&scene.bodies).poisson == 0.0;
        let by_force = friction.prescribed.iter().any(|given| matches!(given, Prescribed::Force(_)));
        let push = friction.prescribed.map(|given| match given {
            Prescribed::Force(force) => force,
            Prescribed::Creepage(shift) => -shift,
        });
        let is_mixed = |(given, push): (&Prescribed, f64)| matches!(given, Prescribed::Creepage(_)) && push != 0.0;
        if !is_known || by_force && friction.prescribed.iter().zip(push).any(is_mixed) {
            return None;
        }
        let length = push[0].hypot(push[1]);
        let less = length / mu;
        (less.is_finite() && less > 0.0).then(|| Push { mu, direction: push.map(|push| push / length), less, by_force })
    }
}

impl Solver {
    /// The smaller load of a scene whose normal problem ended with `stop`; none where the superposition says nothing.
    pub(super) fn smaller_load(
        &mut self,
        turn: &Turn<'_>,
        stop: Outcome,
        monitor: &mut Monitor<'_>,
    ) -> Result<Option<Smaller>> {
        let began = Instant::now();
        let Some(push) = Push::of(turn).filter(|_| stop == Outcome::Converged && self.problem.symmetric) else {
            return Ok(None);
        };
        let depth = self.state.approach - lowest(&self.state.h);
        let (load, sunk) = if push.by_force {
            let force = self.state.force();
            let part = push.less / force;
            if !(part < 1.0) {
                return Ok(None);
            }
            // A ball's; it only sets the tolerance.
            (Load::Force(force - push.less), 2.0 / 3.0 * part * depth)
        } else {
            (Load::Approach(self.state.approach - push.less), push.less.min(depth))
        };
        if !(sunk >= LEAST * depth) {
            return Ok(None);
        }
        let mut state = self.without_residual(load)?;
        let what = "the tractions of a smaller load";
        let n = state.p.len();
        let (mut carried, mut displaced) = (blank(n, f64::NAN, what)?, blank(n, f64::NAN, what)?);
        let (mut products, mut slid) = (0.0, push.less);
        let mut tolerance = (turn.options.tolerance * sunk / (DISPLACED * (depth - sunk))).min(COARSEST);
        for begun in [false, true] {
            if sunk < depth {
                products += match self.solve_smaller((&mut state, begun), tolerance, monitor) {
                    // By round-off; the coarser grids of the tangential problem start it then.
                    Err(Error::NotPositiveDefinite(_)) => return Ok(None),
                    work => 0.5 * work?,
                };
            } else {
                state.unload();
            }
            if push.by_force {
                slid = self.state.approach - state.approach;
            }
            let residual = self.carry(&state.p, slid, &mut carried, &mut displaced)?;
            products += 0.5 * self.problem.take_products() as f64;
            if residual < turn.options.tolerance || sunk >= depth || monitor.is_cancelled() {
                break;
            }
            tolerance *= MARGIN * (turn.options.tolerance / residual).min(1.0);
        }
        let along = push.direction.map(|t| push.mu * t);
        let offset = along.map(|along| if push.by_force { -along * slid } else { 0.0 });
        let seconds = began.elapsed().as_secs_f64();
        Ok(Some(Smaller { carried, displaced, along, offset, products, seconds }))
    }

    /// `p - p*` and its displacements; the residual of a shift of mu `slid` by them, as the certificate has it.
    fn carry(&mut self, smaller: &[f64], slid: f64, carried: &mut [f64], displaced: &mut [f64]) -> Result<f64> {
        for ((carried, p), smaller) in carried.iter_mut().zip(&self.state.p).zip(smaller) {
            let most = p.max(0.0) * (1.0 - ROUNDED);
            *carried = (p - smaller).clamp(-most, most);
        }
        self.problem.displace(carried, displaced)?;
        let (mut left, mut squares, mut count) = (0.0, 0.0, 0.0);
        for ((p, carried), u) in self.state.p.iter().zip(&*carried).zip(&*displaced).filter(|((p, _), _)| **p > 0.0) {
            left += rest([u - slid, 0.0], [*carried, 0.0], *p);
            (squares, count) = (squares + u * u, count + 1.0);
        }
        Ok((left / count).sqrt() / f64::max((squares / count).sqrt(), slid))
    }

    /// The state of another load, with the distance of which p is the exact solution.
    fn without_residual(&self, load: Load) -> Result<State> {
        let State { grid, h, u, contact, approach, round_off, .. } = &self.state;
        let mut state = State::new(*grid, (load, *approach), &self.problem.threads)?;
        let known = h.iter().zip(u).zip(contact);
        for (distance, ((h, u), inside)) in state.h.iter_mut().zip(known) {
            *distance = if *inside { approach - u } else { *h };
        }
        state.round_off = *round_off;
        state.forget();
        Ok(state)
    }

    /// Solves the smaller load, which nobody certifies: the certificate of the tractions does. Returns the products that it took.
    fn solve_smaller(
        &mut self,
        (state, begun): (&mut State, bool),
        tolerance: f64,
        monitor: &mut Monitor<'_>,
    ) -> Result<f64> {
        let finest = self.problem.grid;
        let mut tell = |progress: &Progress| {
            let grid = Grid { mx: progress.mx, my: progress.my, ..finest };
            !monitor.tangential_done(&grid, progress.residual)
        };
        let mut own = Monitor::new(Some(&mut tell), Vec::new(), false);
        let goal = Goal { criterion: Criterion::Residual, tolerance, max_cycles: MOST };
        let lowest = lowest(&state.h);
        let mut task = Task { problem: &mut self.problem, state, lowest, set: NonNegative, goal, monitor: &mut own };
        let method = &mut self.methods.projected_cg;
        match begun {
            // Its displacements are those of sums of directions in single precision.
            true => task.problem.refresh(task.state, NonNegative)?,
            false => method.start(&mut task)?,
        }
        method.step(&mut task)?;
        task.count_products();
        Ok(own.count.work_units)
    }
}
