//! Passes over segments of the contact area with SIMD lanes of different lengths. The elements that leave and enter the contact are compared with the
//! rules of the admissible sets.

use super::super::block::Terms;
use super::super::passes::{Changes, Sum};
use super::*;
use crate::contact::{AdmissibleSet, Fixed, NonNegative};
use crate::methods::projected_cg::formulas::*;
use crate::methods::projected_cg::step_sums::Update;
use crate::scene::{Each, PressureLimit};

/// A contact area, its segments, and arrays of varying values.
struct Given {
    contact: Vec<bool>,
    segments: Vec<u32>,
    doubles: [Vec<f64>; 3],
    singles: [Vec<f32>; 3],
}

fn given(n: usize) -> Given {
    let value = |i: usize, k: usize| ((i * i + 3 * i * k) as f64).sin() / (1 + k) as f64;
    let contact: Vec<bool> = (0..n).map(|i| i % 31 < 6 || i % 17 == 3 || i + 1 == n).collect();
    Given {
        segments: (0..n.div_ceil(LANES))
            .filter(|k| contact[LANES * k..].iter().take(LANES).any(|c| *c))
            .map(|k| k as u32)
            .collect(),
        contact,
        doubles: std::array::from_fn(|k| (0..n).map(|i| value(i, k)).collect()),
        singles: std::array::from_fn(|k| (0..n).map(|i| value(i, 5 + k) as f32).collect()),
    }
}

const UPDATES: [Update; 2] = [
    Update { alpha: 0.7, gamma: 0.0, is_corrected: false, factor: 1.1 },
    Update { alpha: 0.7, gamma: 0.2, is_corrected: true, factor: 0.5 },
];

/// The sums of a pass with the lanes of a machine, as bits.
fn sums<const A: usize, const B: usize, const K: usize>(
    arch: pulp::Arch,
    block: Block<'_>,
    (a, b): ([&[f64]; A], [&[f32]; B]),
    terms: impl Terms<A, B, K>,
) -> Vec<u64> {
    arch.dispatch(Sum { block, arrays: Arrays::of(block, a, b), terms }).map(f64::to_bits).into()
}

/// The results of all passes with the lanes of a machine, as bits.
fn by(arch: pulp::Arch, n: usize) -> Vec<Vec<u64>> {
    let Given { contact, segments, doubles: [h, u, p], singles: [t, q, z] } = &given(n);
    let (block, terms) = (Block::new(0, contact, n, segments), StepTerms { approach: 0.1 });
    let (residual, work) = (Residual { approach: 0.1 }, |update| WorkAndEnergy { approach: 0.1, update });
    let mut found = vec![
        sums::<3, 2, 5>(arch, block, ([h, u, p], [t, q]), terms),
        sums::<3, 2, 9>(arch, block, ([h, u, p], [t, q]), terms),
        sums::<3, 3, 7>(arch, block, ([h, u, p], [t, q, z]), terms),
        sums::<2, 0, 2>(arch, block, ([h, u], []), residual),
        sums::<2, 1, 2>(arch, block, ([h, u], [t]), residual),
        sums::<0, 3, 4>(arch, block, ([], [t, q, z]), Conjugate),
        sums::<1, 0, 1>(arch, block, ([p], []), Carried),
    ];
    for update in &UPDATES {
        found.push(sums::<2, 2, 1>(arch, block, ([h, u], [q, z]), Distance { update, approach: 0.1 }));
        found.push(sums::<3, 3, 2>(arch, block, ([h, u, p], [q, z, t]), work(update)));
    }
    for forecast in [None, Some(0.9)] {
        let mut t = t.clone();
        let arrays = Arrays::of(block, [&p[..]], [&q[..]]);
        arch.dispatch(Changes { block, data: &mut t, arrays, change: Direction { mean: 0.1, beta: 0.3, forecast } });
        found.push(t.iter().map(|t| u64::from(t.to_bits())).collect());
        let moved = Moved { alpha: 0.7, gamma: 0.2 };
        found.push(leaving(
            arch,
            block,
            (p, t.as_slice(), q),
            Leaving { moved, forecast, set: NonNegative, elements: n },
        ));
        let set = PressureLimit(Each::Uniform(0.2));
        found.push(leaving(arch, block, (p, t.as_slice(), q), Leaving { moved, forecast, set, elements: n }));
    }
    for held in [vec![], (0..n).map(|i| !contact[i] && i % 3 == 0).collect()] {
        let wanted = Entering { approach: 0.1, is_fixed: false, held: &held };
        let (mut u, mut list) = (u.clone(), Vec::new());
        let (data, list_of, arrays) = (&mut u[..], &mut list, Arrays::of(block, [&h[..]], [&q[..]]));
        arch.dispatch(Everywhere { block, data, list: list_of, arrays, change: MovedU(&UPDATES[0]), wanted });
        let (data, list_of, arrays) = (&mut u[..], &mut list, Arrays::of(block, [&h[..]], [&q[..], t, z]));
        arch.dispatch(Everywhere { block, data, list: list_of, arrays, change: MovedU(&UPDATES[1]), wanted });
        found.push(u.iter().map(|u| u.to_bits()).collect());
        found.push(list.into_iter().map(u64::from).collect());
    }
    found
}

