//! Estimates of the discretisation errors of tangential forces, from one grid. A shift must start from rest.
//!
//! *Shift.* For a paraboloid, the force of a shift is the difference of two normal forces: that on C and that on the stick area (Jager 1997;
//! Ciavarella 1998). The approaches of both have an error of the same part of the bend of h ([`estimates`]), so most of the error cancels. What
//! remains is the error from the outline of the contact, which is larger with fewer elements across:
//!
//! ```text
//! e = SHIFT_ERROR bend/depth (1 + (OUTLINE_CHORD/elements across)^2) mu N
//! ```
//!
//! *Steady rolling.* The error is of first order in the step. Let F_coarse be the force on the next coarser grid of the nested iteration, with the
//! same pressures. The error is about `|F - F_coarse|`, with spin up to twice that. The estimate is `ROLLING_FACTOR |F - F_coarse|`, plus the error
//! of a shift times ROLLING_FACTOR.
//!
//! *Given approach.* The error e_N of the normal force adds an error to the tangential force: `mu e_N` in full slip, and
//! `mu e_N (1 - (1 - F/(mu N))^(1/3))` for a paraboloid otherwise. Jumps of the surface, such as those of punches, add `F/N` times their part of e_N.
//!
//! *Ends of the surface within the contact, and jumps of the coefficients* ([`at_ends`]). Tractions are singular there like pressures. The error of
//! the tangential force is that of the normal force, with the traction in place of one of the two factors p. If the normal force is given, this error
//! tends to 0 towards full slip.
//!
//! *Jumps of mu.* A jump of mu lies anywhere between two centres, and so does the jump of `mu p` where elements slip ([`at_jumps`]).
//!
//! *Given tangential force.* The creepage has the error `e/(dF/dxi)`. The slope is taken as `dF/dxi = (F/xi) (1 - F/(mu N))^(1/3)`, which is at most
//! that of Cattaneo's and of Carter's solutions.
//!
//! A residual R adds an error of at most R mu N (docs/friction.md). SHIFT_ERROR, OUTLINE_CHORD and ROLLING_FACTOR were measured on balls and ellipses
//! with 7 to 54 elements across (docs/notes/2026-11-friction.md; tests/friction/estimates.rs). They also suffice for flat punches and jumps of mu on
//! 11 to 68 elements across.
//!
//! [`estimates`]: super::estimates

use super::estimates::{at_ends, at_jumps, Curvature, Parts, LEAST_CHORD};
use crate::contact::{Outline, Problem, State};
use crate::effects::Coefficient;
use crate::friction::{Report, Solution, Vector, SLIP};
use crate::rectangle::Rectangle;
use crate::scene::{Friction, Load, Motion, Prescribed};
use crate::sums::in_blocks;

/// Error of the force of a shift relative to mu N, over the bend relative to the approach above the lowest h ([`Curvature::depth`]).
const SHIFT_ERROR: f64 = 0.3;
/// Elements across the contact at which the error from the outline equals the other error of a shift.
const OUTLINE_CHORD: f64 = 13.0;
/// Factor in steady rolling, on the difference from the coarser grid and on the error of a shift.
const ROLLING_FACTOR: f64 = 3.0;
/// The error in one direction is at least this part of the corresponding error in the other direction.
const ACROSS_FACTOR: f64 = 0.25;
/// Factor on the error of a shift for unlike bodies; errors were up to 3.4 times the estimate without it. Pressures displace the surfaces sideways,
/// so the force is not 0 at a creepage of 0.
const UNLIKE_FACTOR: f64 = 8.0;
/// Factor on the error of a shift for coated bodies; errors were up to 1.5 times the estimate without it. The theory above is that of paraboloids on
/// half-spaces.
const COATED_FACTOR: f64 = 2.0;
/// With a given normal force, the factor on errors from ends is this times `(1 - F/(mu N))^(1/3)`, at most 1.
const BEFORE_SLIP: f64 = 2.0;

/// Errors are relative to mu N, or to this factor times the sum of the tractions if that is less. With very large mu elements are stuck as if glued:
/// their tractions do not come near their bounds and are linear in the motion.
const WITHIN_REACH: f64 = 50.0;
/// Factor on the second differences of the directions of tractions, in a shift with spin. That of a smooth integrand is 1/24. Errors were up to .7
/// times the estimate.
const TURN_FACTOR: f64 = 0.0625;

/// A solved scene with friction.
pub struct Solved<'a> {
    /// The normal problem.
    pub problem: &'a Problem,
    /// The solution of the normal problem.
    pub state: &'a State,
    /// The outline of the contact area.
    pub outline: &'a Outline,
    /// The curvature of the surface and of the pressures.
    pub curvature: &'a Curvature,
    /// The parts of the error of the normal force or approach; None if unknown.
    pub parts: Option<Parts>,
    /// The friction of the scene.
    pub friction: &'a Friction<'a>,
    /// The solution of the tangential problem.
    pub solution: &'a Solution,
    /// Whether tractions do not change the pressures.
    pub alike: bool,
    /// Whether the bodies have a coating.
    pub coated: bool,
}

