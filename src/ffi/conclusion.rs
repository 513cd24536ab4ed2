//! The end of a call: its status, its message and its warnings.

use super::status::{contact_normal_status, set_last_error, set_last_text, Refusal, CONTACT_NORMAL_OK};
use super::warnings;
use crate::solver::Outcome;

/// How a solve ended.
#[derive(Default)]
pub(super) struct Conclusion {
    pub status: contact_normal_status,
    /// The message; empty after OK.
    pub message: String,
    /// CONTACT_NORMAL_WARNING_... bits.
    pub warnings: i32,
    /// Whether `max_seconds` ended the solve.
    pub is_late: bool,
}

impl From<Refusal> for Conclusion {
    fn from(refusal: Refusal) -> Conclusion {
        Conclusion { status: refusal.status, message: refusal.message, ..Conclusion::default() }
    }
}

impl Conclusion {
    /// The conclusion of a solve that ended with `outcome`. Unless the outcome is `Converged`, the conclusion has the `message`.
    pub fn of(outcome: Outcome, message: impl FnOnce() -> String) -> Conclusion {
        let message = if outcome == Outcome::Converged { String::new() } else { message() };
        Conclusion { status: outcome.into(), message, ..Conclusion::default() }
    }

    /// Ends an exported function: the message and the warnings become the message of this thread.
    pub fn conclude(self) -> Result<contact_normal_status, Refusal> {
        if self.status < CONTACT_NORMAL_OK {
            return Err(Refusal::new(self.status, self.message));
        }
        let warnings = warnings::text(self.warnings);
        match (self.status > CONTACT_NORMAL_OK, warnings.is_empty()) {
            (true, true) => set_last_error(&self.message),
            (true, false) => set_last_error(&format!("{}; {}", self.message, warnings.to_string_lossy())),
            (false, false) => set_last_text(warnings),
            (false, true) => {}
        }
        Ok(self.status)
    }
}
