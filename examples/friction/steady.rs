//! Steady rolling of Hertz ellipses: the cases, and the results and numbers of products of an earlier program of this project.

use contact_normal::grid::Grid;
use contact_normal::scene::{Friction, Motion, Prescribed};

/// The Poisson ratio of all cases, whose shear modulus is 1.
pub const NU: f64 = 0.28;
/// The cases with given creepages: name, creepages in x and y, spin.
const CREEPAGES: [(&str, [f64; 2], f64); 11] = [
    ("tiny", [-0.05, 0.0], 0.0),
    ("small", [-0.3, 0.1], 0.1),
    ("medium", [-1.0, 0.5], 0.5),
    ("nearsat", [-2.0, 0.0], 0.0),
    ("large", [-3.0, 1.0], 1.0),
    ("full", [-10.0, 0.0], 0.0),
    ("lat", [0.0, -0.6], 0.0),
    ("spin .5", [0.0; 2], 0.5),
    ("spin 1.5", [0.0; 2], 1.5),
    ("spin 4", [0.0; 2], 4.0),
    ("spin 20", [0.0; 2], 20.0),
];
/// The cases with given forces: name, forces in x and y as parts of mu N, spin.
const FORCES: [(&str, [f64; 2], f64); 6] = [
    ("F .1", [0.1, 0.0], 0.0),
    ("F .5 .3, spin .5", [0.5, 0.3], 0.5),
    ("F .8", [0.8, 0.0], 0.0),
    ("F .95", [0.95, 0.0], 0.0),
    ("F .99", [0.99, 0.0], 0.0),
    ("F 0, spin 1.5", [0.0; 2], 1.5),
];

/// The ratios b/a of the semi-axes; b is across the rolling direction.
pub const RATIOS: [f64; 3] = [1.0, 0.25, 4.0];
/// The number of cases of each ratio. Those from [`FIRST_OF_FORCES`] on have given forces.
pub const CASES: usize = CREEPAGES.len() + FORCES.len();
pub const FIRST_OF_FORCES: usize = CREEPAGES.len();
/// The numbers of elements in each direction of the grids.
pub const SIZES: [usize; 4] = [32, 64, 128, 256];

