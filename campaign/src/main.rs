//! Random scenes, each certified: `make campaign N=20000`, or
//!
//! ```text
//! cargo run --release -p campaign -- 20000            cases of seeds 0..20000
//! cargo run --release -p campaign -- 20000 500000     of seeds 500000..520000
//! cargo run --release -p campaign -- --measured 5000  cases of what people bring, of seeds 0..5000
//! cargo run --release -p campaign -- --friction 5000  cases with friction alone, of seeds 0..5000
//! cargo run --release -p campaign -- --measured --friction 5000
//! cargo run --release -p campaign -- --adhesion 5000  cases with adhesion alone, of seeds 0..5000
//! cargo run --release -p campaign -- --laws 5000      laws of friction, layers that yield, wear, of seeds 0..5000
//! cargo run --release -p campaign -- --relaxing 5000  paths of bodies that relax, of seeds 0..5000
//! cargo run --release -p campaign -- --seed 17        one case again, with all that is known of it
//! cargo run --release -p campaign -- --measured --seed 17
//! cargo run --release -p campaign -- --replay FILE    the scene of a dump (docs/dump.md)
//! ```

use std::collections::BTreeMap;
use std::process::ExitCode;

use campaign::account::Account;
use campaign::random::Random;
use campaign::run::{measured, ordinary, Run};
use campaign::verdict::Verdict;
use contact_normal::ffi::dump::Dump;

fn main() -> ExitCode {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut named = |name: &str| {
        let at = arguments.iter().position(|argument| argument == name);
        at.map(|at| arguments.remove(at)).is_some()
    };
    if named("--replay") {
        return dumped(&arguments[0]);
    }
    let (is_measured, is_friction, one) = (named("--measured"), named("--friction"), named("--seed"));
    let (is_adhesive, is_law, is_relaxing) = (named("--adhesion"), named("--laws"), named("--relaxing"));
    let number = |i: usize| arguments.get(i).and_then(|text| text.parse::<u64>().ok());
    let run = if is_measured { measured } else { ordinary };
    if one {
        return replay(&run(number(0).expect("--seed N: a number")));
    }
    let (count, first) = (number(0).unwrap_or(1000), number(1).unwrap_or(0));
    if is_friction {
        return friction(count, first, is_measured);
    }
    if is_adhesive {
        return adhesion(count, first);
    }
    if is_law {
        return laws(count, first);
    }
    if is_relaxing {
        return relaxing(count, first);
    }
    let mut account = Account::default();
    for seed in first..first + count {
        let run = run(seed);
        // At once, for whoever stops a long campaign.
        run.verdict.failures.iter().for_each(|failure| eprintln!("seed {seed}: {}", failure.promise));
        account.add(&run);
    }
    println!("{account}");
    print!("{}", account.failures(usize::MAX));
    end(account.is_clean())
}

fn end(is_clean: bool) -> ExitCode {
    if is_clean {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// The scene of a dump.
fn dumped(path: &str) -> ExitCode {
    let bytes = std::fs::read(path).map_err(|why| why.to_string());
    match bytes.and_then(|bytes| Dump::read(&bytes)).and_then(|dump| campaign::replay::run(&dump)) {
        Ok(run) => replay(&run),
        Err(why) => {
            eprintln!("{path}: {why}");
            ExitCode::FAILURE
        }
    }
}

/// One case, in full.
fn replay(run: &Run) -> ExitCode {
    println!("seed {}: {}", run.case.seed, run.case.describe());
    println!(
        "load {:?}, statuses {:?}, products {:?}, {:.3} s",
        run.case.load, run.statuses, run.products, run.seconds
    );
    println!("beside: {:?}, excused: {:?}", run.beside, run.verdict.excuses);
    for failure in &run.verdict.failures {
        println!("{}: {}", failure.promise, failure.details);
    }
    end(run.verdict.failures.is_empty())
}

/// Cases with friction: how the calls of each motion ended, and what was not kept.
fn friction(count: u64, first: u64, is_measured: bool) -> ExitCode {
    let mut calls = Calls::default();
    for seed in first..first + count {
        let run = campaign::friction::run(&mut Random::new(seed ^ 0x00f1_c710), is_measured);
        calls.add(seed, run.statuses.into_iter().map(|status| (run.case.kind(), status)), run.verdict);
    }
    calls.print()
}

/// Steps of bodies that relax: how they ended, and what was not kept.
fn relaxing(count: u64, first: u64) -> ExitCode {
    let mut calls = Calls::default();
    for seed in first..first + count {
        let run = campaign::relaxing::run(seed);
        let kind = format!("{}, {}", run.case.method(), run.case.effects.name());
        calls.add(seed, run.statuses.into_iter().map(|status| (kind.clone(), status)), run.verdict);
    }
    calls.print()
}

/// Ends of the calls of many cases: how many ended how, and how often each excuse was taken, first by which seed.
#[derive(Default)]
struct Calls {
    ends: BTreeMap<(String, i32), u64>,
    excuses: BTreeMap<&'static str, (u64, u64)>,
    failed: bool,
}

impl Calls {
    /// Adds the calls of a case, by kind and status; prints its failures.
    fn add(&mut self, seed: u64, ends: impl Iterator<Item = (String, i32)>, verdict: Verdict) {
        for end in ends {
            *self.ends.entry(end).or_insert(0) += 1;
        }
        for why in verdict.excuses {
            self.excuses.entry(why).or_insert((0, seed)).0 += 1;
        }
        for failure in verdict.failures {
            self.failed = true;
            println!("seed {seed}: {}: {}", failure.promise, failure.details);
        }
    }

    fn print(self) -> ExitCode {
        println!("| motion | status | calls |");
        println!("|---|---:|---:|");
        for ((kind, status), calls) in self.ends {
            println!("| {kind} | {status} | {calls} |");
        }
        println!("\n| excused | calls | first seed |");
        println!("|---|---:|---:|");
        for (why, (calls, seed)) in self.excuses {
            println!("| {why} | {calls} | {seed} |");
        }
        end(!self.failed)
    }
}

/// Cases with laws of friction: how the calls ended, and what was not kept.
fn laws(count: u64, first: u64) -> ExitCode {
    let mut calls = Calls::default();
    for seed in first..first + count {
        let run = campaign::laws::run(&mut Random::new(seed ^ 0x001a_a5e5));
        calls.add(seed, run.ends.iter().map(|(slope, status)| (run.kind(*slope), *status)), run.verdict.clone());
    }
    calls.print()
}

/// Cases with adhesion: how the calls ended, their products, and what was not kept.
fn adhesion(count: u64, first: u64) -> ExitCode {
    let (mut ends, mut excuses, mut failed, mut products) = (BTreeMap::new(), BTreeMap::new(), false, Vec::new());
    for seed in first..first + count {
        let run = campaign::adhesion::run(&mut Random::new(seed ^ 0x00ad_4e51));
        run.statuses.iter().for_each(|status| *ends.entry(*status).or_insert(0) += 1);
        run.verdict.excuses.iter().for_each(|why| excuses.entry(*why).or_insert((0, seed)).0 += 1);
        products.extend(run.products);
        for failure in run.verdict.failures {
            failed = true;
            println!("seed {seed}: {}: {}", failure.promise, failure.details);
        }
    }
    products.sort_by(f64::total_cmp);
    let part = |of: f64| products.get((of * products.len() as f64) as usize).copied().unwrap_or_default();
    println!("statuses {ends:?}; products: median {:.1}, 90 % {:.1}, 99 % {:.1}", part(0.5), part(0.9), part(0.99));
    println!("excused: {excuses:?}");
    end(!failed)
}
