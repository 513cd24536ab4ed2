//! Reproduces tables 1, 2 and 3 and figure 4 of the paper: prints the numbers of the paper beside those of this library, and continues the tables to
//! finer grids.
//!
//! `cargo run --release --example paper_tables [-- FIGURE.png]`

mod case;
mod figure;

use std::path::PathBuf;

use case::{linear_system, whole_problem, APPROACH};
use contact_normal::methods::multigrid::transfer;
use contact_normal::methods::multigrid::SmootherKind::{GaussSeidel, Jacobi, RedBlack};
use contact_normal::solver::{solve, Method, Options, Outcome, Report};

/// The cycles V(n1, n2) of the columns of tables 2 and 3.
const CYCLES: [(usize, usize); 3] = [(1, 1), (1, 0), (0, 1)];
const FINER: [usize; 2] = [512, 1024];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    table_1();
    table_2_and_3();
    let path = std::env::args().nth(1).map_or_else(|| PathBuf::from("target/figure_4.png"), PathBuf::from);
    figure_4(&path)
}

/// The number of cycles as text, or a dash if the method did not converge.
fn count(stop: Outcome, report: &Report) -> String {
    if stop == Outcome::Converged {
        report.count.cycles.to_string()
    } else {
        "-".into()
    }
}

fn table_1() {
    println!("Table 1: the linear system on C1 = {{h <= 0}}, V(1,1), iterations (factor); paper / ours");
    println!("{:>6} {:>32} {:>32} {:>32} {:>12}", "grid", "omega = 1.1", "omega = 0.8", "omega = 1.0", "CG");
    let paper = [
        (64, ["10 (0.2428)", "9 (0.1927)", "9 (0.2077)"], "29"),
        (128, ["11 (0.2783)", "9 (0.1974)", "10 (0.2402)"], "61"),
    ];
    let finer = FINER.map(|m| (m, ["-"; 3], "-"));
    for (m, printed, printed_cg) in paper.into_iter().chain([(256, ["-"; 3], "-")]).chain(finer) {
        print!("{m:>6}");
        for (omega, printed) in [1.1, 0.8, 1.0].into_iter().zip(printed) {
            let (stop, report, factor) = linear_system(m, Method::Multigrid, GaussSeidel, omega, 100);
            print!(" {:>32}", format!("{printed} / {} ({factor:.4})", count(stop, &report)));
        }
        let (stop, report, _) = linear_system(m, Method::Norm, GaussSeidel, 1.0, 10_000);
        println!(" {:>12}", format!("{printed_cg} / {}", count(stop, &report)));
    }
    println!(
        "(The paper's CG column is not met by textbook CG with the same stop; what it did differently is not said.)"
    );

    println!("\nNot shown in the paper, but said: other smoothers on the same system, V(1,1), iterations (factor)");
    println!(
        "{:>6} {:>16} {:>16} {:>16} {:>20}",
        "grid", "Gauss-Seidel 1", "red-black 1", "Jacobi 1", "damped Jacobi 0.5"
    );
    for m in [32, 64, 128, 256] {
        print!("{m:>6}");
        for (kind, omega, width) in [(GaussSeidel, 1.0, 16), (RedBlack, 1.0, 16), (Jacobi, 1.0, 16), (Jacobi, 0.5, 20)]
        {
            let (stop, report, factor) = linear_system(m, Method::Multigrid, kind, omega, 100);
            // If 100 cycles are not enough, `count` writes a dash. The factor is printed all the same if the residual decreases.
            let factor = if stop == Outcome::Stagnated { "diverges".into() } else { format!("({factor:.4})") };
            print!(" {:>width$}", format!("{} {factor}", count(stop, &report)));
        }
        println!();
    }
}

