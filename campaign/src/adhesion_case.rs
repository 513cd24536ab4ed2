//! Random scenes with adhesion: balls, rough surfaces, waves and measured surfaces; all laws; approaches, and compressive or tensile forces.

use contact_normal::ffi::*;

use crate::coating;
use crate::effects::{patches, Effects, Values};
use crate::grid::{Grid, Load};
use crate::half_space::{compliance, free};
use crate::measured;
use crate::operator::Operator;
use crate::random::Random;

/// A scene with adhesion.
pub struct Case {
    pub grid: Grid,
    pub shear_modulus: [f64; 2],
    pub poisson_ratio: [f64; 2],
    /// The name of the surface.
    pub surface: String,
    /// Undeformed distances.
    pub h: Vec<f64>,
    pub load: Load,
    pub effects: Effects,
    pub law: i32,
    pub smear: f64,
    /// The work of adhesion.
    pub work: Values,
    /// The range of the attraction; 0 stands for the shortest range that the elements resolve.
    pub range: f64,
    /// The largest slope of the attraction times the influence of an element on itself.
    pub kappa: f64,
    pub start: i32,
    /// Friction of like bodies: mu, the shear strength, and the creepage of a shift divided by the range.
    pub friction: Option<(f64, f64, f64)>,
    /// The change of the approach in a second step with the same handle, if there is one.
    pub step: Option<f64>,
}

/// The largest slope of the attraction of a law, `-sigma'(e) rho^2/w`, with the range rho and the work of adhesion w.
fn steepness(law: i32, smear: f64) -> f64 {
    match law {
        CONTACT_NORMAL_LAW_DUGDALE => 0.5 / smear,
        CONTACT_NORMAL_LAW_CUBIC => 2.0 / 3.0,
        CONTACT_NORMAL_LAW_VAN_DER_WAALS => 1.5,
        _ => 1.0,
    }
}

/// The attraction sigma(e) of element i at the distance e, for the range `range`.
pub fn traction(case: &Case, range: f64, i: usize, e: f64) -> f64 {
    let t = e.max(0.0) / range;
    case.work.at(i) / range
        * match case.law {
            CONTACT_NORMAL_LAW_DUGDALE => ((1.0 + case.smear - t) / (2.0 * case.smear)).clamp(0.0, 1.0),
            CONTACT_NORMAL_LAW_CUBIC => (1.0 - t / 3.0).max(0.0).powi(2),
            CONTACT_NORMAL_LAW_VAN_DER_WAALS => (1.0 + 0.5 * t).powi(-3),
            _ => (-t).exp(),
        }
}

/// A random grid: 4 to 150 elements in each direction, or one row. Elements are square or slender.
fn grid(random: &mut Random) -> Grid {
    let dx = 10f64.powf(random.between(-7.0, 1.0));
    if random.chance(0.06) {
        return Grid { mx: random.integer(16, 600), my: 1, dx, dy: dx * random.decades(0.5, 4.0) };
    }
    let most = random.pick(&[12.0, 40.0, 40.0, 64.0, 64.0, 150.0]);
    let (mx, my) = (random.decades(4.0, most) as usize, random.decades(4.0, most) as usize);
    let (mx, my) = if random.chance(0.7) { (mx.max(my), mx.max(my)) } else { (mx, my) };
    Grid { mx, my, dx, dy: dx * if random.chance(0.7) { 1.0 } else { random.decades(0.3, 3.0) } }
}

/// A surface, and a work of adhesion and scales that suit it.
struct Surface {
    name: String,
    h: Vec<f64>,
    /// The work of adhesion.
    work: f64,
    /// The scale of forces: for balls the pull-off force.
    force: f64,
    /// The scale of approaches: the depth of contact of balls, or the height of the roughness.
    height: f64,
}

