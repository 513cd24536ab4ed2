//! Measures what friction costs, in products of two components and in seconds: `cargo run --release --example friction [-- quick] [rolling]`.
//!
//! The scenes are a wheel on a rail (CONTACT's performance tests), Cattaneo's ball, rough surfaces, and random ellipses with given creepages or
//! forces; and steady rolling of the wheel and of ellipses.

mod rolling;
#[path = "../smoothers/rough.rs"]
#[allow(dead_code)]
mod rough;
mod scenes;
mod steady;
#[path = "../../tests/friction/wheel_on_rail.rs"]
mod wheel_on_rail;

use contact_normal::error::Error;
use contact_normal::friction::{Compliance, Report, Request, Solver, Tangential};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Friction, Load, Prescribed, Scene};
use contact_normal::solver::{solve, Options, Outcome};
use contact_normal::threads::Threads;

fn main() -> Result<(), Error> {
    let quick = std::env::args().any(|argument| argument == "quick");
    if std::env::args().any(|argument| argument == "rolling") {
        return rolling::all(quick);
    }
    wheel(if quick { &[1, 2, 4] } else { &[1, 2, 4, 8] })?;
    ball(if quick { &[32, 64, 128] } else { &[32, 64, 128, 256, 512] })?;
    rough_surfaces(if quick { &[128, 256] } else { &[128, 256, 512, 1024] })?;
    random(if quick { 60 } else { 300 })?;
    rolling::all(quick)
}

fn wheel(grids: &[usize]) -> Result<(), Error> {
    println!(
        "wheel on a rail, shift: elements | in contact, slip | products to 1e-4, 1e-6 | seconds tangential, whole"
    );
    for &k in grids {
        let (grid, h) = wheel_on_rail::surface(k);
        let scene = Scene {
            friction: Some(wheel_on_rail::shift(&grid)),
            ..Scene::new(grid, &h, Bodies::same(82000.0, 0.28), Load::Approach(0.02084))
        };
        let run = |tolerance: f64| solve(&scene, &Options { tolerance, ..Options::default() });
        let (_, _, coarse) = run(1e-4)?;
        let (_, stop, fine) = run(1e-6)?;
        let (coarse, found) = (coarse.friction.unwrap_or_default(), fine.friction.unwrap_or_default());
        println!(
            "{:4} x {:4} | {:6} {:6} | {:5.1} {:5.1} | {:.4} {:.4} {}",
            grid.mx,
            grid.my,
            fine.measures.contact_count,
            found.certificate.slip_count,
            coarse.products,
            found.products,
            found.seconds,
            fine.setup_seconds + fine.solve_seconds,
            if stop == Outcome::Converged { "" } else { "FAILED" }
        );
    }
    Ok(())
}

/// Solves the tangential problem for a given traction bound g = mu p, with G = 1.
pub fn tangential(
    grid: Grid,
    nu: f64,
    g: &[f64],
    friction: &Friction<'_>,
    tolerance: f64,
) -> Result<(Outcome, Report, Solver), Error> {
    let compliance = Compliance { shear: 1.0, poisson: nu, unlike: 0.0 };
    let mut solver = Solver::new(grid, Tangential::new(grid.dx, grid.dy, compliance), true, &Threads::One);
    let request = Request::new(g, friction, tolerance);
    let (end, report) = solver.solve(&request, &mut |_, _| true)?;
    Ok((end, report, solver))
}

fn ball(sizes: &[usize]) -> Result<(), Error> {
    println!("Cattaneo's ball, nu = 0, Fx = .875 mu N: elements | Fx/(mu N) | L1 error of q | stick radius | products");
    for &m in sizes {
        let case = scenes::Cattaneo::new(m, 0.5);
        let friction = Friction {
            prescribed: [Prescribed::Creepage(case.shift), Prescribed::Creepage(0.0)],
            ..Friction::new(1.0)
        };
        let (end, report, solver) = tangential(case.grid, 0.0, &case.bound, &friction, 1e-6)?;
        let found = solver.solution().map(|solution| case.compare(solution)).unwrap_or_default();
        println!(
            "{m:4} | {:.5} | {:.2e} | {:.4} | {:.1} {end:?}",
            report.force[0] / case.carried(),
            found.error,
            found.stick_radius,
            report.products
        );
    }
    Ok(())
}

fn rough_surfaces(sizes: &[usize]) -> Result<(), Error> {
    println!("rough surfaces: elements, share in contact | part of mu N, products to 1e-6, seconds, for four shifts");
    for &m in sizes {
        let (grid, h) = (rough::grid(m), rough::undeformed_distance(m));
        let plain = Scene::new(grid, &h, Bodies::same(0.7, 0.3), Load::Force(rough::FORCE));
        let (_, _, report) = solve(&plain, &Options::default())?;
        print!("{m:4} {:4.1} % |", 100.0 * report.measures.contact_count as f64 / grid.len() as f64);
        for part in [0.01, 0.2, 0.6, 1.2] {
            let scene = Scene { friction: Some(scenes::rough_shift(part, &report.measures)), ..plain.clone() };
            let (_, stop, report) = solve(&scene, &Options::default())?;
            let found = report.friction.unwrap_or_default();
            let carried = 0.3 * report.measures.force;
            let part = found.force[0].hypot(found.force[1]) / carried;
            let failed = if stop == Outcome::Converged { "" } else { "FAILED" };
            print!(" {part:.3} {:5.1} {:.3} {failed}", found.products, found.seconds);
        }
        println!();
    }
    Ok(())
}

fn random(count: u64) -> Result<(), Error> {
    println!("random ellipses, 64 x 64: products to 1e-6: median, 90 %, most, failures");
    for forces in [false, true] {
        let (mut products, mut failures) = (Vec::new(), 0);
        for seed in 0..count {
            let case = scenes::Ellipse::random(seed, 64, forces);
            let solved = tangential(case.grid, case.nu, &case.bound, &case.friction, 1e-6);
            let Ok((end, report, _)) = solved else {
                println!("seed {seed}: {:?} {:?}", solved.err(), case.friction.prescribed);
                failures += 1;
                continue;
            };
            if end != Outcome::Converged {
                println!("seed {seed}: {end:?} {:?}", report.certificate);
            }
            failures += u64::from(end != Outcome::Converged);
            products.push(report.products);
        }
        products.sort_by(f64::total_cmp);
        let at = |part: f64| products[(part * (products.len() - 1) as f64) as usize];
        let what = if forces { "forces" } else { "motion" };
        println!("{what}: {:.1} {:.1} {:.1} {failures} of {count}", at(0.5), at(0.9), at(1.0));
    }
    Ok(())
}
