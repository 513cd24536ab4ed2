//! Stresses below the surface: compares those of the library with direct sums of point forces.
//!
//! A force `(fx, fy, fz)` on the surface of a half-space, with fz directed into the body, causes the stresses of Boussinesq and Cerruti at `r = (x,
//! y, z)` (Johnson, Contact Mechanics, eq. 3.19 and appendix; Love, section 166). With `R = |r|` one of them is
//!
//! ```text
//! szz = -3 z^2 (fx x + fy y + fz z)/(2 pi R^5)
//! ```
//!
//! The load of an element is replaced by such forces at Gauss points, with more points on near elements. With patches the loads are multiplied by the
//! factor between their patch and that of the element above the point. With two periods the stresses are sums over waves (`stress_waves`).

use std::f64::consts::PI;
use std::ptr::null;

use contact_normal::ffi::*;

use crate::effect_structs::effect_structs;
use crate::effects::{self, Effects};
use crate::grid::Grid;
use crate::hankel::gauss;
use crate::init::initialised;
use crate::random::Random;
use crate::stress_waves::Waves;
use crate::verdict::Verdict;

/// The stresses xx, yy, zz, xy, xz, yz.
type Tensor = [f64; 6];

/// The stresses at a point by a unit force along z in the origin.
fn boussinesq(nu: f64, [x, y, z]: [f64; 3]) -> Tensor {
    let r = (x * x + y * y + z * z).sqrt();
    let (h, r3, s) = (1.0 - 2.0 * nu, r.powi(3), r + z);
    let along =
        |a: f64| h * (z / r3 - 1.0 / (r * s) + a * a * (2.0 * r + z) / (r3 * s * s)) - 3.0 * a * a * z / r.powi(5);
    let (xx, yy) = (along(x), along(y));
    let xy = h * x * y * (2.0 * r + z) / (r3 * s * s) - 3.0 * x * y * z / r.powi(5);
    let shear = -3.0 * z * z / r.powi(5);
    [xx, yy, shear * z, xy, shear * x, shear * y].map(|value| value / (2.0 * PI))
}

/// The stresses at a point by a unit force along x in the origin.
fn cerruti(nu: f64, [x, y, z]: [f64; 3]) -> Tensor {
    let r = (x * x + y * y + z * z).sqrt();
    let (h, r2, s) = (1.0 - 2.0 * nu, r * r, r + z);
    let over = 1.0 / (r * s * s);
    let (c, d) = (x * x * (3.0 * r + z) / (r2 * s), y * y * (3.0 * r + z) / (r2 * s));
    let five = r.powi(5);
    let xx = -3.0 * x.powi(3) / five + h * (x / r.powi(3) - 3.0 * x * over + x * over * c);
    let yy = -3.0 * x * y * y / five + h * (x / r.powi(3) - x * over + x * over * d);
    let xy = -3.0 * x * x * y / five + h * y * over * (c - 1.0);
    let by = -3.0 * x * z / five;
    [xx, yy, by * z, xy, by * x, by * y].map(|value| value / (2.0 * PI))
}

/// The stresses at a point by a unit force along y in the origin.
fn cerruti_y(nu: f64, [x, y, z]: [f64; 3]) -> Tensor {
    let [xx, yy, zz, xy, xz, yz] = cerruti(nu, [y, x, z]);
    [yy, xx, zz, xy, yz, xz]
}

/// Gauss points along a side d of an element, relative to its centre, and their weights. The side is divided into parts of at most half of the
/// distance.
fn gauss_points(rule: &[(f64, f64)], d: f64, distance: f64) -> Vec<(f64, f64)> {
    let parts = (2.0 * d / distance).ceil().max(1.0);
    let part = |k: usize| rule.iter().map(move |(x, w)| ((k as f64 + x) * d / parts - 0.5 * d, w * d / parts));
    (0..parts as usize).flat_map(part).collect()
}

/// A body, and the loads on its surface.
struct Loaded {
    grid: Grid,
    nu: f64,
    /// p, qx and qy of the elements. None: there are none.
    loads: [Option<Vec<f64>>; 3],
    effects: Effects,
    /// The waves of the loads, if there are two periods.
    waves: Option<Waves>,
}

