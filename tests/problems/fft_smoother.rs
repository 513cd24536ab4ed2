//! V-cycles with the FFT smoother converge on contact areas of any shape, and give the pressures of NORM.

use super::dense;
use crate::paper as case;
use crate::rough;

use contact_normal::contact::Problem;
use contact_normal::grid::Grid;
use contact_normal::influence::{Coefficients, HalfSpace, Table};
use contact_normal::methods::multigrid::smoother::{Smoother, SmootherKind};
use contact_normal::methods::multigrid::{CycleShape, Multigrid};
use contact_normal::operator::fft::good_length;
use contact_normal::operator::Operator;
use contact_normal::scene::{Bodies, Load, Scene};
use contact_normal::solver::{solve, ActiveSet, Guess, Method, Options, Outcome, Report, Solver};
use contact_normal::threads::Threads;

use crate::families::case::Random;

const BODIES: Bodies = Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0, 0.0] };
const TOLERANCE: f64 = 1e-8;

/// Options of V(1,1) cycles with the FFT smoother.
fn options(method: Method) -> Options {
    let cycle = CycleShape { smoother: SmootherKind::Fft, ..CycleShape::default() };
    Options { method, cycle, tolerance: TOLERANCE, max_cycles: 200, ..Options::default() }
}

/// Options of NORM, with a tighter tolerance than that of the solve that is compared.
fn norm() -> Options {
    Options { method: Method::Norm, tolerance: 1e-2 * TOLERANCE, max_cycles: 50_000, ..Options::default() }
}

fn on_contact(scene: &Scene<'_>, options: Options, contact: &[bool]) -> (Solver, Outcome, Report) {
    let options = Options { active_set: ActiveSet::Fixed, ..options };
    let guess = Guess { pressure: &vec![0.0; contact.len()], contact };
    let mut solver = Solver::new(scene, &options).unwrap();
    let (stop, report) = solver.solve(scene, &options, Some(guess), None).unwrap();
    (solver, stop, report)
}

/// Asserts that two results have the same pressures. The 2-norm of their difference is at most the condition number of A times the relative
/// residuals. The eigenvalues of A are inversely proportional to wave numbers, from one wave on the grid to half a wave per element. So the condition
/// number is about the larger number of elements in a row or column times the aspect ratio of the elements; twice that is allowed.
fn assert_same_pressures(a: &Solver, b: &Solver, what: &str) {
    let grid = a.state().grid;
    let aspect = (grid.dx / grid.dy).max(grid.dy / grid.dx);
    let condition = 2.0 * grid.mx.max(grid.my) as f64 * aspect;
    let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let size = norm(&mut b.state().p.iter().copied());
    let difference = norm(&mut a.state().p.iter().zip(&b.state().p).map(|(a, b)| a - b));
    assert!(difference <= condition * 1.01 * TOLERANCE * size, "{what}: pressures differ by {:e}", difference / size);
}

fn assert_converged(stop: Outcome, report: &Report, what: &str) {
    assert_eq!(stop, Outcome::Converged, "{what}: residual {:e}", report.measures.certificate.residual);
    assert!(report.measures.certificate.residual <= TOLERANCE, "{what}");
}

#[test]
fn the_linear_system_of_the_paper_takes_no_more_cycles_than_with_gauss_seidel() {
    for m in [64, 128, 256] {
        let run = |smoother| case::linear_system(m, Method::Multigrid, smoother, 0.0, 100);
        let ((stop, fft, _), (_, gauss_seidel, _)) = (run(SmootherKind::Fft), run(SmootherKind::GaussSeidel));
        assert_eq!(stop, Outcome::Converged);
        assert!(
            fft.count.cycles <= gauss_seidel.count.cycles,
            "{m}: {} for {}",
            fft.count.cycles,
            gauss_seidel.count.cycles
        );
        // Each cycle takes three products; the certificate and the start take one each.
        assert!(fft.count.matrix_products <= 3 * fft.count.cycles + 2, "{m}: {} products", fft.count.matrix_products);
    }
}