fn leaving<S: AdmissibleSet>(
    arch: pulp::Arch,
    block: Block<'_>,
    (p, t, d): (&[f64], &[f32], &[f32]),
    wanted: Leaving<S>,
) -> Vec<u64> {
    let mut list = Vec::new();
    arch.dispatch(List { block, list: &mut list, data: p, arrays: Arrays::of(block, [], [t, d]), wanted });
    list.into_iter().map(u64::from).collect()
}

#[test]
fn no_bit_depends_on_the_length_of_vectors() {
    for n in [3, 8, 1001, 4096] {
        let here = by(pulp::Arch::new(), n);
        assert!(by(pulp::Arch::Scalar, n) == here, "{n} elements");
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = pulp::x86::V3::try_new() {
            assert!(by(pulp::Arch::V3(avx2), n) == here, "{n} elements");
        }
    }
}

/// Asserts that the elements that leave the contact, and those forecast to leave, are those of the set's rule.
fn check_who_leaves<S: AdmissibleSet>(set: S, n: usize) {
    let Given { contact, segments, doubles: [p, ..], singles: [t, d, _] } = &given(n);
    let p: Vec<f64> = p.iter().map(|p| p.abs()).collect();
    let block = Block::new(0, contact, n, segments);
    for (moved, forecast) in [
        (Moved { alpha: 0.7, gamma: 0.0 }, None),
        (Moved { alpha: 0.7, gamma: 1.3 }, None),
        (Moved { alpha: 0.1, gamma: 0.0 }, Some(2.0)),
        (Moved { alpha: 1.5, gamma: 0.5 }, Some(1.5)),
    ] {
        let leaves = |i: usize| {
            let (t, d) = (f64::from(t[i]), f64::from(d[i]));
            let foreseen = forecast.map(|forecast| p[i] + forecast * t);
            let held = foreseen.is_some_and(|p_then| p_then <= 1e-6 * p[i] || p_then >= set.limit(i) * (1.0 - 1e-6));
            contact[i] && (set.leaves(i, p[i] + (moved.alpha * t + moved.gamma * d)) || held)
        };
        let expected: Vec<u64> = (0..n).filter(|&i| leaves(i)).map(|i| i as u64).collect();
        assert!(!expected.is_empty() || n < 1000, "nobody leaves");
        let wanted = Leaving { moved, forecast, set, elements: n };
        assert_eq!(leaving(pulp::Arch::new(), block, (&p, t, d), wanted), expected, "{n} elements");
    }
}

