//! Times of coatings: the set-up of influence coefficients, and solves of a ball on a coated body, each compared with the scene without a coating.

use contact_normal::grid::Grid;
use contact_normal::influence::{Radial, Transfer};
use contact_normal::scene::{Bodies, Coating, Load, Scene};
use contact_normal::solver::{solve, Options};

use crate::{medians, RUNS};

const NU: f64 = 0.3;

fn scene(m: usize, h: &[f64], coating: Option<(f64, f64)>) -> Scene<'_> {
    scene_of(m, 1.0, h, coating)
}

/// A scene on m x m elements of the size 1 x dy; `coating`: the ratio of the shear moduli of coating and substrate, and the thickness.
fn scene_of(m: usize, dy: f64, h: &[f64], coating: Option<(f64, f64)>) -> Scene<'_> {
    let grid = Grid::new(m, m, 1.0, dy).unwrap();
    let coating = coating.map(|(mu, t)| Coating::of_body_1(t, mu, NU));
    Scene { coating, ..Scene::new(grid, h, Bodies::same(1.0, NU), Load::Force(1e-4 * (m * m) as f64)) }
}

/// Prints the tables.
pub fn report() {
    println!("Radial functions of a coating, once for each pair of materials; medians of {RUNS} runs\n");
    println!("| G1/G2 | ms |\n|---:|---:|");
    for mu in [1e-4, 0.01, 0.5, 2.0, 10.0, 100.0, 1e4] {
        let [seconds] = medians([&mut || drop(Radial::new(Transfer::new(mu, [NU, NU])))]);
        println!("| {mu} | {:.1} |", 1e3 * seconds);
    }
    println!("\nCoefficients of 512 x 512 elements, t = 20 elements; medians of {RUNS} runs in turns\n");
    println!("| G1/G2 | dy/dx | ms | Love's alone, ms | ratio |\n|---:|---:|---:|---:|---:|");
    let h = vec![0.0; 512 * 512];
    let mut rows = vec![0.0; 512 * 512];
    for (mu, dy) in [(0.01, 1.0), (2.0, 1.0), (100.0, 1.0), (0.01, 0.8), (2.0, 0.8), (100.0, 0.8), (2.0, 0.25)] {
        let (coated, plain) = (scene_of(512, dy, &h, Some((mu, 20.0))), scene_of(512, dy, &h, None));
        let half_space = plain.coefficients().unwrap();
        let [with, without] = medians([&mut || drop(coated.coefficients().unwrap()), &mut || {
            rows.chunks_exact_mut(512)
                .enumerate()
                .for_each(|(ky, row)| half_space.kernel().fill_row(0, ky as i64, row));
        }]);
        println!("| {mu} | {dy} | {:.1} | {:.1} | {:.1} |", 1e3 * with, 1e3 * without, with / without);
    }
    solves();
    println!();
}

/// E* of the bodies without a coating.
const E_STAR: f64 = 1.0 / (1.0 - NU);
/// R of the ball, whose undeformed distance is h = r^2/(2 R).
const RADIUS: f64 = 1000.0;

/// Compares solves of a ball on a coated body and on a plain one, whose force is chosen so that both contact areas are equal: the cost of a product
/// depends on the window around the contact.
fn solves() {
    println!("\nA ball on a coated body, 256 x 256 elements, force given, tolerance 1e-6, one thread; beside the plain ball of the same area\n");
    println!(
        "| G1/G2 | t in elements | area | products | work units | ms | plain: area | products | work units | ms |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    let m = 256;
    let place = |k: usize| k as f64 - 127.5;
    let h: Vec<f64> = (0..m * m).map(|i| (place(i % m).powi(2) + place(i / m).powi(2)) / (2.0 * RADIUS)).collect();
    let report = |scene: &Scene<'_>| solve(scene, &Options::default()).unwrap().2;
    for (mu, t) in
        [(0.1, 2.0), (0.1, 20.0), (0.5, 2.0), (0.5, 20.0), (2.0, 2.0), (2.0, 20.0), (10.0, 20.0), (100.0, 20.0)]
    {
        let coated = scene(m, &h, Some((mu, t)));
        let one = report(&coated);
        // The force for a contact radius a: F = 4/3 E* a^3/R (Hertz).
        let a = (one.measures.contact_area / std::f64::consts::PI).sqrt();
        let plain = Scene { load: Load::Force(4.0 / 3.0 * E_STAR * a.powi(3) / RADIUS), ..scene(m, &h, None) };
        let other = report(&plain);
        let [with, without] = medians([&mut || _ = report(&coated), &mut || _ = report(&plain)]);
        print!("| {mu} | {t} ");
        for (report, seconds) in [(one, with), (other, without)] {
            let area = report.measures.contact_area;
            let (products, work) = (report.count.matrix_products, report.count.work_units);
            print!("| {area} | {products} | {work:.2} | {:.1} ", 1e3 * seconds);
        }
        println!("|");
    }
}