#[test]
fn the_ellipse_is_solved_by_every_cycle_for_both_loads() {
    for m in [64, 128, 256] {
        let h = case::undeformed_distance(m);
        let by_approach = case::scene(m, &h);
        let (reference, _, report) = solve(&by_approach, &norm()).unwrap();
        let by_force = Scene { load: Load::Force(report.measures.force), ..by_approach.clone() };
        for scene in [&by_approach, &by_force] {
            for method in [Method::Multigrid, Method::FullMultigrid] {
                for (pre_sweeps, post_sweeps) in [(1, 1), (1, 0), (0, 1)] {
                    let what = format!("{m}, {:?}, {method:?}, V({pre_sweeps},{post_sweeps})", scene.load);
                    let fft = options(method);
                    let options = Options { cycle: CycleShape { pre_sweeps, post_sweeps, ..fft.cycle }, ..fft };
                    let (solver, stop, report) = solve(scene, &options).unwrap();
                    assert_converged(stop, &report, &what);
                    assert_same_pressures(&solver, &reference, &what);
                }
            }
        }
    }
}

#[test]
fn the_rough_surface_is_solved() {
    for m in [128, 256] {
        let h = rough::undeformed_distance(m);
        let scene = rough::scene(m, &h);
        let (reference, stop, norm_report) = solve(&scene, &norm()).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let by_approach = Scene { load: Load::Approach(norm_report.measures.approach), ..scene.clone() };
        for scene in [&scene, &by_approach] {
            for method in [Method::Multigrid, Method::FullMultigrid] {
                let (solver, stop, report) = solve(scene, &options(method)).unwrap();
                let what = format!("{m}, {:?}, {method:?}", scene.load);
                assert_converged(stop, &report, &what);
                assert_same_pressures(&solver, &reference, &what);
                assert!(report.count.cycles < 40, "{what}: {} cycles", report.count.cycles);
                // 10 to 25 cycles were measured to reach 1e-8.
            }
            let contact = &reference.state().contact;
            let (solver, stop, report) = on_contact(scene, options(Method::Multigrid), contact);
            assert_converged(stop, &report, "the contact area given");
            assert_same_pressures(&solver, &reference, "the contact area given");
        }
    }
}

/// A contact area of spots of all sizes, with holes. It fills about the part `fill` of the grid.
fn spots(grid: &Grid, fill: f64, random: &mut Random) -> Vec<bool> {
    let mut contact = vec![false; grid.len()];
    while contact.iter().filter(|&&inside| inside).count() < (fill * grid.len() as f64) as usize {
        let (x, y) = (random.next() * grid.mx as f64, random.next() * grid.my as f64);
        let radius = 1.0 + 0.15 * random.next().powi(3) * grid.mx.min(grid.my) as f64;
        let density = random.next();
        for (i, inside) in contact.iter_mut().enumerate() {
            let (dx, dy) = ((i % grid.mx) as f64 - x, (i / grid.mx) as f64 - y);
            *inside |= dx * dx + dy * dy <= radius * radius && random.next() < 0.5 + density;
        }
    }
    contact
}

#[test]
fn scattered_spots_are_solved_as_norm_does() {
    let mut random = Random(7);
    for fill in [0.1, 0.2, 0.35, 0.6] {
        for (mx, my) in [(64, 64), (96, 75), (31, 130)] {
            let grid = Grid::new(mx, my, 1.0, 0.8).unwrap();
            let contact = spots(&grid, fill, &mut random);
            let h: Vec<f64> = (0..grid.len()).map(|_| 0.1 * random.next()).collect();
            for load in [Load::Approach(1.0), Load::Force(20.0)] {
                let scene = Scene::new(grid, &h, BODIES, load);
                let (reference, stop, _) = on_contact(&scene, norm(), &contact);
                assert_eq!(stop, Outcome::Converged);
                for (pre_sweeps, post_sweeps) in [(1, 1), (1, 0), (0, 1)] {
                    let what = format!("{mx} x {my}, {fill}, {load:?}, V({pre_sweeps},{post_sweeps})");
                    let fft = options(Method::Multigrid);
                    let options = Options { cycle: CycleShape { pre_sweeps, post_sweeps, ..fft.cycle }, ..fft };
                    let (solver, stop, report) = on_contact(&scene, options, &contact);
                    assert_converged(stop, &report, &what);
                    assert_same_pressures(&solver, &reference, &what);
                }
            }
        }
    }
}

