//! Laws of friction and layers that yield, in random scenes. Each result is certified by the campaign's own products and by its own march along the
//! paths of particles. Its wear, and the temperatures by its heat, are compared with the campaign's own sums.
//!
//! A result meets two conditions: those of stick and slip with the bounds fixed at |q| (`friction_conditions`), and that `|q|` is the bound of the
//! slip.

use contact_normal::ffi::*;

use crate::flash;
use crate::friction_call::{call_changed, frictionless, From, Handle};
use crate::friction_case::Case;
use crate::friction_conditions::{conditions, length};
use crate::friction_found::{Before, Found};
use crate::friction_place::{Place, Stop};
use crate::init::initialised;
use crate::law_case::{Law, Particles};
use crate::random::Random;
use crate::verdict::Verdict;

/// From this `law_slope` on a solve may end without a certificate (docs/laws.md).
const STEEP: f64 = 0.5;

/// The result of a case.
pub struct Run {
    pub case: Case,
    pub law: Law,
    /// Random numbers for the heat of friction.
    heat: Random,
    /// `law_slope` and status of each call.
    pub ends: Vec<(f64, i32)>,
    pub verdict: Verdict,
}

impl Run {
    /// The motion and the range of the slope.
    pub fn kind(&self, slope: f64) -> String {
        let range = match slope {
            slope if slope < STEEP => "below .5",
            slope if slope < 0.7 => ".5 to .7",
            slope if slope < 1.0 => ".7 to 1",
            _ => "1 and more",
        };
        let law = if self.law.is_one() { "law" } else { "ideal plastic" };
        let tables = if self.case.place.traction_tables.is_some() { ", own tables" } else { "" };
        format!("{}{tables}, {law}, branch {}, law_slope {range}", self.case.motion(), self.law.branch)
    }
}

/// A random case: from rest, then continued by the handle, and by the caller's tractions and particles.
pub fn run(random: &mut Random) -> Run {
    loop {
        let mut place = Place::random(random, false);
        place.shear_modulus[1] = place.shear_modulus[0];
        place.poisson_ratio[1] = place.poisson_ratio[0];
        // By other random numbers, so that the rest of the case does not change.
        let for_tables = &mut random.beside(0x1a35);
        let may_have_tables =
            place.effects.coating.is_none() && place.traction_tables.is_none() && place.surface != "roller";
        if for_tables.chance(0.25) && may_have_tables {
            place.take_tables(for_tables);
        }
        let without = frictionless(&place, &Stop::sharp(random));
        if without.status != CONTACT_NORMAL_OK || without.p.iter().all(|p| !(*p > 0.0)) {
            continue;
        }
        let mut case = Case::random(random, place, &without);
        (case.stop.max_cycles, case.stop.cancel_at) = (1000, None);
        let law = Law::random(random, &mut case, &without.p);
        let heat = random.beside(0xf1a5);
        let mut run = Run { case, law, heat, ends: Vec::new(), verdict: Verdict::default() };
        run.steps();
        return run;
    }
}

