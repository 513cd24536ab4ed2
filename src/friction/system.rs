//! The linear system of a Newton step, `H (z, dc) = (r, f)`, bordered by the creepages of given forces:
//!
//! ```text
//! (P A P + D) z + sum_k dc_k P e_k = r
//!                            sum z = f        for each direction k whose force is given
//! ```
//!
//! P and D are those of [`tangent`](super::tangent), and e_k is the slip by a unit creepage in direction k. With the preconditioner M of
//! [`Tangent::precondition`], the preconditioner of the bordered system is
//!
//! ```text
//! y = M r;    dc = S^-1 (sum y - f);    z = y - Y dc        Y_k = M P e_k,  S_jk = sum (Y_k)_j
//! ```

use super::forces::{sum_of, Forces};
use super::plane::{add, dot, plus, Vector};
use super::problem::Problem;
use super::tangent::Tangent;
use crate::error::Result;
use crate::methods::fgmres::{Bordered, Direction, System};
use crate::methods::fields::{self, Fields};
use crate::threads::Threads;

/// A matrix S is singular if its determinant is below this part of the square of its largest entry. Then eigenvalues below this part of the largest
/// one count as 0.
const SINGULAR: f64 = 1e-8;

/// The system with P and D of a prediction of stick and slip.
pub struct TangentSystem<'a> {
    pub problem: &'a mut Problem,
    pub tangent: &'a Tangent,
    pub border: Border,
    scratch: Vec<Vector>,
}

/// What the elimination of the border needs.
pub struct Border {
    forces: Forces,
    /// The columns of Y; empty for a direction without a given force.
    columns: [Vec<Vector>; 2],
    /// The rows of S.
    sums: [Vector; 2],
    /// The rows of the inverse of S.
    inverse: [Vector; 2],
}

impl Border {
    /// A border whose columns are still to be set by [`Border::set_column`].
    pub fn new(forces: Forces) -> Border {
        Border { forces, columns: [Vec::new(), Vec::new()], sums: [[0.0; 2]; 2], inverse: [[0.0; 2]; 2] }
    }

    /// The directions whose force is given, each with its unit creepage.
    pub fn directions(&self) -> impl Iterator<Item = (usize, Vector)> {
        let given = self.forces.given;
        [[1.0, 0.0], [0.0, 1.0]].into_iter().enumerate().filter(move |(k, _)| given[*k])
    }

    /// Sets the column of Y for direction k, and updates S and its inverse.
    pub fn set_column(&mut self, k: usize, column: Vec<Vector>, problem: &Problem) {
        let sum = self.forces.only_given(sum_of(problem, &column));
        (self.sums[0][k], self.sums[1][k]) = (sum[0], sum[1]);
        (self.inverse, self.columns[k]) = (inverse(self.sums), column);
    }

    /// Computes `dc = S^-1 excess`, where `excess` is the sum of y less f. Given creepages do not change: their dc is exactly 0.
    pub fn creepages(&self, excess: Vector) -> Vector {
        let excess = self.forces.only_given(excess);
        self.forces.only_given(self.inverse.map(|row| dot(row, excess)))
    }

    /// Subtracts Y dc from z.
    pub fn balance(&self, threads: &Threads, creepages: Vector, z: &mut [Vector]) {
        let columns = creepages.iter().zip(&self.columns).filter(|(_, y)| !y.is_empty());
        let terms: Vec<(f64, &[Vector])> = columns.map(|(c, y)| (-c, &y[..])).collect();
        fields::add_all(threads, z, &terms);
    }

    /// The sums of z in the directions with given forces; 0 in the others.
    pub fn sums_of(&self, problem: &Problem, z: &[Vector]) -> Vector {
        if self.forces.any() {
            self.forces.only_given(sum_of(problem, z))
        } else {
            [0.0; 2]
        }
    }

    /// Gives the memory of the columns back to `fields`.
    pub fn give(self, fields: &mut Fields) {
        self.columns.into_iter().filter(|field| !field.is_empty()).for_each(|field| fields.give(field));
    }
}

