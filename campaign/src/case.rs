//! A random case: a scene with its effects, and the options of its solve. A seed determines it.

use contact_normal::ffi::*;

use crate::coating;
use crate::effects::{self, Effects};
use crate::grid::{Grid, Load};
use crate::half_space::compliance;
use crate::operator::Operator;
use crate::random::Random;
use crate::scales::{self, Scales};
use crate::surface;

/// The options of a solve.
#[derive(Clone, Debug)]
pub struct How {
    pub method: i32,
    pub smoother: i32,
    pub criterion: i32,
    pub tolerance: f64,
    pub precision: i32,
    pub threads: i32,
    pub coarsest: i32,
    pub max_cycles: i32,
    /// The number of the callback's call that cancels the solve; None: never.
    pub cancel_at: Option<u32>,
    /// The contact area, if it is fixed.
    pub fixed: Option<Vec<i32>>,
    /// The initial guess of the pressures.
    pub given: Option<Vec<f64>>,
}

/// A function that makes a random surface: its name, and undeformed distances of size about 1.
pub type Surfaces = fn(&mut Random, &Grid) -> (String, Vec<f64>);

/// A scene, and the options of its solve.
#[derive(Clone, Debug)]
pub struct Case {
    pub seed: u64,
    pub grid: Grid,
    pub shear_modulus: [f64; 2],
    pub poisson_ratio: [f64; 2],
    /// The name of the surface.
    pub surface: String,
    /// The function that makes other surfaces of this kind.
    pub surfaces: Surfaces,
    /// Undeformed distances.
    pub h: Vec<f64>,
    /// A bound on the round-off of h.
    pub h_rounding: f64,
    pub load: Load,
    pub effects: Effects,
    pub how: How,
    /// Whether the case is solved by a sequence of calls of a handle instead of one call.
    pub through_handle: bool,
    /// Whether the case is one of the module `measured`.
    pub is_measured: bool,
}

impl Case {
    /// The case of a seed.
    pub fn new(seed: u64) -> Case {
        let mut random = Random::new(seed);
        let random = &mut random;
        let unit = if random.chance(0.3) { 10f64.powi(random.integer(0, 12) as i32 - 6) } else { 1.0 };
        let modulus = if random.chance(0.3) { 10f64.powi(random.integer(0, 20) as i32 - 8) } else { 1.0 };
        let choice = effects::choose(random);
        let grid = elements(random, choice.period.is_some(), choice.row_tables, unit);
        let shear_modulus =
            [modulus, if random.chance(0.3) { f64::INFINITY } else { modulus * random.decades(0.1, 10.0) }];
        let poisson_ratio = [random.between(-0.9, 0.5), 0.3];
        let (surface, mut h) = surface::any(random, &grid);
        let height = unit * random.decades(1e-4, 1.0);
        let offset = if random.chance(0.04) { 1e9 * unit } else { 0.0 };
        h.iter_mut().for_each(|h| *h = *h * height + offset);
        let c = compliance(shear_modulus, poisson_ratio);
        let mut effects = effects::make(random, &choice, &grid, c);
        // A separate sequence of random numbers, so that the other effects of a seed stay the same.
        let for_coating = &mut Random::new(seed ^ 0xc0a7);
        // The quadrature of the campaign needs elements that are not slender.
        if for_coating.chance(0.12) && (0.1..=10.0).contains(&(grid.dx / grid.dy)) {
            effects.coating = Some(coating::random(for_coating, &grid, (shear_modulus, poisson_ratio), effects.period));
        }
        let scales = Scales::of(&h, &effects, &grid, c);
        let load = load(random, &scales, &grid);
        if choice.limit {
            effects.limit = Some(scales::limit(random, &scales, load, &h, &grid));
        }
        let how = How::any(random, &scales, &h, load, choice.limit);
        let through_handle = random.chance(0.2);
        Case {
            seed,
            grid,
            shear_modulus,
            poisson_ratio,
            surface,
            surfaces: surface::any,
            h,
            h_rounding: 0.0,
            load,
            effects,
            how,
            through_handle,
            is_measured: false,
        }
    }

    /// The next case of a sequence, with another surface and load.
    pub fn next(&self, random: &mut Random) -> Case {
        let mut next = self.clone();
        let c = compliance(self.shear_modulus, self.poisson_ratio);
        let before = Scales::of(&self.h, &self.effects, &self.grid, c);
        if random.chance(0.5) {
            let (name, h) = (self.surfaces)(random, &self.grid);
            (next.surface, next.h) = (name, h.iter().map(|h| h * before.depth).collect());
        }
        let scales = Scales::of(&next.h, &self.effects, &self.grid, c);
        next.load = load(random, &scales, &self.grid);
        if self.effects.limit.is_some() {
            next.effects.limit = Some(scales::limit(random, &scales, next.load, &next.h, &self.grid));
        }
        let how = How::any(random, &scales, &next.h, next.load, self.effects.limit.is_some());
        let set_up = &self.how;
        // These options belong to the set-up of a handle, so they stay.
        next.how = How {
            smoother: set_up.smoother,
            threads: set_up.threads,
            coarsest: set_up.coarsest,
            precision: set_up.precision,
            ..how
        };
        next
    }

