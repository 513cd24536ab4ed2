//! The problems that are measured: the paper's ellipse, a self-affine rough surface, real wheel-rail contacts.

use std::f64::consts::TAU;

use contact_normal::grid::Grid;
use contact_normal::scene::{refine, Bodies, Load, Scene};

/// A problem that is measured.
pub struct Case {
    pub name: String,
    pub grid: Grid,
    pub bodies: Bodies,
    pub h: Vec<f64>,
    /// The load for which the targets are stated.
    pub load: Load,
}

impl Case {
    /// The scene with the load of the case.
    pub fn scene(&self) -> Scene<'_> {
        self.scene_with(self.load)
    }

    /// The scene with another load.
    pub fn scene_with(&self, load: Load) -> Scene<'_> {
        Scene::new(self.grid, &self.h, self.bodies, load)
    }
}

/// The paper's test problem (its section 5.1) on m x m elements: `[-10, 10] x [-6, 6]` mm, approach prescribed.
pub fn ellipse(m: usize) -> Case {
    let grid = Grid::new(m, m, 20.0 / m as f64, 12.0 / m as f64).expect("a valid grid");
    let centre = |i: usize, d: f64| (i as f64 + 0.5 - 0.5 * m as f64) * d;
    let h = (0..grid.len())
        .map(|i| {
            let (x, y) = (centre(i % m, grid.dx), centre(i / m, grid.dy));
            0.0016681 * x * x + 0.0030671 * y * y
        })
        .collect();
    let load = Load::Approach(0.1091);
    Case { name: format!("ellipse {m}"), grid, bodies: Bodies::same(82000.0, 0.28), h, load }
}

/// The rough surface of `data/rough` on m x m elements, mean pressure 0.007 E*.
pub fn rough(m: usize) -> Case {
    let z = heights(m);
    let highest = z.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Case {
        name: format!("rough {m}"),
        grid: Grid::new(m, m, 1.0 / m as f64, 1.0 / m as f64).expect("a valid grid"),
        bodies: Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0, 0.0] },
        h: z.into_iter().map(|z| highest - z).collect(),
        load: Load::Force(0.007),
    }
}

/// The heights `z = 2 Re sum of c exp(2 pi i (kx x + ky y))` at x, y = 0, 1/m, ..., with the coefficients c of the data file.
fn heights(m: usize) -> Vec<f64> {
    let text = read("data/rough/self_affine.txt");
    let lines: Vec<Vec<f64>> = text.lines().filter(|line| !line.starts_with('#')).map(numbers).collect();
    let wave: Vec<(f64, f64)> = (0..m).map(|i| (TAU * i as f64 / m as f64).sin_cos()).map(|(s, c)| (c, s)).collect();
    let turn = |k: f64, i: usize| wave[(k as i64 * i as i64).rem_euclid(m as i64) as usize];
    let mut z = vec![0.0; m * m];
    for of_one_ky in lines.chunk_by(|a, b| a[0] == b[0]) {
        let along_x: Vec<(f64, f64)> = (0..m)
            .map(|x| {
                of_one_ky.iter().fold((0.0, 0.0), |(re, im), line| {
                    let (c, s) = turn(line[1], x);
                    (re + line[2] * c - line[3] * s, im + line[2] * s + line[3] * c)
                })
            })
            .collect();
        for (y, row) in z.chunks_exact_mut(m).enumerate() {
            let (c, s) = turn(of_one_ky[0][0], y);
            for (z, (re, im)) in row.iter_mut().zip(&along_x) {
                *z += 2.0 * (re * c - im * s);
            }
        }
    }
    z
}

/// A wheel-rail contact of `data/wheel_rail` with a prescribed approach. Each element is divided into `refinement` x `refinement` elements.
pub fn wheel_rail(name: &str, refinement: usize) -> Case {
    let text = read(&format!("data/wheel_rail/{name}.txt"));
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let head = numbers(lines.next().expect("a first line"));
    let (mx, my) = (head[0] as usize, head[1] as usize);
    let h: Vec<f64> = lines.map(|line| numbers(line)[0]).collect();
    assert_eq!(h.len(), mx * my, "{name}: one line per element");
    let given = Grid::new(mx, my, head[2], head[3]).expect("a valid grid");
    let d = |i: usize| head[i] / refinement as f64;
    let suffix = if refinement == 1 { String::new() } else { format!(" x{refinement}") };
    Case {
        name: format!("wheel-rail {name}{suffix}"),
        grid: Grid::new(mx * refinement, my * refinement, d(2), d(3)).expect("a valid grid"),
        bodies: Bodies::same(head[6], head[7]),
        h: refine(&h, &given, (refinement, refinement), (false, false)).expect("memory"),
        load: Load::Approach(head[4]),
    }
}

/// A case by its name: "ellipse" or "rough" on m x m elements, or the name of a wheel-rail contact with the refinement m.
pub fn by_name(name: &str, m: usize) -> Case {
    match name {
        "ellipse" => ellipse(m),
        "rough" => rough(m),
        _ => wheel_rail(name, m),
    }
}

fn read(path: &str) -> String {
    std::fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).expect("the data file")
}

fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace().map(|x| x.parse().expect("a number")).collect()
}
