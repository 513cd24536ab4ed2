//! Compares products of a handle with random pressures, for all effects, with products by the coefficients of the campaign.

use campaign::call::Handle;
use campaign::case::Case;
use campaign::random::Random;

#[test]
fn products_of_random_scenes_are_those_of_the_oracle() {
    let (mut asked, mut names) = (0, std::collections::BTreeSet::new());
    for seed in 0..400 {
        let case = Case::new(seed);
        if case.grid.len() > 1200 {
            continue;
        }
        // If the library refuses the scene, there is no product.
        let Ok(mut handle) = Handle::new(&case) else { continue };
        let random = &mut Random::new(seed);
        let p: Vec<f64> = (0..case.grid.len()).map(|_| random.between(-1.0, 1.0)).collect();
        let (found, operator) = (handle.product(&p), case.operator());
        let expected = operator.displace(&p);
        let rounding = operator.rounding(&p);
        let largest = expected.iter().fold(0.0f64, |largest, u| largest.max(u.abs()));
        for (found, expected) in found.iter().zip(&expected) {
            let off = (found - expected).abs();
            // The coefficients of a coating have an error of 2e-10. Products by FFT and closed forms have errors of some units of round-off.
            assert!(off <= 1e-9 * largest + 100.0 * rounding, "seed {seed} {}: {found} {expected}", case.describe());
        }
        asked += 1;
        names.insert(case.effects.name());
    }
    assert!(asked > 150 && names.len() > 10, "{asked}: {names:?}");
}
