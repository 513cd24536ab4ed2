//! A given contact area that is pulled: negative forces, with active_set FIXED.

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Each, Layer, Load, Period, Scene};
use contact_normal::solver::{solve, ActiveSet, Guess, InitialGuess, Method, Options, Outcome, Solver};

use super::dense;

fn fixed(method: Method) -> Options {
    Options { method, active_set: ActiveSet::Fixed, tolerance: 1e-9, estimates: true, ..Options::default() }
}

/// The distances of a ball, and a contact area that is not a disc.
fn bonded(grid: &Grid) -> (Vec<f64>, Vec<bool>) {
    let place = |k: usize, m: usize| k as f64 - 0.5 * (m as f64 - 1.0);
    let of = |i: usize| (place(i % grid.mx, grid.mx), place(i / grid.mx, grid.my));
    let h = (0..grid.len()).map(|i| 0.01 * (of(i).0.powi(2) + of(i).1.powi(2))).collect();
    let contact = (0..grid.len()).map(|i| of(i).0.abs() + 0.7 * of(i).1.abs() < 0.35 * grid.mx as f64).collect();
    (h, contact)
}

/// Forces of both signs, and 0. By direct sums all elements of the area have the same approach, and the force is exact to round-off.
#[test]
fn a_force_that_pulls_is_carried_by_every_method() {
    let grid = Grid::new(22, 17, 0.5, 0.4).unwrap();
    let (h, contact) = bonded(&grid);
    let pressure = vec![0.0; h.len()];
    let compliances: Vec<f64> = (0..h.len()).map(|i| 0.1 * (i % 3) as f64).collect();
    let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(0.0));
    let with_multigrid = [plain.clone(), Scene { layer: Some(Layer(Each::Uniform(0.2))), ..plain.clone() }];
    let without = [
        Scene { layer: Some(Layer(Each::PerElement(&compliances))), ..plain.clone() },
        Scene { period: Some(Period { x: true, y: false }), ..plain.clone() },
        Scene { period: Some(Period { x: true, y: true }), ..plain.clone() },
    ];
    for (k, scene) in with_multigrid.iter().chain(&without).enumerate() {
        for method in [Method::Auto, Method::Norm, Method::ProjectedCg, Method::Multigrid, Method::FullMultigrid] {
            if k >= 2 && matches!(method, Method::Multigrid | Method::FullMultigrid) {
                continue;
            }
            let mut solver = Solver::new(scene, &fixed(method)).unwrap();
            // The last two forces are tiny relative to the sum of the positive pressures.
            for force in [-3.0, -1e-3, 0.0, 2.0, -50.0, 1e-22, -1e-12] {
                let scene = Scene { load: Load::Force(force), ..scene.clone() };
                let guess = Some(Guess { pressure: &pressure, contact: &contact });
                let (stop, report) = solver.solve(&scene, &fixed(method), guess, None).unwrap();
                let (what, p) = (format!("scene {k}, {method:?}, {force}"), &solver.state().p);
                assert_eq!(stop, Outcome::Converged, "{what}");
                assert_eq!(report.measures.contact_count, contact.iter().filter(|inside| **inside).count());
                let all: f64 = p.iter().map(|p| p.abs()).sum();
                let carried = p.iter().sum::<f64>();
                assert!((carried * 0.2 - force).abs() <= 1e-11 * (all * 0.2), "{what}: {}", carried * 0.2);
                assert!((report.measures.force - force).abs() <= 1e-11 * (all * 0.2), "{what}");
                let mut u = vec![0.0; p.len()];
                dense::apply(&scene.coefficients().unwrap(), &grid, p, &mut u);
                let (mut residual, mut distance) = (0.0, 0.0);
                for i in 0..p.len() {
                    let e = h[i] - report.measures.approach + u[i];
                    assert!(contact[i] || p[i] == 0.0, "{what}");
                    if contact[i] {
                        residual += e * e;
                        distance += (h[i] - report.measures.approach).powi(2);
                    }
                }
                // The tolerance of 1e-9, and 1 % of it for the different round-off of direct sums and FFT products.
                assert!(residual.sqrt() <= 1.01e-9 * distance.sqrt(), "{what}: {}", (residual / distance).sqrt());
            }
        }
    }
}

