//! Solves random scenes, and checks each result: `make campaign N=20000`, or
//!
//! ```text
//! cargo run --release -p campaign -- 20000            cases of seeds 0..20000
//! cargo run --release -p campaign -- 20000 500000     cases of seeds 500000..520000
//! cargo run --release -p campaign -- --measured 5000  cases like measured ones, of seeds 0..5000
//! cargo run --release -p campaign -- --friction 5000  only cases with friction, of seeds 0..5000
//! cargo run --release -p campaign -- --measured --friction 5000
//! cargo run --release -p campaign -- --adhesion 5000  only cases with adhesion, of seeds 0..5000
//! cargo run --release -p campaign -- --laws 5000      laws of friction, layers that yield, wear, of seeds 0..5000
//! cargo run --release -p campaign -- --relaxing 5000  paths of loads on viscoelastic bodies, of seeds 0..5000
//! cargo run --release -p campaign -- --seed 17        the case of one seed, described in full
//! cargo run --release -p campaign -- --measured --seed 17
//! cargo run --release -p campaign -- --replay FILE    the scene of a dump (docs/dump.md)
//! ```

use std::collections::BTreeMap;
use std::ops::Range;
use std::process::ExitCode;

use campaign::account::{Account, Excuses};
use campaign::random::Random;
use campaign::run::{measured, ordinary, Run};
use campaign::verdict::Verdict;
use contact_normal::ffi::dump::Dump;

fn main() -> ExitCode {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut has_option = |name: &str| {
        let position = arguments.iter().position(|argument| argument == name);
        position.map(|position| arguments.remove(position)).is_some()
    };
    if has_option("--replay") {
        return replay_dump(&arguments[0]);
    }
    let (is_measured, is_friction, one) = (has_option("--measured"), has_option("--friction"), has_option("--seed"));
    let (is_adhesive, is_law, is_relaxing) = (has_option("--adhesion"), has_option("--laws"), has_option("--relaxing"));
    let number = |i: usize| arguments.get(i).and_then(|text| text.parse::<u64>().ok());
    let run = if is_measured { measured } else { ordinary };
    if one {
        return describe(&run(number(0).expect("--seed N: a number")));
    }
    let (count, first) = (number(0).unwrap_or(1000), number(1).unwrap_or(0));
    let seeds = first..first + count;
    if is_friction {
        return report(seeds, |seed| friction(seed, is_measured));
    }
    if is_adhesive {
        return report(seeds, adhesion);
    }
    if is_law {
        return report(seeds, laws);
    }
    if is_relaxing {
        return report(seeds, relaxing);
    }
    let mut account = Account::default();
    for seed in seeds {
        let run = run(seed);
        // Failures are printed immediately, because a long campaign may be stopped.
        run.verdict.failures.iter().for_each(|failure| eprintln!("seed {seed}: {}", failure.promise));
        account.add(&run);
    }
    println!("{account}");
    print!("{}", account.failures(usize::MAX));
    end(account.is_clean())
}

/// The exit code of the program.
fn end(is_clean: bool) -> ExitCode {
    if is_clean {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Runs and describes the scene of a dump.
fn replay_dump(path: &str) -> ExitCode {
    let bytes = std::fs::read(path).map_err(|why| why.to_string());
    match bytes.and_then(|bytes| Dump::read(&bytes)).and_then(|dump| campaign::replay::run(&dump)) {
        Ok(run) => describe(&run),
        Err(why) => {
            eprintln!("{path}: {why}");
            ExitCode::FAILURE
        }
    }
}

/// Prints one case and its result in full.
fn describe(run: &Run) -> ExitCode {
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

/// The calls of a case, for the report of one kind of cases.
struct Calls {
    /// For each call, the row of the report in which it counts, and its status.
    ends: Vec<(String, i32)>,
    /// The products of the first call, if they are counted.
    products: Option<f64>,
    verdict: Verdict,
}

/// Runs a case with friction. Calls count by their motion and bodies.
fn friction(seed: u64, is_measured: bool) -> Calls {
    let run = campaign::friction::run(&mut Random::new(seed ^ 0x00f1_c710), is_measured);
    let ends = run.statuses.iter().map(|status| (run.case.kind(), *status)).collect();
    Calls { ends, products: None, verdict: run.verdict }
}

/// Runs a path of loads on viscoelastic bodies. Calls count by method and effects.
fn relaxing(seed: u64) -> Calls {
    let run = campaign::relaxing::run(seed);
    let kind = format!("{}, {}", run.case.method(), run.case.effects.name());
    let ends = run.statuses.iter().map(|status| (kind.clone(), *status)).collect();
    Calls { ends, products: None, verdict: run.verdict }
}

/// Runs a case with a law of friction. Calls count by their motion and the slope of the law.
fn laws(seed: u64) -> Calls {
    let run = campaign::laws::run(&mut Random::new(seed ^ 0x001a_a5e5));
    let ends = run.ends.iter().map(|(slope, status)| (run.kind(*slope), *status)).collect();
    Calls { ends, products: None, verdict: run.verdict }
}

/// Runs a case with adhesion. Its products are counted.
fn adhesion(seed: u64) -> Calls {
    let run = campaign::adhesion::run(&mut Random::new(seed ^ 0x00ad_4e51));
    let ends = run.statuses.iter().map(|status| ("adhesion".to_string(), *status)).collect();
    Calls { ends, products: run.products, verdict: run.verdict }
}

/// Runs the cases of these seeds. Prints the broken promises, the counts of statuses, the excuses, and quantiles of the products.
fn report(seeds: Range<u64>, run: impl Fn(u64) -> Calls) -> ExitCode {
    let (mut ends, mut excuses, mut products, mut failed) = (BTreeMap::new(), Excuses::default(), Vec::new(), false);
    for seed in seeds {
        let calls = run(seed);
        calls.ends.into_iter().for_each(|end| *ends.entry(end).or_insert(0) += 1);
        products.extend(calls.products);
        excuses.add(&calls.verdict.excuses, seed);
        for failure in calls.verdict.failures {
            failed = true;
            println!("seed {seed}: {}: {}", failure.promise, failure.details);
        }
    }
    println!("| kind | status | calls |");
    println!("|---|---:|---:|");
    for ((kind, status), calls) in ends {
        println!("| {kind} | {status} | {calls} |");
    }
    print!("\n{excuses}");
    products.sort_by(f64::total_cmp);
    let quantile = |part: f64| products.get((part * products.len() as f64) as usize);
    if let (Some(median), Some(ninety), Some(ninety_nine)) = (quantile(0.5), quantile(0.9), quantile(0.99)) {
        println!("\nproducts: median {median:.1}, 90 % {ninety:.1}, 99 % {ninety_nine:.1}");
    }
    end(!failed)
}
