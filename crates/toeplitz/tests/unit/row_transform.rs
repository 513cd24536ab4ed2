//! Transforms of real rows have the same bits as those of the crate realfft, at every length up to 70 and at lengths that products use.

use super::*;
use realfft::{FftNum, RealFftPlanner};

/// Compares the transform of a row of `given` values, padded to length n, and its inverse with those of realfft.
fn compare<T: Real + FftNum>(n: usize, given: usize) {
    let ours = RowTransform::<T>::new(n).unwrap();
    let mut planner = RealFftPlanner::<T>::new();
    let row: Vec<T> = (0..given).map(|i| T::of(((i * 7919 + n) % 1013) as f64 / 7.0 - 60.0)).collect();
    let mut padded = row.clone();
    padded.resize(n, T::zero());

    let (mut bins, mut expected) = (vec![Complex::default(); n / 2 + 1], vec![Complex::default(); n / 2 + 1]);
    let mut scratch = ours.scratch().unwrap();
    ours.forward(&row, &mut bins, &mut scratch);
    planner.plan_fft_forward(n).process(&mut padded, &mut expected).unwrap();
    assert!(bins == expected, "forward, {n} values, {given} given");

    let (mut back, mut expected_back) = (vec![T::nan(); given], vec![T::zero(); n]);
    ours.inverse(&mut bins, &mut back, &mut scratch);
    planner.plan_fft_inverse(n).process(&mut expected, &mut expected_back).unwrap();
    assert!(back == expected_back[..given], "inverse, {n} values, {given} wanted");
}

#[test]
fn a_row_has_the_bits_of_realfft() {
    for n in (1..=70usize).chain([96, 100, 432, 500, 1024, 1440, 2048, 2160]) {
        for given in [n, n.div_ceil(2), (n / 3 + 1).min(n)] {
            compare::<f64>(n, given);
            compare::<f32>(n, given);
        }
    }
}

/// Compares rows that are transformed together with each row alone.
fn compare_together<T: Real>(n: usize, width: usize) {
    let transform = RowTransform::<T>::new(n).unwrap();
    let (nb, mut scratch) = (transform.bins(), transform.scratch().unwrap());
    for count in [1, transform.at_a_time().div_ceil(2), transform.at_a_time()] {
        let rows: Vec<T> = (0..count * width).map(|i| T::of(((i * 7919 + n) % 1013) as f64 / 7.0 - 60.0)).collect();
        let (mut bins, mut one) = (vec![Complex::default(); count * nb], vec![Complex::default(); nb]);
        transform.forward_together(&rows, width, &mut bins, &mut scratch);
        let each = bins.clone();
        let mut back = vec![T::nan(); count * width];
        transform.inverse_together(&mut bins, &mut back, width, &mut scratch);
        for (k, row) in rows.chunks_exact(width).enumerate() {
            transform.forward(row, &mut one, &mut scratch);
            assert!(one == each[k * nb..(k + 1) * nb], "forward, {n} values, row {k} of {count}");
            let mut expected = vec![T::nan(); width];
            transform.inverse(&mut one, &mut expected, &mut scratch);
            assert!(expected == back[k * width..(k + 1) * width], "inverse, {n} values, row {k} of {count}");
        }
    }
}

#[test]
fn rows_that_are_transformed_together_have_the_bits_of_each_alone() {
    for n in [2usize, 3, 8, 15, 30, 36, 54, 64, 108, 128, 250, 256, 258, 432] {
        for width in [n, n.div_ceil(2)] {
            compare_together::<f64>(n, width);
            compare_together::<f32>(n, width);
        }
    }
}
