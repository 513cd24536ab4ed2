//! The iteration on one grid (a "level" of nested iteration), restricted to the window around its contact area.

use super::inner::{in_either, Inner};
use super::part::{enter, leave};
use super::punches::Punches;
use super::scaling::Scaling;
use super::vectors::Inputs;
use super::window;
use crate::contact::{AdmissibleSet, Freshness, State};
use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::operator::Precision;
use crate::operator::{reserve, Operator};
use crate::rectangle::Rectangle;
use crate::threads::Threads;

/// The iteration on a window.
struct Windowed {
    window: Rectangle,
    inner: Inner,
    /// The units of the last iteration.
    units: Scaling,
    /// The part of the state in the window, in the iteration's units. None if the window is the whole grid and the units are those of the scene: the
    /// iteration then works on the state itself.
    part: Option<State>,
    /// Whether the iteration has the present coefficients.
    is_current: bool,
}

/// One grid, and the iteration on its window.
pub struct Level {
    grid: Grid,
    coefficients: Coefficients,
    precision: Precision,
    threads: Threads,
    /// None before the first iteration.
    windowed: Option<Windowed>,
    /// The pressure limits of the window's elements in the iteration's units, if the scene has limits.
    limits: Vec<f64>,
    /// The last window, which is used again if it fits. None: the next window depends on the state only.
    current: Option<Rectangle>,
}

impl Level {
    /// Creates the level of a grid. Its operators are set up when needed.
    pub fn new(grid: Grid, coefficients: Coefficients, precision: Precision, threads: &Threads) -> Level {
        Level {
            grid,
            coefficients,
            precision,
            threads: threads.clone(),
            windowed: None,
            limits: Vec::new(),
            current: None,
        }
    }

    /// Whether the next window is the whole grid.
    pub fn fills_grid(&self, state: &State) -> bool {
        self.window(state).is_full(&self.grid)
    }

    /// Replaces the coefficients on the same grid. The window's operators are updated when they are needed.
    pub fn renew(&mut self, coefficients: Coefficients) {
        self.coefficients = coefficients;
        if let Some(windowed) = &mut self.windowed {
            windowed.is_current = false;
        }
    }

    /// The displacement of an element by a unit pressure on itself.
    pub fn self_influence(&self) -> f64 {
        self.coefficients.self_influence()
    }

    /// The threads of the solve.
    pub fn threads(&self) -> &Threads {
        &self.threads
    }

    /// The coefficients of this grid.
    pub fn coefficients(&self) -> &Coefficients {
        &self.coefficients
    }

    /// Whether the grid is a line in plane strain on which a uniform pressure displaces nothing.
    pub(super) fn is_mean_free_line(&self) -> bool {
        self.coefficients.is_mean_free() && Punches::serve(&self.coefficients, &self.grid)
    }

    /// Forgets the window, so that the bits of the next result do not depend on the solve before.
    pub fn forget_window(&mut self) {
        self.current = None;
    }

    /// The window of the last iteration.
    pub fn current_window(&self) -> Option<Rectangle> {
        self.current.clone()
    }

    /// Makes `window` the last window.
    pub fn go_back_to(&mut self, window: Option<Rectangle>) {
        self.current = window;
    }

    /// Bytes of the coefficients and of the iteration on the window.
    pub fn bytes(&self) -> usize {
        let windowed = |w: &Windowed| w.inner.bytes() + w.part.as_ref().map_or(0, State::bytes);
        self.coefficients.bytes() + self.windowed.as_ref().map_or(0, windowed)
    }

