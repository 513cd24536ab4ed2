//! Ends a solve early. After each cycle it asks the progress callback, the limit of time and the stop of another
//! thread.

use std::sync::atomic::{AtomicI32, Ordering};
use std::time::{Duration, Instant};

use super::conclusion::Conclusion;
use super::floating_point::in_host_environment;
use super::options::{contact_normal_options, Translated};
use super::progress::contact_normal_progress;
use super::status::{Refusal, CONTACT_NORMAL_CANCELLED, CONTACT_NORMAL_ITERATION_LIMIT};
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
    reason: Option<Reason>,
}

impl Watcher {
    /// None where there is nothing to ask.
    pub fn of(options: &Translated) -> Option<Watcher> {
        Watcher::asking(options, options.given)
    }

    /// For a thread of ours: no callback is called there.
    pub fn without_callback(options: &Translated) -> Option<Watcher> {
        Watcher::asking(options, contact_normal_options { progress: None, ..options.given })
    }

    fn asking(options: &Translated, given: contact_normal_options) -> Option<Watcher> {
        // A limit below a nanosecond has passed; one beyond the range of clocks is none.
        let limit = Some(given.max_seconds).filter(|limit| *limit > 0.0);
        let limit = limit.and_then(|limit| Duration::try_from_secs_f64(limit).ok());
        let end = limit.and_then(|limit| options.began.checked_add(limit));
        let watches = given.progress.is_some() || !given.stop.is_null() || end.is_some();
        watches.then_some(Watcher { given, end, reason: None })
    }

    /// Whether to cancel. After one yes all later answers are yes.
    fn told(&mut self, progress: &Progress) -> bool {
        if self.reason.is_some() {
            return true;
        }
        let stop = self.given.stop.cast_mut();
        // SAFETY: not NULL: an integer of the caller's that another thread may set; only read here, and as an atomic.
        let is_stopped = !stop.is_null() && unsafe { AtomicI32::from_ptr(stop) }.load(Ordering::Relaxed) != 0;
        self.reason = if is_stopped {
            Some(Reason::Stop)
        } else if self.end.is_some_and(|end| Instant::now() >= end) {
            Some(Reason::Late)
        } else {
            self.calls_back(progress).then_some(Reason::Callback)
        };
        self.reason.is_some()
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
        match self.reason {
            Some(Reason::Late) => "max_seconds was reached",
            Some(Reason::Stop) => "options->stop asked for it",
            _ => CANCELLED,
        }
    }

    /// The conclusion of a solve that this watched.
    fn conclusion(&self, mut of: Conclusion) -> Conclusion {
        of.is_late = self.reason == Some(Reason::Late);
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

/// The conclusion of a solve that a watcher, if there is one, is told of.
pub(super) fn watched(
    mut watcher: Option<Watcher>,
    solve: impl FnOnce(Option<ProgressCallback<'_>>) -> Result<Conclusion, Refusal>,
) -> Result<Conclusion, Refusal> {
    let mut told = watcher.as_mut().map(|watcher| |progress: &Progress| watcher.told(progress));
    let found = solve(told.as_mut().map(|told| told as ProgressCallback<'_>))?;
    Ok(match watcher {
        Some(watcher) => watcher.conclusion(found),
        None => found,
    })
}
