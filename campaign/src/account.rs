//! The account of a campaign: counts of the cases and their results, the excuses, and every broken promise.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

use crate::run::{Run, BESIDE};

/// Counts of calls by their status.
#[derive(Clone, Copy, Default)]
struct Ends {
    /// Calls with status OK.
    solved: usize,
    /// Calls with a status > 0.
    stopped: usize,
    /// Calls with a status < 0.
    refused: usize,
    /// Cases that broke a promise.
    failed: usize,
}

impl Ends {
    /// Adds the calls of one case.
    fn add(&mut self, statuses: &[i32], has_failed: bool) {
        for &status in statuses {
            *match status {
                0 => &mut self.solved,
                1.. => &mut self.stopped,
                _ => &mut self.refused,
            } += 1;
        }
        self.failed += usize::from(has_failed);
    }
}

/// The excuses of calls. Of each: the number of calls, and the first seed.
#[derive(Default)]
pub struct Excuses(BTreeMap<&'static str, (usize, u64)>);

impl Excuses {
    /// Adds the excuses of the calls of a seed.
    pub fn add(&mut self, excuses: &[&'static str], seed: u64) {
        for why in excuses {
            let (calls, _first_seed) = self.0.entry(why).or_insert((0, seed));
            *calls += 1;
        }
    }
}

impl Display for Excuses {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "| excused | calls | first seed |")?;
        writeln!(f, "|---|---:|---:|")?;
        for (why, (calls, seed)) in &self.0 {
            writeln!(f, "| {why} | {calls} | {seed} |")?;
        }
        Ok(())
    }
}

/// The account of a campaign.
#[derive(Default)]
pub struct Account {
    cases: usize,
    /// The processor time of all cases.
    seconds: f64,
    /// The processor time of the slowest case, and its seed.
    longest: (f64, u64),
    by_effects: BTreeMap<String, Ends>,
    by_method: BTreeMap<&'static str, Ends>,
    by_surface: BTreeMap<String, Ends>,
    /// The further calls of cases (see [`Run::beside`]).
    beside: BTreeMap<String, Ends>,
    /// For each surface: the products of calls of AUTO, and their seeds.
    products: BTreeMap<String, Vec<(f64, u64)>>,
    excuses: Excuses,
    /// For each broken promise: the seeds and the details.
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
        // The name of the surface without its faults.
        let surface = run.case.surface.split(" + ").next().unwrap_or_default().to_string();
        let effects = self.by_effects.entry(run.case.effects.name()).or_default();
        let method = self.by_method.entry(run.case.method()).or_default();
        let shape = self.by_surface.entry(surface.clone()).or_default();
        for ends in [effects, method, shape] {
            ends.add(&run.statuses, !run.verdict.failures.is_empty());
        }
        if let Some((what, statuses)) = &run.beside {
            self.beside.entry(what.clone()).or_default().add(statuses, !run.verdict.failures.is_empty());
        }
        if let Some(products) = run.products {
            self.products.entry(surface).or_default().push((products, run.case.seed));
        }
        self.excuses.add(&run.verdict.excuses, run.case.seed);
        for failure in &run.verdict.failures {
            let text = match failure.details.strip_prefix(BESIDE) {
                Some(details) => details.to_string(),
                None => format!("{}: {}", run.case.describe(), failure.details),
            };
            self.failures.entry(failure.promise).or_default().push((run.case.seed, text));
        }
    }

    /// Whether every promise was kept.
    pub fn is_clean(&self) -> bool {
        self.failures.is_empty()
    }

    /// The number of calls with status OK. Tests require a least number, because an account of refusals only would have no failures.
    pub fn solved(&self) -> usize {
        self.by_method.values().map(|ends| ends.solved).sum()
    }

    /// A text with at most `most` failures of each promise.
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

/// Writes a table of counts, if there are any.
fn table<K: Display>(f: &mut Formatter<'_>, title: &str, rows: &BTreeMap<K, Ends>) -> fmt::Result {
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(f, "| {title} | OK | stopped early | refused | cases that broke a promise |")?;
    writeln!(f, "|---|---:|---:|---:|---:|")?;
    for (name, Ends { solved, stopped, refused, failed }) in rows {
        writeln!(f, "| {name} | {solved} | {stopped} | {refused} | {failed} |")?;
    }
    writeln!(f)
}

/// Writes a table of the products of AUTO.
fn table_of_products(f: &mut Formatter<'_>, rows: &BTreeMap<String, Vec<(f64, u64)>>) -> fmt::Result {
    writeln!(f, "| products of AUTO from nothing | calls | median | 90 % | most | seed of that |")?;
    writeln!(f, "|---|---:|---:|---:|---:|---:|")?;
    for (name, list) in rows {
        let mut sorted = list.clone();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let quantile = |part: f64| sorted[(part * (sorted.len() - 1) as f64) as usize];
        let [(median, _), (ninety, _), (most, seed)] = [0.5, 0.9, 1.0].map(quantile);
        writeln!(f, "| {name} | {} | {median:.1} | {ninety:.1} | {most:.1} | {seed} |", list.len())?;
    }
    writeln!(f)
}

impl Display for Account {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        table(f, "effects", &self.by_effects)?;
        table(f, "method", &self.by_method)?;
        table(f, "surface", &self.by_surface)?;
        table(f, "asked beside", &self.beside)?;
        table_of_products(f, &self.products)?;
        write!(f, "{}", self.excuses)?;
        let (seconds, seed) = self.longest;
        writeln!(
            f,
            "\n{} cases in {:.1} s of the processor; the longest took {seconds:.2} s (seed {seed})",
            self.cases, self.seconds
        )
    }
}
