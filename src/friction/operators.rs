//! The operators of one grid: products with A, or with B in steady rolling, and an approximate inverse of A.

use super::coefficients::Tangential;
use super::excess::Excess;
use super::plane::{add, Vector};
use super::quadrant::Quadrant;
use super::row_product::RowProduct;
use super::sweep::{Rolling, Sweep};
use super::toeplitz::Toeplitz;
use super::unit::unit_of;
use crate::error::Result;
use crate::grid::Grid;
use crate::operator::fft::Real;
use crate::threads::Threads;
use toeplitz::Memory;

/// The number of threads is chosen for this many times the elements of the grid, because a tangential iteration takes more time than a normal one.
const WORK_FACTOR: usize = 4;

/// Products with A, or with B in steady rolling, in double and in single precision; and products with the inverse of a circulant near A.
pub struct Operators {
    /// The influence coefficients, in the units of the iterations.
    pub tangential: Tangential,
    /// The product in double precision. None on a coarser grid, which uses single precision only, or with tables per loaded row.
    exact: Option<(Toeplitz<f64>, Memory<f64>)>,
    /// The product in single precision. None if all products are in double precision.
    fast: Option<(Toeplitz<f32>, Memory<f32>)>,
    /// The product with the inverse of the circulant. None if the circulant is not positive definite: then `1/a0` takes its place.
    inverse: Option<(Toeplitz<f32>, Memory<f32>)>,
    /// The product with tables per loaded row, in place of `exact` and `fast`.
    rows: Option<RowProduct>,
    /// In steady rolling: the step of B, and the sweep that solves its difference equation.
    pub rolling: Option<(Rolling, Sweep)>,
    /// The part of a layer between the bodies that differs between elements; none if the layer is uniform.
    pub excess: Option<Excess>,
    /// The displacement of an element by a unit traction on itself, the larger one of both directions. In steady rolling it is the change of this
    /// displacement in a step.
    pub self_influence: f64,
    /// The self-influence without rolling: the greatest coefficient of A.
    a0: f64,
    /// The unit of the coefficients, a power of two.
    unit: f64,
    /// The threads that suit the size of the grid.
    pub(super) threads: Threads,
    /// The number of products since the last call of [`Problem::take_products`](super::problem::Problem::take_products).
    pub(super) products: u64,
}

impl Operators {
    /// Sets up the product on a grid, in single precision if `single`, otherwise in double precision. `quadrant` has the coefficients of all offsets
    /// that are needed. Iterations also need [`Operators::prepare`].
    pub fn new(
        quadrant: &Quadrant,
        grid: &Grid,
        rolling: Option<Rolling>,
        single: bool,
        threads: &Threads,
    ) -> Result<Operators> {
        let (tangential, threads) = (quadrant.tangential(), &threads.suited_to(WORK_FACTOR * grid.len()));
        let rows = match (tangential.rows(), rolling) {
            (None, _) => None,
            (Some(rows), Some(rolling)) => Some(RowProduct::rolling(tangential, rows, grid, rolling.by.0, threads)?),
            (Some(rows), None) => Some(RowProduct::displaced(tangential, rows, grid, 0.0, threads)?),
        };
        let (exact, fast) = match single {
            _ if rows.is_some() => (None, None),
            true => (None, Some(product(quadrant, grid, rolling, threads)?)),
            false => (Some(product(quadrant, grid, rolling, threads)?), None),
        };
        let [xx, yy, _] = tangential.at(0.0, 0.0);
        let rolling = rolling.map(|rolling| (rolling, Sweep::new(&rolling)));
        // The coefficients one step ahead are interpolated as in the sweep.
        let at = |x: f64, y: f64| match tangential.uneven() {
            Some(tables) if (x, y) != (0.0, 0.0) => tables.whole_at(x as i64, y as i64),
            _ => tangential.at(x, y),
        };
        let ahead = rolling.as_ref().map_or([0.0; 2], |(_, sweep)| sweep.ahead_of(at));
        Ok(Operators {
            exact: exact.map(with_workspace).transpose()?,
            fast: fast.map(with_workspace).transpose()?,
            inverse: None,
            rows,
            rolling,
            excess: None,
            self_influence: (xx - ahead[0]).max(yy - ahead[1]),
            a0: xx.max(yy),
            unit: unit_of(xx),
            products: 0,
            tangential: tangential.clone(),
            threads: threads.clone(),
        })
    }

