//! Random bytes through the C ABI: every call returns a known status, untouched outputs when it refuses, and the truth when it is OK.
//! The bytes are the same at every run; fuzz/ has the same targets for cargo-fuzz.

use campaign::bytes;
use campaign::random::Random;

/// Runs a target on so many strings of bytes.
fn run(runs: u64, target: fn(&[u8])) {
    let mut random = Random::new(1);
    for number in 0..runs {
        let length = random.integer(0, 2999);
        let bytes: Vec<u8> = (0..length).map(|_| random.integer(0, 255) as u8).collect();
        let outcome = std::panic::catch_unwind(|| target(&bytes));
        assert!(outcome.is_ok(), "bytes number {number}");
    }
}

#[test]
fn scenes_and_options() {
    run(6000, bytes::scene_and_options);
}

#[test]
fn tables_of_coefficients() {
    run(6000, bytes::tables);
}

#[test]
fn the_corpus_of_the_fuzz_targets() {
    let mut found = 0;
    for (folder, target) in [("scene", bytes::scene_and_options as fn(&[u8])), ("table", bytes::tables as fn(&[u8]))] {
        let corpus = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(folder);
        for file in std::fs::read_dir(corpus).expect("the corpus") {
            target(&std::fs::read(file.expect("a file").path()).expect("bytes"));
            found += 1;
        }
    }
    assert!(found > 20, "{found} files");
}
