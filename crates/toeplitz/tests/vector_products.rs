//! Compares products of two components with sums term by term: for all kinds of coefficients, on grids from one element to several blocks of columns,
//! in both precisions, with one thread and several.

use std::ops::Range;

use par::threads::Threads;
use toeplitz::{dense, vector_period, EvenMatrix, Real, VectorProduct};

/// Grids of one element, one row and one column, of odd and even sizes, and with several blocks of columns.
const GRIDS: [(usize, usize); 8] = [(1, 1), (9, 1), (1, 9), (2, 3), (7, 5), (16, 16), (33, 20), (70, 24)];

/// xx, yy and xy at the offset (x, y): xx and yy are even in both directions, xy is odd in both.
fn even(x: f64, y: f64) -> [f64; 3] {
    let r2 = 1.0 + x * x + 0.7 * y * y;
    [1.0 / r2.sqrt(), (1.0 + 0.3 * y * y / r2) / r2.sqrt(), 0.4 * x * y / (r2 * r2.sqrt())]
}

/// Values without any symmetry; some rows are zero.
fn values((mx, my): (usize, usize), seed: usize) -> Vec<f64> {
    let value = |i: usize| f64::from(((i * 7919 + seed * 13) % 1013) as f32 / 506.0 - 1.0);
    (0..mx * my).map(|i| if (my / 4..my - my / 5).contains(&(i / mx)) { value(i) } else { 0.0 }).collect()
}

/// Computes u = A q. Both fields are in double precision, whatever the precision T of the product.
fn apply<T: Real>(product: &VectorProduct<T>, q: [&[f64]; 2]) -> [Vec<f64>; 2] {
    let ((mx, my), together) = (product.grid(), product.rows_at_a_time());
    let mut u = [vec![f64::NAN; mx * my], vec![f64::NAN; mx * my]];
    let loaded = q.map(|q| -> Range<usize> {
        let rows = || q.chunks_exact(mx).enumerate().filter(|(_, row)| row.iter().any(|q| *q != 0.0));
        rows().next().map_or(0..0, |(first, _)| first..rows().next_back().map_or(0, |(last, _)| last + 1))
    });
    let load = |component: usize, first: usize, rows: &mut [T]| {
        rows.iter_mut().zip(&q[component][first * mx..]).for_each(|(to, q)| *to = T::of(*q));
    };
    let [x, y] = &mut u;
    let pieces = x.chunks_mut(together * mx).zip(y.chunks_mut(together * mx));
    let write = |(x, y): (&mut [f64], &mut [f64]), first: usize, [ux, uy]: [&[T]; 2]| {
        assert!(first % together == 0 && x.len() == ux.len() && y.len() == uy.len());
        x.iter_mut().zip(ux).for_each(|(to, u)| *to = u.to_double());
        y.iter_mut().zip(uy).for_each(|(to, u)| *to = u.to_double());
    };
    product.apply(loaded, load, (pieces, write), &mut product.memory().expect("memory"));
    u
}

/// The largest error of a product by the coefficients c = [xx, yy, xy], relative to the largest sum of the absolute values of its terms.
fn error<T: Real>(product: &VectorProduct<T>, c: impl Fn(i64, i64) -> [f64; 3], q: [&[f64]; 2]) -> f64 {
    let (grid, found, mut largest) = (product.grid(), apply(product, q), 0.0);
    for (component, found) in found.iter().enumerate() {
        let mut sums = [vec![0.0; found.len()], vec![0.0; found.len()]];
        let mut scale = vec![0.0; found.len()];
        for (from, sums) in sums.iter_mut().enumerate() {
            let coefficient = if from == component { component } else { 2 };
            dense::apply(grid, |x, y| c(x, y)[coefficient], q[from], sums);
            let absolute_q: Vec<f64> = q[from].iter().map(|q| q.abs()).collect();
            let mut absolute_sums = vec![0.0; found.len()];
            dense::apply(grid, |x, y| c(x, y)[coefficient].abs(), &absolute_q, &mut absolute_sums);
            scale.iter_mut().zip(absolute_sums).for_each(|(scale, sum)| *scale += sum);
        }
        let most = scale.iter().fold(1e-300, |most: f64, scale| most.max(*scale));
        for (k, found) in found.iter().enumerate() {
            assert!(found.is_finite(), "{grid:?}");
            largest = f64::max(largest, (found - sums[0][k] - sums[1][k]).abs() / most);
        }
    }
    largest
}

/// The largest relative error that is allowed: each of the log2 steps of the transforms there and back rounds once or twice, and so does the product
/// with S.
fn allowed<T: Real>(grid: (usize, usize)) -> f64 {
    8.0 * (((4 * grid.0 * grid.1) as f64).log2() + 1.0) * T::epsilon().to_double()
}