impl<'a> TangentSystem<'a> {
    /// Sets up the system, and computes Y and S.
    pub fn new(
        problem: &'a mut Problem,
        tangent: &'a Tangent,
        forces: Forces,
        fields: &mut Fields,
    ) -> Result<TangentSystem<'a>> {
        let n = problem.bound.len();
        let mut system = TangentSystem { problem, tangent, border: Border::new(forces), scratch: fields.take(n)? };
        for (k, e) in system.border.directions() {
            let mut unit = fields.take(n)?;
            let weighted = |i: usize| system.problem.weighted(i, e);
            fields::fill(system.problem.threads(), &mut unit, |i| tangent.project_inside(i, weighted(i)));
            let mut column = fields.take(n)?;
            system.precondition_field(&unit, &mut column);
            fields.give(unit);
            system.border.set_column(k, column, system.problem);
        }
        Ok(system)
    }

    /// Gives the memory of the system back to `fields`.
    pub fn give(self, fields: &mut Fields) {
        fields.give(self.scratch);
        self.border.give(fields);
    }

    /// Computes `z = M r`, which is 0 outside C.
    pub fn precondition_field(&mut self, r: &[Vector], z: &mut [Vector]) {
        // r is of the order of slips, not of rms_bound. The unit only keeps single precision in its range.
        let unit = self.problem.rms_bound();
        self.tangent.precondition(self.problem, r, unit, &mut self.scratch, z);
    }

    /// The preconditioner of the bordered system.
    fn precondition(&mut self, r: &Bordered, fields: &mut Fields) -> Result<Bordered> {
        let mut z = fields.take(r.field.len())?;
        self.precondition_field(&r.field, &mut z);
        let border = self.border.creepages(plus(self.border.sums_of(self.problem, &z), -1.0, r.border));
        self.border.balance(self.problem.threads(), border, &mut z);
        Ok(Bordered { field: z, border })
    }

    /// Computes `H z`. `product` is A times the field of z.
    fn apply(&self, z: &Bordered, product: &[Vector], fields: &mut Fields) -> Result<Bordered> {
        let tangent = self.tangent;
        let mut h = fields.take(product.len())?;
        fields::fill(self.problem.threads(), &mut h, |i| {
            let pushed = tangent.project_inside(i, add(product[i], self.problem.weighted(i, z.border)));
            plus(pushed, tangent.curvature[i], z.field[i])
        });
        let border = self.border.sums_of(self.problem, &z.field);
        Ok(Bordered { field: h, border })
    }

    /// Subtracts `H z` from r, for a system without border. `product` is A times the field of z.
    pub fn subtract(&self, z: &Bordered, product: &[Vector], r: &mut [Vector]) {
        let tangent = self.tangent;
        fields::map(self.problem.threads(), r, |i, r| {
            let left = plus(r, -1.0, tangent.project_inside(i, product[i]));
            plus(left, -tangent.curvature[i], z.field[i])
        });
    }

    /// Computes A times a field, in the precision of search directions.
    pub fn multiply(&mut self, field: &[Vector], product: &mut [Vector]) {
        let unit = self.problem.rms_bound();
        self.problem.operators.multiply_fast(field, unit, product);
    }
}

impl System for TangentSystem<'_> {
    fn direction(&mut self, v: &Bordered, fields: &mut Fields) -> Result<(Direction, Bordered)> {
        let z = self.precondition(v, fields)?;
        let mut product = fields.take(z.field.len())?;
        self.multiply(&z.field, &mut product);
        let h = self.apply(&z, &product, fields)?;
        Ok((Direction { z, product }, h))
    }
}

/// The inverse of a 2 x 2 matrix given by rows, symmetric or not. If it is singular, the pseudo-inverse of its symmetric part.
pub fn inverse(matrix: [Vector; 2]) -> [Vector; 2] {
    let [[a, b], [c, d]] = matrix;
    let (determinant, largest) = (a * d - b * c, [a, b, c, d].into_iter().fold(0.0, |most: f64, m| most.max(m.abs())));
    if determinant.abs() > SINGULAR * largest * largest {
        return [[d / determinant, -b / determinant], [-c / determinant, a / determinant]];
    }
    pseudo_inverse(matrix)
}

/// The pseudo-inverse of the symmetric part of a 2 x 2 matrix, by its eigenvectors. S is singular if all of C slips in one direction, or if only one
/// force is given.
fn pseudo_inverse([[a, b], [c, d]]: [Vector; 2]) -> [Vector; 2] {
    let off = 0.5 * (b + c);
    let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
    let radius = half.hypot(off);
    let angle = 0.5 * off.atan2(half);
    let largest = mean.abs() + radius;
    let mut inverse = [[0.0; 2]; 2];
    for (value, v) in [(mean + radius, [angle.cos(), angle.sin()]), (mean - radius, [-angle.sin(), angle.cos()])] {
        if value.abs() > SINGULAR * largest {
            for (i, row) in inverse.iter_mut().enumerate() {
                *row = [row[0] + v[i] * v[0] / value, row[1] + v[i] * v[1] / value];
            }
        }
    }
    inverse
}
