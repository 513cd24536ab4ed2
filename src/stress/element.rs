//! Stresses by a uniform load on one rectangular element, in closed form. They are used near the element.
//!
//! V is the integral of 1/R over the element; C and W are potentials with `C_z = V` and `W_z = C` (Johnson, Contact Mechanics, section 3.2).
//! Subscripts denote derivatives, and `h = 1 - 2 nu`. The stresses by a unit load are `1/(2 pi)` times
//!
//! ```text
//!       pressure                     traction in x
//! xx    2 nu V_z - h C_xx - z V_xx   2 (1 + nu) V_x + 2 nu W_xxx - z C_xxx
//! yy    2 nu V_z - h C_yy - z V_yy   2 nu V_x + 2 nu W_xyy - z C_xyy
//! zz    V_z - z V_zz                 -z V_xz
//! xy    -h C_xy - z V_xy             V_y + 2 nu W_xxy - z C_xxy
//! xz    -z V_xz                      V_z - z V_xx
//! yz    -z V_yz                      -z V_xy
//! ```
//!
//! Each derivative is the corner difference `f(X+, Y+) - f(X+, Y-) - f(X-, Y+) + f(X-, Y-)` of a function f, with `X+- = x +- dx/2` and `Y+- = y
//! +- dy/2`. With `R^2 = X^2 + Y^2 + z^2` the functions are
//!
//! ```text
//! V_x   ln(R + Y)        V_xx  X/(R (R + Y))    C_xx   atan2(X Y, X^2 + z^2 + z R)    C_xxy  X/(R (R + z))    W_xxy  -X/(R + z)
//! V_y   ln(R + X)        V_yy  Y/(R (R + X))    C_yy   atan2(X Y, Y^2 + z^2 + z R)    C_xyy  Y/(R (R + z))    W_xyy  -Y/(R + z)
//! V_z   -(C_xx + C_yy)   V_xz  z/(R (R + Y))    C_xy   ln(R + z)                      C_xxx  -(C_xyy + V_xz)
//! V_xy  1/R              V_yz  z/(R (R + X))    V_zz   -(V_xx + V_yy)                 W_xxx  -(W_xyy + V_x)
//! ```
//!
//! The difference of two logarithms is computed as the logarithm of a quotient, and `R + Y` as `(X^2 + z^2)/(R - Y)` for Y < 0, so that there is
//! no cancellation near the element. At z = 0 only the edges of the element are singular: stresses by tractions are infinite there.

use std::f64::consts::PI;

use super::body::{Body, Loaded};
use super::tensor::Tensor;

/// Two values, at the lower and at the upper edge of an element in one direction.
type Edges = [f64; 2];

/// The derivatives of the potentials V, C and W that the stresses contain, such as `vxz` for V_xz.
#[derive(Default)]
struct Potentials {
    vx: f64,
    vy: f64,
    cxx: f64,
    cyy: f64,
    cxy: f64,
    vxx: f64,
    vyy: f64,
    vxy: f64,
    vxz: f64,
    vyz: f64,
    cxxy: f64,
    cxyy: f64,
    wxxy: f64,
    wxyy: f64,
}