/// The product by [`even`]. Its period in x has room for `beyond` more offsets than the grid.
fn even_product<T: Real>(grid: (usize, usize), beyond: usize, is_coupled: bool, threads: &Threads) -> VectorProduct<T> {
    let fill = |component: usize, ky: i64, row: &mut [f64]| {
        row.iter_mut().enumerate().for_each(|(kx, value)| *value = even(kx as f64, ky as f64)[component]);
    };
    let given = (grid.0 + beyond, grid.1);
    let period = vector_period((2 * given.0 - 1, 2 * given.1 - 1));
    let coefficients = EvenMatrix { given, is_coupled, fill, finish: |values| values };
    VectorProduct::even(grid, period, &coefficients, threads).expect("memory")
}

#[test]
fn products_of_even_and_odd_coefficients_are_direct_sums() {
    for grid in GRIDS {
        let (x, y) = (values(grid, 1), values(grid, 2));
        for is_coupled in [true, false] {
            let c = |x: i64, y: i64| {
                let [xx, yy, xy] = even(x as f64, y as f64);
                [xx, yy, if is_coupled { xy } else { 0.0 }]
            };
            let product = even_product::<f64>(grid, 0, is_coupled, &Threads::One);
            assert_eq!(product.is_uncoupled(), !is_coupled);
            let (double, single) =
                (error(&product, c, [&x, &y]), error(&product.in_precision::<f32>().expect("memory"), c, [&x, &y]));
            assert!(double <= allowed::<f64>(grid), "{grid:?}, {is_coupled}: {double}");
            assert!(single <= allowed::<f32>(grid), "{grid:?}, {is_coupled}: {single}");
            let single = error(&even_product::<f32>(grid, 0, is_coupled, &Threads::One), c, [&x, &y]);
            assert!(single <= allowed::<f32>(grid), "{grid:?}, {is_coupled}, set up in single precision: {single}");
        }
    }
}

#[test]
fn differences_are_direct_sums() {
    for (grid, n) in GRIDS.into_iter().flat_map(|grid| [1, -1, 3].map(|n| (grid, n))) {
        let (x, y) = (values(grid, 1), values(grid, 2));
        let c = |x: i64, y: i64| {
            let (here, there) = (even(x as f64, y as f64), even((x + n) as f64, y as f64));
            [0, 1, 2].map(|k| here[k] - there[k])
        };
        let product = even_product::<f64>(grid, n.unsigned_abs() as usize, true, &Threads::One);
        let product = product.less_further_on(n).expect("memory");
        let double = error(&product, c, [&x, &y]);
        assert!(double <= allowed::<f64>(grid), "{grid:?} by {n}: {double}");
        let single = error(&product.in_precision::<f32>().expect("memory"), c, [&x, &y]);
        assert!(single <= allowed::<f32>(grid), "{grid:?} by {n}: {single}");
        let there = |x: i64, y: i64| even((x + n) as f64, y as f64);
        let product = even_product::<f64>(grid, n.unsigned_abs() as usize, true, &Threads::One);
        let double = error(&product.further_on(n).expect("memory"), there, [&x, &y]);
        assert!(double <= allowed::<f64>(grid), "{grid:?} further on by {n}: {double}");
    }
}

/// The symbol is a sum of a few cosines and sines, so only the nearest offsets have coefficients. A period that is two elements longer than the grid
/// keeps these offsets apart.
#[test]
fn products_of_a_symbol_are_direct_sums() {
    let nearest = |x: i64, y: i64| match (x.abs(), y.abs()) {
        (0, 0) => [3.0, 4.0, 0.0],
        (1, 0) => [-0.7, 0.2, 0.0],
        (0, 1) => [0.4, -0.3, 0.0],
        (1, 1) => [0.1, 0.25, 0.35 * (x * y) as f64],
        _ => [0.0; 3],
    };
    for (grid, is_coupled) in GRIDS.into_iter().flat_map(|grid| [(grid, true), (grid, false)]) {
        let (x, y) = (values(grid, 1), values(grid, 2));
        let period = vector_period((grid.0 + 2, grid.1 + 2));
        let wave = |kx: usize, ky: usize| {
            let angle = |k: usize, period: usize| 2.0 * std::f64::consts::PI * k as f64 / period as f64;
            let (ax, ay) = (angle(kx, period.0), angle(ky, period.1));
            let [centre, in_x, in_y, diagonal] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| nearest(x, y));
            let sum = |k: usize| {
                let in_lines = centre[k] + 2.0 * in_x[k] * ax.cos() + 2.0 * in_y[k] * ay.cos();
                in_lines + 4.0 * diagonal[k] * ax.cos() * ay.cos()
            };
            [sum(0), sum(1), -4.0 * diagonal[2] * ax.sin() * ay.sin()]
        };
        let product = VectorProduct::<f64>::of_waves(grid, period, (is_coupled, wave), &Threads::One).expect("memory");
        let c = |x: i64, y: i64| {
            let [xx, yy, xy] = nearest(x, y);
            [xx, yy, if is_coupled { xy } else { 0.0 }]
        };
        let double = error(&product, c, [&x, &y]);
        assert!(double <= allowed::<f64>(grid), "{grid:?} {is_coupled}: {double}");
        let single = error(&product.in_precision::<f32>().expect("memory"), c, [&x, &y]);
        assert!(single <= allowed::<f32>(grid), "{grid:?} {is_coupled}: {single}");
    }
}