    /// Calls `work` with the part of `state` in the window around the contact area, in the iteration's units. Then copies p, C and the approach back.
    /// `whole` is the operator of the whole grid in double precision, if it exists.
    pub(super) fn on_window<S: AdmissibleSet, R>(
        &mut self,
        (state, set): (&mut State, S),
        displacement: Freshness,
        whole: Option<&Operator<f64>>,
        work: impl FnOnce(&mut Inner, &Rectangle, &Scaling, &mut State, S::Within<'_>) -> R,
    ) -> Result<R> {
        let mut limits = std::mem::take(&mut self.limits);
        let threads = &self.threads.clone();
        let Windowed { window, inner, units, part, .. } = self.choose_window(state, whole)?;
        let grid = window.grid(&state.grid);
        in_either!(inner, inner => inner.wake(grid.len()));
        if S::LIMITED {
            reserve(&mut limits, grid.len(), "limits of the pressures")?;
            limits.clear();
            let mx = state.grid.mx;
            let elements = window.y.clone().flat_map(|y| window.x.clone().map(move |x| y * mx + x));
            limits.extend(elements.map(|i| set.limit(i) * units.pressure()));
            in_either!(inner, inner => inner.reserve_for_limits()?);
        }
        let Some(part) = part else {
            let result = work(inner, window, units, state, S::within(&limits));
            in_either!(inner, inner => inner.rest());
            self.limits = limits;
            return Ok(result);
        };
        enter::<S>((window, units), state, part, displacement, threads)?;
        let result = work(inner, window, units, part, S::within(&limits));
        in_either!(inner, inner => inner.rest());
        leave::<S>((window, units), part, state, threads);
        self.limits = limits;
        Ok(result)
    }

    /// Releases the memory of the window's part of the state until it is needed.
    pub fn rest(&mut self) {
        let part = self.windowed.as_mut().and_then(|windowed| windowed.part.as_mut());
        part.into_iter().for_each(State::rest);
    }

    /// Sets the state's u to that of the last iteration, from which the next finer grid interpolates. u is infinite outside the window.
    pub fn take_displacements(&self, state: &mut State) {
        if let Some(Windowed { window, part: Some(part), .. }) = &self.windowed {
            window.insert(&self.grid, &part.u, &mut state.u, f64::INFINITY, &self.threads);
        }
    }

    /// The window of an iteration that starts from `state`.
    pub fn window(&self, state: &State) -> Rectangle {
        match self.coefficients.depends_on_place() {
            false => window::around(state, self.current.as_ref(), self.coefficients.is_even(&self.grid), &self.threads),
            true => Rectangle::full(&self.grid),
        }
    }

    /// Whether contact is scattered: it fills less than half of the window, and the window is not the whole grid. Elements outside may then enter C.
    pub fn is_scattered(&self, state: &State) -> bool {
        let window = self.window(state);
        !window.is_full(&self.grid) && 2 * state.contact_count() < window.count()
    }

    /// Chooses the window for `state`, and sets up or updates the iteration on it.
    fn choose_window(&mut self, state: &State, whole: Option<&Operator<f64>>) -> Result<&mut Windowed> {
        let window = self.window(state);
        self.current = Some(window.clone());
        let grid = window.grid(&self.grid);
        let units = match self.precision {
            Precision::Double => Scaling::SAME,
            Precision::Auto | Precision::Mixed => Scaling::for_state(state, self.self_influence(), &self.threads),
        };
        let part = if window.is_full(&self.grid) && units == Scaling::SAME {
            None
        } else {
            Some(|| State::at_rest(grid, (state.load, state.approach), &self.threads))
        };
        // The operator of a window depends on the window's size, not on its position.
        let whole = whole.filter(|_| window.is_full(&self.grid));
        let threads = &self.threads.suited_to(grid.len());
        let inputs = Inputs { coefficients: &self.coefficients, factor: units.influence, whole, threads };
        let serves = |windowed: &Windowed| windowed.window.grid(&self.grid) == grid;
        let windowed = match self.windowed.take().filter(serves) {
            Some(mut windowed) => {
                if !windowed.is_current {
                    windowed.inner.renew(inputs, &grid)?;
                }
                windowed.part = windowed.part.filter(|part| part.grid == grid);
                let part = match (part, windowed.part) {
                    (Some(new), None) => Some(new()?),
                    (part, known) => known.filter(|_| part.is_some()),
                };
                Windowed { window, units, inner: windowed.inner, part, is_current: true }
            }
            None => {
                let inner = Inner::new(inputs, &grid, self.precision)?;
                let part = part.map(|new| new()).transpose()?;
                Windowed { window, inner, units, part, is_current: true }
            }
        };
        Ok(self.windowed.insert(windowed))
    }
}
