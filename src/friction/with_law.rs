//! A [law](super::law) of friction or a yielding layer in the units of the iterations, and the state of the interface's particles before and after a
//! step.

use super::law::{Law, March, Particle, Place};
use super::request::Request;
use super::solution::{PLASTIC, SLIP};
use super::solver::Solver;
use super::sweep::{Rolling, Sweep};
use crate::effects::{Friction, Motion, PlasticLayer, Previous};
use crate::error::Result;
use crate::grid::Grid;
use crate::memory::collected;

/// The state of the particles before a step, on the whole grid, in the caller's units.
pub(super) struct ParticlesBefore<'a> {
    friction: &'a Friction<'a>,
    /// The state after the step before, if this step continues from it; otherwise empty.
    kept: &'a [Particle],
    /// Whether the coefficients in `kept` count. A step without friction leaves zeros, which stand for none.
    has_coefficients: bool,
    grid: Grid,
    /// The interpolation at the old places of particles; none unless the motion is transient rolling.
    sweep: Option<Sweep>,
}

impl ParticlesBefore<'_> {
    /// The state before the step of the particle that is on element i after the step.
    pub(super) fn at(&self, i: usize) -> Particle {
        if self.friction.motion == Motion::SteadyRolling {
            return self.fresh(i);
        }
        let Some(sweep) = &self.sweep else { return self.on_element(i) };
        let (x, y) = (i % self.grid.mx, i / self.grid.mx);
        let mut sum = self.times(sweep.own(), self.on_element(i));
        for &(in_x, in_y, weight) in sweep.neighbours() {
            let (jx, jy) = (x.wrapping_add_signed(in_x), y.wrapping_add_signed(in_y));
            let is_there = jx < self.grid.mx && jy < self.grid.my;
            let there = if is_there { self.on_element(jy * self.grid.mx + jx) } else { self.fresh(i) };
            let part = self.times(weight, there);
            sum.coefficient += part.coefficient;
            sum.yield_limit += part.yield_limit;
        }
        sum
    }

    fn times(&self, weight: f64, particle: Particle) -> Particle {
        Particle { coefficient: weight * particle.coefficient, yield_limit: weight * particle.yield_limit }
    }

    /// A particle without history on element i.
    fn fresh(&self, i: usize) -> Particle {
        let yield_limit = self.friction.layer.map_or(0.0, |layer| layer.yield_limit);
        Particle { coefficient: self.friction.coefficient.at(i), yield_limit }
    }

    /// The state of the particle that was on element i before the step: the caller's, that of the step before, or fresh.
    fn on_element(&self, i: usize) -> Particle {
        let fresh = self.fresh(i);
        let mut kept = self.kept.get(i).copied().unwrap_or(fresh);
        if !self.has_coefficients {
            kept.coefficient = fresh.coefficient;
        }
        // A limit of 0 is that of a step without a layer.
        if kept.yield_limit == 0.0 {
            kept.yield_limit = fresh.yield_limit;
        }
        Particle {
            coefficient: self.friction.coefficients_read().map_or(kept.coefficient, |given| given[i]),
            yield_limit: self.friction.yield_limits_read().map_or(kept.yield_limit, |given| given[i]),
        }
    }
}

impl Solver {
    /// Copies the state of the particles after the last step: it is that before this step.
    pub(super) fn keep_particles(&mut self) {
        self.particles_before.clone_from(&self.solution.particles);
    }

    /// Converts the law and the layer to the units of the iterations.
    pub(super) fn law(&self, friction: &Friction<'_>) -> Law {
        let ([displacement, _], duration) =
            (self.scales.callers_displacement([1.0, 0.0]), friction.duration(&self.grid));
        let layer = friction.layer.map(|layer| PlasticLayer {
            yield_limit: self.scales.traction(layer.yield_limit),
            hardening: self.scales.traction(layer.hardening * displacement),
        });
        Law { fall: friction.law, layer, rate: displacement / duration, duration }
    }

