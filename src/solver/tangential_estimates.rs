//! Estimated errors of the tangential forces, from a solve from rest on one grid.
//!
//! *Shift.* With a parabola's pressures the force of a shift is the difference of two normal forces, that on C and that on the stick area
//! (Jager 1997; Ciavarella 1998). The approaches of both have an error of the same part of the bend of h within an element ([`estimates`]),
//! so that most of it cancels. The error from the outline of the contact remains, which is larger with fewer elements across:
//!
//! ```text
//! e = SHIFT_ERROR bend/depth (1 + (OUTLINE_CHORD/elements across)^2) mu N
//! ```
//!
//! *Steady rolling* is of first order in the step: the difference to the next coarser grid of the nested iteration, with these pressures, is
//! about the error (with spin half of it), `e = ROLLING_FACTOR |F - F_coarse|`, plus a part of the above.
//!
//! *With a given approach* the error e_N of the normal force adds to the tangential one: `mu e_N` in full slip, else less,
//! `mu e_N (1 - (1 - F/(mu N))^(1/3))` with a parabola's pressures. Jumps of the surface, as those of punches, add `F/N` times their part of e_N.
//!
//! *Where the surface ends within the contact*, or coefficients jump ([`at_ends`]), tractions are singular like pressures, and the error of the
//! force is that of the normal one with the traction in place of the pressure. If the normal force is given, this part goes to 0 towards full
//! slip.
//!
//! *Where mu jumps* the jump lies anywhere between two centres, and with it that of `mu p` on slip ([`at_jumps`]).
//!
//! With a prescribed force the creepage has the error `e/(dF/dxi)`, with `dF/dxi = (F/xi) (1 - F/(mu N))^(1/3)`, which
//! is that of Cattaneo's and of Carter's curve or less. A residual R adds an error of at most R mu N
//! (docs/friction.md). SHIFT_ERROR, OUTLINE_CHORD and ROLLING_FACTOR are measured on balls and ellipses of 7 to 54
//! elements across (docs/notes/2026-11-friction.md) and tested (`tests/friction/estimates.rs`). They hold for flat
//! punches and jumps of mu on 11 to 68 elements across.
//!
//! [`estimates`]: super::estimates

use super::estimates::{at_ends, at_jumps, Curvature, Parts, LEAST_CHORD};
use crate::contact::{Outline, Problem, State};
use crate::effects::Coefficient;
use crate::friction::{Report, Solution, Vector, SLIP};
use crate::rectangle::Rectangle;
use crate::scene::{Friction, Load, Motion, Prescribed};
use crate::sums::in_blocks;

/// Relative error of the force of a shift, over the bend relative to the depth.
const SHIFT_ERROR: f64 = 0.3;
/// Elements across at which the outline's error equals the rest.
const OUTLINE_CHORD: f64 = 13.0;
/// Factors in steady rolling: on the difference to the coarser grid and on the error of a shift, on the difference in the other direction.
const ROLLING_FACTOR: f64 = 3.0;
const ACROSS_FACTOR: f64 = 0.25;
/// Factor for shifts of unlike bodies, measured up to 3.4 times the estimate: pressures displace sideways, so force and creepage do not
/// vanish together.
const UNLIKE_FACTOR: f64 = 8.0;
/// Factor for shifts of coated bodies, measured up to 1.5 times the estimate: neither parabola nor half-space.
const COATED_FACTOR: f64 = 2.0;
/// With a given normal force, the factor on errors at ends is this times `(1 - F/(mu N))^(1/3)`, at most 1.
const BEFORE_SLIP: f64 = 2.0;

/// Errors are parts of mu N, or of this factor times the sum of the tractions if that is less: tractions of glued elements do not reach their bounds,
/// and are linear in the motion.
const WITHIN_REACH: f64 = 50.0;
/// Factor on second differences of directions in a shift with spin; 1/24 is that of a smooth integrand. Errors were up to .7 times this.
const TURN_FACTOR: f64 = 0.0625;

