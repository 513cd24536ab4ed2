//! Compares transforms of rows in lanes with those of another implementation, realfft.

use super::*;
use crate::block::parts;
use crate::fft::row_pass::{Forward, Inverse};
use realfft::RealFftPlanner;

/// Transforms a group of rows with `width` values each there and back; `missing` rows of the group are left out. Returns the largest error of the
/// bins and of the rows transformed back, each relative to the largest value.
fn errors<T: Real>(n: usize, width: usize, missing: usize) -> [f64; 2] {
    let lanes = LaneRows::<T>::new(n).unwrap().expect("a plan");
    let together = lanes.at_a_time();
    let count = together - missing.min(together - 1);
    let rows: Vec<T> = (0..count * width).map(|i| T::of(((i * 7919 + n) % 1013) as f64 / 7.0 - 60.0)).collect();
    let mut bins = vec![Complex::new(T::nan(), T::nan()); lanes.blocks() * together * BLOCK];
    let mut bins = Block::of(&mut bins, together * BLOCK);
    let mut scratch = vec![Complex::new(T::nan(), T::nan()); lanes.scratch_length()];
    let plan = &*lanes.plan;
    T::rows_forward(lanes.arch, Forward { plan, rows: &rows, width, bins: &mut bins, scratch: &mut scratch });
    let mut planner = RealFftPlanner::<f64>::new();
    let (mut difference, mut largest) = (0.0, 0.0);
    for (r, row) in rows.chunks_exact(width).enumerate() {
        let mut padded: Vec<f64> = row.iter().map(|x| x.to_double()).collect();
        padded.resize(n, 0.0);
        let mut expected = vec![Complex::default(); n / 2 + 1];
        planner.plan_fft_forward(n).process(&mut padded, &mut expected).unwrap();
        for (k, expected) in expected.iter().enumerate() {
            let block = &parts(bins.row(k / BLOCK))[r * 2 * BLOCK..][..2 * BLOCK];
            let (re, im) = (block[k % BLOCK].to_double(), block[BLOCK + k % BLOCK].to_double());
            let error = (re - expected.re).hypot(im - expected.im);
            assert!(error.is_finite(), "{n}, {width} values, bin {k}");
            difference = f64::max(difference, error);
            largest = f64::max(largest, expected.norm());
        }
    }
    let mut back = vec![T::nan(); count * width];
    T::rows_inverse(lanes.arch, Inverse { plan, bins: &bins, rows: &mut back, width, scratch: &mut scratch });
    let of_row = |(x, back): (&T, &T)| (back.to_double() / n as f64 - x.to_double()).abs();
    assert!(back.iter().all(|x| x.to_double().is_finite()), "{n}, {width} values");
    let back = rows.iter().zip(&back).map(of_row).fold(0.0, f64::max);
    [difference / largest, back / 85.0]
}

#[test]
fn rows_in_lanes_have_the_bins_of_each() {
    if LaneRows::<f64>::new(32).unwrap().is_none() {
        // Without vectors rows are transformed one by one, which tests/unit/row_transform.rs checks.
        return assert!(LaneRows::<f32>::new(32).unwrap().is_none());
    }
    for n in [12usize, 16, 18, 20, 30, 32, 50, 54, 64, 100, 240, 432, 864, 900, 1024, 2160, 4096] {
        for width in [n, n - 1, n / 2, n / 2 + 1, n / 3, 5, 1] {
            for missing in [0, 1, 100] {
                // Each of the log2(n) steps rounds once or twice.
                let allowed = 2.0 * (n as f64).log2();
                for error in errors::<f64>(n, width, missing) {
                    assert!(error <= allowed * f64::EPSILON, "{n}, {width} values, {missing} rows missing: {error}");
                }
                for error in errors::<f32>(n, width, missing) {
                    assert!(
                        error <= allowed * f64::from(f32::EPSILON),
                        "{n}, {width} values, {missing} rows missing: {error}"
                    );
                }
            }
        }
    }
}

/// Transforms 16 rows there and back with a given instruction set. Returns the bins, and the rows transformed back.
#[cfg(target_arch = "x86_64")]
fn by<T: Real>(arch: pulp::Arch, n: usize, width: usize) -> (Vec<Complex<T>>, Vec<T>) {
    let lanes = LaneRows::<T>::on(arch, n).unwrap().expect("a plan");
    let rows: Vec<T> = (0..16 * width).map(|i| T::of(((i * 7919 + n) % 1013) as f64 / 7.0 - 60.0)).collect();
    let (mut bins, mut back) = (vec![Complex::default(); 16 * lanes.blocks() * BLOCK], vec![T::nan(); 16 * width]);
    let mut scratch = vec![Complex::default(); lanes.scratch_length()];
    let together = lanes.at_a_time();
    let of_all = |bins: &mut Vec<Complex<T>>, work: &mut dyn FnMut(usize, &mut Block<'_, T>)| {
        let blocks = blocks_of(bins, 16 * BLOCK, 0..16 * BLOCK, together * BLOCK);
        blocks.enumerate().for_each(|(k, mut some)| work(k * together * width, &mut some));
    };
    let count = together * width;
    let plan = &*lanes.plan;
    of_all(&mut bins, &mut |at, bins| {
        let (rows, scratch) = (&rows[at..][..count], &mut scratch[..]);
        T::rows_forward(arch, Forward { plan, rows, width, bins, scratch });
    });
    of_all(&mut bins, &mut |at, bins| {
        let (rows, scratch) = (&mut back[at..][..count], &mut scratch[..]);
        T::rows_inverse(arch, Inverse { plan, bins, rows, width, scratch });
    });
    (bins, back)
}

#[cfg(target_arch = "x86_64")]
#[test]
fn no_bit_depends_on_the_length_of_vectors() {
    // Without AVX-512 there is nothing to compare. Valgrind's tests of examples run without it on each machine.
    let Some(avx2) = pulp::x86::V3::try_new() else { return };
    for (n, width) in [(12, 7), (54, 54), (432, 216), (1024, 512), (2160, 1000)] {
        let here = by::<f64>(pulp::Arch::new(), n, width);
        assert!(by::<f64>(pulp::Arch::V3(avx2), n, width) == here, "{n}, {width} values");
        let here = by::<f32>(pulp::Arch::new(), n, width);
        assert!(by::<f32>(pulp::Arch::V3(avx2), n, width) == here, "{n}, {width} values");
    }
}

#[test]
fn some_lengths_have_no_plan() {
    for n in [1, 2, 4, 6, 7, 8, 10, 15, 28, 44] {
        assert!(RowPlan::<f64>::shared(n).unwrap().is_none(), "{n}");
    }
}
