//! A random law of friction and a plastic layer. Computes the traction bounds and the state of the particles that they imply for the slips of a
//! result.

use contact_normal::ffi::*;

use crate::friction_case::Case;
use crate::friction_conditions::length;
use crate::friction_found::Found;
use crate::own_tractions::Kind;
use crate::random::Random;

/// The state of the particles of the interface that are at the elements after a step.
#[derive(Clone, Debug)]
pub struct Particles {
    /// The friction coefficients.
    pub mu: Vec<f64>,
    /// The yield limits.
    pub limit: Vec<f64>,
}

/// A law of friction, a plastic layer, and the branch of the solution. The fields are those of `contact_normal_friction` (docs/laws.md).
#[derive(Clone, Debug)]
pub struct Law {
    /// The kind of the law; 0: friction of Coulomb.
    pub kind: i32,
    pub kinetic: f64,
    pub falling: [f64; 2],
    pub half_speed: [f64; 2],
    /// The rolling speed. A shift has a duration instead.
    pub speed: f64,
    /// The duration of a step.
    pub duration: f64,
    /// The distance over which a particle forgets its friction coefficient; 0: it has no memory.
    pub memory_distance: f64,
    pub memory_speed: f64,
    /// The yield limit of fresh material; 0: the layer does not yield.
    pub yield_limit: f64,
    pub hardening: f64,
    pub branch: i32,
    /// The compliance of the layer's elastic part.
    pub compliance: f64,
}

impl Law {
    /// A random law for a case. Its speeds and distances are relative to the slips of the case, its yield limit to the pressures p. Changes the
    /// motion of the case to one that the library solves with a law.
    pub fn random(random: &mut Random, case: &mut Case, p: &[f64]) -> Law {
        let (grid, slide) = (case.place.grid, &mut case.slide);
        let is_shift = slide.motion == CONTACT_NORMAL_MOTION_SHIFT;
        // The order of the rigid slip. If a force is given, its creepage is not known and counts as 0.
        let amounts = [0, 1].map(|k| if slide.is_force(k) { 0.0 } else { slide.amount[k] });
        let steps = if is_shift { 1.0 } else { grid.dx };
        let slip = length(amounts) * steps + 1e-6 * grid.dx;
        let (duration, most) = (random.decades(1e-6, 1e3), p.iter().copied().fold(0.0, f64::max));
        let falls = random.chance(0.8);
        let h = [0, 1].map(|_| slip / duration * random.decades(0.01, 100.0));
        let has_memory = falls && random.chance(0.5);
        // Bounds may rise although a law falls: because of hardening, or because coefficients differ from element to element. Both would be rare by
        // chance.
        let (rises, differs) = (random.chance(0.25), random.chance(0.25) && !slide.has_forces());
        if differs {
            slide.uniform = false;
            let most = slide.mu.iter().copied().fold(0.0, f64::max);
            slide.mu.iter_mut().for_each(|mu| *mu = most * random.between(0.1, 1.0));
        }
        let (falls, has_memory) = (falls || rises || differs, has_memory || differs);
        let yields = !falls || rises || random.chance(0.3);
        let mu = slide.mu.iter().copied().fold(0.0, f64::max);
        let yield_limit = mu.min(1.0) * most * random.between(0.05, 1.1);
        let hardens = yields && yield_limit > 0.0 && (rises || random.chance(0.6));
        let sign = if rises || random.chance(0.7) { 1.0 } else { -1.0 };
        let steepness = if rises { random.decades(0.1, 10.0) } else { random.decades(1e-3, 3.0) };
        let law = Law {
            kind: if falls { random.integer(1, 3) as i32 } else { 0 },
            kinetic: random.between(0.0, 0.5),
            falling: [random.between(0.1, 1.0), if random.chance(0.3) { random.between(0.1, 1.0) } else { 0.0 }],
            half_speed: h,
            speed: grid.dx / duration,
            duration,
            memory_distance: if has_memory { slip * random.decades(0.01, 10.0) } else { 0.0 },
            memory_speed: if random.chance(0.5) { slip / duration * random.decades(1e-3, 1.0) } else { 0.0 },
            yield_limit: if yields { yield_limit } else { 0.0 },
            hardening: if hardens { sign * yield_limit / slip * steepness } else { 0.0 },
            branch: if slide.has_forces() || random.chance(0.7) { 0 } else { random.integer(1, 2) as i32 },
            compliance: if random.chance(0.4) { self_influence(case) * random.decades(0.1, 3.0) } else { 0.0 },
        };
        let slide = &mut case.slide;
        slide.distance = 0.0;
        slide.direction = [0.0, std::f64::consts::PI][usize::from(random.chance(0.3))];
        if let Some(tables) =
            case.place.traction_tables.as_ref().filter(|tables| matches!(tables.kind, Kind::Uneven { .. }))
        {
            (slide.motion, slide.direction) = (CONTACT_NORMAL_MOTION_STEADY_ROLLING, tables.kind.direction());
        }
        slide.sensitivities = false;
        law
    }

