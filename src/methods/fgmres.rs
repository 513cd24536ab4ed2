//! Flexible GMRES (Saad 1993) with right preconditioning, for a system `H x = r`. The unknown x consists of a *field* of K numbers per element and a
//! *border* of K numbers. K is 2 by default: tractions and creepages.
//!
//! Let `v_j` be the orthonormal basis, and `z_j = M v_j` the vectors preconditioned by M. The solution is `x = sum_j y_j z_j`.
//!
//! - The products `A z_j` are kept, so that the product A x costs no further one.
//! - If M is the same linear map for all j, the z_j need not be kept: `x = M sum_j y_j v_j`.
//! - With many vectors the products need not be kept either, because A x takes one product only. Then each v_j takes a third of the memory
//!   ([`Kept`]).
//!
//! Vectors and their products are stored in the precision T, double by default. Sums and borders are always double. x and A x are consistent to the
//! precision T. This error is relative to x, which is a Newton step and becomes small.

use super::fields::{self as passes, dot_one as dot, plus, Fields, Stored};
use crate::error::Result;
use crate::threads::Threads;

/// A field and a border. In friction the field holds tractions or slips, and the border creepages or forces. In adhesion the field holds pressures,
/// and the border the approach or the force.
pub struct Bordered<const K: usize = 2, T = f64> {
    pub field: Vec<[T; K]>,
    pub border: [f64; K],
}

impl<const K: usize, T> Default for Bordered<K, T> {
    fn default() -> Bordered<K, T> {
        Bordered { field: Vec::new(), border: [0.0; K] }
    }
}

/// A preconditioned vector z, and the product of A with its field.
#[derive(Default)]
pub struct Direction<const K: usize = 2, T = f64> {
    pub z: Bordered<K, T>,
    pub product: Vec<[T; K]>,
}

/// A direction z, and `H z`.
pub type Turned<const K: usize, T> = (Direction<K, T>, Bordered<K, T>);

/// Which fields are kept for each direction, in addition to the basis vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    /// Preconditioned vectors and their products.
    All,
    /// The products alone, if there are at most this number of directions; otherwise none.
    Products(usize),
}

/// The system `H x = r`.
pub trait System<const K: usize = 2, T: Stored = f64> {
    /// Computes the preconditioned vector `z = M v`, the product of A with its field, and `H z`.
    fn direction(&mut self, v: &Bordered<K, T>, fields: &mut Fields<K>) -> Result<Turned<K, T>>;

    /// Which fields are kept. A system may keep fewer than all if its preconditioner is the same linear map for each direction.
    fn kept(&self) -> Kept {
        Kept::All
    }

    /// Computes the preconditioned vector `M v`, and its product with A only if `is_multiplied`.
    fn again(&mut self, v: &Bordered<K, T>, is_multiplied: bool, fields: &mut Fields<K>) -> Result<Direction<K, T>> {
        let (mut direction, row) = self.direction(v, fields)?;
        fields.give_of(row.field);
        if !is_multiplied {
            fields.give_of(std::mem::take(&mut direction.product));
        }
        Ok(direction)
    }
}

/// The solution x and its product, as linear combinations of stored fields.
pub struct Combination<const K: usize = 2, T = f64> {
    /// x is the sum of these vectors times their factors.
    pub vectors: Vec<(f64, Bordered<K, T>)>,
    /// The product of A with the field of x is `unit` times the sum of these fields times their factors.
    pub products: Vec<(f64, Vec<[T; K]>)>,
    /// The unit in which `products` are stored.
    pub unit: f64,
    /// The norm of the residual, relative to the norm of r.
    pub left: f64,
    /// The number of directions.
    pub count: usize,
}

/// The triangular system for the factors y.
#[derive(Default)]
struct Triangle {
    /// The columns of the Hessenberg matrix after Givens rotations, which make it upper triangular.
    columns: Vec<Vec<f64>>,
    /// Cosine and sine of each rotation.
    rotations: Vec<(f64, f64)>,
    /// The right-hand side after the rotations. Its last value is the norm of the residual, up to the sign.
    right: Vec<f64>,
}

/// The stopping criteria.
#[derive(Clone, Copy, Debug)]
pub struct Until {
    /// The norm of the residual at which the solve stops.
    pub target: f64,
    /// The largest number of directions.
    pub most: usize,
}

/// Solves `H x = r`. In the inner product, borders have the weight `weight` relative to fields.
pub fn solve<const K: usize, T: Stored>(
    system: &mut dyn System<K, T>,
    r: Bordered<K>,
    (Until { target, most }, weight): (Until, f64),
    threads: &Threads,
    fields: &mut Fields<K>,
) -> Result<Combination<K, T>> {
    let first = (passes::dot(threads, &r.field, &r.field) + weight * dot(&r.border, &r.border)).sqrt();
    let (mut norm, target) = (first, target.max(T::ROUND_OFF * first));
    if !(norm > target) {
        fields.give(r.field);
        return Ok(Combination { vectors: Vec::new(), products: Vec::new(), unit: 1.0, left: 1.0, count: 0 });
    }
    let field = T::stored(threads, r.field, 1.0 / norm, fields)?;
    let mut basis = vec![Bordered { field, border: r.border.map(|value| 1.0 / norm * value) }];
    let mut triangle = Triangle { right: vec![norm], ..Triangle::default() };
    let (kept, mut directions) = (system.kept(), Vec::new());
    while triangle.columns.len() < most && norm > target {
        let (direction, mut w) = system.direction(&basis[basis.len() - 1], fields)?;
        let (column, left) = orthogonalise(threads, &mut w, &basis, weight);
        directions.push(direction);
        kept.forget(&mut directions, fields);
        let is_sound = triangle.add(column, left);
        scale(threads, &mut w, if left > 0.0 { 1.0 / left } else { 1.0 });
        basis.push(w);
        if !is_sound {
            directions.pop().into_iter().for_each(|direction| direction.give(fields));
            break;
        }
        norm = triangle.right[triangle.columns.len()].abs();
    }
    let y = triangle.solve();
    let found = match kept {
        Kept::All => Combination::of(directions, &y),
        Kept::Products(_) => again(system, &basis, (directions, &y), threads, fields)?,
    };
    basis.into_iter().for_each(|v| fields.give_of(v.field));
    Ok(Combination { left: norm / first, ..found })
}