/// A solved scene with friction.
pub struct Solved<'a> {
    /// The normal problem, its state and its outline.
    pub problem: &'a Problem,
    pub state: &'a State,
    pub outline: &'a Outline,
    /// Its curvature, and the parts of its error.
    pub curvature: &'a Curvature,
    pub parts: Option<Parts>,
    pub friction: &'a Friction<'a>,
    /// Tractions and slip.
    pub solution: &'a Solution,
    /// Whether the bodies are alike.
    pub alike: bool,
    /// Whether the bodies have a coating.
    pub coated: bool,
}

/// Errors of the tangential force in each direction, or of the creepage where the force is prescribed; none: not known.
pub fn estimate(solved: &Solved<'_>, found: &Report) -> [Option<f64>; 2] {
    let unknown = [None; 2];
    let &Solved { state, outline, curvature, friction, alike, coated, .. } = solved;
    let count = state.contact_count();
    let chord = outline.chord(count, solved.problem.coefficients.repeats(&state.grid));
    let is_plain = friction.compliance == Coefficient::Uniform(0.0) && friction.weights.is_none();
    if !is_plain || !is_known_with_law(friction) || count == 0 || !(chord >= LEAST_CHORD) || !(curvature.depth > 0.0) {
        return unknown;
    }
    let Some(parts) = solved.parts else { return unknown };
    let widened = 1.0 + (OUTLINE_CHORD / chord).powi(2);
    let carried = found.carried.min(WITHIN_REACH * solved.tractions());
    let of_shift = SHIFT_ERROR * curvature.bend.abs() / curvature.depth * widened * carried;
    let hidden = found.certificate.residual * carried;
    let force = found.force[0].hypot(found.force[1]);
    let creepage = found.creepage[0].hypot(found.creepage[1]);
    // (1 - F/(mu N))^(1/3)
    let stuck = (1.0 - force / found.carried).max(f64::EPSILON).cbrt();
    // dxi/dF
    let compliance = creepage / force / stuck;
    let differences = match (friction.motion, found.coarser) {
        (Motion::Shift, _) if found.from_rest => [[0.0; 2]; 2],
        (Motion::SteadyRolling, Some((force, creepage))) if alike => {
            let is_found = friction.has_forces();
            let of_creepage = |k: usize| if is_found[k] { (found.creepage[k] - creepage[k]).abs() } else { 0.0 };
            [[0, 1].map(|k| (found.force[k] - force[k]).abs()), [0, 1].map(of_creepage)]
        }
        _ => return unknown,
    };
    let part = match friction.motion {
        Motion::Shift if coated => COATED_FACTOR,
        Motion::Shift if alike => 1.0,
        Motion::Shift => UNLIKE_FACTOR,
        _ => ROLLING_FACTOR,
    };
    let ends = solved.ends(&parts, stuck);
    // A punch has F/(mu N) of it; a parabola 1 - (1 - F/(mu N))^(1/3), here without cancellation.
    let of_jumps = force / found.carried;
    let slipped = [of_jumps, of_jumps / (1.0 + stuck + stuck * stuck)];
    let more = solved.by_the_normal_force(&parts, found.carried, slipped) + solved.jumps() + solved.turns();
    [0, 1].map(|k| {
        let at_least = |of: Vector| of[k].max(ACROSS_FACTOR * of[1 - k]);
        let of_surface = part * of_shift + at_least(ends) + more;
        let error = match friction.prescribed[k] {
            Prescribed::Creepage(_) => ROLLING_FACTOR * at_least(differences[0]) + of_surface + hidden,
            Prescribed::Force(_) => ROLLING_FACTOR * at_least(differences[1]) + (of_surface + hidden) * compliance,
        };
        error.is_finite().then_some(error)
    })
}

/// Whether the law of friction, if there is one, allows an estimate: of a shift by creepages. Near the largest force of a falling coefficient errors
/// of the creepage were up to 1.5 times the estimate. In steady rolling no coarser grid is solved with the law.
fn is_known_with_law(friction: &Friction<'_>) -> bool {
    let by_creepages = friction.has_forces() == [false; 2];
    !friction.has_law() || friction.motion == Motion::Shift && by_creepages
}

