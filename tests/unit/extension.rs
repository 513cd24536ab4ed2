use super::*;

/// E^T M E z by its definition, with the stand-in M `2 z_i - z_(i-1) - z_(i+1)`.
fn by_definition(z: &[f64], contact: &[bool], (mx, my): (usize, usize)) -> Vec<f64> {
    let near = |a: usize, b: usize| a.abs_diff(b) <= REACH;
    let box_of = |i: usize| (0..mx * my).filter(move |&j| near(i % mx, j % mx) && near(i / mx, j / mx));
    let c = (BOX.min(mx) * BOX.min(my)) as f64 / 8.0;
    let mut e = vec![vec![0.0; mx * my]; mx * my];
    for i in 0..mx * my {
        if contact[i] {
            e[i][i] = 1.0;
            continue;
        }
        let near: Vec<usize> = box_of(i).filter(|&j| contact[j]).collect();
        near.iter().for_each(|&j| e[i][j] = 1.0 / (near.len() as f64 + c));
    }
    let extended: Vec<f64> = e.iter().map(|row| row.iter().zip(z).map(|(e, z)| e * z).sum()).collect();
    let m = differences(&extended);
    (0..mx * my).map(|j| (0..mx * my).map(|i| e[i][j] * m[i]).sum()).collect()
}

fn differences(z: &[f64]) -> Vec<f64> {
    let at = |i: Option<usize>| i.and_then(|i| z.get(i)).copied().unwrap_or(0.0);
    (0..z.len()).map(|i| 2.0 * z[i] - at(i.checked_sub(1)) - at(Some(i + 1))).collect()
}

/// Grids with rows that have no contact near them and with contact at their edges; grids narrower than a box, and several chunks wide; rows that are
/// processed together, and single rows at the end.
const SIZES: [(usize, usize); 12] = [
    (23, 31),
    (5, 40),
    (1, 30),
    (30, 1),
    (64, 3),
    (70, 9),
    (76, 29),
    (130, 18),
    (200, 12),
    (200, 7),
    (600, 2),
    (513, 1),
];

fn in_contact((mx, my): (usize, usize)) -> Vec<bool> {
    (0..mx * my).map(|i| i / mx < my.div_ceil(3) && (7 * i) % 11 < 3).collect()
}

#[test]
fn the_extension_is_what_its_definition_says() {
    for threads in [Threads::One, Threads::new(2).unwrap()] {
        for size in SIZES {
            is_by_definition(size, &threads);
        }
    }
}

/// Compares the extension with its definition for C, for C with one change, and for C again. Earlier results must have no effect, and only changed
/// boxes are counted.
fn is_by_definition((mx, my): (usize, usize), threads: &Threads) {
    let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
    let mut contact = in_contact((mx, my));
    let mut extension = Extension::<f64, 1>::new(&grid, threads).unwrap();
    extension.wake();
    let last = mx * my - 1;
    for change in [None, Some(last), Some(last)] {
        change.into_iter().for_each(|i| contact[i] = !contact[i]);
        extension.count(&contact, |inside| inside, |elements| change.is_none_or(|i| elements.contains(&i)));
        let z = |i: usize| if contact[i] { (i as f64).sin() + 0.3 } else { 0.0 };
        let z: Vec<f64> = (0..mx * my).map(z).collect();
        let expected = by_definition(&z, &contact, (mx, my));
        let mut result = z.clone();
        extension.around(&mut result, 1.0, |z| z.copy_from_slice(&differences(z)));
        for i in (0..mx * my).filter(|&i| contact[i]) {
            let off = (result[i] - expected[i]).abs();
            assert!(off < 1e-13, "{mx} x {my}, {i}: {} {}", result[i], expected[i]);
        }
    }
}

/// Each component of a field of two is extended as a single field. The given values do not change.
#[test]
fn components_are_extended_as_one_field_is() {
    for (mx, my) in SIZES {
        let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
        let contact = in_contact((mx, my));
        let mut both = Extension::<f32, 2>::new(&grid, &Threads::One).unwrap();
        let mut one = Extension::<f32, 1>::new(&grid, &Threads::One).unwrap();
        both.wake();
        one.wake();
        let bound: Vec<f64> = contact.iter().map(|inside| f64::from(u8::from(*inside))).collect();
        both.count(&bound, |g| g > 0.0, |_| true);
        one.count(&contact, |inside| inside, |_| true);
        let value = |i: usize, of: f32| if contact[i] { (of * i as f32).sin() } else { 0.0 };
        let given = [1.0, 1.7].map(|of| (0..mx * my).map(|i| value(i, of)).collect::<Vec<_>>());
        let [mut x, mut y] = [vec![f32::NAN; mx * my], vec![f32::NAN; mx * my]];
        both.between([&given[0], &given[1]], [&mut x, &mut y], 1.5, |from, to| {
            for ((from, to), factor) in from.into_iter().zip(to).zip([2.0, 3.0]) {
                to.iter_mut().zip(from).for_each(|(to, from)| *to = factor * from);
            }
        });
        for ((given, found), factor) in given.iter().zip([x, y]).zip([2.0, 3.0]) {
            let mut z = given.clone();
            one.around(&mut z, 1.5, |z| z.iter_mut().for_each(|z| *z *= factor));
            assert!((0..mx * my).all(|i| !contact[i] || found[i] == z[i]), "{mx} x {my}, times {factor}");
        }
    }
}
