//! The effects that a scene may name, and random ones.

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
    pub fn at(&self, i: usize) -> f64 {
        match self {
            Values::Uniform(value) => *value,
            Values::PerElement(values) => values[i],
        }
    }
}

/// Patches, and the factors between them.
#[derive(Clone, Debug)]
pub struct Patches {
    pub count: usize,
    pub patch: Vec<i32>,
    pub factors: Vec<f64>,
}

impl Patches {
    /// The factor between two elements.
    pub fn between(&self, i: usize, j: usize) -> f64 {
        self.factors[self.patch[i] as usize * self.count + self.patch[j] as usize]
    }
}

/// Own coefficients, as in the C ABI.
#[derive(Clone, Debug)]
pub struct OwnCoefficients {
    pub cx: usize,
    /// Rows of offsets on either side (a table), or rows of the grid (row tables).
    pub cy: usize,
    pub values: Vec<f64>,
}

/// The effects of a scene.
#[derive(Clone, Debug, Default)]
pub struct Effects {
    pub layer: Option<Values>,
    pub limit: Option<Values>,
    pub period: Option<(bool, bool)>,
    pub patches: Option<Patches>,
    pub influence: Option<OwnCoefficients>,
    pub row_tables: Option<OwnCoefficients>,
    pub coating: Option<Coating>,
    /// Own coefficients that are not symmetric.
    pub unsymmetric: bool,
    /// Coefficients of no elastic body: the only promise is that the status is true.
    pub indefinite: bool,
}

