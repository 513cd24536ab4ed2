//! Local Fourier analysis compared with measurements: smoothing factors, convergence factors of two and three grids, and factors of actual cycles on
//! the paper's ellipse (the set {h <= approach}) and on a full rectangle, from a random error.
//!
//! `cargo run --release -p local_fourier_analysis [-- FOLDER]` writes the data of the picture to FOLDER (target/local_fourier_analysis).
//! `make analysis` also copies them to local_fourier_analysis/results, with three digits.

#[path = "../../examples/paper_tables/case.rs"]
#[allow(dead_code)] // the paper's runs, of which this example uses table 1
mod case;
mod picture;

use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace};
use contact_normal::methods::multigrid::CycleShape;
use contact_normal::methods::multigrid::SmootherKind::{self, Fft, GaussSeidel, Jacobi, RedBlack};
use contact_normal::solver::{Method, Outcome};
use local_fourier_analysis::{measured, Analysis};

/// Sizes of the paper's problem, m x m elements.
const SIZES: [usize; 3] = [32, 64, 128];
const CYCLES: [(usize, usize); 3] = [(1, 1), (1, 0), (0, 1)];
/// The number of measured cycles, and the number of the last ones that determine the factor.
const MEASURED: (usize, usize) = (60, 20);
/// The largest coarse grid on which a two-grid cycle is measured: its equations are solved by elimination.
const LARGEST_DIRECT: usize = 32;

/// A contact area that is analysed and measured, and its elements across.
struct Area {
    grid: Grid,
    contact: Vec<bool>,
    across: [usize; 2],
}

impl Area {
    /// The paper's ellipse: its half-axes are sqrt(approach/curvature).
    fn ellipse(m: usize) -> Area {
        let grid = case::grid(m);
        let contact = case::undeformed_distance(m).iter().map(|&h| h <= case::APPROACH).collect();
        let across = |curvature: f64, d: f64| (2.0 * (case::APPROACH / curvature).sqrt() / d) as usize;
        Area { grid, contact, across: [across(case::CURVATURE.0, grid.dx), across(case::CURVATURE.1, grid.dy)] }
    }

    /// All of a grid of square elements.
    fn rectangle(mx: usize, my: usize) -> Area {
        let grid = Grid::new(mx, my, 1.0, 1.0).expect("a valid grid");
        Area { grid, contact: vec![true; mx * my], across: [mx, my] }
    }

    fn analysis(&self, levels: usize) -> Analysis {
        Analysis::new(self.grid.dx, self.grid.dy, self.across, levels).expect("a valid analysis")
    }

    fn measure(&self, shape: CycleShape) -> f64 {
        let influence = Coefficients::from(HalfSpace::new(self.grid.dx, self.grid.dy, 1.0));
        measured::factor(&self.grid, &influence, &self.contact, shape, MEASURED)
    }
}

fn shape(smoother: SmootherKind, relaxation: f64, (pre_sweeps, post_sweeps): (usize, usize)) -> CycleShape {
    CycleShape { smoother, relaxation, pre_sweeps, post_sweeps, coarsest: 4 }
}

/// A factor as text, in powers of ten if the cycle diverges fast.
fn text(factor: f64) -> String {
    if factor < 100.0 {
        format!("{factor:.3}")
    } else {
        format!("{factor:.0e}")
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "target/local_fourier_analysis".into());
    let folder = std::path::Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    smoothers();
    picture::write_relaxation(folder, &relaxation())?;
    picture::write_sizes(folder, &sizes())?;
    rows();
    jacobi();
    picture::write_waves(folder)?;
    println!("\nfor the picture: {}", folder.display());
    Ok(())
}

fn smoothers() {
    println!("Smoothers on the paper's ellipse: smoothing factor of one sweep; then two grids: analysis, measured;");
    println!("three grids: analysis; and all grids down to 4 x 4: measured. A dash: not measured.");
    print!("{:>5} {:<18} {:>9}", "grid", "smoother, omega", "smoothing");
    println!("{}", CYCLES.map(|(pre, post)| format!(" {:>33}", format!("V({pre},{post})"))).concat());
    let kinds = [(GaussSeidel, 0.8), (GaussSeidel, 1.0), (GaussSeidel, 1.1), (RedBlack, 0.8), (RedBlack, 1.0)];
    for m in SIZES {
        let area = Area::ellipse(m);
        let (two, three) = (area.analysis(2), area.analysis(3));
        for (kind, omega) in kinds.into_iter().chain([(Jacobi, 0.5), (Jacobi, 1.0), (Fft, 0.8), (Fft, 1.0)]) {
            let smoothing = two.smoothing_factor(kind, omega, 1);
            print!("{m:>5} {:<18} {smoothing:>9.3}", format!("{kind:?} {omega}"));
            for sweeps in CYCLES {
                let shape = shape(kind, omega, sweeps);
                let direct = CycleShape { coarsest: m / 2, ..shape };
                let on_two = if m / 2 <= LARGEST_DIRECT { text(area.measure(direct)) } else { "-".into() };
                let (by_two, by_three) = (two.convergence_factor(&shape), three.convergence_factor(&shape));
                print!("   {:>6} {on_two:>6}; {:>6}; {:>6}", text(by_two), text(by_three), text(area.measure(shape)));
            }
            println!();
        }
    }
}

