//! Compares sums in lanes and the smallest value with loops over the elements. The values are whole numbers, whose sums have no round-off.

use super::{least, sum_where, Sums};

#[test]
fn sums_are_those_of_all_elements() {
    for n in 0..=23 {
        let values: Vec<f64> = (0..n).map(|i| f64::from(i * i % 17 - 5)).collect();
        let others: Vec<f32> = (0..n).map(|i| (i * 7 % 11 - 3) as f32).collect();
        let mut sums = Sums::new();
        sums.add([&values[..]], [&others[..]], |[a], [b]| [a * b, a - b, 1.0]);
        let pairs = || values.iter().zip(&others).map(|(a, b)| (*a, f64::from(*b)));
        let expected = [pairs().map(|(a, b)| a * b).sum(), pairs().map(|(a, b)| a - b).sum(), f64::from(n)];
        assert_eq!(sums.values(), expected, "{n} elements");
    }
}

#[test]
fn sums_of_one_kind_of_values_only() {
    let (values, ones): (Vec<f64>, Vec<f32>) = ((1..=9).map(f64::from).collect(), vec![1.0; 9]);
    let mut sums = Sums::new();
    sums.add::<f64, 2, 0>([&values, &values], [], |[a, b], []| [a * b]);
    sums.add([], [&ones[..]], |[], [b]| [b]);
    assert_eq!(sums.values(), [285.0 + 9.0]);
}

#[test]
fn the_least_of_all_values() {
    assert_eq!(least(&[]), f64::INFINITY);
    for n in 1..=23 {
        for at in 0..n {
            let mut values: Vec<f64> = (0..n).map(|i| (i * i % 17) as f64).collect();
            values[at] = -3.0;
            assert_eq!(least(&values), -3.0, "{n} values");
        }
    }
}

#[test]
fn sums_where_it_counts() {
    for n in 0..=23 {
        let counts: Vec<bool> = (0..n).map(|i| i % 3 == 1).collect();
        // Elements that do not count have infinite values, like the distances of excluded elements.
        let a: Vec<f64> = (0..n).map(|i| if i % 3 == 1 { i as f64 } else { f64::INFINITY }).collect();
        let b: Vec<f64> = (0..n).map(|i| (7 * i % 11) as f64).collect();
        let those = || (0..n).filter(|i| i % 3 == 1);
        let expected = (those().map(|i| a[i] - 3.0 + b[i]).sum(), those().count() as u64);
        assert_eq!(sum_where((&a, 3.0), &b, &counts), expected, "{n} values");
    }
}
