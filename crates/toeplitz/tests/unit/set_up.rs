//! Compares the symbol of even coefficients that is computed in lanes with that computed one row and column at a time.

use super::*;
use crate::fft::lane_columns::LaneColumns;
use crate::set_up::Transforms;

const PERIODS: [(usize, usize); 9] =
    [(12, 16), (20, 27), (36, 45), (32, 18), (54, 30), (100, 240), (432, 36), (36, 1024), (48, 4096)];

/// Even coefficients at the offsets 0 ..= x and 0 ..= y.
fn even((x, y): (usize, usize)) -> Even<impl Fn(i64, &mut [f64]) + Sync + Send, impl Fn(f64) -> f64 + Sync + Send> {
    let fill = |ky: i64, row: &mut [f64]| {
        let value = |kx: usize| 1.0 / (1.0 + (kx * kx) as f64 + 0.7 * (ky * ky) as f64).sqrt();
        row.iter_mut().enumerate().for_each(|(kx, c)| *c = value(kx));
    };
    // A preconditioner tests each value of the symbol, so it must not get values of columns beyond the last bin.
    let finish = |value: f64| {
        assert!(value.abs() > 1e-9, "a value of no column: {value}");
        1.0 + value
    };
    Even { given: (x + 1, y + 1), fill, finish }
}

/// The largest offsets with coefficients, for tests of one period.
fn reaches((px, py): (usize, usize)) -> [(usize, usize); 3] {
    [(px / 2, py / 2), (px / 3, py / 4), (0, 0)]
}

/// Computes the symbol in lanes with a given instruction set. Returns None if it has no SIMD vectors.
fn by_lanes<T: Real>(
    arch: pulp::Arch,
    period: (usize, usize),
    reach: (usize, usize),
    threads: &Threads,
) -> Option<Vec<T>> {
    let (transforms, columns) =
        (LaneTransforms::on(arch, period, threads).unwrap()?, LaneColumns::<T>::new(period.1).unwrap()?);
    let order = EvenOrder { by_lanes: Some(&columns), columns: period.0 / 2 + 1, py: period.1 };
    let mut spectrum = Vec::new();
    transforms.of_even(&even(reach), &mut SetUp::default(), order, &mut spectrum).unwrap();
    Some(spectrum)
}

#[test]
fn a_spectrum_by_lanes_is_that_of_single_columns() {
    for (px, py) in PERIODS {
        for reach in reaches((px, py)) {
            let Some(spectrum) = by_lanes::<f64>(pulp::Arch::new(), (px, py), reach, &Threads::One) else {
                assert!(LaneRows::<f64>::new(1024).unwrap().is_none(), "{px} x {py}");
                continue;
            };
            let (mut single, half) = (Vec::new(), py / 2 + 1);
            let transforms = Transforms::new((px, py), &Threads::One).unwrap();
            transforms.of_even(&even(reach), &mut SetUp::default(), &mut single).unwrap();
            let (nb, columns) = (px / 2 + 1, LaneColumns::<f64>::new(py).unwrap().unwrap());
            let mut expected = vec![f64::NAN; spectrum.len()];
            for (b, block) in expected.chunks_exact_mut(BLOCK * columns.kept_rows()).enumerate() {
                let first = b * BLOCK;
                columns.write(block, nb - first, |column, bin| single[(first + column) * half + bin]);
            }
            let largest = single.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            // Each of the log2(px py) steps rounds once or twice.
            let allowed = 2.0 * ((px * py) as f64).log2() * f64::EPSILON * largest;
            for (k, (value, expected)) in spectrum.iter().zip(&expected).enumerate() {
                assert!((value - expected).abs() <= allowed, "{px} x {py}, {reach:?}, {k}: {value} {expected}");
            }
        }
    }
}

#[test]
#[cfg(target_arch = "x86_64")]
fn no_bit_depends_on_the_length_of_vectors_or_on_threads() {
    let Some(v3) = pulp::x86::V3::try_new() else { return println!("no AVX2 here") };
    let shorter = pulp::Arch::V3(v3);
    for period in PERIODS {
        for reach in reaches(period) {
            let here = by_lanes::<f64>(pulp::Arch::new(), period, reach, &Threads::One);
            assert!(here.is_some(), "{period:?}");
            assert!(here == by_lanes(shorter, period, reach, &Threads::One), "{period:?}, {reach:?}: AVX2");
            let two = Threads::new(2).unwrap();
            assert!(here == by_lanes(pulp::Arch::new(), period, reach, &two), "{period:?}, {reach:?}: two threads");
            let single = here.unwrap().iter().map(|value| *value as f32).collect();
            assert!(Some(single) == by_lanes::<f32>(shorter, period, reach, &two), "{period:?}, {reach:?}: f32");
        }
    }
}
