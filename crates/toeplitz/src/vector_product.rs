//! Products `u = A q` of fields with two components (x and y), by a symmetric 2 x 2 matrix of coefficients for each offset.
//!
//! ```text
//! (ux, uy)_I = sum_J [xx xy; xy yy](I - J) (qx, qy)_J
//! ```
//!
//! The rows and columns of both components are transformed by the stages of this crate, in SIMD lanes, on every machine. If xy is 0, the components
//! are uncoupled: qx causes displacements in x only, and qy in y only. Then a component of q that is 0 costs no transforms, and its displacements are
//! exactly 0.

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

/// The shortest periods in x and y that have stages: px/2 and py must exceed the largest radix, 5.
const SHORTEST: (usize, usize) = (12, 6);

/// Products by one matrix A of fields with two components, on a grid of `mx * my` elements.
pub struct VectorProduct<T: Real> {
    mx: usize,
    my: usize,
    /// The transforms in x.
    rows: LaneRows<T>,
    /// The transforms in y.
    columns: LaneColumns<T>,
    symbol: VectorSymbol<T>,
    /// The period in x.
    px: usize,
    threads: Threads,
}

/// The period in x and y, of at least these lengths, with the fastest products.
pub fn vector_period((least_x, least_y): (usize, usize)) -> (usize, usize) {
    (length_for_stages(least_x.max(SHORTEST.0)), length_for_stages(least_y.max(SHORTEST.1)))
}

impl<T: Real> VectorProduct<T> {
    /// The product by an [`EvenMatrix`]: xx and yy are even, xy is odd. `period` is a [`vector_period`].
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

    /// The product by a matrix whose symbol is known: xx and yy are even, xy is odd. `values(bin_x, bin_y)` returns [xx, yy, xy] at the bins `0 ..=
    /// px/2`, `0 ..= py/2`, without the normalisation `1/(px py)`. `period` is a [`vector_period`]. Without coupling the values of xy are ignored.
    pub fn of_waves(
        grid: (usize, usize),
        period: (usize, usize),
        (is_coupled, values): (bool, impl Fn(usize, usize) -> [f64; 3] + Sync + Send),
        threads: &Threads,
    ) -> Result<VectorProduct<T>> {
        VectorProduct::of(grid, period, transforms(period, threads)?.of_waves(is_coupled, values)?, threads)
    }

    /// The product that returns, for each element, the displacement `n` elements further on in x. The period in x must have room for `|n|` more
    /// offsets than that of the plain product.
    pub fn further_on(self, n: i64) -> Result<VectorProduct<T>> {
        self.displaced(Place::FurtherOn(n))
    }

    /// The product that returns, for each element, its displacement minus that `n` elements further on in x. The period is as in
    /// [`further_on`](Self::further_on).
    pub fn less_further_on(self, n: i64) -> Result<VectorProduct<T>> {
        self.displaced(Place::LessFurtherOn(n))
    }

    /// Multiplies the symbol by the factors of a [`Place`].
    fn displaced(mut self, place: Place) -> Result<VectorProduct<T>> {
        self.symbol.factors = factors(place, self.px, self.rows.blocks(), &self.threads)?;
        Ok(self)
    }

    /// The product by general coefficients. `fill(kx, ky, [xx, yy, xy])` fills three slices with the coefficients at the offsets `(kx, ky)`,
    /// `(kx + 1, ky)`, ... Without coupling the values of xy are ignored.
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

    /// The product by a symbol of this period.
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

    /// The numbers of elements in x and y.
    pub fn grid(&self) -> (usize, usize) {
        (self.mx, self.my)
    }

    /// The bytes of the symbol.
    pub fn bytes(&self) -> usize {
        self.symbol.bytes()
    }

    /// Whether xy is 0: each component of q causes displacements in its own direction only.
    pub fn is_uncoupled(&self) -> bool {
        self.symbol.is_uncoupled()
    }

    /// The number of rows that are transformed together. [`apply`](Self::apply) writes this many rows at a time.
    pub fn rows_at_a_time(&self) -> usize {
        self.rows.at_a_time()
    }

    /// Allocates the memory of products.
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

    /// Computes `u = A q`.
    ///
    /// - `loaded`: for each component, the rows outside of which q is zero.
    /// - `load(component, first row, rows)` fills `rows` with consecutive rows of q, from `first row` on.
    /// - `write(piece, first row, [ux, uy])` stores consecutive rows of u in a piece of the caller. There is one piece for each
    ///   [`rows_at_a_time`](Self::rows_at_a_time) rows.
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
        let bins_per_component = self.rows.bins_of(self.my);
        memory.wake(2 * bins_per_component + before_a_line::<T>(), &self.threads);
        let Memory { bins, pieces: scratch, .. } = memory;
        let (x, y) = from_a_line(bins)[..2 * bins_per_component].split_at_mut(bins_per_component);
        let mut bins = [x, y];
        let uncoupled = self.is_uncoupled();
        // Without coupling, a component of q that is zero has no displacements.
        let is_zero = [0, 1].map(|component| uncoupled && loaded[component].is_empty());
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
        match uncoupled {
            false => self.multiply(&mut bins, &loaded, scratch),
            true => (0..2)
                .filter(|component| !is_zero[*component])
                .for_each(|component| self.multiply_one(component, bins[component], &loaded[component], scratch)),
        }
        let [x, y] = bins.map(|bins| self.rows.groups(self.my, bins, 0..self.my));
        self.threads.share(x.zip(y).zip(pieces).enumerate(), scratch, |(i, ((x, y), caller_piece)), piece| {
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
            write(caller_piece, first, [ux, uy]);
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

    /// Transforms one component in y, multiplies it by xx or yy and transforms it back.
    fn multiply_one(&self, component: usize, bins: &mut [Complex<T>], loaded: &Range<usize>, scratch: &mut [Piece<T>]) {
        let blocks = bins.chunks_exact_mut(self.rows.height(self.my) * BLOCK).map(|block| [block]);
        self.each_block(blocks, [loaded.clone()], scratch, |b, blocks, memory| {
            self.symbol.multiply_one(&self.columns, (b, component), blocks, memory);
        });
    }

    /// Calls `work(b, blocks, memory)` for each block number b of columns, where `blocks` has this block of all K components.
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

/// The transforms for the computation of a symbol. `period` has stages.
fn transforms(period: (usize, usize), threads: &Threads) -> Result<LaneTransforms<'_>> {
    let transforms = LaneTransforms::of_any(pulp::Arch::new(), period, threads)?;
    Ok(transforms.unwrap_or_else(|| unreachable!("no stages have the periods {period:?}")))
}
