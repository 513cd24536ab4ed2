//! The two directions of a grid, along its rows (x) and along its columns (y), and positions along them.

use crate::grid::Grid;

/// One direction of a grid.
#[derive(Clone, Copy)]
pub struct Direction {
    /// The number of elements of a line in this direction.
    pub m: usize,
    /// The difference of the indices of two neighbours on a line.
    pub step: usize,
    /// Whether the scene is periodic in this direction.
    pub is_periodic: bool,
}

impl Direction {
    /// The directions along x and along y.
    pub fn both(grid: &Grid, (in_x, in_y): (bool, bool)) -> [Direction; 2] {
        [
            Direction { m: grid.mx, step: 1, is_periodic: in_x },
            Direction { m: grid.my, step: grid.mx, is_periodic: in_y },
        ]
    }

    /// The number, in 0..m, of the element at a position of its line. In a periodic direction, positions outside of 0..m are mapped into the period;
    /// otherwise there is no element at them.
    pub fn number(&self, position: isize) -> Option<usize> {
        let m = self.m as isize;
        match (0..m).contains(&position) {
            true => Some(position as usize),
            false => self.is_periodic.then(|| position.rem_euclid(m) as usize),
        }
    }

    /// The index of the element at a position, less that of the first element of its line. None if there is no such element.
    pub fn offset(&self, position: isize) -> Option<usize> {
        self.number(position).map(|number| number * self.step)
    }

    /// The number of consecutive marked elements on the line through a marked element, this one included; at most `most`. The element has the index
    /// `element` on the grid, and is number `number` of its line. If all elements of a periodic line are marked, the result is `most`.
    pub fn run(&self, marked: &[bool], (element, number): (usize, usize), most: usize) -> usize {
        let first = element - number * self.step;
        let is_marked = |position: isize| self.offset(position).is_some_and(|offset| marked[first + offset]);
        let after = (1..most).take_while(|k| is_marked(number as isize + *k as isize)).count();
        let before = (1..most - after).take_while(|k| is_marked(number as isize - *k as isize)).count();
        1 + before + after
    }
}

/// The shorter one of the [runs](Direction::run) along x and along y through a marked element, at most `most`. Directions of one element are left
/// out.
pub fn shortest_run(directions: &[Direction; 2], marked: &[bool], element: usize, most: usize) -> usize {
    let mx = directions[0].m;
    let lines = directions.iter().zip([element % mx, element / mx]).filter(|(direction, _)| direction.m > 1);
    lines.fold(most, |least, (direction, number)| direction.run(marked, (element, number), least))
}
