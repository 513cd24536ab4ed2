//! The influence coefficients are exact, near and far, for square and for very slender elements.

use astro_float::{BigFloat, Consts, RoundingMode};
use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace, Kernel, Periodic, Table};
use contact_normal::operator::Precision;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, InitialGuess, Options, Outcome, Solver};

use super::support::assert_conditions;

/// The precision of the reference in bits: the cancellation at offset 16384 and aspect ratio 1000 takes about 80 of them.
const BITS: usize = 320;
const RM: RoundingMode = RoundingMode::ToEven;

fn big(x: f64) -> BigFloat {
    BigFloat::from_f64(x, BITS)
}

/// a asinh(b/|a|) + b asinh(a/|b|) = a ln((b + r)/|a|) + b ln((a + r)/|b|), r = sqrt(a^2 + b^2)
fn corner(a: &BigFloat, b: &BigFloat, consts: &mut Consts) -> BigFloat {
    let r = a.mul(a, BITS, RM).add(&b.mul(b, BITS, RM), BITS, RM).sqrt(BITS, RM);
    let mut term = |x: &BigFloat, y: &BigFloat| {
        // asinh(y/|x|), odd in y: the logarithm of |y| first, so that nothing cancels
        let log = y.abs().add(&r, BITS, RM).div(&x.abs(), BITS, RM).ln(BITS, RM, consts);
        let signed = if y.is_negative() { log.neg() } else { log };
        x.mul(&signed, BITS, RM)
    };
    let first = term(a, b);
    let second = term(b, a);
    first.add(&second, BITS, RM)
}

/// Love's closed form in 320 bits, for 1/E* = pi.
fn reference(dx: f64, dy: f64, kx: i64, ky: i64, consts: &mut Consts) -> f64 {
    let half = big(0.5);
    let edge = |k: i64, d: f64, sign: i64| {
        let k = big((2 * k + sign) as f64).mul(&half, BITS, RM);
        k.mul(&big(d), BITS, RM)
    };
    let (xp, xm, yp, ym) = (edge(kx, dx, 1), edge(kx, dx, -1), edge(ky, dy, 1), edge(ky, dy, -1));
    let pp = corner(&xp, &yp, consts);
    let pm = corner(&xp, &ym, consts);
    let mp = corner(&xm, &yp, consts);
    let mm = corner(&xm, &ym, consts);
    let sum = pp.sub(&pm, BITS, RM).sub(&mp, BITS, RM).add(&mm, BITS, RM);
    format!("{sum}").parse().expect("a decimal number")
}

#[test]
fn coefficients_have_twelve_digits_up_to_offset_16384_and_aspect_ratio_1000() {
    let mut consts = Consts::new().expect("constants");
    let offsets = [0, 1, 2, 3, 4, 5, 7, 8, 11, 12, 16, 23, 40, 64, 100, 250, 1000, 3000, 4096, 9999, 16384];
    let mut worst: f64 = 0.0;
    for (dx, dy) in [(1.0, 1.0), (0.15, 0.1), (1.0, 50.0), (1000.0, 1.0), (1e-3, 1.0), (30.0, 1.0), (1e-6, 1.0)] {
        let half_space = HalfSpace::new(dx, dy, std::f64::consts::PI);
        for kx in offsets {
            for ky in offsets {
                let exact = reference(dx, dy, kx, ky, &mut consts);
                let error = ((half_space.at(kx, ky) - exact) / exact).abs();
                assert!(error <= 1e-12, "offset ({kx}, {ky}) of {dx} x {dy}: {} for {exact}", half_space.at(kx, ky));
                worst = worst.max(error);
            }
        }
    }
    println!("worst relative error {worst:.1e}");
}

#[test]
fn a_row_of_coefficients_is_its_single_coefficients() {
    for (dx, dy) in [(1.0, 1.0), (0.01, 3.0), (7.0, 0.2)] {
        let half_space = HalfSpace::new(dx, dy, 1e-5);
        for ky in [-5, 0, 3, 200] {
            let mut row = vec![0.0; 900];
            half_space.fill_row(0, ky, &mut row);
            for (kx, value) in row.iter().enumerate() {
                assert_eq!(value.to_bits(), half_space.at(-(kx as i64), -ky).to_bits());
            }
        }
    }
}

#[test]
fn scaling_the_element_by_a_power_of_two_scales_the_bits() {
    let (a, b) = (HalfSpace::new(0.3, 0.2, 2e-5), HalfSpace::new(0.3 / 1024.0, 0.2 / 1024.0, 2e-5));
    for (kx, ky) in [(0, 0), (1, 0), (0, 1), (3, 2), (5, 40), (1000, 20)] {
        assert_eq!(a.at(kx, ky).to_bits(), (1024.0 * b.at(kx, ky)).to_bits());
    }
}