impl Loaded {
    /// The stresses at a point, by the campaign. x and y are measured from the outer corner of element (0, 0). `below` is the element above the
    /// point, if there is one.
    fn at(&self, point: [f64; 3], below: Option<usize>) -> Tensor {
        let Grid { mx, dx, dy, .. } = self.grid;
        if let Some(waves) = &self.waves {
            return waves.at(self.nu, point);
        }
        let factor = |j: usize| match (&self.effects.patches, below) {
            (Some(patches), Some(i)) => patches.between(i, j),
            _ => 1.0,
        };
        let (near, far, kernels) = (gauss(8), gauss(4), [boussinesq, cerruti, cerruti_y]);
        let mut sum = [0.0; 6];
        for j in 0..self.grid.len() {
            let factor = factor(j);
            let loads = self.loads.each_ref().map(|load| load.as_ref().map_or(0.0, |load| factor * load[j]));
            if loads == [0.0; 3] {
                continue;
            }
            let centre = [((j % mx) as f64 + 0.5) * dx, ((j / mx) as f64 + 0.5) * dy];
            let [x, y, z] = [point[0] - centre[0], point[1] - centre[1], point[2]];
            // The distance from the nearest point of the element.
            let beyond_edge = |x: f64, d: f64| f64::max(x.abs() - 0.5 * d, 0.0);
            let distance = beyond_edge(x, dx).hypot(beyond_edge(y, dy)).hypot(z);
            let rule = if distance > 10.0 * dx.max(dy) { &far } else { &near };
            let (in_x, in_y) = (gauss_points(rule, dx, distance), gauss_points(rule, dy, distance));
            for (px, wx) in &in_x {
                for (py, wy) in &in_y {
                    for (load, kernel) in loads.into_iter().zip(kernels).filter(|(load, _)| *load != 0.0) {
                        let stresses = kernel(self.nu, [x - px, y - py, z]);
                        sum.iter_mut().zip(stresses).for_each(|(sum, stress)| *sum += load * wx * wy * stress);
                    }
                }
            }
        }
        sum
    }

    /// The stresses of the library: at depths below all elements, `[component][depth][element]`, and at points. If the library refuses the call,
    /// returns its status. With two periods it may refuse stresses at points alone.
    fn library(&self, depths: &[f64], points: &[[f64; 3]]) -> Result<(Vec<Vec<f64>>, Vec<Tensor>), i32> {
        let structs = effect_structs(&self.effects);
        let mut scene = initialised(contact_normal_scene_init);
        (scene.mx, scene.my) = (self.grid.mx as i32, self.grid.my as i32);
        (scene.dx, scene.dy, scene.poisson_ratio) = (self.grid.dx, self.grid.dy, [0.1, self.nu]);
        structs.point_from(&mut scene, &self.effects);
        let mut stress = vec![vec![f64::NAN; depths.len() * self.grid.len()]; 6];
        let mut outputs = initialised(contact_normal_stress_outputs_init);
        outputs.stress = std::array::from_fn(|c| stress[c].as_mut_ptr());
        let [p, qx, qy] = self.loads.each_ref().map(|load| load.as_ref().map_or(null(), |load| load.as_ptr()));
        let (z, n) = (depths.as_ptr(), depths.len() as i32);
        // SAFETY: arrays as long as the grid and the depths say.
        let status = unsafe { contact_normal_subsurface_stress(&scene, 2, p, qx, qy, z, n, null(), &mut outputs) };
        let mut at = vec![[f64::NAN; 6]; points.len()];
        // The origin of this module is the outer corner of element (0, 0), that of the library the middle of the grid.
        let half = [self.grid.mx as f64 * self.grid.dx / 2.0, self.grid.my as f64 * self.grid.dy / 2.0];
        let points: Vec<[f64; 3]> = points.iter().map(|[x, y, z]| [x - half[0], y - half[1], *z]).collect();
        let (place, n) = (points.as_ptr().cast(), points.len() as i32);
        // SAFETY: as above, and room for six values of each point.
        let at_points =
            unsafe { contact_normal_stress_at_points(&scene, 2, p, qx, qy, place, n, null(), at.as_mut_ptr().cast()) };
        if self.waves.is_some() && at_points == CONTACT_NORMAL_UNSUPPORTED && status == CONTACT_NORMAL_OK {
            return Ok((stress, Vec::new()));
        }
        match (status, at_points) {
            (CONTACT_NORMAL_OK, CONTACT_NORMAL_OK) => Ok((stress, at)),
            (CONTACT_NORMAL_OK, refused) | (refused, _) => Err(refused),
        }
    }
}

/// Random loads on a grid: without effects, on patches, or with two periods. Also returns the largest absolute value of loads.
fn random_loads(random: &mut Random) -> (Loaded, f64) {
    let unit = random.decades(1e-3, 1e3);
    let kind = random.uniform();
    let (two_periods, has_patches) = (kind < 0.25, (0.25..0.4).contains(&kind));
    let most = if two_periods { 10 } else { 24 };
    let grid = Grid {
        mx: random.integer(1, most),
        my: random.integer(1, most),
        dx: unit,
        dy: unit * if random.chance(0.5) { 1.0 } else { random.decades(0.125, 8.0) },
    };
    let size = random.decades(1e-6, 1e6);
    let mut maybe_load = |chance: f64| {
        let values =
            (0..grid.len()).map(|_| size * random.between(-1.0, 1.0) * f64::from(random.chance(0.7))).collect();
        random.chance(chance).then_some(values)
    };
    let mut loads = [maybe_load(0.8), maybe_load(0.5), maybe_load(0.5)];
    if loads.iter().all(Option::is_none) {
        loads[0] = Some(vec![size; grid.len()]);
    }
    let effects = Effects {
        period: two_periods.then_some((true, true)),
        patches: has_patches.then(|| effects::patches(random, &grid)),
        ..Effects::default()
    };
    let of_element = |element: usize| loads.each_ref().map(|load| load.as_ref().map_or(0.0, |load| load[element]));
    let waves = two_periods.then(|| Waves::new(grid, of_element));
    let nu = random.between(0.0, 0.5);
    (Loaded { grid, nu, loads, effects, waves }, size)
}