#[test]
fn products_of_any_coefficients_are_direct_sums() {
    let c = |x: i64, y: i64| {
        let [here, there] = [0.3, -0.4].map(|by| even(x as f64 + by, y as f64 - 2.0 * by));
        [here[0] - 0.2 * there[0], here[1], here[2] + 0.1 * there[1]]
    };
    for grid in GRIDS {
        let (x, y) = (values(grid, 1), values(grid, 2));
        let fill = |kx: i64, ky: i64, rows: [&mut [f64]; 3]| {
            for (component, row) in rows.into_iter().enumerate() {
                row.iter_mut().zip(kx..).for_each(|(value, kx)| *value = c(kx, ky)[component]);
            }
        };
        for is_coupled in [true, false] {
            let coupled = |x: i64, y: i64| [c(x, y)[0], c(x, y)[1], if is_coupled { c(x, y)[2] } else { 0.0 }];
            let product = VectorProduct::<f64>::uneven(grid, is_coupled, fill, &Threads::One).expect("memory");
            let double = error(&product, coupled, [&x, &y]);
            assert!(double <= allowed::<f64>(grid), "{grid:?}, {is_coupled}: {double}");
            let single = error(&product.in_precision::<f32>().expect("memory"), coupled, [&x, &y]);
            assert!(single <= allowed::<f32>(grid), "{grid:?}, {is_coupled}: {single}");
        }
    }
}

#[test]
fn a_component_alone_displaces_in_its_own_direction_only() {
    for grid in GRIDS {
        let (x, nothing) = (values(grid, 1), vec![0.0; grid.0 * grid.1]);
        let product = even_product::<f64>(grid, 0, false, &Threads::One);
        for q in [[&x[..], &nothing], [&nothing, &x]] {
            let u = apply(&product, q);
            let both = apply(&product, [&x, &x]);
            for component in 0..2 {
                let is_alone = q[component].iter().any(|q| *q != 0.0);
                let expected = if is_alone { &both[component] } else { &nothing };
                assert!(u[component] == *expected, "{grid:?}, component {component}");
            }
        }
    }
}

#[test]
fn the_inverse_of_a_circulant_undoes_its_product() {
    // On a grid of one whole period, A is the circulant matrix of its symbol. The inverse symbol gives the inverse of A.
    let (grid, periods) = ((16, 10), vector_period((16, 10)));
    assert_eq!(periods, grid, "a grid of one period");
    let fill = |component: usize, ky: i64, row: &mut [f64]| {
        row.iter_mut().enumerate().for_each(|(kx, value)| {
            let at_half = 2 * kx == grid.0 || 2 * ky as usize == grid.1;
            let [xx, yy, xy] = even(kx as f64, ky as f64);
            let more = if (kx, ky) == (0, 0) { 1.0 } else { 0.0 };
            *value = [xx + more, yy + more, if at_half { 0.0 } else { xy }][component];
        });
    };
    let given = (grid.0 / 2 + 1, grid.1 / 2 + 1);
    let inverse = |[xx, yy, xy]: [f64; 3]| {
        let determinant = xx * yy - xy * xy;
        [yy / determinant, xx / determinant, -xy / determinant]
    };
    let there = EvenMatrix { given, is_coupled: true, fill, finish: |values| values };
    let back = EvenMatrix { given, is_coupled: true, fill, finish: inverse };
    let there = VectorProduct::<f64>::even(grid, periods, &there, &Threads::One).expect("memory");
    let back = VectorProduct::<f64>::even(grid, periods, &back, &Threads::One).expect("memory");
    let q = [values(grid, 1), values(grid, 2)];
    let u = apply(&there, [&q[0], &q[1]]);
    let again = apply(&back, [&u[0], &u[1]]);
    // The eigenvalues of A lie between 0.75 and 47. The second product multiplies errors of the first one, which are relative to sums of up to 50, by
    // at most 1/0.75. The errors of the second product are added.
    for (q, again) in q.iter().flatten().zip(again.iter().flatten()) {
        assert!((q - again).abs() <= 200.0 * allowed::<f64>(grid), "{q} {again}");
    }
}

#[test]
fn no_bit_depends_on_the_number_of_threads() {
    for grid in [(33, 20), (70, 24)] {
        let (x, y) = (values(grid, 1), values(grid, 2));
        let by = |count: usize| {
            let threads = Threads::new(count).expect("threads");
            let rolling = even_product::<f32>(grid, 1, true, &threads).less_further_on(1).expect("memory");
            let fill = |kx: i64, ky: i64, rows: [&mut [f64]; 3]| {
                for (component, row) in rows.into_iter().enumerate() {
                    let value = |kx: i64| even(kx as f64 + 0.3, ky as f64)[component];
                    row.iter_mut().zip(kx..).for_each(|(to, kx)| *to = value(kx));
                }
            };
            let general = VectorProduct::<f64>::uneven(grid, true, fill, &threads).expect("memory");
            (apply(&rolling, [&x, &y]), apply(&general, [&x, &y]))
        };
        assert!(by(1) == by(3), "{grid:?}");
    }
}
