//! E and E' are transposes of each other, and E leaves what is known.

use super::*;
use crate::friction::Vector;

/// `w . E r = E' w . r` for C in spots, on a grid of odd sides and on a row.
#[test]
fn folding_is_the_transpose_of_filling() {
    for (mx, my) in [(21, 13), (17, 1), (16, 10), (2, 3), (1, 24)] {
        let value = |i: usize, seed: usize| ((i * 37 + seed) % 101) as f64 / 101.0 - 0.5;
        let bound: Vec<f64> = (0..mx * my).map(|i| if (i * 29 + i / 7) % 5 < 2 { 1.0 } else { 0.0 }).collect();
        let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
        let mut extension = Extension::<f64>::new(&grid, &Threads::One).unwrap();
        extension.contact_changed(&bound);
        let r: Vec<Vector> = (0..mx * my).map(|i| [bound[i] * value(i, 3), bound[i] * value(i, 8)]).collect();
        let w: Vec<Vector> = (0..mx * my).map(|i| [value(i, 50), value(i, 77)]).collect();
        let (mut filled, mut folded) = (r.clone(), w.clone());
        extension.fill(&mut filled);
        extension.fold(&mut folded);
        let dot = |a: &[Vector], b: &[Vector]| -> f64 { a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum() };
        let (by_filling, by_folding) = (dot(&w, &filled), dot(&folded, &r));
        // Sums of some 600 products below 1/4, in another order.
        assert!((by_filling - by_folding).abs() <= 1e-13, "{mx} x {my}: {by_filling} {by_folding}");
        assert!((0..mx * my).all(|i| bound[i] == 0.0 || filled[i] == r[i]), "what is known changed");
        assert!((0..mx * my).any(|i| bound[i] == 0.0 && filled[i] != [0.0; 2]), "nothing was filled in");
    }
}
