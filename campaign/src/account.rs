//! What was run, what came of it, and every failure.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

use crate::Run;

/// Counts of calls by how they ended: solved, stopped (> 0), refused (< 0).
#[derive(Clone, Copy, Default)]
struct Ends {
    solved: usize,
    stopped: usize,
    refused: usize,
    failed: usize,
}

/// The account of a campaign.
#[derive(Default)]
pub struct Account {
    cases: usize,
    seconds: f64,
    longest: (f64, u64),
    by_effects: BTreeMap<String, Ends>,
    by_method: BTreeMap<&'static str, Ends>,
    /// Per promise: seed and what happened.
    failures: BTreeMap<&'static str, Vec<(u64, String)>>,
}

impl Account {
    /// Adds a case.
    pub fn add(&mut self, run: &Run) {
        self.cases += 1;
        self.seconds += run.seconds;
        if run.seconds > self.longest.0 {
            self.longest = (run.seconds, run.case.seed);
        }
        let effects = self.by_effects.entry(run.case.effects.name()).or_default();
        let method = self.by_method.entry(run.case.method()).or_default();
        for ends in [effects, method] {
            for &status in &run.statuses {
                *match status {
                    0 => &mut ends.solved,
                    1.. => &mut ends.stopped,
                    _ => &mut ends.refused,
                } += 1;
            }
            ends.failed += usize::from(!run.failures.is_empty());
        }
        for failure in &run.failures {
            let text = format!("{}: {}", run.case.describe(), failure.details);
            self.failures.entry(failure.promise).or_default().push((run.case.seed, text));
        }
    }

    /// Whether every promise was kept.
    pub fn is_clean(&self) -> bool {
        self.failures.is_empty()
    }

    /// How many calls were solved: an account of refusals would be worth nothing.
    pub fn solved(&self) -> usize {
        self.by_method.values().map(|ends| ends.solved).sum()
    }

    /// At most so many failures of each promise, in full.
    pub fn failures(&self, most: usize) -> String {
        let mut text = String::new();
        for (promise, list) in &self.failures {
            text += &format!("{promise}: {} failures\n", list.len());
            for (seed, details) in list.iter().take(most) {
                text += &format!("    seed {seed}: {details}\n");
            }
        }
        text
    }
}

fn table<K: Display>(f: &mut Formatter<'_>, title: &str, rows: &BTreeMap<K, Ends>) -> fmt::Result {
    writeln!(f, "| {title} | OK | stopped early | refused | cases that broke a promise |")?;
    writeln!(f, "|---|---:|---:|---:|---:|")?;
    for (name, Ends { solved, stopped, refused, failed }) in rows {
        writeln!(f, "| {name} | {solved} | {stopped} | {refused} | {failed} |")?;
    }
    writeln!(f)
}

impl Display for Account {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        table(f, "effects", &self.by_effects)?;
        table(f, "method", &self.by_method)?;
        let (seconds, seed) = self.longest;
        writeln!(f, "{} cases in {:.1} s; the longest took {seconds:.2} s (seed {seed})", self.cases, self.seconds)
    }
}
