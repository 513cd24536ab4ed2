//! The two directions of a grid: along its rows and along its columns.

use crate::grid::Grid;

/// One of them.
#[derive(Clone, Copy)]
pub(super) struct Direction {
    /// Elements of a line along it.
    pub m: usize,
    /// From one of them to the next, in memory.
    pub step: usize,
    /// Whether a line goes on at its other end.
    pub repeats: bool,
}

impl Direction {
    /// Along x and along y.
    pub fn both(grid: &Grid, repeats: (bool, bool)) -> [Direction; 2] {
        [
            Direction { m: grid.mx, step: 1, repeats: repeats.0 },
            Direction { m: grid.my, step: grid.mx, repeats: repeats.1 },
        ]
    }

    /// The element of a line at `place`, by its number in the line; none beyond the ends.
    pub fn place(&self, place: isize) -> Option<usize> {
        let m = self.m as isize;
        let place = if self.repeats { place.rem_euclid(m) } else { place };
        (0..m).contains(&place).then_some(place as usize)
    }

    /// From the first element of a line to the one at `place`, in memory; none beyond the ends.
    pub fn at(&self, place: isize) -> Option<usize> {
        self.place(place).map(|place| place * self.step)
    }
}