impl Run {
    fn steps(&mut self) {
        let (case, law) = (self.case.clone(), self.law.clone());
        let mut handle = match Handle::new(&case.place, &case.stop) {
            Ok(handle) => handle,
            Err((status, message)) => {
                return self.verdict.fail("a handle for a law", format!("{status}: {message}"));
            }
        };
        let first = call_changed(Some(&mut handle), (&case.place, &case.slide, From::Slide), &case.stop, |friction| {
            law.put(friction, None);
        });
        let fresh = law.fresh(&case);
        let Some(particles) = self.check(&case, &first, (&case.before(&first.p), &fresh)) else { return };
        let kept = call_changed(Some(&mut handle), (&case.place, &case.slide, From::Handle), &case.stop, |friction| {
            law.put(friction, None);
        });
        let before = Before { q: first.q.clone(), p: first.p.clone() };
        self.check(&case, &kept, (&before, &particles));
        // The same step from the caller's tractions and particles. The solve starts elsewhere, so that it may find another one of several solutions.
        // The yield limits may differ from particle to particle.
        let particles = self.varied(particles);
        let mut handed = case.clone();
        handed.slide.previous = Some([0, 1].map(|k: usize| first.q.iter().map(|q| q[k]).collect()));
        let found = call_changed(None, (&handed.place, &handed.slide, From::Slide), &case.stop, |friction| {
            law.put(friction, Some(&particles));
        });
        self.check(&handed, &found, (&before, &particles));
        // After few cycles tractions are not converged.
        let mut short = case.stop.clone();
        short.max_cycles = self.heat.beside(0xc07).integer(1, 12) as i32;
        let found =
            call_changed(None, (&case.place, &case.slide, From::Slide), &short, |friction| law.put(friction, None));
        self.bounded(&found);
    }

    /// Half of the time: yield limits that differ from particle to particle.
    fn varied(&mut self, mut particles: Particles) -> Particles {
        let mut random = self.heat.beside(0x11a7);
        if self.law.yield_limit > 0.0 && random.chance(0.5) {
            particles.limit.iter_mut().for_each(|limit| *limit *= random.between(0.4, 1.6));
        }
        particles
    }

    /// With any status >= 0: no traction is longer than mu p, and each element in contact sticks or slips.
    fn bounded(&mut self, found: &Found) {
        if found.status < 0 {
            return;
        }
        let mu = &self.case.slide.mu;
        let beyond = |i: usize| length(found.q[i]) - mu[i] * found.p[i].max(0.0) * (1.0 + 1e-15);
        let most = (0..found.q.len()).map(beyond).fold(f64::NEG_INFINITY, f64::max);
        // With memory, particles keep the coefficient of an earlier place.
        let is_bounded = most <= 0.0 || self.law.memory_distance > 0.0;
        self.unless(is_bounded, "a law keeps tractions within mu p", || format!("status {}: {most:e}", found.status));
        let of = &found.report.tangential;
        let (told, touching) = (of.stick_count + of.slip_count, found.p.iter().filter(|p| **p > 0.0).count() as i64);
        self.unless(told == touching, "stick and slip are the contact", || format!("{told} of {touching}"));
    }

    fn unless(&mut self, kept: bool, promise: &'static str, details: impl FnOnce() -> String) {
        let (case, law) = (&self.case, &self.law);
        self.verdict.unless(kept, promise, || format!("{}, {law:?}: {}", case.describe(), details()));
    }

    /// Checks one result. Returns the state of the particles after it if the status is OK.
    fn check(&mut self, case: &Case, found: &Found, (before, had): (&Before, &Particles)) -> Option<Particles> {
        let (status, law, slope) = (found.status, self.law.clone(), found.report.tangential.law_slope);
        self.ends.push((if status < 0 { 0.0 } else { slope }, status));
        if status < 0 {
            self.unless(!found.written, "a law refused leaves outputs alone", || format!("status {status}"));
            match (status, case.may_be_infeasible(), case.normal_reason(status)) {
                (CONTACT_NORMAL_INFEASIBLE, Some(why), _) | (_, _, Some(why)) => self.verdict.excuse(why),
                // A layer that yields carries less than mu p.
                (CONTACT_NORMAL_INFEASIBLE, ..) if law.yield_limit > 0.0 => {
                    self.verdict.excuse("refused: a force on a layer that yields")
                }
                _ => self.unless(false, "a law is refused for a reason", || format!("{status}, {}", found.message)),
            }
            return None;
        }
        let numbers = found.q.iter().chain(&found.slip).flatten().chain([&slope, &found.report.tangential.residual]);
        let all = numbers.copied().all(f64::is_finite);
        self.unless(all, "a law returns numbers", || format!("status {status}"));
        self.bounded(found);
        let is_warned = found.report.warnings & CONTACT_NORMAL_WARNING_LAW != 0;
        self.unless(is_warned == (slope >= STEEP), "LAW warns of a law_slope of .5 and more", || format!("{slope}"));
        self.wear(case, found);
        if self.heat.chance(0.3) {
            let flux: Vec<f64> = found.q.iter().zip(&found.slip).map(|(q, s)| length(*q) * length(*s)).collect();
            self.verdict
                .add(flash::check(&mut self.heat, &case.place.grid, &flux).within(&format!("{}: ", case.describe())));
        }
        if status > 0 {
            self.stopped(case, found);
            return None;
        }
        let plain = conditions(case, found, before);
        let (bounds, after) = law.bounds(case, found, had, case.stop.tolerance * plain.scale + plain.rounding);
        self.certify(case, found, before, &bounds);
        Some(after)
    }

