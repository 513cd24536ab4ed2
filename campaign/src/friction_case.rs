//! A random case with friction: the bodies and their load, the friction and the motion, and the stopping rule.

use contact_normal::ffi::*;

use crate::friction_found::{Before, Found};
use crate::friction_place::{Place, Stop};
use crate::grid::{Grid, Load};
use crate::random::Random;
use crate::rules;
use crate::slide::Slide;

/// A case with friction.
#[derive(Clone)]
pub struct Case {
    pub place: Place,
    pub slide: Slide,
    pub stop: Stop,
    /// mu N of the same scene without friction.
    pub carried: f64,
}

/// Random friction coefficients of n elements, whether they are uniform, and a usual coefficient for the scale of motions.
fn coefficients(random: &mut Random, n: usize, is_roller: bool) -> (Vec<f64>, bool, f64) {
    let mu = match random.uniform() {
        u if is_roller && u < 0.5 => random.decades(1e-6, 0.01),
        u if u < 0.05 => 0.0,
        u if u < 0.10 => 1e9,
        u if u < 0.15 => random.decades(1e-9, 1e9),
        u if u < 0.35 => random.decades(1e-6, 0.05),
        _ => random.between(0.05, 1.0),
    };
    let usual = if (1e-6..=10.0).contains(&mu) { mu } else { 0.3 };
    if random.chance(0.7) {
        return (vec![mu; n], true, usual);
    }
    let zeros = random.between(0.0, 0.5);
    let value = |random: &mut Random| if random.chance(zeros) { 0.0 } else { mu * random.between(0.5, 1.5) };
    ((0..n).map(|_| value(random)).collect(), false, usual)
}

/// A random force relative to mu N: 0, nearly 0, a part, nearly all, or more. For unlike bodies tractions change mu N by some hundredths.
fn part_of_friction(random: &mut Random) -> f64 {
    match random.uniform() {
        u if u < 0.02 => random.between(0.99, 1.02),
        u if u < 0.05 => random.decades(1.0, 1e9),
        u if u < 0.15 => 0.0,
        u if u < 0.25 => random.decades(1e-9, 1e-3),
        u if u < 0.45 => 1.0 - random.decades(1e-4, 0.1),
        _ => random.decades(1e-3, 0.99),
    }
}

/// A rolling distance in units of the longer side of an element. Lengths up to 2.9 stay; those from 2.9 to 3 become whole numbers from 3 to 1e5.
fn step(length: f64) -> f64 {
    let beyond = (length - 2.9) / 0.1;
    if beyond > 0.0 {
        (3.0 * (1e5f64 / 3.0).powf(beyond)).round()
    } else {
        length
    }
}