    /// The matrix A, with the coefficients of the campaign.
    pub fn operator(&self) -> Operator<'_> {
        Operator::new(&self.grid, compliance(self.shear_modulus, self.poisson_ratio), &self.effects)
    }

    /// The method's name.
    pub fn method(&self) -> &'static str {
        ["AUTO", "NORM", "MULTIGRID", "FULL_MULTIGRID", "PROJECTED_CG"][self.how.method as usize]
    }

    /// A description of the scene in one line.
    pub fn describe(&self) -> String {
        let Grid { mx, my, dx, dy } = self.grid;
        let how = &self.how;
        let load = match self.load {
            Load::Approach(_) => "approach",
            Load::Force(_) => "force",
        };
        let start = match (&how.fixed, &how.given) {
            (Some(_), _) => ", fixed area",
            (_, Some(_)) => ", given",
            _ => "",
        };
        let criterion = if how.criterion == CONTACT_NORMAL_CRITERION_UPDATE { ", update" } else { "" };
        let handle = if self.through_handle { ", handle" } else { "" };
        format!(
            "{mx} x {my} of {dx:.2e} x {dy:.2e}, {}, {}, {load}, {} {:.0e}{criterion}{start}{handle}",
            self.surface,
            self.effects.name(),
            self.method(),
            how.tolerance
        )
    }
}

/// A random grid; `unit` is its unit of length.
fn elements(random: &mut Random, periodic: bool, row_tables: bool, unit: f64) -> Grid {
    let (mx, my) = match random.uniform() {
        u if u < 0.03 => (1, 1),
        u if u < 0.10 => (random.integer(2, 120), 1),
        u if u < 0.17 => (1, random.integer(2, if row_tables { 40 } else { 120 })),
        u if u < 0.45 => (random.integer(2, 12), random.integer(2, 12)),
        u if u < 0.90 => (random.integer(8, 24), random.integer(8, 24)),
        u if u < 0.98 || row_tables => (random.integer(24, 48), random.integer(24, 48)),
        _ => (random.integer(64, 112), random.integer(64, 112)),
    };
    let dx = unit * random.decades(0.1, 1.0);
    // With a period, the sums over images take long for slender elements. Without one, the round-off of the closed form is acceptable up to 1e4.
    let slenderness: f64 = if periodic { 8.0 } else { 1e4 };
    let dy = match random.uniform() {
        u if u < 0.4 => dx,
        u if u < 0.9 => dx * random.decades(0.25, 4.0),
        _ => dx * random.decades(1.0 / slenderness, slenderness),
    };
    Grid { mx, my, dx, dy }
}

/// A random approach or force, relative to the scales of the scene.
pub fn load(random: &mut Random, scales: &Scales, grid: &Grid) -> Load {
    if random.chance(0.5) {
        let part = match random.uniform() {
            u if u < 0.05 => -0.1,
            u if u < 0.1 => 0.0,
            u if u < 0.2 => 3.0,
            u if u < 0.6 => random.between(0.3, 1.0),
            _ => random.decades(1e-3, 1.0),
        };
        return Load::Approach(scales.lowest + part * scales.depth);
    }
    let part = if random.chance(0.02) { 0.0 } else { random.decades(1e-3, 30.0) };
    Load::Force(part * scales.pressure * grid.element_area() * grid.len() as f64)
}

impl How {
    /// Random options. `limited`: the scene has a pressure limit, with which few cases have a fixed contact area.
    pub fn any(random: &mut Random, scales: &Scales, h: &[f64], load: Load, limited: bool) -> How {
        let method = if random.chance(0.5) { CONTACT_NORMAL_METHOD_AUTO } else { random.integer(1, 4) as i32 };
        let fixed = random.chance(if limited { 0.01 } else { 0.08 }).then(|| contact_area(random, scales, h, load));
        let given = random.chance(0.2).then(|| guess(random, scales, h.len()));
        How {
            method,
            smoother: if random.chance(0.6) { 0 } else { random.integer(1, 4) as i32 },
            criterion: i32::from(random.chance(0.25)),
            tolerance: if random.chance(0.05) { 0.1 } else { 10f64.powi(-(random.integer(4, 8) as i32)) },
            precision: random.integer(0, 2) as i32,
            threads: if random.chance(0.05) { 2 } else { 1 },
            coarsest: if random.chance(0.8) { 4 } else { random.integer(1, 9) as i32 },
            max_cycles: if random.chance(0.08) { random.integer(1, 6) as i32 } else { 1000 },
            cancel_at: random.chance(0.05).then(|| random.integer(1, 4) as u32),
            fixed,
            given,
        }
    }

    /// Whether the solve has 1000 cycles, and is not cancelled.
    pub fn is_unhindered(&self) -> bool {
        self.max_cycles == 1000 && self.cancel_at.is_none()
    }
}

/// A random contact area of at least one element. Excluded elements (h infinite) are not in it.
fn contact_area(random: &mut Random, scales: &Scales, h: &[f64], load: Load) -> Vec<i32> {
    let level = match load {
        Load::Approach(approach) => approach,
        Load::Force(_) => scales.lowest + 0.5 * scales.depth,
    };
    let scattered = random.chance(0.3);
    let inside = |h: f64, chosen: bool| h.is_finite() && if scattered { chosen } else { h <= level };
    let mut contact: Vec<i32> = h.iter().map(|&h| i32::from(inside(h, random.chance(0.5)))).collect();
    if contact.iter().all(|&c| c == 0) {
        contact[h.iter().position(|h| h.is_finite()).unwrap_or(0)] = 1;
    }
    contact
}

/// A random initial guess: no pressures, noise, far too large pressures, pressures of both signs, or a pressure on one element.
fn guess(random: &mut Random, scales: &Scales, n: usize) -> Vec<f64> {
    let kind = random.integer(0, 4);
    let only = random.integer(0, n - 1);
    let value = |i: usize, random: &mut Random| match kind {
        0 => 0.0,
        1 => scales.pressure * random.uniform(),
        2 => scales.pressure * 1e12 * random.uniform(),
        3 => scales.pressure * random.between(-1.0, 1.0),
        _ if i == only => scales.pressure,
        _ => 0.0,
    };
    (0..n).map(|i| value(i, random)).collect()
}