/// On a given area the equations are linear: pressures less those without a force are proportional to the force. A solve from the last solution makes
/// products of its own.
#[test]
fn pulls_add_up() {
    let grid = Grid::new(20, 20, 1.0, 1.0).unwrap();
    let (h, contact) = bonded(&grid);
    let pressure = vec![0.0; h.len()];
    let guess = Some(Guess { pressure: &pressure, contact: &contact });
    let scene = |force| Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(force));
    let mut solver = Solver::new(&scene(1.0), &fixed(Method::Auto)).unwrap();
    let mut pressures = |force, initial_guess| {
        let options = Options { initial_guess, ..fixed(Method::Auto) };
        let (stop, report) = solver.solve(&scene(force), &options, guess, None).unwrap();
        assert!(stop == Outcome::Converged && report.count.matrix_products > 0, "{force}");
        solver.state().p.clone()
    };
    let none = pressures(0.0, InitialGuess::None);
    let [one, two] = [-40.0, -80.0].map(|force| pressures(force, InitialGuess::Previous));
    let largest = two.iter().fold(0.0, |largest: f64, p| largest.max(p.abs()));
    for ((none, one), two) in none.iter().zip(&one).zip(&two) {
        assert!((two - none - 2.0 * (one - none)).abs() <= 1e-6 * largest);
    }
}

#[test]
fn a_free_contact_area_is_not_pulled() {
    let grid = Grid::new(8, 8, 1.0, 1.0).unwrap();
    let (h, _) = bonded(&grid);
    let scene = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(-1.0));
    let refused = solve(&scene, &Options::default()).map(drop).unwrap_err();
    assert!(
        matches!(&refused, Error::InvalidArgument(text) if text.contains("force is -1") && text.contains("FIXED")),
        "{refused}"
    );
}

/// Flat bodies without a force have p = 0. The residual is relative to distances of 0, and must be a number.
#[test]
fn an_even_contact_area_without_force_has_no_pressures() {
    let grid = Grid::new(31, 24, 0.5, 0.4).unwrap();
    let (_, contact) = bonded(&grid);
    for (height, periods) in [(0.0, 0), (0.0, 1), (-0.7, 0), (1e9, 2), (3e-127, 1)] {
        let h: Vec<f64> = contact.iter().map(|&inside| if inside { height } else { f64::INFINITY }).collect();
        let period = (periods > 0).then_some(Period { x: true, y: periods == 2 });
        let scene = Scene { period, ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Force(0.0)) };
        let options = fixed(Method::Auto);
        let mut solver = Solver::new(&scene, &options).unwrap();
        let pressure: Vec<f64> = (0..h.len()).map(|i| if contact[i] { 1e-127 * (i % 7) as f64 } else { 0.0 }).collect();
        let guess = Some(Guess { pressure: &pressure, contact: &contact });
        let (stop, report) = solver.solve(&scene, &options, guess, None).unwrap();
        assert_eq!(stop, Outcome::Converged, "{height}, {periods} periods");
        assert!(solver.state().p.iter().all(|p| *p == 0.0));
        assert!(report.measures.approach == height && report.measures.certificate.residual == 0.0);
        assert_eq!(report.measures.contact_count, contact.iter().filter(|inside| **inside).count());
    }
}

/// With two periods the mean displacement is 0. On a given area an approach above the mean of h presses, and one below it pulls.
#[test]
fn an_area_with_two_periods_takes_approaches_beyond_the_mean() {
    let grid = Grid::new(16, 12, 1.0, 1.0).unwrap();
    let (h, contact) = bonded(&grid);
    let pressure = vec![0.0; h.len()];
    let mean = h.iter().sum::<f64>() / h.len() as f64;
    for method in [Method::Auto, Method::Norm] {
        for approach in [mean + 0.5, mean - 0.5] {
            let plain = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(approach));
            let scene = Scene { period: Some(Period { x: true, y: true }), ..plain };
            let mut solver = Solver::new(&scene, &fixed(method)).unwrap();
            let guess = Some(Guess { pressure: &pressure, contact: &contact });
            let (stop, _) = solver.solve(&scene, &fixed(method), guess, None).unwrap();
            assert_eq!(stop, Outcome::Converged, "{method:?} {approach}");
            let (p, mut u) = (&solver.state().p, vec![0.0; h.len()]);
            dense::apply(&scene.coefficients().unwrap(), &grid, p, &mut u);
            for i in (0..h.len()).filter(|i| contact[*i]) {
                // The tolerance of 1e-9 is for the rms; one element may have all of it, the square root of the number of elements times as much.
                assert!(
                    (h[i] - approach + u[i]).abs() <= 1e-9 * 14.0 * 3.0,
                    "{method:?} {approach}: {}",
                    h[i] - approach + u[i]
                );
            }
        }
    }
}
