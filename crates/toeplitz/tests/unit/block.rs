//! Blocks of columns do not overlap, and columns outside of all blocks do not change.

use super::*;

/// The number of rows of the matrices.
const ROWS: usize = 5;

/// A matrix of zeros.
fn zeros(width: usize) -> Vec<Complex<f64>> {
    vec![Complex::default(); ROWS * width]
}

/// Adds one to each value of a block.
fn count(block: &mut Block<'_, f64>) {
    for row in 0..block.rows() {
        block.row_mut(row).iter_mut().for_each(|value| value.re += 1.0);
    }
}

#[test]
fn some_columns_are_each_in_one_block() {
    for threads in [Threads::One, Threads::new(3).unwrap()] {
        for (width, columns, size) in [(40, 0..40, 16), (40, 3..40, 8), (33, 16..32, 16), (7, 2..5, 1), (9, 4..4, 3)] {
            let (mut matrix, mut scratch) = (zeros(width), vec![(); threads.count()]);
            let blocks = blocks_of(&mut matrix, width, columns.clone(), size);
            assert_eq!(blocks.len(), columns.len().div_ceil(size));
            threads.share(blocks, &mut scratch, |mut block, ()| {
                assert!(block.rows() == ROWS && block.first() >= columns.start && block.columns() <= size);
                count(&mut block);
            });
            for (i, value) in matrix.iter().enumerate() {
                let expected = f64::from(u8::from(columns.contains(&(i % width))));
                assert_eq!(value.re, expected, "column {} of {width}, {columns:?} by {size}", i % width);
            }
        }
    }
}

#[test]
fn what_is_asked_for_need_not_be_there() {
    let mut matrix = zeros(32);
    prefetch(std::ptr::null::<f64>(), 100);
    prefetch(matrix.as_ptr().wrapping_add(usize::MAX / 64), 7);
    let block = Block::of(&mut matrix, 32);
    for row in [0, ROWS - 1, ROWS, usize::MAX] {
        block.prefetch(row, (3, 4));
    }
    assert_eq!(matrix, zeros(32));
}
