//! Real wheel-rail contacts, compared with the pressures of the CONTACT program (computed at tolerance 1e-7).

use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, Method, Options, Outcome};

struct Case {
    grid: Grid,
    bodies: Bodies,
    approach: f64,
    force: f64,
    h: Vec<f64>,
    pressure: Vec<f64>,
    contact: Vec<bool>,
}

fn read(name: &str) -> Case {
    let path = format!("{}/data/wheel_rail/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the data file");
    let numbers = |line: &str| -> Vec<f64> { line.split_whitespace().map(|x| x.parse().expect("a number")).collect() };
    let mut lines = text.lines().skip(3);
    let head = numbers(lines.next().expect("a first line"));
    let rows: Vec<Vec<f64>> = lines.map(numbers).collect();
    Case {
        grid: Grid::new(head[0] as usize, head[1] as usize, head[2], head[3]).unwrap(),
        approach: head[4],
        force: head[5],
        bodies: Bodies::same(head[6], head[7]),
        h: rows.iter().map(|row| row[0]).collect(),
        pressure: rows.iter().map(|row| row[1]).collect(),
        contact: rows.iter().map(|row| row[2] > 0.5).collect(),
    }
}

#[test]
fn every_method_finds_contacts_pressures_and_contact_area() {
    for name in ["y0_10kN.txt", "y4_82kN.txt", "y10_10kN.txt"] {
        let case = read(name);
        let largest = case.pressure.iter().copied().fold(0.0, f64::max);
        for load in [Load::Approach(case.approach), Load::Force(case.force)] {
            for method in [Method::Auto, Method::Norm, Method::Multigrid, Method::FullMultigrid] {
                let scene = Scene::new(case.grid, &case.h, case.bodies, load);
                let options = Options { method, tolerance: 1e-9, ..Options::default() };
                let (solver, stop, report) = solve(&scene, &options).unwrap();
                assert_eq!(stop, Outcome::Converged, "{name}, {method:?}");
                assert_eq!(solver.state().contact, case.contact, "{name}, {method:?}");
                // CONTACT stopped at relative updates of 1e-7. With its convergence factors its error is a few times that.
                for (a, b) in solver.state().p.iter().zip(&case.pressure) {
                    assert!((a - b).abs() <= 5e-7 * largest, "{name}, {method:?}: {a} for {b}");
                }
                assert!((report.measures.force / case.force - 1.0).abs() <= 1e-6);
                assert!((report.measures.approach / case.approach - 1.0).abs() <= 1e-6);
            }
        }
    }
}
