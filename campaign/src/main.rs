//! Random scenes, each certified: `make campaign N=20000`, or
//!
//! ```text
//! cargo run --release -p campaign -- 20000            cases of seeds 0..20000
//! cargo run --release -p campaign -- 20000 500000     of seeds 500000..520000
//! cargo run --release -p campaign -- --seed 17        one case again, with all that is known of it
//! cargo run --release -p campaign -- --friction 5000  cases with friction alone, of seeds 0..5000
//! ```

use std::collections::BTreeMap;
use std::process::ExitCode;

use campaign::account::Account;
use campaign::random::Random;
use campaign::run;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize| arguments.get(i).and_then(|text| text.parse::<u64>().ok());
    if arguments.first().is_some_and(|first| first == "--seed") {
        return replay(number(1).expect("--seed N: a number"));
    }
    if arguments.first().is_some_and(|first| first == "--friction") {
        return friction(number(1).unwrap_or(1000), number(2).unwrap_or(0));
    }
    let (count, first) = (number(0).unwrap_or(1000), number(1).unwrap_or(0));
    let mut account = Account::default();
    for seed in first..first + count {
        account.add(&run(seed));
    }
    println!("{account}");
    print!("{}", account.failures(usize::MAX));
    if account.is_clean() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// One case, in full.
fn replay(seed: u64) -> ExitCode {
    let run = run(seed);
    println!("seed {seed}: {}", run.case.describe());
    println!("load {:?}, statuses {:?}, {:.3} s", run.case.load, run.statuses, run.seconds);
    for failure in &run.failures {
        println!("{}: {}", failure.promise, failure.details);
    }
    if run.failures.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Cases with friction: how the calls of each motion ended, and what was not kept.
fn friction(count: u64, first: u64) -> ExitCode {
    let (mut ends, mut failed) = (BTreeMap::new(), false);
    for seed in first..first + count {
        let (case, statuses, failures) = campaign::friction::check(&mut Random::new(seed ^ 0x00f1_c710));
        for status in statuses {
            *ends.entry((case.motion(), case.place.is_alike(), status)).or_insert(0) += 1;
        }
        for failure in failures {
            failed = true;
            println!("seed {seed}: {}: {}", failure.promise, failure.details);
        }
    }
    println!("| motion | bodies | status | calls |");
    println!("|---|---|---:|---:|");
    for ((motion, alike, status), calls) in ends {
        println!("| {motion} | {} | {status} | {calls} |", if alike { "like" } else { "unlike" });
    }
    if failed {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    }
}
