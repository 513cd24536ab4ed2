//! Solves random scenes with laws of friction and layers that yield, and checks each result. The checks use products of the campaign, and follow the
//! particles along their paths (`law_case`). Wear, and temperatures by the heat of friction, are compared with sums.
//!
//! A result must meet two conditions: those of stick and slip if the bounds are taken as |q| (`friction_conditions`), and that |q| of slipping
//! elements is the bound by the law.

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

/// If `law_slope` is at least this number, a solve may end without a certificate (docs/laws.md).
const STEEP: f64 = 0.5;

/// The result of a case.
pub struct Run {
    pub case: Case,
    pub law: Law,
    /// Separate random numbers for further checks.
    heat: Random,
    /// For each call: `law_slope`, and the status.
    pub ends: Vec<(f64, i32)>,
    pub verdict: Verdict,
}

impl Run {
    /// The row of the report in which a call with this `law_slope` counts.
    pub fn kind(&self, slope: f64) -> String {
        let range = match slope {
            slope if slope < STEEP => "below .5",
            slope if slope < 0.7 => ".5 to .7",
            slope if slope < 1.0 => ".7 to 1",
            _ => "1 and more",
        };
        let law = if self.law.depends_on_slip() { "law" } else { "ideal plastic" };
        let tables = if self.case.place.traction_tables.is_some() { ", own tables" } else { "" };
        format!("{}{tables}, {law}, branch {}, law_slope {range}", self.case.motion(), self.law.branch)
    }
}

/// Makes a random case and checks its steps: from rest, then continued by the handle, and continued from the caller's tractions and particles.
pub fn run(random: &mut Random) -> Run {
    loop {
        let mut place = Place::random(random, false);
        place.shear_modulus[1] = place.shear_modulus[0];
        place.poisson_ratio[1] = place.poisson_ratio[0];
        // A separate sequence of random numbers, so that the rest of the case stays the same.
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
    /// Solves and checks the steps of the case.
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
        // The same step, with the caller's tractions and particles. The initial guess differs from that of the handle, so the solve may find another
        // one of several solutions. The yield limits may differ from particle to particle.
        let particles = self.varied(particles);
        let mut given = case.clone();
        given.slide.previous = Some([0, 1].map(|k: usize| first.q.iter().map(|q| q[k]).collect()));
        let found = call_changed(None, (&given.place, &given.slide, From::Slide), &case.stop, |friction| {
            law.put(friction, Some(&particles));
        });
        self.check(&given, &found, (&before, &particles));
        // With few cycles the tractions do not converge, but they must be within their bounds.
        let mut short = case.stop.clone();
        short.max_cycles = self.heat.beside(0xc07).integer(1, 12) as i32;
        let found =
            call_changed(None, (&case.place, &case.slide, From::Slide), &short, |friction| law.put(friction, None));
        self.bounded(&found);
    }

    /// Makes the yield limits differ from particle to particle, with a probability of 1/2.
    fn varied(&mut self, mut particles: Particles) -> Particles {
        let mut random = self.heat.beside(0x11a7);
        if self.law.yield_limit > 0.0 && random.chance(0.5) {
            particles.limit.iter_mut().for_each(|limit| *limit *= random.between(0.4, 1.6));
        }
        particles
    }

    /// Checks a result with any status >= 0: no traction exceeds mu p, and each element in contact sticks or slips.
    fn bounded(&mut self, found: &Found) {
        if found.status < 0 {
            return;
        }
        let mu = &self.case.slide.mu;
        let excess = |i: usize| length(found.q[i]) - mu[i] * found.p[i].max(0.0) * (1.0 + 1e-15);
        let most = (0..found.q.len()).map(excess).fold(f64::NEG_INFINITY, f64::max);
        // With memory, a particle may have a larger coefficient from an earlier place.
        let is_bounded = most <= 0.0 || self.law.memory_distance > 0.0;
        self.unless(is_bounded, "a law keeps tractions within mu p", || format!("status {}: {most:e}", found.status));
        let report = &found.report.tangential;
        let reported = report.stick_count + report.slip_count;
        let in_contact = found.p.iter().filter(|p| **p > 0.0).count() as i64;
        self.unless(reported == in_contact, "stick and slip are the contact", || format!("{reported} of {in_contact}"));
    }

    /// Adds a broken promise with a description of the case, unless the promise is `kept`.
    fn unless(&mut self, kept: bool, promise: &'static str, details: impl FnOnce() -> String) {
        let (case, law) = (&self.case, &self.law);
        self.verdict.unless(kept, promise, || format!("{}, {law:?}: {}", case.describe(), details()));
    }

    /// Checks one result, for the loads and the particles before the step. If the status is OK, returns the state of the particles after it.
    fn check(&mut self, case: &Case, found: &Found, (before, particles): (&Before, &Particles)) -> Option<Particles> {
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
        let (bounds, after) = law.bounds(case, found, particles, case.stop.tolerance * plain.scale + plain.rounding);
        self.certify(case, found, before, &bounds);
        Some(after)
    }

    /// Checks both conditions of a result with status OK. `bounds` has the bounds by the law, and their changes within the tolerance.
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
            // The slip has an error within the tolerance, by which the bound may change by `change`.
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

    /// The excuse of a result with status > 0: a steep law, a force, or a branch.
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

    /// Compares the frictional work and the depth of wear with sums.
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
        // 1e-13: the round-off of sums of up to some hundred numbers.
        right &= (worn.work - total * area).abs() <= 1e-13 * sizes * area
            && (worn.volume - volume * area).abs() <= 1e-13 * volume * area;
        right &= rows.iter().zip(&passage).all(|(exact, found)| (exact - found).abs() <= 1e-13 * exact);
        self.unless(right, "work and wear are those of tractions and slips", || {
            format!("status {status}, {total:e}, {:e}", worn.work)
        });
    }
}
