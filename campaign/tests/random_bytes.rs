//! Makes calls of the C ABI from random bytes. Every call returns a known status. A refused call leaves its outputs untouched, and each other result
//! is checked. The bytes are the same in every run. fuzz/ has the same targets for cargo-fuzz.

use campaign::bytes;
use campaign::random::Random;

type Target = fn(&[u8]) -> Vec<i32>;

/// Runs a target on this many random strings of bytes. Returns the numbers of calls with the statuses 0, 1, 2 and 3.
fn run(runs: u64, target: Target) -> [u64; 4] {
    let mut answers = [0; 4];
    let mut random = Random::new(1);
    for number in 0..runs {
        let length = random.integer(0, 2999);
        let bytes: Vec<u8> = (0..length).map(|_| random.integer(0, 255) as u8).collect();
        let outcome = std::panic::catch_unwind(|| target(&bytes));
        let statuses = outcome.unwrap_or_else(|_| panic!("bytes number {number}"));
        statuses.iter().filter(|&&status| status >= 0).for_each(|&status| answers[status as usize] += 1);
    }
    answers
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
fn frictions() {
    let answers = run(6000, bytes::friction);
    // Most random scenes are refused. Enough of them must be solved, so that the test checks something.
    assert!(answers[0] >= 300, "{answers:?}");
}

#[test]
fn the_corpus_of_the_fuzz_targets() {
    let mut found = 0;
    let targets =
        [("scene", bytes::scene_and_options as Target), ("table", bytes::tables), ("friction", bytes::friction)];
    for (folder, target) in targets {
        let corpus = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(folder);
        for file in std::fs::read_dir(corpus).expect("the corpus") {
            target(&std::fs::read(file.expect("a file").path()).expect("bytes"));
            found += 1;
        }
    }
    assert!(found > 40, "{found} files");
}
