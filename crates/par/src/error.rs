//! The one thing that can go wrong.

/// There is no memory for some values, or the system starts no more threads. The message says for what.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct OutOfMemory(pub String);

/// Result with [`OutOfMemory`].
pub type Result<T> = std::result::Result<T, OutOfMemory>;
