use super::*;

/// Runs by the definition: element by element.
fn by_definition(row: &[bool], start: u32) -> Vec<(u32, u32)> {
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for (i, _) in row.iter().enumerate().filter(|(_, inside)| **inside) {
        let i = start + i as u32;
        match runs.last_mut().filter(|(_, end)| *end == i) {
            Some((_, end)) => *end = i + 1,
            None => runs.push((i, i + 1)),
        }
    }
    runs
}

#[test]
fn runs_are_those_of_a_search_element_by_element() {
    let every = |n: usize, k: usize| (0..n).map(|i| i % k == 0).collect::<Vec<bool>>();
    let pieces = |n: usize, k: usize| (0..n).map(|i| i / k % 2 == 1).collect::<Vec<bool>>();
    for n in 1..=40 {
        let rows = [vec![true; n], vec![false; n], every(n, 2), every(n, 3), pieces(n, 5), pieces(n, 8), pieces(n, 9)];
        for row in rows {
            let mut runs = Vec::new();
            find_in_row(&row, 100, &mut runs);
            assert_eq!(runs, by_definition(&row, 100), "{row:?}");
        }
    }
}

#[test]
fn a_pass_changes_what_is_in_contact_and_lists_elements_in_order() {
    let grid = Grid::new(130, 170, 1.0, 1.0).expect("a grid");
    for count in [1, 2] {
        let mut segments = Segments::new(&grid, &Threads::new(count).expect("threads")).expect("memory");
        let contact: Vec<bool> = (0..grid.len()).map(|i| i % 7 < 4).collect();
        segments.change_all();
        segments.find(&contact);
        let mut values = vec![1.0; grid.len()];
        for divisor in [5, 11] {
            segments.list_changing(&mut values, |block, values, listed| {
                for (run, local) in block.runs() {
                    values[local].iter_mut().for_each(|value| *value += 1.0);
                    listed.extend(run.filter(|i| i % divisor == 0).map(|i| i as u32));
                }
            });
            let expected: Vec<usize> = (0..grid.len()).filter(|&i| contact[i] && i % divisor == 0).collect();
            assert_eq!(segments.listed().collect::<Vec<_>>(), expected);
        }
        assert!(values.iter().zip(&contact).all(|(value, &inside)| *value == if inside { 3.0 } else { 1.0 }));
    }
}
