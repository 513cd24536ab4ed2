//! A random case with friction: bodies pressed together, how they slide, and when the solve stops.

use contact_normal::ffi::*;

use crate::case;
use crate::effects::Effects;
use crate::friction_found::Found;
use crate::grid::{Grid, Load};
use crate::half_space::compliance;
use crate::random::Random;
use crate::scales::Scales;
use crate::surface;

/// The bodies and what presses them together.
#[derive(Clone, Debug)]
pub struct Place {
    pub grid: Grid,
    pub shear_modulus: [f64; 2],
    pub poisson_ratio: [f64; 2],
    pub surface: String,
    pub h: Vec<f64>,
    pub load: Load,
}

impl Place {
    /// A flat surface that nothing presses.
    pub fn new(grid: Grid, shear_modulus: [f64; 2], poisson_ratio: [f64; 2]) -> Place {
        Place {
            grid,
            shear_modulus,
            poisson_ratio,
            surface: "flat".into(),
            h: vec![0.0; grid.len()],
            load: Load::Force(0.0),
        }
    }

    pub fn random(random: &mut Random) -> Place {
        let unit = if random.chance(0.3) { random.decades(1e-6, 1e6) } else { 1.0 };
        let (mx, my) = match random.uniform() {
            u if u < 0.04 => (1, 1),
            u if u < 0.12 => (random.integer(2, 24), 1),
            u if u < 0.20 => (1, random.integer(2, 24)),
            _ => (random.integer(2, 24), random.integer(2, 24)),
        };
        let dy = unit * if random.chance(0.5) { 1.0 } else { random.decades(0.25, 4.0) };
        let modulus = if random.chance(0.3) { random.decades(1e-6, 1e9) } else { 1.0 };
        let nu = random.between(-0.5, 0.5);
        let (shear_modulus, poisson_ratio) = match random.uniform() {
            // Without nu shifts start from a smaller load.
            u if u < 0.2 => ([modulus; 2], [0.0; 2]),
            u if u < 0.7 => ([modulus; 2], [nu; 2]),
            u if u < 0.8 => ([modulus, f64::INFINITY], [nu, 0.3]),
            _ => ([modulus, modulus * random.decades(0.1, 10.0)], [nu, random.between(0.0, 0.5)]),
        };
        let mut place = Place::new(Grid { mx, my, dx: unit, dy }, shear_modulus, poisson_ratio);
        let (surface, h) = surface::any(random, &place.grid);
        let height = unit * random.decades(1e-4, 1.0);
        (place.surface, place.h) = (surface, h.iter().map(|h| h * height).collect());
        let c = compliance(shear_modulus, poisson_ratio);
        let scales = Scales::of(&place.h, &Effects::default(), &place.grid, c);
        place.load = case::load(random, &scales, &place.grid);
        place
    }

    /// Whether pressures and tractions know nothing of each other.
    pub fn is_alike(&self) -> bool {
        self.shear_modulus[0] == self.shear_modulus[1] && self.poisson_ratio[0] == self.poisson_ratio[1]
    }
}

/// How they slide.
#[derive(Clone, Debug)]
pub struct Slide {
    pub mu: Vec<f64>,
    /// Given as one number.
    pub uniform: bool,
    pub motion: i32,
    pub prescribed: [i32; 2],
    /// The creepages or the forces.
    pub amount: [f64; 2],
    pub spin: f64,
    pub spin_centre: [f64; 2],
    /// As it is given: 0 is dx.
    pub distance: f64,
    pub direction: f64,
    pub previous: Option<[Vec<f64>; 2]>,
    pub rigid: Option<[Vec<f64>; 2]>,
    /// Whether the derivatives of the forces are asked for.
    pub sensitivities: bool,
}

impl Slide {
    pub fn has_forces(&self) -> bool {
        self.prescribed.contains(&CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE)
    }

    fn length(&self, grid: &Grid) -> f64 {
        match self.motion {
            CONTACT_NORMAL_MOTION_SHIFT => 1.0,
            _ if self.distance == 0.0 => grid.dx,
            _ => self.distance,
        }
    }

    /// Where particles were before the step; of a shift here.
    pub fn step(&self, grid: &Grid) -> [f64; 2] {
        if self.motion == CONTACT_NORMAL_MOTION_SHIFT {
            return [0.0; 2];
        }
        let (sine, cosine) = self.direction.sin_cos();
        let clean = |value: f64| if value.abs() < 1e-15 { 0.0 } else { value };
        [self.length(grid) * clean(cosine), self.length(grid) * clean(sine)]
    }

