//! A hard case: a scene that owns its arrays. Also the shapes of surfaces that the families share.

use contact_normal::grid::Grid;
use contact_normal::influence::{HalfSpace, Kernel, Table};
use contact_normal::scene::{Bodies, Load, Scene};

/// A contact problem and its name.
#[derive(Clone)]
pub struct Case {
    /// The name says why the case is hard.
    pub name: String,
    /// The potential contact area.
    pub grid: Grid,
    /// The undeformed distance.
    pub h: Vec<f64>,
    /// The elastic constants.
    pub bodies: Bodies,
    /// Prescribed approach or force.
    pub load: Load,
    /// The caller's coefficients instead of those of the half-space.
    pub influence: Option<Table>,
}

impl std::fmt::Debug for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {:?}, {:?}, {:?}", self.name, self.grid, self.load, self.bodies)
    }
}

impl Case {
    /// A case with a rigid body on one with E* = 1.
    pub fn new(name: &str, grid: Grid, h: Vec<f64>, load: Load) -> Case {
        Case { name: name.into(), grid, h, bodies: rigid_on(1.0), load, influence: None }
    }

    /// The scene for the library.
    pub fn scene(&self) -> Scene<'_> {
        Scene { influence: self.influence.clone(), ..Scene::new(self.grid, &self.h, self.bodies, self.load) }
    }
}

/// A body of modulus `E* = 2 G/(1 - nu)` on a rigid one.
pub fn rigid_on(modulus: f64) -> Bodies {
    Bodies { shear_modulus: [0.5 * modulus, f64::INFINITY], poisson_ratio: [0.0, 0.0] }
}

/// A grid that must be valid.
pub fn grid(mx: usize, my: usize, dx: f64, dy: f64) -> Grid {
    Grid::new(mx, my, dx, dy).expect("a grid")
}

/// The position of the centre of element i, relative to the middle of the grid.
pub fn centre(grid: &Grid, i: usize) -> (f64, f64) {
    let from_middle = |i: usize, m: usize, d: f64| (i as f64 + 0.5 - 0.5 * m as f64) * d;
    (from_middle(i % grid.mx, grid.mx, grid.dx), from_middle(i / grid.mx, grid.my, grid.dy))
}

/// The undeformed distances at the centres of the elements.
pub fn distance(grid: &Grid, h: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    (0..grid.len()).map(|i| centre(grid, i)).map(|(x, y)| h(x, y)).collect()
}

/// `curvature * (x^2 + y^2)`.
pub fn paraboloid(grid: &Grid, curvature: f64) -> Vec<f64> {
    distance(grid, |x, y| curvature * (x * x + y * y))
}

/// A table of the size of the grid with the coefficients `change(kx, ky, c)`, where c is the coefficient of the half-space with E* = 1.
pub fn table(grid: &Grid, change: impl Fn(i64, i64, f64) -> f64) -> Table {
    let half_space = HalfSpace::new(grid.dx, grid.dy, rigid_on(1.0).compliance());
    let (cx, cy) = (grid.mx as i64, grid.my as i64);
    let offsets = (-cy..cy).flat_map(|ky| (-cx..cx).map(move |kx| (kx, ky)));
    let values: Vec<f64> = offsets.map(|(kx, ky)| change(kx, ky, half_space.at(kx, ky))).collect();
    Table::new(grid.mx, grid.my, &values, grid).expect("a table")
}

/// Pseudo-random numbers between 0 and 1 from a fixed seed.
pub struct Random(pub u64);

impl Random {
    /// The next number.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}
