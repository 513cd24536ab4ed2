//! Measures what pressure limits cost: the work of AUTO relative to that for the scene without a limit.
//!
//! `cargo run --release --example pressure_limits` prints one row per scene: an ellipse and a rough surface on 64 x 64 to 512 x 512 elements, with a
//! given approach or force, and with limits that are parts of the largest pressure. Then it prints the mean and the largest of the factors, and
//! how many of them are above 3.

use contact_normal::scene::{Each, Load, PressureLimit, Scene};
use contact_normal::solver::{solve, Options, Outcome};

#[path = "../../benches/performance/case.rs"]
#[allow(dead_code)]
mod case;

/// The limits, as parts of the largest pressure without a limit.
const SHARES: [f64; 9] = [0.95, 0.9, 0.8, 0.75, 0.6, 0.5, 0.4, 0.3, 0.2];

fn main() {
    print!("{:14} {:8} {:>6}", "scene", "load", "plain");
    SHARES.iter().for_each(|share| print!(" {share:>6}"));
    println!("    (work units; then factors)");
    let mut factors = Vec::new();
    for m in [64, 128, 256, 512] {
        for case in [case::ellipse(m), case::rough(m)] {
            let exact = Options { tolerance: 1e-9, ..Options::default() };
            let (_, _, found) = solve(&case.scene(), &exact).expect("the plain scene is solved");
            for load in [Load::Approach(found.measures.approach), Load::Force(found.measures.force)] {
                row(&case, load, found.measures.max_pressure, &mut factors);
            }
        }
    }
    let mean = (factors.iter().map(|factor: &f64| factor.ln()).sum::<f64>() / factors.len() as f64).exp();
    let largest = factors.iter().copied().fold(0.0, f64::max);
    let above = factors.iter().filter(|factor| **factor > 3.0).count();
    println!("{} scenes: geometric mean {mean:.2}, largest {largest:.2}, {above} above 3", factors.len());
}

/// Prints the row of a scene. A limit with which the force cannot be carried is left out.
fn row(case: &case::Case, load: Load, largest: f64, factors: &mut Vec<f64>) {
    let plain = case.scene_with(load);
    let work = |scene: &Scene<'_>| match solve(scene, &Options::default()) {
        Ok((_, Outcome::Converged, report)) => Some(report.count.work_units),
        Ok((_, stop, _)) => panic!("{}: {stop:?}", case.name),
        Err(_) => None,
    };
    let alone = work(&plain).expect("the plain scene is solved");
    let by = if matches!(load, Load::Force(_)) { "force" } else { "approach" };
    print!("{:14} {by:8} {alone:>6.2}", case.name);
    for share in SHARES {
        let limit = PressureLimit(Each::Uniform(share * largest));
        match work(&Scene { pressure_limit: Some(limit), ..plain.clone() }) {
            Some(work) => {
                factors.push(work / alone);
                print!(" {:>6.2}", work / alone);
            }
            None => print!(" {:>6}", "-"),
        }
    }
    println!();
}
