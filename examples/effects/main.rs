//! Measures what each effect costs alone, on the ellipse of the paper: the table of docs/effects.md.
//!
//! `cargo run --release --example effects` prints the table, with medians of repeats in turns. `-- NAME M` makes one solve of one row on M x M
//! elements, to count its instructions: `valgrind --tool=callgrind target/release/examples/effects plain 128`.

use std::time::Instant;

use contact_normal::grid::Grid;
use contact_normal::influence::{HalfSpace, Kernel, RowTables};
use contact_normal::scene::{Bodies, Each, Layer, Load, Patches, Period, PressureLimit, Scene};
use contact_normal::solver::{solve, Options, Outcome, Report};

const ROWS: [&str; 10] = [
    "plain",
    "layer",
    "layer-per-element",
    "pressure_limit-not-reached",
    "pressure_limit",
    "period-x",
    "period-xy",
    "period-xy-layer",
    "patches",
    "row_tables",
];
const REPEATS: usize = 7;

/// The grid and the arrays of the scenes.
struct Arrays {
    grid: Grid,
    h: Vec<f64>,
    compliances: Vec<f64>,
    /// The patch of each element: the left and the right half of the grid.
    patch: Vec<i32>,
}

impl Arrays {
    fn new(m: usize) -> Arrays {
        let grid = Grid::new(m, m, 20.0 / m as f64, 12.0 / m as f64).expect("a valid grid");
        let centre = |i: usize, d: f64| (i as f64 + 0.5 - 0.5 * m as f64) * d;
        let square = |i: usize| (centre(i % m, grid.dx).powi(2), centre(i / m, grid.dy).powi(2));
        let h = (0..grid.len()).map(|i| 0.0016681 * square(i).0 + 0.0030671 * square(i).1).collect();
        // Compliances in mm3/N, 0 in the middle: at most about the displacement of the half-space by a unit pressure on a square of 1 mm.
        let compliances = (0..grid.len()).map(|i| 1e-5 * (square(i).0 / 20.0).min(1.0)).collect();
        let patch = (0..grid.len()).map(|i| i32::from(2 * (i % m) >= m)).collect();
        Arrays { grid, h, compliances, patch }
    }

    fn scene(&self, row: &str) -> Scene<'_> {
        let mut scene = Scene::new(self.grid, &self.h, Bodies::same(82000.0, 0.28), Load::Force(82000.0));
        match row {
            "layer" => scene.layer = Some(Layer(Each::Uniform(1e-5))),
            "layer-per-element" => scene.layer = Some(Layer(Each::PerElement(&self.compliances))),
            "pressure_limit-not-reached" => scene.pressure_limit = Some(PressureLimit(Each::Uniform(2000.0))),
            "pressure_limit" => scene.pressure_limit = Some(PressureLimit(Each::Uniform(1400.0))),
            "period-x" => scene.period = Some(Period { x: true, y: false }),
            "period-xy" => scene.period = Some(Period { x: true, y: true }),
            "patches" => {
                scene.patches = Some(Patches { count: 2, patch: &self.patch, factors: &[1.0, 0.5, 0.5, 1.0] });
            }
            "row_tables" => scene.row_tables = Some(self.row_tables(scene.bodies)),
            "period-xy-layer" => {
                (scene.period, scene.layer) = (Some(Period { x: true, y: true }), Some(Layer(Each::Uniform(1e-5))));
            }
            _ => {}
        }
        scene
    }

    /// Tables for a surface whose normals rotate by 0.6 rad over the grid: the coefficients are multiplied by the cosine of the angle between normals.
    fn row_tables(&self, bodies: Bodies) -> RowTables {
        let Grid { mx, my, dx, dy } = self.grid;
        let half_space = HalfSpace::new(dx, dy, bodies.compliance());
        let mut values = vec![0.0; my * my * 2 * mx];
        for (k, row) in values.chunks_exact_mut(2 * mx).enumerate() {
            let (jy, iy) = ((k / my) as i64, (k % my) as i64);
            half_space.fill_row(0, iy - jy, &mut row[mx..]);
            for kx in 0..mx {
                row[mx + kx] *= ((iy - jy) as f64 * 0.05 * dy).cos();
                row[mx - kx] = row[mx + kx];
            }
        }
        RowTables::new(mx, my, &values, &self.grid).expect("tables of the grid")
    }
}

/// Makes a cold call. Returns its seconds and the report.
fn call(scene: &Scene<'_>) -> (f64, Report) {
    let began = Instant::now();
    let (solver, stop, report) = solve(scene, &Options::default()).expect("a solvable scene");
    assert_eq!(stop, Outcome::Converged);
    drop(solver);
    (began.elapsed().as_secs_f64(), report)
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [row, m] = &arguments[..] {
        let arrays = Arrays::new(m.parse().expect("a number of elements"));
        let (_, report) = call(&arrays.scene(row));
        println!("{row} {m}: {} products, force {:.1}", report.count.matrix_products, report.measures.force);
        return;
    }
    let arrays = Arrays::new(512);
    let scenes = ROWS.map(|row| arrays.scene(row));
    let mut times = ROWS.map(|_| (Vec::new(), Vec::new()));
    let mut reports = Vec::new();
    for repeat in 0..REPEATS {
        for (scene, (setup_times, solve_times)) in scenes.iter().zip(&mut times) {
            let (seconds, report) = call(scene);
            setup_times.push(report.setup_seconds);
            solve_times.push(seconds - report.setup_seconds);
            if repeat == 0 {
                reports.push(report);
            }
        }
    }
    println!("| scene, 512 x 512 | set-up ms | solve ms | products | work units | bytes per element |");
    println!("|---|---:|---:|---:|---:|---:|");
    for ((row, (setup, solve)), report) in ROWS.into_iter().zip(times).zip(reports) {
        let (setup, solve) = (1e3 * median(setup), 1e3 * median(solve));
        let bytes = report.bytes as f64 / arrays.grid.len() as f64;
        let (products, work) = (report.count.matrix_products, report.count.work_units);
        println!("| {row} | {setup:.1} | {solve:.1} | {products} | {work:.1} | {bytes:.1} |");
    }
}
