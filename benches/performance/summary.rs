//! The table of all targets at the end of a run: for each target the best and the worst measured case.

use std::sync::Mutex;

/// A target for the cost, or the speed, of some work.
struct Target {
    work: &'static str,
    /// The value at commit 9fd3772.
    before: &'static str,
    wanted: f64,
    /// Whether `wanted` is a lower limit.
    at_least: bool,
    unit: &'static str,
}

// The names of the targets, by which `note` records measurements.
pub const ELLIPSE: &str = "ellipse 256 .. 2048, one thread";
pub const ROUGH: &str = "rough surface 256 .. 2048, one thread";
pub const ELLIPSE_OLD: &str = "ellipse, in products of 9fd3772";
pub const ROUGH_OLD: &str = "rough surface, in products of 9fd3772";
pub const SPEED_UP: &str = "two threads against one, 512 and more";
pub const VERSUS: &str = "against commit 9fd3772, one thread, 512 and more";
pub const SMALL_16: &str = "ellipse 16 x 16, cold";
pub const SMALL_64: &str = "ellipse 64 x 64, cold";
pub const ONE: &str = "one element, own table";
pub const STEPS: &str = "time steps of 1 %, nine cases, one thread";
pub const STEPS_OLD: &str = "time steps, in products of 9fd3772";
pub const BATCH: &str = "batch of 64 x 64, two workers";
pub const TABLE: &str = "own table changed on a handle, with what the next solve computes of it";
pub const GROOVE: &str = "row tables: a call from the solution, groove of 100 rows";
pub const BYTES_8192: &str = "ellipse 8192 x 8192, two threads: memory";
pub const SECONDS_8192: &str = "ellipse 8192 x 8192, two threads: time";
pub const BYTES_16384: &str = "rough surface 16384 x 16384, two threads: memory";
pub const SECONDS_16384: &str = "rough surface 16384 x 16384, two threads: time";
pub const GROWTH: &str = "growth from 512 to the largest size that was run";

const fn target(work: &'static str, before: &'static str, wanted: f64, at_least: bool, unit: &'static str) -> Target {
    Target { work, before, wanted, at_least, unit }
}

const TARGETS: [Target; 19] = [
    target(ELLIPSE, "9 .. 12", 8.0, false, "products"),
    target(ELLIPSE_OLD, "9 .. 12", 8.0, false, "products"),
    target(ROUGH, "21 .. 27", 18.0, false, "products"),
    target(ROUGH_OLD, "21 .. 27", 18.0, false, "products"),
    target(SPEED_UP, "1.04 .. 1.42", 1.75, true, "times"),
    target(VERSUS, "1", 1.4, true, "times"),
    target(SMALL_16, "107", 50.0, false, "us"),
    target(SMALL_64, "820", 450.0, false, "us"),
    target(ONE, "18", 4.0, false, "us"),
    target(STEPS, "6 .. 14", 8.0, false, "products"),
    target(STEPS_OLD, "6 .. 14", 8.0, false, "products"),
    target(BATCH, "3344", 6000.0, true, "a second"),
    target(TABLE, "set-up", 2.5, false, "products"),
    target(GROOVE, "14", 5.0, false, "ms"),
    target(BYTES_8192, "7.3", 4.5, false, "GB"),
    target(SECONDS_8192, "17.4", 8.0, false, "s"),
    target(BYTES_16384, "does not fit", 20.0, false, "GB"),
    target(SECONDS_16384, "does not fit", 300.0, false, "s"),
    target(GROWTH, "1.12", 1.08, false, "exponent"),
];

/// The target of time steps also demands that a step takes at most this number of products in at least [`CASES_OF_SHORT_STEPS`] cases.
const SHORT_STEP: f64 = 5.0;
const CASES_OF_SHORT_STEPS: usize = 5;

static MEASURED: Mutex<Vec<(&str, f64)>> = Mutex::new(Vec::new());

/// Records a measurement of one of the targets, in its unit.
pub fn note(work: &'static str, value: f64) {
    assert!(TARGETS.iter().any(|target| target.work == work), "{work} is no target");
    MEASURED.lock().expect("the measurements").push((work, value));
}

/// Records a time in products of this library, and in products of 9fd3772, where the time of these products is known.
pub fn note_products(works: [&'static str; 2], time: f64, products: [Option<f64>; 2]) {
    for (work, product) in works.into_iter().zip(products) {
        if let Some(product) = product {
            note(work, time / product);
        }
    }
}

/// Prints the table.
pub fn print() {
    let measured = MEASURED.lock().expect("the measurements");
    println!("\n## All targets: what this run has measured, from the best case to the worst\n");
    println!("| work | at 9fd3772 | now | wanted | |");
    println!("|---|---|---|---|---|");
    for Target { work, before, wanted, at_least, unit } in &TARGETS {
        let mut values: Vec<f64> = measured.iter().filter(|(of, _)| of == work).map(|(_, value)| *value).collect();
        values.sort_by(f64::total_cmp);
        if *at_least {
            values.reverse();
        }
        let (Some(best), Some(worst)) = (values.first(), values.last()) else {
            println!("| {work} | {before} | not run | {wanted} {unit} | |");
            continue;
        };
        let shown = |value: f64| if value < 10.0 { format!("{value:.2}") } else { format!("{value:.0}") };
        let mut now = if values.len() == 1 { shown(*worst) } else { format!("{} .. {}", shown(*best), shown(*worst)) };
        let mut met = if *at_least { worst >= wanted } else { worst <= wanted };
        if [STEPS, STEPS_OLD].contains(work) {
            let few = values.iter().filter(|value| **value <= SHORT_STEP).count();
            now += &format!("; at most {SHORT_STEP} in {few} of {} cases", values.len());
            met &= few >= CASES_OF_SHORT_STEPS;
        }
        let sign = if *at_least { "at least" } else { "at most" };
        println!("| {work} | {before} | {now} | {sign} {wanted} {unit} | {} |", if met { "met" } else { "MISSED" });
    }
    println!("\nAgainst other solvers: `make bench-peers`. 8192 x 8192: `--large`; 16384 x 16384: `--huge`.");
}