    /// Sets up what iterations need: products of search directions, in single precision if `single`, and the approximate inverse.
    pub fn prepare(&mut self, quadrant: &Quadrant, grid: &Grid, single: bool) -> Result<()> {
        if let (true, None, Some((exact, _))) = (single, &self.fast, &self.exact) {
            self.fast = Some(with_workspace(exact.in_precision()?)?);
        }
        let inverse = Toeplitz::nearly_inverse(quadrant, grid, &self.threads)?;
        self.inverse = inverse.map(with_workspace).transpose()?;
        Ok(())
    }

    /// The greatest coefficient of A: that of an element on itself, in the direction where it is larger.
    pub fn greatest(&self) -> f64 {
        self.a0
    }

    /// The self-influence of element k with the compliance of its layer, which may differ between elements. In steady rolling it is the change in a
    /// step.
    pub fn influence_on_itself(&self, k: usize) -> f64 {
        let own_weight = self.rolling.as_ref().map_or(0.0, |(_, sweep)| sweep.own());
        self.self_influence + self.excess.as_ref().map_or(0.0, |excess| (1.0 - own_weight) * excess.at(k))
    }

    /// The self-influence without rolling, relative to that without a layer between the bodies.
    pub fn relative_compliance(&self) -> f64 {
        self.a0 / (self.a0 - self.tangential.layer())
    }

    /// The step of steady rolling.
    pub fn step(&self) -> Option<Rolling> {
        self.rolling.as_ref().map(|(rolling, _)| *rolling)
    }

    /// Computes `u = A q`, or B q in steady rolling, for q of the order of `unit`. The product is in double precision, except on coarser grids that
    /// have single precision only.
    pub fn multiply(&mut self, q: &[Vector], unit: f64, u: &mut [Vector]) {
        match (&mut self.rows, &mut self.exact, &mut self.fast) {
            (Some(rows), ..) => rows.apply(q, u),
            (_, Some((operator, workspace)), _) => operator.apply(q, 1.0, u, workspace),
            (.., Some((operator, workspace))) => operator.apply(q, unit_of(unit), u, workspace),
            _ => unreachable!("there is one of them"), // see `new`
        }
        self.add_excess(q, u);
        self.products += 1;
    }

    /// Adds the displacements by the part of a layer that is not uniform.
    fn add_excess(&self, q: &[Vector], u: &mut [Vector]) {
        if let Some(excess) = &self.excess {
            excess.add(|i| q[i], self.rolling.as_ref().map(|(_, sweep)| sweep), |i, v| u[i] = add(u[i], v));
        }
    }

    /// [`Operators::multiply`], in single precision if that product is set up.
    pub fn multiply_fast(&mut self, q: &[Vector], unit: f64, u: &mut [Vector]) {
        let Some((operator, workspace)) = &mut self.fast else { return self.multiply(q, unit, u) };
        operator.apply(q, unit_of(unit), u, workspace);
        self.add_excess(q, u);
        self.products += 1;
    }

    /// Computes `u = A q/unit`, or B q/unit, for fields by component, with the [unit](Self::unit) of the coefficients.
    pub fn multiply_plain<S: Real>(&mut self, q: [&[S]; 2], u: [&mut [S]; 2]) {
        let [ux, uy] = u;
        match (&mut self.rows, &mut self.exact, &mut self.fast) {
            (Some(rows), ..) => rows.apply_by_component(q, 1.0 / self.unit, [&mut *ux, &mut *uy]),
            (.., Some((operator, memory))) => operator.apply_by_component(q, [1.0; 2], [&mut *ux, &mut *uy], memory),
            (_, Some((operator, memory)), _) => operator.apply_by_component(q, [1.0; 2], [&mut *ux, &mut *uy], memory),
            _ => unreachable!("there is one of them"),
        }
        if let Some(excess) = &self.excess {
            let by = 1.0 / self.unit;
            let add = |i: usize, v: Vector| {
                (ux[i], uy[i]) = (S::of(ux[i].to_double() + by * v[0]), S::of(uy[i].to_double() + by * v[1]));
            };
            let q = |i: usize| [q[0][i].to_double(), q[1][i].to_double()];
            excess.add(q, self.rolling.as_ref().map(|(_, sweep)| sweep), add);
        }
        self.products += 1;
    }

