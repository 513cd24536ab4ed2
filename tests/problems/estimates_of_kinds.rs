//! Estimated errors on surfaces for which errors are hard to estimate: sharp peaks among shallow contacts, flat punches by force and by approach, a
//! contact that the border of the grid cuts.

use std::f64::consts::PI;

use contact_normal::grid::Grid;
use contact_normal::influence::{HalfSpace, Kernel, Table};
use contact_normal::scene::{Bodies, Coating, Each, Layer, Load, Patches, Period, Scene};
use contact_normal::solver::{solve, Options, Report};

/// E* = 1.
const UNIT: Bodies = Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0, 0.0] };
const M: usize = 64;

fn report(scene: &Scene<'_>) -> Report {
    let options = Options { tolerance: 1e-8, estimates: true, ..Options::default() };
    solve(scene, &options).expect("a solvable scene").2
}

fn grid(side: f64) -> Grid {
    Grid::new(M, M, side / M as f64, side / M as f64).expect("a grid")
}

/// The undeformed distances at the centres of the elements, with coordinates from the middle of the grid.
fn at_centres(grid: &Grid, h: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let place = |k: usize| (k as f64 - 0.5 * (M as f64 - 1.0)) * grid.dx;
    (0..M * M).map(|i| h(place(i % M), place(i / M))).collect()
}

/// Balls in square cells that do not interact (as patches), so that each is a contact of Hertz. Of the balls `sharp` are pressed in by the full
/// approach, and have a contact radius of some elements. The others are broad and hardly touch. The arrays of the scene, and the exact force.
struct Balls {
    h: Vec<f64>,
    patch: Vec<i32>,
    count: usize,
    force: f64,
}

const APPROACH: f64 = 0.01;

/// Makes the scene. `radius`: the contact radius of the sharp balls, in elements. `depth`: the depth of the other balls, relative to the approach.
/// `off`: the offset of the centres from the middle of the cells.
fn balls(cells: usize, sharp: usize, radius: f64, depth: f64, off: f64) -> Balls {
    let (d, cell) = (1.0 / M as f64, 1.0 / cells as f64);
    let mut balls = Balls { h: vec![0.0; M * M], patch: vec![0; M * M], count: cells * cells, force: 0.0 };
    let of = |k: usize| if k < sharp { (radius * d, APPROACH) } else { (0.4 * cell, depth * APPROACH) };
    for (i, (h, patch)) in balls.h.iter_mut().zip(&mut balls.patch).enumerate() {
        let (x, y) = ((i % M) as f64 * d + 0.5 * d, (i / M) as f64 * d + 0.5 * d);
        let (ix, iy) = ((x / cell) as usize, (y / cell) as usize);
        let k = iy * cells + ix;
        let (a, depth) = of(k);
        let (u, v) = (x - (ix as f64 + 0.5) * cell - off * d, y - (iy as f64 + 0.5) * cell + 0.7 * off * d);
        // Hertz: a^2 = R depth.
        *h = (u * u + v * v) * depth / (2.0 * a * a) + APPROACH - depth;
        *patch = k as i32;
    }
    balls.force = (0..balls.count).map(|k| 4.0 / 3.0 * of(k).0 * of(k).1).sum();
    balls
}

