//! Tables of tangential coefficients that a caller gives instead of elastic constants, in scenes with friction.
//!
//! All are made from the coefficients A of half-spaces, so that the campaign's products (`tangential`) can use them:
//!
//! | kind | coefficients | for |
//! |---|---|---|
//! | even | `f A` | softer or stiffer like bodies |
//! | uneven | `A + c sum over n >= 0 of (1 - e) e^n A(x + n)` | bodies that relax, in steady rolling towards +x; or mirrored in x |
//! | rows | `d_i A d_j`, for the rows i and j | row tables. The coefficients of pressures have the same factors |

use contact_normal::ffi::*;

use crate::effects::UserCoefficients;
use crate::grid::Grid;
use crate::half_space::free;
use crate::init::initialised;
use crate::random::Random;

/// The largest number of elements in a step of rolling.
pub const STEP: usize = 3;
/// Terms of the sum over n are left out if `e^n` is below this number.
const NOTHING: f64 = 1e-18;

/// How the tables are made from the coefficients of half-spaces.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    Even {
        factor: f64,
    },
    /// If `back` is true, the table is mirrored in x, for rolling towards -x.
    Uneven {
        c: f64,
        e: f64,
        back: bool,
    },
    Rows {
        d: Vec<f64>,
    },
}

/// The tables xx, yy and xy.
#[derive(Clone, Debug)]
pub struct TractionTables {
    pub kind: Kind,
    /// The coefficients are at offsets kx = -cx .. cx.
    cx: usize,
    /// In tables, the coefficients are at offsets ky = -cy .. cy. In row tables, this is the number of rows of the grid.
    cy: usize,
    values: [Vec<f64>; 3],
}

/// A function that returns the half-space's coefficients xx, yy and xy at an offset in elements.
pub type At<'a> = &'a dyn Fn(i64, i64) -> [f64; 3];

impl Kind {
    /// A random kind of tables.
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

    /// The rolling direction, as an angle: that of uneven tables, otherwise 0.
    pub fn direction(&self) -> f64 {
        match self {
            Kind::Uneven { back: true, .. } => std::f64::consts::PI,
            _ => 0.0,
        }
    }

    /// The coefficients at the offsets `(first, ky)`, `(first + 1, ky)`, ..., without the factors of rows.
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
                let terms = (NOTHING.ln() / e.ln()).ceil() as i64;
                // The sum over n at an offset follows from that at the next offset.
                let (mut sum, mut row) = ([0.0; 3], vec![[0.0; 3]; count]);
                for k in (0..count as i64 + terms).rev() {
                    let entry = at(first + k, ky);
                    sum = [0, 1, 2].map(|i: usize| (1.0 - e) * entry[i] + e * sum[i]);
                    if let Some(value) = row.get_mut(k as usize) {
                        *value = [0, 1, 2].map(|i: usize| entry[i] + c * sum[i]);
                    }
                }
                row
            }
        }
    }
}

impl TractionTables {
    /// The tables for a grid and steps of up to [`STEP`] elements.
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

    /// The row tables for pressures that belong to row tables for tractions. None for other kinds: pressures have the coefficients of the bodies.
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

/// The structs of the C ABI for these tables.
pub struct Structs {
    tables: [contact_normal_influence; 3],
    rows: [contact_normal_row_tables; 3],
}

impl Structs {
    /// Structs that point to these tables.
    pub fn new(traction_tables: &TractionTables) -> Box<Structs> {
        let (cx, cy) = (traction_tables.cx as i32, traction_tables.cy as i32);
        let table = |values: &Vec<f64>| {
            let mut table = initialised(contact_normal_influence_init);
            (table.cx, table.cy, table.coefficients) = (cx, cy, values.as_ptr());
            table
        };
        let rows = |values: &Vec<f64>| {
            let mut rows = initialised(contact_normal_row_tables_init);
            (rows.cx, rows.rows, rows.coefficients) = (cx, cy, values.as_ptr());
            rows
        };
        let values = traction_tables.values.each_ref();
        Box::new(Structs { tables: values.map(table), rows: values.map(rows) })
    }

    /// Points a friction struct to the structs of these tables.
    pub fn put(&self, tables: &TractionTables, friction: &mut contact_normal_friction) {
        match tables.kind {
            Kind::Rows { .. } => friction.row_tables = self.rows.each_ref().map(|rows| &raw const *rows),
            _ => friction.influence = self.tables.each_ref().map(|table| &raw const *table),
        }
    }
}
