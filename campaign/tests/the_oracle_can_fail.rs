//! Spoils results of the library in one value each. The checks of the campaign must find every spoiled result.

use campaign::call::{self, Outputs};
use campaign::case::Case;
use campaign::friction_call::call;
use campaign::friction_case::Case as Sliding;
use campaign::friction_found::Found;
use campaign::measured;
use campaign::random::Random;
use campaign::refused_force::exceeded;
use campaign::rules;

/// A function that spoils a result of a case.
type Spoil<T, C> = fn(&mut T, &C);

/// Changes of a result without friction: what is changed, and the function.
const NORMAL: [(&str, Spoil<Outputs, Case>); 7] = [
    ("a pressure", |found, _| {
        let greatest = greatest(&found.p);
        found.p[greatest] *= 1.0 + 1e-3;
    }),
    ("a displacement", |found, _| found.u[0] += 1e-3 * found.report.normal.max_pressure),
    ("a distance", |found, _| {
        let greatest = greatest(&found.p);
        found.e[greatest] += 1e-3 * found.u[greatest];
    }),
    ("the residual", |found, _| found.report.normal.residual += 1e-2),
    ("the contact", |found, _| {
        let greatest = greatest(&found.p);
        found.contact[greatest] = 0;
    }),
    ("tension", |found, _| {
        let greatest = greatest(&found.p);
        found.p[greatest] *= -1.0;
    }),
    ("the status", |found, case| {
        // All values belong to each other, but the pressures are 10 % too large, so that the status OK is wrong.
        found.p.iter_mut().for_each(|p| *p *= 1.1);
        found.u = case.operator().displace(&found.p);
        let e = |i: usize| case.h[i] - found.report.normal.approach + found.u[i];
        found.e = (0..found.p.len()).map(e).collect();
    }),
];

/// The element with the largest pressure.
fn greatest(p: &[f64]) -> usize {
    (0..p.len()).fold(0, |best, i| if p[i] > p[best] { i } else { best })
}

#[test]
fn spoiled_answers_without_friction_are_found() {
    let mut spoiled = 0;
    for seed in 0..60 {
        let case = measured::case(seed);
        let is_usual = case.how.criterion == 0 && case.how.fixed.is_none() && case.grid.len() < 4000;
        if !is_usual || case.effects.coating.is_some() || case.how.tolerance > 1e-3 {
            continue;
        }
        let found = call::solve(&case);
        if found.status != 0 || !(found.report.normal.force > 0.0) || !rules::check(&case, &found).failures.is_empty() {
            continue;
        }
        for (what, spoil) in NORMAL {
            let mut bad = call::solve(&case);
            spoil(&mut bad, &case);
            let verdict = rules::check(&case, &bad);
            assert!(!verdict.failures.is_empty(), "seed {seed}: {what} was spoiled: {}", case.describe());
            spoiled += 1;
        }
    }
    assert!(spoiled >= 70, "only {spoiled}");
}

/// Changes of a result with friction: what is changed, and the function. More than one element must be in contact, so that elements act on each
/// other.
const SLIDING: [(&str, Spoil<Found, Sliding>); 5] = [
    ("a traction", |found, case| {
        let greatest = greatest(&found.p);
        found.q[greatest][0] = (1.0 + 2.0 * case.slide.mu[greatest]) * found.p[greatest];
    }),
    ("slip", |found, _| {
        let (greatest, u) = (greatest(&found.p), found.u.iter().copied().fold(0.0, f64::max));
        found.slip[greatest][1] += 1e-3 * u;
    }),
    ("stick_slip", |found, _| {
        let greatest = greatest(&found.p);
        found.stick_slip[greatest] = 0;
    }),
    ("the reported force", |found, _| found.report.tangential.force[0] += 0.1 * found.report.normal.force),
    ("a distance beside the contact", |found, _| {
        let u = found.u.iter().copied().fold(0.0, f64::max);
        found.e.iter_mut().filter(|e| e.is_finite()).for_each(|e| *e += 1e-3 * u);
    }),
];

#[test]
fn spoiled_answers_with_friction_are_found() {
    let mut spoiled = [0, 0];
    for seed in 0..110 {
        let Some(case) = campaign::friction::draw(&mut Random::new(seed)) else { continue };
        let found = call(&case.place, &case.slide, &case.stop);
        // Previous tractions may be 1e9 times the bounds. Then the slip is round-off, and changes of it are not found.
        let is_usual = found.status == 0 && found.report.normal.contact_count > 3 && case.slide.previous.is_none();
        if !is_usual || !campaign::friction_rules::check(&case, &found, &case.before(&found.p)).failures.is_empty() {
            continue;
        }
        for (what, spoil) in SLIDING {
            let mut bad = call(&case.place, &case.slide, &case.stop);
            spoil(&mut bad, &case);
            let verdict = campaign::friction_rules::check(&case, &bad, &case.before(&bad.p));
            assert!(!verdict.failures.is_empty(), "seed {seed}: {what} was spoiled: {}", case.describe());
            spoiled[usize::from(!case.place.is_alike())] += 1;
        }
    }
    assert!(spoiled.iter().all(|count| *count >= 30), "{spoiled:?}");
}

/// Half of mu N is carried by some creepage, so that a wrong refusal of this force would be found. Twice mu N is carried by none.
#[test]
fn refused_forces_that_creepages_carry_are_found() {
    let (mut tried, mut found) = (0, 0);
    for seed in 0..600 {
        let Some(mut case) = campaign::friction::draw(&mut Random::new(seed)) else { continue };
        let slide = &case.slide;
        let is_one = slide.is_force(0) != slide.is_force(1) && slide.rigid.is_none() && slide.previous.is_none();
        let is_usual = slide.uniform && (1e-4..1.0).contains(&slide.mu[0]) && case.carried > 0.0;
        if !is_one || !is_usual || !case.stop.is_unhindered() {
            continue;
        }
        let k = usize::from(case.slide.is_force(1));
        // Spin and the creepage in the other direction would change the direction of tractions, so they are set to 0.
        (case.slide.spin, case.slide.amount) = (0.0, [0.0; 2]);
        case.slide.amount[k] = 0.5 * case.carried;
        found += usize::from(exceeded(&case).is_some());
        case.slide.amount[k] = 2.0 * case.carried;
        assert!(exceeded(&case).is_none(), "seed {seed}: {}", case.describe());
        tried += 1;
    }
    assert!(tried >= 20 && 10 * found >= 9 * tried, "{found} of {tried}");
}
