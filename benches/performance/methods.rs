//! Compares all methods on several grids, with one and two threads.

use contact_normal::solver::{Method, Options, Outcome};

use crate::case::{ellipse, rough, wheel_rail};
use crate::measure::{cold, in_turns, median, shown};

const METHODS: [(&str, Method); 5] = [
    ("AUTO", Method::Auto),
    ("PROJECTED_CG", Method::ProjectedCg),
    ("FULL_MULTIGRID", Method::FullMultigrid),
    ("MULTIGRID", Method::Multigrid),
    ("NORM", Method::Norm),
];

/// Prints the work of each method, in products on the finest grid, and its time with one and two threads.
pub fn methods(sizes: &[usize]) {
    println!("\n### Methods, cold, tolerance 1e-6: work in products / time with one thread / with two\n");
    println!("| case | {} |", METHODS.map(|(name, _)| name).join(" | "));
    println!("|---{}|", "|---".repeat(METHODS.len()));
    let cases = sizes.iter().flat_map(|&m| [ellipse(m), rough(m)]);
    for case in cases.chain([wheel_rail("y4_82kN", 1)]) {
        print!("| {} |", case.name);
        let scene = case.scene();
        for (_, method) in METHODS {
            let one = Options { method, max_cycles: 3000, ..Options::default() };
            let two = Options { threads: 2, ..one };
            let (stop, report) = cold(&scene, &one);
            if stop != Outcome::Converged {
                print!(" {stop:?} |");
                continue;
            }
            let times = in_turns(&mut [&mut || _ = cold(&scene, &one), &mut || _ = cold(&scene, &two)]);
            print!(" {:.0} / {} / {} |", report.count.work_units, shown(median(&times[0])), shown(median(&times[1])));
        }
        println!();
    }
}
