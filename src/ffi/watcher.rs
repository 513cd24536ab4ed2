//! The watcher of a solve: after each cycle it tests whether the progress callback, `max_seconds` or `options->stop` ends the solve.

use std::cell::Cell;
use std::sync::atomic::{AtomicI32, Ordering};
use std::time::{Duration, Instant};

use super::conclusion::Conclusion;
use super::floating_point::in_host_environment;
use super::options::{contact_normal_options, Translated};
use super::progress::contact_normal_progress;
use super::status::{CONTACT_NORMAL_CANCELLED, CONTACT_NORMAL_ITERATION_LIMIT};
use crate::solver::{Outcome, Progress, ProgressCallback};

/// What ended a solve early.
#[derive(Clone, Copy, PartialEq)]
enum Reason {
    /// The progress callback returned non-zero.
    Callback,
    /// `options->stop` was set.
    Stop,
    /// `max_seconds` was reached.
    Late,
}

/// Tests after each cycle whether to end the solve.
pub(super) struct Watcher {
    /// The options with the callback and `stop`.
    given: contact_normal_options,
    /// When `max_seconds` is reached. None: there is no limit.
    end: Option<Instant>,
    /// The first reason that ended the solve.
    reason: Cell<Option<Reason>>,
}

impl Watcher {
    /// A watcher with the callback, the limit of time and the stop of `options`.
    pub fn of(options: &Translated) -> Watcher {
        Watcher::with(options, options.given)
    }

    /// As [`Watcher::of`], without the progress callback: for a thread of the library, on which no callback may be called.
    pub fn without_callback(options: &Translated) -> Watcher {
        Watcher::with(options, contact_normal_options { progress: None, ..options.given })
    }

    fn with(options: &Translated, given: contact_normal_options) -> Watcher {
        // A limit below a nanosecond is reached at once. A limit beyond the range of clocks is no limit.
        let limit = Some(given.max_seconds).filter(|limit| *limit > 0.0);
        let limit = limit.and_then(|limit| Duration::try_from_secs_f64(limit).ok());
        let end = limit.and_then(|limit| options.began.checked_add(limit));
        Watcher { given, end, reason: Cell::new(None) }
    }

    /// The callback for a solve: `told`, which is the function that [`told`](Self::told) returns. None: nothing can end the solve early.
    pub fn callback<'a>(&self, told: ProgressCallback<'a>) -> Option<ProgressCallback<'a>> {
        let watches = self.given.progress.is_some() || !self.given.stop.is_null() || self.end.is_some();
        watches.then_some(told)
    }

    /// Returns a function that is called with the progress after each cycle, and returns whether to end the solve. Once the function has returned
    /// true, it always returns true.
    pub fn told(&self) -> impl FnMut(&Progress) -> bool + '_ {
        |progress| {
            self.reason.set(self.reason.get().or_else(|| self.reason_to_end(progress)));
            self.reason.get().is_some()
        }
    }

    /// The reason to end a solve now, if there is one.
    fn reason_to_end(&self, progress: &Progress) -> Option<Reason> {
        let stop = self.given.stop.cast_mut();
        // SAFETY: not NULL, so an integer of the caller that another thread may set. It is only read here, and as an atomic.
        let is_stopped = !stop.is_null() && unsafe { AtomicI32::from_ptr(stop) }.load(Ordering::Relaxed) != 0;
        if is_stopped {
            Some(Reason::Stop)
        } else if self.end.is_some_and(|end| Instant::now() >= end) {
            Some(Reason::Late)
        } else {
            self.calls_back(progress).then_some(Reason::Callback)
        }
    }

    /// Calls the progress callback, if there is one. Returns whether the callback ends the solve.
    fn calls_back(&self, progress: &Progress) -> bool {
        let Some(callback) = self.given.progress else { return false };
        let progress = contact_normal_progress::from(progress);
        // SAFETY: the caller's function, called on the caller's thread with the caller's pointer. No lock is held, and other calls with the handle
        // that solves are refused meanwhile.
        in_host_environment(|| unsafe { callback(&progress, self.given.user) != 0 })
    }

    /// Why the solve was cancelled, for the message.
    fn why(&self) -> &'static str {
        match self.reason.get() {
            Some(Reason::Late) => "max_seconds was reached",
            Some(Reason::Stop) => "options->stop asked for it",
            _ => CANCELLED,
        }
    }

    /// Completes the conclusion of the solve: the message gets the reason, and a solve that `max_seconds` ended has the status ITERATION_LIMIT.
    pub fn conclusion(&self, mut conclusion: Conclusion) -> Conclusion {
        conclusion.is_late = self.reason.get() == Some(Reason::Late);
        conclusion.message = conclusion.message.replace(CANCELLED, self.why());
        if conclusion.is_late && conclusion.status == CONTACT_NORMAL_CANCELLED {
            conclusion.status = CONTACT_NORMAL_ITERATION_LIMIT;
        }
        conclusion
    }
}

/// The reason in the message of a cancelled solve. [`Watcher::conclusion`] replaces it if `stop` or `max_seconds` ended the solve.
const CANCELLED: &str = "the progress callback cancelled";

/// Why an iteration ended, for messages.
pub(super) fn why(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Converged => "solved",
        Outcome::IterationLimit => "max_cycles was reached",
        Outcome::Cancelled => CANCELLED,
        Outcome::Stagnated => "no further progress",
    }
}