/// `[m, omega, two grids, three grids, measured, mean factor of table 1]`.
fn relaxation() -> Vec<[f64; 6]> {
    println!("\nGauss-Seidel, V(1,1), on the paper's ellipse: omega; two and three grids: analysis; all grids: measured, from");
    println!("a random error; and the system of table 1 to 1e-6: cycles (mean factor)");
    let mut table = Vec::new();
    for m in [64, 128, 256, 512] {
        let area = Area::ellipse(m);
        let (two, three) = (area.analysis(2), area.analysis(3));
        for omega in [0.5, 0.6, 0.7, 0.75, 0.8, 0.9, 1.0, 1.1] {
            let shape = shape(GaussSeidel, omega, (1, 1));
            let (by_two, by_three) = (two.convergence_factor(&shape), three.convergence_factor(&shape));
            let measured = if m <= 256 { area.measure(shape) } else { f64::NAN };
            let (stop, report, mean) = case::linear_system(m, Method::Multigrid, GaussSeidel, omega, 100);
            assert_eq!(stop, Outcome::Converged);
            let asymptotic = if measured.is_nan() { "-".into() } else { text(measured) };
            let cycles = report.count.cycles;
            println!("{m:>5} {omega:>5} {by_two:>7.3} {by_three:>7.3} {asymptotic:>7} {cycles:>4} ({mean:.4})");
            table.push([m as f64, omega, by_two, by_three, measured, mean]);
        }
    }
    table
}

/// `[elements across, smoothing factors .., growth of Jacobi]`.
fn sizes() -> Vec<[f64; 6]> {
    println!("\nHow it depends on the lowest frequency: square elements, n x n across. Smoothing factors; two grids, V(1,1);");
    println!("and what a sweep of Jacobi makes of the longest wave, over omega n");
    println!(
        "{:>5} {:>12} {:>12} {:>10} {:>11} {:>15} {:>8}",
        "n", "Gauss-S. 0.8", "red-bl. 0.8", "Jacobi 0.8", "Fft 0.8", "Gauss-S., grids", "growth"
    );
    let mut table = Vec::new();
    for n in [8, 16, 32, 64, 128, 256, 512] {
        let analysis = Area::rectangle(n, n).analysis(2);
        let [gauss_seidel, red_black, jacobi, fft] =
            [GaussSeidel, RedBlack, Jacobi, Fft].map(|kind| analysis.smoothing_factor(kind, 0.8, 1));
        let two = analysis.convergence_factor(&shape(GaussSeidel, 0.8, (1, 1)));
        let growth = analysis.symbol().into_iter().fold(0.0, f64::max) / n as f64;
        println!("{n:>5} {gauss_seidel:>12.3} {red_black:>12.3} {jacobi:>10.3} {fft:>11.3} {two:>15.3} {growth:>8.3}");
        table.push([n as f64, gauss_seidel, red_black, jacobi, fft, two]);
    }
    table
}

fn rows() {
    println!("\nThe direction of the rows: full grids of square elements, Gauss-Seidel, V(1,1), omega = 0.8");
    println!("{:>11} {:>10} {:>10} {:>10}", "mx x my", "smoothing", "two grids", "measured");
    for (mx, my) in [(16, 256), (32, 128), (64, 64), (128, 32), (256, 16)] {
        let (area, shape) = (Area::rectangle(mx, my), shape(GaussSeidel, 0.8, (1, 1)));
        let analysis = area.analysis(2);
        let (smoothing, two) = (analysis.smoothing_factor(GaussSeidel, 0.8, 1), analysis.convergence_factor(&shape));
        println!("{:>11} {smoothing:>10.3} {two:>10.3} {:>10.3}", format!("{mx} x {my}"), area.measure(shape));
    }
}

fn jacobi() {
    println!("\nJacobi, V(1,1), by the number of grids: analysis and measured on all of m x m square elements");
    println!("{:>5} {:>6} {:>20} {:>20} {:>20}", "m", "omega", "2 grids", "3 grids", "4 grids");
    for m in [16, 32, 64] {
        let area = Area::rectangle(m, m);
        for omega in [0.25, 0.5, 1.0] {
            print!("{m:>5} {omega:>6}");
            for levels in [2, 3, 4] {
                let shape = CycleShape { coarsest: m >> (levels - 1), ..shape(Jacobi, omega, (1, 1)) };
                let (by_analysis, measured) = (area.analysis(levels).convergence_factor(&shape), area.measure(shape));
                print!(" {:>20}", format!("{} {}", text(by_analysis), text(measured)));
            }
            println!();
        }
    }
}
