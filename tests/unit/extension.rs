use super::*;

/// E^T M E by the definition, M being `2 z_i - z_(i-1) - z_(i+1)`.
fn by_definition(z: &[f64], contact: &[bool], (mx, my): (usize, usize)) -> Vec<f64> {
    let box_of = |i: usize| {
        let (x, y) = (i % mx, i / mx);
        let columns = x.saturating_sub(REACH)..mx.min(x + REACH + 1);
        (y.saturating_sub(REACH)..my.min(y + REACH + 1)).flat_map(move |y| columns.clone().map(move |x| y * mx + x))
    };
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

#[test]
fn it_is_what_the_definition_says() {
    // Rows without contact near them, pieces at the edges; grids narrower than a box, and several chunks wide, more than are summed together;
    // rows that are worked on together, and those left at the end.
    let sizes = [
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
    for (mx, my) in sizes {
        let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
        for threads in [Threads::One, Threads::new(2).unwrap()] {
            let mut contact: Vec<bool> = (0..mx * my).map(|i| i / mx < my.div_ceil(3) && (7 * i) % 11 < 3).collect();
            let mut segments = Segments::new(&grid, &threads).unwrap();
            segments.change_all();
            let mut extension = Extension::<f64>::new(&grid, &threads).unwrap();
            // As it is, changed in one place, and as it was: what was there before does not matter.
            for _ in 0..3 {
                segments.find(&contact);
                let z = |i: usize| if contact[i] { (i as f64).sin() + 0.3 } else { 0.0 };
                let z: Vec<f64> = (0..mx * my).map(z).collect();
                let expected = by_definition(&z, &contact, (mx, my));
                let mut result = z.clone();
                extension.wake(mx * my);
                let area = Area { contact: &contact, segments: &segments };
                extension.around(&mut result, area, 1.0, |z| z.copy_from_slice(&differences(z)));
                for i in (0..mx * my).filter(|&i| contact[i]) {
                    assert!((result[i] - expected[i]).abs() < 1e-13, "{mx} x {my}, {i}: {} {}", result[i], expected[i]);
                }
                let last = mx * my - 1;
                contact[last] = !contact[last];
                segments.list_changing(&contact, &mut vec![0.0; mx * my], |block, _, listed| {
                    listed.extend(block.elements().filter(|i| *i == last).map(|i| i as u32));
                });
                segments.change_listed(|_| true);
            }
        }
    }
}
