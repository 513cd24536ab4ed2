//! The properties of an effect that the rest of the library uses. Every effect states all properties: an effect that omits one does not compile.

use super::each::Each;

/// The largest admissible pressure p_max, on each element. +infinity: no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureLimit<'a>(pub Each<'a>);

/// The layout of the caller's influence coefficients of pressures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// One table over the offsets between two elements, for all elements.
    Offsets,
    /// One table for each loaded row of the grid.
    Rows,
}

/// The message of effects for whose bodies the library has no stresses below the surface. It follows the name of the effect.
pub const HALF_SPACE_ALONE: &str = "is given; subsurface stresses are those of a half-space";

/// How an effect changes the stresses below the surface of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stresses<'a> {
    /// The stresses are those of the pressures and tractions on a half-space.
    Same,
    /// The stresses are those of a half-space with loads that are periodic in both directions.
    Repeat,
    /// The load on an element counts times the factor between its patch and the patch of the element above the point of the stress.
    Patches {
        /// Number of patches.
        count: usize,
        /// The patch of each element.
        patch: &'a [i32],
        /// The factor between each pair of patches, `[count][count]`.
        factors: &'a [f64],
    },
    /// The library does not compute these stresses. The message follows the name of the effect.
    Unknown(&'static str),
}

/// A load step that begins where the last step of the solver ended: parts of the messages that refuse it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Continues {
    /// The member of the scene that requests such a step.
    pub member: &'static str,
    /// The result that the last step must have left in the solver.
    pub from: &'static str,
    /// The advice for a batch, which cannot continue from step to step.
    pub instead: &'static str,
}

/// What the rest of the library has to know about an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties<'a> {
    /// The names of effects that cannot be solved together with this one. It is enough if one effect of a pair excludes the other.
    pub excludes: &'static [&'static str],
    /// The name of the effect in the message by which MULTIGRID and FULL_MULTIGRID refuse it, because the problem has no smoother or no coarser
    /// grids. None: these methods solve the effect.
    pub without_multigrid: Option<&'static str>,
    /// Whether the effect can be solved on a given contact area.
    pub with_given_area: bool,
    /// Why the values of the effect hold on one grid only. Solves on several grids are then refused. None: they hold on any grid.
    pub one_grid: Option<&'static str>,
    /// The layout of the caller's coefficients, if the effect replaces those of the bodies. Later scenes of the solver may leave the effect out.
    pub own_coefficients: Option<Layout>,
    /// Whether the effect makes the scene periodic in x, and in y.
    pub repeats: (bool, bool),
    /// The largest admissible pressures. None: there is no limit.
    pub limits: Option<PressureLimit<'a>>,
    /// Whether a further problem, as that of friction, is solved after the normal one. That problem may be refused after the normal solve, or change
    /// the undeformed distance.
    pub is_beside: bool,
    /// If the step begins where the last one ended: how messages call it. None: the step does not depend on the last one.
    pub continues: Option<Continues>,
}