    /// The rigid slip of an element with the creepages of the report, and of what size its terms are.
    pub fn rigid_slip(&self, grid: &Grid, i: usize, creepage: [f64; 2]) -> ([f64; 2], f64) {
        let (step, length) = (self.step(grid), self.length(grid));
        let centre = |k: usize, m: usize, d: f64| (k as f64 - 0.5 * (m as f64 - 1.0)) * d;
        let x = centre(i % grid.mx, grid.mx, grid.dx) - self.spin_centre[0] + step[0] / 6.0;
        let y = centre(i / grid.mx, grid.my, grid.dy) - self.spin_centre[1] + step[1] / 6.0;
        let own = self.rigid.as_ref().map_or([0.0; 2], |own| [own[0][i], own[1][i]]);
        let arms = self.spin_centre[0].abs() + self.spin_centre[1].abs() + x.abs() + y.abs();
        let sizes = length * (creepage[0].abs() + creepage[1].abs() + self.spin.abs() * arms);
        let w = [length * (creepage[0] - self.spin * y) + own[0], length * (creepage[1] + self.spin * x) + own[1]];
        (w, sizes + own[0].abs() + own[1].abs())
    }

    /// The tractions before the step.
    pub fn before(&self) -> Vec<[f64; 2]> {
        let at = |i: usize| self.previous.as_ref().map_or([0.0; 2], |before| [before[0][i], before[1][i]]);
        (0..self.mu.len()).map(at).collect()
    }
}

/// When the solve stops.
#[derive(Clone, Debug)]
pub struct Stop {
    pub tolerance: f64,
    pub precision: i32,
    pub threads: i32,
    pub max_cycles: i32,
    pub cancel_at: Option<u32>,
}

impl Stop {
    pub fn unhindered(random: &mut Random) -> Stop {
        let tolerance = 10f64.powi(-(random.integer(3, 8) as i32));
        let (precision, threads) = (random.integer(0, 2) as i32, if random.chance(0.05) { 2 } else { 1 });
        Stop { tolerance, precision, threads, max_cycles: 1000, cancel_at: None }
    }

    pub fn is_unhindered(&self) -> bool {
        self.max_cycles == 1000 && self.cancel_at.is_none()
    }
}

/// A case.
pub struct Case {
    pub place: Place,
    pub slide: Slide,
    pub stop: Stop,
    /// mu N of the same scene without friction.
    pub carried: f64,
}

/// mu of the elements, and what motions go by: extremes do not say what moves.
fn coefficients(random: &mut Random, n: usize) -> (Vec<f64>, bool, f64) {
    let mu = match random.uniform() {
        u if u < 0.05 => 0.0,
        u if u < 0.10 => 1e9,
        u if u < 0.15 => random.decades(1e-9, 1e9),
        _ => random.between(0.05, 1.0),
    };
    let usual = if (0.01..=10.0).contains(&mu) { mu } else { 0.3 };
    if random.chance(0.7) {
        return (vec![mu; n], true, usual);
    }
    let zeros = random.between(0.0, 0.5);
    let value = |random: &mut Random| if random.chance(zeros) { 0.0 } else { mu * random.between(0.5, 1.5) };
    ((0..n).map(|_| value(random)).collect(), false, usual)
}

/// A step in elements: the last tenth of 0.3 to 3 stands for 3 to 1e5, in the longer direction.
fn step(length: f64) -> f64 {
    let beyond = (length - 2.9) / 0.1;
    if beyond > 0.0 {
        (3.0 * (1e5f64 / 3.0).powf(beyond)).round()
    } else {
        length
    }
}

