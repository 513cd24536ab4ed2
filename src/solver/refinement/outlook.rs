//! The errors of a solution and their decrease on finer grids.

use crate::contact::{touching, State};
use crate::effects;
use crate::grid::Grid;
use crate::rectangle::Rectangle;
use crate::scene::{Load, Scene};
use crate::solver::falling::Falling;
use crate::solver::quantities::{Course, Lack, Quantity, Value};
use crate::solver::{Report, Solver};
use crate::threads::Threads;

/// The first grid of a history has at least this many elements in its shorter direction.
const LEAST_ELEMENTS: usize = 16;

/// The relative errors of a solution and their decrease on finer grids.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outlook {
    /// The error of each quantity, at the index of its [number](Quantity::number); None if unknown.
    errors: [Option<Falling>; Quantity::ALL.len()],
}

impl Outlook {
    /// The errors that have estimates in the report of a solve.
    pub fn of(solver: &Solver, report: &Report, load: Load) -> Outlook {
        let (error, measures) = (&report.error, &report.measures);
        let found = measures.found(load);
        let force = report.halving.error.filter(|_| error.force.is_some() && solver.has_solved());
        let peak = error.max_pressure.map(|by_four| Falling { by_four, ..Falling::default() });
        let area = error.corrected_area.map(|by_two| Falling { by_two, ..Falling::default() });
        let mut outlook = Outlook::default();
        outlook.set(Quantity::Force, force.and_then(|error| error.over(found)));
        outlook.set(Quantity::MaxPressure, peak.and_then(|error| error.over(measures.max_pressure)));
        outlook.set(Quantity::ContactArea, area.and_then(|error| error.over(measures.corrected_area)));
        outlook
    }

    /// Sets the relative error of a quantity.
    fn set(&mut self, quantity: Quantity, error: Option<Falling>) {
        self.errors[quantity.number()] = error;
    }

    /// The relative error of a quantity on this grid; None if unknown.
    pub fn relative(&self, quantity: Quantity) -> Option<f64> {
        self.error(quantity).map(|error| error.now())
    }

    /// The relative error of a quantity on this and finer grids; None if unknown.
    pub fn error(&self, quantity: Quantity) -> Option<Falling> {
        self.errors[quantity.number()]
    }
}

/// The values of the wanted quantities, grid by grid.
#[derive(Clone, Debug)]
pub struct History {
    courses: Vec<Course>,
}

impl History {
    /// The history of the wanted quantities, without grids yet.
    pub fn of(wanted: impl Iterator<Item = Quantity>, scene: &Scene<'_>) -> History {
        History { courses: wanted.map(|quantity| Course::of(quantity, scene)).collect() }
    }

    /// Whether the error of a quantity needs grids coarser than the scene's.
    pub fn needs_coarser(&self) -> bool {
        self.courses.iter().any(|course| !course.quantity().has_estimate())
    }

    /// The least number of elements of the first grid in its shorter direction. It is halved if stresses are the only quantities that need several
    /// grids, and they need three: with pressure limits or coupled problems.
    pub fn least(&self, scene: &Scene<'_>) -> usize {
        let is_steep = effects::limits(scene).is_some() || effects::beside(scene).next().is_some();
        let need_several = || self.courses.iter().map(Course::quantity).filter(|quantity| !quantity.has_estimate());
        if is_steep && need_several().all(Quantity::is_stress) {
            LEAST_ELEMENTS / 2
        } else {
            LEAST_ELEMENTS
        }
    }

    /// Whether there are enough grids for the error of each quantity to be valid.
    pub fn is_believed(&self) -> bool {
        self.courses.iter().all(Course::is_believed)
    }

    /// The wanted quantities.
    pub fn wanted(&self) -> Vec<Quantity> {
        self.courses.iter().map(Course::quantity).collect()
    }

    /// Adds the values on a grid, and sets those errors of its outlook that follow from several grids.
    pub fn add(&mut self, doublings: i32, values: &Values, outlook: &mut Outlook) {
        for (course, value) in self.courses.iter_mut().zip(&values.of_wanted) {
            let Ok(found) = *value else { continue };
            course.add(doublings, found, values.residual);
            course.below_known_pressure(values.lack_estimates || outlook.error(Quantity::MaxPressure).is_some());
            if values.lack_estimates {
                course.reaches_limit();
            }
            // Estimates from one grid are not replaced.
            if !course.quantity().has_estimate() || values.lack_estimates {
                let error = course.error(values.lack_estimates);
                outlook.set(course.quantity(), error.and_then(|error| error.over(found.value)));
            }
        }
    }
}

/// The values on one grid.
pub struct Values {
    /// The value of each wanted quantity, or why there is none. Empty if the computation was cancelled.
    pub of_wanted: Vec<Result<Value, Lack>>,
    /// The larger of the relative residuals of the normal and the tangential problem.
    pub residual: f64,
    /// Whether a single grid has no estimates in this scene: elements are at their pressure limit, or bodies attract.
    pub lack_estimates: bool,
}

/// The number of elements across the contact area, along x and along y. 0 without contact.
///
/// - In a periodic direction in which the area has no end, the number is unlimited (`usize::MAX`).
/// - If the area has no end in either direction, or if bodies attract without contact, the number is that of the grid. In this case it is unlimited
///   along x for a scene of one column, and along y for a scene of one row: the scene is uniform there.
pub fn across(state: &State, repeats: (bool, bool), scene: &Grid) -> (usize, usize) {
    let State { grid, p, .. } = state;
    let around = Rectangle::around_values(&touching(state), grid, &Threads::One, |row| row.contains(&true));
    let attract = || p.iter().any(|p| *p != 0.0);
    let ((x, y), ends) = match around.map(|around| (around.x.len(), around.y.len())) {
        Some((x, y)) => ((x, y), (x < grid.mx || !repeats.0, y < grid.my || !repeats.1)),
        None if attract() => ((grid.mx, grid.my), (false, false)),
        None => return (0, 0),
    };
    let span = |count: usize, is_limited: bool| if is_limited { count } else { usize::MAX };
    match ends {
        // A direction of one element is uniform, unless both have one.
        (false, false) => (span(x, scene.mx > 1 || scene.my == 1), span(y, scene.my > 1 || scene.mx == 1)),
        (ends_in_x, ends_in_y) => (span(x, ends_in_x), span(y, ends_in_y)),
    }
}
