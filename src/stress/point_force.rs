//! Stresses by concentrated forces on the surface of a half-space (Boussinesq, Cerruti; Johnson, Contact Mechanics, eqs. 3.18 and 3.76).
//!
//! At the position (x, y, z) relative to the force, with R its length, `(l, m, n) = (x, y, z)/R`, `w = 1/(1 + n)` and `h = 1 - 2 nu`, the
//! stresses by a unit force are `1/(2 pi R^2)` times
//!
//! ```text
//!       force by pressure (into the body)         force in x
//! xx    h (n - w + l^2 (2 + n) w^2) - 3 l^2 n      h (l - 3 l w^2 + l^3 (3 + n) w^3) - 3 l^3
//! yy    h (n - w + m^2 (2 + n) w^2) - 3 m^2 n      h (l - l w^2 + l m^2 (3 + n) w^3) - 3 l m^2
//! zz    -3 n^3                                     -3 l n^2
//! xy    h l m (2 + n) w^2 - 3 l m n                h (-m w^2 + l^2 m (3 + n) w^3) - 3 l^2 m
//! xz    -3 l n^2                                   -3 l^2 n
//! yz    -3 m n^2                                   -3 l m n
//! ```
//!
//! A force in y has the stresses of one in x, with x and y exchanged. The formulas contain direction cosines only, so that nothing overflows at
//! any distance.

use super::body::{Body, Loaded};
use crate::blocks::LANES;

/// One value for each of several positions.
pub type Lanes = [f64; LANES];

/// Stresses `[load][component][position]`.
pub type Values = [[Lanes; 6]; 3];

/// Adds to `sum` the stresses by a force of size `force` for each load in `loaded`. The positions relative to the force have the given x, and one
/// y and z.
pub fn add(body: &Body, loaded: Loaded, position: (&Lanes, f64, f64), force: f64, sum: &mut Values) {
    pulp::Arch::new().dispatch(Add { nu: body.poisson_ratio, loaded, position, force, sum });
}

/// The work of [`add`], which pulp compiles for the vector instructions of the machine.
struct Add<'a> {
    nu: f64,
    loaded: Loaded,
    position: (&'a Lanes, f64, f64),
    force: f64,
    sum: &'a mut Values,
}

impl pulp::NullaryFnOnce for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Add { nu, loaded, position: (x, y, z), force, sum } = self;
        let h = 1.0 - 2.0 * nu;
        let scale = force / (2.0 * std::f64::consts::PI);
        let [mut l, mut m, mut n, mut w, mut s] = [[0.0; LANES]; 5];
        for i in 0..LANES {
            let inverse = 1.0 / (x[i] * x[i] + y * y + z * z).sqrt();
            (l[i], m[i], n[i]) = (x[i] * inverse, y * inverse, z * inverse);
            w[i] = 1.0 / (1.0 + n[i]);
            s[i] = scale * inverse * inverse;
        }
        if loaded[0] {
            for i in 0..LANES {
                let (l, m, n, w, s) = (l[i], m[i], n[i], w[i], s[i]);
                let g = (2.0 + n) * w * w;
                let out = &mut sum[0];
                out[0][i] += s * (h * (n - w + l * l * g) - 3.0 * l * l * n);
                out[1][i] += s * (h * (n - w + m * m * g) - 3.0 * m * m * n);
                out[2][i] += s * (-3.0 * n * n * n);
                out[3][i] += s * (l * m * (h * g - 3.0 * n));
                out[4][i] += s * (-3.0 * l * n * n);
                out[5][i] += s * (-3.0 * m * n * n);
            }
        }
        if loaded[1] {
            in_x(h, (&l, &m, &n, &w, &s), [0, 1, 2, 3, 4, 5], &mut sum[1]);
        }
        if loaded[2] {
            in_x(h, (&m, &l, &n, &w, &s), [1, 0, 2, 3, 5, 4], &mut sum[2]);
        }
    }
}

/// Adds the stresses by a force along the first of two lateral directions, with the direction cosines l, m. `index` has the index in `out` of
/// each component.
#[inline(always)]
fn in_x(h: f64, (l, m, n, w, s): (&Lanes, &Lanes, &Lanes, &Lanes, &Lanes), index: [usize; 6], out: &mut [Lanes; 6]) {
    for i in 0..LANES {
        let (l, m, n, w, s) = (l[i], m[i], n[i], w[i], s[i]);
        let w2 = w * w;
        let g = (3.0 + n) * w2 * w;
        out[index[0]][i] += s * l * (h * (1.0 - 3.0 * w2 + l * l * g) - 3.0 * l * l);
        out[index[1]][i] += s * l * (h * (1.0 - w2 + m * m * g) - 3.0 * m * m);
        out[index[2]][i] += s * (-3.0 * l * n * n);
        out[index[3]][i] += s * m * (h * (l * l * g - w2) - 3.0 * l * l);
        out[index[4]][i] += s * (-3.0 * l * l * n);
        out[index[5]][i] += s * (-3.0 * l * m * n);
    }
}
