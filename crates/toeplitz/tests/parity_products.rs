//! Compares sums of products by kernels that are even or odd in either direction with sums term by term.

use toeplitz::fft::good_length;
use toeplitz::{dense, ParityProduct, Term};

/// Grids of one element, one row and one column, of odd and even sizes, and with more columns than are transformed at a time.
const GRIDS: [(usize, usize); 7] = [(1, 1), (9, 1), (1, 9), (2, 3), (7, 5), (16, 16), (33, 20)];
/// Whether a kernel is odd in x, and whether it is odd in y.
const PARITIES: [(bool, bool); 4] = [(false, false), (true, false), (false, true), (true, true)];

/// A kernel with a given parity, at the offset (x, y).
fn kernel((odd_x, odd_y): (bool, bool), x: i64, y: i64) -> f64 {
    let (x, y) = (x as f64, y as f64);
    let r2 = 1.0 + x * x + 0.7 * y * y;
    (if odd_x { x } else { 1.0 }) * (if odd_y { y } else { 1.0 }) / (r2 * r2.sqrt())
}

/// A load without symmetry.
fn load((mx, my): (usize, usize), seed: usize) -> Vec<f64> {
    (0..mx * my).map(|i| ((i * 7919 + seed * 131) % 1013) as f64 / 506.0 - 1.0).collect()
}

/// The largest error of a sum of products of loads by kernels with these parities, relative to the sum of the absolute values of the kernels. With
/// `repeats`, loads and kernels are periodic.
fn error(grid: (usize, usize), parities: &[(bool, bool)], repeats: bool) -> f64 {
    let (mx, my) = grid;
    let period = |m: usize| if repeats { m } else { good_length(2 * m - 1) };
    let product = ParityProduct::new(period(mx), period(my)).expect("memory");
    let ((px, py), (nb, half)) = (product.lengths(), product.bins());
    let given = if repeats { (mx / 2 + 1, my / 2 + 1) } else { grid };
    let mut memory = product.memory(given.1).expect("memory");
    // The offset of at most half a period that is equal to k, up to whole periods.
    let near = |k: i64, m: usize| {
        let k = if repeats { k.rem_euclid(m as i64) } else { k };
        if repeats && 2 * k > m as i64 {
            k - m as i64
        } else {
            k
        }
    };
    let periodic_kernel = |(odd_x, odd_y): (bool, bool), x: i64, y: i64| {
        let (x, y) = (near(x, mx), near(y, my));
        // An offset of half a period is its own opposite. An odd kernel is 0 there.
        let is_opposite_of_itself = |k: i64, m: usize| repeats && 2 * k.unsigned_abs() as usize == m;
        if (odd_x && is_opposite_of_itself(x, mx)) || (odd_y && is_opposite_of_itself(y, my)) {
            0.0
        } else {
            kernel((odd_x, odd_y), x, y)
        }
    };
    let (mut expected, mut scale) = (vec![0.0; mx * my], 0.0);
    let parts: Vec<_> = parities
        .iter()
        .enumerate()
        .map(|(seed, &parity)| {
            let load = load(grid, seed);
            let mut u = vec![0.0; mx * my];
            dense::apply(grid, |x, y| periodic_kernel(parity, x, y), &load, &mut u);
            expected.iter_mut().zip(&u).for_each(|(sum, u)| *sum += u);
            scale += (0..mx * my).map(|i| periodic_kernel(parity, (i % mx) as i64, (i / mx) as i64).abs()).sum::<f64>();
            let table: Vec<f64> =
                (0..given.0 * given.1).map(|i| kernel(parity, (i % given.0) as i64, (i / given.0) as i64)).collect();
            let mut symbol = vec![f64::NAN; nb * half];
            product.of_kernel(&table, given.0, parity, &mut memory, &mut symbol);
            let load = product.of_load(&load, mx, 2.0, 2.0 / (px as f64 * py as f64)).expect("memory");
            (load, symbol)
        })
        .collect();
    let terms = parts.iter().zip(parities);
    let terms = terms.map(|((load, symbol), &is_odd)| Term { load, symbol, is_odd });
    let (mut in_x, mut found) = (vec![toeplitz::Complex::default(); my * nb], vec![f64::NAN; mx * my]);
    product.in_x(terms, (nb, half), &mut memory, &mut in_x);
    product.back(&in_x, nb, 1.0, &mut memory, &mut found, mx);
    let error = found.iter().zip(&expected).map(|(found, expected)| (found - expected).abs());
    error.inspect(|error| assert!(error.is_finite())).fold(0.0, f64::max) / (4.0 * scale).max(1.0)
}

#[test]
fn sums_of_products_are_direct_sums() {
    for (grid, repeats) in GRIDS.into_iter().flat_map(|grid| [(grid, false), (grid, true)]) {
        // Each of the log2(4 mx my) steps of the transforms rounds once or twice.
        let allowed = 8.0 * (((4 * grid.0 * grid.1) as f64).log2() + 1.0) * f64::EPSILON;
        for parity in PARITIES {
            let error = error(grid, &[parity], repeats);
            assert!(error <= allowed, "{grid:?}, {parity:?}, repeats {repeats}: {error}");
        }
        let error = error(grid, &PARITIES, repeats);
        assert!(error <= allowed, "{grid:?}, repeats {repeats}: {error}");
    }
}
