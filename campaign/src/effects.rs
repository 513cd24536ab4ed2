//! The effects of a scene (layer, pressure limit, period, patches, ...), and functions that make random effects.

use crate::coating::Coating;
use crate::grid::Grid;
use crate::half_space::free;
use crate::random::Random;

/// A value for all elements, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    Uniform(f64),
    PerElement(Vec<f64>),
}

impl Values {
    /// The value of element i.
    pub fn at(&self, i: usize) -> f64 {
        match self {
            Values::Uniform(value) => *value,
            Values::PerElement(values) => values[i],
        }
    }
}

/// Patches: groups of elements, and factors on the influence coefficients between elements of two groups.
#[derive(Clone, Debug)]
pub struct Patches {
    /// The number of patches.
    pub count: usize,
    /// The patch of each element.
    pub patch: Vec<i32>,
    /// The factors, `[patch][patch]`.
    pub factors: Vec<f64>,
}

impl Patches {
    /// The factor between two elements.
    pub fn between(&self, i: usize, j: usize) -> f64 {
        self.factors[self.patch[i] as usize * self.count + self.patch[j] as usize]
    }
}

/// Influence coefficients that the caller of the library gives instead of elastic constants: a table, or row tables, as in the C ABI.
#[derive(Clone, Debug)]
pub struct UserCoefficients {
    /// The coefficients are at offsets kx = -cx .. cx.
    pub cx: usize,
    /// In a table, the coefficients are at offsets ky = -cy .. cy. In row tables, this is the number of rows of the grid.
    pub cy: usize,
    /// `[ky][kx]` of a table, `[jy][iy][kx]` of row tables: the displacements in row iy by pressures in row jy.
    pub values: Vec<f64>,
}

/// What the matrix A of a caller's coefficients is like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Definiteness {
    /// A is symmetric and positive definite, as for elastic bodies.
    #[default]
    PositiveDefinite,
    /// A is not symmetric.
    Unsymmetric,
    /// A may be indefinite, and need not be symmetric: no elastic body has such coefficients. The library may then fail, but must not return OK for a
    /// result that is no solution.
    Indefinite,
}

/// The effects of a scene.
#[derive(Clone, Debug, Default)]
pub struct Effects {
    /// Compliances of a thin layer.
    pub layer: Option<Values>,
    /// The largest pressures.
    pub limit: Option<Values>,
    /// Whether the scene is periodic in x, and whether it is in y.
    pub period: Option<(bool, bool)>,
    pub patches: Option<Patches>,
    /// A table of the caller's coefficients.
    pub influence: Option<UserCoefficients>,
    /// Row tables of the caller's coefficients.
    pub row_tables: Option<UserCoefficients>,
    pub coating: Option<Coating>,
    /// What A is like, if the scene has a table or row tables.
    pub definiteness: Definiteness,
}

impl Effects {
    /// The names of the effects, as "layer, period xy", or "plain".
    pub fn name(&self) -> String {
        let per_element = |values: &Option<Values>, one: &'static str, each: &'static str| match values {
            Some(Values::Uniform(_)) => Some(one),
            Some(Values::PerElement(_)) => Some(each),
            None => None,
        };
        let [influence, row_tables] = match self.definiteness {
            Definiteness::Indefinite => ["influence (no elastic body)", "row_tables (no elastic body)"],
            Definiteness::Unsymmetric => ["influence (unsymmetric)", "row_tables (unsymmetric)"],
            Definiteness::PositiveDefinite => ["influence", "row_tables"],
        };
        let period = |(x, y)| {
            if x && y {
                "period xy"
            } else if x {
                "period x"
            } else {
                "period y"
            }
        };
        let names = [
            self.influence.as_ref().map(|_| influence),
            self.row_tables.as_ref().map(|_| row_tables),
            self.period.map(period),
            self.coating.as_ref().map(|_| "coating"),
            self.patches.as_ref().map(|_| "patches"),
            per_element(&self.layer, "layer", "layer per element"),
            per_element(&self.limit, "limit", "limit per element"),
        ];
        let names: Vec<_> = names.into_iter().flatten().collect();
        if names.is_empty() {
            "plain".into()
        } else {
            names.join(" + ")
        }
    }

    /// Whether the effects contain a pair that this version does not solve (docs/effects.md).
    pub fn is_unsupported_pair(&self) -> bool {
        let has_user_table = self.influence.is_some() || self.row_tables.is_some();
        self.period.is_some() && (has_user_table || self.patches.is_some())
            || self.influence.is_some() && self.row_tables.is_some()
            || self.coating.is_some() && (has_user_table || matches!(self.period, Some((true, false) | (false, true))))
    }

    /// Whether MULTIGRID and FULL_MULTIGRID may refuse these effects.
    pub fn may_lack_multigrid(&self) -> bool {
        let layer = matches!(self.layer, Some(Values::PerElement(_)));
        self.period.is_some() || self.patches.is_some() || self.row_tables.is_some() || layer
    }
}

/// Which effects a random scene has. A coating is drawn separately.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    pub layer: bool,
    pub limit: bool,
    pub period: Option<(bool, bool)>,
    pub patches: bool,
    pub influence: bool,
    pub row_tables: bool,
}

/// Chooses up to two effects. The numbers 0, 1 and 2 of draws are equally likely. The list has each twice, so that seeds keep their scenes.
pub fn choose(random: &mut Random) -> Choice {
    let mut choice = Choice::default();
    for _ in 0..random.pick(&[0, 0, 1, 1, 2, 2]) {
        match random.integer(0, 5) {
            0 => choice.layer = true,
            1 => choice.limit = true,
            2 => choice.period = Some(random.pick(&[(true, false), (false, true), (true, true)])),
            3 => choice.patches = true,
            4 => choice.influence = true,
            _ => choice.row_tables = true,
        }
    }
    choice
}