#[test]
fn sharp_peaks_among_shallow_contacts_are_covered() {
    let mut ratios = Vec::new();
    for (sharp, radius, depth, off) in [
        (1, 1.5, 0.03, 0.0),
        (1, 1.5, 0.03, 0.5),
        (1, 1.5, 0.1, 0.0),
        (1, 1.5, 0.1, 0.5),
        (3, 1.5, 0.03, 0.5),
        (3, 1.5, 0.1, 0.5),
        (3, 2.5, 0.03, 0.5),
        (3, 2.5, 0.1, 0.5),
    ] {
        let Balls { h, patch, count, force } = balls(4, sharp, radius, depth, off);
        let alone: Vec<f64> = (0..count * count).map(|k| f64::from(k % (count + 1) == 0)).collect();
        for (load, exact) in [(Load::Approach(APPROACH), force), (Load::Force(force), APPROACH)] {
            let patches = Patches { patch: &patch, count, factors: &alone };
            let report = report(&Scene { patches: Some(patches), ..Scene::new(grid(1.0), &h, UNIT, load) });
            let ratio = report.error.force.expect("an estimate") / (report.measures.found(load) - exact).abs();
            // The bend is the measure of curvature at the rim from which the library estimates the error. The error of forces is half of the bend,
            // within a third (docs/notes), at most 0.67. The library estimates 0.58 of the bend, and 0.58/0.67 is 0.87. On few elements the ratio is
            // less.
            assert!(ratio >= 0.75, "{sharp} {radius} {depth} {off} {load:?}: {ratio}");
            ratios.push(ratio);
        }
    }
    ratios.sort_by(f64::total_cmp);
    // The estimates are not far above the errors, either.
    assert!(ratios[ratios.len() / 2] <= 4.0, "{ratios:?}");
}

/// For a flat punch F is proportional to the approach, so that relative errors are equal, whichever of them is given.
#[test]
fn errors_of_a_flat_punch_are_the_same_by_force_and_by_approach() {
    let grid = grid(1.93);
    let h = at_centres(&grid, |x, y| if x.abs().max(y.abs()) < 0.6 { 0.0 } else { f64::INFINITY });
    let by_approach = report(&Scene::new(grid, &h, UNIT, Load::Approach(APPROACH)));
    let force = by_approach.measures.force;
    let by_force = report(&Scene::new(grid, &h, UNIT, Load::Force(force)));
    let [of_force, of_approach] = [(&by_approach, force), (&by_force, by_force.measures.approach)]
        .map(|(report, value)| report.error.force.expect("an estimate") / value);
    // h is constant, so that only round-off and the residual differ.
    assert!((of_force / of_approach - 1.0).abs() < 1e-3, "{of_force} {of_approach}");
}

/// If the border of the grid cuts the contact, pressures at the border are infinite. The largest pressure on a grid is no approximation then,
/// wherever its peak is.
#[test]
fn a_peak_beside_a_cut_contact_is_not_trusted() {
    let grid = grid(1.0);
    for (off, is_known) in [(0.25, false), (0.0, true)] {
        let h = at_centres(&grid, |x, y| 0.5 * ((x - off) * (x - off) + y * y));
        let error = report(&Scene::new(grid, &h, UNIT, Load::Approach(0.08))).error;
        assert_eq!(error.max_pressure.is_some(), is_known, "{off}: {error:?}");
    }
}

/// The amplitude of the wave.
const DEPTH: f64 = 0.01;

/// The report of a wave along x, or along y if `turned`. `place`: the place of its crest from the middle, in periods.
fn of_wave((mx, my): (usize, usize), turned: bool, place: f64, load: Load) -> Report {
    let of = |k: usize| DEPTH * (1.0 - (2.0 * PI * ((k as f64 + 0.5) / mx as f64 - 0.5 - place)).cos());
    let (nx, ny) = if turned { (my, mx) } else { (mx, my) };
    let grid = Grid::new(nx, ny, 1.0 / nx as f64, 1.0 / ny as f64).expect("a grid");
    let h: Vec<f64> = (0..grid.len()).map(|i| of(if turned { i / nx } else { i % nx })).collect();
    let period = Some(Period { x: true, y: true });
    report(&Scene { period, ..Scene::new(grid, &h, UNIT, load) })
}

