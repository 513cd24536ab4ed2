//! Steady rolling of bodies with thin coatings that are much stiffer than the substrate, like membranes. Their influence reaches beyond half a period
//! of the circulant, so that the inverse of a circulant of coefficients is a poor preconditioner: it takes up to three times the products. The
//! library uses a circulant of responses to waves, which is as good as for other bodies.

use contact_normal::friction::{Solver, Vector};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Coating, CoatingLayer, Friction, Load, Motion, Prescribed, Scene};
use contact_normal::solver::{solve, Options, Outcome};
use contact_normal::threads::Threads;

use super::coated::coated;
use super::dense;
use super::steady_scenes::ellipse;
use super::support::{residual_by, run};

fn steady(creepage: Vector, spin: f64, coefficient: f64) -> Friction<'static> {
    Friction {
        motion: Motion::SteadyRolling,
        prescribed: creepage.map(Prescribed::Creepage),
        spin,
        ..Friction::new(coefficient)
    }
}

/// The conditions hold by direct sums for layers that are thinner than an element and 1e2 to 1e4 times as stiff as the substrate, from nearly full
/// stick to nearly full slip.
#[test]
fn membranes_meet_the_conditions() {
    let ((grid, g), mut sides, mut most) = (ellipse(0.8, 26), [0usize; 2], 0.0f64);
    let none = vec![[0.0; 2]; grid.len()];
    for (thickness, mu, nu) in [(0.05, 1e2, [0.3, 0.4]), (0.2, 1e3, [0.45, 0.2]), (0.6, 1e4, [0.0, 0.5])] {
        let coated = coated(&grid, thickness * grid.dx, mu, nu);
        for (part, spin) in [(1e-4, 0.0), (1e-3, 3e-4), (1e-2, 0.0), (0.1, 0.1)] {
            // Creepages are proportional to the compliance of the substrate, which is `mu` times that of the layer.
            let friction = steady([-part * mu, 0.4 * part * mu], spin * mu, 0.4);
            let mut solver = Solver::new(grid, coated.clone(), true, &Threads::One);
            let (report, solution) = run(&mut solver, &g, &friction, 1e-7);
            let sums = |by: (f64, f64), q: &[Vector], u: &mut [Vector]| dense::apply(&coated, &grid, by, q, u);
            let slip_residual = residual_by(sums, &grid, &g, &friction, &none, (&report, &solution));
            let certificate = report.certificate;
            println!("{thickness} {mu} {part}: {slip_residual:e} {certificate:?} products {}", report.products);
            assert!(slip_residual <= 1.01e-7, "{thickness} {mu} {friction:?}: {slip_residual:e}");
            sides = [sides[0].max(certificate.stick_count), sides[1].max(certificate.slip_count)];
            most = most.max(report.products);
        }
    }
    // The contact has 440 elements, of which in all cases together many stick and many slip.
    assert!(sides.iter().all(|count| *count > 300), "{sides:?}");
    println!("most products {most}");
    assert!(most <= 60.0, "{most} products");
}

/// For such coatings the preconditioner is far from an inverse. The certificate is that of the tractions after the projection onto the circles |q| <=
/// mu p. A further step by a part of the preconditioned residual would make the residual four times as large.
#[test]
fn tolerances_below_single_precision_are_reached() {
    let (m, layer) = (33, CoatingLayer { thickness: 0.2, shear_modulus: 1e3, poisson_ratio: 0.3 });
    let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
    let at = |k: usize| (k as f64 - 16.0).powi(2);
    let h: Vec<f64> = (0..m * m).map(|i| 0.01 * (at(i % m) + at(i / m))).collect();
    for (tolerance, most) in [(1e-6, 60.0), (1e-7, 70.0), (1e-8, 85.0), (1e-10, 115.0)] {
        let scene = Scene {
            coating: Some(Coating { layers: [Some(layer); 2] }),
            friction: Some(steady([-1e-3, 0.5e-3], 0.0, 0.6)),
            ..Scene::new(grid, &h, Bodies::same(1.0, 0.4), Load::Force(300.0))
        };
        let (_, end, report) = solve(&scene, &Options { tolerance, ..Options::default() }).unwrap();
        let found = report.friction.unwrap();
        println!("{tolerance} {end:?} {:?} products {}", found.certificate, found.products);
        assert_eq!(end, Outcome::Converged);
        assert!(found.certificate.residual < tolerance);
        assert!(found.products <= most, "{tolerance} {} products", found.products);
    }
}
