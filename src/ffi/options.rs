//! `contact_normal_options` and `contact_normal_cycle`, and their translation to [`Options`].

use std::time::Instant;

use libc::{c_char, c_void};

use super::arguments::{count, not_negative, reserved, unknown, Regions};
use super::progress::contact_normal_progress;
use super::status::Refusal;
use super::structs::{self, versioned, Versioned};
use crate::error::require;
use crate::methods::multigrid::{CycleShape, SmootherKind};
use crate::solver::{ActiveSet, Criterion, InitialGuess, Method, Options, Precision};

/// `method`: the library chooses the fastest method that is reliable, and tries others if it fails.
pub const CONTACT_NORMAL_METHOD_AUTO: i32 = 0;
/// `method`: Kalker's NORM, an active-set method with conjugate gradients.
pub const CONTACT_NORMAL_METHOD_NORM: i32 = 1;
/// `method`: one V-cycle of multigrid per active-set step (section 4.1 of the paper).
pub const CONTACT_NORMAL_METHOD_MULTIGRID: i32 = 2;
/// `method`: MULTIGRID nested over the grids, from the coarsest to the finest (section 4.3 of the paper).
pub const CONTACT_NORMAL_METHOD_FULL_MULTIGRID: i32 = 3;
/// `method`: nested iteration with projected, preconditioned conjugate gradients; symmetric influence coefficients only.
pub const CONTACT_NORMAL_METHOD_PROJECTED_CG: i32 = 4;

/// `smoother`: the default, which is GAUSS_SEIDEL.
pub const CONTACT_NORMAL_SMOOTHER_AUTO: i32 = 0;
/// `smoother`: lexicographic Gauss-Seidel with relaxation.
pub const CONTACT_NORMAL_SMOOTHER_GAUSS_SEIDEL: i32 = 1;
/// `smoother`: Gauss-Seidel in red-black order.
pub const CONTACT_NORMAL_SMOOTHER_RED_BLACK: i32 = 2;
/// `smoother`: (damped) Jacobi, which does not converge on fine grids.
pub const CONTACT_NORMAL_SMOOTHER_JACOBI: i32 = 3;
/// `smoother`: the inverse of a circulant, by FFT, with the step length of least energy.
pub const CONTACT_NORMAL_SMOOTHER_FFT: i32 = 4;

/// `active_set`: the contact conditions determine the contact area.
pub const CONTACT_NORMAL_ACTIVE_SET_FREE: i32 = 0;
/// `active_set`: the contact area is `fields->contact`; e = 0 is solved there, as in NORM's inner solve. Pressures may be negative.
pub const CONTACT_NORMAL_ACTIVE_SET_FIXED: i32 = 1;

/// `initial_guess`: there is no initial guess.
pub const CONTACT_NORMAL_INITIAL_GUESS_NONE: i32 = 0;
/// `initial_guess`: `fields->pressure`, and `fields->contact` if it is not NULL.
pub const CONTACT_NORMAL_INITIAL_GUESS_GIVEN: i32 = 1;
/// `initial_guess`: the last result of this solver handle.
pub const CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS: i32 = 2;

/// `criterion`: `||h - approach + A p|| <= tolerance ||h - approach||`, 2-norms over C.
pub const CONTACT_NORMAL_CRITERION_RESIDUAL: i32 = 0;
/// `criterion`: rms over C of the last change of p <= tolerance times the rms over C of p. OK also needs residual, violation and
/// complementarity within the larger of 1e-2 and the tolerance, because the last change is also small if the iteration stalls.
pub const CONTACT_NORMAL_CRITERION_UPDATE: i32 = 1;

/// `precision`: whichever of DOUBLE and MIXED is faster.
pub const CONTACT_NORMAL_PRECISION_AUTO: i32 = 0;
/// `precision`: double precision throughout.
pub const CONTACT_NORMAL_PRECISION_DOUBLE: i32 = 1;
/// `precision`: single precision in inner iterations, where it helps; the result is always in double precision.
pub const CONTACT_NORMAL_PRECISION_MIXED: i32 = 2;

