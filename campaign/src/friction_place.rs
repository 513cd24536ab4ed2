//! The normal part of a scene with friction: grid, bodies, surface, load, and effects. Also the stopping rule of its solve.

use std::sync::Arc;

use contact_normal::ffi::CONTACT_NORMAL_CRITERION_RESIDUAL;

use crate::case::{self, Case, How};
use crate::coating::{self, Coating};
use crate::effects::{self, Effects, Values};
use crate::grid::{Grid, Load};
use crate::half_space::{compliance, free};
use crate::measured;
use crate::own_tractions::{Kind, TractionTables};
use crate::random::Random;
use crate::scales::{self, Scales};
use crate::surface;
use crate::tangential_coefficients::{Compliance, Element};

/// A scene without its friction.
#[derive(Clone, Debug)]
pub struct Place {
    pub grid: Grid,
    pub shear_modulus: [f64; 2],
    pub poisson_ratio: [f64; 2],
    /// The name of the surface.
    pub surface: String,
    /// Undeformed distances.
    pub h: Vec<f64>,
    pub load: Load,
    /// At most a coating of both bodies, a layer, a limit, and row tables of the pressures.
    pub effects: Effects,
    /// The caller's tangential coefficients, if the scene has them.
    pub traction_tables: Option<Arc<TractionTables>>,
}

/// Random shear moduli and Poisson ratios. Most bodies are alike. Some have nu = 0, for which the library starts shifts from a smaller load.
fn bodies(random: &mut Random) -> ([f64; 2], [f64; 2]) {
    let modulus = if random.chance(0.3) { random.decades(1e-6, 1e9) } else { 1.0 };
    let nu = random.between(-0.5, 0.5);
    match random.uniform() {
        u if u < 0.2 => ([modulus; 2], [0.0; 2]),
        u if u < 0.6 => ([modulus; 2], [nu; 2]),
        u if u < 0.75 => ([modulus, f64::INFINITY], [nu, 0.3]),
        _ => ([modulus, modulus * random.decades(0.1, 10.0)], [nu, random.between(0.0, 0.5)]),
    }
}

/// A random grid of up to 24 elements in each direction.
fn elements(random: &mut Random, unit: f64) -> Grid {
    let (mx, my) = match random.uniform() {
        u if u < 0.04 => (1, 1),
        u if u < 0.12 => (random.integer(2, 24), 1),
        u if u < 0.20 => (1, random.integer(2, 24)),
        _ => (random.integer(2, 24), random.integer(2, 24)),
    };
    let dy = match random.uniform() {
        u if u < 0.5 => unit,
        u if u < 0.9 => unit * random.decades(0.25, 4.0),
        _ => unit * random.decades(0.02, 50.0),
    };
    Grid { mx, my, dx: unit, dy }
}

/// A random larger grid: a square, a line or a strip.
fn large(random: &mut Random, unit: f64) -> Grid {
    let (mx, my) = match random.uniform() {
        u if u < 0.2 => (random.integer(24, 600), 1),
        u if u < 0.3 => (random.integer(50, 400), random.integer(2, 8)),
        u if u < 0.9 => (random.integer(10, 50), random.integer(10, 50)),
        _ => (random.integer(50, 100), random.integer(50, 100)),
    };
    // A separate sequence of random numbers, so that the rest of the case stays the same.
    let for_lines = &mut random.beside(0x11e5);
    if my == 1 && for_lines.chance(0.15) {
        return Grid { mx: for_lines.integer(1000, 4000), my, dx: unit, dy: unit * for_lines.decades(1e2, 1e5) };
    }
    // Lines like those of rollers: the elements are long across the line.
    if my == 1 && random.chance(0.4) {
        return Grid { mx, my, dx: unit, dy: unit * random.decades(1.0, 5.0 * mx as f64) };
    }
    let (mx, my) = if random.chance(0.5) { (mx, my) } else { (my, mx) };
    let dy = unit * if random.chance(0.6) { 1.0 } else { random.decades(0.25, 4.0) };
    Grid { mx, my, dx: unit, dy }
}

