use super::*;
use crate::lanes::{Holds, Lanes};

const SIZES: [(usize, usize); 6] = [(130, 170), (1, 1), (3, 1), (7, 9), (33, 40), (8, 300)];

/// Contact areas on n elements: of single elements, of pieces, empty, and full.
fn contact_areas(n: usize) -> Vec<Vec<bool>> {
    let every = |k: usize| (0..n).map(|i| i % k == 0).collect();
    let pieces = |k: usize| (0..n).map(|i| i / k % 3 == 1).collect();
    vec![every(2), every(9), every(17), every(100), pieces(5), pieces(8), pieces(60), vec![false; n], vec![true; n]]
}

/// The segments of a contact area, found on one thread or several.
fn segments(grid: &Grid, threads: usize, contact: &[bool]) -> Segments {
    let mut segments = Segments::new(grid, &Threads::new(threads).expect("threads")).expect("memory");
    segments.change_all();
    segments.find(contact);
    segments
}

#[test]
fn segments_are_the_vectors_with_an_element_in_contact() {
    for n in 1..=70 {
        for contact in contact_areas(n) {
            let mut found = Vec::new();
            let count = find_segments(&contact, &mut found);
            let vectors = contact.chunks(LANES).enumerate().filter(|(_, vector)| vector.contains(&true));
            assert_eq!(found, vectors.map(|(k, _)| k as u32).collect::<Vec<_>>(), "{contact:?}");
            assert_eq!(count, contact.iter().filter(|inside| **inside).count(), "{contact:?}");
        }
    }
}

/// A pass for tests. As `Terms`: the number of elements, the sum of a, and the sum of a b.
struct Formula;

impl Terms<1, 1, 3> for Formula {
    fn of<S: pulp::Simd>(&self, [a]: [Lanes<S>; 1], [b]: [Lanes<S>; 1]) -> [Lanes<S>; 3] {
        [a.all(1.0), a, a * b]
    }
}

/// As `Becomes`: the new value is `value + a - 2 b`.
impl Becomes<1, 1> for Formula {
    fn of<S: pulp::Simd>(&self, value: Lanes<S>, [a]: [Lanes<S>; 1], [b]: [Lanes<S>; 1]) -> Lanes<S> {
        value + (a - 2.0 * b)
    }
}

/// As `Wanted`: the elements whose value is less than b and whose index is no multiple of three.
impl Wanted<1> for Formula {
    fn of<S: pulp::Simd>(&self, first: usize, value: Lanes<S>, [b]: [Lanes<S>; 1]) -> Holds<S> {
        let divides = value.of_each(|lane| f64::from(u8::from((first + lane) % 3 == 0)));
        value.is_below(b) & divides.is_below(value.all(0.5))
    }
}

/// Whole numbers for the elements in contact, so that sums have no round-off, and NaN outside.
fn arrays(contact: &[bool]) -> (Vec<f64>, Vec<f32>) {
    let value = |i: usize| if contact[i] { (i * i % 17) as f64 - 5.0 } else { f64::NAN };
    (0..contact.len()).map(|i| (value(i), (i * 7 % 11) as f32 - 3.0)).unzip()
}

#[test]
fn sums_are_those_of_the_elements_in_contact() {
    for (mx, my) in SIZES {
        let grid = Grid::new(mx, my, 1.0, 1.0).expect("a grid");
        for contact in contact_areas(grid.len()) {
            let (a, b) = arrays(&contact);
            let those = || (0..grid.len()).filter(|i| contact[*i]);
            let product = |i: usize| a[i] * f64::from(b[i]);
            let expected = [those().count() as f64, those().map(|i| a[i]).sum(), those().map(product).sum()];
            for threads in [1, 2] {
                let mut segments = segments(&grid, threads, &contact);
                assert_eq!(segments.count(), those().count());
                assert_eq!(segments.sum(&contact, |block| block.sum([&a], [&b[..]], Formula)), expected, "{mx} x {my}");
            }
        }
    }
}

#[test]
fn a_pass_changes_and_lists_what_is_in_contact() {
    for (mx, my) in SIZES {
        let grid = Grid::new(mx, my, 1.0, 1.0).expect("a grid");
        for contact in contact_areas(grid.len()) {
            let (a, b) = arrays(&contact);
            let begin = |i: usize| i as f64 % 5.0 - 2.0;
            let wanted = |i: &usize| contact[*i] && begin(*i) < f64::from(b[*i]) && i % 3 != 0;
            let change = |i: usize| if contact[i] { a[i] - 2.0 * f64::from(b[i]) } else { 0.0 };
            let expected: Vec<f64> = (0..grid.len()).map(|i| begin(i) + change(i)).collect();
            for threads in [1, 2] {
                let mut segments = segments(&grid, threads, &contact);
                let mut values: Vec<f64> = (0..grid.len()).map(begin).collect();
                let mut singles: Vec<f32> = values.iter().map(|value| *value as f32).collect();
                segments.list_changing(&contact, &mut values, |block, values, listed| {
                    block.list(listed, values, [&b[..]], Formula);
                    block.change(values, [&a], [&b[..]], Formula);
                });
                let listed: Vec<usize> = segments.listed().collect();
                assert_eq!(listed, (0..grid.len()).filter(wanted).collect::<Vec<_>>(), "{mx} x {my}");
                assert_eq!(values, expected, "{mx} x {my}");
                let [] = segments.sum_changing(&contact, &mut singles, |block, values| {
                    block.change(values, [&a], [&b[..]], Formula);
                    []
                });
                assert!(singles.iter().zip(&expected).all(|(single, value)| f64::from(*single) == *value));
            }
        }
    }
}

#[test]
fn segments_are_found_again_where_elements_change_sides() {
    let grid = Grid::new(37, 150, 1.0, 1.0).expect("a grid");
    let mut contact: Vec<bool> = (0..grid.len()).map(|i| i % 23 < 4).collect();
    let mut segments = segments(&grid, 1, &contact);
    let (mut values, row) = (vec![0.0; grid.len()], |y: usize| y * 37..(y + 1) * 37);
    let mut list = |segments: &mut Segments, contact: &[bool], elements: &Range<usize>| {
        segments.list_changing(contact, &mut values, |block, _, listed| {
            listed.extend(block.elements().filter(|i| elements.contains(i)).map(|i| i as u32));
        });
    };
    for (y, far) in [(0, 75), (60, 120), (149, 75)] {
        let version = segments.version();
        list(&mut segments, &contact, &row(y));
        segments.change_listed(|_| false);
        segments.find(&contact);
        assert_eq!(segments.version(), version, "nothing changed");
        contact[row(y)].iter_mut().for_each(|inside| *inside = !*inside);
        segments.change_listed(|_| true);
        segments.find(&contact);
        assert!(segments.changed_since(version, row(y)) && !segments.changed_since(version, row(far)), "row {y}");
        assert_eq!(segments.count(), contact.iter().filter(|inside| **inside).count(), "row {y}");
        list(&mut segments, &contact, &(0..0));
        assert_eq!(segments.listed().count(), 0, "what an earlier pass listed");
    }
}