    /// Whether the bound of an element depends on its slip: there is a law of friction, or a yield limit that hardens or softens.
    pub fn depends_on_slip(&self) -> bool {
        self.kind > 0 || self.hardening != 0.0
    }

    /// The state of particles of fresh material.
    pub fn fresh(&self, case: &Case) -> Particles {
        Particles { mu: case.slide.mu.clone(), limit: vec![self.yield_limit; case.slide.mu.len()] }
    }

    /// Writes the law to the struct of the C ABI. `before` is the state of the particles before the step, if the caller gives it.
    pub fn put(&self, friction: &mut contact_normal_friction, before: Option<&Particles>) {
        (friction.law, friction.kinetic, friction.falling) = (self.kind, self.kinetic, self.falling);
        (friction.half_speed, friction.speed, friction.time_step) = (self.half_speed, self.speed, self.duration);
        (friction.memory_distance, friction.memory_speed) = (self.memory_distance, self.memory_speed);
        (friction.yield_limit, friction.hardening, friction.branch) = (self.yield_limit, self.hardening, self.branch);
        friction.compliance = self.compliance;
        if let Some(before) = before {
            (friction.previous_coefficient, friction.previous_yield_limit) =
                (before.mu.as_ptr(), before.limit.as_ptr());
        }
    }

    /// The friction coefficient at a slip velocity, relative to that at rest.
    fn relative_mu(&self, v: f64) -> f64 {
        let term = |k: usize| {
            let x = v / self.half_speed[k];
            match (self.kind, k) {
                (CONTACT_NORMAL_FRICTION_LAW_LINEAR, _) => (1.0 - 0.5 * x).max(0.0),
                (CONTACT_NORMAL_FRICTION_LAW_RATIONAL, 0) => 1.0 / (1.0 + x),
                (CONTACT_NORMAL_FRICTION_LAW_RATIONAL, _) => 1.0 / (1.0 + x * x),
                _ => 0.5f64.powf(x),
            }
        };
        let [a, b] = self.falling;
        (self.kinetic + a * term(0) + if b > 0.0 { b * term(1) } else { 0.0 }) / (self.kinetic + a + b)
    }

    /// The traction bound of an element at a slip, and the new friction coefficient and yield limit of its particle. `p` and `mu` are the pressure
    /// and the coefficient at rest of the element; `old_mu` and `old_limit` are those of the particle before the step.
    fn bound_mu_and_limit(&self, slip: f64, (p, mu): (f64, f64), (old_mu, old_limit): (f64, f64)) -> (f64, f64, f64) {
        let mut new_mu = mu;
        if self.kind > 0 {
            let v = slip / self.duration;
            let kept = self.memory_distance / (self.memory_distance + self.duration * v.max(self.memory_speed));
            let kept = if self.memory_distance > 0.0 { kept } else { 0.0 };
            new_mu = kept * old_mu + (1.0 - kept) * mu * self.relative_mu(v);
        }
        let new_mu = new_mu.max(1e-9 * mu);
        let cap = new_mu * p;
        if self.yield_limit == 0.0 || old_limit >= cap {
            return (cap, new_mu, old_limit);
        }
        let least = (1e-3 * self.yield_limit).min(old_limit);
        let limit = (old_limit + self.hardening * slip).max(least).min(cap);
        (limit, new_mu, limit)
    }

