//! Flexible GMRES (Saad 1993), for a field of K numbers per element and a border of K numbers, right-preconditioned.
//! K is 2 if nothing else is said: tractions and creepages.
//!
//! `x = sum_j y_j z_j` with `z_j` the preconditioned vectors; the products of the z_j are kept, so that the product of x costs none.

use super::fields::{self as passes, dot_one as dot, plus, Fields};
use crate::error::Result;
use crate::threads::Threads;

/// A field, and a border: of friction tractions or slips, and creepages or forces; of adhesion pressures, and the approach or the force.
pub struct Bordered<const K: usize = 2> {
    pub field: Vec<[f64; K]>,
    pub border: [f64; K],
}

impl<const K: usize> Default for Bordered<K> {
    fn default() -> Bordered<K> {
        Bordered { field: Vec::new(), border: [0.0; K] }
    }
}

/// One direction: the preconditioned vector, and the product of its field with A.
#[derive(Default)]
pub struct Direction<const K: usize = 2> {
    pub z: Bordered<K>,
    pub product: Vec<[f64; K]>,
}

/// The system `H x = r`.
pub trait System<const K: usize = 2> {
    /// A preconditioned vector, its product with A, and `H` of it.
    fn direction(&mut self, v: &Bordered<K>, fields: &mut Fields<K>) -> Result<(Direction<K>, Bordered<K>)>;
}

/// The solution as a combination, `x = sum_j y_j z_j`.
#[derive(Default)]
pub struct Combination<const K: usize = 2> {
    pub directions: Vec<Direction<K>>,
    pub y: Vec<f64>,
    /// The norm of what is left of r, relative to that of r.
    pub left: f64,
}

/// The triangular system of the coefficients.
#[derive(Default)]
struct Triangle {
    columns: Vec<Vec<f64>>,
    rotations: Vec<(f64, f64)>,
    rest: Vec<f64>,
}

/// Until when.
#[derive(Clone, Copy, Debug)]
pub struct Until {
    /// The residual is at most this.
    pub target: f64,
    /// Or there are so many directions.
    pub most: usize,
}

/// Of the first residual: below that is the round-off of products, and directions of it are none.
const ROUND_OFF: f64 = 1e-10;

/// Solves `H x = r`; `weight`: of borders in the inner product.
pub fn solve<const K: usize>(
    system: &mut dyn System<K>,
    mut r: Bordered<K>,
    (Until { target, most }, weight): (Until, f64),
    threads: &Threads,
    fields: &mut Fields<K>,
) -> Result<Combination<K>> {
    let square = |v: &Bordered<K>| passes::dot(threads, &v.field, &v.field) + weight * dot(&v.border, &v.border);
    let first = square(&r).sqrt();
    let (mut norm, target) = (first, target.max(ROUND_OFF * first));
    let mut found = Combination { left: 1.0, ..Combination::default() };
    if !(norm > target) {
        fields.give(r.field);
        return Ok(found);
    }
    scale(threads, &mut r, 1.0 / norm);
    let mut basis = vec![r];
    let mut triangle = Triangle { rest: vec![norm], ..Triangle::default() };
    while found.directions.len() < most && norm > target {
        let (direction, mut w) = system.direction(&basis[basis.len() - 1], fields)?;
        let (column, left) = orthogonalise(threads, &mut w, &basis, weight);
        found.directions.push(direction);
        let is_sound = triangle.add(column, left);
        scale(threads, &mut w, if left > 0.0 { 1.0 / left } else { 1.0 });
        basis.push(w);
        if !is_sound {
            found.directions.pop().into_iter().for_each(|direction| direction.give(fields));
            break;
        }
        norm = triangle.rest[found.directions.len()].abs();
    }
    basis.into_iter().for_each(|v| fields.give(v.field));
    found.y = triangle.solve(found.directions.len());
    found.left = norm / first;
    Ok(found)
}

/// Takes from w what lies along the basis, as modified Gram and Schmidt do; returns the coefficients, and the norm of what is left.
fn orthogonalise<const K: usize>(
    threads: &Threads,
    w: &mut Bordered<K>,
    basis: &[Bordered<K>],
    weight: f64,
) -> (Vec<f64>, f64) {
    let mut column = Vec::with_capacity(basis.len() + 1);
    let mut along = passes::dot(threads, &w.field, &basis[0].field);
    for (j, v) in basis.iter().enumerate() {
        let h = along + weight * dot(&w.border, &v.border);
        w.border = plus(w.border, -h, v.border);
        along = match basis.get(j + 1) {
            Some(next) => passes::add_and_dot(threads, &mut w.field, -h, &v.field, &next.field),
            None => passes::add_and_square(threads, &mut w.field, -h, &v.field),
        };
        column.push(h);
    }
    (column, (along + weight * dot(&w.border, &w.border)).sqrt())
}

fn scale<const K: usize>(threads: &Threads, v: &mut Bordered<K>, a: f64) {
    passes::scale(threads, &mut v.field, a);
    v.border = v.border.map(|value| a * value);
}

impl<const K: usize> Direction<K> {
    /// Gives its fields back.
    pub fn give(self, fields: &mut Fields<K>) {
        fields.give(self.z.field);
        fields.give(self.product);
    }
}

impl<const K: usize> Combination<K> {
    /// Adds x to `to`, and the product of its field to `product`; gives the directions back.
    pub fn add_to(self, to: &mut Bordered<K>, product: &mut [[f64; K]], threads: &Threads, fields: &mut Fields<K>) {
        let Combination { directions, y, .. } = self;
        let of = |field: fn(&Direction<K>) -> &[[f64; K]]| -> Vec<(f64, &[[f64; K]])> {
            y.iter().zip(&directions).map(|(y, direction)| (*y, field(direction))).collect()
        };
        passes::add_all(threads, &mut to.field, &of(|direction| &direction.z.field));
        passes::add_all(threads, product, &of(|direction| &direction.product));
        for (y, direction) in y.iter().zip(&directions) {
            to.border = plus(to.border, *y, direction.z.border);
        }
        directions.into_iter().for_each(|direction| direction.give(fields));
    }
}

impl Triangle {
    /// Rotates a column into the triangle, `below` its element below the diagonal. False: it is no direction.
    fn add(&mut self, mut column: Vec<f64>, below: f64) -> bool {
        let k = column.len() - 1;
        for (i, &(c, s)) in self.rotations.iter().enumerate() {
            (column[i], column[i + 1]) = (c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]);
        }
        let diagonal = column[k].hypot(below);
        if !(diagonal > 0.0 && diagonal.is_finite()) {
            return false;
        }
        let (c, s) = (column[k] / diagonal, below / diagonal);
        column[k] = diagonal;
        self.rotations.push((c, s));
        self.columns.push(column);
        let last = self.rest[k];
        self.rest[k] = c * last;
        self.rest.push(-s * last);
        true
    }

    fn solve(&self, count: usize) -> Vec<f64> {
        let mut y = self.rest[..count].to_vec();
        for i in (0..count).rev() {
            y[i] /= self.columns[i][i];
            let value = y[i];
            (0..i).for_each(|j| y[j] -= self.columns[i][j] * value);
        }
        y
    }
}
