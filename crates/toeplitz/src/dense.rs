//! The product of a block Toeplitz matrix term by term, without transforms. Tests compare [`Product`](crate::Product) with it.

/// Computes `u_I = sum_J c(I - J) p_J` on a grid of `mx * my` elements, term by term; `c(kx, ky)` is the coefficient at an offset.
pub fn apply((mx, my): (usize, usize), c: impl Fn(i64, i64) -> f64, p: &[f64], u: &mut [f64]) {
    assert!(p.len() == mx * my && u.len() == mx * my, "arrays of another grid");
    let place = |i: usize| ((i % mx) as i64, (i / mx) as i64);
    for (i, u) in u.iter_mut().enumerate() {
        let (x, y) = place(i);
        let term = |(j, p): (usize, &f64)| {
            let (loaded_x, loaded_y) = place(j);
            c(x - loaded_x, y - loaded_y) * p
        };
        *u = p.iter().enumerate().map(term).sum();
    }
}
