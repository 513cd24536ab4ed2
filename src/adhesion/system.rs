//! The linear system of a Newton step, for total pressures and the approach:
//!
//! ```text
//! in C       (A dp - da)/a0 = -e/a0
//! outside    dp - s (A dp - da) = -(p + sigma - s (e - eh))        with sigma and s at the distance eh
//! force      sum dp = F/(dx dy) - sum p
//! ```
//!
//! The preconditioner is `z = M (a0 y)` on C and `z = y/max(1 - s a0, 1/2)` outside. If the force is given, the approach is a further unknown
//! (the border), and `da = (sum z - y_F)/sum Y`, `z -= Y da`, with Y the preconditioned column of da.
//!
//! On large grids preconditioned vectors are not kept. The preconditioner is the same linear map for all search directions, so that it is applied
//! once to the sum of basis vectors that makes the solution. Products are kept while they are few.
//!
//! Vectors are stored in single precision ([`Short`]), because a linear solve ends at a tenth of its right-hand side. So are the s a0, which are
//! of order 1.

use super::level::Level;
use super::unknowns::{is_small, One};
use crate::error::Result;
use crate::methods::fgmres::{self, Bordered, Combination, Direction, Kept, System, Turned, Until};
use crate::methods::fields::{self, Fields};
use crate::threads::Threads;

/// The smallest diagonal of a row outside C in the preconditioner. The diagonal of the system is `1 - s a0`, which is 0 or less for elements that
/// snap alone.
const LEAST_DIAGONAL: f64 = 0.5;

/// The largest number of search directions whose products are kept on large grids. If there are more, one more product, of their sum, replaces
/// the kept ones. A basis of 22 vectors without products takes the memory of 11 vectors with them.
pub const KEPT_PRODUCTS: usize = 11;

/// One component per element, in single precision.
pub type Short = [f32; 1];

/// The linear system for the contact area of the level and a given slope s of the attraction.
pub struct Linearised<'a> {
    /// The grid with the current iterate.
    pub level: &'a mut Level,
    /// s a0; 0 on C.
    pub stiffness: &'a [Short],
    /// The influence of an element on itself.
    a0: f64,
    /// a0 Y if the force is given; empty otherwise.
    column: Vec<Short>,
    /// `1/sum(a0 Y)`; 0 without Y.
    inverse: f64,
}

