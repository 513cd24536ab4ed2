//! Results have the same bits with any number of threads, for each motion, with like and unlike bodies, creepages and forces, and derivatives.

use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Scene};
use contact_normal::solver::{solve, Options, Outcome};

use super::support::ball;

/// With M x M elements each pass over the grid is shared between threads.
const M: usize = 160;

fn check(name: &str, nu: [f64; 2], friction: Friction<'_>) {
    let (grid, h) = ball(M, 0.012);
    let bodies = Bodies { shear_modulus: [82000.0; 2], poisson_ratio: nu };
    let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(1000.0)) };
    let found = |threads: usize| {
        let (solver, stop, report) = solve(&scene, &Options { threads, ..Options::default() }).unwrap();
        assert_eq!(stop, Outcome::Converged, "{name}");
        let (found, solution) = (report.friction.unwrap(), solver.friction().unwrap());
        assert!(found.certificate.stick_count > 0 && found.certificate.slip_count > 0, "{name}: {found:?}");
        let numbers = solution.traction.iter().chain(&solution.slip).flatten();
        let of_report = found.creepage.into_iter().chain(found.force).chain([found.moment, found.certificate.residual]);
        let derivatives = found.sensitivities.into_iter().flatten().flatten();
        let bits = |value: f64| value.to_bits();
        (numbers.copied().map(bits).collect::<Vec<_>>(), of_report.chain(derivatives).map(bits).collect::<Vec<_>>())
    };
    let one = found(1);
    for threads in [2, 3] {
        assert!(one == found(threads), "{name}: {threads} threads");
    }
}

#[test]
fn any_number_of_threads_finds_the_same_bits_of_each_motion() {
    let creepages = |x: f64, y: f64| [Prescribed::Creepage(x), Prescribed::Creepage(y)];
    let forces = [Prescribed::Force(150.0), Prescribed::Force(30.0)];
    let shift = Friction { prescribed: creepages(-2e-3, 5e-4), ..Friction::new(0.3) };
    let rolling = Friction { motion: Motion::SteadyRolling, prescribed: creepages(-1e-3, 5e-4), ..shift };
    check("a shift with spin", [0.28; 2], Friction { spin: 1e-3, ..shift });
    check("a shift with spin, by forces", [0.28; 2], Friction { spin: 1e-3, prescribed: forces, ..shift });
    let along_x = [Prescribed::Creepage(-2e-3), Prescribed::Creepage(0.0)];
    check("a shift without coupling, from a smaller load", [0.0; 2], Friction { prescribed: along_x, ..shift });
    check("a shift without coupling", [0.0; 2], Friction { spin: 1e-3, ..shift });
    check("unlike bodies", [0.28, 0.1], shift);
    let transient = Friction { motion: Motion::TransientRolling, ..shift };
    check("a transient step", [0.28; 2], Friction { prescribed: creepages(-0.1, 0.03), ..transient });
    check("steady rolling and derivatives", [0.28; 2], Friction { sensitivities: true, spin: 1e-4, ..rolling });
    let across = Friction { rolling_direction: 0.6, prescribed: forces, ..rolling };
    check("steady rolling across the grid, by forces", [0.28; 2], across);
}
