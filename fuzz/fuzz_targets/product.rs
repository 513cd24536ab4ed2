#![no_main]

#[path = "../../crates/toeplitz/tests/bytes/mod.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    bytes::product(data);
});
