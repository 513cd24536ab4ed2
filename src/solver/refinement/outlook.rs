//! What a solution says about finer grids.

use crate::contact::State;
use crate::scene::Load;
use crate::solver::{Report, Solver};

/// What an accuracy is asked of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The force, or the approach if the force is prescribed.
    Force,
    /// The largest pressure.
    MaxPressure,
    /// The corrected contact area.
    ContactArea,
}

/// An error: what falls by 4 with a doubling of the elements in both directions, what falls by 2, and what the residual hides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Falling {
    /// What falls by 4.
    pub(super) by_four: f64,
    /// What falls by 2.
    pub(super) by_two: f64,
    /// What stays.
    pub(super) hidden: f64,
}

impl Falling {
    /// As it is.
    pub fn now(&self) -> f64 {
        self.after(0)
    }

    /// After so many doublings; with a negative number before them.
    pub fn after(&self, doublings: i32) -> f64 {
        let ratio = 0.5_f64.powi(doublings);
        self.by_four * ratio * ratio + self.by_two * ratio + self.hidden
    }

    pub(super) fn over(self, whole: f64) -> Option<Falling> {
        let [by_four, by_two, hidden] = [self.by_four, self.by_two, self.hidden].map(|part| part / whole.abs());
        (by_four + by_two + hidden).is_finite().then_some(Falling { by_four, by_two, hidden })
    }
}

/// The relative errors of a solution, where they are known.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outlook {
    force: Option<Falling>,
    max_pressure: Option<Falling>,
    contact_area: Option<Falling>,
}

impl Outlook {
    /// Of a solution with estimates.
    pub fn of(solver: &Solver, report: &Report, load: Load) -> Outlook {
        let (error, measures) = (&report.error, &report.measures);
        let residual = measures.certificate.residual;
        let found = measures.found(load);
        let hidden = residual * found.abs();
        // s + e and s/4 + e/2 are told.
        let (whole, halved) = (error.force - hidden, report.halving.force - hidden);
        let by_two = (4.0 * halved - whole).clamp(0.0, whole.max(0.0));
        let known = error.force >= 0.0 && solver.has_solved();
        let force = Falling { by_four: whole - by_two, by_two, hidden };
        let peak = Falling { by_four: error.max_pressure, ..Falling::default() };
        let area = Falling { by_two: error.corrected_area, ..Falling::default() };
        Outlook {
            force: if known { force.over(found) } else { None },
            max_pressure: if error.max_pressure >= 0.0 { peak.over(measures.max_pressure) } else { None },
            contact_area: if error.corrected_area >= 0.0 { area.over(measures.corrected_area) } else { None },
        }
    }

    /// The relative error.
    pub fn relative(&self, quantity: Quantity) -> Option<f64> {
        self.falling(quantity).map(|falling| falling.now())
    }

    /// The relative error on this and finer grids.
    pub fn falling(&self, quantity: Quantity) -> Option<Falling> {
        match quantity {
            Quantity::Force => self.force,
            Quantity::MaxPressure => self.max_pressure,
            Quantity::ContactArea => self.contact_area,
        }
    }
}

/// Elements across the contact area, along x and y; as many as need be in a direction in which it repeats itself without an end.
pub fn across(state: &State, repeats: (bool, bool)) -> (usize, usize) {
    let (mx, my) = (state.grid.mx, state.grid.my);
    let (mut columns, mut rows) = ((mx, 0), (my, 0));
    for (y, row) in state.contact.chunks_exact(mx).enumerate() {
        let Some(first) = row.iter().position(|&inside| inside) else { continue };
        let last = row.iter().rposition(|&inside| inside).unwrap_or(first);
        columns = (columns.0.min(first), columns.1.max(last + 1));
        rows = (rows.0.min(y), rows.1.max(y + 1));
    }
    let span = |(start, end): (usize, usize), m: usize, repeats: bool| match end.saturating_sub(start) {
        all if all == m && repeats => usize::MAX,
        some => some,
    };
    (span(columns, mx, repeats.0), span(rows, my, repeats.1))
}