    /// Status OK: both conditions.
    fn certify(&mut self, case: &Case, found: &Found, before: &Before, bounds: &[[f64; 2]]) {
        let (law, mut frozen) = (self.law.clone(), case.clone());
        let is_steady = case.slide.motion == CONTACT_NORMAL_MOTION_STEADY_ROLLING;
        let q_there = if is_steady { &found.q } else { &before.q };
        let layer = |k: usize| -> Vec<f64> {
            let there = |i: usize| Law::upstream(case, i).map_or(0.0, |j| q_there[j][k]);
            let rigid = |i: usize| case.slide.rigid.as_ref().map_or(0.0, |rigid| rigid[k][i]);
            (0..found.q.len()).map(|i| rigid(i) + law.compliance * (found.q[i][k] - there(i))).collect()
        };
        frozen.slide.rigid = Some([layer(0), layer(1)]);
        let (mut left, mut rest, mut count, mut floor) = (0.0, 0.0, 0.0f64, 0.0f64);
        let mut worst = (0.0, 0);
        let most = bounds.iter().zip(&found.p).zip(&case.slide.mu).map(|((_, p), mu)| mu * p).fold(0.0, f64::max);
        for (i, [bound, change]) in bounds.iter().enumerate() {
            let (q, p) = (length(found.q[i]), found.p[i]);
            if !(p > 0.0 && case.slide.mu[i] > 0.0) {
                continue;
            }
            let slips = found.stick_slip[i] >= CONTACT_NORMAL_STICK_SLIP_SLIP;
            frozen.slide.mu[i] = if slips { q / p } else { 10.0 * case.slide.mu[i].max(q / p) };
            // The error of the slip is within the tolerance; `change` is that of the bound by it.
            let off = if slips { ((q - bound).abs() - change).max(0.0) } else { (q - bound).max(0.0) };
            left += (off / most).powi(2);
            worst = if off > worst.0 { (off, i) } else { worst };
            rest += (case.slide.mu[i] * p / most).powi(2);
            count += 1.0;
            floor = floor.max(1e-13);
        }
        if count == 0.0 {
            return;
        }
        let [plain, with_layer] = [case, &frozen].map(|case| conditions(case, found, before));
        let scale = law.scale(case, found, plain.scale).max(with_layer.scale);
        let allowed = 1.001 * case.stop.tolerance * scale + with_layer.rounding;
        self.unless(with_layer.slip_error <= 4.0 * with_layer.rounding, "a law's slip is w + A q - u'", || {
            format!("{:e}, {:e}", with_layer.slip_error, with_layer.rounding)
        });
        self.unless(with_layer.left <= allowed, "OK with a law: the slip is within the tolerance", || {
            format!(
                "{:e} left of {scale:e}, rounding {:e}, reported {:e}",
                with_layer.left, with_layer.rounding, found.report.tangential.residual
            )
        });
        let off = (left / rest).sqrt();
        self.unless(off <= 1.001 * case.stop.tolerance + floor, "OK with a law: |q| is the bound of the slip", || {
            let i = worst.1;
            format!(
                "{off:e}, reported {:e}; {:e} at element {i}, |q| {:e}, bound {:e}, slip {:?}, state {}, p {:e}, mu {:e}",
                found.report.tangential.residual,
                worst.0,
                length(found.q[i]),
                bounds[i][0],
                found.slip[i],
                found.stick_slip[i],
                found.p[i],
                case.slide.mu[i]
            )
        });
    }