#[test]
fn lines_ragged_grids_and_slender_elements_are_solved() {
    for (mx, my, dx) in [
        (1, 1, 1.0),
        (1, 37, 1.0),
        (64, 1, 1.0),
        (257, 1, 1.0),
        (3, 50, 1.0),
        (33, 65, 1.0),
        (24, 20, 0.02),
        (20, 24, 50.0),
    ] {
        let grid = Grid::new(mx, my, dx, 1.0).unwrap();
        let part = |i: usize, m: usize| (2.0 * i as f64 + 1.0) / m as f64 - 1.0;
        let h: Vec<f64> = (0..grid.len()).map(|i| part(i % mx, mx).powi(2) + part(i / mx, my).powi(2)).collect();
        let approach = Scene::new(grid, &h, BODIES, Load::Approach(0.6));
        let (reference, _, report) = solve(&approach, &norm()).unwrap();
        let force = Scene { load: Load::Force(report.measures.force), ..approach.clone() };
        for scene in [&approach, &force] {
            for method in [Method::Multigrid, Method::FullMultigrid] {
                let what = format!("{grid:?}, {:?}, {method:?}", scene.load);
                let (solver, stop, report) = solve(scene, &options(method)).unwrap();
                assert_converged(stop, &report, &what);
                assert_same_pressures(&solver, &reference, &what);
            }
        }
    }
}

#[test]
fn no_cycle_raises_the_energy() {
    // The energy (v, A v)/2 - (d, v) does not grow in any cycle, with relaxation factors up to nearly 2, on contact areas on which a fixed step
    // length diverges.
    let mut random = Random(11);
    let grid = Grid::new(40, 56, 1.0, 1.0).unwrap();
    let influence = Coefficients::from(HalfSpace::new(1.0, 1.0, 1.0));
    for (fill, relaxation) in [(0.1, 1.0), (0.3, 0.3), (0.3, 1.9), (0.6, 1.0), (1.0, 1.0)] {
        let contact = spots(&grid, fill, &mut random);
        let shape = CycleShape { smoother: SmootherKind::Fft, relaxation, ..CycleShape::default() };
        let mut multigrid =
            Multigrid::new(&mut Problem::new(grid, influence.clone(), &Threads::One).unwrap(), shape).unwrap();
        let d: Vec<f64> = contact.iter().map(|&c| if c { random.next() - 0.2 } else { 0.0 }).collect();
        let (mut v, mut u, mut before) = (vec![0.0; grid.len()], vec![0.0; grid.len()], 0.0_f64);
        for _ in 0..12 {
            let defect: Vec<f64> = d.iter().zip(&u).map(|(d, u)| d - u).collect();
            let correction = multigrid.cycle(0, &defect, &contact);
            v.iter_mut().zip(correction).for_each(|(v, c)| *v += c);
            assert!(v.iter().zip(&contact).all(|(v, &inside)| inside || *v == 0.0));
            dense::apply(&influence, &grid, &v, &mut u);
            let energy: f64 = (0..v.len()).map(|i| v[i] * (0.5 * u[i] - d[i])).sum();
            // The tolerance is the round-off of a sum of terms of that size.
            assert!(energy <= before + 1e-13 * before.abs(), "{fill}, {relaxation}: {energy} after {before}");
            before = energy;
        }
    }
}

/// A table of the coefficients `f(kx, ky)` for a grid.
fn table(grid: &Grid, f: impl Fn(i64, i64) -> f64) -> Table {
    let (cx, cy) = (grid.mx as i64, grid.my as i64);
    let values: Vec<f64> =
        (-cy..cy).flat_map(|ky| (-cx..cx).map(move |kx| (kx, ky))).map(|(kx, ky)| f(kx, ky)).collect();
    Table::new(grid.mx, grid.my, &values, grid).unwrap()
}

#[test]
fn a_sweep_leaves_the_true_residual_and_product() {
    let mut random = Random(3);
    for (mx, my) in [(1, 1), (17, 1), (1, 12), (13, 22)] {
        let grid = Grid::new(mx, my, 1.0, 0.7).unwrap();
        let bent = table(&grid, |kx, ky| {
            1.0 / (1.0 + ((kx * kx + ky * ky) as f64).sqrt() + 0.1 * (kx + 2 * ky) as f64).powi(2)
        });
        for influence in [Coefficients::from(HalfSpace::new(1.0, 0.7, 1.0)), bent.into()] {
            let contact: Vec<bool> = (0..grid.len()).map(|i| i == 0 || random.next() < 0.7).collect();
            let b: Vec<f64> = (0..grid.len()).map(|i| if contact[i] { random.next() } else { 0.0 }).collect();
            let mut smoother = Smoother::new(SmootherKind::Fft, &influence, &grid, &Threads::One).unwrap();
            assert!(smoother.keeps_residual());
            let (mut p, mut residual) = (vec![0.0; grid.len()], b.clone());
            for _ in 0..3 {
                let displace = |p: &[f64], u: &mut [f64]| dense::apply(&influence, &grid, p, u);
                smoother.sweep(&mut p, &mut residual, &contact, 1.0, displace);
                let mut u = vec![0.0; grid.len()];
                displace(&p, &mut u);
                let Smoother::Fft(fft) = &smoother else { panic!("another smoother") };
                for i in 0..grid.len() {
                    let expected = if contact[i] { b[i] - u[i] } else { 0.0 };
                    // The tolerance is the round-off of a few sums of terms of order 1.
                    assert!((residual[i] - expected).abs() <= 1e-12, "{mx} x {my}: {} for {expected}", residual[i]);
                    assert!((fft.product()[i] - u[i]).abs() <= 1e-12);
                }
            }
        }
    }
}

