//! Flexible GMRES (Saad 1993), for a field of K numbers per element and a border of K numbers, right-preconditioned.
//! K is 2 if nothing else is said: tractions and creepages.
//!
//! `x = sum_j y_j z_j` with `z_j` the preconditioned vectors; the products of the z_j are kept, so that the product of x costs none.
//!
//! Vectors and their products are stored in the precision T, double if nothing else is said; sums and borders are always double. x and its product
//! belong to each other to the precision T, and x is a step: what a step leaves wrong is a part of the step, and the steps become small.

use super::fields::{self as passes, dot_one as dot, plus, Fields, Stored};
use crate::error::Result;
use crate::threads::Threads;

/// A field, and a border: of friction tractions or slips, and creepages or forces; of adhesion pressures, and the approach or the force.
pub struct Bordered<const K: usize = 2, T = f64> {
    pub field: Vec<[T; K]>,
    pub border: [f64; K],
}

impl<const K: usize, T> Default for Bordered<K, T> {
    fn default() -> Bordered<K, T> {
        Bordered { field: Vec::new(), border: [0.0; K] }
    }
}

/// One direction: the preconditioned vector, and the product of its field with A.
#[derive(Default)]
pub struct Direction<const K: usize = 2, T = f64> {
    pub z: Bordered<K, T>,
    pub product: Vec<[T; K]>,
}

/// A direction, and `H` of it.
pub type Turned<const K: usize, T> = (Direction<K, T>, Bordered<K, T>);

/// The system `H x = r`.
pub trait System<const K: usize = 2, T = f64> {
    /// A preconditioned vector, its product with A, and `H` of it.
    fn direction(&mut self, v: &Bordered<K, T>, fields: &mut Fields<K>) -> Result<Turned<K, T>>;
}

/// The solution as a combination, `x = sum_j y_j z_j`.
pub struct Combination<const K: usize = 2, T = f64> {
    pub directions: Vec<Direction<K, T>>,
    pub y: Vec<f64>,
    /// Products are stored in this unit.
    pub unit: f64,
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

/// Solves `H x = r`; `weight`: of borders in the inner product.
pub fn solve<const K: usize, T: Stored>(
    system: &mut dyn System<K, T>,
    r: Bordered<K>,
    (Until { target, most }, weight): (Until, f64),
    threads: &Threads,
    fields: &mut Fields<K>,
) -> Result<Combination<K, T>> {
    let first = (passes::dot(threads, &r.field, &r.field) + weight * dot(&r.border, &r.border)).sqrt();
    let (mut norm, target) = (first, target.max(T::ROUND_OFF * first));
    let mut found = Combination { directions: Vec::new(), y: Vec::new(), unit: 1.0, left: 1.0 };
    if !(norm > target) {
        fields.give(r.field);
        return Ok(found);
    }
    let field = T::stored(threads, r.field, 1.0 / norm, fields)?;
    let mut basis = vec![Bordered { field, border: r.border.map(|value| 1.0 / norm * value) }];
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
    basis.into_iter().for_each(|v| fields.give_of(v.field));
    found.y = triangle.solve(found.directions.len());
    found.left = norm / first;
    Ok(found)
}

/// Takes from w what lies along the basis, as modified Gram and Schmidt do; returns the coefficients, and the norm of what is left.
fn orthogonalise<const K: usize, T: Stored>(
    threads: &Threads,
    w: &mut Bordered<K, T>,
    basis: &[Bordered<K, T>],
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

fn scale<const K: usize, T: Stored>(threads: &Threads, v: &mut Bordered<K, T>, a: f64) {
    passes::scale(threads, &mut v.field, a);
    v.border = v.border.map(|value| a * value);
}

impl<const K: usize, T: Stored> Direction<K, T> {
    /// Gives its fields back.
    pub fn give(self, fields: &mut Fields<K>) {
        fields.give_of(self.z.field);
        fields.give_of(self.product);
    }
}

impl<const K: usize, T: Stored> Combination<K, T> {
    /// Adds x to `to`, and the product of its field to `product`; gives the directions back.
    pub fn add_to(self, to: &mut Bordered<K>, product: &mut [[f64; K]], threads: &Threads, fields: &mut Fields<K>) {
        let Combination { directions, y, unit, .. } = self;
        let terms = || y.iter().copied().zip(&directions);
        let of_z: Vec<(f64, &[[T; K]])> = terms().map(|(y, direction)| (y, &direction.z.field[..])).collect();
        let of_product: Vec<(f64, &[[T; K]])> =
            terms().map(|(y, direction)| (unit * y, &direction.product[..])).collect();
        passes::add_all(threads, &mut to.field, &of_z);
        passes::add_all(threads, product, &of_product);
        for (y, direction) in terms() {
            to.border = plus(to.border, y, direction.z.border);
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
