//! The error of this crate.

/// An allocation failed, or the system could not start more threads. The message says what the memory or the threads were for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct OutOfMemory(pub String);

/// A result whose error is [`OutOfMemory`].
pub type Result<T> = std::result::Result<T, OutOfMemory>;
