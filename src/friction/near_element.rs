//! The integrals a and b of the tangential coefficients near an element, by closed forms, or by a closed form in one direction and Gauss-Legendre in
//! the other (see [`half_space`](super::half_space)).

use crate::influence::gauss_each;

/// The integrals a and b at an offset `kx, ky >= 0`, in elements, nearer than the series reaches.
pub fn near(kx: f64, ky: f64, dx: f64, dy: f64) -> (f64, f64) {
    if ky >= 2.0 {
        let [a, sum] = gauss_each(ky * dy, dy, |y| along(kx, dx, y));
        (a, sum - a)
    } else if kx >= 2.0 {
        let [b, sum] = gauss_each(kx * dx, dx, |x| along(ky, dy, x));
        (sum - b, b)
    } else {
        let (xp, xm, yp, ym) = ((kx + 0.5) * dx, (kx - 0.5) * dx, (ky + 0.5) * dy, (ky - 0.5) * dy);
        let f = |x: f64, y: f64| if x == 0.0 { 0.0 } else { x * (y / x.abs()).asinh() };
        let corners = |f: &dyn Fn(f64, f64) -> f64| f(xp, yp) - f(xp, ym) - f(xm, yp) + f(xm, ym);
        (corners(&f), corners(&|x, y| f(y, x)))
    }
}

/// The integrals over x of `y^2/r^3` and of `1/r`, on the interval of length d about k d, at the distance y. They are the differences of `x/r` and of
/// `asinh(x/y)` between the ends of the interval, computed without cancellation.
fn along(k: f64, d: f64, y: f64) -> [f64; 2] {
    let (plus, minus) = ((k + 0.5) * d, (k - 0.5) * d);
    // Lengths are of the order of 1, so that their squares are in range.
    let r = |x: f64| (x * x + y * y).sqrt();
    let rp = r(plus);
    if k == 0.0 {
        return [2.0 * (plus / rp), 2.0 * (plus / y).asinh()];
    }
    let rm = r(minus);
    if minus < 0.0 {
        return [plus / rp - minus / rm, (plus / y).asinh() - (minus / y).asinh()];
    }
    let squares = (plus + minus) * d;
    let sine = y * y * squares / (rp * rm * (plus * rm + minus * rp));
    [sine, ((d + squares / (rp + rm)) / (minus + rm)).ln_1p()]
}
