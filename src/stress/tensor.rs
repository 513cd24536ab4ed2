//! Results from one stress tensor: the von Mises stress, the principal stresses and their directions, the largest shear stress.

/// A stress tensor: its six components in the order xx, yy, zz, xy, xz, yz, positive in tension.
pub type Tensor = [f64; 6];

/// The largest number of sweeps of Jacobi's method. It converges quadratically, and six sweeps reach round-off.
const SWEEPS: usize = 12;

/// The principal stresses and their directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principal {
    /// The principal stresses, the largest first.
    pub stresses: [f64; 3],
    /// Unit vectors: `directions[k]` is the direction of `stresses[k]`.
    pub directions: [[f64; 3]; 3],
}

impl Principal {
    /// The largest shear stress: half the difference of the largest and the smallest principal stress.
    pub fn maximum_shear(&self) -> f64 {
        0.5 * (self.stresses[0] - self.stresses[2])
    }
}

/// The von Mises stress `sqrt(((xx - yy)^2 + (yy - zz)^2 + (zz - xx)^2)/2 + 3 (xy^2 + xz^2 + yz^2))`.
pub fn von_mises([xx, yy, zz, xy, xz, yz]: Tensor) -> f64 {
    let scale = largest(&[xx, yy, zz, xy, xz, yz]);
    if scale == 0.0 {
        return 0.0;
    }
    let square = |value: f64| (value / scale) * (value / scale);
    let normal = square(xx - yy) + square(yy - zz) + square(zz - xx);
    scale * (0.5 * normal + 3.0 * (square(xy) + square(xz) + square(yz))).sqrt()
}

/// Computes the principal stresses and directions by Jacobi's cyclic rotations (Golub & Van Loan, section 8.5), which are accurate also for
/// nearly equal stresses.
pub fn principal(tensor: Tensor) -> Principal {
    let scale = largest(&tensor);
    let [xx, yy, zz, xy, xz, yz] = if scale > 0.0 { tensor.map(|value| value / scale) } else { tensor };
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        if a[0][1] == 0.0 && a[0][2] == 0.0 && a[1][2] == 0.0 {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, &mut v, p, q);
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a[j][j].total_cmp(&a[i][i]));
    Principal {
        stresses: order.map(|k| a[k][k] * if scale > 0.0 { scale } else { 1.0 }),
        directions: order.map(|k| [v[0][k], v[1][k], v[2][k]]),
    }
}

/// Rotates the matrix `a` by the angle that makes `a[p][q]` zero, and the columns of `v` with it.
fn rotate(a: &mut [[f64; 3]; 3], v: &mut [[f64; 3]; 3], p: usize, q: usize) {
    let off = a[p][q];
    // The element is too small to change the diagonal.
    if off.abs() <= 0.25 * f64::EPSILON * f64::min(a[p][p].abs(), a[q][q].abs()) || off == 0.0 {
        (a[p][q], a[q][p]) = (0.0, 0.0);
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * off);
    let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    let s = t * c;
    let r = 3 - p - q;
    a[p][p] -= t * off;
    a[q][q] += t * off;
    (a[p][q], a[q][p]) = (0.0, 0.0);
    let (rp, rq) = (a[r][p], a[r][q]);
    (a[r][p], a[r][q]) = (c * rp - s * rq, s * rp + c * rq);
    (a[p][r], a[q][r]) = (a[r][p], a[r][q]);
    for row in v {
        (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
    }
}

/// The largest absolute value.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| f64::max(largest, value.abs()))
}
