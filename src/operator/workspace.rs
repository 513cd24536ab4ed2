//! Memory for products.

use toeplitz::fft::Real;
use toeplitz::{Memory, Room};

use crate::error::Result;
use crate::memory::{keep, zeros};
use crate::threads::Threads;

/// Memory for a product, which then allocates nothing.
pub struct Workspace<T: Real> {
    pub(super) memory: Memory<T>,
    /// With patches: p scaled for one patch, and its product.
    pub(super) masked: [Vec<T>; 2],
    /// With patches: a copy of p, for products in place.
    pub(super) given: Vec<T>,
}

/// The sizes of memory that the products of an operator need.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct Needs {
    /// For transforms.
    pub(super) room: Room,
    /// Elements of the grid if there are patches, otherwise 0.
    pub(super) masked: usize,
}

impl Needs {
    /// The larger of both sizes.
    #[must_use]
    pub fn max(self, other: Needs) -> Needs {
        Needs { room: self.room.max(other.room), masked: self.masked.max(other.masked) }
    }
}

impl<T: Real> Workspace<T> {
    /// Memory for products with these needs.
    pub fn of(needs: Needs, threads: &Threads) -> Result<Workspace<T>> {
        let memory = |n| zeros(n, "the product's workspace");
        Ok(Workspace {
            memory: Memory::new(needs.room, threads)?,
            masked: [memory(needs.masked)?, memory(needs.masked)?],
            given: memory(needs.masked)?,
        })
    }

    /// Releases the memory of transforms until the next product.
    pub fn rest(&mut self) {
        self.memory.rest();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.memory.bytes() + 3 * size_of_val(&self.given[..])
    }
}

impl<T: Real> Drop for Workspace<T> {
    fn drop(&mut self) {
        let [scaled, product] = &mut self.masked;
        keep([scaled, product, &mut self.given]);
    }
}