/// A scene with a table of the half-space's coefficients uses the same operators as the half-space. It additionally holds the tables, which are even:
/// mx by my doubles of offsets >= 0 on each grid.
#[test]
fn reported_bytes_hold_the_coefficients() {
    let (mx, my) = (40, 36);
    let grid = Grid::new(mx, my, 0.5, 0.5).expect("a grid");
    // All elements are in contact, so that both solves converge at their first certificate, and neither keeps a best iterate.
    let h: Vec<f64> = (0..grid.len()).map(|i| 1e-4 * ((i % mx) as f64 - 20.0).powi(2)).collect();
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.5));
    let half_space = plain.coefficients().unwrap();
    let offsets = (0..4 * mx * my).map(|i| ((i % (2 * mx)) as i64 - mx as i64, (i / (2 * mx)) as i64 - my as i64));
    let values: Vec<f64> = offsets.map(|(kx, ky)| half_space.at(kx, ky)).collect();
    let table = Table::new(mx, my, &values, &grid).expect("a table");
    let bytes = |scene: &Scene<'_>| solve(scene, &Options::default()).expect("a solution").2.bytes;
    let more = bytes(&Scene { influence: Some(table), ..plain.clone() }) - bytes(&plain);
    let tables: usize = [(40, 36), (20, 18), (10, 9), (5, 5)].map(|(mx, my)| 8 * mx * my).iter().sum();
    assert_eq!(more, tables as u64);
    let periodic = Periodic::new(HalfSpace::new(0.5, 0.5, 1.0), (true, true), &grid).unwrap();
    assert_eq!(Coefficients::from(periodic).bytes(), 8 * 21 * 19);
}

/// A table of the half-space's coefficients times a factor. Offsets `(kx, .)` and `(-kx, .)` differ by a part `skew`.
fn own_table(grid: &Grid, factor: f64, skew: f64) -> Vec<f64> {
    let (mx, my) = (grid.mx as i64, grid.my as i64);
    let half_space = HalfSpace::new(grid.dx, grid.dy, 1.0 / factor);
    let offsets = (0..4 * mx * my).map(|i| (i % (2 * mx) - mx, i / (2 * mx) - my));
    offsets.map(|(kx, ky)| (1.0 + skew * kx.signum() as f64) * half_space.at(kx, ky)).collect()
}

/// A handle that gets another table has the bits of a new handle, for solves without a guess, on a window of the grid, and in both precisions. With a
/// skew below 1e-7 the table counts as symmetric, but its symbol has another period.
#[test]
fn a_solver_with_another_table_solves_as_a_new_one_from_nothing_and_from_its_last_result() {
    let grid = Grid::new(90, 72, 0.5, 0.6).expect("a grid");
    let place = |i: usize| ((i % 90) as f64 - 44.0, (i / 90) as f64 - 36.0);
    let h: Vec<f64> = (0..grid.len()).map(place).map(|(x, y)| 1e-3 * (x * x + y * y)).collect();
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.2));
    // A smaller load has a window of another size.
    let less = Scene { load: Load::Approach(0.1), ..plain.clone() };
    let with = |values: &[f64]| Scene { influence: Some(Table::new(90, 72, values, &grid).unwrap()), ..plain.clone() };
    for precision in [Precision::Mixed, Precision::Double] {
        let options = Options { precision, ..Options::default() };
        let previous = Options { initial_guess: InitialGuess::Previous, ..options };
        let first = own_table(&grid, 1.0, 0.0);
        let mut handle = Solver::new(&with(&first), &options).unwrap();
        assert_eq!(handle.solve(&plain, &options, None, None).unwrap().0, Outcome::Converged);
        for (factor, skew) in [(1.5, 0.0), (1.0, 1e-8), (0.9, 1e-8), (1.2, 0.0), (1.2, 0.0)] {
            let values = own_table(&grid, factor, skew);
            let (mut new, _, _) = solve(&with(&values), &options).unwrap();
            handle.set_influence(Table::new(90, 72, &values, &grid).unwrap()).unwrap();
            for initial in [&previous, &options] {
                assert_eq!(handle.solve(&plain, initial, None, None).unwrap().0, Outcome::Converged);
                let (p, mut u) = (&handle.state().p, vec![0.0; grid.len()]);
                for j in (0..p.len()).filter(|&j| p[j] > 0.0) {
                    for (i, u) in u.iter_mut().enumerate() {
                        *u += p[j] * values[(i / 90 + 72 - j / 90) * 180 + i % 90 + 90 - j % 90];
                    }
                }
                assert_conditions(&h, 0.2, p, &u, &format!("{factor} {skew} {initial:?}"));
            }
            assert!(handle.state().p == new.state().p, "{factor} {skew} {precision:?}");
            for scene in [&less, &plain] {
                assert_eq!(handle.solve(scene, &options, None, None).unwrap().0, Outcome::Converged);
                new.solve(scene, &options, None, None).unwrap();
                assert!(handle.state().p == new.state().p, "{factor} {skew} {precision:?} {:?}", scene.load);
            }
        }
    }
}

