//! The y direction of a product by a block Toeplitz matrix: transforms columns, multiplies them by the symbol S and transforms them back.
//!
//! ```text
//! u_I = sum_J c(ix - jx, iy - jy) p_J = [F^-1 (S . F p)]_I,    S = F c,  p padded with zeros to px * py
//! ```
//!
//! S is stored with the normalisation 1/(px py) of F^-1 ([`symbol`](crate::symbol)).
//!
//! [`LaneColumns`] multiplies each block of columns in place, under three conditions: the coefficients are even, the machine has SIMD vectors, and
//! both periods have stages ([`have_stages`]). Otherwise the columns of a block are copied to contiguous memory, transformed, multiplied, transformed
//! back and copied back.

use std::ops::Range;

use crate::block::{for_each_block, room_of_column, BLOCK};
use crate::coefficients::Coefficients;
use crate::coefficients::Even;
use crate::fft::any_length::ColumnTransform;
use crate::fft::column_pass::{Blocks, EvenSymbol, Multiply};
use crate::fft::lane_columns::LaneColumns;
use crate::fft::lane_rows::LaneRows;
use crate::lengths::have_stages;
use crate::passes::Real;
use crate::rows::Rows;
use crate::set_up::{SetUp, Transforms};
use crate::set_up_lanes::LaneTransforms;
use crate::symbol::{is_coarse, EvenOrder, Symbol, SYMBOL};
use crate::workspace::Memory;
use par::memory::unwritten;
use par::threads::Threads;
use par::Result;

/// The transforms in y of a product, and its symbol.
pub(crate) struct Convolution<T: Real> {
    pub columns: ColumnTransform<T>,
    /// The transforms of rows and columns in lanes, which an even symbol uses. None if a period has no stages, or the machine no SIMD vectors.
    by_lanes: Option<(LaneRows<T>, LaneColumns<T>)>,
    symbol: Symbol<T>,
}

impl<T: Real> Convolution<T> {
    /// Makes the transforms of a period. The symbol is empty until a `set_` function computes it.
    pub fn new((px, py): (usize, usize)) -> Result<Convolution<T>> {
        // Plans are made only if they will be used: for a grid of one row, the plan of rows would need as much memory as the grid.
        let by_lanes = if have_stages((px, py)) { LaneRows::new(px)?.zip(LaneColumns::new(py)?) } else { None };
        Ok(Convolution { columns: ColumnTransform::new(py)?, by_lanes, symbol: Symbol::Even(Vec::new()) })
    }