/// Estimates the error of the tangential force in x and in y, or of the creepage where the force is prescribed. None: unknown. `found` is the report
/// of the tangential problem.
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
    // (1 - F/(mu N))^(1/3): the radius of the stick area over that of the contact, for a ball.
    let stuck = (1.0 - force / found.carried).max(f64::EPSILON).cbrt();
    // dxi/dF
    let compliance = creepage / force / stuck;
    // The differences of forces, and of creepages where forces are given, from those of the coarser grid.
    let [of_forces, of_creepages] = match (friction.motion, found.coarser) {
        (Motion::Shift, _) if found.from_rest => [[0.0; 2]; 2],
        (Motion::SteadyRolling, Some((force, creepage))) if alike => {
            let has_force = friction.has_forces();
            let of_creepage = |k: usize| if has_force[k] { (found.creepage[k] - creepage[k]).abs() } else { 0.0 };
            [[0, 1].map(|k| (found.force[k] - force[k]).abs()), [0, 1].map(of_creepage)]
        }
        _ => return unknown,
    };
    let factor = match friction.motion {
        Motion::Shift if coated => COATED_FACTOR,
        Motion::Shift if alike => 1.0,
        Motion::Shift => UNLIKE_FACTOR,
        _ => ROLLING_FACTOR,
    };
    let ends = solved.ends(&parts, stuck);
    // The parts of mu e_N, for the error from jumps (punches): F/(mu N), and for that from the bend (paraboloids): 1 - (1 - F/(mu N))^(1/3), here
    // written without cancellation.
    let of_jumps = force / found.carried;
    let slipped = [of_jumps, of_jumps / (1.0 + stuck + stuck * stuck)];
    let more = solved.by_the_normal_force(&parts, found.carried, slipped) + solved.jumps() + solved.turns();
    [0, 1].map(|k| {
        let at_least = |of: Vector| of[k].max(ACROSS_FACTOR * of[1 - k]);
        let of_surface = factor * of_shift + at_least(ends) + more;
        let error = match friction.prescribed[k] {
            Prescribed::Creepage(_) => ROLLING_FACTOR * at_least(of_forces) + of_surface + hidden,
            Prescribed::Force(_) => ROLLING_FACTOR * at_least(of_creepages) + (of_surface + hidden) * compliance,
        };
        error.is_finite().then_some(error)
    })
}

/// Whether errors can be estimated with the friction law, if there is one. They can for a shift with given creepages. With given forces they cannot:
/// near the largest force of a falling coefficient, errors of the creepage were up to 1.5 times the estimate. In steady rolling they cannot either,
/// because no coarser grid is solved with the law.
fn is_known_with_law(friction: &Friction<'_>) -> bool {
    let by_creepages = friction.has_forces() == [false; 2];
    !friction.has_law() || friction.motion == Motion::Shift && by_creepages
}

impl Solved<'_> {
    /// The sum of the tractions of all elements, as a force.
    fn tractions(&self) -> f64 {
        in_blocks(self.solution.traction.iter().map(|q| q[0].hypot(q[1]))) * self.state.grid.element_area()
    }

    /// The error from ends of the surface and jumps of the coefficients, in each direction. `stuck` is `(1 - F/(mu N))^(1/3)`.
    fn ends(&self, parts: &Parts, stuck: f64) -> Vector {
        if parts.ends == 0.0 {
            return [0.0; 2];
        }
        let Solved { problem, state, friction, solution, .. } = self;
        let sums = at_ends(problem, state, |i| solution.traction[i].map(f64::abs));
        let factor = match (state.load, friction.coefficient) {
            (Load::Force(_), Coefficient::Uniform(_)) => (BEFORE_SLIP * stuck).min(1.0),
            _ => 1.0,
        };
        sums.map(|sum| factor * sum * parts.stiffness / state.force())
    }

    /// The error of the tangential force that the error of the normal force causes: `carried` (mu N) over N, times the parts `of_jumps` and
    /// `of_smooth` of the normal force's errors from jumps and from the bend.
    fn by_the_normal_force(&self, parts: &Parts, carried: f64, [of_jumps, of_smooth]: [f64; 2]) -> f64 {
        let of_normal = match self.state.load {
            Load::Force(_) => of_jumps * parts.jumps * parts.stiffness,
            Load::Approach(_) => of_jumps * parts.jumps + of_smooth * parts.smooth,
        };
        of_normal * carried / self.state.force()
    }

    /// The error of a shift with spin that comes from the pole of the motion, around which the tractions rotate within an element or two.
    fn turns(&self) -> f64 {
        let Solved { state, friction, solution, .. } = self;
        if friction.motion != Motion::Shift || friction.spin == 0.0 {
            return 0.0;
        }
        let (grid, p) = (&state.grid, &state.p);
        let bound = |i: usize| friction.coefficient.at(i) * p[i];
        let slips = |i: usize| solution.stick_slip[i] == SLIP && bound(i) > 0.0;
        let turn = |i: usize, (number, last): (usize, usize), step: usize| {
            if number == 0 || number == last || bound(i) <= 0.0 || !slips(i - step) || !slips(i + step) {
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
