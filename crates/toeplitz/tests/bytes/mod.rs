//! Makes a grid, coefficients and values of random bytes, and compares their product with the sum term by term. The cargo-fuzz target `product` in
//! fuzz/ also uses this module.

use par::threads::Threads;
use toeplitz::coefficients::SYMMETRY;
use toeplitz::{dense, Coefficients, Product, Real};

/// The largest number of elements in one direction.
const LONGEST: u64 = 40;
/// Values and coefficients are between about 2^-20 and 2^20, so that single precision has room for their products.
const POWERS: u64 = 20;

/// Reads bytes one after another. Beyond their end it reads zeros.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn next(&mut self) -> u64 {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        u64::from(*first)
    }

    /// A whole number from 0 to `most`.
    fn up_to(&mut self, most: u64) -> u64 {
        (self.next() | self.next() << 8) % (most + 1)
    }

    /// A value of either sign, over some orders of magnitude. One of eight is zero.
    fn value(&mut self) -> f64 {
        let (digits, sign) = (self.next(), self.next());
        if sign % 8 == 0 {
            return 0.0;
        }
        let size = (1.0 + digits as f64 / 256.0) * 2f64.powi(self.up_to(2 * POWERS) as i32 - POWERS as i32);
        if sign % 2 == 0 {
            -size
        } else {
            size
        }
    }
}

/// A table of coefficients at all offsets on a grid.
struct Table {
    grid: (i64, i64),
    values: Vec<f64>,
}

impl Table {
    /// Reads coefficients with a symmetry `kind`: 0 even in both directions, 1 equal at k and -k, 2 none.
    fn read(bytes: &mut Bytes<'_>, grid: (usize, usize), kind: u64) -> Table {
        let (mx, my) = (grid.0 as i64, grid.1 as i64);
        // So that few bytes make many coefficients, each offset is hashed to one of 16 values.
        let drawn: Vec<f64> = (0..16).map(|_| bytes.value()).collect();
        let hashed = |a: i64, b: i64| drawn[(a * 5 + b * 3).rem_euclid(16) as usize];
        let value = |kx: i64, ky: i64| match kind {
            0 => hashed(kx.abs(), ky.abs()),
            1 if (ky, kx) < (0, 0) => hashed(-kx, -ky),
            _ => hashed(kx, ky),
        };
        let values =
            (1 - my..my).flat_map(|ky| (1 - mx..mx).map(move |kx| (kx, ky))).map(|(kx, ky)| value(kx, ky)).collect();
        Table { grid: (mx, my), values }
    }

    /// The coefficient at an offset; 0 beyond the grid.
    fn at(&self, kx: i64, ky: i64) -> f64 {
        let (mx, my) = self.grid;
        if kx.abs() >= mx || ky.abs() >= my {
            return 0.0;
        }
        self.values[((ky + my - 1) * (2 * mx - 1) + kx + mx - 1) as usize]
    }
}

impl Coefficients for Table {
    fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = self.at(kx, ky));
    }

    fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        out.iter_mut().zip(kx..).for_each(|(value, kx)| *value = 0.5 * (self.at(kx, ky) + self.at(-kx, -ky)));
    }

    fn are_symmetric(&self) -> bool {
        let largest = self.values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        self.values.iter().zip(self.values.iter().rev()).all(|(one, other)| (one - other).abs() <= SYMMETRY * largest)
    }
}

/// Makes a product of bytes, in double or single precision and with one to three threads, and compares it with the sum term by term.
///
/// # Panics
/// If the product differs from the sum by more than round-off.
pub fn product(data: &[u8]) {
    let mut bytes = Bytes(data);
    let grid = (1 + bytes.up_to(LONGEST - 1) as usize, 1 + bytes.up_to(LONGEST - 1) as usize);
    let (kind, is_single) = (bytes.up_to(2), bytes.next() % 2 == 1);
    let threads = Threads::new(1 + bytes.up_to(2) as usize).expect("threads");
    let table = Table::read(&mut bytes, grid, kind);
    let p: Vec<f64> = (0..grid.0 * grid.1).map(|_| bytes.value()).collect();
    if is_single {
        compare::<f32>(&table, grid, kind, &threads, &p);
    } else {
        compare::<f64>(&table, grid, kind, &threads, &p);
    }
}

/// Compares the product of a table and p with the sum term by term.
///
/// A transform keeps the norm of its values, and each of its steps rounds. No value of the symbol exceeds the sum of the coefficients' absolute
/// values. So the norm of the error is at most this sum, times the norm of p, times a few roundings per step.
fn compare<T: Real>(table: &Table, grid: (usize, usize), kind: u64, threads: &Threads, p: &[f64]) {
    let product = match kind {
        0 => Product::<T>::even(grid, |kx, ky| table.at(kx as i64, ky as i64), threads),
        _ => Product::<T>::uneven(grid, table, threads),
    };
    let product = product.expect("memory");
    let given: Vec<T> = p.iter().map(|p| T::of(*p)).collect();
    let mut u = vec![T::nan(); p.len()];
    product.apply(&given, &mut u, &mut product.memory().expect("memory"));
    let (p, mut expected): (Vec<f64>, _) = (given.iter().map(|p| p.to_double()).collect(), vec![0.0; p.len()]);
    dense::apply(grid, |kx, ky| table.at(kx, ky), &p, &mut expected);
    let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>().sqrt();
    let sum: f64 = table.values.iter().map(|value| value.abs()).sum();
    let steps = ((4 * p.len()) as f64).log2() + 2.0;
    let allowed = 8.0 * steps * T::epsilon().to_double() * sum * norm(&mut p.iter().copied());
    let error = norm(&mut u.iter().zip(&expected).map(|(u, expected)| u.to_double() - expected));
    assert!(error <= allowed, "{grid:?}, kind {kind}, {} threads: {error:e}, {allowed:e}", threads.count());
}
