//! The memory of products.

use toeplitz::fft::Real;
use toeplitz::{Memory, Room};

use crate::error::Result;
use crate::memory::{keep, zeros};
use crate::threads::Threads;

/// Names its memory in messages.
const WORKSPACE: &str = "the product's workspace";

/// Memory that a product needs, so that it allocates nothing.
pub struct Workspace<T: Real> {
    pub(super) memory: Memory<T>,
    /// With patches: p scaled for one of them, and its product.
    pub(super) masked: [Vec<T>; 2],
    /// And p, where u takes its place.
    pub(super) given: Vec<T>,
}

/// Numbers of values that the products of an operator need.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct Needs {
    /// Transforms.
    pub(super) room: Room,
    /// Elements of a grid with patches.
    pub(super) masked: usize,
}

impl Needs {
    /// The sizes that either needs.
    #[must_use]
    pub fn max(self, other: Needs) -> Needs {
        Needs { room: self.room.max(other.room), masked: self.masked.max(other.masked) }
    }
}

impl<T: Real> Workspace<T> {
    /// Memory for products that need no more.
    pub fn of(needs: Needs, threads: &Threads) -> Result<Workspace<T>> {
        let memory = |n| zeros(n, WORKSPACE);
        Ok(Workspace {
            memory: Memory::new(needs.room, threads)?,
            masked: [memory(needs.masked)?, memory(needs.masked)?],
            given: memory(needs.masked)?,
        })
    }

    /// It is not needed for a while.
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
