//! The two directions of a grid: along its rows and along its columns.

use crate::grid::Grid;

/// One direction of a grid.
#[derive(Clone, Copy)]
pub struct Direction {
    /// Elements of a line along the direction.
    pub m: usize,
    /// The distance in memory from one element to the next.
    pub step: usize,
    /// Whether the direction is periodic.
    pub repeats: bool,
}

impl Direction {
    /// The directions along x and along y.
    pub fn both(grid: &Grid, repeats: (bool, bool)) -> [Direction; 2] {
        [
            Direction { m: grid.mx, step: 1, repeats: repeats.0 },
            Direction { m: grid.my, step: grid.mx, repeats: repeats.1 },
        ]
    }

    /// The number, within its line, of the element at `place`. Periodic lines go on beyond their ends; other lines have none there.
    pub fn place(&self, place: isize) -> Option<usize> {
        let m = self.m as isize;
        match (0..m).contains(&place) {
            true => Some(place as usize),
            false => self.repeats.then(|| place.rem_euclid(m) as usize),
        }
    }

    /// The distance in memory from the first element of a line to the one at `place`; none beyond the ends.
    pub fn at(&self, place: isize) -> Option<usize> {
        self.place(place).map(|place| place * self.step)
    }

    /// The length of the run of marked elements through the marked element `at`, which is number `place` of its line; at most `most`.
    pub fn run(&self, marked: &[bool], (at, place): (usize, usize), most: usize) -> usize {
        let first = at - place * self.step;
        let is_marked = |place: isize| self.at(place).is_some_and(|next| marked[first + next]);
        let behind = (1..most).take_while(|k| is_marked(place as isize + *k as isize)).count();
        let before = (1..most - behind).take_while(|k| is_marked(place as isize - *k as isize)).count();
        1 + before + behind
    }
}

/// The shorter one of the runs along x and along y, or `most` if both are longer. A line of one element has no run.
pub fn shortest_run(directions: &[Direction; 2], marked: &[bool], at: usize, most: usize) -> usize {
    let mx = directions[0].m;
    let lines = directions.iter().zip([at % mx, at / mx]).filter(|(direction, _)| direction.m > 1);
    lines.fold(most, |least, (direction, place)| direction.run(marked, (at, place), least))
}
