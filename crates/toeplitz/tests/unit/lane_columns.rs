//! Compares products of columns in lanes with those by another implementation of the transforms, rustfft.

use std::ops::Range;

use super::*;
use crate::block::{parts, parts_mut};
use crate::fft::any_length::ColumnTransform;
use crate::fft::column_pass::{Blocks, EvenSymbol, Multiply};
use crate::fft::stages::before_a_line;
use crate::real::Complex;

/// Multiplies the columns of a matrix of `my` rows by an even symbol. Only the rows `loaded` hold values. Returns the largest error relative to the
/// largest value.
fn error<T: Real>(length: usize, width: usize, my: usize, loaded: Range<usize>) -> f64 {
    let even = LaneColumns::<T>::new(length).unwrap().expect("a plan");
    let value = |i: usize| T::of(((i * 7919 + length) % 1013) as f64 / 506.0 - 1.0);
    let s = |column: usize, bin: usize| T::of(((column * 31 + bin * 17) % 97) as f64 / 97.0 + 0.1);
    let matrix: Vec<Complex<T>> = (0..my * width).map(|i| Complex::new(value(2 * i), value(2 * i + 1))).collect();

    let transform = ColumnTransform::<f64>::new(length).unwrap();
    let mut scratch = transform.scratch().unwrap();
    let mut expected = Vec::new();
    for x in 0..width {
        let double = |z: Complex<T>| Complex::new(z.re.to_double(), z.im.to_double());
        let row = |y: usize| if loaded.contains(&y) { double(matrix[y * width + x]) } else { Complex::default() };
        let mut column: Vec<Complex<f64>> = (0..length).map(row).collect();
        transform.forward(&mut column, &mut scratch);
        column.iter_mut().enumerate().for_each(|(k, z)| *z *= s(x, k.min(length - k)).to_double());
        transform.inverse(&mut column, &mut scratch);
        expected.push(column);
    }

    // The matrix as `[block][row][part][column]`. Columns beyond the last one are NaN: they must not influence the result.
    let (wide, kept) = (width.next_multiple_of(BLOCK), BLOCK * even.kept_rows());
    let mut spectrum = vec![T::nan(); wide / BLOCK * kept];
    for (b, block) in spectrum.chunks_exact_mut(kept).enumerate() {
        even.write(block, width - b * BLOCK, |column, bin| s(b * BLOCK + column, bin));
    }
    let place = |y: usize, x: usize| (x / BLOCK * my + y) * 2 * BLOCK + x % BLOCK;
    let mut blocks = vec![Complex::new(T::nan(), T::nan()); my * wide];
    for (i, z) in matrix.iter().enumerate() {
        let at = place(i / width, i % width);
        (parts_mut(&mut blocks)[at], parts_mut(&mut blocks)[at + BLOCK]) = (z.re, z.im);
    }
    let memory = vec![Complex::new(T::nan(), T::nan()); BLOCK * length + before_a_line::<T>()];
    for (b, (block, spectrum)) in blocks.chunks_exact_mut(my * BLOCK).zip(spectrum.chunks_exact(kept)).enumerate() {
        let (columns, next) = (width - b * BLOCK, [block.as_ptr()]);
        let blocks = Blocks { blocks: [block], columns, next, loaded: [loaded.clone()] };
        let (factor, memory) = (&EvenSymbol(spectrum), &mut memory.clone()[..]);
        T::by_even(even.arch, Multiply { plan: &even.plan, blocks, factor, memory });
    }
    let (mut difference, mut largest) = (0.0, 0.0);
    for y in 0..my {
        for (x, column) in expected.iter().enumerate() {
            let at = place(y, x);
            let (re, im) = (parts(&blocks)[at].to_double(), parts(&blocks)[at + BLOCK].to_double());
            let error = (re - column[y].re).hypot(im - column[y].im);
            assert!(error.is_finite(), "column {x}, row {y}");
            difference = f64::max(difference, error);
            largest = f64::max(largest, column[y].norm());
        }
    }
    assert!(largest > 0.0);
    difference / largest
}

/// Lengths that have each radix as the first, a middle and the last one. Some are so long that their stages work in parts.
const LENGTHS: [usize; 18] = [6, 8, 9, 10, 15, 16, 20, 25, 27, 32, 48, 50, 60, 120, 450, 1024, 2160, 4096];

#[test]
fn columns_in_lanes_have_the_product_of_each() {
    for length in LENGTHS {
        for width in [1, 7, 8, 11, 16, 24, 40, 47] {
            for (my, loaded) in
                [(length, 0..length), (length / 2 + 1, 0..length / 2), (length / 2 + 1, 1..2), (1, 0..1)]
            {
                // Each of the log2(length) steps rounds once or twice.
                let allowed = 2.0 * (length as f64).log2();
                let (double, single) =
                    (error::<f64>(length, width, my, loaded.clone()), error::<f32>(length, width, my, loaded));
                assert!(double <= allowed * f64::EPSILON, "{length}, {width} columns: {double}");
                assert!(single <= allowed * f64::from(f32::EPSILON), "{length}, {width} columns: {single}");
            }
        }
    }
}

#[test]
fn some_lengths_have_no_plan() {
    for length in [1, 2, 3, 4 * 7, 5, 11, 22] {
        assert!(EvenPlan::<f64>::shared(length).unwrap().is_none(), "{length}");
    }
}

/// Multiplies a block of columns with a given instruction set.
#[cfg(target_arch = "x86_64")]
fn by<T: Real>(arch: pulp::Arch, length: usize) -> Vec<Complex<T>> {
    let even = LaneColumns::<T>::on(arch, length).unwrap().expect("a plan");
    let value = |i: usize| T::of(((i * 7919 + length) % 1013) as f64 / 506.0 - 1.0);
    let (mut spectrum, my) = (vec![T::nan(); BLOCK * even.kept_rows()], length / 2);
    even.write(&mut spectrum, BLOCK, |column, bin| value(column * 31 + bin * 17));
    let mut block: Vec<_> = (0..my * BLOCK).map(|i| Complex::new(value(2 * i), value(2 * i + 1))).collect();
    let mut memory = vec![Complex::default(); BLOCK * length + before_a_line::<T>()];
    let (next, loaded) = ([block.as_ptr()], 0..my);
    let blocks = Blocks { blocks: [&mut block[..]], columns: BLOCK, next, loaded: [loaded] };
    T::by_even(arch, Multiply { plan: &even.plan, blocks, factor: &EvenSymbol(&spectrum), memory: &mut memory });
    block
}

#[cfg(target_arch = "x86_64")]
#[test]
fn no_bit_depends_on_the_length_of_vectors() {
    // Without AVX-512 there is nothing to compare. Valgrind's tests of examples run without it on each machine.
    let Some(avx2) = pulp::x86::V3::try_new() else { return };
    for length in LENGTHS {
        assert!(by::<f64>(pulp::Arch::V3(avx2), length) == by(pulp::Arch::new(), length), "{length}");
        assert!(by::<f32>(pulp::Arch::V3(avx2), length) == by(pulp::Arch::new(), length), "{length}");
    }
}