impl Effects {
    /// The names of the effects, as "layer, period xy", or "plain".
    pub fn name(&self) -> String {
        let per_element = |values: &Option<Values>, one: &'static str, each: &'static str| match values {
            Some(Values::Uniform(_)) => Some(one),
            Some(Values::PerElement(_)) => Some(each),
            None => None,
        };
        let own = match (self.indefinite, self.unsymmetric) {
            (true, _) => ["influence (no elastic body)", "row_tables (no elastic body)"],
            (_, true) => ["influence (unsymmetric)", "row_tables (unsymmetric)"],
            _ => ["influence", "row_tables"],
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
            self.influence.as_ref().map(|_| own[0]),
            self.row_tables.as_ref().map(|_| own[1]),
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
        let own = self.influence.is_some() || self.row_tables.is_some();
        self.period.is_some() && (own || self.patches.is_some())
            || self.influence.is_some() && self.row_tables.is_some()
            || self.coating.is_some() && (own || matches!(self.period, Some((true, false) | (false, true))))
    }

    /// Effects that MULTIGRID and FULL_MULTIGRID may refuse (docs/effects.md).
    pub fn may_lack_multigrid(&self) -> bool {
        let layer = matches!(self.layer, Some(Values::PerElement(_)));
        self.period.is_some() || self.patches.is_some() || self.row_tables.is_some() || layer
    }
}

/// The kinds of effects that a scene names.
#[derive(Clone, Debug, Default)]
pub struct Kinds {
    pub layer: bool,
    pub limit: bool,
    pub period: Option<(bool, bool)>,
    pub patches: bool,
    pub influence: bool,
    pub row_tables: bool,
}

/// No effect, one or two.
pub fn kinds(random: &mut Random) -> Kinds {
    let mut kinds = Kinds::default();
    for _ in 0..random.pick(&[0, 0, 1, 1, 2, 2]) {
        match random.integer(0, 5) {
            0 => kinds.layer = true,
            1 => kinds.limit = true,
            2 => kinds.period = Some(random.pick(&[(true, false), (false, true), (true, true)])),
            3 => kinds.patches = true,
            4 => kinds.influence = true,
            _ => kinds.row_tables = true,
        }
    }
    kinds
}

/// Random effects of these kinds, without the limit, which belongs to the load. `c` is the compliance over pi.
pub fn make(random: &mut Random, kinds: &Kinds, grid: &Grid, c: f64) -> Effects {
    let mut effects = Effects { period: kinds.period, ..Effects::default() };
    let quality = random.uniform();
    let own = kinds.influence || kinds.row_tables;
    (effects.unsymmetric, effects.indefinite) = (own && quality < 0.4, own && quality < 0.15);
    let kind = (effects.unsymmetric, effects.indefinite);
    effects.influence = kinds.influence.then(|| table(random, grid, c, kind));
    effects.row_tables = kinds.row_tables.then(|| row_tables(random, grid, c, kind));
    if kinds.layer {
        effects.layer = Some(layer(random, grid, free(1, 1, grid.dx, grid.dy, c).at(0, 0)));
    }
    effects.patches = kinds.patches.then(|| patches(random, grid));
    effects
}

/// A compliance in units of the self-influence; now and then 0.
pub fn layer(random: &mut Random, grid: &Grid, own: f64) -> Values {
    let size = own * random.decades(1e-3, 1e3);
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

/// Blocks, stripes or scattered elements; factors `g_a g_b`, so that A stays positive definite.
pub fn patches(random: &mut Random, grid: &Grid) -> Patches {
    let count = random.integer(1, 4);
    let scattered = random.chance(0.2);
    let patch = (0..grid.len())
        .map(|i| match scattered {
            true => random.integer(0, count - 1) as i32,
            false => ((i % grid.mx) * count / grid.mx) as i32,
        })
        .collect();
    let part: Vec<f64> =
        (0..count).map(|_| if random.chance(0.5) { random.pick(&[0.0, 1.0]) } else { random.uniform() }).collect();
    let factors =
        (0..count * count).map(|k| if k / count == k % count { 1.0 } else { part[k / count] * part[k % count] });
    Patches { count, patch, factors: factors.collect() }
}

/// Sums of positive definite coefficients (the half-space, a foundation), or others that are not.
pub fn table(random: &mut Random, grid: &Grid, c: f64, (unsymmetric, indefinite): (bool, bool)) -> OwnCoefficients {
    let (cx, cy) = (grid.mx + random.pick(&[0, 0, 1, 7]), grid.my + random.pick(&[0, 0, 2]));
    let half_space = free(cx + 1, cy + 1, grid.dx, grid.dy, c);
    let own = half_space.at(0, 0);
    let (factor, foundation) = (random.decades(0.1, 10.0), random.pick(&[0.0, 0.0, 0.5]) * own);
    let (lean, noise) = (random.between(0.02, 0.3), own * random.decades(0.1, 10.0));
    let mut values = Vec::with_capacity(4 * cx * cy);
    for ky in -(cy as i64)..cy as i64 {
        for kx in -(cx as i64)..cx as i64 {
            let mut value = factor * half_space.at(kx, ky);
            if (kx, ky) == (0, 0) {
                value += foundation;
            } else if indefinite {
                value += noise * random.between(-1.0, 1.0);
            } else if unsymmetric && kx > 0 {
                value *= 1.0 - lean;
            }
            values.push(value);
        }
    }
    OwnCoefficients { cx, cy, values }
}

/// `d_iy d_jy c(kx, iy - jy)`: positive definite; with one of the two factors only it is not symmetric.
pub fn row_tables(
    random: &mut Random,
    grid: &Grid,
    c: f64,
    (unsymmetric, indefinite): (bool, bool),
) -> OwnCoefficients {
    let (cx, my) = (grid.mx + random.pick(&[0, 0, 3]), grid.my);
    let half_space = free(cx + 1, my, grid.dx, grid.dy, c);
    let noise = half_space.at(0, 0) * random.decades(0.1, 10.0);
    let scale: Vec<f64> = (0..my).map(|_| random.between(0.6, 1.4)).collect();
    let mut values = Vec::with_capacity(2 * cx * my * my);
    for jy in 0..my {
        for iy in 0..my {
            for kx in -(cx as i64)..cx as i64 {
                let part = if unsymmetric { scale[iy] } else { scale[iy] * scale[jy] };
                let mut value = part * half_space.at(kx, iy as i64 - jy as i64);
                if indefinite && (kx, iy) != (0, jy) {
                    value += noise * random.between(-1.0, 1.0);
                }
                values.push(value);
            }
        }
    }
    OwnCoefficients { cx, cy: my, values }
}
