//! Calls the fuzz target with random bytes, which are the same in each run.

mod bytes;

#[test]
fn products_from_random_bytes_are_those_term_by_term() {
    let mut state = 1_u64;
    // Knuth's linear congruential generator MMIX.
    let mut draw = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as u8
    };
    for _ in 0..400 {
        let length = 4 * usize::from(draw());
        let data: Vec<u8> = (0..length).map(|_| draw()).collect();
        bytes::product(&data);
    }
}
