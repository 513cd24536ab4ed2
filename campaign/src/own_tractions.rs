//! The caller's own tangential coefficients: tables over offsets, for softer like bodies or for bodies that relax and roll, and tables per loaded
//! row.
//!
//! All are made from the coefficients of half-spaces, so that the campaign's products (`tangential`) can use them:
//!
//! ```text
//! even:    f A
//! uneven:  A + c sum over n >= 0 of (1 - e) e^n A(x + n)        in steady rolling towards +x: softer behind the contact; or mirrored in x
//! rows:    d_i A d_j, of the rows i and j; pressures alike
//! ```

use contact_normal::ffi::*;

use crate::effects::UserCoefficients;
use crate::grid::Grid;
use crate::half_space::free;
use crate::init::initialised;
use crate::random::Random;

/// The largest number of elements in a step of rolling.
pub const STEP: usize = 3;
/// The relative size of an uneven table at its end.
const NOTHING: f64 = 1e-18;

/// The rule by which the tables are made.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    Even { factor: f64 },
    Uneven { c: f64, e: f64, back: bool },
    Rows { d: Vec<f64> },
}

/// The tables xx, yy and xy.
#[derive(Clone, Debug)]
pub struct TractionTables {
    pub kind: Kind,
    cx: usize,
    cy: usize,
    values: [Vec<f64>; 3],
}

/// The half-space's coefficients xx, yy and xy at offsets in elements.
pub type At<'a> = &'a dyn Fn(i64, i64) -> [f64; 3];

impl Kind {
    /// A random kind.
    pub fn random(random: &mut Random, grid: &Grid) -> Kind {
        match random.integer(0, 3) {
            0 => Kind::Even { factor: random.decades(0.1, 10.0) },
            1 => Kind::Rows { d: (0..grid.my).map(|_| random.between(0.8, 1.2)).collect() },
            _ => Kind::Uneven {
                c: random.decades(0.1, 10.0),
                e: (-1.0 / random.decades(0.1, 30.0)).exp(),
                back: random.chance(0.5),
            },
        }
    }

    /// The rolling direction of uneven tables.
    pub fn direction(&self) -> f64 {
        match self {
            Kind::Uneven { back: true, .. } => std::f64::consts::PI,
            _ => 0.0,
        }
    }

    /// The coefficients of a row of offsets, beginning with `first`.
    pub fn row(&self, ky: i64, first: i64, count: usize, at: At<'_>) -> Vec<[f64; 3]> {
        let plain = || (0..count as i64).map(|k| at(first + k, ky));
        match *self {
            Kind::Rows { .. } => plain().collect(),
            Kind::Even { factor } => plain().map(|entry| entry.map(|value| factor * value)).collect(),
            Kind::Uneven { c, e, back: true } => {
                let ahead = Kind::Uneven { c, e, back: false }.row(ky, -(first + count as i64 - 1), count, at);
                ahead.into_iter().rev().map(|[xx, yy, xy]| [xx, yy, -xy]).collect()
            }
            Kind::Uneven { c, e, back: false } => {
                let beyond = (NOTHING.ln() / e.ln()).ceil() as i64;
                let (mut behind, mut row) = ([0.0; 3], vec![[0.0; 3]; count]);
                for k in (0..count as i64 + beyond).rev() {
                    let entry = at(first + k, ky);
                    behind = [0, 1, 2].map(|i: usize| (1.0 - e) * entry[i] + e * behind[i]);
                    if let Some(value) = row.get_mut(k as usize) {
                        *value = [0, 1, 2].map(|i: usize| entry[i] + c * behind[i]);
                    }
                }
                row
            }
        }
    }
}

impl TractionTables {
    /// Tables for a grid and steps of a few elements.
    pub fn new(kind: Kind, grid: &Grid, at: At<'_>) -> TractionTables {
        let (cx, is_by_row) = (grid.mx + STEP + 1, matches!(kind, Kind::Rows { .. }));
        let cy = if is_by_row { grid.my } else { grid.my + 1 };
        let mut values = [Vec::new(), Vec::new(), Vec::new()];
        let mut add = |ky: i64, factor: f64| {
            for entry in kind.row(ky, -(cx as i64), 2 * cx, at) {
                values.iter_mut().zip(entry).for_each(|(values, value)| values.push(factor * value));
            }
        };
        match &kind {
            Kind::Rows { d } => {
                (0..cy * cy).for_each(|k| add((k % cy) as i64 - (k / cy) as i64, d[k % cy] * d[k / cy]))
            }
            _ => (-(cy as i64)..cy as i64).for_each(|ky| add(ky, 1.0)),
        }
        TractionTables { kind, cx, cy, values }
    }

    /// The coefficients of pressures that belong to tables per loaded row, or None: those of the bodies.
    pub fn of_pressures(&self, grid: &Grid, c: f64) -> Option<UserCoefficients> {
        let Kind::Rows { d } = &self.kind else { return None };
        let (cx, cy) = (grid.mx, grid.my);
        let half_space = free(cx + 1, cy, grid.dx, grid.dy, c);
        let value = |k: usize| {
            let (kx, iy, jy) = (k % (2 * cx), k / (2 * cx) % cy, k / (2 * cx) / cy);
            d[iy] * d[jy] * half_space.at(kx as i64 - cx as i64, iy as i64 - jy as i64)
        };
        Some(UserCoefficients { cx, cy, values: (0..cy * cy * 2 * cx).map(value).collect() })
    }
}

/// The structs of the C ABI.
pub struct Structs {
    tables: [contact_normal_influence; 3],
    rows: [contact_normal_row_tables; 3],
}

impl Structs {
    /// Structs that point to these tables.
    pub fn new(own: &TractionTables) -> Box<Structs> {
        let table = |values: &Vec<f64>| {
            let mut table = initialised(contact_normal_influence_init);
            (table.cx, table.cy, table.coefficients) = (own.cx as i32, own.cy as i32, values.as_ptr());
            table
        };
        let rows = |values: &Vec<f64>| {
            let mut rows = initialised(contact_normal_row_tables_init);
            (rows.cx, rows.rows, rows.coefficients) = (own.cx as i32, own.cy as i32, values.as_ptr());
            rows
        };
        Box::new(Structs { tables: own.values.each_ref().map(table), rows: own.values.each_ref().map(rows) })
    }

    /// Sets the tables of a friction struct.
    pub fn put(&self, own: &TractionTables, friction: &mut contact_normal_friction) {
        match own.kind {
            Kind::Rows { .. } => friction.row_tables = self.rows.each_ref().map(|rows| &raw const *rows),
            _ => friction.influence = self.tables.each_ref().map(|table| &raw const *table),
        }
    }
}
