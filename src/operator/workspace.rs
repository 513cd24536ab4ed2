//! The memory of products by an operator.

use toeplitz::fft::Real;
use toeplitz::{Memory, Room};

use crate::error::Result;
use crate::memory::{keep, zeros};
use crate::threads::Threads;

/// The memory of products. A product with a workspace allocates nothing.
pub struct Workspace<T: Real> {
    /// The memory of transforms.
    pub(super) memory: Memory<T>,
    /// With patches: p times the factors of one patch, and A times this.
    pub(super) masked: [Vec<T>; 2],
    /// With patches: a copy of p, for products in place.
    pub(super) given: Vec<T>,
}

/// The sizes of the memory that products by an operator need.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct Needs {
    /// The memory of transforms.
    pub(super) room: Room,
    /// The number of elements of the grid if there are patches, otherwise 0.
    pub(super) masked: usize,
}

impl Needs {
    /// The sizes that satisfy both needs.
    #[must_use]
    pub fn max(self, other: Needs) -> Needs {
        Needs { room: self.room.max(other.room), masked: self.masked.max(other.masked) }
    }
}

impl<T: Real> Workspace<T> {
    /// Allocates memory for products with these needs.
    pub fn of(needs: Needs, threads: &Threads) -> Result<Workspace<T>> {
        let memory = |n| zeros(n, "the product's workspace");
        Ok(Workspace {
            memory: Memory::new(needs.room, threads)?,
            masked: [memory(needs.masked)?, memory(needs.masked)?],
            given: memory(needs.masked)?,
        })
    }

    /// Releases the memory of transforms until the next product, which allocates it again.
    pub fn rest(&mut self) {
        self.memory.rest();
    }

    /// Bytes of this memory.
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
