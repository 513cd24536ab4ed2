//! Scenes with friction: Cattaneo's ball, a rough surface, ellipses.

use std::f64::consts::PI;

use contact_normal::friction::{Solution, STICK};
use contact_normal::grid::Grid;
use contact_normal::scene::{Friction, Motion, Prescribed};
use contact_normal::solver::Measures;

/// Hertz' pressures of a ball with radius of contact 1 and `mu p_0 = 1`, `G = 1`, pushed sideways until the stick area has the radius c
/// (Cattaneo 1938; Mindlin 1949; Johnson, Contact Mechanics, section 7.2). Exact for nu = 0, where tractions in x displace nothing in y.
pub struct Cattaneo {
    pub grid: Grid,
    pub bound: Vec<f64>,
    /// The shift, of body 1 over body 2: negative, so that the force is positive.
    pub shift: f64,
    c: f64,
}

/// A solution beside the exact one.
#[derive(Clone, Copy, Default)]
pub struct Compared {
    /// `sum |q - q_exact| / sum |q_exact|`.
    pub error: f64,
    /// Radius of a disc of the area that sticks.
    pub stick_radius: f64,
}

impl Cattaneo {
    /// On m x m elements, C being 10/11 of the grid across.
    pub fn new(m: usize, c: f64) -> Cattaneo {
        let d = 2.2 / m as f64;
        let grid = Grid { mx: m, my: m, dx: d, dy: d };
        let bound = (0..grid.len()).map(|i| (1.0 - radius2(&grid, i)).max(0.0).sqrt()).collect();
        // At nu = 0 u(0) of g is that of a normal pressure with E* = G: pi/2 times the slope of the paraboloid, 1, times the radius.
        let displacement = |radius: f64| PI / 2.0 * radius * radius;
        let shift = -(displacement(1.0) - displacement(c));
        Cattaneo { grid, bound, shift, c }
    }

    /// The sum of g dx dy.
    pub fn carried(&self) -> f64 {
        self.bound.iter().sum::<f64>() * self.grid.element_area()
    }

    /// Beside the exact tractions.
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

/// A shift of a part of that at which all of a rough surface would slide, were it a ball's: `mu` times the approach, times
/// `(2 - nu)/(2 (1 - nu))` (Ciavarella 1998; Jaeger 1998).
pub fn rough_shift(part: f64, measures: &Measures) -> Friction<'static> {
    let length = part * 0.3 * measures.approach * 1.7 / 1.4;
    Friction {
        prescribed: [Prescribed::Creepage(-0.8 * length), Prescribed::Creepage(0.6 * length)],
        spin: if part == 0.2 { length } else { 0.0 },
        ..Friction::new(0.3)
    }
}

/// An ellipse of Hertz with semi-axes 1 and b.
pub struct Ellipse {
    pub grid: Grid,
    pub nu: f64,
    pub bound: Vec<f64>,
    pub friction: Friction<'static>,
}

impl Ellipse {
    /// b/a in 0.2 .. 5, nu in 0 .. 0.49; motions over decades, or forces up to 99 % of mu N.
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

    /// The same, in steady rolling; with forces spin, too.
    pub fn random_rolling(seed: u64, m: usize, forces: bool) -> Ellipse {
        let mut case = Ellipse::random(seed, m, forces);
        case.friction.motion = Motion::SteadyRolling;
        if forces {
            // From none to as much as leaves 99 % of mu N: golden ratio, as if random.
            let part = (0.618 * seed as f64).fract();
            case.friction.spin = if seed % 3 == 0 { 0.1 * part } else { 0.0 };
        }
        case
    }
}
