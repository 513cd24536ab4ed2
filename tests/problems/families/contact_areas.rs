//! Contact areas of any size and place: one element, two far apart, a row, the whole grid, none, at the edge, beside a hole.

use contact_normal::scene::Load;

use super::case::{centre, distance, grid, paraboloid, Case};

pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |name: &str, grid, h: Vec<f64>, loads: &[Load]| {
        cases.extend(loads.iter().map(|&load| Case::new(name, grid, h.clone(), load)));
    };

    // A force of 1e-4 displaces one element by much less than it is above the next ones: its compliance is about 4 ln(1 + sqrt 2)/pi * d = 1.12 d/E*.
    let square = grid(41, 41, 0.1, 0.1);
    add("one element", square, paraboloid(&square, 10.0), &[Load::Approach(0.01), Load::Force(1e-4)]);

    let wide = grid(100, 90, 0.1, 0.1);
    let spots = [wide.index(4, 3), wide.index(95, 86)];
    let mut h = vec![1.0; wide.len()];
    (h[spots[0]], h[spots[1]]) = (0.0, 0.001);
    add("two elements far apart", wide, h, &[Load::Approach(0.01), Load::Force(2e-3)]);

    let row = grid(200, 1, 0.1, 0.1);
    add("a grid of one row", row, paraboloid(&row, 0.01), &[Load::Approach(0.5), Load::Force(1.0)]);
    let column = grid(1, 200, 0.1, 0.1);
    add("a grid of one column", column, paraboloid(&column, 0.01), &[Load::Approach(0.5), Load::Force(1.0)]);
    let ridge = grid(120, 41, 0.1, 0.1);
    let h = distance(&ridge, |x, y| 0.001 * x * x + 50.0 * y * y);
    add("a row of elements in contact", ridge, h, &[Load::Approach(0.02), Load::Force(0.05)]);

    let flat = grid(65, 50, 0.1, 0.1);
    add("flat punch, full contact", flat, vec![0.0; flat.len()], &[Load::Approach(0.1), Load::Force(1.0)]);
    add("full contact, curved", flat, paraboloid(&flat, 0.001), &[Load::Approach(0.5), Load::Force(100.0)]);

    add("bodies apart", flat, paraboloid(&flat, 0.1), &[Load::Approach(-0.5), Load::Force(0.0)]);
    // The lowest element just touches: h = approach, no pressure.
    let odd = grid(31, 31, 0.1, 0.1);
    add("a touch without pressure", odd, paraboloid(&odd, 0.1), &[Load::Approach(0.0)]);

    let corner = distance(&flat, |x, y| 0.1 * ((x - 3.0).powi(2) + (y - 2.4).powi(2)));
    add("contact at two edges", flat, corner, &[Load::Approach(0.1), Load::Force(0.2)]);

    let mut h = paraboloid(&flat, 0.1);
    (0..h.len()).filter(|&i| centre(&flat, i).0 > 0.0).for_each(|i| h[i] = f64::INFINITY);
    add("half of the grid without surface", flat, h, &[Load::Approach(0.1), Load::Force(0.2)]);
    let mut h = vec![f64::INFINITY; flat.len()];
    h[flat.index(64, 49)] = 3.0;
    add("one element with a surface", flat, h, &[Load::Approach(3.5), Load::Force(1.0)]);
    cases
}

#[cfg(test)]
mod promises {
    use super::super::certificate::{assert_solved_or_told, run};
    use super::*;
    use contact_normal::solver::Method;

    #[test]
    fn contact_areas_of_every_size_and_place() {
        assert_solved_or_told(&cases());
    }

    #[test]
    fn the_cases_are_what_their_names_say() {
        for case in cases() {
            let found = run(&case, Method::Auto).expect("a solve");
            let count = found.report.measures.contact_count;
            let (expected, exactly) = match case.name.as_str() {
                "one element" | "one element with a surface" => (1, true),
                "two elements far apart" => (2, true),
                "flat punch, full contact" | "full contact, curved" => (case.grid.len(), true),
                "bodies apart" => (0, true),
                "a row of elements in contact" => (30, false),
                "a touch without pressure" => (0, false),
                _ => (5, false),
            };
            assert!(count == expected || !exactly && count > expected, "{} {:?}: {count}", case.name, case.load);
            if case.name == "a row of elements in contact" {
                let rows: Vec<usize> = (0..found.p.len()).filter(|&i| found.contact[i]).map(|i| i / 120).collect();
                assert!(rows.iter().all(|&row| row == rows[0]));
            }
        }
    }
}
