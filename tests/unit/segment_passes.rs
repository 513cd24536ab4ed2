use super::*;
use crate::contact::NonNegative;
use crate::methods::projected_cg::formulas::{Direction, Entering, Leaving, Moved, MovedU, StepSums};
use crate::methods::projected_cg::passes::Update;

/// Arrays of a grid that ends within a segment.
struct Arrays {
    contact: Vec<bool>,
    doubles: [Vec<f64>; 3],
    singles: [Vec<f32>; 2],
}

fn arrays(n: usize) -> Arrays {
    let value = |i: usize, k: usize| ((i * i + 3 * i * k) as f64).sin() / (1 + k) as f64;
    Arrays {
        contact: (0..n).map(|i| i % 31 < 6 || i % 17 == 3).collect(),
        doubles: std::array::from_fn(|k| (0..n).map(|i| value(i, k)).collect()),
        singles: std::array::from_fn(|k| (0..n).map(|i| value(i, 5 + k) as f32).collect()),
    }
}

/// What passes with the vectors of a machine leave: sums, a direction, elements that leave, u, elements that enter.
type Left = (Vec<u64>, Vec<u32>, Vec<u32>, Vec<u64>, Vec<u32>);

fn by(arch: pulp::Arch, n: usize) -> Left {
    let Arrays { contact, doubles: [h, u, p], singles: [t, q] } = arrays(n);
    let segments: Vec<u32> = (0..n.div_ceil(EIGHT) as u32).filter(|k| contact[EIGHT * *k as usize]).collect();
    let (block, segments) = (Block::new(0, &contact, n, &segments), &segments[..]);
    let terms = StepSums { approach: 0.1 };
    let arrays = super::Arrays::of(block, [&h[..], &u, &p], [&t[..], &q]);
    let sums: [f64; 9] = arch.dispatch(Sum { segments, arrays, terms });

    let mut direction = t.clone();
    let arrays = super::Arrays::of(block, [&p[..]], [&q[..]]);
    let change = Direction { mean: 0.1, beta: 0.3, forecast: Some(0.9) };
    arch.dispatch(Changes { segments, data: &mut direction, arrays, change });

    let moved = Moved { alpha: 0.7, gamma: 0.2 };
    let wanted = Leaving { moved, forecast: Some(0.9), set: NonNegative, elements: n };
    let (mut leaving, arrays) = (Vec::new(), super::Arrays::of(block, [], [&t[..], &q]));
    arch.dispatch(List { block, list: &mut leaving, data: eights(&p), arrays, wanted });

    let update = Update { alpha: 0.7, factor: 1.1, ..Update::default() };
    let (mut moved, mut entering) = (u.clone(), Vec::new());
    let arrays = super::Arrays::of(block, [&h[..]], [&q[..]]);
    let wanted = Entering { approach: 0.1, is_fixed: false, held: &[] };
    let list = &mut entering;
    arch.dispatch(Everywhere { first: 0, data: &mut moved, list, arrays, change: MovedU(&update), wanted });
    let (bits, single_bits) = (|v: &f64| v.to_bits(), |v: &f32| v.to_bits());
    let sums = sums.iter().map(bits).collect();
    (sums, direction.iter().map(single_bits).collect(), leaving, moved.iter().map(bits).collect(), entering)
}

#[test]
fn no_bit_depends_on_the_length_of_vectors() {
    // A machine without AVX-512 has nothing to compare; valgrind's tests of examples are one without on each machine.
    let Some(avx2) = pulp::x86::V3::try_new() else { return };
    for n in [3, 8, 1001, 4096] {
        let (here, there) = (by(pulp::Arch::new(), n), by(pulp::Arch::V3(avx2), n));
        assert!(here == there, "{n} elements");
        assert!(by(pulp::Arch::Scalar, n) == here, "{n} elements");
    }
}

#[test]
fn elements_enter_that_penetrate_outside() {
    for n in [1, 8, 30, 1001] {
        let Arrays { contact, doubles: [h, before, _], singles: [_, q] } = arrays(n);
        for update in
            [Update { alpha: 0.7, ..Update::default() }, Update { alpha: 0.7, gamma: 0.2, settled: true, factor: 0.5 }]
        {
            let (mut u, mut list) = (before.clone(), Vec::new());
            let block = Block::new(0, &contact, n, &[]);
            let entering = Entering { approach: 0.1, is_fixed: false, held: &[] };
            let products = [&q[..], &q, &q];
            if update.settled {
                block.change_and_list_outside(&mut u, &mut list, [&h], products, MovedU(&update), entering);
            } else {
                block.change_and_list_outside(&mut u, &mut list, [&h], [&q[..]], MovedU(&update), entering);
            }
            let moved = |i: usize| {
                let more = if update.settled { update.gamma + 1.0 } else { 0.0 };
                update.factor * (before[i] + (update.alpha + more) * f64::from(q[i]))
            };
            for (i, u) in u.iter().enumerate() {
                assert!((u - moved(i)).abs() < 1e-15, "element {i} of {n}");
            }
            let enters = |i: &usize| !contact[*i] && h[*i] - 0.1 + u[*i] < 0.0;
            assert_eq!(list, (0..n).filter(enters).map(|i| i as u32).collect::<Vec<_>>(), "{n} elements");
        }
    }
}

#[test]
fn elements_at_their_limit_enter_where_e_is_positive() {
    let n = 101;
    let Arrays { contact, doubles: [h, mut u, _], singles: [_, q] } = arrays(n);
    let held: Vec<bool> = (0..n).map(|i| !contact[i] && i % 3 == 0).collect();
    let (block, update, mut list) = (Block::new(0, &contact, n, &[]), Update::default(), Vec::new());
    let entering = Entering { approach: 0.1, is_fixed: false, held: &held };
    block.change_and_list_outside(&mut u, &mut list, [&h], [&q[..]], MovedU(&update), entering);
    let e = |i: usize| h[i] - 0.1 + u[i];
    let enters = |i: &usize| !contact[*i] && if held[*i] { e(*i) > 0.0 } else { e(*i) < 0.0 };
    assert_eq!(list, (0..n).filter(enters).map(|i| i as u32).collect::<Vec<_>>());
    let (fixed, mut list) = (Entering { is_fixed: true, ..entering }, Vec::new());
    block.change_and_list_outside(&mut u, &mut list, [&h], [&q[..]], MovedU(&update), fixed);
    assert!(list.is_empty());
}