/// Checks the stresses by random loads at two depths, below two elements and at two other points.
pub fn check(random: &mut Random) -> Verdict {
    let (loaded, size) = random_loads(random);
    let (grid, longer) = (loaded.grid, loaded.grid.dx.max(loaded.grid.dy));
    let depths = [longer * random.decades(0.2, 3.0), longer * random.decades(1.0, 100.0)];
    let elements: Vec<usize> = (0..2).map(|_| random.integer(0, grid.len() - 1)).collect();
    // Points may be up to one element outside the grid. With patches, a point needs an element above it.
    let margin = if loaded.effects.patches.is_some() { 0.0 } else { 1.0 };
    let coordinate = |random: &mut Random, m: usize, d: f64| random.between(-margin, m as f64 + margin) * d;
    let points: Vec<[f64; 3]> = (0..2)
        .map(|k| [coordinate(random, grid.mx, grid.dx), coordinate(random, grid.my, grid.dy), depths[k % 2]])
        .collect();
    let (on_grid, at_points) = match loaded.library(&depths, &points) {
        Ok(found) => found,
        Err(status) => return Verdict::failed("stresses are refused without a reason", format!("{status}")),
    };
    let mut verdict = Verdict::default();
    if at_points.len() < points.len() {
        verdict.excuse("refused: stresses at points of a period");
    }
    let mut compare = |found: Tensor, place: [f64; 3], below: Option<usize>| {
        let exact = loaded.at(place, below);
        for (c, (found, exact)) in found.into_iter().zip(exact).enumerate() {
            // Loads are at most `size`. The relative error of eight Gauss points on parts of half the distance is `(4 + sqrt 17)^-16 = 3e-15`. That
            // of four points at a distance of ten elements is `(1/40)^8`. Both grow by the derivatives of 1/R that stresses have.
            let is_near = (found - exact).abs() <= 1e-9 * size;
            verdict.unless(is_near, "stresses are those of the loads", || {
                let effects = loaded.effects.name();
                format!("component {c} at {place:?} of {grid:?}, {effects}: {found:e} for {exact:e}, loads of {size:e}")
            });
        }
    };
    for (k, z) in depths.into_iter().enumerate() {
        for &i in &elements {
            let centre = [((i % grid.mx) as f64 + 0.5) * grid.dx, ((i / grid.mx) as f64 + 0.5) * grid.dy, z];
            compare(std::array::from_fn(|c| on_grid[c][k * grid.len() + i]), centre, Some(i));
        }
    }
    for (found, place) in at_points.into_iter().zip(&points) {
        let [ix, iy] = [place[0] / grid.dx, place[1] / grid.dy].map(|value| value.floor());
        let is_within = ix >= 0.0 && iy >= 0.0 && ix < grid.mx as f64 && iy < grid.my as f64;
        compare(found, *place, is_within.then(|| iy as usize * grid.mx + ix as usize));
    }
    verdict
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the equilibrium of the stresses of each force by differences, and szz below the centre of a square with a uniform pressure by its
    /// closed form (Love 1929).
    #[test]
    fn kernels_are_in_equilibrium_and_have_the_closed_form() {
        for kernel in [boussinesq, cerruti, cerruti_y] {
            let (place, step) = ([0.7, -0.4, 0.9], 1e-4);
            let slope = |axis: usize, c: usize| {
                let at = |by: f64| {
                    let mut moved = place;
                    moved[axis] += by;
                    kernel(0.3, moved)[c]
                };
                (at(step) - at(-step)) / (2.0 * step)
            };
            for row in [[0, 3, 4], [3, 1, 5], [4, 5, 2]] {
                let sum: f64 = row.into_iter().enumerate().map(|(axis, c)| slope(axis, c)).sum();
                assert!(sum.abs() <= 1e-7, "{row:?}: {sum:e}");
            }
        }
        let grid = Grid { mx: 1, my: 1, dx: 2.0, dy: 2.0 };
        let loads = [Some(vec![1.0]), None, None];
        let loaded = Loaded { grid, nu: 0.3, loads, effects: Effects::default(), waves: None };
        let (z, r) = (0.8f64, (2.0f64 + 0.64).sqrt());
        let exact = -2.0 / PI * ((1.0 / (z * r)).atan() + 2.0 * z / (r * (1.0 + z * z)));
        assert!((loaded.at([1.0, 1.0, z], None)[2] - exact).abs() <= 1e-9);
    }
}
