//! Errors. A message names the argument, its value, and the rule that it breaks.

/// Why a problem was refused or could not be solved. The C ABI has a negative status for each variant.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An argument breaks a rule (a size, a range, an unknown enumerator).
    #[error("{0}")]
    InvalidArgument(String),
    /// A NaN, or an infinity where none is allowed.
    #[error("{0}")]
    NotFinite(String),
    /// A valid request that this version of the library does not support.
    #[error("{0}")]
    Unsupported(String),
    /// No pressures or tractions satisfy the conditions: they cannot carry the prescribed force, or, with two periods, not take the prescribed approach.
    #[error("{0}")]
    Infeasible(String),
    /// The influence coefficients are not those of a positive definite operator.
    #[error("{0}")]
    NotPositiveDefinite(String),
    /// The influence coefficients differ from those of the solver's set-up.
    #[error("{0}")]
    InfluenceChanged(String),
    /// Memory could not be allocated.
    #[error("{0}")]
    OutOfMemory(String),
}

impl From<par::OutOfMemory> for Error {
    fn from(par::OutOfMemory(message): par::OutOfMemory) -> Error {
        Error::OutOfMemory(message)
    }
}

/// Result with this crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Shorthand for `Err(Error::InvalidArgument(..))`.
pub(crate) fn invalid<T>(message: String) -> Result<T> {
    Err(Error::InvalidArgument(message))
}

/// Formats a number for a message; very large and very small ones with an exponent: `-0.5`, `3`, `2e-9`.
pub(crate) struct Number(pub f64);

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Number(value) = self;
        if *value == 0.0 || (1e-4..1e15).contains(&value.abs()) {
            write!(f, "{value}")
        } else {
            write!(f, "{value:e}")
        }
    }
}

/// Formats a computed number for a message, rounded to six digits.
pub(crate) struct Rounded(pub f64);

impl std::fmt::Display for Rounded {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let rounded = format!("{:.5e}", self.0).parse().unwrap_or(self.0);
        write!(f, "{}", Number(rounded))
    }
}

/// Refuses a `value` unless `holds`. The message names the value and the `rule` that it breaks. The error is `NotFinite` for NaN and infinities, else
/// `InvalidArgument`.
pub(crate) fn require(holds: bool, name: &str, value: f64, rule: &str) -> Result<()> {
    let message = || format!("{name} is {}; {rule}", Number(value));
    match (holds, value.is_finite()) {
        (true, _) => Ok(()),
        (false, true) => Err(Error::InvalidArgument(message())),
        (false, false) => Err(Error::NotFinite(message())),
    }
}

/// Refuses a value that is not finite.
pub(crate) fn finite(name: &str, value: f64) -> Result<()> {
    require(value.is_finite(), name, value, "it must be finite")
}

/// Refuses a value that is not positive, or not finite.
pub(crate) fn positive(name: &str, value: f64) -> Result<()> {
    require(value > 0.0 && value.is_finite(), name, value, "it must be positive and finite")
}

/// Refuses a value that is negative, or not finite.
pub(crate) fn not_negative(name: &str, value: f64) -> Result<()> {
    require(value >= 0.0 && value.is_finite(), name, value, "it must be 0 or more, and finite")
}
