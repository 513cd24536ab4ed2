//! Shows why red-black order is worse than lexicographic order: neither the coarse grid nor a red-black sweep reduces the error of a checkerboard.

use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace};
use contact_normal::methods::multigrid::smoother::{Smoother, SmootherKind};
use contact_normal::operator::Operator;
use contact_normal::solver::{Method, Outcome};
use contact_normal::threads::Threads;

use super::case::linear_system;

const ORDERS: [SmootherKind; 2] = [SmootherKind::GaussSeidel, SmootherKind::RedBlack];
const OMEGAS: [f64; 5] = [1.0, 0.8, 0.6, 0.5, 0.4];

/// Prints the part of a checkerboard error that one sweep leaves, and the V(1,1) cycles and reduction factors for the linear system of table 1.
pub fn study() {
    println!("\nPart of a checkerboard error (-1)^(ix + iy) that one sweep with omega = 1 leaves, full contact");
    println!("{:>6} {:>16} {:>16}", "grid", "lexicographic", "red-black");
    for m in [16, 32, 64] {
        let [lexicographic, red_black] = ORDERS.map(|kind| checkerboard_left(kind, m));
        println!("{m:>6} {lexicographic:>16.3} {red_black:>16.3}");
    }
    println!("\nTable 1's system, V(1,1): cycles (mean factor); a dash: not within 200 cycles");
    println!("{:>6} {:>8} {:>16} {:>16}", "grid", "omega", "lexicographic", "red-black");
    for m in [32, 64, 128] {
        for omega in OMEGAS {
            let [lexicographic, red_black] = ORDERS.map(|kind| {
                let (stop, report, factor) = linear_system(m, Method::Multigrid, kind, omega, 200);
                let cycles = if stop == Outcome::Converged { report.count.cycles.to_string() } else { "-".into() };
                format!("{cycles} ({factor:.3})")
            });
            println!("{m:>6} {omega:>8} {lexicographic:>16} {red_black:>16}");
        }
    }
}

fn checkerboard_left(kind: SmootherKind, m: usize) -> f64 {
    let grid = Grid::new(m, m, 1.0, 1.0).expect("a valid grid");
    let influence = Coefficients::from(HalfSpace::new(1.0, 1.0, 1.0));
    let operator = Operator::<f64>::new(&influence, &grid, &Threads::One).expect("an operator");
    let mut workspace = operator.workspace().expect("a workspace");
    let mut smoother = Smoother::new(kind, &influence, &grid, &Threads::One).expect("a smoother");
    let checkerboard = |i: usize| if (i / m + i % m) % 2 == 0 { 1.0 } else { -1.0 };
    let mut error: Vec<f64> = (0..m * m).map(checkerboard).collect();
    let mut residual = vec![0.0; m * m];
    operator.apply(&error, &mut residual, &mut workspace);
    residual.iter_mut().for_each(|r| *r = -*r);
    let displace = |p: &[f64], u: &mut [f64]| operator.apply(p, u, &mut workspace);
    smoother.sweep(&mut error, &mut residual, &vec![true; m * m], 1.0, displace);
    error.iter().enumerate().map(|(i, e)| e * checkerboard(i)).sum::<f64>() / (m * m) as f64
}
