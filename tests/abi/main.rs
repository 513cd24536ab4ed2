//! What the C ABI promises for any input, tested by calls from Rust.

mod bad_handles;
mod bad_input;
mod boundary;
mod by_name;
mod call;
mod callbacks;
mod coating;
mod dump;
mod dump_calls;
mod dump_handles;
mod dump_scene;
mod friction_batch;
mod heat;
mod laws;
mod odd_input;
mod rows;
mod struct_sizes;
mod subsurface_stress;
mod tangential_handle;
mod warnings;
mod watching;
mod wear;
mod what_matters;
