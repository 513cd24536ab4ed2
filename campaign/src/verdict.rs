//! The verdict on a result: broken promises, and excuses.

/// A promise that was not kept.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The promise, in a few words.
    pub promise: &'static str,
    pub details: String,
}

/// Failures, and the reasons for which a result that is no solution is accepted. Each is counted and printed.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    pub failures: Vec<Failure>,
    pub excuses: Vec<&'static str>,
}

impl Verdict {
    /// A result that is no solution, but accepted.
    pub fn excused(why: &'static str) -> Verdict {
        Verdict { failures: Vec::new(), excuses: vec![why] }
    }

    pub fn failed(promise: &'static str, details: String) -> Verdict {
        Verdict { failures: vec![Failure { promise, details }], excuses: Vec::new() }
    }

    pub fn fail(&mut self, promise: &'static str, details: impl Into<String>) {
        self.failures.push(Failure { promise, details: details.into() });
    }

    pub fn unless(&mut self, kept: bool, promise: &'static str, details: impl FnOnce() -> String) {
        if !kept {
            self.fail(promise, details());
        }
    }

    pub fn excuse(&mut self, why: &'static str) {
        self.excuses.push(why);
    }

    /// Adds another verdict.
    pub fn add(&mut self, other: Verdict) {
        self.failures.extend(other.failures);
        self.excuses.extend(other.excuses);
    }

    /// The verdict with `what` before the details of each failure.
    pub fn within(mut self, what: &str) -> Verdict {
        self.failures.iter_mut().for_each(|failure| failure.details = format!("{what}{}", failure.details));
        self
    }
}

impl From<Vec<Failure>> for Verdict {
    fn from(failures: Vec<Failure>) -> Verdict {
        Verdict { failures, excuses: Vec::new() }
    }
}
