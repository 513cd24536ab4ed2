//! Warnings about a result, whatever the status of the call: `report->warnings`.

use std::ffi::{CStr, CString};
use std::sync::OnceLock;

use crate::adhesion::{LARGEST_BORDER_SHARE, UNSTABLE_KAPPA};
use crate::contact::State;
use crate::effects;
use crate::friction::law::STEEP;
use crate::scene::Scene;
use crate::solver::{ActiveSet, Options, Report};
use crate::threads::made_once;

/// `warnings`: contact reaches the border of the grid, in a direction without a period. The potential contact area may be too small.
pub const CONTACT_NORMAL_WARNING_BORDER: i32 = 1;
/// `warnings`: only one element of the grid is in contact. The grid is too coarse, or the units of lengths and pressures are inconsistent.
pub const CONTACT_NORMAL_WARNING_ONE_ELEMENT: i32 = 2;
/// `warnings`: one of several elements in contact carries more than half of the force. The grid is too coarse there, or a value of h is wrong.
pub const CONTACT_NORMAL_WARNING_SPIKE: i32 = 4;
/// `warnings`: the error of the force (or of the approach) cannot be estimated: see `accuracy.untrusted`. If `untrusted` is 0, a solve on one grid
/// cannot estimate the error, because pressures are at their limit or the bodies attract each other.
pub const CONTACT_NORMAL_WARNING_ERROR_UNKNOWN: i32 = 8;
/// `warnings`: a single element is unstable under the attraction. The elements are too coarse for the range (`adhesion.resolution` above 1).
pub const CONTACT_NORMAL_WARNING_RANGE: i32 = 16;
/// `warnings`: the attraction reaches the border of the grid (`adhesion.border_share` above 0.001). The grid is too small for it.
pub const CONTACT_NORMAL_WARNING_ATTRACTION: i32 = 32;
/// `warnings`: the traction bounds fall so steeply with the slip (`tangential.law_slope` of 0.5 or more) that there may be several solutions.
pub const CONTACT_NORMAL_WARNING_LAW: i32 = 64;

/// The bit of each warning, and its text in messages.
const TEXTS: [(i32, &str); 7] = [
    (CONTACT_NORMAL_WARNING_BORDER, "contact reaches the border of the grid: a larger grid may carry more"),
    (
        CONTACT_NORMAL_WARNING_ONE_ELEMENT,
        "one element is in contact: take smaller elements, or check the units of lengths and pressures",
    ),
    (
        CONTACT_NORMAL_WARNING_SPIKE,
        "one element carries more than half of the force: take smaller elements, or look for a wrong value of h",
    ),
    (CONTACT_NORMAL_WARNING_ERROR_UNKNOWN, "the error is not known"),
    (
        CONTACT_NORMAL_WARNING_RANGE,
        "elements snap alone, for they are too large for the range of the attraction: take smaller elements, or a longer range",
    ),
    (CONTACT_NORMAL_WARNING_ATTRACTION, "the attraction reaches the border of the grid: take a larger grid"),
    (
        CONTACT_NORMAL_WARNING_LAW,
        "friction falls so steeply that there may be several solutions; this is the one that friction.branch asks for: take a larger memory \
         distance, or a stiffer layer",
    ),
];

/// The texts of the warnings whose bits are set, joined. All combinations are made once, because later solves with a handle allocate nothing.
pub(super) fn text(warnings: i32) -> &'static CStr {
    if warnings == 0 {
        return c"";
    }
    static ALL: OnceLock<[CString; 1 << TEXTS.len()]> = OnceLock::new();
    let joined = |warnings: usize| {
        let texts: Vec<&str> =
            TEXTS.iter().filter(|(bit, _)| warnings as i32 & bit != 0).map(|(_, text)| *text).collect();
        CString::new(texts.join("; ")).unwrap_or_default()
    };
    &made_once(&ALL, || std::array::from_fn(joined))[warnings as usize % (1 << TEXTS.len())]
}

/// The bits of the warnings about a result.
pub(super) fn of(scene: &Scene<'_>, options: &Options, report: &Report, state: &State) -> i32 {
    let (measures, grid) = (&report.measures, &scene.grid);
    let effects = of_adhesion(report) | of_law(report.friction.map(|found| found.law_slope));
    if measures.contact_count == 0 || grid.len() == 1 {
        return effects;
    }
    // A FIXED contact area cannot grow beyond the border, and has no estimates of errors.
    let is_free = options.active_set == ActiveSet::Free;
    // The force of the positive pressures. On a FIXED contact area others may be negative.
    let positive_part = || state.p.iter().filter(|p| **p > 0.0).sum::<f64>() * grid.element_area();
    let without_adhesion = || if is_free { measures.force } else { positive_part() };
    let pressing_force = report.adhesion.map_or_else(without_adhesion, |found| found.repulsive_force);
    let is_spike = measures.max_pressure * grid.element_area() > 0.5 * pressing_force;
    let warnings = [
        (CONTACT_NORMAL_WARNING_BORDER, is_free && measures.edge_count > 0 && is_at_border(scene, state)),
        (CONTACT_NORMAL_WARNING_ONE_ELEMENT, measures.contact_count == 1),
        (CONTACT_NORMAL_WARNING_SPIKE, measures.contact_count > 1 && is_spike),
        (CONTACT_NORMAL_WARNING_ERROR_UNKNOWN, is_free && options.estimates && report.error.force.is_none()),
    ];
    effects | warnings.into_iter().filter(|(_, holds)| *holds).map(|(bit, _)| bit).sum::<i32>()
}

/// The bits of the warnings about adhesion.
fn of_adhesion(report: &Report) -> i32 {
    let Some(found) = &report.adhesion else { return 0 };
    let range = if found.resolution > UNSTABLE_KAPPA { CONTACT_NORMAL_WARNING_RANGE } else { 0 };
    range | if found.border_share > LARGEST_BORDER_SHARE { CONTACT_NORMAL_WARNING_ATTRACTION } else { 0 }
}

/// The bit of the warning about a law of friction with this `law_slope`.
pub(super) fn of_law(slope: Option<f64>) -> i32 {
    if slope.is_some_and(|slope| slope >= STEEP) {
        CONTACT_NORMAL_WARNING_LAW
    } else {
        0
    }
}

/// The part of a message about traction bounds that fall steeply with the slip; empty if they do not.
pub(super) fn advice_on_law(slope: f64) -> String {
    match slope >= STEEP {
        true => format!(
            "; tangential.law_slope is {slope:.2}: bounds of friction fall by that part of what an element's influence holds, and from {STEEP} on \
             there may be several solutions: a larger memory_distance, a longer step or a stiffer layer"
        ),
        false => String::new(),
    }
}

/// Whether an element in contact lies in a row or column at a border of the grid. Borders with a period across them do not count, and neither do the
/// borders of a direction with one element, as in a line contact.
fn is_at_border(scene: &Scene<'_>, state: &State) -> bool {
    let (x, y) = effects::repeats(scene);
    let [columns, rows, _] = state.edge_counts();
    (!y && scene.grid.my > 1 && rows > 0) || (!x && scene.grid.mx > 1 && columns > 0)
}