/// A callback that is called after each cycle, on the calling thread and in its floating-point environment. If it returns non-zero, the call is
/// cancelled. The callback must not use the handle that is solving: such calls are refused.
pub type contact_normal_progress_callback =
    Option<unsafe extern "C" fn(progress: *const contact_normal_progress, user: *mut c_void) -> i32>;

/// How a scene is solved. The defaults suit most users.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_options {
    /// Set by `contact_normal_options_init`.
    pub struct_size: i64,
    /// CONTACT_NORMAL_METHOD_...; default AUTO.
    pub method: i32,
    /// CONTACT_NORMAL_ACTIVE_SET_...; default FREE.
    pub active_set: i32,
    /// CONTACT_NORMAL_INITIAL_GUESS_...; default NONE.
    pub initial_guess: i32,
    /// CONTACT_NORMAL_CRITERION_...; default RESIDUAL.
    pub criterion: i32,
    /// The tolerance of the criterion, between 0 and 1 (p = 0 has a residual of 1); default 1e-6.
    pub tolerance: f64,
    /// > 0: the solve may stop once the residual is below this part of the estimated discretisation error. OK then refers to the larger tolerance in
    /// `report->normal.tolerance`. NORM and MULTIGRID, and scenes without an estimate, keep `tolerance`. Default 0: `tolerance` holds.
    pub error_ratio: f64,
    /// The largest number of cycles, or of iterations of conjugate gradients or steps of GMRES, on the finest grid; default 1000. For a pull
    /// (adhesion, force < 0) the first path of the search may take three times as many. Each further path may take as many or, if that is more, 500
    /// plus four times the cycles of the first path.
    pub max_cycles: i32,
    /// The number of threads; default 1, which is safe beside OpenMP and MPI; 0: all cores.
    pub threads: i32,
    /// CONTACT_NORMAL_PRECISION_...; default AUTO.
    pub precision: i32,
    /// Always 0.
    pub reserved: i32,
    /// The progress callback, which is called after each cycle, or NULL (default).
    pub progress: contact_normal_progress_callback,
    /// Passed to `progress`; default NULL.
    pub user: *mut c_void,
    /// The cycle of the paper's methods, MULTIGRID and FULL_MULTIGRID; NULL (default): the cycle that `contact_normal_cycle_init` makes.
    pub cycle: *const contact_normal_cycle,
    /// The largest number of seconds of a call, tested after each cycle. The call then ends with ITERATION_LIMIT, and outputs hold the best iterate.
    /// In a batch the limit is that of the whole call. Default 0: no limit.
    pub max_seconds: f64,
    /// An integer that any thread may set, or NULL (default). Once it is not 0, the call ends with CANCELLED after the present cycle.
    pub stop: *const i32,
    /// The path of a file, or NULL (default). A call that ends neither with OK nor with CANCELLED writes its arguments to this file, for
    /// `contact-normal-replay` (docs/dump.md); `contact_normal_quantities` and `contact_normal_effects_bill` do not. In the path %p is the number of
    /// the process, %n the number of the dump in the process, and %% a %.
    pub dump: *const c_char,
    /// > 0, for `contact_normal_solve` only: leaves out effects whose omission changes force or approach, largest pressure, area and tangential
    /// forces by less than this part, as `contact_normal_effects_bill` estimates on small grids; `report->accuracy.neglected` has these effects.
    /// Friction, adhesion, a pressure limit and the relaxation of bodies are never left out. `progress` is also called for the cycles on the small
    /// grids. Below 1. Default 0: nothing is left out. Since 0.2.
    pub neglect_below: f64,
}

/// The cycle of the paper's methods.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_cycle {
    /// Set by `contact_normal_cycle_init`.
    pub struct_size: i64,
    /// CONTACT_NORMAL_SMOOTHER_...; default AUTO.
    pub smoother: i32,
    /// The number n1 of sweeps before the coarse grid in the cycle V(n1, n2); default 1.
    pub pre_sweeps: i32,
    /// The number n2 of sweeps after the coarse grid in the cycle V(n1, n2); default 1.
    pub post_sweeps: i32,
    /// The coarsest grid has at most this many elements in each direction, 1 to 16; default 4.
    pub coarsest: i32,
    /// The relaxation factor omega, in (0, 2); default 0: the factor that suits the smoother.
    pub relaxation: f64,
}

