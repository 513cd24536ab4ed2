//! Measures whether a dense direct solve of the equations on the contact area C would be faster on grids of few elements.

use contact_normal::operator::dense;
use contact_normal::solver::{Options, Solver};
use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};

use crate::case::ellipse;
use crate::measure::{cold, in_turns, median, shown};

/// Compares one Cholesky solve of the equations on the contact area, which is known, with a whole solve by AUTO, which also finds this area.
pub fn direct() {
    println!("\n### One dense solve on the contact area against the whole of AUTO's, one thread\n");
    println!("| case | in contact | Cholesky, solve | AUTO, on a solver set up | AUTO, cold | AUTO, set up / one dense solve |");
    println!("|---|---|---|---|---|---|");
    let options = Options::default();
    for m in [4, 6, 8, 12, 16, 20, 24, 32] {
        let case = ellipse(m);
        let scene = case.scene();
        let mut solver = Solver::new(&scene, &options).expect("a solver");
        solver.solve(&scene, &options, None, None).expect("a solvable scene");
        let contact: Vec<usize> = (0..case.grid.len()).filter(|&i| solver.state().contact[i]).collect();
        let mut matrix = Vec::new();
        dense::fill_matrix(&case.grid, &contact, |x, y| solver.influence().at(x, y), &mut matrix);
        let n = contact.len();
        let right = Mat::from_fn(n, 1, |row, _| 0.1091 - case.h[contact[row]]);
        let times = in_turns(&mut [
            &mut || {
                let matrix = MatRef::from_column_major_slice(&matrix, n, n);
                let factors = matrix.llt(Side::Lower).expect("a positive definite matrix");
                std::hint::black_box(factors.solve(&right));
            },
            &mut || {
                solver.solve(&scene, &options, None, None).expect("a solvable scene");
            },
            &mut || {
                cold(&scene, &options);
            },
        ]);
        let [dense, set_up, cold] = [0, 1, 2].map(|i| median(&times[i]));
        println!(
            "| {} | {n} | {} | {} | {} | {:.1} |",
            case.name,
            shown(dense),
            shown(set_up),
            shown(cold),
            set_up / dense
        );
    }
}
