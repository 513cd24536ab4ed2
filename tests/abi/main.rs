//! What the C ABI promises whatever comes in; called from Rust.

mod bad_handles;
mod bad_input;
mod boundary;
mod call;
mod callbacks;
mod coating;
mod friction_batch;
mod odd_input;
mod rows;
mod struct_sizes;
mod subsurface_stress;
mod tangential_handle;
mod warnings;
mod watching;
