//! The verdict on a result: broken promises of the library, and excuses.

/// A broken promise.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The promise, in a few words.
    pub promise: &'static str,
    /// How it is broken, in words and numbers.
    pub details: String,
}

/// The verdict on one or several results.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// The broken promises.
    pub failures: Vec<Failure>,
    /// The reasons for which results are accepted although they are no solutions. Each is counted and printed.
    pub excuses: Vec<&'static str>,
}

impl Verdict {
    /// The verdict on a result that is accepted although it is no solution.
    pub fn excused(why: &'static str) -> Verdict {
        Verdict { failures: Vec::new(), excuses: vec![why] }
    }

    /// The verdict on a result that breaks one promise.
    pub fn failed(promise: &'static str, details: String) -> Verdict {
        Verdict { failures: vec![Failure { promise, details }], excuses: Vec::new() }
    }

    /// Adds a broken promise.
    pub fn fail(&mut self, promise: &'static str, details: impl Into<String>) {
        self.failures.push(Failure { promise, details: details.into() });
    }

    /// Adds a broken promise, unless it is `kept`.
    pub fn unless(&mut self, kept: bool, promise: &'static str, details: impl FnOnce() -> String) {
        if !kept {
            self.fail(promise, details());
        }
    }

    /// Adds an excuse.
    pub fn excuse(&mut self, why: &'static str) {
        self.excuses.push(why);
    }

    /// Adds the failures and excuses of another verdict.
    pub fn add(&mut self, other: Verdict) {
        self.failures.extend(other.failures);
        self.excuses.extend(other.excuses);
    }

    /// Puts the text `what` before the details of each failure.
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