/// One or two balls. The work of adhesion is such that the contact radius without a load is 0.15 to 0.6 of half the grid.
fn balls(random: &mut Random, grid: &Grid, modulus: f64) -> Surface {
    let half = 0.5 * (grid.mx as f64 * grid.dx).min(grid.my.max(2) as f64 * grid.dy);
    let (a, radius) = (half * random.between(0.15, 0.6), half * random.decades(2.0, 1e4));
    // a^3 = 6 pi w R^2/K, K = 4/3 E* (Johnson, Kendall and Roberts 1971).
    let work = a.powi(3) * 4.0 / 3.0 * modulus / (6.0 * std::f64::consts::PI * radius * radius);
    let two = random.chance(0.2).then(|| random.between(0.3, 0.9) * half);
    let at = |k: usize, m: usize, d: f64| (k as f64 - 0.5 * (m as f64 - 1.0)) * d;
    let (x0, y0) = (random.between(-0.5, 0.5) * grid.dx, random.between(-0.5, 0.5) * grid.dy);
    let h = (0..grid.len()).map(|i| {
        let (x, y) = (at(i % grid.mx, grid.mx, grid.dx) - x0, at(i / grid.mx, grid.my, grid.dy) - y0);
        let x = two.map_or(x, |apart| x.abs() - apart);
        (x * x + y * y) / (2.0 * radius)
    });
    let force = 1.5 * std::f64::consts::PI * work * radius;
    Surface { name: "balls".into(), h: h.collect(), work, force, height: a * a / radius }
}

/// A rough surface, a punch or a wave. The work of adhesion is a part of the elastic energy per area that flattens the surface.
fn rough(random: &mut Random, grid: &Grid, modulus: f64) -> Surface {
    let (name, mut h) = measured::surface(random, grid);
    let height = grid.dx * random.decades(1e-3, 0.3);
    h.iter_mut().for_each(|h| *h *= height);
    let length = (grid.mx as f64 * grid.dx).max(grid.my as f64 * grid.dy) / random.decades(2.0, 12.0);
    let work = modulus * height * height / length * random.decades(1e-3, 0.3);
    let area = grid.len() as f64 * grid.element_area();
    Surface { name, h, work, force: modulus * height / length * area * random.decades(1e-4, 0.05), height }
}

impl Case {
    /// A random case.
    pub fn random(random: &mut Random) -> Case {
        let grid = grid(random);
        let modulus = 10f64.powf(random.between(-3.0, 12.0));
        let alike = random.chance(0.3);
        let (shear_modulus, poisson_ratio) = match alike {
            true => ([modulus; 2], [random.between(0.0, 0.49); 2]),
            false => ([modulus, random.pick(&[f64::INFINITY, 3.0 * modulus])], [random.between(0.0, 0.49), 0.3]),
        };
        let c = compliance(shear_modulus, poisson_ratio);
        let e_star = 1.0 / (std::f64::consts::PI * c);
        let surface = match random.chance(0.45) {
            true => balls(random, &grid, e_star),
            false => rough(random, &grid, e_star),
        };
        let effects = effects(random, &grid, (shear_modulus, poisson_ratio));
        let law = random.integer(0, 3) as i32;
        let smear = if law == CONTACT_NORMAL_LAW_DUGDALE { random.between(0.2, 1.0) } else { 0.3 };
        let operator = Operator::new(&grid, c, &effects);
        let kappa = if random.chance(0.9) { random.decades(0.02, 0.5) } else { random.decades(0.5, 2.0) };
        let range = (steepness(law, smear) * surface.work * operator.diagonal() / kappa).sqrt();
        let load = load(random, &surface, range);
        let load = if effects.period == Some((true, true)) { below_mean(&surface.h, load) } else { load };
        let is_line = grid.len() == 1 || grid.my == 1;
        let friction = (alike && !is_line && friction_goes(&effects) && random.chance(0.5)).then(|| {
            (random.pick(&[0.0, 0.3, 1.0]), random.pick(&[0.0, 0.5]) * surface.work / range, random.decades(0.01, 10.0))
        });
        Case {
            work: works(random, surface.work, &grid),
            range: if random.chance(0.1) { 0.0 } else { range },
            kappa,
            step: random.chance(0.25).then(|| range * random.between(-0.5, 0.5)),
            start: random.pick(&[0, 0, 0, 1, 2]),
            grid,
            shear_modulus,
            poisson_ratio,
            surface: surface.name,
            h: surface.h,
            load,
            effects,
            law,
            smear,
            friction,
        }
    }

