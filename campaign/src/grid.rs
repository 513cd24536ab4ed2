//! The grid and the load of a scene.

/// A grid of rectangular elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The number of elements in x.
    pub mx: usize,
    /// The number of elements in y.
    pub my: usize,
    /// The side of an element in x.
    pub dx: f64,
    /// The side of an element in y.
    pub dy: f64,
}

impl Grid {
    /// The number of elements.
    pub fn len(&self) -> usize {
        self.mx * self.my
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The area of one element.
    pub fn element_area(&self) -> f64 {
        self.dx * self.dy
    }
}

/// The prescribed load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    Approach(f64),
    Force(f64),
}
