//! contact-normal
#![warn(missing_docs)]
pub mod error;
pub mod grid;
pub mod influence;
pub mod operator;
pub mod threads;