impl<'a> Linearised<'a> {
    /// Sets up the system, with Y if the force is given (`by_force`).
    pub fn new(
        level: &'a mut Level,
        stiffness: &'a [Short],
        by_force: bool,
        fields: &mut Fields<1>,
    ) -> Result<Linearised<'a>> {
        let a0 = level.self_influence();
        let mut system = Linearised { level, stiffness, a0, column: Vec::new(), inverse: 0.0 };
        if by_force {
            let n = stiffness.len();
            let (mut column, mut preconditioned) = (fields.take_of(n)?, fields.take_of(n)?);
            fields::fill(&system.level.problem.threads, &mut column, |i| [system.column_at(i) as f32]);
            system.precondition_field(&column, &mut preconditioned);
            fields.give_of(column);
            let sum = system.sum(&preconditioned);
            (system.column, system.inverse) =
                (preconditioned, Some(1.0 / sum).filter(|inverse| inverse.is_finite()).unwrap_or(0.0));
        }
        Ok(system)
    }

    /// Element i of the system's column of da, times a0.
    pub fn column_at(&self, i: usize) -> f64 {
        if self.level.now.contact[i] {
            -1.0
        } else {
            f64::from(self.stiffness[i][0])
        }
    }

    /// Row i of the left-hand side for pressures y, at a fixed approach. `displaced` is the displacement of element i by all pressures, in units
    /// of a0.
    pub fn row(&self, i: usize, y: f64, displaced: f64) -> f64 {
        if self.level.now.contact[i] {
            displaced
        } else {
            y - f64::from(self.stiffness[i][0]) * displaced
        }
    }

    /// Gives the system's fields back to the pool `fields`.
    pub fn give(self, fields: &mut Fields<1>) {
        if !self.column.is_empty() {
            fields.give_of(self.column);
        }
    }

    /// Solves for the right-hand side `r`. Displacements are stored in units of a0, so that they are within the range of single precision for any
    /// units of the caller.
    pub fn solve(
        &mut self,
        r: Bordered<1>,
        until: (Until, f64),
        threads: &Threads,
        fields: &mut Fields<1>,
    ) -> Result<Combination<1, f32>> {
        let found = fgmres::solve(self, r, until, threads, fields)?;
        Ok(Combination { unit: self.a0, ..found })
    }

    /// Whether the force is given, so that the approach is an unknown.
    fn by_force(&self) -> bool {
        !self.column.is_empty()
    }

    /// The sum of a field.
    fn sum(&self, field: &[Short]) -> f64 {
        let [sum] = fields::sum(&self.level.problem.threads, field.len(), |i| field[i].map(f64::from));
        sum
    }

    /// Applies the preconditioner to a field, at a fixed approach.
    fn precondition_field(&mut self, y: &[Short], z: &mut [Short]) {
        self.level.precondition(y, z);
        let contact = &self.level.now.contact;
        fields::map(&self.level.problem.threads, z, |i, z| match contact[i] {
            true => z,
            false => [(f64::from(y[i][0]) / (1.0 - f64::from(self.stiffness[i][0])).max(LEAST_DIAGONAL)) as f32],
        });
    }

    /// Applies the preconditioner to a field and, if the force is given, its border.
    fn precondition(&mut self, r: &Bordered<1, f32>, fields: &mut Fields<1>) -> Result<Bordered<1, f32>> {
        let mut z = fields.take_of(r.field.len())?;
        self.precondition_field(&r.field, &mut z);
        if !self.by_force() {
            return Ok(Bordered { field: z, border: [0.0] });
        }
        let by = (self.sum(&z) - r.border[0]) * self.inverse;
        fields::add_all(&self.level.problem.threads, &mut z, &[(-by, &self.column)]);
        Ok(Bordered { field: z, border: [by * self.a0] })
    }

    /// Computes A z in double precision.
    fn displaced(&mut self, z: &[Short], fields: &mut Fields<1>) -> Result<Vec<One>> {
        let mut displaced = fields.take(z.len())?;
        let problem = &mut self.level.problem;
        fields::fill(&problem.threads, &mut displaced, |i| z[i].map(f64::from));
        problem.displace_in_place(displaced.as_flattened_mut())?;
        Ok(displaced)
    }
}

impl System<1, f32> for Linearised<'_> {
    fn direction(&mut self, v: &Bordered<1, f32>, fields: &mut Fields<1>) -> Result<Turned<1, f32>> {
        let z = self.precondition(v, fields)?;
        let n = z.field.len();
        let displaced = self.displaced(&z.field, fields)?;
        let (mut row, mut product) = (fields.take_of(n)?, fields.take_of(n)?);
        let (contact, a0, by) = (&self.level.now.contact, self.a0, z.border[0]);
        let (stiffness, field, threads) = (self.stiffness, &z.field, &self.level.problem.threads);
        fields::fill_both(threads, (&mut row, &mut product), |i| {
            let change = (displaced[i][0] - by) / a0;
            let outside = || f64::from(field[i][0]) - f64::from(stiffness[i][0]) * change;
            let row = if contact[i] { change } else { outside() };
            [[row as f32], [(displaced[i][0] / a0) as f32]]
        });
        fields.give(displaced);
        let border = if self.by_force() { [self.sum(&z.field)] } else { [0.0] };
        Ok((Direction { z, product }, Bordered { field: row, border }))
    }

    fn kept(&self) -> Kept {
        match is_small(self.stiffness.len()) {
            true => Kept::All,
            false => Kept::Products(KEPT_PRODUCTS),
        }
    }

    fn again(
        &mut self,
        v: &Bordered<1, f32>,
        is_multiplied: bool,
        fields: &mut Fields<1>,
    ) -> Result<Direction<1, f32>> {
        let z = self.precondition(v, fields)?;
        let mut product = Vec::new();
        if is_multiplied {
            product = fields.take_of(z.field.len())?;
            let (a0, displaced) = (self.a0, self.displaced(&z.field, fields)?);
            fields::fill(&self.level.problem.threads, &mut product, |i| [(displaced[i][0] / a0) as f32]);
            fields.give(displaced);
        }
        Ok(Direction { z, product })
    }
}
