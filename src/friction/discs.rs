//! The fields of projected gradients on discs, on C alone, and the passes over them.
//!
//! Tractions are divided by a power of two near min(rms g, rms w/a0), displacements by this number times a power of two near a0. So both are near 1,
//! within the range of single precision.

mod fields;
mod passes;
mod state;

use super::disc::Units;
use super::places::Places;
use super::problem::Problem;
use crate::memory::keep;
use crate::methods::extension::Extension;
use crate::methods::fields::over;
use crate::operator::fft::Real;
use crate::threads::Threads;
use fields::{Fields, FIELDS};
use passes::{AddProduct, Direct, Energy, Go, Precondition, Predict};

/// The fields of one solve.
#[derive(Default)]
pub struct Discs<T: Real> {
    /// The values of [`Fields`], on C by blocks.
    fields: Vec<f64>,
    /// On the grid, by component: the fields to be multiplied, 0 outside C, and the products.
    given: [Vec<T>; 2],
    answer: [Vec<T>; 2],
    extension: Option<Extension<T, 2>>,
    units: Units,
}

/// Sums of squares over C: of the slip's residual and of u; after a step also of the deferred corrections and of the change of q.
#[derive(Clone, Copy)]
pub struct Sums {
    pub rest: f64,
    pub displaced: f64,
    pub deferred: f64,
    pub moved: f64,
}

impl<T: Real> Discs<T> {
    /// A displacement in the unit of the problem.
    pub fn unscaled_displacement(&self, displacement: f64) -> f64 {
        self.units.displacement * displacement
    }

    /// A traction in the unit of the state.
    pub fn unscaled_traction(&self, traction: f64) -> f64 {
        self.units.traction * traction
    }

    /// Calls `work` on the fields of each block, and copies z to the grid to be multiplied.
    fn give_z<const K: usize>(
        &mut self,
        places: &Places,
        threads: &Threads,
        work: impl Fn(&mut Fields<'_>) -> [f64; K] + Sync + Send,
    ) -> [f64; K] {
        let [x, y] = &mut self.given;
        let given = places.cut_grid(x).zip(places.cut_grid(y));
        let blocks = places.parts().zip(places.cut(&mut self.fields, FIELDS)).zip(given);
        over(threads, blocks, |_, ((part, fields), (x, y))| {
            let mut fields = Fields::of(fields);
            let sums = work(&mut fields);
            part.scatter(fields.z[0], x);
            part.scatter(fields.z[1], y);
            sums
        })
    }

    /// Copies the answer to the fields that `take` chooses, and calls `work` on the fields of each block.
    fn with_answer<const K: usize>(
        &mut self,
        problem: &Problem,
        take: impl for<'a, 'b> Fn(&'a mut Fields<'b>) -> &'a mut [&'b mut [f64]; 2] + Sync + Send,
        work: impl Fn(&mut Fields<'_>) -> [f64; K] + Sync + Send,
    ) -> [f64; K] {
        let (places, answer) = (&problem.places, &self.answer);
        let blocks = places.parts().zip(places.cut(&mut self.fields, FIELDS));
        over(problem.threads(), blocks, |_, (part, fields)| {
            let mut fields = Fields::of(fields);
            for (to, answer) in take(&mut fields).iter_mut().zip(answer) {
                part.gather(answer, to);
            }
            work(&mut fields)
        })
    }

    /// Predicts the slip area, and prepares the preconditioner's argument.
    pub fn predict(&mut self, places: &Places, threads: &Threads) -> Sums {
        let units = self.units;
        let predict = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(Predict { fields, units });
        let [rest, displaced] = self.give_z(places, threads, predict);
        Sums { rest, displaced, deferred: 0.0, moved: 0.0 }
    }

    /// z, the preconditioned residual: see [`Tangent::precondition`](super::tangent::Tangent::precondition). Returns `z.(A + D) t`, with the last
    /// direction as t.
    pub fn precondition(&mut self, problem: &mut Problem) -> f64 {
        let operators = &mut problem.operators;
        let compliance = operators.relative_compliance();
        let (given, [x, y]) = (self.given.each_ref().map(|given| &given[..]), &mut self.answer);
        match &mut self.extension {
            Some(extension) => {
                extension.between(given, [x, y], compliance, |r, z| operators.precondition_plain(r, z));
            }
            None => operators.precondition_plain(given, [x, y]),
        }
        let units = self.units;
        let work = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(Precondition { fields, units });
        let [along] = self.with_answer(problem, |fields| &mut fields.z, work);
        along
    }

    /// The direction t, its chord at the length f, and the field to be multiplied: the chord with the deferred corrections.
    pub fn choose_direction(&mut self, problem: &Problem, (beta, f): (f64, f64)) {
        let units = self.units;
        let direct = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(Direct { fields, units, beta, f });
        let [] = self.give_z(&problem.places, problem.threads(), direct);
    }

    /// Multiplies the given field by A. Returns `t.(A + D) t` and `t` times the projected residual. On stick the chord takes the place of t.
    pub fn multiply(&mut self, problem: &mut Problem) -> [f64; 2] {
        self.multiply_given(problem);
        let units = self.units;
        let energy = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(Energy { fields, units });
        self.with_answer(problem, |fields| &mut fields.product, energy)
    }

    /// Steps by `length` along the chord at the length f, and predicts the slip area there.
    pub fn go(&mut self, places: &Places, threads: &Threads, length: f64, f: f64) -> Sums {
        let units = self.units;
        let go = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(Go { fields, units, length, f });
        let [rest, displaced, deferred, moved] = self.give_z(places, threads, go);
        Sums { rest, displaced, deferred, moved }
    }

    /// Makes all deferred corrections by a product.
    pub fn correct(&mut self, problem: &mut Problem) {
        let threads = problem.threads().clone();
        let [] = self.give_z(&problem.places, &threads, |fields| {
            for (z, deferred) in fields.z.iter_mut().zip(&mut fields.deferred) {
                z.copy_from_slice(deferred);
                deferred.fill(0.0);
            }
            []
        });
        self.multiply_given(problem);
        let add = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(AddProduct { fields });
        let [] = self.with_answer(problem, |fields| &mut fields.z, add);
    }

    fn multiply_given(&mut self, problem: &mut Problem) {
        let [x, y] = &mut self.answer;
        problem.operators.multiply_plain(self.given.each_ref().map(|given| &given[..]), [x, y]);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.fields.capacity() * size_of::<f64>()
            + 2 * (self.given[0].capacity() + self.answer[0].capacity()) * size_of::<T>()
            + self.extension.as_ref().map_or(0, Extension::bytes)
    }
}

impl<T: Real> Drop for Discs<T> {
    fn drop(&mut self) {
        let Discs { fields, given: [x, y], answer: [ux, uy], .. } = self;
        keep([fields]);
        keep([x, y, ux, uy]);
    }
}