/// The stresses at the position `(x, y, z)` relative to the centre of an element `dx` by `dy`, by each unit load that is set in `loaded`.
pub fn stresses(body: &Body, loaded: Loaded, (x, y, z): (f64, f64, f64), (dx, dy): (f64, f64)) -> [Tensor; 3] {
    let edges = |x: f64, d: f64| [x - 0.5 * d, x + 0.5 * d];
    let f = potentials(edges(x, dx), edges(y, dy), z);
    let mut out = [[0.0; 6]; 3];
    let (nu, scale) = (body.poisson_ratio, 1.0 / (2.0 * PI));
    let h = 1.0 - 2.0 * nu;
    let vz = -(f.cxx + f.cyy);
    if loaded[0] {
        let normal = 2.0 * nu * vz;
        let xx = normal - h * f.cxx - z * f.vxx;
        let yy = normal - h * f.cyy - z * f.vyy;
        let zz = vz + z * (f.vxx + f.vyy);
        out[0] = [xx, yy, zz, -h * f.cxy - z * f.vxy, -z * f.vxz, -z * f.vyz].map(|value| scale * value);
    }
    if loaded[1] {
        let (wxxx, cxxx) = (-(f.wxyy + f.vx), -(f.cxyy + f.vxz));
        let xx = 2.0 * (1.0 + nu) * f.vx + 2.0 * nu * wxxx - z * cxxx;
        let yy = 2.0 * nu * (f.vx + f.wxyy) - z * f.cxyy;
        let xy = f.vy + 2.0 * nu * f.wxxy - z * f.cxxy;
        out[1] = [xx, yy, -z * f.vxz, xy, vz - z * f.vxx, -z * f.vxy].map(|value| scale * value);
    }
    if loaded[2] {
        let (wyyy, cyyy) = (-(f.wxxy + f.vy), -(f.cxxy + f.vyz));
        let yy = 2.0 * (1.0 + nu) * f.vy + 2.0 * nu * wyyy - z * cyyy;
        let xx = 2.0 * nu * (f.vy + f.wxxy) - z * f.cxxy;
        let xy = f.vx + 2.0 * nu * f.wxyy - z * f.cxyy;
        out[2] = [xx, yy, -z * f.vyz, xy, -z * f.vxy, vz - z * f.vyy].map(|value| scale * value);
    }
    out
}

/// The derivatives of the potentials. `x` and `y` have the position relative to the edges.
fn potentials(x: Edges, y: Edges, z: f64) -> Potentials {
    let r = |i: usize, j: usize| x[i].hypot(y[j]).hypot(z);
    let r = [[r(0, 0), r(0, 1)], [r(1, 0), r(1, 1)]];
    let mut f = Potentials {
        vx: log_difference(y, r[1], x[1] * x[1] + z * z) - log_difference(y, r[0], x[0] * x[0] + z * z),
        vy: log_difference(x, [r[0][1], r[1][1]], y[1] * y[1] + z * z)
            - log_difference(x, [r[0][0], r[1][0]], y[0] * y[0] + z * z),
        cxy: (((r[1][1] + z) / (r[1][0] + z)) * ((r[0][0] + z) / (r[0][1] + z))).ln(),
        ..Potentials::default()
    };
    for (i, j, sign) in [(1, 1, 1.0), (1, 0, -1.0), (0, 1, -1.0), (0, 0, 1.0)] {
        let (x, y, r) = (x[i], y[j], r[i][j]);
        let (x2, y2, z2) = (x * x, y * y, z * z);
        f.cxx += sign * (x * y).atan2(x2 + z2 + z * r);
        f.cyy += sign * (x * y).atan2(y2 + z2 + z * r);
        let over = sign / (r + z);
        f.wxxy -= x * over;
        f.wxyy -= y * over;
        // In the stresses, all other derivatives are multiplied by z.
        if z > 0.0 {
            let over_r = sign / r;
            let (to_y, to_x) = (over_r * inverse_of_sum(r, y, x2 + z2), over_r * inverse_of_sum(r, x, y2 + z2));
            f.vxx += x * to_y;
            f.vxz += z * to_y;
            f.vyy += y * to_x;
            f.vyz += z * to_x;
            f.vxy += over_r;
            f.cxxy += x * over / r;
            f.cxyy += y * over / r;
        }
    }
    f
}

/// `ln(R+ + a+) - ln(R- + a-)` for the coordinates a at both edges and their R. `rest = R^2 - a^2` is the same at both edges.
fn log_difference([minus, plus]: Edges, [r_minus, r_plus]: Edges, rest: f64) -> f64 {
    if minus >= 0.0 {
        ((r_plus + plus) / (r_minus + minus)).ln()
    } else if plus <= 0.0 {
        ((r_minus - minus) / (r_plus - plus)).ln()
    } else {
        (r_plus + plus).ln() + ((r_minus - minus) / rest).ln()
    }
}

/// `1/(R + a)` without cancellation. `rest` is `R^2 - a^2`.
fn inverse_of_sum(r: f64, a: f64, rest: f64) -> f64 {
    if a >= 0.0 {
        1.0 / (r + a)
    } else {
        (r - a) / rest
    }
}