#[test]
fn elements_leave_by_the_rule_of_the_admissible_set() {
    for n in [1, 8, 30, 1001] {
        check_who_leaves(NonNegative, n);
        check_who_leaves(PressureLimit(Each::Uniform(0.6)), n);
        let limits: Vec<f64> =
            (0..n).map(|i| if i % 5 == 0 { f64::INFINITY } else { 0.3 + 0.001 * i as f64 }).collect();
        check_who_leaves(PressureLimit(Each::PerElement(&limits)), n);
    }
}

#[test]
fn what_is_no_number_or_at_a_bound_does_not_leave() {
    // The step leads to pressures of 0, of the limit, and beyond both bounds; one pressure is NaN.
    let (p, t) = ([0.5, 0.5, 0.5, 0.5, f64::NAN], [-0.5_f32, 0.5, -0.6, 0.6, 1.0]);
    let block = Block::new(0, &[true; 5], 5, &[0]);
    let (moved, set) = (Moved { alpha: 1.0, gamma: 0.0 }, PressureLimit(Each::Uniform(1.0)));
    let wanted = Leaving { moved, forecast: None, set, elements: 5 };
    assert_eq!(leaving(pulp::Arch::new(), block, (&p, &t, &t), wanted), [2, 3]);
}

/// Asserts that the elements that enter the contact after a step are those of the set's rule.
fn check_who_enters<S: AdmissibleSet>(set: S, n: usize) {
    let Given { contact, doubles: [h, before, _], singles: [_, q, z], .. } = &given(n);
    // Some elements have no surface, and must not enter.
    let h: Vec<f64> = h.iter().enumerate().map(|(i, h)| if i % 13 == 5 { f64::INFINITY } else { *h }).collect();
    let at_limit: Vec<bool> = (0..n).map(|i| S::LIMITED && !contact[i] && i % 3 == 0).collect();
    let held = if S::LIMITED { &at_limit[..] } else { &[] };
    let block = Block::new(0, contact, n, &[]);
    let entering = Entering { approach: 0.1, is_fixed: S::FIXED, held };
    for update in &UPDATES {
        let (mut u, mut list) = (before.clone(), Vec::new());
        match update.is_corrected {
            true => block.change_and_list_outside(&mut u, &mut list, [&h], [&q[..], q, z], MovedU(update), entering),
            false => block.change_and_list_outside(&mut u, &mut list, [&h], [&q[..]], MovedU(update), entering),
        }
        for (i, u) in u.iter().enumerate() {
            let repair = if update.is_corrected { update.gamma * f64::from(q[i]) + f64::from(z[i]) } else { 0.0 };
            let expected = update.factor * (before[i] + update.alpha * f64::from(q[i]) + repair);
            assert!((u - expected).abs() < 1e-15, "element {i} of {n}");
        }
        let enters = |i: &usize| !contact[*i] && set.enters(at_limit[*i], h[*i] - 0.1 + u[*i]);
        let expected: Vec<u32> = (0..n).filter(enters).map(|i| i as u32).collect();
        assert!(expected.is_empty() == S::FIXED || n < 1000, "who enters");
        assert_eq!(list, expected, "{n} elements");
    }
}

#[test]
fn elements_enter_by_the_rule_of_the_admissible_set() {
    for n in [1, 8, 30, 1001] {
        check_who_enters(NonNegative, n);
        check_who_enters(PressureLimit(Each::Uniform(1.0)), n);
        check_who_enters(Fixed, n);
    }
}

#[test]
fn at_e_of_zero_nobody_enters() {
    let (h, mut u, mut list) = ([1.0, 1.0, 1.0, 1.0], [0.0, -0.5, 0.5, 0.0], Vec::new());
    let (block, update) = (Block::new(0, &[false; 4], 4, &[]), Update::default());
    let plain = Entering { approach: 1.0, is_fixed: false, held: &[] };
    block.change_and_list_outside(&mut u, &mut list, [&h], [&[0.0_f32; 4][..]], MovedU(&update), plain);
    assert_eq!(list, [1]);
    list.clear();
    let entering = Entering { held: &[false, false, true, true], ..plain };
    block.change_and_list_outside(&mut u, &mut list, [&h], [&[0.0_f32; 4][..]], MovedU(&update), entering);
    assert_eq!(list, [1, 2]);
}

