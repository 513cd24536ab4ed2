//! Measures what accuracy costs, and compares what the library says of it with exact solutions: the tables of docs/accuracy.md and
//! docs/notes/2026-11-accuracy.md.
//!
//! `accuracy [estimates] [searches] [prices] [study] [--quick]` prints the named tables, or all. The study is written to build/accuracy.csv,
//! from which benches/accuracy.py makes its tables. Seeds are fixed, and no run is left out.

use std::collections::BTreeMap;

use contact_normal::solver::Outcome;

#[path = "../../benches/performance/case.rs"]
#[allow(dead_code)]
mod case;
mod judge;
#[path = "../../campaign/src/random.rs"]
#[allow(dead_code)]
mod random;
mod study;
mod surfaces;

const SIZES: [usize; 9] = [16, 24, 32, 48, 64, 100, 128, 200, 256];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let quick = arguments.iter().any(|argument| argument == "--quick");
    let named = arguments.iter().any(|argument| argument != "--quick");
    let wanted = |name: &str| !named || arguments.iter().any(|argument| argument == name);
    let seeds = if quick { 1 } else { 6 };
    let sets: [(&str, judge::Surfaces); 2] = [("measured by", surfaces::studied), ("held back", surfaces::held_back)];
    for (set, surfaces) in sets {
        if wanted("estimates") {
            estimates(set, surfaces, seeds);
        }
        if wanted("searches") {
            searches(set, surfaces, seeds);
        }
        if wanted("prices") {
            prices(set, surfaces, seeds.min(2));
        }
    }
    if wanted("study") {
        std::fs::create_dir_all("build").expect("a folder");
        std::fs::write("build/accuracy.csv", study::study(quick)).expect("a writable build/accuracy.csv");
    }
}

fn estimates(set: &str, surfaces: judge::Surfaces, seeds: u64) {
    println!(
        "\nEstimated over true error, surfaces {set}, elements {SIZES:?}, {seeds} seeds, by approach and by force\n"
    );
    println!("| of | surface | runs | unknown | infinite, trusted | below 0.3 | least | median | 95 % |\n|---|---|---|---|---|---|---|---|---|");
    for ((quantity, family), found) in judge::estimates(surfaces, 0..seeds, &SIZES) {
        let number =
            |part: f64| if found.ratios.is_empty() { "".into() } else { format!("{:.2}", found.quantile(part)) };
        println!(
            "| {} | {family} | {} | {:.0} % | {} | {:.0} % | {} | {} | {} |",
            judge::QUANTITIES[quantity],
            found.runs,
            100.0 * found.unknown(),
            found.trusted_infinite,
            100.0 * found.low(),
            number(0.0),
            number(0.5),
            number(0.95)
        );
    }
}

fn searches(set: &str, surfaces: judge::Surfaces, seeds: u64) {
    let all = judge::searches(surfaces, 0..seeds);
    let ok: Vec<_> = all.iter().filter(|search| search.stop == Outcome::Converged).collect();
    let (beyond, worst) = (ok.iter().filter(|s| s.miss > 1.0).count(), ok.iter().map(|s| s.miss).fold(0.0, f64::max));
    let mut ratios: Vec<f64> = ok.iter().filter_map(|s| Some(s.elements as f64 / s.cheapest? as f64)).collect();
    ratios.sort_by(f64::total_cmp);
    println!("\nsolve_to_accuracy, surfaces {set}: {} searches, {} OK; {beyond} beyond the target, the worst {worst:.2} times", all.len(), ok.len());
    let at = |part: f64| ratios[(part * (ratios.len() - 1) as f64) as usize];
    println!(
        "elements over those of the cheapest safe grid ({} known): median {}, 90 % {}, most {}",
        ratios.len(),
        at(0.5),
        at(0.9),
        at(1.0)
    );
    let across = |search: &&judge::Search| {
        search.across.0.min(if search.family.contains("wave") { usize::MAX } else { search.across.1 })
    };
    println!("elements across the contact: at least {}", ok.iter().map(across).min().unwrap_or(0));
    for search in ok.iter().filter(|search| search.miss > 1.0) {
        let judge::Search { family, by_force, target, miss, .. } = search;
        println!("beyond: {family}, by force: {by_force}, {target:e}: {miss:.2}");
    }
    let mut stops: BTreeMap<(&str, String), usize> = BTreeMap::new();
    for search in all.iter().filter(|search| search.stop != Outcome::Converged) {
        let why = search.reason.split(" is in the way").next().unwrap_or_default();
        *stops.entry((search.family, format!("{:?}: {why}", search.stop))).or_default() += 1;
    }
    for ((family, stop), count) in stops {
        println!("not reached: {count} of {family}, {stop}");
    }
}

fn prices(set: &str, surfaces: judge::Surfaces, seeds: u64) {
    let all = judge::prices(surfaces, 0..seeds, 1024);
    let mut ratios: Vec<f64> = all
        .iter()
        .filter(|paid| paid.seconds > 0.0)
        .filter_map(|paid| Some(paid.price.seconds_one_thread? / paid.seconds))
        .collect();
    ratios.sort_by(f64::total_cmp);
    let known = all
        .iter()
        .filter_map(|paid| paid.price.grid.and(paid.doublings.1).map(|cheapest| paid.doublings.0 - cheapest as i32));
    let doublings: Vec<i32> = known.collect();
    let near = doublings.iter().filter(|k| k.abs() <= 1).count();
    let within = ratios.iter().filter(|ratio| (1.0 / 1.5..=1.5).contains(*ratio)).count();
    let at = |part: f64| ratios[(part * (ratios.len() - 1) as f64) as usize];
    let beyond = all.iter().filter(|paid| paid.seconds > 0.0 && paid.error > paid.price.target).count();
    println!("\nThe price list, surfaces {set}: {} rows, {} solved; grid within one doubling of the cheapest safe one: {near} of {}; beyond the target: {beyond}", all.len(), ratios.len(), doublings.len());
    println!(
        "predicted over paid seconds: 5 % {:.2}, median {:.2}, 95 % {:.2}; within a factor 1.5: {within} of {}",
        at(0.05),
        at(0.5),
        at(0.95),
        ratios.len()
    );
    let mut lists: Vec<f64> = all.iter().map(|paid| paid.list).collect();
    lists.sort_by(f64::total_cmp);
    println!("seconds of a price list: median {:.3}, most {:.3}", lists[lists.len() / 2], lists[lists.len() - 1]);
    println!("\n| surface | load | target | grid | tolerance | predicted | paid | predicted error | true error | |\n|---|---|---|---|---|---|---|---|---|---|");
    let known = |value: Option<f64>| value.unwrap_or(-1.0);
    for paid in &all {
        let grid = paid.price.grid.map_or("".into(), |grid| format!("{} x {}", grid.mx, grid.my));
        let load = if paid.by_force { "force" } else { "approach" };
        let (price, obstacle) =
            (&paid.price, paid.price.obstacle.map_or(String::new(), |obstacle| format!("{obstacle:?}")));
        println!(
            "| {} | {load} | {:.0e} | {grid} | {:.0e} | {:.2e} | {:.2e} | {:.1e} | {:.1e} | {obstacle} |",
            paid.family,
            price.target,
            price.tolerance,
            known(price.seconds_one_thread),
            paid.seconds,
            known(price.error),
            paid.error
        );
    }
}