    /// The order in which an even symbol of `columns` columns is stored.
    fn order(&self, columns: usize) -> EvenOrder<'_, T> {
        let by_lanes = self.by_lanes.as_ref().map(|(_, columns_by_lanes)| columns_by_lanes);
        EvenOrder { by_lanes, columns, py: self.columns.length() }
    }

    /// The transforms of rows in lanes, if the present symbol uses lanes.
    pub fn lanes(&self) -> Option<&LaneRows<T>> {
        self.lanes_of_even_symbol().filter(|_| matches!(self.symbol, Symbol::Even(_)))
    }

    /// The transforms of rows in lanes that an even symbol would use, whatever the symbol is now. Only the size of memory depends on them.
    pub fn lanes_of_even_symbol(&self) -> Option<&LaneRows<T>> {
        self.by_lanes.as_ref().map(|(rows_by_lanes, _)| rows_by_lanes)
    }

    /// The convolution in another precision, with its symbol times a factor; `px` is the period in x.
    pub fn in_precision<S: Real>(&self, px: usize, factor: f64, threads: &Threads) -> Result<Convolution<S>> {
        let mut other = Convolution::new((px, self.columns.length()))?;
        other.symbol = self.symbol.in_precision(factor, threads)?;
        Ok(other)
    }

    /// The bytes of the symbol.
    pub fn bytes(&self) -> usize {
        self.symbol.bytes()
    }

    /// Transforms the rows' bins in y, multiplies them by the symbol and transforms them back. Only the rows `loaded` hold values before.
    pub fn apply(&self, rows: &Rows<T>, loaded: Range<usize>, memory: &mut Memory<T>) {
        match (&self.by_lanes, &self.symbol) {
            (Some(by_lanes), Symbol::Even(symbol)) => apply_by_lanes(by_lanes, symbol, rows, loaded, memory),
            _ => self.apply_by_columns(rows, loaded, memory),
        }
    }

    /// [`apply`](Self::apply) without lanes: gathers the columns of a block in contiguous memory, and scatters them afterwards.
    fn apply_by_columns(&self, rows: &Rows<T>, loaded: Range<usize>, memory: &mut Memory<T>) {
        let Memory { bins, pieces, .. } = memory;
        let (nb, length) = (rows.transform.bins(), self.columns.length());
        let (room, order) = (room_of_column(length), self.order(nb));
        for_each_block(&mut bins[..rows.my * nb], nb, &rows.threads, pieces, |block, piece| {
            #[cfg(feature = "test-panics")]
            crate::panics::at_a_block();
            let columns = &mut piece.columns[..block.columns() * room];
            block.gather(loaded.clone(), room, columns);
            // Long columns have a gap behind them (`room > length`). They are processed one by one, so that each stays in the first-level cache.
            // Short columns are processed together.
            let (part_room, part_length) = if room > length { (room, length) } else { (columns.len(), columns.len()) };
            for (c, part) in columns.chunks_exact_mut(part_room).enumerate() {
                let values = &mut part[..part_length];
                self.columns.forward(values, &mut piece.scratch);
                self.symbol.multiply(block.first() + c, order, values);
                self.columns.inverse(values, &mut piece.scratch);
            }
            block.scatter(0..rows.my, room, columns);
        });
    }

    /// Computes the symbol of even coefficients. It reuses the memory of the present symbol. `px` is the period in x.
    pub fn set_even<F, G>(&mut self, even: &Even<F, G>, px: usize, threads: &Threads, set_up: &mut SetUp) -> Result<()>
    where
        F: Fn(i64, &mut [f64]) + Sync + Send,
        G: Fn(f64) -> f64 + Sync + Send,
    {
        let mut values = self.symbol.take_real();
        let (period, order) = ((px, self.columns.length()), self.order(px / 2 + 1));
        let lanes = match order.by_lanes {
            Some(_) => LaneTransforms::new(period, threads)?,
            None => None,
        };
        assert_eq!(
            lanes.is_some(),
            order.by_lanes.is_some(),
            "the symbol's order is that of lanes, but its set-up has no lanes"
        );
        match lanes {
            Some(lanes) => lanes.of_even(even, set_up, order, &mut values)?,
            None => Transforms::new(period, threads)?.of_even(even, set_up, &mut values)?,
        }
        self.symbol = Symbol::Even(values);
        Ok(())
    }

    /// Sets the symbol of even coefficients from its values: `value(bin_x, bin_y)` at the bins `0 ..= px/2`, `0 ..= py/2`, without the normalisation.
    /// `px` is the period in x, and `nb` is px/2 + 1.
    pub fn set_values(&mut self, (nb, px): (usize, usize), value: impl Fn(usize, usize) -> f64) -> Result<()> {
        let (py, order) = (self.columns.length(), self.order(nb));
        let scale = 1.0 / (px as f64 * py as f64);
        let value = |bin_x: usize, bin_y: usize| T::of(scale * value(bin_x, bin_y));
        let mut symbol = Vec::new();
        unwritten(&mut symbol, order.len(), T::nan(), SYMBOL, &Threads::One)?;
        if let Some(columns_by_lanes) = order.by_lanes {
            for (first, block) in (0..nb).step_by(BLOCK).zip(symbol.chunks_exact_mut(order.block())) {
                columns_by_lanes.write(block, nb - first, |column, bin_y| value(first + column, bin_y));
            }
        } else {
            for (x, column) in symbol.chunks_exact_mut(order.half()).enumerate() {
                // An odd number of columns is padded by repeating the last.
                let bin_x = x.min(nb - 1);
                column.iter_mut().enumerate().for_each(|(bin_y, out)| *out = value(bin_x, bin_y));
            }
        }
        self.symbol = Symbol::Even(symbol);
        Ok(())
    }

    /// Computes the symbol of any coefficients, times a factor. They need not be even in each direction.
    pub fn set_general(
        &mut self,
        (coefficients, factor): (&impl Coefficients, f64),
        grid: (usize, usize),
        px: usize,
        threads: &Threads,
        set_up: &mut SetUp,
    ) -> Result<()> {
        let transforms = Transforms::new((px, self.columns.length()), threads)?;
        let symmetric = coefficients.are_symmetric();
        // In single precision the asymmetry of a symmetric table is below round-off, so its symmetric part is used ([`symbol`](crate::symbol)).
        self.symbol = if symmetric && is_coarse::<T>() {
            let mut values = self.symbol.take_real();
            transforms.of_symmetric((coefficients, factor), grid, set_up, &mut values)?;
            Symbol::Symmetric(values)
        } else {
            let mut values = self.symbol.take_complex();
            transforms.of_general((coefficients, factor), grid, set_up, &mut values)?;
            Symbol::General(values, symmetric)
        };
        Ok(())
    }
}

/// [`Convolution::apply`] by an even symbol with SIMD lanes: multiplies each block of columns in place.
fn apply_by_lanes<T: Real>(
    (rows_by_lanes, columns_by_lanes): &(LaneRows<T>, LaneColumns<T>),
    symbol: &[T],
    rows: &Rows<T>,
    loaded: Range<usize>,
    memory: &mut Memory<T>,
) {
    let (bins, pieces) = rows.blocks_of_bins(rows_by_lanes, memory);
    let block_length = rows_by_lanes.height(rows.my) * BLOCK;
    let symbol_length = BLOCK * columns_by_lanes.kept_rows();
    assert_eq!(symbol.len(), rows_by_lanes.blocks() * symbol_length, "a symbol that was not set up");
    let blocks = bins.chunks_exact_mut(block_length).zip(symbol.chunks_exact(symbol_length)).enumerate();
    rows.threads.share(blocks, pieces, |(b, (block, symbol)), piece| {
        #[cfg(feature = "test-panics")]
        crate::panics::at_a_block();
        // The block that this thread probably multiplies next is prefetched.
        let next = piece.next_block(block.as_ptr(), b, block_length, rows_by_lanes.blocks());
        piece.block = b;
        let (block, columns) = (&mut block[..rows.my * BLOCK], rows_by_lanes.bins() - b * BLOCK);
        let blocks = Blocks { blocks: [block], columns, next: [next], loaded: [loaded.clone()] };
        let (factor, memory) = (&EvenSymbol(symbol), &mut piece.columns[..]);
        T::by_even(columns_by_lanes.arch, Multiply { plan: &columns_by_lanes.plan, blocks, factor, memory });
    });
}