impl Case {
    /// A random case. Creepages and forces are relative to the displacements and pressures of the scene without friction.
    pub fn random(random: &mut Random, place: Place, without: &Found) -> Case {
        let (grid, n) = (place.grid, place.grid.len());
        let is_roller = place.surface == "roller";
        let (mu, uniform, usual) = coefficients(random, n, is_roller);
        let motion = if is_roller && random.chance(0.6) { 2 } else { random.integer(0, 2) as i32 };
        let is_shift = motion == CONTACT_NORMAL_MOTION_SHIFT;
        let size = (grid.mx as f64 * grid.dx).max(grid.my as f64 * grid.dy);
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, |a: f64, b| a.max(b.abs()));
        let slip = usual * largest(&without.u);
        let creepage = if is_shift { slip } else { slip / size };
        let carried: f64 = mu.iter().zip(&without.p).map(|(mu, p)| mu * p * grid.element_area()).sum();
        let prescribed = [0, 1].map(|k| i32::from(random.chance(if is_roller && k == 0 { 0.7 } else { 0.25 })));
        let force_count = prescribed.iter().filter(|&&k| k == CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE).count();
        let signed = |random: &mut Random, value: f64| if random.chance(0.5) { value } else { -value };
        let amount = prescribed.map(|kind| {
            let part = match kind {
                CONTACT_NORMAL_PRESCRIBED_CREEPAGE => match random.uniform() {
                    u if u < 0.1 => 0.0,
                    u if u < 0.2 => creepage * random.decades(1e-12, 1e6),
                    _ => creepage * random.decades(0.01, 10.0),
                },
                _ => carried * part_of_friction(random) / (force_count as f64).sqrt(),
            };
            signed(random, part)
        });
        let spin = if random.chance(0.5) { creepage / size * random.decades(0.1, 10.0) } else { 0.0 };
        let pressure = largest(&without.p);
        let garbage = usual * pressure * random.pick(&[0.1, 1.0, 1.0, 1e3, 1e9]);
        let noise =
            |random: &mut Random, size: f64| -> Vec<f64> { (0..n).map(|_| size * random.between(-1.0, 1.0)).collect() };
        let previous = random.chance(0.3).then(|| [0, 1].map(|_| noise(random, garbage)));
        let rigid_size = slip * random.decades(0.01, 1.0) * if is_shift { 1.0 } else { grid.dx / size };
        let mut slide = Slide {
            mu,
            uniform,
            motion,
            prescribed,
            amount,
            spin: signed(random, spin),
            spin_centre: if random.chance(0.8) { [0.0; 2] } else { [size * random.between(-2.0, 2.0), 0.3 * size] },
            distance: if is_roller || random.chance(0.6) {
                0.0
            } else {
                // For coatings the campaign has a table along the distance, whose length is limited.
                let longest = if place.effects.coating.is_some() { 30.0 } else { f64::INFINITY };
                let elements = step(random.between(0.3, 3.0)).min(longest);
                (grid.dx.max(grid.dy) * elements).min(1e6 * grid.dx.min(grid.dy))
            },
            direction: match random.uniform() {
                u if is_roller => [0.0, std::f64::consts::PI][usize::from(u < 0.5)],
                u if u < 0.4 => 0.0,
                u if u < 0.7 => random.pick(&[0.5, 1.0, 1.5]) * std::f64::consts::PI,
                _ => random.between(0.0, 6.0),
            },
            previous,
            rigid: random.chance(0.15).then(|| [0, 1].map(|_| noise(random, rigid_size))),
            sensitivities: false,
        };
        if let Some(tables) = &place.traction_tables {
            slide.fit(&tables.kind, &mut random.beside(0x7ab1e), &grid);
        }
        let mut stop = Stop::unhindered(random);
        if random.chance(0.1) {
            stop.max_cycles = random.integer(1, 30) as i32;
        }
        if random.chance(0.1) {
            stop.cancel_at = Some(random.integer(1, 30) as u32);
        }
        Case { place, slide, stop, carried }
    }

    /// The reason for which the library may refuse the forces as infeasible, if there is one. Forces below mu N must not be refused, because a large
    /// enough creepage reaches them.
    pub fn may_be_infeasible(&self) -> Option<&'static str> {
        let size = self.slide.force();
        let has_much_friction = self.has_much_friction();
        match () {
            // A force of 0 is always possible.
            _ if size == 0.0 => None,
            _ if size >= self.carried * (1.0 - 1e-9) => Some("refused: a force of mu N or more"),
            // N has an error of the tolerance.
            _ if size >= self.carried * (1.0 - self.stop.tolerance.max(1e-4)) => {
                Some("refused: a force of 0.9999 mu N or more")
            }
            // Tractions change the pressures of unlike bodies, and so mu N.
            _ if !self.carries_what_is_known() && (size >= 0.8 * self.carried || has_much_friction) => {
                Some("refused: a force on unlike bodies whose mu N the tractions change, of 0.8 of it or with mu > 1")
            }
            _ => None,
        }
    }

    /// Whether mu N is known before the solve: the bodies are alike, or the normal force is given and mu is the same everywhere.
    pub fn carries_what_is_known(&self) -> bool {
        self.place.is_alike() || matches!(self.place.load, Load::Force(_)) && self.slide.uniform
    }

    /// Whether a step of steady rolling is shorter than a tenth of an element along it: such a step is refused.
    pub fn step_is_too_short(&self) -> bool {
        let grid = &self.place.grid;
        let [x, y] = self.slide.step(grid);
        self.slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING && (x / grid.dx).abs().max((y / grid.dy).abs()) < 0.1
    }

    /// The reason for which the library may refuse the normal problem with this status, if there is one.
    pub fn normal_reason(&self, status: i32) -> Option<&'static str> {
        rules::reason(&self.place.normal(&self.stop, &vec![0.0; self.place.h.len()], 0.0), status)
    }

    /// The loads before the step: none if it starts from rest, or the given tractions together with the present pressures.
    pub fn before(&self, p: &[f64]) -> Before {
        let p = if self.slide.previous.is_some() { p.to_vec() } else { vec![0.0; p.len()] };
        Before { q: self.slide.before(), p }
    }

    /// The name of the motion.
    pub fn motion(&self) -> &'static str {
        ["shift", "transient rolling", "steady rolling"][self.slide.motion as usize]
    }

    /// The row of the report in which the case counts: the motion and the kind of bodies.
    pub fn kind(&self) -> String {
        let bodies = match () {
            _ if self.place.effects.coating.is_some() => "coated",
            _ if self.place.traction_tables.is_some() => "tables of like",
            _ if self.place.is_alike() => "like",
            _ => "unlike",
        };
        format!("{}, {bodies} bodies", self.motion())
    }

    /// Whether the case is a line contact of unlike bodies with 1000 cycles and without much friction. The alternation between the normal and the
    /// tangential problem may need more cycles then.
    pub fn is_slow_line(&self) -> bool {
        let is_line = self.place.grid.mx == 1 || self.place.grid.my == 1;
        is_line && !self.place.is_alike() && self.stop.is_unhindered() && !self.has_much_friction()
    }

    /// Whether a friction coefficient exceeds 1. By the library's documentation the alternation between the normal and the tangential problem of
    /// unlike bodies need not converge then.
    pub fn has_much_friction(&self) -> bool {
        self.slide.mu.iter().any(|mu| *mu > 1.0)
    }

    /// A description of the case in one line.
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
            "{mx} x {my} of {dx:.2e} x {dy:.2e}, {}, {}, {alike}, {}, mu {mu:.1e} ({}), prescribed {:?} {:?}, spin {:.1e}{more}, \
             tolerance {:.0e}, precision {}, cycles {}, cancel {:?}, step {:?}",
            self.place.surface,
            self.place.effects.name(),
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
