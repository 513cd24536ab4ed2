//! Products of two components, `u = A q`, by a symmetric 2 x 2 matrix of coefficients for each offset.
//!
//! ```text
//! (ux, uy)_I = sum_J [xx xy; xy yy](I - J) (qx, qy)_J
//! ```
//!
//! Rows and columns of both components are transformed by this crate's own stages, in lanes, on every machine. Without xy a component displaces in
//! its own direction only. Then a component of zeros costs nothing, and its displacements are exactly 0.

use std::ops::Range;

use crate::block::BLOCK;
use crate::coefficients::EvenMatrix;
use crate::fft::column_pass::Blocks;
use crate::fft::lane_columns::LaneColumns;
use crate::fft::lane_rows::LaneRows;
use crate::fft::row_pass::{Forward, Inverse};
use crate::fft::stages::{before_a_line, from_a_line};
use crate::lengths::length_for_stages;
use crate::passes::Real;
use crate::real::Complex;
use crate::set_up::SetUp;
use crate::set_up_lanes::LaneTransforms;
use crate::vector_symbol::{factors, Place, VectorSymbol};
use crate::workspace::{Memory, Piece, Room};
use par::threads::Threads;
use par::Result;

/// The shortest periods with stages: px/2 and py exceed the largest radix, 5.
const SHORTEST: (usize, usize) = (12, 6);

/// Products of two components on a grid of `mx * my` elements.
pub struct VectorProduct<T: Real> {
    mx: usize,
    my: usize,
    rows: LaneRows<T>,
    columns: LaneColumns<T>,
    symbol: VectorSymbol<T>,
    px: usize,
    threads: Threads,
}

/// The period with the fastest products, of at least these lengths.
pub fn vector_period((least_x, least_y): (usize, usize)) -> (usize, usize) {
    (length_for_stages(least_x.max(SHORTEST.0)), length_for_stages(least_y.max(SHORTEST.1)))
}

impl<T: Real> VectorProduct<T> {
    /// The product of coefficients that are even or odd, with a [period](vector_period).
    pub fn even<F, G>(
        grid: (usize, usize),
        period: (usize, usize),
        coefficients: &EvenMatrix<F, G>,
        threads: &Threads,
    ) -> Result<VectorProduct<T>>
    where
        F: Fn(usize, i64, &mut [f64]) + Sync + Send,
        G: Fn([f64; 3]) -> [f64; 3] + Sync + Send,
    {
        let symbol = transforms(period, threads)?.of_even_matrix(coefficients, &mut SetUp::default())?;
        VectorProduct::of(grid, period, symbol, threads)
    }

    /// The product of a symbol. `of(kx, ky)` returns its [xx, yy, xy] at the bins >= 0 of a [period](vector_period). xx and yy are even, xy is odd.
    pub fn of_waves(
        grid: (usize, usize),
        period: (usize, usize),
        (is_coupled, of): (bool, impl Fn(usize, usize) -> [f64; 3] + Sync + Send),
        threads: &Threads,
    ) -> Result<VectorProduct<T>> {
        VectorProduct::of(grid, period, transforms(period, threads)?.of_waves(is_coupled, of)?, threads)
    }

    /// The product for displacements `n` elements further on in x. Its period must hold `|n|` more offsets in x than that of the plain product.
    pub fn further_on(self, n: i64) -> Result<VectorProduct<T>> {
        self.at(Place::FurtherOn(n))
    }

    /// The product for the displacements minus those `n` elements further on in x. Its period is that of [`further_on`](Self::further_on).
    pub fn less_further_on(self, n: i64) -> Result<VectorProduct<T>> {
        self.at(Place::LessFurtherOn(n))
    }

    fn at(mut self, place: Place) -> Result<VectorProduct<T>> {
        self.symbol.factors = factors(place, self.px, self.rows.blocks(), &self.threads)?;
        Ok(self)
    }

