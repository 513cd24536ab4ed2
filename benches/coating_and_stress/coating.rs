//! Set-up of coefficients, and solves of a ball on a coated body, each beside the plain scene.

use contact_normal::grid::Grid;
use contact_normal::influence::{Radial, Transfer};
use contact_normal::scene::{Bodies, Coating, Load, Scene};
use contact_normal::solver::{solve, Options};

use crate::{medians, RUNS};

const NU: f64 = 0.3;

fn scene(m: usize, h: &[f64], coating: Option<(f64, f64)>) -> Scene<'_> {
    let grid = Grid::new(m, m, 1.0, 1.0).unwrap();
    let coating = coating.map(|(mu, t)| Coating::of_body_1(t, mu, NU));
    Scene { coating, ..Scene::new(grid, h, Bodies::same(1.0, NU), Load::Force(1e-4 * (m * m) as f64)) }
}

/// Prints the tables.
pub fn report() {
    println!("Radial functions of a coating, once for each pair of materials; medians of {RUNS} runs\n");
    println!("| G1/G2 | ms |\n|---:|---:|");
    for mu in [0.01, 0.5, 2.0, 10.0, 100.0] {
        let [seconds] = medians([&mut || drop(Radial::new(Transfer::new(mu, [NU, NU])))]);
        println!("| {mu} | {:.1} |", 1e3 * seconds);
    }
    println!("\nCoefficients of 512 x 512 elements, t = 20 elements; medians of {RUNS} runs in turns\n");
    println!("| G1/G2 | ms | Love's alone, ms | ratio |\n|---:|---:|---:|---:|");
    let h = vec![0.0; 512 * 512];
    let mut rows = vec![0.0; 512 * 512];
    for mu in [0.01, 2.0, 100.0] {
        let (coated, plain) = (scene(512, &h, Some((mu, 20.0))), scene(512, &h, None));
        let half_space = plain.coefficients().unwrap();
        let [with, without] = medians([&mut || drop(coated.coefficients().unwrap()), &mut || {
            rows.chunks_exact_mut(512)
                .enumerate()
                .for_each(|(ky, row)| half_space.kernel().fill_row(0, ky as i64, row));
        }]);
        println!("| {mu} | {:.1} | {:.1} | {:.1} |", 1e3 * with, 1e3 * without, with / without);
    }
    println!("\nA ball on a coated body, 256 x 256 elements, force given, tolerance 1e-6, one thread\n");
    println!("| G1/G2 | t in elements | products | work units | ms | plain: products | work units | ms |\n|---|---:|---:|---:|---:|---:|---:|---:|");
    let m = 256;
    let place = |k: usize| k as f64 - 127.5;
    let h: Vec<f64> = (0..m * m).map(|i| 5e-4 * (place(i % m).powi(2) + place(i / m).powi(2))).collect();
    for (mu, t) in
        [(0.1, 2.0), (0.1, 20.0), (0.5, 2.0), (0.5, 20.0), (2.0, 2.0), (2.0, 20.0), (10.0, 20.0), (100.0, 20.0)]
    {
        let (coated, plain) = (scene(m, &h, Some((mu, t))), scene(m, &h, None));
        let report = |scene: &Scene<'_>| solve(scene, &Options::default()).unwrap().2;
        let (one, other) = (report(&coated), report(&plain));
        let [with, without] = medians([&mut || _ = report(&coated), &mut || _ = report(&plain)]);
        println!(
            "| {mu} | {t} | {} | {:.1} | {:.1} | {} | {:.1} | {:.1} |",
            one.count.matrix_products,
            one.count.work_units,
            1e3 * with,
            other.count.matrix_products,
            other.count.work_units,
            1e3 * without
        );
    }
    println!();
}
