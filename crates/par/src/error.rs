//! The error of this crate.

/// An allocation failed, or the system starts no more threads. The message names the purpose.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct OutOfMemory(pub String);

/// Result with [`OutOfMemory`].
pub type Result<T> = std::result::Result<T, OutOfMemory>;
