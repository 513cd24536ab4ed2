#![no_main]

#[allow(dead_code)]
#[path = "../../tests/random_bytes/target.rs"]
mod target;

libfuzzer_sys::fuzz_target!(|data: &[u8]| target::tables(data));