    /// The state of the particles before a step. `particles` is the state after the step before, used if the friction continues from it.
    pub(super) fn particles_before_step<'a>(
        &self,
        friction: &'a Friction<'a>,
        particles: &'a [Particle],
    ) -> ParticlesBefore<'a> {
        let grid = self.grid;
        let sweep = (friction.motion == Motion::TransientRolling).then(|| {
            let by = friction.elements_rolled(&grid);
            Sweep::new(&Rolling { distance: friction.distance(&grid), by })
        });
        let kept = if friction.previous == Previous::Kept { particles } else { &[] };
        let has_coefficients = kept.iter().any(|particle| particle.coefficient != 0.0);
        ParticlesBefore { friction, kept, has_coefficients, grid, sweep }
    }

    /// The yield limits of an ideal layer before the step of a request. It is called before [`keep_particles`](Self::keep_particles): unless the
    /// request repeats the last step, the state of the particles is still in the last result.
    pub(super) fn limits_before(&self, request: &Request<'_>) -> Result<Vec<f64>> {
        let is_kept = request.start.is_again();
        self.limits(request.friction, if is_kept { &self.particles_before } else { &self.solution.particles })
    }

    /// The yield limits of an ideal layer before a step, one for each element; empty without such a layer.
    pub(super) fn limits(&self, friction: &Friction<'_>, particles: &[Particle]) -> Result<Vec<f64>> {
        if !friction.has_ideal_layer() {
            return Ok(Vec::new());
        }
        let before = self.particles_before_step(friction, particles);
        Ok(collected((0..self.grid.len()).map(|i| before.at(i).yield_limit), "the yield limits")?)
    }

    /// Converts a particle's state to the units of the iterations.
    pub(super) fn scaled(&self, particle: Particle) -> Particle {
        Particle { yield_limit: self.scales.traction(particle.yield_limit), ..particle }
    }

    /// Sets up the [`March`] over the particles of the whole grid, with their state before the step, and memory for the state after it. None without
    /// a law and a layer.
    pub(super) fn march(&self, friction: &Friction<'_>, pressure: &[f64]) -> Result<Option<(March, Vec<Particle>)>> {
        if friction.law.is_none() && friction.layer.is_none() {
            return Ok(None);
        }
        let (law, scales, before) =
            (self.law(friction), self.scales, self.particles_before_step(friction, &self.particles_before));
        let place = |i: usize| Place {
            pressure: scales.traction(pressure[i].max(0.0)),
            coefficient: friction.coefficient.at(i),
        };
        let by = friction.elements_rolled(&self.grid);
        let march = March::new((self.grid, law), friction.motion, by, place, |i| self.scaled(before.at(i)))?;
        let particles = collected((0..self.grid.len()).map(|_| Particle::default()), "what particles carry")?;
        Ok(Some((march, particles)))
    }

    /// Writes the state of the particles after the step, and marks the slipping elements whose layer yields.
    pub(super) fn write_particles(&mut self, march: Option<(March, Vec<Particle>)>) {
        let (solution, scales) = (&mut self.solution, self.scales);
        let Some((mut march, mut particles)) = march else { return solution.particles.clear() };
        let law = march.law;
        march.go(|i, place, before| {
            // For particles, elements without friction are outside the contact, as in the iteration.
            let slips = solution.stick_slip[i] == SLIP && place.coefficient > 0.0;
            let [x, y] = if slips { scales.displacement(solution.slip[i]) } else { [0.0; 2] };
            let response = law.at(x.hypot(y), place, before);
            if slips && response.yields {
                solution.stick_slip[i] = PLASTIC;
            }
            let Particle { coefficient, yield_limit } = response.particle;
            // After a step without a layer the limit is 0.
            let yield_limit = if law.layer.is_some() { scales.callers_traction([yield_limit, 0.0])[0] } else { 0.0 };
            particles[i] = Particle { coefficient, yield_limit };
            response.particle
        });
        solution.particles = particles;
    }
}
