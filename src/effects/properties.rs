//! The properties of an effect that the rest of the library uses. Every effect states all of them: one that omits a property does not
//! compile.

use super::each::Each;

/// p_max, a pressure; +infinity: no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureLimit<'a>(pub Each<'a>);

/// The layout of the caller's coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// One table over offsets.
    Offsets,
    /// One table per loaded row.
    Rows,
}

/// The message of most effects without subsurface stresses.
pub const HALF_SPACE_ALONE: &str = "is given; subsurface stresses are those of a half-space";

/// How stresses below the surface of a body change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stresses<'a> {
    /// The stresses are those of the pressures and tractions on a half-space.
    Same,
    /// The stresses repeat in both directions.
    Repeat,
    /// Loads count times the factor between their patch and that of the element above.
    Patches {
        /// Number of patches.
        count: usize,
        /// The patch of each element.
        patch: &'a [i32],
        /// `[count][count]`.
        factors: &'a [f64],
    },
    /// The stresses are unknown: the message after the name of the effect.
    Unknown(&'static str),
}

/// A step that begins where the last one of the solver ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Continues {
    /// The member of the scene that requests it.
    pub member: &'static str,
    /// The result that the last step must have left.
    pub from: &'static str,
    /// The call to make instead of a batch.
    pub instead: &'static str,
}

/// The role of an effect in the rest of the library.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties<'a> {
    /// The effects that exclude this one; one of a pair names the other.
    pub excludes: &'static [&'static str],
    /// The name of the effect if MULTIGRID and FULL_MULTIGRID refuse it, because it has no smoother or no coarser
    /// grids.
    pub without_multigrid: Option<&'static str>,
    /// Whether the effect works on a given contact area.
    pub with_given_area: bool,
    /// Why the effect stands for one grid only, so that solves on several grids are refused.
    pub one_grid: Option<&'static str>,
    /// The layout of the caller's coefficients, if they replace those of the bodies. Later scenes of a solver need not name them again.
    pub own_coefficients: Option<Layout>,
    /// The directions in which the effect makes the scene repeat.
    pub repeats: (bool, bool),
    /// The largest admissible pressures; none: there are no limits.
    pub limits: Option<PressureLimit<'a>>,
    /// Whether a further problem is solved after the normal one. After the normal solve it may be refused or change the undeformed distance.
    pub is_beside: bool,
    /// How this step begins where the last one ended; none: it does not.
    pub continues: Option<Continues>,
}
