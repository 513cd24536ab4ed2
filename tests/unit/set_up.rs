//! The spectrum of even coefficients by rows and columns in the places of vectors, by that of rows and columns one by one.

use super::super::even_columns::EvenColumns;
use super::*;

#[test]
fn a_spectrum_by_lanes_is_that_of_single_columns() {
    let fill = |ky: i64, row: &mut [f64]| {
        row.iter_mut()
            .enumerate()
            .for_each(|(kx, c)| *c = 1.0 / (1.0 + (kx * kx) as f64 + 0.7 * (ky * ky) as f64).sqrt())
    };
    let mut set_up = SetUp::default();
    for (px, py) in [(12, 16), (32, 18), (54, 30), (100, 240), (432, 36), (36, 1024), (48, 4096)] {
        for reach in [(px / 2, py / 2), (px / 3, py / 4), (0, 0)] {
            // A preconditioner looks at each value that it is given: columns that are not there have none.
            let finish = |value: f64| {
                assert!(value.abs() > 1e-9, "a value of no column: {value}");
                1.0 + value
            };
            let even = Even { given: (reach.0 + 1, reach.1 + 1), fill, finish };
            let nb = px / 2 + 1;
            let transforms = Transforms::new((px, py), &Threads::One);
            let mut single = Vec::new();
            let order = EvenOrder::<f64> { by_lanes: None, columns: nb, py };
            transforms.of_even(&even, &mut set_up, order, &mut single).unwrap();
            let Some(columns) = EvenColumns::<f64>::new(py).filter(|_| transforms.lanes.is_some()) else {
                assert!(LaneRows::<f64>::new(1024).is_none(), "{px} x {py}");
                continue;
            };
            let mut spectrum = Vec::new();
            let order = EvenOrder { by_lanes: Some(&columns), ..order };
            transforms.of_even(&even, &mut set_up, order, &mut spectrum).unwrap();
            let mut expected = vec![f64::NAN; spectrum.len()];
            for (b, block) in expected.chunks_exact_mut(order.block()).enumerate() {
                let first = b * BLOCK;
                columns.write(block, nb - first, |column, bin| single[(first + column) * order.half() + bin]);
            }
            let largest = single.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            // Each of log2(px py) steps rounds once or twice.
            let allowed = 2.0 * ((px * py) as f64).log2() * f64::EPSILON * largest;
            for (k, (value, expected)) in spectrum.iter().zip(&expected).enumerate() {
                assert!((value - expected).abs() <= allowed, "{px} x {py}, {reach:?}, {k}: {value} {expected}");
            }
        }
    }
}
