//! The bytes that a product moves and the operations that it takes per second, compared with the speed at which the machine copies memory.
//!
//! Consider a product on N = m x m elements with even coefficients, padded to 2m x 2m. If no array stays in the caches, it moves 88 bytes per
//! element: 8 for p, 8 for u, 64 for the transformed rows (written, read and written by the columns, read) and 8 for the spectrum. It takes 2 m
//! real transforms of 2m values and 2 (m + 1) complex ones. A complex transform of length L takes `5 L log2 L` operations, a real one half of
//! that; together these are `30 N log2(2m)`.

use std::hint::black_box;

use crate::case::ellipse;
use crate::measure::{in_turns, median, shown, Product};

/// Bytes that a product moves for each element.
const BYTES: f64 = 88.0;
/// The number of values of an array that is larger than any cache.
const LARGE: usize = 1 << 25;

/// Prints the rates of products, and of copying.
pub fn limits(threads: usize, sizes: &[usize]) {
    println!("\n### What a product moves and computes, {threads} thread(s)\n");
    println!("| case | product | GB/s | Gflop/s |");
    println!("|---|---|---|---|");
    for &m in sizes {
        let case = ellipse(m);
        let mut product = Product::new(&case.scene(), threads);
        let time = median(&in_turns(&mut [&mut || product.run()])[0]);
        let elements = (m * m) as f64;
        let operations = 30.0 * elements * (2.0 * m as f64).log2();
        println!(
            "| {} | {} | {:.1} | {:.1} |",
            case.name,
            shown(time),
            1e-9 * BYTES * elements / time,
            1e-9 * operations / time
        );
    }
    let (from, mut to) = (vec![1.0; LARGE], vec![0.0; LARGE]);
    let time = median(&in_turns(&mut [&mut || black_box(&mut to).copy_from_slice(black_box(&from))])[0]);
    println!("\nOne thread copies {:.1} GB/s, read and written.", 16e-9 * LARGE as f64 / time);
}
