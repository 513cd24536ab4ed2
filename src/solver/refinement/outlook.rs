//! Forecasts for finer grids from a solution.

use crate::contact::{touching, State};
use crate::effects;
use crate::grid::Grid;
use crate::rectangle::Rectangle;
use crate::scene::{Load, Scene};
use crate::solver::falling::Falling;
use crate::solver::quantities::{Course, Lack, Quantity, Value};
use crate::solver::{Report, Solver};
use crate::threads::Threads;

/// Least elements in the shorter direction of the first grid of a history.
const LEAST_ELEMENTS: usize = 16;

/// The relative errors of a solution, where they are known.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outlook {
    falling: [Option<Falling>; Quantity::ALL.len()],
}

impl Outlook {
    /// The errors of a solution with estimates.
    pub fn of(solver: &Solver, report: &Report, load: Load) -> Outlook {
        let (error, measures) = (&report.error, &report.measures);
        let found = measures.found(load);
        let force = report.halving.error.filter(|_| error.force.is_some() && solver.has_solved());
        let peak = error.max_pressure.map(|by_four| Falling { by_four, ..Falling::default() });
        let area = error.corrected_area.map(|by_two| Falling { by_two, ..Falling::default() });
        let mut outlook = Outlook::default();
        outlook.set(Quantity::Force, force.and_then(|falling| falling.over(found)));
        outlook.set(Quantity::MaxPressure, peak.and_then(|falling| falling.over(measures.max_pressure)));
        outlook.set(Quantity::ContactArea, area.and_then(|falling| falling.over(measures.corrected_area)));
        outlook
    }

    fn set(&mut self, quantity: Quantity, falling: Option<Falling>) {
        self.falling[quantity.number()] = falling;
    }

    /// The relative error.
    pub fn relative(&self, quantity: Quantity) -> Option<f64> {
        self.falling(quantity).map(|falling| falling.now())
    }

    /// The relative error on this and finer grids.
    pub fn falling(&self, quantity: Quantity) -> Option<Falling> {
        self.falling[quantity.number()]
    }
}

/// The values of quantities, grid by grid.
#[derive(Clone, Debug)]
pub struct History {
    courses: Vec<Course>,
}

impl History {
    /// The history of the wanted quantities. If a limit is reached or bodies attract, one grid alone has no estimates.
    pub fn of(wanted: impl Iterator<Item = Quantity>, scene: &Scene<'_>) -> History {
        History { courses: wanted.map(|quantity| Course::of(quantity, scene)).collect() }
    }

    /// Whether errors need grids coarser than the scene's.
    pub fn needs_coarser(&self) -> bool {
        self.courses.iter().any(|course| !course.quantity().has_estimate())
    }

    /// Least elements in the shorter direction of the first grid: fewer if only stresses below the surface need three grids.
    pub fn least(&self, scene: &Scene<'_>) -> usize {
        let is_steep = effects::limits(scene).is_some() || effects::beside(scene).next().is_some();
        let of_several = || self.courses.iter().map(Course::quantity).filter(|quantity| !quantity.has_estimate());
        if is_steep && of_several().all(Quantity::is_stress) {
            LEAST_ELEMENTS / 2
        } else {
            LEAST_ELEMENTS
        }
    }

    /// Whether there are enough grids for each error.
    pub fn is_believed(&self) -> bool {
        self.courses.iter().all(Course::is_believed)
    }

    /// The wanted quantities.
    pub fn wanted(&self) -> Vec<Quantity> {
        self.courses.iter().map(Course::quantity).collect()
    }

    /// Adds the values of a grid, and writes their errors to its outlook.
    pub fn add(&mut self, doublings: i32, values: &Values, outlook: &mut Outlook) {
        for (course, value) in self.courses.iter_mut().zip(&values.of_wanted) {
            let Ok(found) = *value else { continue };
            course.add(doublings, found, values.residual);
            course.below_known_pressure(values.lack_estimates || outlook.falling(Quantity::MaxPressure).is_some());
            if values.lack_estimates {
                course.reaches_limit();
            }
            // Estimates from one grid are kept.
            if !course.quantity().has_estimate() || values.lack_estimates {
                let falling = course.falling(values.lack_estimates);
                outlook.set(course.quantity(), falling.and_then(|falling| falling.over(found.value)));
            }
        }
    }
}

/// The values of one grid, in the order of the wanted quantities.
pub struct Values {
    /// The value of each wanted quantity, or why there is none. Empty if the computation was cancelled.
    pub of_wanted: Vec<Result<Value, Lack>>,
    /// The relative residual.
    pub residual: f64,
    /// Whether one such grid has no estimates: a limit is reached, or bodies attract.
    pub lack_estimates: bool,
}

/// Elements across the contact area, along x and y; unlimited in a direction in which a periodic area has no end. An
/// area without any end, and bodies apart that attract, have the elements of the grid. For a scene of one column these
/// are unlimited along x, for one of one row along y.
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
        // Along its one element a line is uniform.
        (false, false) => (span(x, scene.mx > 1 || scene.my == 1), span(y, scene.my > 1 || scene.mx == 1)),
        (ends_in_x, ends_in_y) => (span(x, ends_in_x), span(y, ends_in_y)),
    }
}
