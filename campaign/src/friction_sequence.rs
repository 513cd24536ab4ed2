//! Checks a handle in a random sequence of calls with and without friction: steps from rest, continued steps, refused calls, cancelled calls, and
//! batches.
//!
//! A refused call must change neither the outputs nor the results that the handle holds. A call that does not start from the last result must have
//! the bits of a call without a handle.

use contact_normal::ffi::*;

use crate::friction_call::{call, frictionless, From, Handle};
use crate::friction_case::Case;
use crate::friction_found::{Before, Found};
use crate::friction_place::{Place, Stop};
use crate::friction_rules::check;
use crate::grid::Load;
use crate::random::Random;
use crate::verdict::Verdict;

/// A handle and its sequence of calls.
struct Sequence<'a> {
    random: &'a mut Random,
    handle: Handle,
    /// The loads at the end of the last step with friction. The next step continues from them, also after solves without friction.
    last: Option<Before>,
    is_measured: bool,
    /// The present case.
    case: Case,
    /// The calls so far in words, for the messages of failures.
    history: String,
    statuses: Vec<i32>,
    verdict: Verdict,
}

/// Makes a random case and a sequence of calls of a handle. Returns the last case, the statuses of the calls, and the verdict.
pub fn run(random: &mut Random, is_measured: bool) -> (Case, Vec<i32>, Verdict) {
    let place = Place::random(random, is_measured);
    let without = frictionless(&place, &Stop::sharp(random));
    if without.status < 0 {
        let (case, statuses) = (Case::random(random, place, &without), vec![without.status]);
        return (case, statuses, Verdict::excused("friction: no normal problem"));
    }
    let mut case = Case::random(random, place, &without);
    (case.stop.max_cycles, case.stop.cancel_at) = (1000, None);
    let handle = match Handle::new(&case.place, &case.stop) {
        Ok(handle) => handle,
        Err((status, message)) => {
            return (case, vec![status], Verdict::failed("a handle for friction", format!("{status}: {message}")))
        }
    };
    let (history, statuses, verdict) = (String::new(), Vec::new(), Verdict::default());
    let mut sequence = Sequence { random, handle, last: None, is_measured, case, history, statuses, verdict };
    for _ in 0..sequence.random.integer(3, 7) {
        sequence.step();
    }
    (sequence.case, sequence.statuses, sequence.verdict)
}

