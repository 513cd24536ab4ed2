//! The y direction of a product by a block Toeplitz matrix.
//!
//! ```text
//! u_I = sum_J c(ix - jx, iy - jy) p_J = [F^-1 (S . F p)]_I,    S = F c,  p padded with zeros to px * py
//! ```
//!
//! Blocks of columns with even coefficients are done by [`LaneColumns`] on machines with vectors. Others are gathered, transformed, multiplied,
//! transformed back and scattered.

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

/// Transforms in y, and the symbol.
pub(crate) struct Convolution<T: Real> {
    pub columns: ColumnTransform<T>,
    /// Transforms of rows and columns in lanes, for an even symbol.
    by_lanes: Option<(LaneRows<T>, LaneColumns<T>)>,
    symbol: Symbol<T>,
}

impl<T: Real> Convolution<T> {
    /// Transforms of a period; the symbol is still to be computed.
    pub fn new((px, py): (usize, usize)) -> Result<Convolution<T>> {
        // Plans are made only if used: that of a grid of one row is as large as the grid.
        let by_lanes = if have_stages((px, py)) { LaneRows::new(px)?.zip(LaneColumns::new(py)?) } else { None };
        Ok(Convolution { columns: ColumnTransform::new(py)?, by_lanes, symbol: Symbol::Even(Vec::new()) })
    }

    /// The storage of an even symbol of this number of columns.
    fn order(&self, columns: usize) -> EvenOrder<'_, T> {
        EvenOrder { by_lanes: self.by_lanes.as_ref().map(|(_, columns)| columns), columns, py: self.columns.length() }
    }

    /// The transforms of rows in lanes, if the symbol uses lanes.
    pub fn lanes(&self) -> Option<&LaneRows<T>> {
        self.lanes_if_even().filter(|_| matches!(self.symbol, Symbol::Even(_)))
    }

    /// The transforms of rows in lanes, for any present coefficients.
    pub fn lanes_if_even(&self) -> Option<&LaneRows<T>> {
        self.by_lanes.as_ref().map(|(rows, _)| rows)
    }

    /// The convolution in another precision, times a factor; `px` is the period in x.
    pub fn in_precision<S: Real>(&self, px: usize, factor: f64, threads: &Threads) -> Result<Convolution<S>> {
        let mut other = Convolution::new((px, self.columns.length()))?;
        other.symbol = self.symbol.in_precision(factor, threads)?;
        Ok(other)
    }

    pub fn bytes(&self) -> usize {
        self.symbol.bytes()
    }

    /// Transforms in y, multiplies by the symbol and transforms back; rows `loaded` hold pressures.
    pub fn apply(&self, rows: &Rows<T>, loaded: Range<usize>, memory: &mut Memory<T>) {
        if let (Some((in_x, even)), Symbol::Even(symbol)) = (&self.by_lanes, &self.symbol) {
            let (bins, pieces) = rows.blocks_of_bins(in_x, memory);
            let (length, kept) = (in_x.height(rows.my) * BLOCK, BLOCK * even.kept_rows());
            assert_eq!(symbol.len(), in_x.blocks() * kept, "a symbol that was not set up");
            let blocks = bins.chunks_exact_mut(length).zip(symbol.chunks_exact(kept)).enumerate();
            return rows.threads.share(blocks, pieces, |(b, (block, symbol)), piece| {
                #[cfg(feature = "test-panics")]
                crate::panics::at_a_block();
                let next = piece.next_block(block.as_ptr(), b, length, in_x.blocks());
                piece.block = b;
                let (block, columns) = (&mut block[..rows.my * BLOCK], in_x.bins() - b * BLOCK);
                let blocks = Blocks { blocks: [block], columns, next: [next], loaded: [loaded.clone()] };
                let (factor, memory) = (&EvenSymbol(symbol), &mut piece.columns[..]);
                T::by_even(even.arch, Multiply { plan: &even.plan, blocks, factor, memory });
            });
        }
        let Memory { bins, pieces, .. } = memory;
        let (nb, length) = (rows.transform.bins(), self.columns.length());
        let (room, order) = (room_of_column(length), self.order(nb));
        for_each_block(&mut bins[..rows.my * nb], nb, &rows.threads, pieces, |block, piece| {
            #[cfg(feature = "test-panics")]
            crate::panics::at_a_block();
            let columns = &mut piece.columns[..block.columns() * room];
            block.gather(loaded.clone(), room, columns);
            // Long columns one by one, in the nearest cache.
            let (together, used) = if room > length { (room, length) } else { (columns.len(), columns.len()) };
            for (c, columns) in columns.chunks_exact_mut(together).enumerate() {
                let columns = &mut columns[..used];
                self.columns.forward(columns, &mut piece.scratch);
                self.symbol.multiply(block.first() + c, order, columns);
                self.columns.inverse(columns, &mut piece.scratch);
            }
            block.scatter(0..rows.my, room, columns);
        });
    }

    /// Computes the symbol of even coefficients in the present memory; `px` is the period in x.
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
        assert_eq!(lanes.is_some(), order.by_lanes.is_some(), "an order of columns without their transforms");
        match lanes {
            Some(lanes) => lanes.of_even(even, set_up, order, &mut values)?,
            None => Transforms::new(period, threads)?.of_even(even, set_up, &mut values)?,
        }
        self.symbol = Symbol::Even(values);
        Ok(())
    }

    /// Takes the symbol `value(x, y)` of even coefficients at the bins >= 0; `px` is the period in x.
    pub fn set_values(&mut self, (nb, px): (usize, usize), value: impl Fn(usize, usize) -> f64) -> Result<()> {
        let (py, order) = (self.columns.length(), self.order(nb));
        let scale = 1.0 / (px as f64 * py as f64);
        let value = |x: usize, y: usize| T::of(scale * value(x, y));
        let mut symbol = Vec::new();
        unwritten(&mut symbol, order.len(), T::nan(), SYMBOL, &Threads::One)?;
        if let Some(even) = order.by_lanes {
            for (first, block) in (0..nb).step_by(BLOCK).zip(symbol.chunks_exact_mut(order.block())) {
                even.write(block, nb - first, |column, bin| value(first + column, bin));
            }
        } else {
            for (x, column) in symbol.chunks_exact_mut(order.half()).enumerate() {
                column.iter_mut().enumerate().for_each(|(y, out)| *out = value(x.min(nb - 1), y));
            }
        }
        self.symbol = Symbol::Even(symbol);
        Ok(())
    }

    /// Computes the symbol of coefficients that are not even, times a factor.
    pub fn set_uneven(
        &mut self,
        (coefficients, factor): (&impl Coefficients, f64),
        grid: (usize, usize),
        px: usize,
        threads: &Threads,
        set_up: &mut SetUp,
    ) -> Result<()> {
        let transforms = Transforms::new((px, self.columns.length()), threads)?;
        let symmetric = coefficients.are_symmetric();
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
