//! A wavy surface with adhesion in plane strain, in the limit of a short range (Johnson 1995).

use std::f64::consts::PI;

use contact_normal::adhesion::{Law, Start};
use contact_normal::grid::Grid;
use contact_normal::scene::{Adhesion, Load, Period, Scene};
use contact_normal::solver::{self, Options, Outcome};

use super::support::{adhesion, bodies};

/// The amplitude D of h = D (1 - cos(2 pi x/L)), with L = 1 and E* = 1.
const DEPTH: f64 = 0.02;
/// Johnson's parameter alpha = sqrt(2 E* w/L)/p*.
const ALPHA: f64 = 0.15;

/// The contact half-width a/L for a mean pressure p relative to p* = pi E* D/L: p = sin^2 psi - alpha sqrt(tan psi), psi = pi a/L.
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

// The difference from the limit is of first order in the range.
#[test]
fn contact_widths_approach_those_of_the_closed_form_with_the_range() {
    for (pressure, limit) in [(0.0, 0.0925), (0.2, 0.1931), (0.5, 0.3091)] {
        assert!((contact_width(pressure) - limit).abs() < 1e-4, "{pressure}: {}", contact_width(pressure));
    }
    for pressure in [0.0, 0.2, 0.5] {
        let wanted = contact_width(pressure);
        let off: Vec<f64> = [512, 2048].into_iter().map(|n| wanted - width(n, pressure, 0.0)).collect();
        println!("{pressure}: off by {off:?}");
        // The first range is twice the second one. Half an element of 512 is .001.
        assert!(off[0] > 0.0 && off[0] < 0.03 && off[1] < 0.7 * off[0] + 1e-3, "{pressure}: {off:?}");
    }
}

// The half-widths are multiples of half an element, and the prototype printed them to four digits.
#[test]
fn contact_widths_are_those_that_the_prototype_printed() {
    for (n, range, printed) in [(1024, 0.0485, [0.0820, 0.1836, 0.2988]), (4096, 0.0266, [0.0881, 0.1890, 0.3044])] {
        for (pressure, printed) in [0.0, 0.2, 0.5].into_iter().zip(printed) {
            let found = width(n, pressure, range * DEPTH);
            assert!((found - printed).abs() < 5e-5 + 1e-12, "{n} {pressure}: {found} {printed}");
        }
    }
}

/// The half-width of the contact on n elements. A range of 0 stands for the shortest range that the elements resolve.
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

/// Displacements have no mean, so that the mean of the gap is that of `h - approach`. As long as it is positive, some elements are apart, whatever
/// the start is. A uniform pressure causes no displacement, and a large one must not hide the gap.
#[test]
fn not_all_touch_above_the_mean_distance() {
    for ((n, my), law) in [
        ((16, 1), Law::Exponential),
        ((64, 1), Law::Dugdale(0.25)),
        ((64, 16), Law::Cubic),
        ((344, 1), Law::VanDerWaals),
    ] {
        let d = 1.0 / n as f64;
        let grid = Grid::new(n, my, d, d).expect("a grid");
        let of = |i: usize| DEPTH * (1.0 - (2.0 * PI * ((i % n) as f64 + 0.5) * d).cos());
        let h: Vec<f64> = (0..n * my).map(of).collect();
        for start in [Start::Auto, Start::Contact, Start::Apart] {
            for part in [-0.5, 0.3, 0.9, 0.99, 0.999] {
                let attraction = Adhesion { start, ..adhesion(law, 0.3 * DEPTH * DEPTH * n as f64 / 64.0, 0.0) };
                let plain = Scene::new(grid, &h, bodies(1.0), Load::Approach(part * DEPTH));
                let scene = Scene { adhesion: Some(attraction), period: Some(Period { x: true, y: true }), ..plain };
                let what = format!("{n} x {my} {law:?} {start:?} {part}");
                let (solver, outcome, _) = solver::solve(&scene, &Options::default()).expect("a solve");
                assert_eq!(outcome, Outcome::Converged, "{what}");
                let state = solver.state();
                assert!(state.contact.contains(&false), "{what}");
                // The pressure that flattens the wave has the amplitude pi E* D/L, 30 times of which is ample.
                let largest = state.p.iter().fold(0.0, |largest: f64, p| largest.max(p.abs()));
                assert!(largest < 30.0 * PI * DEPTH, "{what}: {largest}");
                let gaps: f64 = state.u.iter().zip(&h).map(|(u, h)| h - part * DEPTH + u).sum();
                let expected = (1.0 - part) * DEPTH * h.len() as f64;
                assert!((gaps / expected - 1.0).abs() < 1e-9, "{what}: {gaps} {expected}");
            }
        }
    }
}
