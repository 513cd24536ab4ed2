//! Compares products by FFT with sums term by term, for all kinds of coefficients and grids, both precisions and several numbers of threads.

use par::threads::Threads;
use toeplitz::{dense, Coefficients, Complex, Even, Product, Real, SetUp};

/// Grids of one element, one row and one column, of odd and even sizes, with several blocks of columns, and with periods that have stages or not.
const GRIDS: [(usize, usize); 10] =
    [(1, 1), (9, 1), (1, 9), (40, 1), (2, 3), (7, 5), (16, 16), (33, 20), (50, 47), (130, 36)];

/// Values without any symmetry, some rows of which are zero.
fn values<T: Real>((mx, my): (usize, usize)) -> Vec<T> {
    let loaded = my / 4..my - my / 5;
    let value = |i: usize| T::of(((i * 7919 + 13) % 1013) as f64 / 506.0 - 1.0);
    (0..mx * my).map(|i| if loaded.contains(&(i / mx)) { value(i) } else { T::zero() }).collect()
}

/// Coefficients that decrease with the offset.
#[derive(Clone, Copy)]
struct FallOff {
    /// The amplitudes of two parts that are not even in each direction: one with `c(k) = c(-k)`, and one without symmetry. If both are 0, the
    /// coefficients are even.
    skew: [f64; 2],
}

impl FallOff {
    /// The coefficient at an offset.
    fn at(&self, kx: i64, ky: i64) -> f64 {
        let (x, y) = (kx as f64, ky as f64);
        let r2 = 1.0 + x * x + 0.7 * y * y;
        (1.0 + self.skew[0] * x * y / r2 + self.skew[1] * (x + 0.5 * y) / r2) / r2.sqrt()
    }
}

impl Coefficients for FallOff {
    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = self.at(kx, ky));
    }

    fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = 0.5 * (self.at(kx, ky) + self.at(-kx, -ky)));
    }

    fn are_symmetric(&self) -> bool {
        self.skew[1] == 0.0
    }
}

/// The product by these coefficients, in precision T.
fn product<T: Real>(c: FallOff, grid: (usize, usize), threads: &Threads) -> Product<T> {
    match c.skew {
        [0.0, 0.0] => Product::even(grid, |kx, ky| c.at(kx as i64, ky as i64), threads),
        _ => Product::uneven(grid, &c, threads),
    }
    .expect("memory")
}

/// The largest error of a product, relative to its largest value.
fn error<T: Real>(product: &Product<T>, c: FallOff) -> f64 {
    let (p, grid) = (values::<T>(product.grid()), product.grid());
    let mut u = vec![T::nan(); p.len()];
    product.apply(&p, &mut u, &mut product.memory().expect("memory"));
    let (p, mut expected): (Vec<f64>, _) = (p.iter().map(|p| p.to_double()).collect(), vec![0.0; p.len()]);
    dense::apply(grid, |kx, ky| c.at(kx, ky), &p, &mut expected);
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most: f64, value| most.max(value.abs()));
    let differences = &mut u.iter().zip(&expected).map(|(u, expected)| u.to_double() - expected);
    assert!(u.iter().all(|u| u.is_finite()));
    let scale = largest(&mut expected.iter().copied());
    if scale == 0.0 {
        largest(differences)
    } else {
        largest(differences) / scale
    }
}

/// The largest relative error that is allowed. Each of the log2 steps of both transforms, there and back, rounds once or twice, and so does the
/// product with S. The values of p are of one size and c decreases with the offset, so no sum is much smaller than its terms.
fn allowed<T: Real>(grid: (usize, usize)) -> f64 {
    let steps = ((4 * grid.0 * grid.1) as f64).log2() + 1.0;
    8.0 * steps * T::epsilon().to_double()
}

#[test]
fn products_are_those_term_by_term() {
    for skew in [[0.0, 0.0], [0.6, 0.0], [0.6, 0.5]] {
        for grid in GRIDS {
            let c = FallOff { skew };
            for threads in [Threads::One, Threads::new(2).expect("threads")] {
                let double = product::<f64>(c, grid, &threads);
                assert!(error(&double, c) <= allowed::<f64>(grid), "{skew:?}, {grid:?}: {}", error(&double, c));
                for single in [product::<f32>(c, grid, &threads), double.in_precision(1.0).expect("memory")] {
                    assert!(error(&single, c) <= allowed::<f32>(grid), "{skew:?}, {grid:?}: {}", error(&single, c));
                }
            }
        }
    }
}

#[test]
fn the_bits_do_not_depend_on_threads() {
    for grid in GRIDS {
        for skew in [[0.0, 0.0], [0.6, 0.5]] {
            let bits = |threads: &Threads| {
                let product = product::<f64>(FallOff { skew }, grid, threads);
                let (p, mut memory) = (values(grid), product.memory().expect("memory"));
                let mut u = vec![f64::NAN; p.len()];
                // The product is computed twice: the second one must not depend on what the first one left in memory.
                product.apply(&p, &mut u, &mut memory);
                product.apply(&p, &mut u, &mut memory);
                u.into_iter().map(f64::to_bits).collect::<Vec<_>>()
            };
            let one = bits(&Threads::One);
            for count in [2, 3] {
                assert!(one == bits(&Threads::new(count).expect("threads")), "{grid:?}, {count} threads");
            }
        }
    }
}

#[test]
fn a_known_symbol_is_that_of_its_coefficients() {
    let (grid, period) = ((12, 10), (24, 20));
    let c = FallOff { skew: [0.0, 0.0] };
    let mut product = Product::<f64>::new(grid, period, &Threads::One).expect("memory");
    let fill = |ky: i64, row: &mut [f64]| row.iter_mut().zip(0..).for_each(|(value, kx)| *value = c.at(kx, ky));
    product.set_even(&Even { given: grid, fill, finish: |value| value }, &mut SetUp::default()).expect("memory");
    let (p, mut memory) = (values::<f64>(grid), product.memory().expect("memory"));
    let (mut u, mut of_values) = (vec![0.0; p.len()], vec![0.0; p.len()]);
    product.apply(&p, &mut u, &mut memory);
    // The symbol F c, term by term.
    let wave = |k: i64, bin: usize, period: usize| {
        Complex::from_polar(1.0, -std::f64::consts::TAU * (k * bin as i64) as f64 / period as f64)
    };
    let value = |x: usize, y: usize| {
        let offsets = (1 - grid.1 as i64..grid.1 as i64)
            .flat_map(|ky| (1 - grid.0 as i64..grid.0 as i64).map(move |kx| (kx, ky)));
        offsets.map(|(kx, ky)| c.at(kx, ky) * (wave(kx, x, period.0) * wave(ky, y, period.1)).re).sum::<f64>()
    };
    product.set_values(value).expect("memory");
    product.apply(&p, &mut of_values, &mut memory);
    let largest = u.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    let allowed = 24.0 * allowed::<f64>(grid) * largest;
    assert!(u.iter().zip(&of_values).all(|(u, other)| (u - other).abs() <= allowed), "{u:?}, {of_values:?}");
}