impl Kept {
    /// Returns the fields that are not kept to the pool. Called after each new direction, which is the last of `directions`.
    fn forget<const K: usize, T: Stored>(self, directions: &mut [Direction<K, T>], fields: &mut Fields<K>) {
        let Kept::Products(most) = self else { return };
        let count = directions.len();
        if let Some(last) = directions.last_mut() {
            fields.give_of(std::mem::take(&mut last.z.field));
        }
        if count > most {
            let products = directions.iter_mut().map(|direction| std::mem::take(&mut direction.product));
            products.filter(|product| !product.is_empty()).for_each(|product| fields.give_of(product));
        }
    }
}

/// Computes the solution from the basis: by one more application of the preconditioner, and by one more product if products are not kept.
fn again<const K: usize, T: Stored>(
    system: &mut dyn System<K, T>,
    basis: &[Bordered<K, T>],
    (directions, y): (Vec<Direction<K, T>>, &[f64]),
    threads: &Threads,
    fields: &mut Fields<K>,
) -> Result<Combination<K, T>> {
    let mut sum = Bordered { field: fields.zeros(basis[0].field.len(), threads)?, border: [0.0; K] };
    let terms: Vec<(f64, &[[T; K]])> = y.iter().zip(basis).map(|(y, v)| (*y, &v.field[..])).collect();
    passes::add_all(threads, &mut sum.field, &terms);
    sum.border = y.iter().zip(basis).fold(sum.border, |sum, (y, v)| plus(sum, *y, v.border));
    let is_kept = directions.iter().all(|direction| !direction.product.is_empty());
    let Direction { z, product } = system.again(&sum, !is_kept, fields)?;
    fields.give_of(sum.field);
    let products = match is_kept {
        true => y.iter().copied().zip(directions.into_iter().map(|direction| direction.product)).collect(),
        false => vec![(1.0, product)],
    };
    Ok(Combination { vectors: vec![(1.0, z)], products, unit: 1.0, left: 1.0, count: y.len() })
}

/// Orthogonalises w against the basis by the modified Gram-Schmidt method. Returns the coefficients, and the norm of what is left of w.
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
        let next = basis.get(j + 1).map(|next| &next.field[..]);
        along = passes::add_and_dot(threads, &mut w.field, -h, &v.field, next);
        column.push(h);
    }
    (column, (along + weight * dot(&w.border, &w.border)).sqrt())
}

/// Multiplies field and border by a.
fn scale<const K: usize, T: Stored>(threads: &Threads, v: &mut Bordered<K, T>, a: f64) {
    passes::scale(threads, &mut v.field, a);
    v.border = v.border.map(|value| a * value);
}

impl<const K: usize, T: Stored> Direction<K, T> {
    /// Returns the fields to the pool.
    fn give(self, fields: &mut Fields<K>) {
        [self.z.field, self.product]
            .into_iter()
            .filter(|field| !field.is_empty())
            .for_each(|field| fields.give_of(field));
    }
}

impl<const K: usize, T: Stored> Combination<K, T> {
    /// The linear combination of the directions with the factors y.
    fn of(directions: Vec<Direction<K, T>>, y: &[f64]) -> Combination<K, T> {
        let (vectors, products) =
            directions.into_iter().zip(y).map(|(direction, y)| ((*y, direction.z), (*y, direction.product))).unzip();
        Combination { vectors, products, unit: 1.0, left: 1.0, count: y.len() }
    }

    /// Adds x to `to`, and the product of A with the field of x to `product`. The fields go back to the pool.
    pub fn add_to<S: Stored>(
        self,
        to: &mut Bordered<K, S>,
        product: &mut [[S; K]],
        threads: &Threads,
        fields: &mut Fields<K>,
    ) {
        let Combination { vectors, products, unit, .. } = self;
        let of_x: Vec<(f64, &[[T; K]])> = vectors.iter().map(|(y, z)| (*y, &z.field[..])).collect();
        let of_product: Vec<(f64, &[[T; K]])> = products.iter().map(|(y, product)| (unit * y, &product[..])).collect();
        passes::add_all(threads, &mut to.field, &of_x);
        passes::add_all(threads, product, &of_product);
        to.border = vectors.iter().fold(to.border, |to, (y, z)| plus(to, *y, z.border));
        let fields_of_x = vectors.into_iter().map(|(_, z)| z.field);
        fields_of_x.chain(products.into_iter().map(|(_, product)| product)).for_each(|field| fields.give_of(field));
    }
}

impl Triangle {
    /// Adds a column of the Hessenberg matrix, whose element below the diagonal is `below`, by rotations. Returns false, and adds nothing, if the
    /// triangle would become singular or a value is not finite.
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
        let last = self.right[k];
        self.right[k] = c * last;
        self.right.push(-s * last);
        true
    }

    /// Computes the factors y by back substitution.
    fn solve(&self) -> Vec<f64> {
        let mut y = self.right[..self.columns.len()].to_vec();
        for i in (0..y.len()).rev() {
            y[i] /= self.columns[i][i];
            let value = y[i];
            (0..i).for_each(|j| y[j] -= self.columns[i][j] * value);
        }
        y
    }
}
