//! Measures what a solve costs, and compares it with targets: `cargo bench` or `make bench`.
//!
//! Every time is a median of repeats. The calls that are compared are repeated in turns. Times of whole calls include the set-up.
//!
//! Options of `cargo bench -- OPTIONS`:
//!
//! - `--quick`: grids of up to 512 x 512 elements.
//! - `--large`: also 4096 x 4096 elements (2 GB), and memory on 8192 x 8192 (5 GB); `--huge`: also memory on 16384 x 16384 (20 GB).
//! - `--threads N`: the tables of the targets with one and N threads; default 2, and 1: one thread only.
//! - `--processor`: times with one thread are processor times, for machines that other programs use too.
//! - Names of tables, of which only these are then run: cold steps limits versus speedup one influence force accuracy growth norm memory batch
//!   dense methods friction.
//!
//! The last table has all targets, with the results of this run.

mod case;
mod dense;
mod friction;
mod influence;
mod limits;
mod measure;
mod methods;
mod old;
mod summary;
mod targets;
mod versus;

/// The limit of memory in bytes per element: 4.5 GB on 8192 x 8192 elements.
const LARGEST_ELLIPSE: f64 = 4.5e9 / (8192.0 * 8192.0);
/// The limit of memory in bytes per element: 20 GB on 16384 x 16384 elements.
const LARGEST_ROUGH: f64 = 20e9 / (16384.0 * 16384.0);

fn main() {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.is_empty() {
        // `cargo test --all-targets` runs benches too, without --bench. One small case shows that this bench works.
        return targets::cold_row(&case::ellipse(16), 1, |product| 25.0 * product + 50e-6, 25.0);
    }
    arguments.retain(|argument| argument != "--bench");
    if let [first, library, name, m, load, threads] = &arguments[..] {
        if first == versus::CALL {
            let number = |text: &String| text.parse().expect("a number");
            return versus::call(library, name, number(m), load, number(threads));
        }
    }
    if let [first, name, m, rest @ ..] = &arguments[..] {
        let size = || m.parse().expect("a size");
        match (first.as_str(), rest) {
            (targets::SOLVE_ONCE, []) => return targets::solve_once(name, size()),
            (targets::SOLVE_AGAIN, [what, seconds, threads @ ..]) => {
                let seconds = seconds.parse().expect("seconds");
                let threads = threads.first().map_or(1, |count| count.parse().expect("threads"));
                if what != "shift" {
                    return targets::solve_again(name, size(), what == "steps", seconds, threads);
                }
                let case = if name == "rough" { friction::like_bodies(size()) } else { case::ellipse(size()) };
                return friction::shift_again(&case, threads, seconds);
            }
            _ => {}
        }
    }
    let (mut quick, mut large, mut huge, mut processor, mut threads) = (false, false, false, false, 2);
    let mut tables = Vec::new();
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--quick" => quick = true,
            "--large" => large = true,
            "--huge" => huge = true,
            "--processor" => processor = true,
            "--threads" => threads = rest.next().and_then(|n| n.parse().ok()).expect("--threads N"),
            table => tables.push(table),
        }
    }
    let wanted = |table: &str| tables.is_empty() || tables.contains(&table);
    let sizes: &[usize] = if quick { &[256, 512] } else { &[256, 512, 1024, 2048] };
    let mut thread_counts = vec![1, threads];
    thread_counts.dedup();

    println!("## Targets: tolerance 1e-6; a product is one u = A p on the full grid in double precision");
    if processor {
        println!("\nTimes with one thread are those of the processor.");
    }
    for threads in thread_counts {
        measure::by_processor(processor && threads == 1);
        if wanted("cold") {
            targets::cold_calls(threads, sizes);
        }
        if wanted("steps") {
            targets::time_steps(threads);
        }
        if wanted("limits") {
            limits::limits(threads, sizes);
        }
        if wanted("versus") {
            versus::versus(threads, sizes);
        }
    }
    if wanted("friction") {
        measure::by_processor(false);
        friction::shifts(threads, &sizes[..sizes.len().min(3)]);
        friction::given_pressures();
    }
    if wanted("speedup") && threads > 1 {
        measure::by_processor(false);
        targets::speed_up(threads, sizes);
        targets::speed_up_of_products(threads, sizes);
    }
    measure::by_processor(processor);
    if wanted("one") {
        targets::one_element();
    }
    if wanted("influence") {
        influence::another_table(sizes);
        influence::row_tables();
    }
    if wanted("force") {
        targets::force_against_approach(1);
    }
    if wanted("accuracy") {
        targets::accuracy(1);
    }
    if wanted("growth") {
        let largest = [512, 1024, 2048, 4096];
        targets::growth(1, if large { &largest } else { &largest[..if quick { 2 } else { 3 }] });
    }
    if wanted("norm") {
        targets::norm_against_auto(1);
    }
    if wanted("memory") {
        targets::memory(&[("ellipse", 1024, 120.0), ("rough", 1024, 120.0)]);
        if large {
            targets::memory(&[("ellipse", 4096, 75.0), ("rough", 4096, 75.0), ("ellipse", 8192, LARGEST_ELLIPSE)]);
        }
        if huge {
            targets::memory(&[("rough", 16384, LARGEST_ROUGH)]);
        }
    }
    measure::by_processor(false);
    if wanted("batch") && threads > 1 {
        targets::batch();
    }
    if wanted("dense") {
        dense::direct();
    }
    if wanted("methods") {
        methods::methods(if quick { &[128] } else { &[128, 256, 512] });
    }
    summary::print();
}
