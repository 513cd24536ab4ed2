//! Scenes with friction: Cattaneo's ball, a rough surface, ellipses.

use std::f64::consts::PI;

use contact_normal::friction::{Solution, STICK};
use contact_normal::grid::Grid;
use contact_normal::scene::{Friction, Motion, Prescribed};
use contact_normal::solver::Measures;

/// A ball with a contact of radius 1, `mu p_0 = 1` and `G = 1`, pushed sideways until the stick area has the radius c (Cattaneo 1938; Mindlin 1949;
/// Johnson, Contact Mechanics, section 7.2). The solution is exact for nu = 0, where tractions in x cause no displacements in y.
pub struct Cattaneo {
    pub grid: Grid,
    pub bound: Vec<f64>,
    /// The shift of body 1 over body 2. It is negative, so that the force on body 1 is positive.
    pub shift: f64,
    c: f64,
}

/// The errors of a solution.
#[derive(Clone, Copy, Default)]
pub struct Compared {
    /// `sum |q - q_exact| / sum |q_exact|`.
    pub error: f64,
    /// The radius of a circle with the area of the sticking elements.
    pub stick_radius: f64,
}

impl Cattaneo {
    /// The case on m x m elements. The contact is 10/11 as wide as the grid.
    pub fn new(m: usize, c: f64) -> Cattaneo {
        let d = 2.2 / m as f64;
        let grid = Grid { mx: m, my: m, dx: d, dy: d };
        let bound = (0..grid.len()).map(|i| (1.0 - radius2(&grid, i)).max(0.0).sqrt()).collect();
        // For nu = 0 a traction displaces as a normal pressure does with E* = G. The displacement of the centre by sqrt(radius^2 - r^2) is
        // pi/2 radius^2.
        let displacement = |radius: f64| PI / 2.0 * radius * radius;
        let shift = -(displacement(1.0) - displacement(c));
        Cattaneo { grid, bound, shift, c }
    }

    /// The sum of g dx dy.
    pub fn carried(&self) -> f64 {
        self.bound.iter().sum::<f64>() * self.grid.element_area()
    }

    /// Compares a solution with the exact tractions and stick area.
    pub fn compare(&self, solution: &Solution) -> Compared {
        let (mut error, mut all, mut stick) = (0.0, 0.0, 0.0);
        for (i, q) in solution.traction.iter().enumerate() {
            let r2 = radius2(&self.grid, i);
            let exact = (1.0 - r2).max(0.0).sqrt() - (self.c * self.c - r2).max(0.0).sqrt();
            error += (q[0] - exact).hypot(q[1]);
            all += exact;
            stick += f64::from(u8::from(solution.stick_slip[i] == STICK));
        }
        Compared { error: error / all, stick_radius: (stick * self.grid.element_area() / PI).sqrt() }
    }
}

fn radius2(grid: &Grid, i: usize) -> f64 {
    let x = ((i % grid.mx) as f64 - 0.5 * (grid.mx as f64 - 1.0)) * grid.dx;
    let y = ((i / grid.mx) as f64 - 0.5 * (grid.my as f64 - 1.0)) * grid.dy;
    x * x + y * y
}

/// A shift of a rough surface: `part` of the shift at which a ball with the same approach would slide, `mu` times the approach times
/// `(2 - nu)/(2 (1 - nu))` (Ciavarella 1998; Jaeger 1998).
pub fn rough_shift(part: f64, measures: &Measures) -> Friction<'static> {
    let length = part * 0.3 * measures.approach * 1.7 / 1.4;
    Friction {
        prescribed: [Prescribed::Creepage(-0.8 * length), Prescribed::Creepage(0.6 * length)],
        spin: if part == 0.2 { length } else { 0.0 },
        ..Friction::new(0.3)
    }
}

/// A Hertz contact ellipse with semi-axes 1 and b, and a motion or force.
pub struct Ellipse {
    pub grid: Grid,
    pub nu: f64,
    pub bound: Vec<f64>,
    pub friction: Friction<'static>,
}

impl Ellipse {
    /// A random shift: b/a between 0.2 and 5, nu between 0 and 0.49; creepages over decades, or forces of up to 99 % of mu N.
    pub fn random(seed: u64, m: usize, forces: bool) -> Ellipse {
        let mut state = seed.wrapping_mul(2).wrapping_add(u64::from(forces)).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        next();
        let b = 0.2 * 25f64.powf(next());
        let nu = 0.49 * next();
        let grid = Grid { mx: m, my: m, dx: 2.2 / m as f64, dy: 2.2 * b / m as f64 };
        let bound: Vec<f64> = (0..grid.len())
            .map(|i| {
                let x = ((i % m) as f64 - 0.5 * (m as f64 - 1.0)) * grid.dx;
                let y = ((i / m) as f64 - 0.5 * (m as f64 - 1.0)) * grid.dy / b;
                (1.0 - x * x - y * y).max(0.0).sqrt()
            })
            .collect();
        let (size, angle) = (0.02 * 250f64.powf(next()), 2.0 * PI * next());
        let spin = if next() < 0.5 { 0.0 } else { 5.0 * next() * size.min(1.0) };
        let carried: f64 = bound.iter().sum::<f64>() * grid.element_area();
        let part = 0.99 * next() * carried;
        let of = |value: f64| if forces { Prescribed::Force(value * part) } else { Prescribed::Creepage(value * size) };
        let prescribed = [of(angle.cos()), of(angle.sin())];
        let friction = Friction { prescribed, spin: if forces { 0.0 } else { spin }, ..Friction::new(1.0) };
        Ellipse { grid, nu, bound, friction }
    }

    /// A random case of steady rolling, which has spin also if forces are given.
    pub fn random_rolling(seed: u64, m: usize, forces: bool) -> Ellipse {
        let mut case = Ellipse::random(seed, m, forces);
        case.friction.motion = Motion::SteadyRolling;
        if forces {
            // Spins between 0 and 0.1, with which 99 % of mu N can still be reached. Multiples of the golden ratio serve as random numbers.
            let part = (0.618 * seed as f64).fract();
            case.friction.spin = if seed % 3 == 0 { 0.1 * part } else { 0.0 };
        }
        case
    }
}
