//! Runs some cases of the campaign. `make campaign N=20000` runs more of them, and `make campaign SURFACES=measured N=5000` cases with surfaces like
//! measured ones.

use campaign::account::Account;
use campaign::run::{measured, ordinary, Run};

/// Runs the cases of the first seeds. No promise may be broken, and at least `least` calls must be solved.
fn clean(seeds: u64, run: fn(u64) -> Run, least: usize) {
    let mut account = Account::default();
    for seed in 0..seeds {
        account.add(&run(seed));
    }
    assert!(account.solved() >= least, "only {} calls were solved\n{account}", account.solved());
    assert!(account.is_clean(), "{account}\n{}", account.failures(5));
}

#[test]
fn every_answer_to_a_random_scene_is_true_and_auto_solves_elastic_bodies() {
    clean(400, ordinary, 280);
}

#[test]
fn every_answer_to_what_people_bring_is_true_and_auto_solves_it() {
    clean(100, measured, 70);
}
