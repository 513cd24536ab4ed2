//! Random cases with surfaces as users bring them: measured maps with their faults, line scans, strips, punches and gratings, on grids of up to 60000
//! elements.

mod faults;
mod grids;
mod heights;
mod loads;

pub use loads::any as load;

use crate::case::{Case, How};
use crate::coating;
use crate::effects::{self, Choice, Effects};
use crate::grid::Grid;
use crate::half_space::compliance;
use crate::random::Random;
use crate::scales::{self, Scales};

/// A random surface: its name, with the faults, and its undeformed distances in an arbitrary unit.
pub fn surface(random: &mut Random, grid: &Grid) -> (String, Vec<f64>) {
    let (mut name, mut h) = heights::any(random, grid);
    for fault in faults::any(random, grid, &mut h) {
        name = format!("{name} + {fault}");
    }
    (name, h)
}

/// The case of a seed.
pub fn case(seed: u64) -> Case {
    let mut random = Random::new(seed ^ 0x0006_3ea5_04ed);
    let random = &mut random;
    let grid = grids::any(random);
    let choice = choose(random, &grid);
    let modulus = if random.chance(0.2) { 10f64.powi(random.integer(0, 16) as i32 - 6) } else { 1.0 };
    let second = if random.chance(0.5) { f64::INFINITY } else { modulus * random.decades(0.1, 10.0) };
    let (shear_modulus, poisson_ratio) = ([modulus, second], [random.between(0.0, 0.5), 0.3]);
    let (mut name, mut h) = surface(random, &grid);
    let height = grid.dx * random.decades(1e-4, 1.0);
    h.iter_mut().for_each(|h| *h *= height);
    name += datum(&mut Random::new(seed ^ 0x00da_7a5e), height, &mut h);
    let c = compliance(shear_modulus, poisson_ratio);
    let mut effects = effects::make(random, &choice, &grid, c);
    if is_coated(random, &grid, &effects) {
        effects.coating = Some(coating::random(random, &grid, (shear_modulus, poisson_ratio), effects.period));
    }
    let load = load(random, &grid, &h, c, effects.period);
    if choice.limit {
        let scales = Scales::of(&h, &effects, &grid, c);
        effects.limit = Some(scales::limit(random, &scales, load, &h, &grid));
    }
    let how = how(random, &Scales::of(&h, &effects, &grid, c), &h, load, (choice.limit, &grid));
    let through_handle = grid.len() < 5000 && random.chance(0.15);
    Case {
        seed,
        grid,
        shear_modulus,
        poisson_ratio,
        surface: name,
        surfaces: surface,
        h,
        h_rounding: 0.0,
        load,
        effects,
        how,
        through_handle,
        is_measured: true,
    }
}

/// Shifts some surfaces by a constant, and flattens others. Returns what is added to the name of the surface.
fn datum(random: &mut Random, height: f64, h: &mut [f64]) -> &'static str {
    let (is_shifted, is_flat) = (random.chance(0.1), random.chance(0.02));
    let level = if is_shifted || is_flat { height * random.pick(&[1.0 / 3.0, -1.0, 30.0, 1e3]) } else { 0.0 };
    for h in h.iter_mut().filter(|h| h.is_finite()) {
        *h = if is_flat { level } else { *h + level };
    }
    match (is_shifted, is_flat) {
        (_, true) => " flattened",
        (true, false) => " above a datum",
        _ => "",
    }
}

/// Chooses the effects of a scene. Row tables are chosen on small grids only, because their products take long.
fn choose(random: &mut Random, grid: &Grid) -> Choice {
    let mut choice = Choice::default();
    // With a period, the sums over images take long for slender elements.
    let slender = grid.dx.max(grid.dy) > 8.0 * grid.dx.min(grid.dy);
    if !slender && random.chance(0.45) {
        choice.period = Some(random.pick(&[(true, false), (false, true), (true, true), (true, true)]));
    }
    choice.layer = random.chance(0.12);
    choice.limit = random.chance(0.2);
    if choice.period.is_none() {
        choice.patches = random.chance(0.06);
        choice.influence = random.chance(0.06);
        choice.row_tables = !choice.influence && grid.my <= 40 && grid.len() <= 2000 && random.chance(0.06);
    }
    choice
}

/// Whether the bodies are coated. They may be on small grids without slender elements only, because the campaign integrates coatings by quadrature.
fn is_coated(random: &mut Random, grid: &Grid, effects: &Effects) -> bool {
    let has_user_table = effects.influence.is_some() || effects.row_tables.is_some();
    let one_period = matches!(effects.period, Some((true, false) | (false, true)));
    let square = (0.1..=10.0).contains(&(grid.dx / grid.dy));
    !has_user_table && !one_period && square && grid.mx.max(grid.my) <= 130 && random.chance(0.1)
}

/// Random options, mostly with the method AUTO. Large grids always have AUTO, because other methods may take thousands of cycles.
fn how(
    random: &mut Random,
    scales: &Scales,
    h: &[f64],
    load: crate::grid::Load,
    (limited, grid): (bool, &Grid),
) -> How {
    let mut how = How::any(random, scales, h, load, limited);
    if random.chance(0.6) || grid.len() > 12000 {
        how.method = 0;
    }
    if random.chance(0.6) {
        (how.given, how.fixed, how.cancel_at, how.max_cycles) = (None, None, None, 1000);
    }
    how
}
