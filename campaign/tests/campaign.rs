//! 500 cases of the campaign; `make campaign N=20000` runs more.

use campaign::account::Account;
use campaign::run;

#[test]
fn every_answer_to_a_random_scene_is_true_and_auto_solves_elastic_bodies() {
    let mut account = Account::default();
    for seed in 0..500 {
        account.add(&run::ordinary(seed));
    }
    // Most calls of the campaign are of scenes that have a solution.
    assert!(account.solved() >= 350, "only {} calls were solved\n{account}", account.solved());
    assert!(account.is_clean(), "{account}\n{}", account.failures(5));
}
