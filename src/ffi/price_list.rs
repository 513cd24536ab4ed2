//! `contact_normal_cost_of_accuracy`: the price list, which has the predicted cost of several accuracies.

use std::cell::Cell;

use super::accuracy::{self, contact_normal_accuracy};
use super::arguments::{count, required, Regions};
use super::conclusion::Conclusion;
use super::dump::{given, recorded, Recording};
use super::ledger::known;
use super::options::{self, contact_normal_options, Translated};
use super::scene::{contact_normal_scene, Named};
use super::status::{contact_normal_status, Refusal};
use super::structs::{self, versioned, Rows, Versioned};
use super::watcher::{why, Watcher};
use crate::grid::Grid;
use crate::scene::Scene;
use crate::solver::{cost_of_accuracy, Accuracy, Obstacle, Price, Quantity, SurfaceCallback};

/// `quantity`: the force, or the approach if the force is prescribed.
pub const CONTACT_NORMAL_QUANTITY_FORCE: i32 = 0;
/// `quantity`: the largest pressure.
pub const CONTACT_NORMAL_QUANTITY_MAX_PRESSURE: i32 = 1;
/// `quantity`: the corrected contact area.
pub const CONTACT_NORMAL_QUANTITY_CONTACT_AREA: i32 = 2;
/// `quantity`: the mean of the deformed distance over the elements with a surface.
pub const CONTACT_NORMAL_QUANTITY_MEAN_GAP: i32 = 3;
/// `quantity`: the stiffness dF/dapproach, as `contact_normal_solver_stiffness` computes it.
pub const CONTACT_NORMAL_QUANTITY_STIFFNESS: i32 = 4;
/// `quantity`: the magnitude of the tangential force.
pub const CONTACT_NORMAL_QUANTITY_TANGENTIAL_FORCE: i32 = 5;
/// `quantity`: the magnitude of the creepage, of the directions in which the force is prescribed.
pub const CONTACT_NORMAL_QUANTITY_CREEPAGE: i32 = 6;
/// `quantity`: the moment of the tractions about the spin centre.
pub const CONTACT_NORMAL_QUANTITY_SPIN_MOMENT: i32 = 7;
/// `quantity`: the stick area.
pub const CONTACT_NORMAL_QUANTITY_STICK_AREA: i32 = 8;
/// `quantity`: the largest von Mises stress in both bodies, over all depths.
pub const CONTACT_NORMAL_QUANTITY_MAX_VON_MISES: i32 = 9;
/// `quantity`: the depth of the largest von Mises stress.
pub const CONTACT_NORMAL_QUANTITY_VON_MISES_DEPTH: i32 = 10;
/// `quantity`: the largest shear stress in both bodies, over all depths.
pub const CONTACT_NORMAL_QUANTITY_MAX_SHEAR: i32 = 11;

/// `obstacle`: there is none, the accuracy can be reached.
pub const CONTACT_NORMAL_OBSTACLE_NONE: i32 = 0;
/// `obstacle`: no grid is known to suffice. The quantity is singular or not resolved, contact is on single elements, nothing touches and the
/// quantity is not 0 then, or no grid was solved.
pub const CONTACT_NORMAL_OBSTACLE_SINGULAR: i32 = 1;
/// `obstacle`: the target is below round-off.
pub const CONTACT_NORMAL_OBSTACLE_ROUND_OFF: i32 = 2;
/// `obstacle`: the accuracy takes more elements than `accuracy->max_elements`.
pub const CONTACT_NORMAL_OBSTACLE_ELEMENTS: i32 = 3;
/// `obstacle`: the accuracy takes more memory than `accuracy->max_bytes`.
pub const CONTACT_NORMAL_OBSTACLE_MEMORY: i32 = 4;
/// `obstacle`: the accuracy takes longer than `accuracy->max_seconds`.
pub const CONTACT_NORMAL_OBSTACLE_TIME: i32 = 5;
/// `obstacle`: the bodies relax, and the error because of the time step alone, `time_error`, exceeds `target`.
pub const CONTACT_NORMAL_OBSTACLE_STEP: i32 = 6;
const _: () = assert!(Obstacle::Singular as i32 == CONTACT_NORMAL_OBSTACLE_SINGULAR);
const _: () = assert!(Obstacle::RoundOff as i32 == CONTACT_NORMAL_OBSTACLE_ROUND_OFF);
const _: () = assert!(Obstacle::Elements as i32 == CONTACT_NORMAL_OBSTACLE_ELEMENTS);
const _: () = assert!(Obstacle::Memory as i32 == CONTACT_NORMAL_OBSTACLE_MEMORY);
const _: () = assert!(Obstacle::Time as i32 == CONTACT_NORMAL_OBSTACLE_TIME);
const _: () = assert!(Obstacle::Step as i32 == CONTACT_NORMAL_OBSTACLE_STEP);

