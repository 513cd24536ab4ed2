//! For creepages near zero forces are proportional to creepages and spin, with the coefficients of Kalker's linear theory.

use contact_normal::friction::{Compliance, Solver, Tangential};
use contact_normal::scene::{Friction, Motion, Prescribed};
use contact_normal::threads::Threads;

use super::steady_scenes::ellipse;
use super::support::run;

/// For each `a/b`, a in the direction of rolling: C11, C22 and C23, each for nu = 0, 1/4, 1/2 (Kalker 1990, table E.3).
#[rustfmt::skip]
#[allow(clippy::approx_constant)] // C22 of one of them is 3.14.
const TABLE: [(f64, [[f64; 3]; 3]); 5] = [
    (0.2, [[2.59, 3.37, 4.81], [2.59, 2.63, 2.66], [0.483, 0.603, 0.809]]),
    (0.5, [[2.88, 3.62, 4.83], [2.88, 3.01, 3.14], [0.827, 0.929, 1.07]]),
    (1.0, [[3.40, 4.12, 5.20], [3.40, 3.67, 3.98], [1.33, 1.47, 1.63]]),
    (2.0, [[4.37, 5.10, 6.11], [4.37, 4.90, 5.56], [2.35, 2.62, 2.96]]),
    (5.0, [[6.96, 7.78, 8.82], [6.96, 8.14, 9.79], [5.72, 6.63, 7.89]]),
];

/// The coefficients C11, C22 and C23 from computed forces: `Fx = -G a b C11 xi, Fy = -G a b C22 eta - G (a b)^(3/2) C23 phi`.
fn slopes(ratio: f64, nu: f64, m: usize) -> [f64; 3] {
    // The semi-axis in the rolling direction is a = 1.
    let b = 1.0 / ratio;
    let (grid, g) = ellipse(b, m);
    let compliance = Compliance { shear: 1.0, poisson: nu, unlike: 0.0 };
    let mut solver = Solver::new(grid, Tangential::new(grid.dx, grid.dy, compliance), true, &Threads::One);
    let size = 1e-5;
    let mut force = |creepage: [f64; 2], spin: f64| {
        let friction = Friction {
            motion: Motion::SteadyRolling,
            prescribed: creepage.map(Prescribed::Creepage),
            spin,
            ..Friction::new(1.0)
        };
        run(&mut solver, &g, &friction, 1e-5).0.force
    };
    let (in_x, in_y, of_spin) = (force([size, 0.0], 0.0), force([0.0, size], 0.0), force([0.0; 2], size));
    [-in_x[0] / (b * size), -in_y[1] / (b * size), -of_spin[1] / (b.powf(1.5) * size)]
}

#[test]
fn creepages_near_zero_have_kalkers_coefficients() {
    for (ratio, known) in TABLE {
        for (k, nu) in [0.0, 0.25, 0.5].into_iter().enumerate() {
            // The error is of first order in the element. In the most slender ellipse tractions rise within few elements, so that it has more
            // elements.
            let found = slopes(ratio, nu, if ratio < 5.0 { 128 } else { 256 });
            for (found, known) in found.into_iter().zip(known.map(|known| known[k])) {
                // 1 % for the error of the discretisation, and half a unit of the third digit, to which the table is printed.
                let last = 10f64.powf(known.log10().floor() - 2.0);
                assert!((found - known).abs() <= 0.01 * known + 0.5 * last, "{ratio} {nu}: {found} {known}");
            }
        }
    }
}
