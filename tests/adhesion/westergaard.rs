//! A wavy surface in plane strain, in the limit of a short range: Johnson 1995.

use std::f64::consts::PI;

use contact_normal::adhesion::Law;
use contact_normal::grid::Grid;
use contact_normal::scene::{Load, Period, Scene};
use contact_normal::solver::{self, Options, Outcome};

use super::support::{adhesion, bodies};

/// h = D (1 - cos(2 pi x/L)) with L = 1, E* = 1.
const DEPTH: f64 = 0.02;
/// sqrt(2 E* w/L)/p*.
const ALPHA: f64 = 0.15;

/// a/L of a mean pressure, relative to p* = pi E* D/L:  p = sin^2 psi - alpha sqrt(tan psi), psi = pi a/L.
fn contact_width(pressure: f64) -> f64 {
    let p = |psi: f64| psi.sin().powi(2) - ALPHA * psi.tan().sqrt();
    let (mut low, mut high) = (0.25, 1.3);
    assert!(p(low) < pressure && p(high) > pressure);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        *(if p(middle) < pressure { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high) / PI
}

// The limit is approached to the first order of the range.
#[test]
fn contact_widths_approach_those_of_the_closed_form_with_the_range() {
    for (pressure, limit) in [(0.0, 0.0925), (0.2, 0.1931), (0.5, 0.3091)] {
        assert!((contact_width(pressure) - limit).abs() < 1e-4, "{pressure}: {}", contact_width(pressure));
    }
    for pressure in [0.0, 0.2, 0.5] {
        let wanted = contact_width(pressure);
        let off: Vec<f64> = [512, 2048].into_iter().map(|n| wanted - width(n, pressure, 0.0)).collect();
        println!("{pressure}: off by {off:?}");
        // Ranges are as 2 to 1, and half an element of 512 is .002.
        assert!(off[0] > 0.0 && off[0] < 0.03 && off[1] < 0.7 * off[0] + 1e-3, "{pressure}: {off:?}");
    }
}

// The half-widths are halves of elements, printed to four digits.
#[test]
fn contact_widths_are_those_that_the_prototype_printed() {
    for (n, range, printed) in [(1024, 0.0485, [0.0820, 0.1836, 0.2988]), (4096, 0.0266, [0.0881, 0.1890, 0.3044])] {
        for (pressure, printed) in [0.0, 0.2, 0.5].into_iter().zip(printed) {
            let found = width(n, pressure, range * DEPTH);
            assert!((found - printed).abs() < 5e-5 + 1e-12, "{n} {pressure}: {found} {printed}");
        }
    }
}

/// The half-width of the contact; a range of 0 is the shortest that the elements carry.
fn width(n: usize, pressure: f64, range: f64) -> f64 {
    let d = 1.0 / n as f64;
    let grid = Grid::new(n, 1, d, d).expect("a grid");
    let h: Vec<f64> = (0..n).map(|i| DEPTH * (1.0 - (2.0 * PI * ((i as f64 + 0.5) * d - 0.5)).cos())).collect();
    let largest = PI * DEPTH;
    let work = 0.5 * (ALPHA * largest).powi(2);
    let scene = Scene {
        period: Some(Period { x: true, y: true }),
        adhesion: Some(adhesion(Law::Exponential, work, range)),
        ..Scene::new(grid, &h, bodies(1.0), Load::Force(pressure * largest * d))
    };
    let (_, outcome, report) = solver::solve(&scene, &Options::default()).expect("a solve");
    assert_eq!(outcome, Outcome::Converged, "{n} {pressure}");
    println!("{n} {pressure}: {} products, {:.1} work", report.count.matrix_products, report.count.work_units);
    0.5 * report.measures.contact_count as f64 * d
}