    /// The product of general coefficients. `fill(kx, ky, [xx, yy, xy])` sets those of the offsets `(kx, ky)`, `(kx + 1, ky)`, ... xy is used if the
    /// components are coupled.
    pub fn uneven(
        grid: (usize, usize),
        is_coupled: bool,
        fill: impl Fn(i64, i64, [&mut [f64]; 3]) + Sync + Send,
        threads: &Threads,
    ) -> Result<VectorProduct<T>> {
        let period = vector_period((2 * grid.0 - 1, 2 * grid.1 - 1));
        let transforms = transforms(period, threads)?;
        let symbol = transforms.of_general_matrix(grid, is_coupled, fill, &mut SetUp::default())?;
        VectorProduct::of(grid, period, symbol, threads)
    }

    fn of(
        (mx, my): (usize, usize),
        (px, py): (usize, usize),
        symbol: VectorSymbol<T>,
        threads: &Threads,
    ) -> Result<VectorProduct<T>> {
        let rows = LaneRows::of_any(pulp::Arch::new(), px)?;
        let rows = rows.unwrap_or_else(|| unreachable!("no stages have the period {px}"));
        let columns = LaneColumns::new(py)?.unwrap_or_else(|| unreachable!("no stages have the period {py}"));
        Ok(VectorProduct { mx, my, rows, columns, symbol, px, threads: threads.clone() })
    }

    /// The product in another precision.
    pub fn in_precision<S: Real>(&self) -> Result<VectorProduct<S>> {
        let period = (self.px, self.columns.length());
        VectorProduct::of((self.mx, self.my), period, self.symbol.in_precision(&self.threads)?, &self.threads)
    }

    /// Elements in x and y.
    pub fn grid(&self) -> (usize, usize) {
        (self.mx, self.my)
    }

    /// Bytes of the symbol.
    pub fn bytes(&self) -> usize {
        self.symbol.bytes()
    }

    /// Whether a component displaces in its own direction only.
    pub fn is_uncoupled(&self) -> bool {
        self.symbol.is_uncoupled()
    }

    /// The number of rows that are transformed together. [`apply`](Self::apply) writes this many rows at a time.
    pub fn rows_at_a_time(&self) -> usize {
        self.rows.at_a_time()
    }

    /// Memory for its products.
    pub fn memory(&self) -> Result<Memory<T>> {
        let room = Room {
            bins: 2 * self.rows.bins_of(self.my) + before_a_line::<T>(),
            row: 2 * self.rows.at_a_time() * self.mx,
            columns: 2 * self.rows.at_a_time() * self.columns.length() + before_a_line::<T>(),
            scratch: self.rows.scratch_length(),
            pieces: self.threads.count(),
        };
        Memory::new(room, &self.threads)
    }

    /// `u = A q`. q is zero outside the rows `loaded` of each component. `load(component, first row, rows)` fills `rows` with rows of q.
    /// `write(piece, first row, [ux, uy])` stores rows of u in one of the `pieces`, one for each [`rows_at_a_time`](Self::rows_at_a_time) rows.
    pub fn apply<P: Send>(
        &self,
        loaded: [Range<usize>; 2],
        load: impl Fn(usize, usize, &mut [T]) + Sync + Send,
        (pieces, write): (
            impl DoubleEndedIterator<Item = P> + ExactSizeIterator + Send,
            impl Fn(P, usize, [&[T]; 2]) + Sync + Send,
        ),
        memory: &mut Memory<T>,
    ) {
        let of_component = self.rows.bins_of(self.my);
        memory.wake(2 * of_component + before_a_line::<T>(), &self.threads);
        let Memory { bins, pieces: scratch, .. } = memory;
        let (x, y) = from_a_line(bins)[..2 * of_component].split_at_mut(of_component);
        let mut bins = [x, y];
        let alone = self.is_uncoupled();
        let is_zero = [0, 1].map(|component| alone && loaded[component].is_empty());
        for component in (0..2).filter(|component| !is_zero[*component]) {
            let (rows, first) = (loaded[component].clone(), loaded[component].start);
            let groups = self.rows.groups(self.my, bins[component], rows.clone()).enumerate();
            self.threads.share(groups, scratch, |(i, mut bins), piece| {
                let first = first + i * self.rows.at_a_time();
                let count = self.rows.at_a_time().min(rows.end - first);
                let values = &mut piece.row[..count * self.mx];
                load(component, first, values);
                let (plan, bins, scratch) = (&*self.rows.plan, &mut bins, &mut piece.scratch[..]);
                T::rows_forward(self.rows.arch, Forward { plan, rows: values, width: self.mx, bins, scratch });
            });
        }
        match alone {
            false => self.multiply(&mut bins, &loaded, scratch),
            true => (0..2)
                .filter(|component| !is_zero[*component])
                .for_each(|component| self.multiply_one(component, bins[component], &loaded[component], scratch)),
        }
        let [x, y] = bins.map(|bins| self.rows.groups(self.my, bins, 0..self.my));
        self.threads.share(x.zip(y).zip(pieces).enumerate(), scratch, |(i, ((x, y), to)), piece| {
            let first = i * self.rows.at_a_time();
            let count = self.rows.at_a_time().min(self.my - first);
            let (ux, uy) = piece.row[..2 * count * self.mx].split_at_mut(count * self.mx);
            for ((bins, rows), is_zero) in [(x, &mut *ux), (y, &mut *uy)].into_iter().zip(is_zero) {
                if is_zero {
                    rows.fill(T::zero());
                    continue;
                }
                let (plan, scratch) = (&*self.rows.plan, &mut piece.scratch[..]);
                T::rows_inverse(self.rows.arch, Inverse { plan, bins: &bins, rows, width: self.mx, scratch });
            }
            write(to, first, [ux, uy]);
        });
    }