    /// Status > 0: excused for the slope, a force, or a branch.
    fn stopped(&mut self, case: &Case, found: &Found) {
        let slope = found.report.tangential.law_slope;
        let says = found.message.contains("tangential.law_slope is");
        self.unless(says == (slope >= STEEP), "what is not solved says how steep its law is", || found.message.clone());
        let why = match () {
            () if slope >= STEEP => "law: law_slope of .5 and more",
            () if case.slide.has_forces() => "law: a force that may be above the maximum",
            () if self.law.branch > 0 => "law: turns of a branch that do not settle",
            // One call in three thousand (docs/laws.md).
            () => "law: neither steps nor turns settle",
        };
        self.verdict.excuse(why);
    }

    /// Work and depth by sums.
    fn wear(&mut self, case: &Case, found: &Found) {
        let (grid, n) = (case.place.grid, found.q.len());
        let column = |of: &[[f64; 2]], k: usize| of.iter().map(|v| v[k]).collect::<Vec<f64>>();
        let (q, s) = ([column(&found.q, 0), column(&found.q, 1)], [column(&found.slip, 0), column(&found.slip, 1)]);
        let mut wear = initialised(contact_normal_wear_init);
        (wear.mx, wear.my, wear.dx, wear.dy) = (grid.mx as i32, grid.my as i32, grid.dx, grid.dy);
        (wear.traction, wear.slip) = ([q[0].as_ptr(), q[1].as_ptr()], [s[0].as_ptr(), s[1].as_ptr()]);
        (wear.coefficient, wear.hardness, wear.steps, wear.rolling_distance) = (1e-3, 7.0, 3.0, grid.dx);
        let (mut work, mut depth, mut passage) = (vec![0.0; n], vec![0.0; n], vec![0.0; grid.my]);
        let mut worn = initialised(contact_normal_worn_init);
        let to = (work.as_mut_ptr(), depth.as_mut_ptr(), passage.as_mut_ptr());
        // SAFETY: structs with the arrays that they declare.
        let status = unsafe { contact_normal_frictional_wear(&wear, to.0, to.1, to.2, &mut worn) };
        let (mut total, mut volume, mut sizes) = (0.0, 0.0, 0.0);
        let mut rows = vec![0.0; grid.my];
        let mut right = status == CONTACT_NORMAL_OK;
        for i in 0..n {
            let terms = [q[0][i] * s[0][i], q[1][i] * s[1][i]];
            let (exact, size) = (-3.0 * (terms[0] + terms[1]), 3.0 * (terms[0].abs() + terms[1].abs()));
            let worn_off = 1e-3 / 7.0 * exact.max(0.0);
            right &= (work[i] - exact).abs() <= 1e-15 * size
                && (depth[i] - worn_off).abs() <= 1e-18 * size + 1e-15 * worn_off;
            rows[i / grid.mx] += worn_off / 3.0;
            (total, volume, sizes) = (total + exact, volume + worn_off, sizes + size);
        }
        let area = grid.dx * grid.dy;
        // Sums of up to some hundred numbers.
        right &= (worn.work - total * area).abs() <= 1e-13 * sizes * area
            && (worn.volume - volume * area).abs() <= 1e-13 * volume * area;
        right &= rows.iter().zip(&passage).all(|(exact, found)| (exact - found).abs() <= 1e-13 * exact);
        self.unless(right, "work and wear are those of tractions and slips", || {
            format!("status {status}, {total:e}, {:e}", worn.work)
        });
    }
}
