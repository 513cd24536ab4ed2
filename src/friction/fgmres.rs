//! Flexible GMRES (Saad 1993), for a field and a border of two numbers, right-preconditioned.
//!
//! `x = sum_j y_j z_j` with `z_j` the preconditioned vectors; the products of the z_j are kept, so that the product of x costs none.

use super::problem::{dot, plus};
use super::Vector;

/// A field of tractions or slips, and a border: creepages or forces.
#[derive(Clone)]
pub struct Bordered {
    pub field: Vec<Vector>,
    pub border: Vector,
}

impl Bordered {
    /// Zeros.
    pub fn zeros(n: usize) -> Bordered {
        Bordered { field: vec![[0.0; 2]; n], border: [0.0; 2] }
    }

    /// `self + a other`.
    pub fn add(&mut self, a: f64, other: &Bordered) {
        self.field.iter_mut().zip(&other.field).for_each(|(to, from)| *to = plus(*to, a, *from));
        self.border = plus(self.border, a, other.border);
    }

    /// `self . other`; borders weigh `weight`.
    pub fn dot(&self, other: &Bordered, weight: f64) -> f64 {
        let sum: f64 = self.field.iter().zip(&other.field).map(|(v, w)| dot(*v, *w)).sum();
        sum + weight * dot(self.border, other.border)
    }

    fn scale(&mut self, a: f64) {
        self.field.iter_mut().for_each(|v| *v = [a * v[0], a * v[1]]);
        self.border = [a * self.border[0], a * self.border[1]];
    }
}

/// One direction: the preconditioned vector, and the product of its field with A.
pub struct Direction {
    pub z: Bordered,
    pub product: Vec<Vector>,
}

/// What is solved: `H x = r`.
pub trait System {
    /// A preconditioned vector, its product with A, and `H` of it.
    fn direction(&mut self, v: &Bordered) -> (Direction, Bordered);
}

/// Directions at most.
const MOST: usize = 40;

/// Solves `H x = r` until the residual is at most `target`. Returns the directions and their coefficients; `weight`: of borders in the
/// inner product.
pub fn solve(system: &mut dyn System, r: Bordered, target: f64, weight: f64) -> (Vec<Direction>, Vec<f64>) {
    let mut norm = r.dot(&r, weight).sqrt();
    let (mut directions, mut basis): (Vec<Direction>, Vec<Bordered>) = (Vec::new(), vec![r]);
    // Upper triangle column by column, rotations, and the right-hand side.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut rotations: Vec<(f64, f64)> = Vec::new();
    let mut rest = vec![norm];
    if !(norm > target) {
        return (directions, Vec::new());
    }
    basis[0].scale(1.0 / norm);
    while directions.len() < MOST && norm > target {
        let k = directions.len();
        let (direction, mut w) = system.direction(&basis[k]);
        let mut column = Vec::with_capacity(k + 2);
        for v in &basis {
            let h = w.dot(v, weight);
            w.add(-h, v);
            column.push(h);
        }
        let left = w.dot(&w, weight).sqrt();
        for (i, &(c, s)) in rotations.iter().enumerate() {
            (column[i], column[i + 1]) = (c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]);
        }
        let diagonal = column[k].hypot(left);
        if !(diagonal > 0.0 && diagonal.is_finite()) {
            break;
        }
        let (c, s) = (column[k] / diagonal, left / diagonal);
        column[k] = diagonal;
        rotations.push((c, s));
        columns.push(column);
        directions.push(direction);
        let last = rest[k];
        rest[k] = c * last;
        rest.push(-s * last);
        norm = rest[k + 1].abs();
        if left > 0.0 {
            w.scale(1.0 / left);
        }
        basis.push(w);
    }
    let count = directions.len();
    let mut y = rest[..count].to_vec();
    for i in (0..count).rev() {
        y[i] /= columns[i][i];
        let value = y[i];
        (0..i).for_each(|j| y[j] -= columns[i][j] * value);
    }
    (directions, y)
}