#[test]
fn tables_without_a_positive_circulant_or_without_symmetry_give_no_wrong_result() {
    let grid = Grid::new(20, 16, 1.0, 1.0).unwrap();
    let distance = |kx: i64, ky: i64| ((kx * kx + ky * ky) as f64).sqrt();
    let cases = [
        // The circulant has negative eigenvalues for some waves, as A itself may have on large contact areas.
        (
            "box",
            table(&grid, |kx, ky| {
                if kx == 0 && ky == 0 {
                    1.5
                } else if kx.abs() <= 2 && ky.abs() <= 2 {
                    0.4
                } else {
                    0.0
                }
            }),
        ),
        // A is positive definite. But the circulant of period m adds the ends of the table with a negative sign.
        (
            "waves",
            table(&grid, |kx, ky| {
                0.05 * (0.3 * kx as f64).cos() * (0.2 * ky as f64).cos() + if kx == 0 && ky == 0 { 0.1 } else { 0.0 }
            }),
        ),
        ("not symmetric", table(&grid, |kx, ky| 1.0 / (1.0 + distance(kx - i64::from(kx > 0), ky)))),
        (
            "strongly not symmetric",
            table(&grid, |kx, ky| {
                if kx == 0 && ky == 0 {
                    2.0
                } else if kx > 0 {
                    1.0 / distance(kx, ky)
                } else {
                    0.0
                }
            }),
        ),
    ];
    let h: Vec<f64> = (0..grid.len())
        .map(|i| 0.01 * ((i % 20) as f64 - 9.0).powi(2) + 0.02 * ((i / 20) as f64 - 8.0).powi(2))
        .collect();
    for (what, influence) in &cases[..2] {
        let inverse = Operator::<f64>::inverse_circulant(
            &influence.clone().into(),
            &grid,
            (good_length(21), good_length(17)),
            &Threads::One,
        )
        .unwrap();
        assert!(inverse.is_none(), "{what} was meant to have no positive circulant");
    }
    for (what, own) in cases {
        let influence = Coefficients::from(own.clone());
        for load in [Load::Approach(0.4), Load::Force(2.0)] {
            let scene = Scene { influence: Some(own.clone()), ..Scene::new(grid, &h, BODIES, load) };
            for method in [Method::Multigrid, Method::FullMultigrid] {
                let (solver, stop, _) = solve(&scene, &options(method)).unwrap();
                let state = solver.state();
                let mut u = vec![0.0; grid.len()];
                dense::apply(&influence, &grid, &state.p, &mut u);
                let e = |i: usize| h[i] - state.approach + u[i];
                // Symmetric positive definite tables converge even without the preconditioner M. For the others the solve may give up.
                assert!(what != "waves" || stop == Outcome::Converged, "{what}, {load:?}, {method:?}: {stop:?}");
                assert!(state.p.iter().all(|p| p.is_finite() && *p >= 0.0));
                if stop == Outcome::Converged {
                    let (mut rr, mut hh) = (0.0, 0.0);
                    for (i, distance) in h.iter().enumerate() {
                        if state.contact[i] {
                            rr += e(i).powi(2);
                            hh += (distance - state.approach).powi(2);
                        } else {
                            assert!(state.p[i] == 0.0 && e(i) > -1e-6, "{what}: {} at {i}", e(i));
                        }
                    }
                    // The tolerance of the solve, and .1 % of it for round-off.
                    assert!(rr.sqrt() <= 1.001 * TOLERANCE * hh.sqrt(), "{what}: {}", (rr / hh).sqrt());
                }
            }
        }
    }
}