versioned! {
    contact_normal_cycle, contact_normal_cycle_init, 32,
    pre_sweeps: Options::default().cycle.pre_sweeps as i32,
    post_sweeps: Options::default().cycle.post_sweeps as i32,
    coarsest: Options::default().cycle.coarsest as i32,
}

versioned! {
    contact_normal_options, contact_normal_options_init, 104,
    tolerance: Options::default().tolerance,
    max_cycles: Options::default().max_cycles as i32,
    threads: Options::default().threads as i32,
}

impl contact_normal_options {
    /// The options of a set-up that a handle keeps: precision and threads.
    pub(super) fn of_set_up(options: &Options) -> contact_normal_options {
        let precision = match options.precision {
            Precision::Auto => CONTACT_NORMAL_PRECISION_AUTO,
            Precision::Double => CONTACT_NORMAL_PRECISION_DOUBLE,
            Precision::Mixed => CONTACT_NORMAL_PRECISION_MIXED,
        };
        contact_normal_options { precision, threads: options.threads as i32, ..Default::default() }
    }
}

impl From<&CycleShape> for contact_normal_cycle {
    fn from(shape: &CycleShape) -> contact_normal_cycle {
        contact_normal_cycle {
            smoother: match shape.smoother {
                SmootherKind::GaussSeidel => CONTACT_NORMAL_SMOOTHER_GAUSS_SEIDEL,
                SmootherKind::RedBlack => CONTACT_NORMAL_SMOOTHER_RED_BLACK,
                SmootherKind::Jacobi => CONTACT_NORMAL_SMOOTHER_JACOBI,
                SmootherKind::Fft => CONTACT_NORMAL_SMOOTHER_FFT,
            },
            pre_sweeps: shape.pre_sweeps as i32,
            post_sweeps: shape.post_sweeps as i32,
            coarsest: shape.coarsest as i32,
            relaxation: shape.relaxation,
            ..Default::default()
        }
    }
}

/// The options of a call, in the forms of C and of the core.
pub(super) struct Translated {
    /// A copy of the caller's struct.
    pub given: contact_normal_options,
    /// A copy of the caller's cycle.
    cycle: Option<contact_normal_cycle>,
    pub options: Options,
    /// The time at which the call began.
    pub began: Instant,
}

// SAFETY: of the caller's pointers the threads of the library use only `stop`, which is read as an atomic.
unsafe impl Sync for Translated {}

impl Translated {
    /// Adds the caller's struct at `address`, which may be NULL, the cycle and `stop`.
    pub fn add_to(&self, regions: &mut Regions, address: *const contact_normal_options) -> Result<(), Refusal> {
        regions.input_struct(address, &self.given)?;
        regions.input("options->stop", self.given.stop, 1)?;
        self.cycle.iter().try_for_each(|cycle| regions.input_struct(self.given.cycle, cycle))
    }
}

/// Translates the options of a call; NULL: the defaults. Refuses `neglect_below`.
pub(super) unsafe fn translate(options: *const contact_normal_options) -> Result<Translated, Refusal> {
    // SAFETY: by the caller.
    let translated = unsafe { translate_neglecting(options)? };
    match translated.given.neglect_below {
        0.0 => Ok(translated),
        below => {
            Err(Refusal::invalid(format!("neglect_below is {below}; only contact_normal_solve leaves effects out")))
        }
    }
}