    /// The unit of the coefficients, a power of two.
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// Whether search directions are multiplied in single precision.
    pub fn has_fast(&self) -> bool {
        self.fast.is_some()
    }

    /// Whether [`multiply_fast`](Self::multiply_fast) is as accurate as [`multiply`](Self::multiply).
    pub fn fast_is_exact(&self) -> bool {
        self.exact.is_none() || self.fast.is_none()
    }

    /// Computes `q = M u`, where M is the inverse of a circulant near A. Tractions are of the order of `unit`.
    pub fn precondition(&mut self, u: &[Vector], unit: f64, q: &mut [Vector]) {
        let a0 = self.a0;
        match &mut self.inverse {
            Some((operator, workspace)) => operator.apply(u, unit_of(unit * a0), q, workspace),
            None => q.iter_mut().zip(u).for_each(|(q, u)| *q = [u[0] / a0, u[1] / a0]),
        }
    }

    /// [`Operators::precondition`] of fields by component.
    pub fn precondition_components(&mut self, u: [&[f64]; 2], unit: f64, q: [&mut [f64]; 2]) {
        let unit = unit_of(unit * self.a0);
        let scales = self.inverse.as_ref().map_or([1.0; 2], |(operator, _)| operator.scales(unit));
        self.precondition_scaled(u, (scales, 1.0 / self.a0), q);
    }

    /// [`Operators::precondition_components`] for displacements in units of [`unit`](Self::unit), as those of [`Operators::multiply_plain`].
    pub fn precondition_plain<S: Real>(&mut self, u: [&[S]; 2], q: [&mut [S]; 2]) {
        self.precondition_scaled(u, ([1.0; 2], self.unit / self.a0), q);
    }

    /// Computes M u with these factors on the input and the output of the product. Without a circulant M is the factor `by`.
    fn precondition_scaled<S: Real>(&mut self, u: [&[S]; 2], (scales, by): ([f64; 2], f64), q: [&mut [S]; 2]) {
        match &mut self.inverse {
            Some((operator, memory)) => operator.apply_by_component(u, scales, q, memory),
            None => {
                for (q, u) in q.into_iter().zip(u) {
                    q.iter_mut().zip(u).for_each(|(q, u)| *q = S::of(by * u.to_double()));
                }
            }
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        fn of<T: Real>(operator: &Option<(Toeplitz<T>, Memory<T>)>) -> usize {
            let held = |memory: &Memory<T>| memory.bytes() + memory.bytes_of_pieces();
            operator.as_ref().map_or(0, |(operator, memory)| operator.bytes() + held(memory))
        }
        let excess = self.excess.as_ref().map_or(0, Excess::bytes);
        let rows = self.rows.as_ref().map_or(0, RowProduct::bytes);
        of(&self.exact) + of(&self.fast) + of(&self.inverse) + rows + excess
    }
}

/// Sets up the product with A, or with B in steady rolling.
fn product<T: Real>(
    quadrant: &Quadrant,
    grid: &Grid,
    rolling: Option<Rolling>,
    threads: &Threads,
) -> Result<Toeplitz<T>> {
    match rolling {
        Some(rolling) => Toeplitz::rolling(quadrant, grid, rolling.by, threads),
        None => Toeplitz::direct(quadrant, grid, threads),
    }
}

fn with_workspace<T: Real>(operator: Toeplitz<T>) -> Result<(Toeplitz<T>, Memory<T>)> {
    let workspace = operator.workspace()?;
    Ok((operator, workspace))
}