    /// A description of the case in one line.
    pub fn describe(&self) -> String {
        let Grid { mx, my, dx, dy } = self.grid;
        let work = match &self.work {
            Values::Uniform(work) => format!("{work:e}"),
            Values::PerElement(_) => "per element".into(),
        };
        format!(
            "{mx} x {my} of {dx:e} x {dy:e}, {}, {}, law {}, work {work}, range {:e}, kappa {:.3}, {:?}, start {}, friction {:?}, step {:?}",
            self.surface, self.effects.name(), self.law, self.range, self.kappa, self.load, self.start, self.friction, self.step
        )
    }
}

/// A random work of adhesion: uniform, or one for each element, some of which are 0. The largest is `work`.
fn works(random: &mut Random, work: f64, grid: &Grid) -> Values {
    if random.chance(0.75) {
        return Values::Uniform(work);
    }
    let bare = random.pick(&[0.0, 0.3]);
    let mut of_element = |_| if random.chance(bare) { 0.0 } else { work * random.uniform() };
    let mut works: Vec<f64> = (0..grid.len()).map(&mut of_element).collect();
    // kappa belongs to the largest work, so one element has it.
    works[0] = work;
    Values::PerElement(works)
}

/// A random approach or force.
fn load(random: &mut Random, surface: &Surface, range: f64) -> Load {
    let lowest = surface.h.iter().copied().fold(f64::INFINITY, f64::min);
    match random.integer(0, 3) {
        0 | 1 => Load::Approach(lowest + random.between(-2.0, 2.0) * range + random.pick(&[0.0, 0.3]) * surface.height),
        2 => Load::Force(surface.force * random.pick(&[0.0, 0.1, 1.0, 3.0])),
        _ => Load::Force(-surface.force * random.decades(0.01, 3.0)),
    }
}

/// For two periods: replaces some loads by approaches between the first contact and the mean distance, at which full contact begins. It uses a
/// separate sequence of random numbers, so that all other scenes of the seeds stay the same.
fn below_mean(h: &[f64], load: Load) -> Load {
    let mut random = Random::new(h.iter().fold(h.len() as u64, |seed, h| seed.rotate_left(5) ^ h.to_bits()));
    let (mean, lowest) = (h.iter().sum::<f64>() / h.len() as f64, h.iter().copied().fold(f64::INFINITY, f64::min));
    match random.chance(0.4) && mean.is_finite() {
        true => Load::Approach(lowest + random.pick(&[-0.5, 0.3, 0.9, 0.99, 0.999]) * (mean - lowest)),
        false => load,
    }
}

/// Random effects that the library can solve together with adhesion.
fn effects(random: &mut Random, grid: &Grid, bodies: ([f64; 2], [f64; 2])) -> Effects {
    let mut effects = Effects::default();
    let self_influence = free(1, 1, grid.dx, grid.dy, compliance(bodies.0, bodies.1)).at(0, 0);
    match random.integer(0, 11) {
        0 => {
            let size = self_influence * random.decades(1e-2, 1.0);
            effects.layer = Some(match random.chance(0.5) {
                true => Values::Uniform(size),
                false => Values::PerElement((0..grid.len()).map(|_| size * random.uniform()).collect()),
            });
        }
        1 => effects.patches = Some(patches(random, grid)),
        2 | 3 => effects.period = Some((true, true)),
        4 => effects.period = Some(random.pick(&[(true, false), (false, true)])),
        5 if grid.len() < 2500 => {
            let period = random.chance(0.3).then_some((true, true));
            effects.coating = Some(coating::random(random, grid, bodies, period));
            effects.period = period;
        }
        _ => {}
    }
    effects
}

/// Whether the library can solve friction with these effects. With coated bodies it requires equal coatings, which are rare here, so they are left
/// out.
fn friction_goes(effects: &Effects) -> bool {
    effects.period.is_none() && effects.patches.is_none() && effects.coating.is_none()
}