/// Makes the chosen effects, except the pressure limit: `scales::limit` makes it, because its size depends on the load. `c = 1/(pi E*)`.
pub fn make(random: &mut Random, choice: &Choice, grid: &Grid, c: f64) -> Effects {
    let mut effects = Effects { period: choice.period, ..Effects::default() };
    let drawn = random.uniform();
    if choice.influence || choice.row_tables {
        effects.definiteness = match drawn {
            d if d < 0.15 => Definiteness::Indefinite,
            d if d < 0.4 => Definiteness::Unsymmetric,
            _ => Definiteness::PositiveDefinite,
        };
    }
    let definiteness = effects.definiteness;
    effects.influence = choice.influence.then(|| table(random, grid, c, definiteness));
    effects.row_tables = choice.row_tables.then(|| row_tables(random, grid, c, definiteness));
    if choice.layer {
        effects.layer = Some(layer(random, grid, free(1, 1, grid.dx, grid.dy, c).at(0, 0)));
    }
    effects.patches = choice.patches.then(|| patches(random, grid));
    effects
}

/// A layer: one compliance for all elements, or one for each. The compliance is 1e-3 to 1e3 times the influence of an element on itself,
/// `self_influence`, or up to 1e6 times for single elements. Some compliances are 0.
pub fn layer(random: &mut Random, grid: &Grid, self_influence: f64) -> Values {
    let size = self_influence * random.decades(1e-3, 1e3);
    if random.chance(0.5) {
        return Values::Uniform(if random.chance(0.1) { 0.0 } else { size });
    }
    let (bare, spread) = (random.between(0.0, 0.6), random.decades(1.0, 1e3));
    Values::PerElement(
        (0..grid.len())
            .map(|_| if random.chance(bare) { 0.0 } else { size * random.decades(1.0, spread + 1e-9) })
            .collect(),
    )
}

/// Stripes along y, or scattered elements. The factor is 1 within a patch and `g_a g_b`, with g from 0 to 1, between patches a and b. So A stays
/// positive definite (Schur's product theorem).
pub fn patches(random: &mut Random, grid: &Grid) -> Patches {
    let count = random.integer(1, 4);
    let scattered = random.chance(0.2);
    let patch = (0..grid.len())
        .map(|i| match scattered {
            true => random.integer(0, count - 1) as i32,
            false => ((i % grid.mx) * count / grid.mx) as i32,
        })
        .collect();
    let g: Vec<f64> =
        (0..count).map(|_| if random.chance(0.5) { random.pick(&[0.0, 1.0]) } else { random.uniform() }).collect();
    let factors = (0..count * count).map(|k| if k / count == k % count { 1.0 } else { g[k / count] * g[k % count] });
    Patches { count, patch, factors: factors.collect() }
}

/// A random table: the coefficients of the half-space times a factor, plus a Winkler foundation on the diagonal. Both are positive definite. If the
/// table shall be unsymmetric, the coefficients with kx > 0 are smaller. If it shall be indefinite, noise is added to all but the diagonal.
pub fn table(random: &mut Random, grid: &Grid, c: f64, definiteness: Definiteness) -> UserCoefficients {
    let (cx, cy) = (grid.mx + random.pick(&[0, 0, 1, 7]), grid.my + random.pick(&[0, 0, 2]));
    let half_space = free(cx + 1, cy + 1, grid.dx, grid.dy, c);
    let self_influence = half_space.at(0, 0);
    let (factor, foundation) = (random.decades(0.1, 10.0), random.pick(&[0.0, 0.0, 0.5]) * self_influence);
    let (reduction, noise) = (random.between(0.02, 0.3), self_influence * random.decades(0.1, 10.0));
    let mut values = Vec::with_capacity(4 * cx * cy);
    for ky in -(cy as i64)..cy as i64 {
        for kx in -(cx as i64)..cx as i64 {
            let mut value = factor * half_space.at(kx, ky);
            match definiteness {
                _ if (kx, ky) == (0, 0) => value += foundation,
                Definiteness::Indefinite => value += noise * random.between(-1.0, 1.0),
                Definiteness::Unsymmetric if kx > 0 => value *= 1.0 - reduction,
                _ => {}
            }
            values.push(value);
        }
    }
    UserCoefficients { cx, cy, values }
}

/// Random row tables `scale[iy] scale[jy] c(kx, iy - jy)`, with c of the half-space, which are positive definite. If they shall be unsymmetric or
/// indefinite, the factor `scale[jy]` is left out. If they shall be indefinite, noise is added to all but the diagonal.
pub fn row_tables(random: &mut Random, grid: &Grid, c: f64, definiteness: Definiteness) -> UserCoefficients {
    let (cx, my) = (grid.mx + random.pick(&[0, 0, 3]), grid.my);
    let half_space = free(cx + 1, my, grid.dx, grid.dy, c);
    let noise = half_space.at(0, 0) * random.decades(0.1, 10.0);
    let scale: Vec<f64> = (0..my).map(|_| random.between(0.6, 1.4)).collect();
    let mut values = Vec::with_capacity(2 * cx * my * my);
    for jy in 0..my {
        for iy in 0..my {
            for kx in -(cx as i64)..cx as i64 {
                let is_definite = definiteness == Definiteness::PositiveDefinite;
                let factor = if is_definite { scale[iy] * scale[jy] } else { scale[iy] };
                let mut value = factor * half_space.at(kx, iy as i64 - jy as i64);
                if definiteness == Definiteness::Indefinite && (kx, iy) != (0, jy) {
                    value += noise * random.between(-1.0, 1.0);
                }
                values.push(value);
            }
        }
    }
    UserCoefficients { cx, cy: my, values }
}