impl Solved<'_> {
    /// The sum of the tractions of all elements, as a force.
    fn tractions(&self) -> f64 {
        in_blocks(self.solution.traction.iter().map(|q| q[0].hypot(q[1]))) * self.state.grid.element_area()
    }

    /// The error from ends of the surface, in each direction. `stuck`: `(1 - F/(mu N))^(1/3)`.
    fn ends(&self, parts: &Parts, stuck: f64) -> Vector {
        if parts.ends == 0.0 {
            return [0.0; 2];
        }
        let Solved { problem, state, friction, solution, .. } = self;
        let sums = at_ends(problem, state, |i| solution.traction[i].map(f64::abs));
        let of_rest = match (state.load, friction.coefficient) {
            (Load::Force(_), Coefficient::Uniform(_)) => (BEFORE_SLIP * stuck).min(1.0),
            _ => 1.0,
        };
        sums.map(|sum| of_rest * sum * parts.stiffness / state.force())
    }

    /// In full slip mu times the error of the normal force, else parts of the errors by jumps and by the bend.
    fn by_the_normal_force(&self, parts: &Parts, carried: f64, [of_jumps, of_smooth]: [f64; 2]) -> f64 {
        let of_normal = match self.state.load {
            Load::Force(_) => of_jumps * parts.jumps * parts.stiffness,
            Load::Approach(_) => of_jumps * parts.jumps + of_smooth * parts.smooth,
        };
        of_normal * carried / self.state.force()
    }

    /// The error of a shift with spin: from the place that does not move, around which tractions turn within an element or two.
    fn turns(&self) -> f64 {
        let Solved { state, friction, solution, .. } = self;
        if friction.motion != Motion::Shift || friction.spin == 0.0 {
            return 0.0;
        }
        let (grid, p) = (&state.grid, &state.p);
        let bound = |i: usize| friction.coefficient.at(i) * p[i];
        let slips = |i: usize| solution.stick_slip[i] == SLIP && bound(i) > 0.0;
        let turn = |i: usize, (at, last): (usize, usize), step: usize| {
            if at == 0 || at == last || bound(i) <= 0.0 || !slips(i - step) || !slips(i + step) {
                return 0.0;
            }
            let [a, b, c] = [i - step, i, i + step].map(|j| solution.traction[j].map(|q| q / bound(j)));
            let [x, y] = [0, 1].map(|k| a[k] - 2.0 * b[k] + c[k]);
            x.hypot(y) * bound(i)
        };
        let of = |i: usize| {
            let (x, y) = (i % grid.mx, i / grid.mx);
            turn(i, (x, grid.mx - 1), 1) + turn(i, (y, grid.my - 1), grid.mx)
        };
        TURN_FACTOR * in_blocks((0..grid.len()).map(of)) * grid.element_area()
    }

    /// The error from jumps of mu.
    fn jumps(&self) -> f64 {
        let Solved { problem, state, friction, solution, .. } = self;
        let Coefficient::PerElement(mu) = friction.coefficient else { return 0.0 };
        let grid = &state.grid;
        let weight = |i: usize, j: usize| {
            let slips = solution.stick_slip[i] == SLIP || solution.stick_slip[j] == SLIP;
            if slips {
                0.5 * (state.p[i].max(0.0) + state.p[j].max(0.0))
            } else {
                0.0
            }
        };
        let reached = |i: usize| WITHIN_REACH * solution.traction[i][0].hypot(solution.traction[i][1]) / state.p[i];
        let value = |i: usize| if state.p[i] > 0.0 { mu[i].min(reached(i)) } else { mu[i] };
        let repeats = problem.coefficients.repeats(grid);
        at_jumps((grid, &Rectangle::full(grid)), repeats, value, weight) * grid.element_area()
    }
}
