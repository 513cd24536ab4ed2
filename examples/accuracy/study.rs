//! Measures errors, seconds and work units on several grids, with several methods and tolerances. The exact solution is a closed form, or that of a
//! grid four times finer. The results are comma-separated lines, which `make accuracy` draws.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt::Write;

use contact_normal::analytic::hertz;
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load, Period, Scene};
use contact_normal::solver::{solve, Method, Options};

use super::case;

const METHODS: [Method; 4] = [Method::Auto, Method::FullMultigrid, Method::Multigrid, Method::Norm];
/// The tolerances on all grids: a tenth of the targets 1 %, 0.1 % and 0.01 %, and one that leaves only the error of the grid.
const GRIDS: [f64; 4] = [1e-3, 1e-4, 1e-5, 1e-8];
/// Bodies with E* = 1.
const UNIT: Bodies = Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0, 0.0] };

/// A problem on a grid, and the exact value of what its load does not prescribe: the force or the approach.
struct Problem {
    name: &'static str,
    grid: Grid,
    h: Vec<f64>,
    bodies: Bodies,
    load: Load,
    exact: f64,
}

fn on_square(
    name: &'static str,
    m: usize,
    size: (f64, f64),
    h: impl Fn(f64, f64) -> f64,
    bodies: Bodies,
    load: Load,
    exact: f64,
) -> Problem {
    let grid = Grid::new(m, m, size.0 / m as f64, size.1 / m as f64).expect("a grid");
    let centre = |i: usize, d: f64| (i as f64 + 0.5 - 0.5 * m as f64) * d;
    let h = (0..m * m).map(|i| h(centre(i % m, grid.dx), centre(i / m, grid.dy))).collect();
    Problem { name, grid, h, bodies, load, exact }
}

fn closed_form(name: &str, m: usize) -> Problem {
    match name {
        "ellipse" => {
            let exact = hertz(0.0016681, 0.0030671, 0.1091, 0.72 / 82000.0).expect("a contact").force;
            let h = |x: f64, y: f64| 0.0016681 * x * x + 0.0030671 * y * y;
            on_square("ellipse", m, (20.0, 12.0), h, Bodies::same(82000.0, 0.28), Load::Approach(0.1091), exact)
        }
        "cone" => on_square(
            "cone",
            m,
            (1.0, 1.0),
            f64::hypot,
            UNIT,
            Load::Approach(FRAC_PI_2 * 0.37),
            FRAC_PI_2 * 0.37 * 0.37,
        ),
        _ => {
            let h = |x: f64, y: f64| if x.hypot(y) < 0.37 { 0.0 } else { f64::INFINITY };
            on_square("flat punch", m, (1.0, 1.0), h, UNIT, Load::Approach(0.1), 2.0 * 0.37 * 0.1)
        }
    }
}

/// A wave of length 1 and amplitude D on a half-space (Westergaard 1939). With p* = pi E* D, half of it is in contact under the mean pressure
/// `p = p* sin^2(pi/4)`. The approach of the mean planes is `(p/pi)(1 - log(p/p*))` for E* = 1.
fn westergaard(m: usize) -> Problem {
    let amplitude = 0.01;
    let grid = Grid::new(m, 4, 1.0 / m as f64, 1.0 / m as f64).expect("a grid");
    let h = (0..grid.len())
        .map(|i| amplitude * (1.0 - (TAU * ((i % m) as f64 + 0.5 - 0.5 * m as f64) / m as f64).cos()))
        .collect();
    let force = 0.5 * PI * amplitude * grid.element_area() * grid.len() as f64;
    let exact = 0.5 * amplitude * (1.0 - 0.5_f64.ln());
    Problem { name: "wave", grid, h, bodies: UNIT, load: Load::Force(force), exact }
}

/// Solves a problem. Returns the force or the approach that is found, the seconds, the work units and the cycles; None if the method fails.
fn run(problem: &Problem, method: Method, tolerance: f64) -> Option<(f64, f64, f64, u64)> {
    let mut scene = Scene::new(problem.grid, &problem.h, problem.bodies, problem.load);
    if problem.name == "wave" {
        scene.period = Some(Period { x: true, y: true });
    }
    let options = Options { method, tolerance, max_cycles: 3000, ..Options::default() };
    let (_, _, report) = solve(&scene, &options).ok()?;
    let found = report.measures.found(problem.load);
    Some((found, report.setup_seconds + report.solve_seconds, report.count.work_units, report.count.cycles))
}

fn of_case(case: case::Case, name: &'static str, exact: f64) -> Problem {
    Problem { name, grid: case.grid, h: case.h, bodies: case.bodies, load: case.load, exact }
}

/// Makes the study, and returns all lines.
pub fn study(quick: bool) -> String {
    let mut lines = String::from("case,method,mx,tolerance,seconds,work,cycles,error\n");
    let largest = if quick { 256 } else { 2048 };
    let mut study = |problem: &Problem, method: Method, tolerance: f64| {
        // The products of NORM grow with the size, and cycles with Gauss-Seidel sweeps are slow. Grids up to these sizes show that.
        let most = match method {
            Method::Norm | Method::Multigrid => 256,
            Method::FullMultigrid => 512,
            _ => usize::MAX,
        };
        if problem.grid.mx > most {
            return;
        }
        if let Some((found, mut seconds, work, cycles)) = run(problem, method, tolerance) {
            // The least of nine times, or of two if they are long: the time of a machine that does nothing else.
            for _ in 0..if seconds < 0.1 { 8 } else { 1 } {
                seconds = run(problem, method, tolerance).map_or(seconds, |again| seconds.min(again.1));
            }
            let error = (found / problem.exact - 1.0).abs();
            let (name, mx) = (problem.name, problem.grid.mx);
            let line = format!("{name},{method:?},{mx},{tolerance:e},{seconds:.3e},{work:.2},{cycles},{error:.3e}");
            writeln!(lines, "{line}").expect("memory");
        }
    };

    let sizes: Vec<usize> = (4..12).map(|k| 1 << k).filter(|m| *m <= largest).collect();
    for name in ["ellipse", "cone", "flat punch", "wave"] {
        for &m in &sizes {
            let problem = if name == "wave" { westergaard(m) } else { closed_form(name, m) };
            GRIDS.iter().for_each(|tolerance| study(&problem, Method::Auto, *tolerance));
            if m == 128 && name == "ellipse" {
                let tolerances =
                    (2..=12).map(|k| 10f64.powi(-k)).flat_map(|tolerance| METHODS.map(|method| (method, tolerance)));
                tolerances.for_each(|(method, tolerance)| study(&problem, method, tolerance));
            }
        }
    }
    let exact = |case: case::Case| run(&of_case(case, "", 1.0), Method::Auto, 1e-9).map_or(f64::NAN, |run| run.0);
    for m in [64, 128, 256, 512].into_iter().filter(|m| 4 * m <= largest) {
        let problem = of_case(case::rough(m), "rough", exact(case::rough(4 * m)));
        GRIDS.iter().for_each(|tolerance| study(&problem, Method::Auto, *tolerance));
    }
    for refinement in [1, 2, 4] {
        let rail = |refinement| case::wheel_rail("y4_82kN", refinement);
        let problem = of_case(rail(refinement), "wheel-rail", exact(rail(4 * refinement)));
        GRIDS.iter().for_each(|tolerance| study(&problem, Method::Auto, *tolerance));
    }
    lines
}
