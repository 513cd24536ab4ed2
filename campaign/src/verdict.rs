//! What came of an answer: promises that were not kept, and what is excused.

/// A promise that was not kept.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Which one, in a few words.
    pub promise: &'static str,
    pub details: String,
}

/// Failures, and reasons for which an answer that is no solution was let pass: each is counted and printed.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    pub failures: Vec<Failure>,
    pub excuses: Vec<&'static str>,
}

impl Verdict {
    /// An answer that was let pass.
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

    /// Adds another one.
    pub fn add(&mut self, other: Verdict) {
        self.failures.extend(other.failures);
        self.excuses.extend(other.excuses);
    }

    /// The same with a word before the details of each failure.
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
