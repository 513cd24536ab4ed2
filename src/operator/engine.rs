//! Products by what is Toeplitz in A: in both directions, or in x only.

use toeplitz::fft::Real;
use toeplitz::{Memory, Product, Room};

use super::row_tables::PerRow;
use crate::error::Result;
use crate::threads::Threads;

/// The product of one operator.
pub(super) enum Engine<T: Real> {
    Toeplitz(Product<T>),
    PerRow(PerRow<T>),
}

impl<T: Real> Engine<T> {
    pub fn threads(&self) -> &Threads {
        match self {
            Engine::Toeplitz(product) => product.threads(),
            Engine::PerRow(per_row) => &per_row.rows.threads,
        }
    }

    /// Elements in x and y.
    pub fn grid(&self) -> (usize, usize) {
        match self {
            Engine::Toeplitz(product) => product.grid(),
            Engine::PerRow(per_row) => (per_row.rows.mx, per_row.rows.my),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        match self {
            Engine::Toeplitz(product) => product.bytes(),
            Engine::PerRow(per_row) => per_row.bytes(),
        }
    }

    /// What its products need.
    pub fn room(&self) -> Room {
        match self {
            Engine::Toeplitz(product) => product.room(),
            Engine::PerRow(per_row) => per_row.room(),
        }
    }

    /// The same in another precision, times a factor.
    pub fn in_precision<S: Real>(&self, factor: f64) -> Result<Engine<S>> {
        Ok(match self {
            Engine::Toeplitz(product) => Engine::Toeplitz(product.in_precision(factor)?),
            Engine::PerRow(per_row) => Engine::PerRow(per_row.in_precision(factor)?),
        })
    }

    /// `A p`, transformed in x.
    pub fn forward(&self, p: &[T], memory: &mut Memory<T>) {
        match self {
            Engine::Toeplitz(product) => product.forward(p, memory),
            Engine::PerRow(per_row) => per_row.forward(p, memory),
        }
    }

    /// Back to u.
    pub fn back(&self, u: &mut [T], memory: &mut Memory<T>) {
        match self {
            Engine::Toeplitz(product) => product.back(u, memory),
            Engine::PerRow(per_row) => per_row.rows.back(u, memory),
        }
    }

    /// The same; `write(first element, values of u, values of A p)` takes some rows at a time.
    pub fn back_with(&self, u: &mut [T], memory: &mut Memory<T>, write: impl Fn(usize, &mut [T], &[T]) + Sync + Send) {
        match self {
            Engine::Toeplitz(product) => product.back_with(u, memory, write),
            Engine::PerRow(per_row) => per_row.rows.back_with(u, memory, write),
        }
    }
}
