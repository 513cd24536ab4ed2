//! The elements of C in blocks: each block has all elements of its rows, in order.

use super::*;

/// Every element of C is in one block, in order, and the blocks belong to the rows of the grid.
#[test]
fn blocks_have_all_elements_and_all_rows() {
    for (mx, my, inside) in [(70, 50, 3), (1, 9, 2), (3000, 2, 1), (5, 4, 1000), (9, 9, 5)] {
        let is_inside = |i: usize| i % inside == 1 % inside || i % 17 < 4 && inside == 5;
        let bound: Vec<f64> = (0..mx * my).map(|i| if is_inside(i) { 1.0 } else { 0.0 }).collect();
        let mut places = Places::new(&Grid::new(mx, my, 1.0, 1.0).unwrap()).unwrap();
        // An earlier C has no effect.
        places.contact_changed(&vec![1.0; mx * my]);
        places.contact_changed(&bound);
        let expected: Vec<usize> = (0..mx * my).filter(|&i| bound[i] > 0.0).collect();
        assert!(places.elements().eq(expected.iter().copied()));
        assert_eq!(places.count(), expected.len());
        // Values are copied from the grid to C and back: each element has its own value, and no other element has one.
        let numbers: Vec<f64> = (0..mx * my).map(|i| i as f64 + 1.0).collect();
        let (mut on_c, mut on_grid) = (vec![0.0; 2 * places.length()], vec![0.0f32; mx * my]);
        let blocks = places.parts().zip(places.cut(&mut on_c, 2)).zip(places.cut_grid(&mut on_grid));
        for ((part, on_c), on_grid) in blocks {
            assert_eq!(on_c.len() % (2 * LANES), 0);
            let (first, second) = on_c.split_at_mut(on_c.len() / 2);
            part.gather(&numbers, second);
            part.scatter(second, on_grid);
            part.each(|place, at| first[at] = place as f64 + 1.0);
            assert!(first == second);
        }
        let value = |i: usize| if bound[i] > 0.0 { i as f32 + 1.0 } else { 0.0 };
        assert!(on_grid.iter().enumerate().all(|(i, found)| *found == value(i)));
        assert_eq!(places.cut_grid(&mut on_grid).map(|rows| rows.len()).sum::<usize>(), mx * my);
    }
}
