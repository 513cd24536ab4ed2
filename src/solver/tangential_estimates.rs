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
//! Where a force is prescribed, the creepage has the error: `e/(dF/dxi)`, with `dF/dxi = (F/xi) (1 - F/(mu N))^(1/3)`, which is that of
//! Cattaneo's and of Carter's curve or less. A residual R leaves an error of R mu N at most (docs/friction.md). PART, CHORD and ROLLING are
//! measured, on balls and ellipses of 7 to 54 elements across (docs/notes/2026-11-friction.md; `tests/friction/estimates.rs` keeps to them).
//!
//! [`estimates`]: super::estimates

use crate::contact::{Curvature, Outline, Problem, State};
use crate::friction::{Report, Vector};
use crate::scene::{Friction, Motion, Prescribed};

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

/// Errors of the tangential force in each direction, or of the creepage where the force is prescribed; negative: not known. `alike`:
/// whether the bodies are.
pub fn estimate(
    (problem, state, outline): (&Problem, &State, &Outline),
    (friction, alike): (&Friction<'_>, bool),
    found: &Report,
) -> Vector {
    let unknown = [-1.0; 2];
    let curvature = Curvature::of(problem, state, outline.rows);
    let count = state.contact_count();
    let chord = outline.chord(count);
    if count == 0 || !(chord >= LEAST_CHORD) || !(curvature.depth > 0.0) {
        return unknown;
    }
    let widened = 1.0 + (CHORD / chord).powi(2);
    let of_shift = PART * curvature.bend.abs() / curvature.depth * widened * found.carried;
    let hidden = found.certificate.residual * found.carried;
    let force = found.force[0].hypot(found.force[1]);
    let creepage = found.creepage[0].hypot(found.creepage[1]);
    // dxi/dF
    let compliance = creepage / force / (1.0 - force / found.carried).max(f64::EPSILON).cbrt();
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
        Motion::Shift if alike => 1.0,
        Motion::Shift => UNLIKE,
        _ => ROLLING_SHIFT,
    };
    [0, 1].map(|k| {
        let at_least = |of: Vector| of[k].max(ACROSS * of[1 - k]);
        let error = match friction.prescribed[k] {
            Prescribed::Creepage(_) => ROLLING * at_least(differences[0]) + part * of_shift + hidden,
            Prescribed::Force(_) => ROLLING * at_least(differences[1]) + (part * of_shift + hidden) * compliance,
        };
        if error.is_finite() {
            error
        } else {
            -1.0
        }
    })
}
