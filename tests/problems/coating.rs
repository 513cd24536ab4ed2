//! Coatings.

use std::f64::consts::PI;

use contact_normal::grid::Grid;
use contact_normal::influence::{radial, Coated, CoatedBody, HalfSpace, Kernel};

fn coated(mu: f64, nu: [f64; 2], t: f64, grid: &Grid) -> Coated {
    let rigid = CoatedBody { compliance: 0.0, layer: None };
    let layer = CoatedBody { compliance: 1.0, layer: Some((t, radial(mu, nu))) };
    Coated::new([layer, rigid], grid).unwrap()
}

#[test]
fn quick() {
    for _ in 0..2 {
        let b = std::time::Instant::now();
        contact_normal::influence::Radial::new(contact_normal::influence::Transfer::new(2.0, [0.3, 0.3]));
        println!("radial again {:.1}", 1e3 * b.elapsed().as_secs_f64());
    }
    for mu in [1e-4, 1e-2, 0.1, 0.5, 1.0, 2.0, 10.0, 100.0, 1e4] {
        let began = std::time::Instant::now();
        radial(mu, [0.3, 0.3]);
        println!("mu {mu}: radial {:.1} ms", 1e3 * began.elapsed().as_secs_f64());
        for t in [10.0, 1.0, 0.3] {
            let fine = coated(mu, [0.3, 0.3], t, &Grid::new(310, 310, 1.0, 1.0).unwrap());
            let triple = coated(mu, [0.3, 0.3], t, &Grid::new(110, 110, 3.0, 3.0).unwrap());
            let mut worst = (0.0, 0, 0);
            for ky in 0..100 {
                for kx in 0..100 {
                    let mut sum = 0.0;
                    for j in -1..2 {
                        for i in -1..2 {
                            sum += fine.at(3 * kx + i, 3 * ky + j);
                        }
                    }
                    let error = (sum / triple.at(kx, ky) - 1.0).abs();
                    if !(error <= worst.0) {
                        worst = (error, kx, ky);
                    }
                }
            }
            let love = HalfSpace::new(1.0, 1.0, PI);
            let a00 = fine.at(0, 0) / love.at(0, 0);
            let far = fine.at(300, 3) / love.at(300, 3);
            println!("  t {t}: 3x3 {worst:?}  A00/L {a00:.12} A300/L {far:.12}");
        }
    }
    let began = std::time::Instant::now();
    for _ in 0..10 {
        coated(2.0, [0.3, 0.3], 10.0, &Grid::new(512, 512, 1.0, 1.0).unwrap());
    }
    println!("512: {:.1} ms", 100.0 * began.elapsed().as_secs_f64());
    let love = HalfSpace::new(1.0, 1.0, PI);
    let mut row = vec![0.0; 512];
    let began = std::time::Instant::now();
    for _ in 0..10 {
        for ky in 0..512 {
            love.fill_row(0, ky, &mut row);
        }
    }
    println!("love: {:.1} ms", 100.0 * began.elapsed().as_secs_f64());
}
