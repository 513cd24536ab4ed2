//! The elements and the load.

/// The grid of elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    pub mx: usize,
    pub my: usize,
    pub dx: f64,
    pub dy: f64,
}

impl Grid {
    pub fn len(&self) -> usize {
        self.mx * self.my
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

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
