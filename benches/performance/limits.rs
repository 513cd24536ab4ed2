//! What a product moves and computes, beside what the machine can.
//!
//! A product on N = m x m elements of even coefficients, padded to 2m x 2m, moves 88 bytes an element when no array stays in the caches:
//! p and u (8 each), the transformed rows (written, read and written by the columns, read: 64), the spectrum (8). Its transforms are 2 m
//! real ones of 2m values and 2 (m + 1) complex ones; `5 L log2 L` operations for a complex one of length L, half of that for a real one,
//! are `30 N log2(2m)` in all.

use std::hint::black_box;

use crate::case::ellipse;
use crate::measure::{in_turns, median, shown, Product};

/// Bytes that a product moves for each element.
const BYTES: f64 = 88.0;
/// Values of an array that no cache holds.
const LARGE: usize = 1 << 25;

/// The table.
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
