#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    campaign::bytes::scene_and_options(data);
});
