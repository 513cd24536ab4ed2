//! The fields of the projected conjugate gradients on discs ([`shift`](super::shift)), which hold the elements of C only, and the passes over them.
//!
//! The unit of tractions is a power of two near min(rms g, rms w/a0). The unit of displacements is this unit times a power of two near a0. In these
//! units both are near 1, within the range of single precision.

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
use passes::{AddProduct, ChooseDirection, Energy, Precondition, Predict, Step};

/// The fields of one solve. T is the type of numbers in products.
#[derive(Default)]
pub struct Discs<T: Real> {
    /// The values of [`Fields`]: `[block][field][element of C]`.
    fields: Vec<f64>,
    /// The input of a product or of the preconditioner, on the grid by component; 0 outside C.
    input: [Vec<T>; 2],
    /// The output of a product or of the preconditioner, likewise.
    output: [Vec<T>; 2],
    /// The extension of residuals beyond C, on grids where it saves time.
    extension: Option<Extension<T, 2>>,
    units: Units,
}

/// Sums of squares over C.
#[derive(Clone, Copy)]
pub struct Sums {
    /// Of the residual slip, see [`rest`](super::certificate::rest).
    pub rest: f64,
    /// Of u.
    pub displaced: f64,
    /// Of the deferred corrections; 0 before the first step.
    pub deferred: f64,
    /// Of the change of q in the step; 0 before the first step.
    pub moved: f64,
}

impl<T: Real> Discs<T> {
    /// Converts a displacement to the units of the problem.
    pub fn unscaled_displacement(&self, displacement: f64) -> f64 {
        self.units.displacement * displacement
    }

    /// Converts a traction to the units of the problem.
    pub fn unscaled_traction(&self, traction: f64) -> f64 {
        self.units.traction * traction
    }

    /// Calls `work` on the fields of each block, and copies z to the input on the grid. Returns the sums of what `work` returns.
    fn compute_input<const K: usize>(
        &mut self,
        places: &Places,
        threads: &Threads,
        work: impl Fn(&mut Fields<'_>) -> [f64; K] + Sync + Send,
    ) -> [f64; K] {
        let [x, y] = &mut self.input;
        let input = places.cut_grid(x).zip(places.cut_grid(y));
        let blocks = places.parts().zip(places.cut(&mut self.fields, FIELDS)).zip(input);
        over(threads, blocks, |_, ((part, fields), (x, y))| {
            let mut fields = Fields::of(fields);
            let sums = work(&mut fields);
            part.scatter(fields.z[0], x);
            part.scatter(fields.z[1], y);
            sums
        })
    }

    /// Copies the output on the grid to the fields that `choose` selects, and calls `work` on the fields of each block. Returns the sums of what
    /// `work` returns.
    fn with_output<const K: usize>(
        &mut self,
        problem: &Problem,
        choose: impl for<'a, 'b> Fn(&'a mut Fields<'b>) -> &'a mut [&'b mut [f64]; 2] + Sync + Send,
        work: impl Fn(&mut Fields<'_>) -> [f64; K] + Sync + Send,
    ) -> [f64; K] {
        let (places, output) = (&problem.places, &self.output);
        let blocks = places.parts().zip(places.cut(&mut self.fields, FIELDS));
        over(problem.threads(), blocks, |_, (part, fields)| {
            let mut fields = Fields::of(fields);
            for (to, output) in choose(&mut fields).iter_mut().zip(output) {
                part.gather(output, to);
            }
            work(&mut fields)
        })
    }

    /// Predicts the slip area, and computes the input of the preconditioner.
    pub fn predict(&mut self, places: &Places, threads: &Threads) -> Sums {
        let units = self.units;
        let predict = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(Predict { fields, units });
        let [rest, displaced] = self.compute_input(places, threads, predict);
        Sums { rest, displaced, deferred: 0.0, moved: 0.0 }
    }

    /// Computes the preconditioned residual z, see [`Tangent::precondition`](super::tangent::Tangent::precondition). Returns `z.(A + D) t`, where t
    /// is the last direction.
    pub fn precondition(&mut self, problem: &mut Problem) -> f64 {
        let operators = &mut problem.operators;
        let compliance = operators.relative_compliance();
        let (input, [x, y]) = (self.input.each_ref().map(|input| &input[..]), &mut self.output);
        match &mut self.extension {
            Some(extension) => {
                extension.between(input, [x, y], compliance, |r, z| operators.precondition_plain(r, z));
            }
            None => operators.precondition_plain(input, [x, y]),
        }
        let units = self.units;
        let work = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(Precondition { fields, units });
        let [along] = self.with_output(problem, |fields| &mut fields.z, work);
        along
    }

    /// Computes the direction t, its chord at the length f, and the input of the product: the chord plus the deferred corrections over f.
    pub fn choose_direction(&mut self, problem: &Problem, (beta, f): (f64, f64)) {
        let units = self.units;
        let choose = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(ChooseDirection { fields, units, beta, f });
        let [] = self.compute_input(&problem.places, problem.threads(), choose);
    }

    /// Multiplies the input by A. Returns `t.(A + D) t`, and the product of t and the projected residual. On stick the chord takes the place of t.
    pub fn multiply(&mut self, problem: &mut Problem) -> [f64; 2] {
        self.multiply_input(problem);
        let units = self.units;
        let energy = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(Energy { fields, units });
        self.with_output(problem, |fields| &mut fields.product, energy)
    }

    /// Makes a step of this length, of which u changes along the chord at the length f. Predicts the slip area there, and computes the input of the
    /// preconditioner.
    pub fn step(&mut self, places: &Places, threads: &Threads, length: f64, f: f64) -> Sums {
        let units = self.units;
        let step = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(Step { fields, units, length, f });
        let [rest, displaced, deferred, moved] = self.compute_input(places, threads, step);
        Sums { rest, displaced, deferred, moved }
    }

    /// Makes all deferred corrections of u, by one product.
    pub fn correct(&mut self, problem: &mut Problem) {
        let threads = problem.threads().clone();
        let [] = self.compute_input(&problem.places, &threads, |fields| {
            for (z, deferred) in fields.z.iter_mut().zip(&mut fields.deferred) {
                z.copy_from_slice(deferred);
                deferred.fill(0.0);
            }
            []
        });
        self.multiply_input(problem);
        let add = |fields: &mut Fields<'_>| pulp::Arch::new().dispatch(AddProduct { fields });
        let [] = self.with_output(problem, |fields| &mut fields.z, add);
    }

    fn multiply_input(&mut self, problem: &mut Problem) {
        let [x, y] = &mut self.output;
        problem.operators.multiply_plain(self.input.each_ref().map(|input| &input[..]), [x, y]);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.fields.capacity() * size_of::<f64>()
            + 2 * (self.input[0].capacity() + self.output[0].capacity()) * size_of::<T>()
            + self.extension.as_ref().map_or(0, Extension::bytes)
    }
}

impl<T: Real> Drop for Discs<T> {
    fn drop(&mut self) {
        let Discs { fields, input: [x, y], output: [ux, uy], .. } = self;
        keep([fields]);
        keep([x, y, ux, uy]);
    }
}
