//! Ends a solve early. After each cycle it asks the progress callback, the limit of time and the stop of another
//! thread.

use std::cell::Cell;
use std::sync::atomic::{AtomicI32, Ordering};
use std::time::{Duration, Instant};

use super::conclusion::Conclusion;
use super::floating_point::in_host_environment;
use super::options::{contact_normal_options, Translated};
use super::progress::contact_normal_progress;
use super::status::{CONTACT_NORMAL_CANCELLED, CONTACT_NORMAL_ITERATION_LIMIT};
use crate::solver::{Outcome, Progress, ProgressCallback};

/// Why a solve was ended from outside.
#[derive(Clone, Copy, PartialEq)]
enum Reason {
    Callback,
    Stop,
    Late,
}

/// Asked after each cycle whether to end the solve.
pub(super) struct Watcher {
    given: contact_normal_options,
    end: Option<Instant>,
    reason: Cell<Option<Reason>>,
}

impl Watcher {
    /// Asks what the options of a call name.
    pub fn of(options: &Translated) -> Watcher {
        Watcher::asking(options, options.given)
    }

    /// A watcher for a thread of the library, on which no callback is called.
    pub fn without_callback(options: &Translated) -> Watcher {
        Watcher::asking(options, contact_normal_options { progress: None, ..options.given })
    }

    fn asking(options: &Translated, given: contact_normal_options) -> Watcher {
        // A limit below a nanosecond has passed; one beyond the range of clocks is none.
        let limit = Some(given.max_seconds).filter(|limit| *limit > 0.0);
        let limit = limit.and_then(|limit| Duration::try_from_secs_f64(limit).ok());
        let end = limit.and_then(|limit| options.began.checked_add(limit));
        Watcher { given, end, reason: Cell::new(None) }
    }

    /// `told`, the answers of [`told`](Self::told), as the callback of a solve. None if there is nothing to ask.
    pub fn callback<'a>(&self, told: ProgressCallback<'a>) -> Option<ProgressCallback<'a>> {
        let watches = self.given.progress.is_some() || !self.given.stop.is_null() || self.end.is_some();
        watches.then_some(told)
    }

    /// Answers whether to cancel. After one yes all later answers are yes.
    pub fn told(&self) -> impl FnMut(&Progress) -> bool + '_ {
        |progress| {
            self.reason.set(self.reason.get().or_else(|| self.reason_to_end(progress)));
            self.reason.get().is_some()
        }
    }

    /// The reason to end a solve now, if there is one.
    fn reason_to_end(&self, progress: &Progress) -> Option<Reason> {
        let stop = self.given.stop.cast_mut();
        // SAFETY: not NULL: an integer of the caller's that another thread may set; only read here, and as an atomic.
        let is_stopped = !stop.is_null() && unsafe { AtomicI32::from_ptr(stop) }.load(Ordering::Relaxed) != 0;
        if is_stopped {
            Some(Reason::Stop)
        } else if self.end.is_some_and(|end| Instant::now() >= end) {
            Some(Reason::Late)
        } else {
            self.calls_back(progress).then_some(Reason::Callback)
        }
    }

    fn calls_back(&self, progress: &Progress) -> bool {
        let Some(callback) = self.given.progress else { return false };
        let progress = contact_normal_progress::from(progress);
        // SAFETY: the caller's function, called on the caller's thread with the caller's pointer; no lock is held, and the
        // handle that solves refuses to be used.
        in_host_environment(|| unsafe { callback(&progress, self.given.user) != 0 })
    }

    /// Why a solve that ended so was cancelled, in words.
    fn why(&self) -> &'static str {
        match self.reason.get() {
            Some(Reason::Late) => "max_seconds was reached",
            Some(Reason::Stop) => "options->stop asked for it",
            _ => CANCELLED,
        }
    }

    /// The conclusion of a solve that this watched.
    pub fn conclusion(&self, mut of: Conclusion) -> Conclusion {
        of.is_late = self.reason.get() == Some(Reason::Late);
        of.message = of.message.replace(CANCELLED, self.why());
        if of.is_late && of.status == CONTACT_NORMAL_CANCELLED {
            of.status = CONTACT_NORMAL_ITERATION_LIMIT;
        }
        of
    }
}

/// The reason in the message of a cancelled solve, unless `stop` or the limit of time cancelled it.
const CANCELLED: &str = "the progress callback cancelled";

/// Why a loop ended, in words.
pub(super) fn why(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Converged => "solved",
        Outcome::IterationLimit => "max_cycles was reached",
        Outcome::Cancelled => CANCELLED,
        Outcome::Stagnated => "no further progress",
    }
}
