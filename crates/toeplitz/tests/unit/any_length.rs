//! Transforms by rustfft: their bits depend on their length only.

use super::*;

/// Transforms n values on a new thread, which has planned the lengths `before` already.
fn transformed<T: Real>(n: usize, before: &'static [usize]) -> Vec<Complex<T>> {
    let transform = move || {
        before.iter().for_each(|&length| drop(ColumnTransform::<T>::planned(length)));
        let values = (0..n).map(|k| Complex::new(T::of((k as f64).sin()), T::of((2.7 * k as f64).cos())));
        let mut values: Vec<_> = values.collect();
        let transform = ColumnTransform::<T>::planned(n).unwrap();
        transform.forward(&mut values, &mut transform.scratch().unwrap());
        values
    };
    std::thread::scope(|scope| scope.spawn(transform).join().unwrap())
}

/// Bits do not depend on the lengths that a thread planned before.
#[test]
fn a_plan_has_nothing_of_those_before() {
    const BEFORE: &[usize] =
        &[128, 192, 256, 320, 384, 480, 512, 640, 768, 960, 1024, 1152, 1280, 1536, 1920, 2048, 2304];
    for n in (2..50).map(|k| 64 * k).chain([1535, 3071, 97, 194, 388, 3888]) {
        let [alone, after] = [&[], BEFORE].map(|before| transformed::<f64>(n, before));
        assert!(alone == after, "double, {n}");
        let [alone, after] = [&[], BEFORE].map(|before| transformed::<f32>(n, before));
        assert!(alone == after, "single, {n}");
    }
}
