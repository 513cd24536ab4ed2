//! How wrong the forces of a tangential problem are, estimated from a solve from rest: no other grid is solved for it.
//!
//! *Shift.* With a parabola's pressures the force of a shift is the difference of two normal forces, that on C and that on the stick area
//! (Jager 1997; Ciavarella 1998). Approaches of both are off by the same part of the bend of h within an element ([`estimates`]), so that
//! most of it goes out; what the outline makes of it is left, and more of it the fewer elements lie across the contact:
//!
//! ```text
//! e = PART bend/depth (1 + (CHORD/elements across)^2) mu N
//! ```
//!
//! *Steady rolling* is of first order in the step: what the next coarser grid of the nested iteration has, with these pressures, differs
//! by about what is missing (with spin by half of it), `e = ROLLING |F - F_coarse|`, and a part of the above.
//!
//! *With an approach that is given* the normal force is off by its own error e_N, and with it the tangential one: by `mu e_N` where all slips,
//! else by less, `mu e_N (1 - (1 - F/(mu N))^(1/3))` with a parabola's pressures. Jumps of the surface are off by the same.
//!
//! *Where the surface ends within the contact* ([`at_ends`]) tractions are singular as pressures are, and the force is off as the normal
//! one is, with the traction in the place of the pressure. If the normal force is given, this part goes to 0 as the contact approaches full slip.
//!
//! *Where mu jumps* the jump lies anywhere between two centres, and with it `mu p` of what slips there ([`at_jumps`]).
//!
//! Where a force is prescribed, the creepage has the error: `e/(dF/dxi)`, with `dF/dxi = (F/xi) (1 - F/(mu N))^(1/3)`, which is that of
//! Cattaneo's and of Carter's curve or less. A residual R leaves an error of R mu N at most (docs/friction.md). PART, CHORD and ROLLING are
//! measured, on balls and ellipses of 7 to 54 elements across (docs/notes/2026-11-friction.md; `tests/friction/estimates.rs` keeps to them).
//! So do flat punches and jumps of mu, on 11 to 68 elements across.
//!
//! [`estimates`]: super::estimates

use super::estimates::Parts;
use crate::contact::{at_ends, at_jumps, Curvature, Outline, Problem, State};
use crate::effects::Coefficient;
use crate::friction::{Report, Solution, Vector, SLIP};
use crate::rectangle::Rectangle;
use crate::scene::{Friction, Load, Motion, Prescribed};

/// Of the bend, relative to the depth, the part by which forces of a shift are off.
const PART: f64 = 0.3;
/// With fewer elements across than that the outline matters more.
const CHORD: f64 = 13.0;
/// With shorter chords nothing is known.
const LEAST_CHORD: f64 = 1.5;
/// In steady rolling: of the difference to the coarser grid, of what a shift would be off, and of the difference in the other direction.
const ROLLING: f64 = 3.0;
const ROLLING_SHIFT: f64 = 3.0;
const ACROSS: f64 = 0.25;
/// Of unlike bodies a shift is off by up to 3.4 times as much: pressures push sideways, and force and creepage do not begin at 0 together.
const UNLIKE: f64 = 8.0;
/// Of coated bodies by up to 1.5 times as much: the shifts of no parabola on no half-space.
const COATED: f64 = 2.0;
/// With a normal force that is given, ends matter by that much of `(1 - F/(mu N))^(1/3)`, and by 1 at most.
const BEFORE_SLIP: f64 = 2.0;

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
    /// Whether they have a coating.
    pub coated: bool,
}

/// Errors of the tangential force in each direction, or of the creepage where the force is prescribed; negative: not known.
pub fn estimate(solved: &Solved<'_>, found: &Report) -> Vector {
    let unknown = [-1.0; 2];
    let &Solved { state, outline, curvature, friction, alike, coated, .. } = solved;
    let count = state.contact_count();
    let chord = outline.chord(count, solved.problem.coefficients.repeats(&state.grid));
    let is_plain = friction.compliance == Coefficient::Uniform(0.0) && friction.weights.is_none();
    if !is_plain || count == 0 || !(chord >= LEAST_CHORD) || !(curvature.depth > 0.0) {
        return unknown;
    }
    let Some(parts) = solved.parts else { return unknown };
    let widened = 1.0 + (CHORD / chord).powi(2);
    let of_shift = PART * curvature.bend.abs() / curvature.depth * widened * found.carried;
    let hidden = found.certificate.residual * found.carried;
    let force = found.force[0].hypot(found.force[1]);
    let creepage = found.creepage[0].hypot(found.creepage[1]);
    // (1 - F/(mu N))^(1/3)
    let stuck = (1.0 - force / found.carried).max(f64::EPSILON).cbrt();
    // dxi/dF
    let compliance = creepage / force / stuck;
    let differences = match (friction.motion, found.coarser) {
        (Motion::Shift, _) if found.from_rest => [[0.0; 2]; 2],
        (Motion::SteadyRolling, Some((force, creepage))) if alike => {
            let is_found = |k: usize| matches!(friction.prescribed[k], Prescribed::Force(_));
            let of_creepage = |k: usize| if is_found(k) { (found.creepage[k] - creepage[k]).abs() } else { 0.0 };
            [[0, 1].map(|k| (found.force[k] - force[k]).abs()), [0, 1].map(of_creepage)]
        }
        _ => return unknown,
    };
    let part = match friction.motion {
        Motion::Shift if coated => COATED,
        Motion::Shift if alike => 1.0,
        Motion::Shift => UNLIKE,
        _ => ROLLING_SHIFT,
    };
    let ends = solved.ends(&parts, stuck);
    let more = solved.by_the_normal_force(&parts, found.carried) * (1.0 - stuck) + solved.jumps();
    [0, 1].map(|k| {
        let at_least = |of: Vector| of[k].max(ACROSS * of[1 - k]);
        let of_surface = part * of_shift + at_least(ends) + more;
        let error = match friction.prescribed[k] {
            Prescribed::Creepage(_) => ROLLING * at_least(differences[0]) + of_surface + hidden,
            Prescribed::Force(_) => ROLLING * at_least(differences[1]) + (of_surface + hidden) * compliance,
        };
        if error.is_finite() {
            error
        } else {
            -1.0
        }
    })
}

impl Solved<'_> {
    /// By ends of the surface, in each direction. `stuck`: `(1 - F/(mu N))^(1/3)`.
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

    /// Where all slips: mu times the error of the normal force.
    fn by_the_normal_force(&self, parts: &Parts, carried: f64) -> f64 {
        let of_normal = match self.state.load {
            Load::Force(_) => parts.jumps * parts.stiffness,
            Load::Approach(_) => parts.jumps + parts.smooth,
        };
        of_normal * carried / self.state.force()
    }

    /// By jumps of mu.
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
        let value = |i: usize| mu[i];
        let repeats = problem.coefficients.repeats(grid);
        at_jumps((grid, &Rectangle::full(grid)), repeats, value, weight) * grid.element_area()
    }
}
