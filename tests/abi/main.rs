//! What the C ABI promises whatever comes in; called from Rust.

mod bad_input;
mod boundary;
mod call;
mod callbacks;
mod coating;
mod friction_batch;
mod rows;
mod subsurface_stress;