/// The sums over C of `terms(element)`, element by element.
fn plain<const K: usize>(contact: &[bool], terms: impl Fn(usize) -> [f64; K]) -> [f64; K] {
    let mut sums = [0.0; K];
    for i in (0..contact.len()).filter(|&i| contact[i]) {
        sums.iter_mut().zip(terms(i)).for_each(|(sum, term)| *sum += term);
    }
    sums
}

/// Asserts that sums are equal up to the round-off of some hundred terms of at most 1.
fn check<const K: usize>(found: [f64; K], expected: [f64; K], what: &str) {
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found - expected).abs() < 1e-12, "{what}, sum {k}: {found} for {expected}");
    }
}

#[test]
fn sums_of_a_step_are_what_they_say() {
    let Given { contact, segments, doubles: [h, u, p], singles } = &given(1001);
    let block = Block::new(0, contact, 1001, segments);
    let [t, q, d] = [0, 1, 2].map(|k| move |i: usize| f64::from(singles[k][i]));
    let (r, depth) = (|i: usize| 0.1 - h[i] - u[i], |i: usize| 0.1 - h[i]);
    let step = |i: usize| [r(i) * t(i), t(i) * q(i), t(i) * t(i), t(i).abs(), p[i] * p[i]];
    let terms = StepTerms { approach: 0.1 };
    let ([a, b, c], [of_t, of_q, of_d]) = ([&h[..], u, p], [&singles[0][..], &singles[1], &singles[2]]);
    check(block.sum([a, b, c], [of_t, of_q], terms), plain(contact, step), "a step");
    let scaled = |i: usize| {
        let [rt, tq, tt, t1, pp] = step(i);
        [rt, tq, tt, t1, pp, p[i] * depth(i), t(i) * depth(i), p[i] * u[i], p[i] * q(i)]
    };
    check(block.sum([a, b, c], [of_t, of_q], terms), plain(contact, scaled), "a step with the energy");
    let beside = |i: usize| {
        let [rt, tq, tt, t1, pp] = step(i);
        [rt, tq, tt, t1, pp, r(i) * d(i), q(i) * d(i)]
    };
    check(block.sum([a, b, c], [of_t, of_q, of_d], terms), plain(contact, beside), "a step beside a change");
    let (residual, none): (_, [&[f32]; 0]) = (Residual { approach: 0.1 }, []);
    check(block.sum([a, b], none, residual), plain(contact, |i| [r(i) * r(i), depth(i) * depth(i)]), "a residual");
    check(block.sum([a, b], [of_d], residual), plain(contact, |i| [r(i) * d(i), r(i) * r(i)]), "along a change");
    check(block.sum([], [of_t, of_d, of_q], Conjugate), plain(contact, |i| [t(i), d(i), q(i), d(i) * q(i)]), "beta");
    for update in &UPDATES {
        let moved = |i: usize, w: f64, repair: f64| u[i] + update.alpha * q(i) + w + repair;
        let is_corrected = f64::from(u8::from(update.is_corrected));
        let distance = |i: usize| [update.factor * moved(i, 0.0, is_corrected * d(i)) - depth(i)];
        let formula = Distance { update, approach: 0.1 };
        check(block.sum([a, b], [of_q, of_d], formula), plain(contact, distance), "a mean distance");
        let work = |i: usize| [p[i] * depth(i), p[i] * moved(i, update.gamma * t(i), is_corrected * d(i))];
        let formula = WorkAndEnergy { approach: 0.1, update };
        check(block.sum([a, b, c], [of_q, of_d, of_t], formula), plain(contact, work), "work and energy");
    }
}
