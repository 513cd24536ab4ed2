//! The same bits as another implementation, realfft, of every length up to 70 and of those that products take.

use super::*;
use realfft::{FftNum, RealFftPlanner};

fn compare<T: Real + FftNum>(n: usize, given: usize) {
    let ours = RowTransform::<T>::new(n);
    let mut planner = RealFftPlanner::<T>::new();
    let row: Vec<T> = (0..given).map(|i| T::of(((i * 7919 + n) % 1013) as f64 / 7.0 - 60.0)).collect();
    let mut padded = row.clone();
    padded.resize(n, T::zero());

    let (mut bins, mut expected) = (vec![Complex::default(); n / 2 + 1], vec![Complex::default(); n / 2 + 1]);
    let mut scratch = ours.scratch();
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
