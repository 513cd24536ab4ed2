//! Random bytes through the C ABI: every call returns a known status, untouched outputs when it refuses, and the truth when it is OK.
//! The bytes are the same at every run; fuzz/ has the same targets for cargo-fuzz.

use crate::target;

/// Runs a target on so many strings of bytes.
fn run(runs: u64, target: fn(&[u8])) {
    let mut state = 1u64;
    let mut next = move || {
        // splitmix64
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    for number in 0..runs {
        let length = next() % 3000;
        let bytes: Vec<u8> = (0..length).map(|_| next() as u8).collect();
        let outcome = std::panic::catch_unwind(|| target(&bytes));
        assert!(outcome.is_ok(), "bytes number {number}");
    }
}

#[test]
fn scenes_and_options() {
    run(6000, target::scene_and_options);
}

#[test]
fn tables_of_coefficients() {
    run(6000, target::tables);
}

#[test]
fn the_corpus_of_the_fuzz_targets() {
    let mut found = 0;
    for (folder, target) in [("scene", target::scene_and_options as fn(&[u8])), ("table", target::tables as fn(&[u8]))]
    {
        let corpus = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(folder);
        for file in std::fs::read_dir(corpus).expect("the corpus") {
            target(&std::fs::read(file.expect("a file").path()).expect("bytes"));
            found += 1;
        }
    }
    assert!(found > 20, "{found} files");
}
