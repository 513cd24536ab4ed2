#![no_main]

#[allow(dead_code)]
#[path = "../../tests/abi/target.rs"]
mod target;

libfuzzer_sys::fuzz_target!(|data: &[u8]| target::scene_and_options(data));
