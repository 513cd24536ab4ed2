//! Scenes on which the exchange of elements by steps (4.1) and (4.2) cycles.
//!
//! On three elements in a row, each of which lifts its neighbour, solving on C and exchanging all elements that violate the conditions ((4.1), u = A
//! p of the truncated p, (4.2)) returns to an earlier contact area. A is positive definite, so that the solution is unique.

use contact_normal::scene::Load;

use super::case::{grid, table, Case};

/// The coefficients at offsets 0, 1, 2, ... of a row, and approach - h of its elements.
type Row = (&'static [f64], &'static [f64]);

/// The rows were found by a search through random coefficients and distances.
const ROWS: &[Row] = &[
    (&[1.0, -0.92, 0.77], &[0.64, -0.91, 0.1]),
    (&[1.0, -0.9, 0.98], &[0.41, -0.8, 0.32]),
    (&[1.0, -0.75, 0.84], &[0.68, -0.82, 0.35]),
    (&[1.0, -0.49, 0.97, -0.47], &[0.07, 0.13, 0.17, 0.92]),
    (&[1.0, -0.52, 0.98], &[0.66, -0.82, 0.87]),
];

/// Cases with one copy of each row, and with 40 copies that are too far apart to interact.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (coefficients, depths) in ROWS {
        for copies in [1, 40] {
            let period = 2 * coefficients.len();
            let m = (copies - 1) * period + coefficients.len();
            let grid = grid(m, 1, 1.0, 1.0);
            let influence = table(&grid, |kx, ky, _| match coefficients.get(kx.unsigned_abs() as usize) {
                Some(c) if ky == 0 => *c,
                _ => 0.0,
            });
            // Elements between the copies have no surface.
            let h = (0..m).map(|i| depths.get(i % period).map_or(f64::INFINITY, |depth| 1.0 - depth)).collect();
            let name = format!("4.1 and 4.2 cycle, {copies} x {} elements", coefficients.len());
            cases.push(Case { influence: Some(influence), ..Case::new(&name, grid, h, Load::Approach(1.0)) });
        }
    }
    cases
}

#[cfg(test)]
mod promises {
    use super::super::case::Random;
    use super::super::certificate::{assert_certified, assert_solved_or_told, displace, run_with, Found};
    use super::*;
    use contact_normal::error::Error;
    use contact_normal::solver::{Method, Options, Outcome};

    /// Solves `A p = 1 - h` on the contact area by elimination.
    fn solve_on(case: &Case, contact: &[bool]) -> Vec<f64> {
        let influence = case.scene().coefficients().unwrap();
        let elements: Vec<usize> = (0..contact.len()).filter(|&i| contact[i]).collect();
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for &i in &elements {
            let mut row: Vec<f64> = elements.iter().map(|&k| influence.at(i as i64 - k as i64, 0)).collect();
            row.push(1.0 - case.h[i]);
            rows.push(row);
        }
        let n = rows.len();
        for k in 0..n {
            let pivot = rows[k].clone();
            for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
                let factor = row[k] / pivot[k];
                row.iter_mut().zip(&pivot).for_each(|(value, pivot)| *value -= factor * pivot);
            }
        }
        let mut p = vec![0.0; contact.len()];
        (0..n).for_each(|k| p[elements[k]] = rows[k][n] / rows[k][k]);
        p
    }

    #[test]
    fn the_plain_exchange_cycles_on_these_scenes() {
        for case in cases() {
            let mut contact: Vec<bool> = case.h.iter().map(|h| *h <= 1.0).collect();
            let mut seen = Vec::new();
            while !seen.contains(&contact) {
                seen.push(contact.clone());
                let mut p = solve_on(&case, &contact);
                p.iter_mut().for_each(|p| *p = p.max(0.0));
                let u = displace(&case, &p);
                contact = (0..p.len()).map(|i| p[i] > 0.0 || (case.h[i] - 1.0 + u[i] <= 0.0 && u[i] < 1e9)).collect();
            }
            let last = seen.last().expect("a contact area");
            assert!(*last != contact, "{}: the exchange ends", case.name);
        }
    }

    #[test]
    fn where_the_exchange_cycles_every_method_ends() {
        assert_solved_or_told(&cases());
        for case in cases() {
            for method in [Method::FullMultigrid, Method::Multigrid, Method::Norm] {
                let found = run_with(&case, &Options { method, ..Options::default() }).expect("a solve");
                assert!(found.report.count.cycles <= 1000, "{}: {method:?}", case.name);
            }
        }
    }

    #[test]
    fn rows_of_random_coefficients_are_solved() {
        let mut random = Random(3);
        let (mut solved, mut refused) = (0, 0);
        for number in 0..400 {
            let m = 2 + (random.next() * 12.0) as usize;
            let grid = grid(m, 1, 1.0, 1.0);
            let coefficients: Vec<f64> = (1..m).map(|_| 1.4 * random.next() - 0.7).collect();
            let influence = table(&grid, |kx, ky, _| match (kx.unsigned_abs() as usize, ky) {
                (0, 0) => 1.0,
                (k, 0) if k < m => coefficients[k - 1],
                _ => 0.0,
            });
            let h = (0..m).map(|_| 2.0 * random.next()).collect();
            let load = if number % 2 == 0 { Load::Approach(1.0) } else { Load::Force(0.5) };
            let case = Case { influence: Some(influence), ..Case::new("a random row", grid, h, load) };
            let definite = is_definite(&coefficients);
            let what = format!("row {number}, definite: {definite}, {load:?}");
            match run_with(&case, &Options::default()) {
                Ok(found) if found.stop == Outcome::Converged => {
                    assert_certified(&case, &what, &found, 1e-6);
                    solved += 1;
                }
                Ok(Found { stop, report, .. }) => assert!(!definite, "{what}: {stop:?} {report:?}"),
                Err(Error::NotPositiveDefinite(_)) if !definite => refused += 1,
                Err(error) => panic!("{what}: {error}"),
            }
        }
        assert!(solved > 50 && refused > 5, "{solved} and {refused}");
    }

    /// Whether the matrix with diagonal 1 and these coefficients is positive definite, that is, whether Cholesky's method finds positive pivots.
    fn is_definite(coefficients: &[f64]) -> bool {
        let m = coefficients.len() + 1;
        let at = |i: usize, k: usize| if i == k { 1.0 } else { coefficients[i.abs_diff(k) - 1] };
        let mut factor = vec![vec![0.0; m]; m];
        for i in 0..m {
            for k in 0..=i {
                let sum: f64 = (0..k).map(|l| factor[i][l] * factor[k][l]).sum();
                let pivot = at(i, k) - sum;
                if i == k && pivot <= 1e-12 {
                    return false;
                }
                factor[i][k] = if i == k { pivot.sqrt() } else { pivot / factor[k][k] };
            }
        }
        true
    }
}
