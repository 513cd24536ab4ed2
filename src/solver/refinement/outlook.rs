//! What a solution says about finer grids.

use crate::contact::State;
use crate::scene::Load;
use crate::solver::quantities::{Falling, Lack, Quantity, Sequence};
use crate::solver::{Report, Solver};

/// The relative errors of a solution, where they are known.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outlook {
    falling: [Option<Falling>; Quantity::ALL.len()],
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
        let mut outlook = Outlook::default();
        outlook.set(Quantity::Force, if known { force.over(found) } else { None });
        let peak = if error.max_pressure >= 0.0 { peak.over(measures.max_pressure) } else { None };
        outlook.set(Quantity::MaxPressure, peak);
        let area = if error.corrected_area >= 0.0 { area.over(measures.corrected_area) } else { None };
        outlook.set(Quantity::ContactArea, area);
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

/// The values of quantities without an estimate from one grid, grid by grid.
#[derive(Clone, Debug)]
pub struct History {
    sequences: Vec<(Quantity, Sequence)>,
}

impl History {
    /// Of those among `wanted` that need it.
    pub fn of(wanted: impl Iterator<Item = Quantity>) -> History {
        let needed = wanted.filter(|quantity| !quantity.has_estimate());
        History { sequences: needed.map(|quantity| (quantity, Sequence::default())).collect() }
    }

    /// Which.
    pub fn wanted(&self) -> Vec<Quantity> {
        self.sequences.iter().map(|(quantity, _)| *quantity).collect()
    }

    /// Adds the values of a grid, in the order of [`wanted`](Self::wanted), and tells the outlook what they say.
    pub fn add(&mut self, doublings: i32, values: &[Result<f64, Lack>], residual: f64, outlook: &mut Outlook) {
        for ((quantity, sequence), value) in self.sequences.iter_mut().zip(values) {
            let Ok(value) = *value else { continue };
            sequence.add(doublings, value, residual * value.abs());
            outlook.set(*quantity, sequence.falling().and_then(|falling| falling.over(value)));
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