    /// Transforms both components in y, multiplies them by the symbol and transforms them back.
    fn multiply(&self, bins: &mut [&mut [Complex<T>]; 2], loaded: &[Range<usize>; 2], scratch: &mut [Piece<T>]) {
        let length = self.rows.height(self.my) * BLOCK;
        let [x, y] = bins.each_mut().map(|bins| bins.chunks_exact_mut(length));
        self.each_block(x.zip(y).map(|(x, y)| [x, y]), loaded.clone(), scratch, |b, blocks, memory| {
            self.symbol.multiply(&self.columns, b, blocks, memory);
        });
    }

    /// Transforms one component in y, multiplies it by its symbol and transforms it back.
    fn multiply_one(&self, component: usize, bins: &mut [Complex<T>], loaded: &Range<usize>, scratch: &mut [Piece<T>]) {
        let blocks = bins.chunks_exact_mut(self.rows.height(self.my) * BLOCK).map(|block| [block]);
        self.each_block(blocks, [loaded.clone()], scratch, |b, blocks, memory| {
            self.symbol.multiply_one(&self.columns, (b, component), blocks, memory);
        });
    }

    /// Calls `work(number, blocks, memory)` for each block of columns, of K components.
    fn each_block<'a, const K: usize>(
        &self,
        blocks: impl DoubleEndedIterator<Item = [&'a mut [Complex<T>]; K]> + ExactSizeIterator + Send,
        loaded: [Range<usize>; K],
        scratch: &mut [Piece<T>],
        work: impl Fn(usize, Blocks<'_, T, K>, &mut [Complex<T>]) + Sync,
    ) where
        T: 'a,
    {
        let length = self.rows.height(self.my) * BLOCK;
        self.threads.share(blocks.enumerate(), scratch, |(b, blocks), piece| {
            #[cfg(feature = "test-panics")]
            crate::panics::at_a_block();
            let next = blocks.each_ref().map(|block| piece.next_block(block.as_ptr(), b, length, self.rows.blocks()));
            piece.block = b;
            let blocks = blocks.map(|block| &mut block[..self.my * BLOCK]);
            let blocks = Blocks { blocks, columns: self.rows.bins() - b * BLOCK, next, loaded: loaded.clone() };
            work(b, blocks, &mut piece.columns);
        });
    }
}

fn transforms(period: (usize, usize), threads: &Threads) -> Result<LaneTransforms<'_>> {
    let transforms = LaneTransforms::of_any(pulp::Arch::new(), period, threads)?;
    Ok(transforms.unwrap_or_else(|| unreachable!("no stages have the periods {period:?}")))
}