/// As [`translate`], for a call that leaves out negligible effects: accepts `neglect_below`.
pub(super) unsafe fn translate_neglecting(options: *const contact_normal_options) -> Result<Translated, Refusal> {
    let began = Instant::now();
    // SAFETY: NULL or a struct that declares its size.
    let given = unsafe { structs::read_optional(options, "options")? }.unwrap_or_else(contact_normal_options::defaults);
    // SAFETY: likewise.
    let cycle = unsafe { structs::read_optional(given.cycle, "options->cycle")? };
    reserved("options->reserved", given.reserved)?;
    let is_limit = given.max_seconds >= 0.0 && given.max_seconds.is_finite();
    require(is_limit, "max_seconds", given.max_seconds, "it must be positive, or 0 for no limit")?;
    let below = given.neglect_below;
    require((0.0..1.0).contains(&below), "neglect_below", below, "it must lie between 0 and 1, or be 0 for none")?;
    let options = Options {
        method: method(given.method)?,
        cycle: cycle.map_or(Ok(CycleShape::default()), shape)?,
        active_set: match given.active_set {
            CONTACT_NORMAL_ACTIVE_SET_FREE => ActiveSet::Free,
            CONTACT_NORMAL_ACTIVE_SET_FIXED => ActiveSet::Fixed,
            other => return unknown("active_set", other, "FREE 0 or FIXED 1"),
        },
        initial_guess: match given.initial_guess {
            CONTACT_NORMAL_INITIAL_GUESS_NONE => InitialGuess::None,
            CONTACT_NORMAL_INITIAL_GUESS_GIVEN => InitialGuess::Given,
            CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS => InitialGuess::Previous,
            other => return unknown("initial_guess", other, "NONE 0, GIVEN 1 or PREVIOUS 2"),
        },
        tolerance: given.tolerance,
        criterion: match given.criterion {
            CONTACT_NORMAL_CRITERION_RESIDUAL => Criterion::Residual,
            CONTACT_NORMAL_CRITERION_UPDATE => Criterion::Update,
            other => return unknown("criterion", other, "RESIDUAL 0 or UPDATE 1"),
        },
        error_ratio: given.error_ratio,
        max_cycles: count("max_cycles", given.max_cycles)?,
        threads: not_negative("threads", given.threads)?,
        precision: match given.precision {
            CONTACT_NORMAL_PRECISION_AUTO => Precision::Auto,
            CONTACT_NORMAL_PRECISION_DOUBLE => Precision::Double,
            CONTACT_NORMAL_PRECISION_MIXED => Precision::Mixed,
            other => return unknown("precision", other, "AUTO 0, DOUBLE 1 or MIXED 2"),
        },
        // `Outputs::options` sets this.
        estimates: false,
    };
    options.check()?;
    Ok(Translated { given, cycle, options, began })
}

fn shape(given: contact_normal_cycle) -> Result<CycleShape, Refusal> {
    Ok(CycleShape {
        smoother: smoother(given.smoother)?,
        pre_sweeps: not_negative("pre_sweeps", given.pre_sweeps)?,
        post_sweeps: not_negative("post_sweeps", given.post_sweeps)?,
        relaxation: given.relaxation,
        coarsest: count("coarsest", given.coarsest)?,
    })
}

fn method(value: i32) -> Result<Method, Refusal> {
    Ok(match value {
        CONTACT_NORMAL_METHOD_AUTO => Method::Auto,
        CONTACT_NORMAL_METHOD_NORM => Method::Norm,
        CONTACT_NORMAL_METHOD_MULTIGRID => Method::Multigrid,
        CONTACT_NORMAL_METHOD_FULL_MULTIGRID => Method::FullMultigrid,
        CONTACT_NORMAL_METHOD_PROJECTED_CG => Method::ProjectedCg,
        other => return unknown("method", other, "AUTO 0, NORM 1, MULTIGRID 2, FULL_MULTIGRID 3 or PROJECTED_CG 4"),
    })
}

fn smoother(value: i32) -> Result<SmootherKind, Refusal> {
    Ok(match value {
        CONTACT_NORMAL_SMOOTHER_AUTO | CONTACT_NORMAL_SMOOTHER_GAUSS_SEIDEL => SmootherKind::GaussSeidel,
        CONTACT_NORMAL_SMOOTHER_RED_BLACK => SmootherKind::RedBlack,
        CONTACT_NORMAL_SMOOTHER_JACOBI => SmootherKind::Jacobi,
        CONTACT_NORMAL_SMOOTHER_FFT => SmootherKind::Fft,
        other => return unknown("smoother", other, "AUTO 0, GAUSS_SEIDEL 1, RED_BLACK 2, JACOBI 3 or FFT 4"),
    })
}