impl Place {
    /// A place with a flat surface, a force of 0 and no effects.
    pub fn new(grid: Grid, shear_modulus: [f64; 2], poisson_ratio: [f64; 2]) -> Place {
        let (surface, h) = ("flat".into(), vec![0.0; grid.len()]);
        let (load, effects) = (Load::Force(0.0), Effects::default());
        Place { grid, shear_modulus, poisson_ratio, surface, h, load, effects, traction_tables: None }
    }

    /// A random place: on a small grid, or on a larger one with a surface like measured ones.
    pub fn random(random: &mut Random, is_measured: bool) -> Place {
        let unit = if random.chance(0.3) { random.decades(1e-6, 1e6) } else { 1.0 };
        let grid = if is_measured { large(random, unit) } else { elements(random, unit) };
        let (shear_modulus, poisson_ratio) = bodies(random);
        let mut place = Place::new(grid, shear_modulus, poisson_ratio);
        if random.chance(0.08) {
            place.become_roller(random, unit);
            return place;
        }
        let surfaces = if is_measured { measured::surface } else { surface::any };
        let (surface, h) = surfaces(random, &grid);
        let height = unit * random.decades(1e-4, 1.0);
        (place.surface, place.h) = (surface, h.iter().map(|h| h * height).collect());
        // A separate sequence of random numbers, so that the rest of the case stays the same.
        let for_bodies = &mut random.beside(0xc0a7);
        // The quadrature of the campaign needs elements that are not slender.
        if for_bodies.chance(0.15) && place.is_alike() && (0.1..=10.0).contains(&(grid.dx / grid.dy)) {
            let coating = coating::on_both(for_bodies, &grid, (shear_modulus[0], poisson_ratio[0]));
            place.shear_modulus = coating.shear_modulus;
            place.effects.coating = Some(coating);
        } else if for_bodies.chance(0.1) && place.is_alike() && grid.len() <= 600 {
            place.take_tables(for_bodies);
        }
        place.press(random, is_measured);
        if random.chance(0.1) {
            let self_influence = free(1, 1, grid.dx, grid.dy, place.compliance()).at(0, 0);
            place.effects.layer = Some(effects::layer(random, &grid, self_influence));
        }
        if random.chance(0.15) {
            place.effects.limit = place.limit(random);
        }
        place
    }

    /// Adds random tables of tangential coefficients. Row tables of tractions also need row tables of pressures.
    pub fn take_tables(&mut self, random: &mut Random) {
        let (grid, kind) = (self.grid, Kind::random(random, &self.grid));
        let element = self.element();
        let at = |kx: i64, ky: i64| {
            let ([xx, yy, xy, ..], _) = element.at([kx as f64 * grid.dx, ky as f64 * grid.dy]);
            [xx, yy, xy]
        };
        let tables = TractionTables::new(kind, &grid, &at);
        self.effects.row_tables = tables.of_pressures(&grid, self.compliance());
        self.traction_tables = Some(Arc::new(tables));
    }

    /// The compliances of the materials at both surfaces: those of the coating, or of the bodies.
    pub fn materials(&self) -> Compliance {
        let coating = self.effects.coating.as_ref();
        let (modulus, ratio) = coating.map_or((self.shear_modulus, self.poisson_ratio), Coating::at_surface);
        let over_g = |values: [f64; 2]| [0, 1].map(|b: usize| values[b] / modulus[b]);
        let [shear, poisson] = [over_g([1.0; 2]), over_g(ratio)].map(|[a, b]| 0.5 * (a + b));
        let [first, second] = over_g(ratio.map(|nu| 1.0 - 2.0 * nu));
        Compliance { shear, poisson, unlike: if self.is_alike() { 0.0 } else { 0.25 * (first - second) } }
    }

    /// The tangential coefficients of half-spaces of these materials.
    pub fn element(&self) -> Element {
        Element::new(self.materials(), [self.grid.dx, self.grid.dy])
    }

    /// A random pressure limit that suits the load.
    pub fn limit(&self, random: &mut Random) -> Option<Values> {
        Some(scales::limit(random, &self.scales(), self.load, &self.h, &self.grid))
    }

