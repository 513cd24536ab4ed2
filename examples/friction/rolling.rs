//! Measures the costs of steady rolling: a wheel on a rail, and ellipses of Hertz, with given creepages and with given forces.

use contact_normal::error::Error;
use contact_normal::scene::{Bodies, Friction, Load, Scene};
use contact_normal::solver::{solve, Options, Outcome};

use super::{scenes, steady, tangential, wheel_on_rail};

pub fn all(quick: bool) -> Result<(), Error> {
    wheel(if quick { &[1, 2] } else { &[1, 2, 4, 8] })?;
    ellipses(if quick { &[32, 64] } else { &steady::SIZES })?;
    random(if quick { 50 } else { 500 })
}

fn wheel(grids: &[usize]) -> Result<(), Error> {
    println!("wheel on a rail, steady rolling, creepages and then forces given:");
    println!("elements | slip | Fx, Fy over mu N, or creepages | products to 1e-4, 1e-6 | seconds, whole");
    for &k in grids {
        let (grid, h) = wheel_on_rail::surface(k);
        let run = |friction: Friction<'_>, tolerance: f64| {
            let plain = Scene::new(grid, &h, Bodies::same(82000.0, 0.28), Load::Approach(0.02084));
            solve(&Scene { friction: Some(friction), ..plain }, &Options { tolerance, ..Options::default() })
        };
        let (_, _, report) = run(wheel_on_rail::rolling(&grid), 1e-4)?;
        let carried = 0.3 * report.measures.force;
        for forces in [false, true] {
            let friction = match forces {
                false => wheel_on_rail::rolling(&grid),
                true => wheel_on_rail::rolling_with_forces(&grid, carried),
            };
            let (_, _, coarse) = run(friction, 1e-4)?;
            let (_, stop, fine) = run(friction, 1e-6)?;
            let seconds = [&coarse, &fine].map(|report| report.setup_seconds + report.solve_seconds);
            let (coarse, found) = (coarse.friction.unwrap_or_default(), fine.friction.unwrap_or_default());
            let values = if forces { found.creepage } else { found.force.map(|force| force / carried) };
            println!(
                "{:4} x {:4} | {:6} | {:.5e} {:.5e} | {:5.1} {:5.1} | {:.4} {:.4} {}",
                grid.mx,
                grid.my,
                found.certificate.slip_count,
                values[0],
                values[1],
                coarse.products,
                found.products,
                seconds[0],
                seconds[1],
                if stop == Outcome::Converged { "" } else { "FAILED" }
            );
        }
    }
    Ok(())
}

fn ellipses(sizes: &[usize]) -> Result<(), Error> {
    println!("steady rolling: b/a, case | F/(mu N) or creepages | slip | products to 1e-4/1e-6 (before)");
    let (mut all, mut above) = (vec![Vec::new(); 2], 0);
    for (b, known) in steady::RATIOS.iter().zip(steady::KNOWN) {
        for (k, (_, loose, tight)) in known.iter().enumerate() {
            let mut line = String::new();
            for (n, &m) in sizes.iter().enumerate() {
                let case = steady::Rolling::new(*b, k, m);
                let run = |tolerance| tangential(case.grid, steady::NU, &case.bound, &case.friction, tolerance);
                let (coarse, fine) = (run(1e-4)?, run(1e-6)?);
                let products = [coarse.1.products, fine.1.products];
                if n + 1 == sizes.len() {
                    let found = match k < steady::FIRST_OF_FORCES {
                        true => fine.1.force.map(|force| force / case.carried()),
                        false => fine.1.creepage,
                    };
                    let slip = fine.1.certificate.slip_count as f64
                        / (fine.1.certificate.slip_count + fine.1.certificate.stick_count) as f64;
                    line = format!(
                        "{b:4} {:16} | {:7.3} {:7.3} | {:5.1} % |{line}",
                        case.name,
                        found[0],
                        found[1],
                        100.0 * slip
                    );
                }
                let known = [loose[n], tight[n]].map(f64::from);
                above += usize::from(products[1] > 1.1 * known[1]);
                all[usize::from(k >= steady::FIRST_OF_FORCES)].push(products[1]);
                let failed = if (coarse.0, fine.0) == (Outcome::Converged, Outcome::Converged) { "" } else { "FAILED" };
                line += &format!(" {:4.1}/{:4.1} ({}/{}){failed}", products[0], products[1], known[0], known[1]);
            }
            println!("{line}");
        }
    }
    for products in &mut all {
        products.sort_by(f64::total_cmp);
    }
    let medians = all.iter().map(|products| products[products.len() / 2]).collect::<Vec<_>>();
    println!("medians to 1e-6, creepages and forces: {medians:.1?}; {above} cases of more than 1.1 times as before");
    Ok(())
}

fn random(count: u64) -> Result<(), Error> {
    println!("steady rolling, random ellipses, 64 x 64: products to 1e-6: median, 90 %, most, failures");
    for forces in [false, true] {
        let (mut products, mut failures) = (Vec::new(), 0);
        for seed in 0..count {
            let case = scenes::Ellipse::random_rolling(seed, 64, forces);
            match tangential(case.grid, case.nu, &case.bound, &case.friction, 1e-6) {
                Ok((Outcome::Converged, report, _)) => products.push(report.products),
                other => {
                    failures += 1;
                    println!("seed {seed}: {:?} {:?}", other.map(|(end, report, _)| (end, report)), case.friction);
                }
            }
        }
        products.sort_by(f64::total_cmp);
        let at = |part: f64| products[(part * (products.len() - 1) as f64) as usize];
        let what = if forces { "forces" } else { "creepages" };
        println!("{what}: {:.1} {:.1} {:.1} {failures} of {count}", at(0.5), at(0.9), at(1.0));
    }
    Ok(())
}