impl Case {
    /// A motion or forces of the size that the bodies' pressures suggest.
    pub fn random(random: &mut Random, place: Place, without: &Found) -> Case {
        let (grid, n) = (place.grid, place.grid.len());
        let (mu, uniform, usual) = coefficients(random, n);
        let motion = random.integer(0, 2) as i32;
        let is_shift = motion == CONTACT_NORMAL_MOTION_SHIFT;
        let size = (grid.mx as f64 * grid.dx).max(grid.my as f64 * grid.dy);
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, |a: f64, b| a.max(b.abs()));
        let slip = usual * largest(&without.u);
        let creepage = if is_shift { slip } else { slip / size };
        let normal: f64 = mu.iter().zip(&without.p).map(|(mu, p)| mu * p * grid.element_area()).sum();
        let prescribed = [0, 1].map(|_| i32::from(random.chance(0.25)));
        let given = prescribed.iter().filter(|&&k| k == CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE).count();
        let signed = |random: &mut Random, value: f64| if random.chance(0.5) { value } else { -value };
        let amount = prescribed.map(|kind| {
            let part = match kind {
                CONTACT_NORMAL_PRESCRIBED_CREEPAGE => match random.uniform() {
                    u if u < 0.1 => 0.0,
                    u if u < 0.2 => creepage * random.decades(1e-12, 1e6),
                    _ => creepage * random.decades(0.01, 10.0),
                },
                _ if random.chance(0.05) => normal * random.decades(1.0, 1e9),
                _ => normal * random.decades(1e-3, 0.99) / (given as f64).sqrt(),
            };
            signed(random, part)
        });
        let spin = if random.chance(0.5) { creepage / size * random.decades(0.1, 10.0) } else { 0.0 };
        let pressure = largest(&without.p);
        let garbage = usual * pressure * random.pick(&[0.1, 1.0, 1.0, 1e3, 1e9]);
        let noise =
            |random: &mut Random, size: f64| -> Vec<f64> { (0..n).map(|_| size * random.between(-1.0, 1.0)).collect() };
        let previous = random.chance(0.3).then(|| [0, 1].map(|_| noise(random, garbage)));
        let own_size = slip * random.decades(0.01, 1.0) * if is_shift { 1.0 } else { grid.dx / size };
        let slide = Slide {
            mu,
            uniform,
            motion,
            prescribed,
            amount,
            spin: signed(random, spin),
            spin_centre: if random.chance(0.8) { [0.0; 2] } else { [size * random.between(-2.0, 2.0), 0.3 * size] },
            distance: if random.chance(0.6) { 0.0 } else { grid.dx.max(grid.dy) * step(random.between(0.3, 3.0)) },
            direction: match random.uniform() {
                u if u < 0.4 => 0.0,
                u if u < 0.7 => random.pick(&[0.5, 1.0, 1.5]) * std::f64::consts::PI,
                _ => random.between(0.0, 6.0),
            },
            previous,
            rigid: random.chance(0.15).then(|| [0, 1].map(|_| noise(random, own_size))),
            sensitivities: false,
        };
        let mut stop = Stop::unhindered(random);
        if random.chance(0.1) {
            stop.max_cycles = random.integer(1, 30) as i32;
        }
        if random.chance(0.1) {
            stop.cancel_at = Some(random.integer(1, 30) as u32);
        }
        Case { place, slide, stop, carried: normal }
    }

    /// Forces beyond mu N, or less where something else takes a part of it: what a spin leaves is not known here.
    pub fn may_be_infeasible(&self) -> bool {
        let Slide { prescribed, amount, spin, rigid, previous, .. } = &self.slide;
        let given = |k: usize| prescribed[k] == CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE;
        let force = [0, 1].map(|k| if given(k) { amount[k] } else { 0.0 });
        let else_moves = *spin != 0.0 || rigid.is_some() || previous.is_some();
        let moves = else_moves || (0..2).any(|k| !given(k) && amount[k] != 0.0);
        // A force of 0 is met where nothing is carried.
        let nothing = force == [0.0; 2] && self.carried == 0.0;
        self.slide.has_forces()
            && !nothing
            && (force[0].hypot(force[1]) >= 0.99 * self.carried || moves || !self.place.is_alike())
    }

    /// What the motion is called.
    pub fn motion(&self) -> &'static str {
        ["shift", "transient rolling", "steady rolling"][self.slide.motion as usize]
    }

    /// The motion and whether bodies are alike.
    pub fn kind(&self) -> String {
        format!("{}, {} bodies", self.motion(), if self.place.is_alike() { "like" } else { "unlike" })
    }

    /// In one line.
    pub fn describe(&self) -> String {
        let Grid { mx, my, dx, dy } = self.place.grid;
        let (slide, stop) = (&self.slide, &self.stop);
        let alike = if self.place.is_alike() { "like" } else { "unlike" };
        let mu = slide.mu.iter().copied().fold(0.0, f64::max);
        let more = format!(
            "{}{}",
            if slide.previous.is_some() { ", previous" } else { "" },
            if slide.rigid.is_some() { ", own slip" } else { "" }
        );
        format!(
            "{mx} x {my} of {dx:.2e} x {dy:.2e}, {}, {alike}, {}, mu {mu:.1e} ({}), prescribed {:?} {:?}, spin {:.1e}{more}, \
             tolerance {:.0e}, precision {}, cycles {}, cancel {:?}, step {:?}",
            self.place.surface,
            self.motion(),
            slide.uniform,
            slide.prescribed,
            slide.amount,
            slide.spin,
            stop.tolerance,
            stop.precision,
            stop.max_cycles,
            stop.cancel_at,
            slide.step(&self.place.grid),
        )
    }
}