impl Sequence<'_> {
    /// Makes one random call, mostly with another load and motion.
    fn step(&mut self) {
        if self.random.chance(0.7) {
            self.change();
        }
        match self.random.integer(0, 9) {
            0 | 1 => self.without_friction(),
            2 | 3 => self.start(),
            4 | 5 => self.continued(),
            6 | 7 => self.refused(),
            8 => self.cancelled(),
            _ => self.batch(),
        }
    }

    /// Changes the load, the limit and the motion of the case, but not the set-up of the handle.
    fn change(&mut self) {
        let mut place = self.case.place.clone();
        place.press(self.random, self.is_measured);
        if place.effects.limit.is_some() {
            place.effects.limit = place.limit(self.random);
        }
        let without = frictionless(&place, &self.case.stop);
        if without.status != CONTACT_NORMAL_OK {
            return;
        }
        let stop = self.case.stop.clone();
        self.case = Case { stop, ..Case::random(self.random, place, &without) };
    }

    /// Adds a call to the history and its status to the statuses.
    fn note(&mut self, what: &str, found: &Found) {
        self.history += &format!("{what} ({}{}), ", found.status, found.message);
        self.statuses.push(found.status);
    }

    /// Stores the loads at the end of a step with friction, if it has a result.
    fn remember(&mut self, found: &Found) {
        if found.status >= 0 {
            self.last = Some(Before { q: found.q.clone(), p: found.p.clone() });
        }
    }

    /// Adds a broken promise with the case and the history, unless the promise is `kept`.
    fn fail_unless(&mut self, kept: bool, promise: &'static str) {
        let details = format!("{}: {}", self.case.describe(), self.history);
        self.verdict.unless(kept, promise, || details);
    }

    /// Adds the verdict on a call, with the history.
    fn add(&mut self, verdict: Verdict) {
        self.verdict.add(verdict.within(&format!("{}: ", self.history)));
    }

    /// A call without friction.
    fn without_friction(&mut self) {
        let Case { place, stop, .. } = &self.case;
        let (found, fresh) = (self.handle.solve(place, None, stop), frictionless(place, stop));
        self.note("no friction", &found);
        self.fail_unless(found.bits() == fresh.bits(), "a start from nothing has the bits of a new handle");
    }

    /// A step from rest, or from given tractions.
    fn start(&mut self) {
        let Case { place, slide, stop, .. } = &self.case;
        let found = self.handle.solve(place, Some((slide, From::Slide)), stop);
        let fresh = call(place, slide, stop);
        self.note("from rest", &found);
        self.remember(&found);
        self.add(check(&self.case, &found, &self.case.before(&found.p)));
        self.fail_unless(found.bits() == fresh.bits(), "a start from nothing has the bits of a new handle");
    }

    /// A step that continues from the last one with friction. If there is none, the call must be refused.
    fn continued(&mut self) {
        let held = self.handle.fields(self.case.place.grid.len());
        let Case { place, slide, stop, .. } = &self.case;
        let found = self.handle.solve(place, Some((slide, From::Handle)), stop);
        self.note("continued", &found);
        if found.status == CONTACT_NORMAL_INVALID_ARGUMENT {
            // The call may be refused because there is no step to continue from, or because a step of steady rolling is shorter than a tenth of an
            // element.
            let is_short = self.case.step_is_too_short();
            self.fail_unless(self.last.is_none() || is_short, "a step continues from the last one with friction");
            self.keeps(&held);
        } else if let Some(before) = &self.last {
            let verdict = check(&self.case, &found, before);
            self.add(verdict);
            if found.status < 0 {
                self.keeps(&held);
            }
            self.remember(&found);
        } else {
            self.fail_unless(found.status < 0, "a step continues from nothing");
        }
    }

    /// A call that must be refused.
    fn refused(&mut self) {
        let held = self.handle.fields(self.case.place.grid.len());
        let Case { mut place, mut slide, mut stop, carried, .. } = self.case.clone();
        let element = self.random.integer(0, slide.mu.len() - 1);
        let infinite = Some([0, 1].map(|_| vec![1e200; slide.mu.len()]));
        let what = match self.random.integer(0, 9) {
            0 => {
                (slide.uniform, slide.mu[element]) = (false, -1.0);
                "mu of -1"
            }
            1 => {
                (slide.uniform, slide.mu[element]) = (false, f64::NAN);
                "mu of NaN"
            }
            2 if carried > 0.0 && place.is_alike() => {
                (slide.prescribed, slide.amount) = ([1, 0], [1.5 * carried, 0.0]);
                "1.5 mu N"
            }
            3 => {
                slide.rigid = infinite;
                "own slip of 1e200"
            }
            4 => {
                slide.previous = infinite;
                (slide.motion, slide.mu) = (CONTACT_NORMAL_MOTION_SHIFT, vec![0.3; slide.mu.len()]);
                "tractions before of 1e200"
            }
            5 => {
                place.h[element] = f64::NAN;
                "h of NaN"
            }
            6 => {
                place.load = Load::Force(-1.0);
                "a force of -1"
            }
            7 => {
                stop.tolerance = self.random.pick(&[-1.0, 1.0, 2.0, f64::NAN]);
                "a tolerance out of range"
            }
            8 => {
                (slide.motion, slide.distance) = (CONTACT_NORMAL_MOTION_STEADY_ROLLING, f64::NAN);
                "a step of NaN"
            }
            _ => {
                slide.spin = f64::NAN;
                "a spin of NaN"
            }
        };
        let from = if self.random.chance(0.3) && slide.previous.is_none() { From::Handle } else { From::Slide };
        let found = self.handle.solve(&place, Some((&slide, from)), &stop);
        self.note(what, &found);
        self.fail_unless(found.status < 0, "a handle refuses what is no scene");
        if found.status < 0 {
            self.fail_unless(!found.written, "friction refused leaves outputs alone");
            self.keeps(&held);
        }
    }

    /// Checks that a refusal changes nothing that the handle holds.
    fn keeps(&mut self, held: &Found) {
        let now = self.handle.fields(self.case.place.grid.len());
        let same = now.status == held.status && (now.status < 0 || now.bits() == held.bits());
        self.fail_unless(same, "a refusal changes nothing that a handle holds");
    }

    /// A call whose callback cancels it once.
    fn cancelled(&mut self) {
        let stop = Stop { cancel_at: Some(self.random.integer(1, 40) as u32), ..self.case.stop.clone() };
        let Case { place, slide, carried, .. } = self.case.clone();
        let found = self.handle.solve(&place, Some((&slide, From::Slide)), &stop);
        self.note("cancelled", &found);
        self.remember(&found);
        let case = Case { place, slide, stop, carried };
        self.add(check(&case, &found, &case.before(&found.p)));
    }

    /// Several loads in one call, with one to three threads. The bits must be those of single calls. A batch that continues from the last step must
    /// be refused.
    fn batch(&mut self) {
        let Case { place, slide, stop, .. } = self.case.clone();
        let stop = Stop { threads: self.random.integer(1, 3) as i32, ..stop };
        let Ok(mut handle) = Handle::new(&place, &stop) else { return };
        let mut places = vec![place.clone(); self.random.integer(2, 5)];
        for next in &mut places[1..] {
            next.press(self.random, self.is_measured);
        }
        if self.random.chance(0.2) {
            let (status, found) = handle.solve_batch(&places, (&slide, From::Handle), &stop);
            self.history += &format!("batch that continues ({status}), ");
            self.fail_unless(status < 0 && found.iter().all(|found| !found.written), "a batch does not continue");
            return;
        }
        let (status, found) = handle.solve_batch(&places, (&slide, From::Slide), &stop);
        self.history += &format!("batch ({status}), ");
        for (place, found) in places.iter().zip(&found) {
            let alone = call(place, &slide, &stop);
            let same = found.status == alone.status && (found.status < 0 || found.bits() == alone.bits());
            self.fail_unless(same, "a batch with friction gives the bits of single calls");
        }
    }
}