/// One row of the price list: the predicted cost of one accuracy.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_price {
    /// Set by `contact_normal_price_init`, which the first row of an array needs, and by the call.
    pub struct_size: i64,
    /// The relative error that is wanted, between 0 and 1.
    pub target: f64,
    /// The larger of the relative error of the grid and the tolerance; < 0: not known.
    pub error: f64,
    /// The tolerance that the accuracy needs. A smaller one would not improve the result.
    pub tolerance: f64,
    /// The predicted seconds of set-up and solve with `options->threads`; < 0: not known.
    pub seconds: f64,
    /// The predicted seconds with one thread; < 0: not known.
    pub seconds_one_thread: f64,
    /// The predicted bytes of the solver; 0: not known.
    pub bytes: i64,
    /// Elements in x of the coarsest grid that reaches the accuracy; 0: not known.
    pub mx: i32,
    /// Elements in y of that grid.
    pub my: i32,
    /// Element size in x of that grid.
    pub dx: f64,
    /// Element size in y of that grid.
    pub dy: f64,
    /// CONTACT_NORMAL_OBSTACLE_...: the obstacle to the accuracy.
    pub obstacle: i32,
    /// Always 0.
    pub reserved: i32,
    /// For bodies that relax: the relative error because of the time step, which any grid has in addition to `error`. It falls with the square of the
    /// time step. 0: no body relaxes.
    pub time_error: f64,
    /// The work units of the solve, products on its grid, as `work_units` of a report; 0: not known. They depend little on the machine.
    pub work_units: f64,
}

versioned! { contact_normal_price, contact_normal_price_init, 88, error: -1.0, seconds: -1.0, seconds_one_thread: -1.0 }

impl From<&Price> for contact_normal_price {
    fn from(price: &Price) -> Self {
        // A number of elements that an int32_t cannot hold is written as 0.
        let count = |n: usize| i32::try_from(n).unwrap_or(0);
        contact_normal_price {
            struct_size: size_of::<contact_normal_price>() as i64,
            target: price.target,
            error: known(price.error),
            tolerance: price.tolerance,
            seconds: known(price.seconds),
            seconds_one_thread: known(price.seconds_one_thread),
            bytes: i64::try_from(price.bytes).unwrap_or(i64::MAX),
            mx: price.grid.map_or(0, |grid| count(grid.mx)),
            my: price.grid.map_or(0, |grid| count(grid.my)),
            dx: price.grid.map_or(0.0, |grid| grid.dx),
            dy: price.grid.map_or(0.0, |grid| grid.dy),
            obstacle: price.obstacle.map_or(CONTACT_NORMAL_OBSTACLE_NONE, |obstacle| obstacle as i32),
            reserved: 0,
            time_error: price.time_error,
            work_units: price.work_units,
        }
    }
}

