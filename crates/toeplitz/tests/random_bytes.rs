//! Random bytes, the same at each run, through the fuzz target.

mod bytes;

#[test]
fn products_from_random_bytes_are_those_term_by_term() {
    let mut state = 1_u64;
    // Knuth's linear congruence.
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
