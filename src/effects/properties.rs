//! The questions of other places to an effect: every effect answers all of them, so one that forgets something does not compile.

/// p_max, a pressure; +infinity: no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PressureLimit<'a> {
    /// The same everywhere.
    Uniform(f64),
    /// One per element, `[my][mx]`.
    PerElement(&'a [f64]),
}

impl PressureLimit<'_> {
    /// Of element i.
    #[inline]
    pub fn at(&self, i: usize) -> f64 {
        match self {
            PressureLimit::Uniform(limit) => *limit,
            PressureLimit::PerElement(limits) => limits[i],
        }
    }
}

/// How the caller's own coefficients are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// One table over offsets.
    Offsets,
    /// One table per loaded row.
    Rows,
}

/// The answer of most effects that stresses below the surface do not know.
pub const HALF_SPACE_ALONE: &str = "is given; subsurface stresses are those of a half-space";

/// How stresses below the surface of a body change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stresses<'a> {
    /// They are those of the pressures and tractions on a half-space.
    Same,
    /// They repeat themselves in both directions.
    Repeat,
    /// Loads count times the factor between their patch and that of the element above.
    Patches {
        /// Number of patches.
        count: usize,
        /// Of each element.
        patch: &'a [i32],
        /// `[count][count]`.
        factors: &'a [f64],
    },
    /// They are not known: what the message says after the name of the effect.
    Unknown(&'static str),
}

/// A step that begins where the last one of the solver ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Continues {
    /// The member that says so.
    pub member: &'static str,
    /// The result that the last step must have left.
    pub from: &'static str,
    /// The call to make instead of a batch.
    pub instead: &'static str,
}

/// The role of an effect in the rest of the library.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties<'a> {
    /// The effects that it is not solved with; one of a pair says so.
    pub excludes: &'static [&'static str],
    /// The effect that MULTIGRID and FULL_MULTIGRID do not solve: there is no smoother, or there are no coarser grids.
    pub without_multigrid: Option<&'static str>,
    /// Whether it is solved on a contact area that is given.
    pub with_given_area: bool,
    /// Why it stands for one grid only: then no accuracy is reached over several.
    pub one_grid: Option<&'static str>,
    /// Coefficients of the caller's own, in place of the bodies'. Later scenes of a solver need not name them again.
    pub own_coefficients: Option<Layout>,
    /// In which directions it makes the scene repeat itself.
    pub repeats: (bool, bool),
    /// The greatest pressures that are admissible; none: there are no limits.
    pub limits: Option<PressureLimit<'a>>,
    /// Whether something is solved beside the normal problem: it may be refused, or change the undeformed distance, when that is solved already.
    pub is_beside: bool,
    /// Whether this step begins where the last one ended; none: it does not.
    pub continues: Option<Continues>,
}
