use super::*;

/// Coefficients of plane strain: displacements at the centres of elements by a uniform pressure on one element.
fn kernel(n: usize, period: bool) -> Vec<f64> {
    let antiderivative = |x: f64| if x == 0.0 { 0.0 } else { x * (x.abs().ln() - 1.0) };
    let free = |k: f64| antiderivative(k - 0.5) - antiderivative(k + 0.5) + (n as f64).ln() + 1.0;
    let wrapped = |k: usize| if period { k.min(n - k) } else { k };
    (0..n).map(|k| free(wrapped(k) as f64)).collect()
}

/// A contact area on a line, given by pairs: the length of a gap, and the length of the piece after it.
fn contact(n: usize, pieces: &[(usize, usize)]) -> Vec<bool> {
    let mut contact = Vec::new();
    for &(gap, length) in pieces {
        contact.resize(contact.len() + gap, false);
        contact.resize(contact.len() + length, true);
    }
    contact.resize(n, false);
    contact
}

fn areas(n: usize) -> Vec<Vec<bool>> {
    let scattered = (0..n).map(|i| (i * i * 7919 + 31 * i) % 101 < 30).collect();
    vec![
        contact(n, &[]),
        contact(n, &[(7, 1)]),
        contact(n, &[(0, n)]),
        contact(n, &[(3, 20), (1, 1), (30, 5)]),
        (0..n).map(|i| i % 2 == 0).collect(),
        scattered,
    ]
}

/// The pressures g of each punch on its elements, by their definition.
fn shapes(punches: &Punches, n: usize) -> Vec<Vec<f64>> {
    let mut shapes: Vec<Vec<f64>> = Vec::new();
    for &(start, end) in &punches.pieces {
        let inside = |i: usize| (start as usize..end as usize).contains(&i);
        shapes.push((0..n).map(|i| if inside(i) { punches.weights[i] } else { 0.0 }).collect());
    }
    for Joint { left, right, part, .. } in &punches.joints {
        let (l, r) = (&shapes[*left as usize], &shapes[*right as usize]);
        let joined = l.iter().zip(r).map(|(l, r)| part * l + (1.0 - part) * r).collect();
        shapes.push(joined);
    }
    shapes
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Q^T Q r and the terms of the joints by their definition, with 1 for M.
fn by_definition(punches: &Punches, r: &[f64], without_force: bool) -> Vec<f64> {
    let (n, shapes) = (r.len(), shapes(punches, r.len()));
    let mut z = r.to_vec();
    for (&(start, end), g) in punches.pieces.iter().zip(&shapes) {
        let piece = start as usize..end as usize;
        let mean = product(g, r);
        z[piece.clone()].iter_mut().for_each(|z| *z -= mean);
        let force: f64 = z[piece].iter().sum();
        z.iter_mut().zip(g).for_each(|(z, g)| *z -= force * g);
    }
    for Joint { left, right, energy, .. } in &punches.joints {
        let (l, r_) = (&shapes[*left as usize], &shapes[*right as usize]);
        let apart: Vec<f64> = (0..n).map(|i| l[i] - r_[i]).collect();
        let force = FORCES_FACTOR * product(&apart, r) / energy;
        z.iter_mut().zip(&apart).for_each(|(z, apart)| *z += force * apart);
    }
    if let (Some(g), Some(all), false) = (shapes.last(), punches.punches.last(), without_force) {
        let force = FORCES_FACTOR * product(g, r) / all.energy;
        z.iter_mut().zip(g).for_each(|(z, g)| *z += force * g);
    }
    z
}

#[test]
fn forces_of_pieces_are_those_of_the_definition() {
    let n = 150;
    for period in [false, true] {
        let mut punches = Punches::new(kernel(n, period), period.then_some(n as f64)).unwrap();
        for (case, contact) in areas(n).iter().enumerate() {
            punches.find(contact);
            assert_eq!(punches.joints.len(), punches.pieces.len().saturating_sub(1), "case {case}");
            let wave = |i: usize| (0.2 * i as f64).sin() + 0.3;
            let r: Vec<f64> = (0..n).map(|i| if contact[i] { wave(i) } else { 0.0 }).collect();
            for without_force in [false, true] {
                let mut z = r.clone();
                punches.take_means(&mut z);
                punches.give_forces(&mut z, without_force);
                let wanted = by_definition(&punches, &r, without_force);
                let size = wanted.iter().fold(1e-300, |size: f64, z| size.max(z.abs()));
                for i in 0..n {
                    // Both results are sums of some hundred terms of at most this size.
                    assert!((z[i] - wanted[i]).abs() <= 1e-12 * size, "case {case}, {i}: {} {}", z[i], wanted[i]);
                }
                if without_force {
                    let sum: f64 = z.iter().sum();
                    assert!(sum.abs() <= 1e-12 * size * n as f64, "case {case}: a force of {sum}");
                }
            }
        }
    }
}

/// The displacements by joined pieces, by direct sums, differ from the energy by at most a quarter everywhere on C (they are 0.80 to 1.05 of it if
/// every second element is in contact). The energy that is computed without sums is accurate to a twentieth.
#[test]
fn joined_pieces_are_near_a_flat_punch() {
    let n = 400;
    let table = kernel(n, false);
    let mut punches = Punches::new(table.clone(), None).unwrap();
    for pieces in [&[(20, 30), (5, 8), (60, 90), (3, 1), (2, 40)][..], &[(10, 4); 20], &[(1, 1); 150]] {
        let contact = contact(n, pieces);
        punches.find(&contact);
        let count = contact.iter().filter(|inside| **inside).count() as f64;
        let mut d = vec![0.0; n];
        punches.press_flat(&mut d);
        let force: f64 = d.iter().sum();
        assert!((force / count - 1.0).abs() < 1e-12, "mean {}", force / count);
        assert!(d.iter().zip(&contact).all(|(d, inside)| (*d > 0.0) == *inside), "d is positive on C, and 0 elsewhere");
        let u: Vec<f64> = (0..n).map(|i| (0..n).map(|j| table[i.abs_diff(j)] * d[j]).sum::<f64>() / force).collect();
        let energy = product(&d, &u) / force;
        let all = punches.punches.last().unwrap().energy;
        assert!((all / energy - 1.0).abs() < 0.05, "{pieces:?}: energy {energy}, {all} without sums");
        let inside = || u.iter().zip(&contact).filter(|(_, inside)| **inside).map(|(u, _)| u / energy);
        let (least, most) =
            inside().fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), u| (least.min(u), most.max(u)));
        assert!(least > 0.75 && most < 1.25, "{pieces:?}: displacements from {least} to {most} of the energy");
    }
}