    /// The scale of slips; `plain` is that without the layer. In a shift, and with given forces, displacements of the layer count as well.
    pub fn scale(&self, case: &Case, found: &Found, plain: f64) -> f64 {
        let counts = case.slide.motion == CONTACT_NORMAL_MOTION_SHIFT || case.slide.has_forces();
        if !(counts && self.compliance > 0.0) {
            return plain;
        }
        let (mut displaced, mut tractions, mut elements) = (0.0, 0.0, 0.0);
        for i in (0..found.q.len()).filter(|&i| found.p[i] > 0.0 && case.slide.mu[i] > 0.0) {
            let (w, _) = case.slide.rigid_slip(&case.place.grid, i, found.report.tangential.creepage);
            displaced += (found.slip[i][0] - w[0]).powi(2) + (found.slip[i][1] - w[1]).powi(2);
            tractions += length(found.q[i]).powi(2);
            elements += 1.0;
        }
        f64::max(plain + self.compliance * f64::sqrt(tractions / elements), f64::sqrt(displaced / elements))
    }

    /// The element at which the particle of element i was before the step: in a shift element i itself, in rolling the next one in the rolling
    /// direction. None if it was outside the grid.
    pub fn upstream(case: &Case, i: usize) -> Option<usize> {
        let [step, _] = case.slide.step(&case.place.grid);
        let (x, mx) = (i % case.place.grid.mx, case.place.grid.mx);
        match step {
            _ if case.slide.motion == CONTACT_NORMAL_MOTION_SHIFT => Some(i),
            step if step > 0.0 => (x + 1 < mx).then_some(i + 1),
            _ => (x > 0).then(|| i - 1),
        }
    }

    /// The traction bounds of all elements for the slips of a result, and the new state of the particles. Each bound is a pair: the bound, and its
    /// largest change if the slip changes by `delta`.
    pub fn bounds(&self, case: &Case, found: &Found, before: &Particles, delta: f64) -> (Vec<[f64; 2]>, Particles) {
        let n = found.p.len();
        let is_steady = case.slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING;
        let (fresh, mut bounds) = (self.fresh(case), vec![[0.0; 2]; n]);
        let mut after = fresh.clone();
        let backwards = case.slide.step(&case.place.grid)[0] > 0.0;
        // In steady rolling, the state before the step is that after the step at the next element. Particles are fresh until they enter the contact.
        let mut has_entered = vec![!is_steady; n];
        for k in 0..n {
            let i = if backwards { n - 1 - k } else { k };
            let previous = if is_steady { &after } else { before };
            let from = Law::upstream(case, i).filter(|&j| has_entered[j]);
            let old = from.map_or((fresh.mu[i], fresh.limit[i]), |j| (previous.mu[j], previous.limit[j]));
            has_entered[i] = !is_steady || from.is_some() || found.p[i] > 0.0 && case.slide.mu[i] > 0.0;
            // Where mu is 0, particles do not change, as outside the contact.
            let slips =
                found.p[i] > 0.0 && case.slide.mu[i] > 0.0 && found.stick_slip[i] >= CONTACT_NORMAL_STICK_SLIP_SLIP;
            let slip = if slips { length(found.slip[i]) } else { 0.0 };
            let at = |slip: f64| self.bound_mu_and_limit(slip, (found.p[i].max(0.0), case.slide.mu[i]), old);
            let (bound, mu, limit) = at(slip);
            let change = |slip: f64| {
                let (other_bound, ..) = at(slip);
                (other_bound - bound).abs()
            };
            bounds[i] = [bound, if slips { change((slip - delta).max(0.0)).max(change(slip + delta)) } else { 0.0 }];
            (after.mu[i], after.limit[i]) = (mu, limit);
        }
        (bounds, after)
    }
}

/// The order of the influence of an element on itself.
fn self_influence(case: &Case) -> f64 {
    let (grid, coating) = (&case.place.grid, case.place.effects.coating.as_ref());
    let bodies = (case.place.shear_modulus, case.place.poisson_ratio);
    let (modulus, _) = coating.map_or(bodies, |coating| coating.at_surface());
    (grid.dx * grid.dy).sqrt() / (2.0 * modulus[0])
}
