use super::*;

/// E^T M E by the definition, M being `2 z_i - z_(i-1) - z_(i+1)`, with cells of `side` x `side` elements.
fn by_definition(z: &[f64], contact: &[bool], (mx, my): (usize, usize), side: usize) -> Vec<f64> {
    let near = |a: usize, b: usize| (a / side).abs_diff(b / side) <= REACH;
    let box_of = |i: usize| (0..mx * my).filter(move |&j| near(i % mx, j % mx) && near(i / mx, j / mx));
    let c = (BOX.min(mx.div_ceil(side)) * BOX.min(my.div_ceil(side)) * side * side) as f64 / 8.0;
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
    // rows that are worked on together, and those left at the end; cells that end beyond the grid, and cells that are all in C.
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
    let by_elements = sizes.map(|size| (size, 1));
    let by_cells = [
        ((23, 31), 2),
        ((70, 9), 4),
        ((45, 45), 4),
        ((300, 5), 2),
        ((400, 3), 2),
        ((19, 90), 8),
        ((280, 7), 16),
        ((3, 500), 16),
    ];
    for threads in [Threads::One, Threads::new(2).unwrap()] {
        for (size, side) in by_elements.into_iter().chain(by_cells) {
            is_by_definition(size, [side; 3], &threads);
        }
        // Cells change, and with them what is counted; a row of more than one chunk of cells, and rows that share their boxes.
        is_by_definition((150, 26), [1, 2, 1], &threads);
        is_by_definition((150, 26), [16, 4, 2], &threads);
        is_by_definition((33, 40), [2, 8, 1], &threads);
    }
}

/// With cells of these sides, one after the other.
fn is_by_definition((mx, my): (usize, usize), sides: [usize; 3], threads: &Threads) {
    let grid = Grid::new(mx, my, 1.0, 1.0).unwrap();
    let in_contact =
        |i: usize| i / mx < my.div_ceil(3) && ((7 * i) % 11 < 3 || sides[0] > 1 && i % mx / sides[0] % 5 == 2);
    let mut contact: Vec<bool> = (0..mx * my).map(in_contact).collect();
    let mut segments = Segments::new(&grid, threads).unwrap();
    segments.change_all();
    let mut extension = Extension::<f64>::new(&grid, threads).unwrap();
    // As it is, changed in one place, and as it was: what was there before does not matter.
    for side in sides {
        segments.find(&contact);
        let z = |i: usize| if contact[i] { (i as f64).sin() + 0.3 } else { 0.0 };
        let z: Vec<f64> = (0..mx * my).map(z).collect();
        let expected = by_definition(&z, &contact, (mx, my), side);
        let mut result = z.clone();
        extension.wake(mx * my);
        extension.take_cells(side);
        let area = Area { contact: &contact, segments: &segments };
        extension.around(&mut result, area, 1.0, |z| z.copy_from_slice(&differences(z)));
        for i in (0..mx * my).filter(|&i| contact[i]) {
            let off = (result[i] - expected[i]).abs();
            assert!(off < 1e-13, "{mx} x {my}, cells of {side}, {i}: {} {}", result[i], expected[i]);
        }
        let last = mx * my - 1;
        contact[last] = !contact[last];
        segments.list_changing(&contact, &mut vec![0.0; mx * my], |block, _, listed| {
            listed.extend(block.elements().filter(|i| *i == last).map(|i| i as u32));
        });
        segments.change_listed(|_| true);
    }
}

#[test]
fn cells_suit_the_pieces_of_contact() {
    // Squares of so many elements, and as many between them.
    let squares = |width: usize, m: usize| -> Vec<bool> {
        (0..m * m).map(|i| i % m / width % 2 == 1 && i / m / width % 2 == 1).collect()
    };
    for (width, side) in
        [(1, 1), (5, 1), (11, 1), (12, 2), (23, 2), (24, 4), (47, 4), (48, 8), (95, 8), (96, 16), (200, 16)]
    {
        let m = 8 * width;
        assert_eq!(suitable_side(&squares(width, m), m), side, "squares of {width}");
    }
    // Long in one direction, short in the other; one piece in each row and column; none.
    let stripes = |m: usize| -> Vec<bool> { (0..m * m).map(|i| i % m % 100 != 0 && i / m % 4 < 2).collect() };
    assert_eq!(suitable_side(&stripes(400), 400), 1);
    assert_eq!(suitable_side(&vec![true; 400 * 400], 400), 1);
    assert_eq!(suitable_side(&vec![false; 400], 20), 1);
    assert_eq!(suitable_side(&[true], 1), 1);
}
