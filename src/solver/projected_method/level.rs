//! The iteration of one grid, on the window around its contact area.

use std::sync::Arc;

use super::super::monitor::Monitor;
use super::super::options::Precision;
use crate::active_set::State;
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Influence;
use crate::operator::fft::Real;
use crate::operator::{zeros, Toeplitz};
use crate::projected_cg::{Cycle, End, Iteration, Stopping, Window};
use crate::threads::Threads;

/// What the u of a state is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Displacement {
    /// A p.
    Known,
    /// Near A p.
    Near,
    /// Anything.
    Unknown,
}

/// The iteration in the precision asked for.
enum Inner {
    Single(Iteration<f32>),
    Double(Iteration<f64>),
}

impl Inner {
    /// On `grid`, of which `operator` is the one in double precision if that is known.
    fn new(
        influence: &Influence,
        grid: &Grid,
        operator: Option<&Toeplitz<f64>>,
        precision: Precision,
        threads: &Threads,
    ) -> Result<Inner> {
        fn iteration<T: Real>(
            influence: &Influence,
            grid: &Grid,
            operator: Option<&Toeplitz<f64>>,
            threads: &Threads,
        ) -> Result<Iteration<T>> {
            let operator = match operator {
                Some(operator) => operator.in_precision()?,
                None => Toeplitz::new(influence, grid, threads)?,
            };
            Iteration::new(operator, influence, grid, threads)
        }
        let threads = &threads.suited_to(grid.len());
        Ok(match precision {
            Precision::Double => Inner::Double(iteration(influence, grid, operator, threads)?),
            Precision::Auto | Precision::Mixed => Inner::Single(iteration(influence, grid, operator, threads)?),
        })
    }

    /// Sees to it that u is A p; returns the number of products done.
    fn displace(&mut self, state: &mut State, displacement: Displacement) -> u64 {
        match (self, displacement) {
            (_, Displacement::Known) => return 0,
            (Inner::Single(iteration), Displacement::Near) => iteration.correct(state),
            (Inner::Double(iteration), Displacement::Near) => iteration.correct(state),
            (Inner::Single(iteration), Displacement::Unknown) => iteration.displace(state),
            (Inner::Double(iteration), Displacement::Unknown) => iteration.displace(state),
        }
        1
    }

    fn run(&mut self, state: &mut State, stop: &Stopping, after_cycle: impl FnMut(&Cycle) -> bool) -> End {
        match self {
            Inner::Single(iteration) => iteration.run(state, stop, after_cycle),
            Inner::Double(iteration) => iteration.run(state, stop, after_cycle),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Inner::Single(iteration) => iteration.bytes(),
            Inner::Double(iteration) => iteration.bytes(),
        }
    }
}

/// The iteration on a window.
struct Windowed {
    window: Window,
    inner: Inner,
    /// The window's part of the state; none when the window is the whole grid.
    part: Option<State>,
}

/// One grid.
pub struct Level {
    grid: Grid,
    influence: Influence,
    /// Of the whole grid, in double precision, if there is one.
    operator: Option<Arc<Toeplitz<f64>>>,
    precision: Precision,
    threads: Threads,
    /// None before the first iteration.
    windowed: Option<Windowed>,
    /// Whether the next window is chosen without regard to the one there is.
    choose_anew: bool,
}

impl Level {
    /// Nothing is set up before it is needed.
    pub fn new(grid: Grid, influence: Influence, precision: Precision, threads: &Threads) -> Level {
        Level {
            grid,
            influence,
            operator: None,
            precision,
            threads: threads.clone(),
            windowed: None,
            choose_anew: true,
        }
    }

    /// Where the window is the whole grid, its operator need not be set up anew.
    pub fn with_operator(self, operator: Arc<Toeplitz<f64>>) -> Level {
        Level { operator: Some(operator), ..self }
    }

    /// The influence of an element on itself.
    pub fn self_influence(&self) -> f64 {
        self.influence.at(0, 0)
    }

    /// The coefficients of this grid.
    pub fn influence(&self) -> &Influence {
        &self.influence
    }

    /// The next window is chosen by itself, so that a result does not depend, in the last bits, on the solve before.
    pub fn forget_window(&mut self) {
        self.choose_anew = true;
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.windowed.as_ref().map_or(0, |w| w.inner.bytes() + w.part.as_ref().map_or(0, State::bytes))
    }

    /// Iterates on the window around the contact area. Outside it u is not known afterwards.
    pub fn run(
        &mut self,
        state: &mut State,
        displacement: Displacement,
        stop: &Stopping,
        finest: usize,
        monitor: &mut Monitor<'_>,
    ) -> Result<End> {
        if displacement != Displacement::Known {
            state.balance_force();
        }
        self.choose_window(state)?;
        let Some(Windowed { window, inner, part }) = &mut self.windowed else { return Ok(End::Breakdown) };
        let work = window.elements() as f64 / finest as f64;
        let grid = window.grid(&self.grid);
        if let Some(part) = part {
            window.extract(&self.grid, &state.h, &mut part.h);
            window.extract(&self.grid, &state.p, &mut part.p);
            window.extract(&self.grid, &state.contact, &mut part.contact);
            if displacement != Displacement::Unknown {
                window.extract(&self.grid, &state.u, &mut part.u);
            }
            (part.load, part.approach) = (state.load, state.approach);
        }
        let on_window = part.as_mut().unwrap_or(state);
        monitor.count_products(inner.displace(on_window, displacement), work);
        let end = inner.run(on_window, stop, |cycle| {
            monitor.count_products(cycle.products, work);
            monitor.active_set_steps += 1;
            monitor.cycle_done(&grid, cycle.changes, cycle.update, cycle.residual)
        });
        if let Some(part) = part {
            window.insert(&self.grid, &part.p, &mut state.p, 0.0);
            window.insert(&self.grid, &part.contact, &mut state.contact, false);
            state.approach = part.approach;
        }
        Ok(end)
    }

    /// The u of the last iteration, for what follows on other grids; infinite outside the window.
    pub fn take_displacements(&self, state: &mut State) {
        if let Some(Windowed { window, part: Some(part), .. }) = &self.windowed {
            window.insert(&self.grid, &part.u, &mut state.u, f64::INFINITY);
        }
    }

    fn choose_window(&mut self, state: &State) -> Result<()> {
        let current = self.windowed.as_ref().map(|windowed| &windowed.window).filter(|_| !self.choose_anew);
        let window = match self.influence.depends_on_place() {
            false => Window::around(state, current),
            true => Window::full(&self.grid),
        };
        self.choose_anew = false;
        let grid = window.grid(&self.grid);
        // The operator of a window depends on its size only.
        if let Some(windowed) = self.windowed.as_mut().filter(|windowed| windowed.window.grid(&self.grid) == grid) {
            windowed.window = window;
            return Ok(());
        }
        let operator = self.operator.as_deref().filter(|_| window.is_full(&self.grid));
        let inner = Inner::new(&self.influence, &grid, operator, self.precision, &self.threads)?;
        let part = if window.is_full(&self.grid) {
            None
        } else {
            Some(State::new(grid, zeros(grid.len(), "undeformed distances")?, state.load, state.approach)?)
        };
        self.windowed = Some(Windowed { window, inner, part });
        Ok(())
    }
}