/// The known results of a case: the force `F/(mu N)`, or the creepages if forces are given, on the finest grid; the products to residuals of 1e-4 and
/// of 1e-6 on grids of the four sizes.
pub type Known = ([f64; 2], [u8; 4], [u8; 4]);
#[rustfmt::skip]
pub const KNOWN: [[Known; CASES]; 3] = [
    [
        ([0.098, 0.000], [17, 19, 19, 21], [23, 26, 27, 31]),
        ([0.492, -0.212], [17, 19, 21, 26], [23, 28, 32, 40]),
        ([0.822, -0.545], [12, 13, 15, 10], [19, 22, 25, 23]),
        ([1.000, 0.000], [9, 6, 5, 5], [12, 12, 13, 13]),
        ([0.924, -0.358], [6, 6, 5, 5], [12, 12, 8, 8]),
        ([1.000, 0.000], [5, 4, 3, 3], [7, 6, 5, 5]),
        ([0.000, 0.746], [14, 16, 18, 16], [20, 23, 28, 34]),
        ([0.000, -0.337], [17, 19, 25, 21], [23, 27, 37, 36]),
        ([0.000, -0.591], [13, 17, 20, 15], [21, 26, 31, 36]),
        ([0.000, -0.349], [12, 14, 16, 15], [19, 17, 23, 23]),
        ([0.000, -0.093], [9, 11, 10, 10], [13, 13, 14, 17]),
        ([-0.051, 0.000], [17, 16, 18, 19], [23, 22, 24, 28]),
        ([-0.398, -0.482], [17, 16, 17, 20], [24, 24, 27, 32]),
        ([-0.587, 0.000], [18, 17, 18, 19], [24, 27, 28, 32]),
        ([-0.864, 0.000], [21, 15, 19, 18], [27, 24, 30, 30]),
        ([-1.046, 0.000], [22, 19, 19, 20], [28, 23, 24, 31]),
        ([0.000, -0.730], [16, 16, 18, 23], [22, 24, 27, 36]),
    ],
    [
        ([0.160, 0.000], [17, 16, 19, 24], [23, 25, 27, 35]),
        ([0.698, -0.343], [20, 23, 28, 25], [28, 33, 40, 42]),
        ([0.843, -0.514], [10, 10, 6, 5], [16, 18, 15, 15]),
        ([1.000, 0.000], [5, 4, 4, 4], [9, 9, 10, 7]),
        ([0.933, -0.336], [7, 4, 4, 4], [9, 8, 8, 8]),
        ([1.000, 0.000], [5, 4, 3, 3], [7, 6, 5, 5]),
        ([0.000, 0.980], [15, 14, 16, 26], [24, 26, 32, 38]),
        ([0.000, -0.623], [21, 26, 34, 36], [28, 34, 44, 57]),
        ([0.000, -0.711], [16, 15, 19, 22], [19, 23, 30, 36]),
        ([0.000, -0.425], [16, 14, 16, 20], [18, 21, 24, 30]),
        ([0.000, -0.126], [11, 14, 17, 17], [17, 20, 21, 20]),
        ([-0.031, 0.000], [18, 17, 18, 17], [26, 26, 29, 31]),
        ([-0.227, -0.363], [28, 24, 21, 26], [34, 33, 33, 43]),
        ([-0.359, 0.000], [19, 16, 19, 24], [25, 31, 30, 40]),
        ([-0.536, 0.000], [27, 23, 22, 22], [34, 34, 42, 46]),
        ([-0.654, 0.000], [24, 20, 25, 25], [32, 30, 38, 44]),
        ([0.000, -0.733], [22, 24, 25, 21], [28, 32, 39, 50]),
    ],
    [
        ([0.083, 0.000], [18, 20, 23, 26], [24, 26, 31, 35]),
        ([0.398, -0.171], [21, 19, 23, 26], [29, 33, 35, 40]),
        ([0.580, -0.529], [15, 15, 16, 18], [23, 23, 26, 32]),
        ([1.000, 0.000], [10, 6, 5, 5], [16, 14, 13, 13]),
        ([0.801, -0.449], [8, 8, 5, 5], [14, 14, 12, 12]),
        ([1.000, 0.000], [5, 4, 3, 3], [7, 6, 5, 5]),
        ([0.000, 0.609], [18, 15, 18, 22], [24, 23, 28, 33]),
        ([0.000, -0.231], [15, 16, 19, 20], [22, 28, 31, 34]),
        ([0.000, -0.296], [13, 13, 10, 10], [20, 20, 20, 26]),
        ([0.000, -0.164], [12, 11, 11, 14], [16, 15, 16, 20]),
        ([0.000, -0.041], [8, 7, 8, 12], [12, 13, 13, 18]),
        ([-0.061, 0.000], [18, 17, 21, 24], [24, 26, 29, 34]),
        ([-0.835, -0.661], [20, 16, 17, 13], [26, 24, 27, 32]),
        ([-0.686, 0.000], [22, 17, 18, 17], [29, 26, 30, 31]),
        ([-0.999, 0.000], [24, 16, 20, 15], [32, 26, 26, 28]),
        ([-1.201, 0.000], [21, 20, 14, 14], [31, 25, 25, 27]),
        ([0.000, -0.688], [20, 20, 25, 32], [26, 28, 30, 38]),
    ],
];

/// A case on a grid.
pub struct Rolling {
    pub name: &'static str,
    pub grid: Grid,
    pub bound: Vec<f64>,
    pub friction: Friction<'static>,
}

impl Rolling {
    /// Case `k` of the ratio b on m x m elements. The semi-axes are 1 and b, and the sides of the grid are 2.2 times as long.
    pub fn new(b: f64, k: usize, m: usize) -> Rolling {
        let (grid, bound) = ellipse(b, m);
        let carried = bound.iter().sum::<f64>() * grid.element_area();
        let (name, prescribed, spin) = match k.checked_sub(FIRST_OF_FORCES) {
            None => (CREEPAGES[k].0, CREEPAGES[k].1.map(Prescribed::Creepage), CREEPAGES[k].2),
            Some(k) => (FORCES[k].0, FORCES[k].1.map(|part| Prescribed::Force(part * carried)), FORCES[k].2),
        };
        let friction = Friction { motion: Motion::SteadyRolling, prescribed, spin, ..Friction::new(1.0) };
        Rolling { name, grid, bound, friction }
    }

    /// The sum of g dx dy.
    pub fn carried(&self) -> f64 {
        self.bound.iter().sum::<f64>() * self.grid.element_area()
    }
}

/// The grid and the pressures of Hertz on an ellipse with semi-axes 1 and b. The pressure in the middle is 1.
pub fn ellipse(b: f64, m: usize) -> (Grid, Vec<f64>) {
    let grid = Grid { mx: m, my: m, dx: 2.2 / m as f64, dy: 2.2 * b / m as f64 };
    let bound = (0..grid.len())
        .map(|i| {
            let x = ((i % m) as f64 - 0.5 * (m as f64 - 1.0)) * grid.dx;
            let y = ((i / m) as f64 - 0.5 * (m as f64 - 1.0)) * grid.dy / b;
            (1.0 - x * x - y * y).max(0.0).sqrt()
        })
        .collect();
    (grid, bound)
}