fn table_2_and_3() {
    let table_2 = [(32, [9, 16, 16], 77), (64, [10, 17, 16], 131), (128, [10, 17, 16], 198), (256, [12, 20, 28], 280)];
    let table_3 = [(32, [7, 13, 13]), (64, [6, 11, 12]), (128, [5, 9, 9]), (256, [6, 10, 8])];
    let or_dash = |printed: Option<i32>| printed.map_or("-".into(), |n| n.to_string());
    let sizes = [32, 64, 128, 256].into_iter().chain(FINER);

    println!("\nTable 2: one V-cycle per active-set step (section 4.1), cycles; paper / ours, and seconds of ours");
    println!("{:>6} {:>20} {:>20} {:>20} {:>30}", "grid", "V(1,1)", "V(1,0)", "V(0,1)", "NORM + CG (steps)");
    let mut per_cycle = Vec::new();
    for m in sizes.clone() {
        let printed = table_2.iter().find(|row| row.0 == m);
        print!("{m:>6}");
        for (k, (pre, post)) in CYCLES.into_iter().enumerate() {
            let (stop, report) = whole_problem(m, Method::Multigrid, pre, post);
            if k == 0 {
                per_cycle.push((m, report.solve_seconds / report.count.cycles as f64));
            }
            let printed = or_dash(printed.map(|row| row.1[k]));
            print!(" {:>20}", format!("{printed} / {}  {:.3} s", count(stop, &report), report.solve_seconds));
        }
        let (stop, report) = whole_problem(m, Method::Norm, 1, 1);
        let printed = or_dash(printed.map(|row| row.2));
        let ours =
            format!("{} ({})  {:.3} s", count(stop, &report), report.count.active_set_steps, report.solve_seconds);
        println!(" {:>30}", format!("{printed} / {ours}"));
    }

    println!("\nTable 3: full multigrid (section 4.3), cycles on the finest grid; paper / ours, and seconds of ours");
    println!("{:>6} {:>20} {:>20} {:>20}", "grid", "V(1,1)", "V(1,0)", "V(0,1)");
    for m in sizes {
        let printed = table_3.iter().find(|row| row.0 == m);
        print!("{m:>6}");
        for (k, (pre, post)) in CYCLES.into_iter().enumerate() {
            let (stop, report) = whole_problem(m, Method::FullMultigrid, pre, post);
            let printed = or_dash(printed.map(|row| row.1[k]));
            print!(" {:>20}", format!("{printed} / {}  {:.3} s", count(stop, &report), report.solve_seconds));
        }
        println!();
    }

    println!("\nGrowth of the time of a V(1,1) cycle with the number of elements n");
    for (m, seconds) in &per_cycle {
        println!("{m:>6} {:>10.5} s", seconds);
    }
    let at = |m: usize| per_cycle.iter().find(|row| row.0 == m).map_or(f64::NAN, |row| row.1);
    println!("from 128 to 1024: n^{:.2}", (at(1024) / at(128)).log2() / 6.0);
}

fn figure_4(path: &std::path::Path) -> Result<(), Box<dyn std::error::Error>> {
    let m = 32;
    let h = case::undeformed_distance(m);
    // (a) The contact area of the first step, {h <= approach}.
    let by_distance: Vec<bool> = h.iter().map(|&h| h <= APPROACH).collect();
    // (b) The contact area with which full multigrid starts on this grid: where the pressures interpolated from the next coarser grid are positive, or
    // e <= 0.
    let options = Options { method: Method::FullMultigrid, ..Options::default() };
    let coarse_h = case::undeformed_distance(m / 2);
    let (coarse, _, _) = solve(&case::scene(m / 2, &coarse_h), &options)?;
    let (fine_grid, coarse_grid) = (case::grid(m), case::grid(m / 2));
    let (mut p, mut u) = (vec![0.0; m * m], vec![0.0; m * m]);
    transfer::interpolate(&fine_grid, &coarse_grid, &coarse.state().p, &mut p, |to, value| *to = value);
    transfer::interpolate(&fine_grid, &coarse_grid, &coarse.state().u, &mut u, |to, value| *to = value);
    let by_full_multigrid: Vec<bool> = (0..m * m).map(|i| p[i] > 0.0 || h[i] - APPROACH + u[i] <= 0.0).collect();
    // (c) The contact area of the solution.
    let (fine, _, _) = solve(&case::scene(m, &h), &options)?;
    let exact = fine.state().contact.clone();

    let elements = |contact: &[bool]| contact.iter().filter(|&&inside| inside).count();
    let off = |contact: &[bool]| contact.iter().zip(&exact).filter(|(a, b)| a != b).count();
    println!("\nFigure 4: contact areas on the 32 x 32 grid, in elements");
    println!("(a) h <= 0             {:>4}, of which {} are wrong", elements(&by_distance), off(&by_distance));
    println!(
        "(b) start of FMG       {:>4}, of which {} are wrong",
        elements(&by_full_multigrid),
        off(&by_full_multigrid)
    );
    println!("(c) the contact area   {:>4}", elements(&exact));
    figure::draw(path, m, &[by_distance, by_full_multigrid, exact])?;
    println!("drawn to {}", path.display());
    Ok(())
}