    /// Becomes a smooth cylinder on a line of elements that are long across the line, so that the contact is nearly one of plane strain.
    fn become_roller(&mut self, random: &mut Random, unit: f64) {
        let (n, length) = (random.integer(3, 300), random.decades(10.0, 1e6));
        self.grid = Grid { mx: n, my: 1, dx: unit, dy: unit * length };
        let radius = unit * n as f64 * random.decades(1.0, 1e4);
        let x = |i: usize| (i as f64 + 0.5 - 0.5 * n as f64) * unit;
        self.surface = "roller".into();
        self.h = (0..n).map(|i| x(i).powi(2) / (2.0 * radius)).collect();
        // Hertz's line contact of half-width a carries the force pi E* a^2/(4 R) per length. The half-width is 0.1 to 0.45 of the line.
        let e_star = 1.0 / (std::f64::consts::PI * self.compliance());
        let a = random.between(0.1, 0.45) * n as f64 * unit;
        self.load = Load::Force(0.25 * std::f64::consts::PI * e_star * a * a / radius * self.grid.dy);
    }

    /// The compliance `c = 1/(pi E*)` of the materials at both surfaces.
    fn compliance(&self) -> f64 {
        let of_bodies = || compliance(self.shear_modulus, self.poisson_ratio);
        self.effects.coating.as_ref().map_or_else(of_bodies, Coating::compliance)
    }

    /// The scales of distances and pressures.
    fn scales(&self) -> Scales {
        Scales::of(&self.h, &Effects::default(), &self.grid, self.compliance())
    }

    /// Sets another random load.
    pub fn press(&mut self, random: &mut Random, is_measured: bool) {
        let c = self.compliance();
        self.load = match is_measured {
            true => measured::load(random, &self.grid, &self.h, c, None),
            false => case::load(random, &self.scales(), &self.grid),
        };
    }

    /// Whether the bodies are alike: tractions then cause no normal displacements, and pressures no tangential ones.
    pub fn is_alike(&self) -> bool {
        self.shear_modulus[0] == self.shear_modulus[1] && self.poisson_ratio[0] == self.poisson_ratio[1]
    }

    /// The normal problem as a case without friction. `by_tractions` are the normal displacements by tractions, which are added to h, and `rounding`
    /// is their possible round-off.
    pub fn normal(&self, stop: &Stop, by_tractions: &[f64], rounding: f64) -> Case {
        let Place { grid, shear_modulus, poisson_ratio, load, effects, .. } = self.clone();
        let how = How {
            method: 0,
            smoother: 0,
            criterion: CONTACT_NORMAL_CRITERION_RESIDUAL,
            tolerance: stop.tolerance,
            precision: stop.precision,
            threads: stop.threads,
            coarsest: 4,
            max_cycles: stop.max_cycles,
            cancel_at: stop.cancel_at,
            fixed: None,
            given: None,
        };
        let h = self.h.iter().zip(by_tractions).map(|(h, u)| h + u).collect();
        let (surface, surfaces) = (self.surface.clone(), surface::any as case::Surfaces);
        Case {
            seed: 0,
            grid,
            shear_modulus,
            poisson_ratio,
            surface,
            surfaces,
            h,
            h_rounding: rounding,
            load,
            effects,
            how,
            through_handle: false,
            is_measured: false,
        }
    }
}

/// The stopping rule of a solve.
#[derive(Clone, Debug)]
pub struct Stop {
    pub tolerance: f64,
    pub precision: i32,
    pub threads: i32,
    pub max_cycles: i32,
    /// The number of the callback's call that cancels the solve; None: never.
    pub cancel_at: Option<u32>,
}

impl Stop {
    /// A random tolerance, with 1000 cycles and without cancelling.
    pub fn unhindered(random: &mut Random) -> Stop {
        let tolerance = 10f64.powi(-(random.integer(3, 8) as i32));
        let (precision, threads) = (random.integer(0, 2) as i32, if random.chance(0.05) { 2 } else { 1 });
        Stop { tolerance, precision, threads, max_cycles: 1000, cancel_at: None }
    }

    /// The same with a tolerance of 1e-8, which is sharp enough to determine mu N.
    pub fn sharp(random: &mut Random) -> Stop {
        Stop { tolerance: 1e-8, ..Stop::unhindered(random) }
    }

    /// Whether the solve has 1000 cycles, and is not cancelled.
    pub fn is_unhindered(&self) -> bool {
        self.max_cycles == 1000 && self.cancel_at.is_none()
    }
}