/// Westergaard's wave (1939): for the mean pressure `p = p* sin^2(pi c/2)`, with c the part of the period in contact, the mean planes approach by
/// `(p/pi)(1 - log(p/p*))`. Its derivative is unbounded as c tends to 1.
#[test]
fn errors_of_a_wave_are_covered_up_to_full_contact() {
    let closing = PI * DEPTH;
    let mut ratios = Vec::new();
    for part in [0.2, 0.35, 0.5, 0.65, 0.75, 0.85, 0.9] {
        let pressure = closing * (0.5 * PI * part).sin().powi(2);
        let approach = pressure / PI * (1.0 - (pressure / closing).ln());
        for (mx, my) in [(32, 4), (48, 6), (100, 12), (128, 1), (256, 32)] {
            for (load, exact) in [(Load::Approach(approach), pressure), (Load::Force(pressure), approach)] {
                let of = |turned, place| of_wave((mx, my), turned, place, load);
                let report = of(false, 0.0);
                let ratio = report.error.force.expect("an estimate") / (report.measures.found(load) - exact).abs();
                // As for the balls above, the error is at most 0.67 of the bend and 0.58 of it is estimated, which is 0.87; on few elements less.
                assert!(ratio >= 0.75, "{part} of {mx} x {my}, {load:?}: {ratio}");
                ratios.push(ratio);
                // The estimate does not depend on where the period begins, or on the direction, up to the round-off of sums and the residual of 1e-8.
                // With 64 rows in contact or more the library uses only some of the rows, so that the direction matters.
                let along_y = (part * mx as f64 + 1.0 < 64.0).then(|| of(true, 0.0));
                for other in [of(false, 0.5)].into_iter().chain(along_y) {
                    let [other, own] = [&other, &report].map(|report| report.error.force.expect("an estimate"));
                    let off = (other / own - 1.0).abs();
                    assert!(off < 1e-3, "{part} of {mx} x {my}, {load:?}: {off}");
                }
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios[ratios.len() / 2] <= 4.0, "{ratios:?}");
}

/// A ball with one side lower by a step. The contact ends at the step, where the second difference of h is as large as the step. This must not count
/// as a bend of the outline in the estimate.
#[test]
fn errors_beside_a_step_fall_with_the_elements() {
    let of_grid = |m: usize, slope: f64, load: Load| {
        let grid = Grid::new(m, m, 1.0 / m as f64, 1.0 / m as f64).expect("a grid");
        let place = |k: usize| (k as f64 + 0.5) / m as f64 - 0.5;
        let of = |x: f64, y: f64| x * x + y * y + if x + slope * y > 0.03 { 0.09 } else { 0.0 };
        let h: Vec<f64> = (0..m * m).map(|i| of(place(i % m), place(i / m))).collect();
        report(&Scene::new(grid, &h, UNIT, load))
    };
    for (slope, load) in [(0.0, Load::Approach(0.15)), (0.4, Load::Approach(0.15)), (0.4, Load::Force(0.05))] {
        let found = [32, 64, 128, 256].map(|m| of_grid(m, slope, load));
        let value = |k: usize| found[k].measures.found(load);
        for k in 0..2 {
            let [finer, error] = [k + 1, k].map(|k| found[k].error.force.expect("an estimate"));
            let ratio = finer / error;
            // From grid to grid the error falls to a half or to a quarter, with changes by steps of the outline.
            assert!((0.2..0.6).contains(&ratio), "{slope} {load:?}: {ratio}");
            // The finest grid serves as the reference. Its own error is at most a quarter of this one.
            assert!(
                error >= 0.75 * (value(k) - value(3)).abs(),
                "{slope} {load:?}: {error} of {}",
                value(k) - value(3)
            );
        }
    }
}

/// With two periods the mean of all displacements is 0. Near full contact the mean does not give the stiffness, and with a layer not even its sign.
/// The error must then be a number or unknown.
#[test]
fn errors_near_full_contact_of_two_periods_are_numbers_or_unknown() {
    let grid = grid(1.0);
    let wave = at_centres(&grid, |x, y| {
        let [x, y] = [x, y].map(|place| (2.0 * std::f64::consts::PI * place).cos());
        0.01 * (1.0 - x * y)
    });
    let flat = vec![0.0; M * M];
    for (h, layer, loads) in [
        (&wave, 1e-4, [Load::Force(0.018), Load::Approach(0.0099)]),
        (&wave, 0.0, [Load::Force(0.018), Load::Approach(0.0099)]),
        (&flat, 0.0, [Load::Force(1.0), Load::Force(1e-6)]),
        (&flat, 1e-4, [Load::Force(1.0), Load::Force(1e-6)]),
    ] {
        for load in loads {
            let plain = Scene::new(grid, h, UNIT, load);
            let layer = (layer > 0.0).then_some(Layer(Each::Uniform(layer)));
            let error = report(&Scene { period: Some(Period { x: true, y: true }), layer, ..plain }).error;
            for value in [error.force, error.max_pressure, error.contact_area, error.corrected_area, error.pressure] {
                assert!(value.is_none_or(|value| value >= 0.0), "{load:?}, layer {layer:?}: {error:?}");
            }
        }
    }
}

/// Where an element gives way more than on a half-space, the rim has no bias, and the error of the corrected area is the whole correction. Besides a
/// plain scene there are three of this kind: with a layer, with a thin coating that acts as this layer, and with a table of coefficients that has its
/// compliance on the diagonal.
#[test]
fn corrected_areas_of_compliant_elements_have_the_error_of_the_correction() {
    let (thickness, modulus, ratio) = (0.01, 0.005, 0.3);
    let compliance = thickness * (1.0 - 2.0 * ratio) / (2.0 * modulus * (1.0 - ratio));
    let error_of = |kind: &str, m: usize, centre: [f64; 2]| {
        let grid = Grid::new(m, m, 1.0 / m as f64, 1.0 / m as f64).expect("a grid");
        let place = |k: usize| (k as f64 + 0.5) * grid.dx - 0.5;
        let distance = |i: usize| 0.3 * (place(i % m) - centre[0]).powi(2) + 0.4 * (place(i / m) - centre[1]).powi(2);
        let h: Vec<f64> = (0..m * m).map(distance).collect();
        let half_space = HalfSpace::new(grid.dx, grid.dy, UNIT.compliance());
        let own = |k: usize| {
            let (kx, ky) = ((k % (2 * m)) as i64 - m as i64, (k / (2 * m)) as i64 - m as i64);
            half_space.at(kx, ky) + if (kx, ky) == (0, 0) { compliance } else { 0.0 }
        };
        let table: Vec<f64> = (0..4 * m * m).map(own).collect();
        let scene = Scene {
            layer: (kind == "layer").then_some(Layer(Each::Uniform(compliance))),
            coating: (kind == "coating").then_some(Coating::of_body_1(thickness, modulus, ratio)),
            influence: (kind == "table").then(|| Table::new(m, m, &table, &grid).expect("a table")),
            ..Scene::new(grid, &h, UNIT, Load::Approach(0.02))
        };
        let report = report(&scene);
        (report.measures.corrected_area, report.error.corrected_area.expect("an estimate"))
    };
    for kind in ["plain", "layer", "coating", "table"] {
        let (mut sum, mut above) = (0.0, 0);
        let centres = [[0.0, 0.0], [0.013, -0.008], [-0.021, 0.017], [0.005, 0.03], [-0.011, -0.027], [0.029, 0.002]];
        for centre in centres {
            let (exact, _) = error_of(kind, 256, centre);
            for m in [32, 48] {
                let (area, error) = error_of(kind, m, centre);
                let ratio = (area - exact).abs() / error;
                sum += ratio;
                above += usize::from(ratio > 1.0);
            }
        }
        println!("{kind}: mean {:.2}, above 1: {above} of 12", sum / 12.0);
        // The estimate is a standard deviation, not a bound: a tenth of 240 areas exceeded it. Before this estimate was added, half of them did.
        assert!(sum / 12.0 <= 0.8 && above <= 2, "{kind}: {sum} {above}");
    }
}
