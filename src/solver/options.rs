//! The options of a solve. The defaults suit all scenes.

use crate::error::{invalid, require, Error, Result};
use crate::methods::multigrid::CycleShape;
use crate::operator::Precision;
use crate::progress::{Criterion, Goal};

/// The method of the normal problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// A list of methods that suits the scene, the fastest one first. If a method does not converge, the next one continues.
    #[default]
    Auto,
    /// Kalker's NORM: active set and conjugate gradients (section 3 of the paper).
    Norm,
    /// One V-cycle per active-set step (section 4.1).
    Multigrid,
    /// V-cycles nested over the grids (section 4.3).
    FullMultigrid,
    /// Nested iteration with projected, preconditioned conjugate gradients; needs symmetric influence coefficients.
    ProjectedCg,
}

/// Whether the contact area is solved for or given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ActiveSet {
    /// The contact conditions determine it.
    #[default]
    Free,
    /// The caller gives the contact area. The equations e = 0 are solved on its elements, and pressures may be negative (NORM's inner solve).
    Fixed,
}

/// Where the iteration starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InitialGuess {
    /// No guess: each method has a start of its own.
    #[default]
    None,
    /// The given pressures and contact area.
    Given,
    /// The last result of this solver.
    Previous,
}

/// Pressures and contact area to start from.
#[derive(Clone, Copy, Debug)]
pub struct Guess<'a> {
    /// Pressures, `[my][mx]`. Pressures outside the contact area count as 0, and so do negative ones unless the contact area is given (FIXED).
    pub pressure: &'a [f64],
    /// Contact area.
    pub contact: &'a [bool],
}

/// How a scene is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The method of the normal problem.
    pub method: Method,
    /// Smoother and sweeps of the V-cycle, for multigrid methods.
    pub cycle: CycleShape,
    /// Whether the contact area is solved for or given.
    pub active_set: ActiveSet,
    /// Where the iteration starts.
    pub initial_guess: InitialGuess,
    /// The bound on the measure that `criterion` chooses; between 0 and 1.
    pub tolerance: f64,
    /// Which measure has to fall below the tolerance.
    pub criterion: Criterion,
    /// If positive: the solve may end once the residual is below this part of the estimated discretisation error. The error is relative, that of the
    /// force or of the approach, whichever is not prescribed. It is estimated from the start of a solve without a guess. FULL_MULTIGRID and
    /// PROJECTED_CG start from the coarser grids; NORM and MULTIGRID start from p = 0, which gives no estimate, and ignore this option.
    pub error_ratio: f64,
    /// Most cycles (of multigrid) or iterations (of conjugate gradients) on the finest grid.
    pub max_cycles: usize,
    /// Number of threads; 0 means all cores.
    pub threads: usize,
    /// The precision of products inside the iteration. The final check is always in double precision.
    pub precision: Precision,
    /// Whether the discretisation errors in report and ledger are estimated.
    pub estimates: bool,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            method: Method::Auto,
            cycle: CycleShape::default(),
            active_set: ActiveSet::Free,
            initial_guess: InitialGuess::None,
            tolerance: 1e-6,
            criterion: Criterion::Residual,
            error_ratio: 0.0,
            max_cycles: 1000,
            threads: 1,
            precision: Precision::Auto,
            estimates: false,
        }
    }
}

/// Most elements of the coarsest grid in each direction. Each cycle eliminates its unknowns: this takes milliseconds for 16^2, 20 seconds for 64^2.
const LARGEST_COARSEST: usize = 16;
/// Most sweeps of a smoother in a cycle. A larger number is taken for a mistake.
const MOST_SWEEPS: usize = 100;
/// Most threads. A larger number is taken for a mistake; starting so many threads might exhaust the machine.
const MOST_THREADS: usize = 1024;

impl Options {
    /// Refuses invalid options.
    pub fn check(&self) -> Result<()> {
        let tolerance = self.tolerance;
        require(
            tolerance > 0.0 && tolerance < 1.0,
            "tolerance",
            tolerance,
            "it must lie between 0 and 1: p = 0 has a residual of 1",
        )?;
        if self.max_cycles == 0 {
            return invalid("max_cycles is 0; at least one cycle must be allowed".into());
        }
        let CycleShape { relaxation, pre_sweeps, post_sweeps, coarsest, .. } = self.cycle;
        let allowed = "it must lie in (0, 2), or be 0 for the default";
        require((0.0..2.0).contains(&relaxation), "relaxation", relaxation, allowed)?;
        if (pre_sweeps, post_sweeps) == (0, 0) {
            return invalid("pre_sweeps and post_sweeps are both 0; a cycle needs at least one sweep".into());
        }
        for (name, sweeps) in [("pre_sweeps", pre_sweeps), ("post_sweeps", post_sweeps)] {
            if sweeps > MOST_SWEEPS {
                return invalid(format!("{name} is {sweeps}; at most {MOST_SWEEPS} are allowed"));
            }
        }
        if !(1..=LARGEST_COARSEST).contains(&coarsest) {
            return invalid(format!("coarsest is {coarsest}; it must lie in 1..{LARGEST_COARSEST}"));
        }
        let ratio = self.error_ratio;
        require(ratio >= 0.0 && ratio.is_finite(), "error_ratio", ratio, "it must be positive and finite, or 0")?;
        check_threads("threads", self.threads)
    }

    /// Refuses options that are invalid for calls which solve several grids, each without a guess.
    pub(super) fn check_several_grids(&self) -> Result<()> {
        self.check()?;
        if self.is_fixed() {
            return Err(Error::Unsupported("active_set is FIXED; the contact area of finer grids is not known".into()));
        }
        if self.initial_guess != InitialGuess::None {
            return invalid("initial_guess must be NONE: each grid is solved from nothing".into());
        }
        Ok(())
    }

    /// Whether the contact area is given (active_set FIXED).
    pub(super) fn is_fixed(&self) -> bool {
        self.active_set == ActiveSet::Fixed
    }

    /// The goal of the loop: criterion, tolerance and limit on cycles.
    pub fn goal(&self) -> Goal {
        Goal { criterion: self.criterion, tolerance: self.tolerance, max_cycles: self.max_cycles as u64 }
    }
}

/// Refuses a number of threads beyond [`MOST_THREADS`].
pub(crate) fn check_threads(name: &str, threads: usize) -> Result<()> {
    match threads > MOST_THREADS {
        true => invalid(format!("{name} is {threads}; at most {MOST_THREADS} are allowed")),
        false => Ok(()),
    }
}