/// A table counts as symmetric relative to its largest coefficient within the grid, not to the largest of the whole table or to that of an element on
/// itself.
#[test]
fn symmetry_is_judged_beside_the_largest_coefficient_of_the_grid() {
    let (grid, part) = (Grid::new(9, 6, 1.0, 1.0).unwrap(), Grid::new(4, 6, 1.0, 1.0).unwrap());
    for (large, skew, whole, of_part) in
        [(1.0, 4e-8, true, true), (100.0, 4e-8, true, true), (100.0, 4e-6, true, false), (1.0, 4e-6, false, false)]
    {
        let mut values = vec![0.5; 18 * 12];
        let place = |kx: i64, ky: i64| ((ky + 6) * 18 + kx + 9) as usize;
        values[place(0, 0)] = 1.0;
        values[place(1, 2)] += skew;
        for (kx, ky) in [(-6, 3), (6, -3), (-6, -3), (6, 3)] {
            values[place(kx, ky)] = -large;
        }
        let influence = Coefficients::from(Table::new(9, 6, &values, &grid).unwrap());
        let found = [&grid, &part].map(|grid| (influence.is_symmetric(grid), influence.largest(grid)));
        assert_eq!(found, [(whole, large.max(1.0)), (of_part, 1.0)], "{large} {skew}");
    }
}

/// The message names the first bad coefficient in the order of the table, whether the table is even or not.
#[test]
fn a_coefficient_that_is_not_finite_is_named() {
    let grid = Grid::new(5, 4, 1.0, 1.0).unwrap();
    let place = |kx: i64, ky: i64| ((ky + 4) * 10 + kx + 5) as usize;
    for (bad, first) in [
        (&[(1, 2)][..], "(1, 2)"),
        (&[(3, 1), (-2, -3), (4, -3)], "(-2, -3)"),
        (&[(2, 3), (-2, 3), (2, -3), (-2, -3)], "(-2, -3)"),
    ] {
        for value in [f64::NAN, f64::INFINITY, 1e308] {
            let mut values = vec![1.0; 10 * 8];
            bad.iter().for_each(|(kx, ky)| values[place(*kx, *ky)] = value);
            let error = Table::scaled(5, 4, &values, 1e10, &grid).unwrap_err().to_string();
            // Of an even table only a quarter is tested, so that another one is the first.
            let first = if bad.len() == 4 && !value.is_nan() { "(2, 3)" } else { first };
            assert!(error.contains(first) && error.contains("finite"), "{error}, not {first}");
        }
    }
}

/// The library stores coefficients of small grids and computes others when needed. Both have the same bits. Elements that are twice as large have
/// coefficients that are twice as large.
#[test]
fn coefficients_that_are_kept_are_those_that_are_computed() {
    for (dx, dy) in [(1.0, 1.0), (0.3, 0.7), (2.0, 0.01)] {
        let half_space = HalfSpace::new(dx, dy, 1.7);
        let coarse = half_space.for_element(2.0 * dx, 2.0 * dy);
        for ky in [0, 1, 7, 8, 20, 63] {
            let (mut computed, mut kept) = ([0.0; 65], [0.0; 64]);
            half_space.fill_row(0, ky, &mut computed);
            for columns in [8, 30, 64] {
                half_space.fill_row(0, ky, &mut kept[..columns]);
                assert_eq!(kept[..columns], computed[..columns], "{dx} x {dy}, row {ky}, {columns} columns");
                half_space.fill_row(3, ky, &mut kept[..columns - 3]);
                assert_eq!(kept[..columns - 3], computed[3..columns], "{dx} x {dy}, row {ky}, from column 3");
                coarse.fill_row(0, ky, &mut kept[..columns]);
                assert!(kept[..columns].iter().zip(&computed).all(|(kept, computed)| *kept == 2.0 * computed));
            }
        }
    }
}