/// Predicts the cost of each of `n` relative errors of a `quantity`: `rows[i]` belongs to `targets[i]`. `contact_normal_price_init(rows)` must have
/// set the size of a row. The call solves the scene only on small grids over its rectangle. It takes at most 2 % of the seconds of the most expensive
/// row that can be reached (the least that its samples predict; on a busy machine the last sample may take longer) or 50 ms, or some 2 s if no row
/// is known by then. If nothing touches on the scene's grid, a quantity of 0 is exact: the row has that grid and the error 0.
///
/// Of `accuracy` (NULL: the defaults) the call reads `max_seconds`, `max_bytes`, `max_elements`, `surface` and `user`. A row that exceeds a limit has
/// this limit as its obstacle, and the cost without the limit. With a surface callback the scene's undeformed distance is not read and may be NULL.
/// Without one, small grids sample the undeformed distance, and grids finer than the scene's are refined from it, as in
/// `contact_normal_solve_to_accuracy`.
///
/// CANCELLED: the surface callback or `options->stop` cancelled the call. ITERATION_LIMIT: `options->max_seconds` was reached, and rows have the
/// results so far; or because of `max_cycles` neither the scene's grid nor a coarser one was solved. STAGNATED: neither the scene's grid nor a
/// coarser one was solved. UNSUPPORTED: influence coefficients of your own, FIXED contact, or a step of bodies that relax with `continues`.
/// Since 0.2.
#[no_mangle]
pub unsafe extern "C" fn contact_normal_cost_of_accuracy(
    scene: *const contact_normal_scene,
    options: *const contact_normal_options,
    accuracy: *const contact_normal_accuracy,
    quantity: i32,
    n: i32,
    targets: *const f64,
    rows: *mut contact_normal_price,
) -> contact_normal_status {
    let arguments = given![scene, options, accuracy, quantity, n, targets, rows];
    let predict = |recording: &mut Recording<'_>| {
        let n = count("n", n)?;
        // SAFETY: each pointer is NULL or points to what it says, by the conventions of the ABI.
        let (given, translated, named, targets) = unsafe {
            (
                structs::read_optional(accuracy, "accuracy")?,
                options::translate(options)?,
                Named::read(scene)?,
                required("targets", targets, n)?,
            )
        };
        // SAFETY: NULL or rows of which the first declares its size.
        let to = unsafe { Rows::of(rows, "rows")? };
        let mut regions = Regions::default();
        match given {
            Some(contact_normal_accuracy { surface: Some(_), .. }) => {
                named.add_without_distance(&mut regions, scene)?
            }
            _ => named.add_to(&mut regions, scene)?,
        }
        translated.add_to(&mut regions, options)?;
        if let Some(given) = &given {
            regions.input_struct(accuracy, given)?;
        }
        regions.input("targets", targets.as_ptr(), n)?;
        regions.output_rows("rows", rows, &to, n)?;
        recording.keep(&regions);
        regions.check()?;
        let given = given.unwrap_or_else(contact_normal_accuracy::defaults);
        // SAFETY: as above.
        let h = if given.surface.is_some() { Vec::new() } else { unsafe { named.copy_of_distance()? } };
        // SAFETY: as above.
        let scene = unsafe { named.with_distance(&h)? };
        let quantity = quantity_of("quantity", quantity)?;
        let asked = accuracy::translate(&given)?;
        let surface = accuracy::surface(&given, recording);
        // The targets are copied, because callbacks may write into the caller's array.
        let wanted = (quantity, &targets.to_vec()[..]);
        predict_watched(&scene, &translated, (&asked, wanted), surface, |i, price| {
            // SAFETY: the caller has n rows.
            unsafe { to.write(i, &price.into()) }
        })
    };
    // SAFETY: as above.
    unsafe { recorded("contact_normal_cost_of_accuracy", options, arguments, predict) }
}

/// Predicts the rows and calls `write` with each. The message of a cancelled call says whether the surface callback cancelled it.
fn predict_watched(
    scene: &Scene<'_>,
    translated: &Translated,
    (asked, wanted): (&Accuracy, (Quantity, &[f64])),
    surface: Option<impl FnMut(&Grid, &mut [f64]) -> bool>,
    write: impl Fn(usize, &Price),
) -> Result<contact_normal_status, Refusal> {
    let by_surface = Cell::new(false);
    let mut surface = surface.map(|mut surface| {
        let by_surface = &by_surface;
        move |grid: &Grid, h: &mut [f64]| {
            by_surface.set(surface(grid, h));
            by_surface.get()
        }
    });
    let surface = surface.as_mut().map(|surface| surface as SurfaceCallback<'_>);
    let watcher = Watcher::without_callback(translated);
    let told = &mut watcher.told();
    let progress = watcher.callback(told);
    let (outcome, prices) = cost_of_accuracy(scene, &translated.options, asked, wanted, surface, progress)?;
    prices.iter().enumerate().for_each(|(i, price)| write(i, price));
    let reason = if by_surface.get() { "the surface callback cancelled" } else { why(outcome) };
    watcher.conclusion(Conclusion::of(outcome, || reason.into())).conclude()
}

/// The quantity with this number. Messages call the argument `name`.
pub(super) fn quantity_of(name: &str, quantity: i32) -> Result<Quantity, Refusal> {
    let known = usize::try_from(quantity).ok().and_then(|number| Quantity::ALL.get(number));
    known.copied().ok_or_else(|| {
        let describe = |known: &Quantity| format!("{} {}", known.name().to_uppercase(), known.number());
        let names: Vec<String> = Quantity::ALL.iter().map(describe).collect();
        Refusal::invalid(format!("{name} is {quantity}; it must be one of {}", names.join(", ")))
    })
}
