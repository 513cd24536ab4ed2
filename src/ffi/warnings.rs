//! Warnings of a result, whatever its status: `report->warnings`.

use std::ffi::{CStr, CString};
use std::sync::OnceLock;

use crate::adhesion::{LARGEST_BORDER_SHARE, UNSTABLE_KAPPA};
use crate::contact::State;
use crate::effects;
use crate::friction::law::STEEP;
use crate::scene::Scene;
use crate::solver::{ActiveSet, Options, Report};
use crate::threads::made_once;

/// `warnings`: contact reaches the border of the grid, in a direction without a period: the potential contact area may be too small.
pub const CONTACT_NORMAL_WARNING_BORDER: i32 = 1;
/// `warnings`: one element in contact of many: the grid is too coarse, or the units of lengths and pressures do not go together.
pub const CONTACT_NORMAL_WARNING_ONE_ELEMENT: i32 = 2;
/// `warnings`: one element of several carries more than half of the force: the grid is too coarse there, or a value of h is wrong.
pub const CONTACT_NORMAL_WARNING_SPIKE: i32 = 4;
/// `warnings`: an error of the force (or the approach) was to be estimated, and cannot be: see `accuracy.untrusted`. If that is 0, one grid does
/// not tell the error: pressures are at their limit, or bodies attract each other.
pub const CONTACT_NORMAL_WARNING_ERROR_UNKNOWN: i32 = 8;
/// `warnings`: an element alone is unstable under the attraction: the elements are too coarse for its range (`adhesion.resolution` above 1).
pub const CONTACT_NORMAL_WARNING_RANGE: i32 = 16;
/// `warnings`: the attraction reaches the border of the grid (`adhesion.border_share` above 0.001): the grid does not contain it.
pub const CONTACT_NORMAL_WARNING_ATTRACTION: i32 = 32;
/// `warnings`: bounds of friction fall so steeply with the slip (`tangential.law_slope` of .5 or more) that there may be several solutions.
pub const CONTACT_NORMAL_WARNING_LAW: i32 = 64;

/// Each warning with its text in messages.
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
    (CONTACT_NORMAL_WARNING_LAW, "friction falls so steeply that there may be several solutions; this is the one that friction.branch asks for: take a larger memory distance, or a stiffer layer"),
];

/// The texts of the warnings; empty without any. They are made once, because later solves with a handle allocate nothing.
pub(super) fn text(warnings: i32) -> &'static CStr {
    if warnings == 0 {
        return c"";
    }
    static ALL: OnceLock<[CString; 1 << TEXTS.len()]> = OnceLock::new();
    let said = |warnings: usize| {
        let said: Vec<&str> =
            TEXTS.iter().filter(|(bit, _)| warnings as i32 & bit != 0).map(|(_, text)| *text).collect();
        CString::new(said.join("; ")).unwrap_or_default()
    };
    &made_once(&ALL, || std::array::from_fn(said))[warnings as usize % (1 << TEXTS.len())]
}

/// The warnings of a result.
pub(super) fn of(scene: &Scene<'_>, options: &Options, report: &Report, state: &State) -> i32 {
    let (measures, grid) = (&report.measures, &scene.grid);
    let effects = of_adhesion(report) | of_law(report.friction.map(|found| found.law_slope));
    if measures.contact_count == 0 || grid.len() == 1 {
        return effects;
    }
    // A FIXED contact area cannot grow beyond the border, and has no estimate.
    let is_free = options.active_set == ActiveSet::Free;
    // On a FIXED contact area some elements may pull.
    let of_given = || state.p.iter().filter(|p| **p > 0.0).sum::<f64>() * grid.element_area();
    let of_bodies = || if is_free { measures.force } else { of_given() };
    let pressing = report.adhesion.map_or_else(of_bodies, |found| found.repulsive_force);
    let is_spike = measures.max_pressure * grid.element_area() > 0.5 * pressing;
    let found = [
        (CONTACT_NORMAL_WARNING_BORDER, is_free && measures.edge_count > 0 && is_at_border(scene, state)),
        (CONTACT_NORMAL_WARNING_ONE_ELEMENT, measures.contact_count == 1),
        (CONTACT_NORMAL_WARNING_SPIKE, measures.contact_count > 1 && is_spike),
        (CONTACT_NORMAL_WARNING_ERROR_UNKNOWN, is_free && options.estimates && report.error.force.is_none()),
    ];
    effects | found.into_iter().filter(|(_, holds)| *holds).map(|(bit, _)| bit).sum::<i32>()
}

/// The warnings of adhesion.
fn of_adhesion(report: &Report) -> i32 {
    let Some(found) = &report.adhesion else { return 0 };
    let range = if found.resolution > UNSTABLE_KAPPA { CONTACT_NORMAL_WARNING_RANGE } else { 0 };
    range | if found.border_share > LARGEST_BORDER_SHARE { CONTACT_NORMAL_WARNING_ATTRACTION } else { 0 }
}

/// The warning of a law of friction, by `law_slope`.
pub(super) fn of_law(slope: Option<f64>) -> i32 {
    if slope.is_some_and(|slope| slope >= STEEP) {
        CONTACT_NORMAL_WARNING_LAW
    } else {
        0
    }
}

/// The advice where bounds of friction fall steeply.
pub(super) fn advice_on_law(slope: f64) -> String {
    match slope >= STEEP {
        true => format!(
            "; tangential.law_slope is {slope:.2}: bounds of friction fall by that part of what an element's influence holds, and from {STEEP} on there \
             may be several solutions: a larger memory_distance, a longer step or a stiffer layer"
        ),
        false => String::new(),
    }
}

/// Whether an element in contact lies in a row or column at a border of the grid without a period across it. In a line contact the direction of one
/// element does not count.
fn is_at_border(scene: &Scene<'_>, state: &State) -> bool {
    let (x, y) = effects::repeats(scene);
    let [columns, rows, _] = state.edge_counts();
    (!y && scene.grid.my > 1 && rows > 0) || (!x && scene.grid.mx > 1 && columns > 0)
}
