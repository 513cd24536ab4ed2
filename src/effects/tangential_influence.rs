//! The caller's tangential influence coefficients, which belong to [`Friction`](super::Friction), and their checks.

use toeplitz::coefficients::SYMMETRY;

use crate::error::{invalid, require, Error, Number, Result};
use crate::grid::Grid;
use crate::influence::offset_beyond;
use crate::memory::copied;

/// The caller's tangential influence coefficients, in the caller's memory.
pub type TangentialInfluence<'a> = TangentialTables<&'a [f64]>;

/// A solver's copy of the caller's tangential influence coefficients.
pub type KeptInfluence = TangentialTables<Vec<f64>>;

/// Tables of tangential influence coefficients, over the offsets `-cx` to `cx - 1` and `-cy` to `cy - 1`, x fastest, as the table of pressures.
///
/// - Axx and Ayy must be even in x and in y, Axy odd in x and in y.
/// - In steady rolling of like bodies the coefficients need this symmetry in y only, because viscoelastic bodies are softer behind a load.
/// - With `by_row` there is a table for each loaded row, with another symmetry (`tangential_rows.rs`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentialTables<A> {
    /// Columns of the tables' grid: offsets in x are less than cx.
    pub cx: usize,
    /// Rows of the tables' grid: offsets in y are less than cy.
    pub cy: usize,
    /// Whether there is a table for each loaded row. A component has then the shape `[cy][cy][2 cx]`: the loaded row, the displaced row, and the
    /// offset in x. Otherwise a component has the shape `[2 cy][2 cx]`.
    pub by_row: bool,
    /// Axx, Ayy and Axy: the displacement in x by a traction in x, that in y by a traction in y, and that in x by a traction in y. In one table for
    /// all elements Axy is the displacement in y by a traction in x as well.
    pub coefficients: [A; 3],
    /// For unlike bodies Axz and Ayz: the displacements in x and in y by a pressure. Tractions displace the surfaces along the normal by
    /// `-(Axz qx + Ayz qy)`.
    pub cross: Option<[A; 2]>,
    /// A positive factor on every coefficient.
    pub scale: f64,
}

/// An offset `(kx, ky)`, and the coefficient there.
type AtOffset = ((i64, i64), f64);

/// The symmetry that a component must have.
#[derive(Clone, Copy)]
struct Symmetry {
    name: &'static str,
    /// The coefficient at `-kx` over that at `kx`: 1 (even) or -1 (odd).
    in_x: f64,
    /// The coefficient at `-ky` over that at `ky`: 1 (even) or -1 (odd).
    in_y: f64,
    /// The rule, for messages.
    rule: &'static str,
}

const ALONG: &str = "xx and yy must be even in x and in y, xy odd in both";
const IN_STEADY_ROLLING: &str = "in steady rolling xx and yy must be even in y, xy odd in y";
/// The rule for `scale`.
pub(super) const SCALE: &str = "coefficients are scaled by a positive, finite number";

const CROSS: &str = "xz must be odd in x and even in y, yz even in x and odd in y";

/// The symmetries of xx, yy, xy, xz and yz.
const SYMMETRIES: [Symmetry; 5] = [
    Symmetry { name: "friction->influence[0] (xx)", in_x: 1.0, in_y: 1.0, rule: ALONG },
    Symmetry { name: "friction->influence[1] (yy)", in_x: 1.0, in_y: 1.0, rule: ALONG },
    Symmetry { name: "friction->influence[2] (xy)", in_x: -1.0, in_y: -1.0, rule: ALONG },
    Symmetry { name: "friction->influence_cross[0] (xz)", in_x: -1.0, in_y: 1.0, rule: CROSS },
    Symmetry { name: "friction->influence_cross[1] (yz)", in_x: 1.0, in_y: -1.0, rule: CROSS },
];

impl TangentialInfluence<'_> {
    /// The name of the member of `friction` that holds these tables.
    pub fn name(&self) -> &'static str {
        if self.by_row {
            "friction->row_tables"
        } else {
            "friction->influence"
        }
    }

    /// `[Axx, Ayy, Axy]` at an offset of one table for all elements.
    pub fn at(&self, kx: i64, ky: i64) -> [f64; 3] {
        let k = (ky + self.cy as i64) as usize * 2 * self.cx + (kx + self.cx as i64) as usize;
        self.coefficients.map(|values| self.scale * values[k])
    }

    /// `[Axz, Ayz]` at an offset; 0 if the tables have no such components.
    pub fn cross_at(&self, kx: i64, ky: i64) -> [f64; 2] {
        let k = (ky + self.cy as i64) as usize * 2 * self.cx + (kx + self.cx as i64) as usize;
        self.cross.map_or([0.0; 2], |tables| tables.map(|values| self.scale * values[k]))
    }

    /// Whether coefficients of like bodies lack their symmetry in x by more than round-off: Axx and Ayy are not even in x, or Axy is not odd.
    pub fn is_uneven(&self) -> bool {
        let largest = self.at(0, 0)[0].max(self.at(0, 0)[1]);
        let differ = |kx: i64, ky: i64| {
            let (right, left) = (self.at(kx, ky), self.at(-kx, ky));
            let differences = [right[0] - left[0], right[1] - left[1], right[2] + left[2]];
            differences.iter().any(|difference| !(difference.abs() <= SYMMETRY * largest))
        };
        self.cross.is_none() && (0..self.cy as i64).any(|ky| (0..self.cx as i64).any(|kx| differ(kx, ky)))
    }

    /// Refuses tables that do not reach the offsets of a grid, and coefficients that no elastic body has: without the symmetries, with an element
    /// that a traction does not displace along itself, or larger than those of an element on itself. `is_steady`: the bodies roll steadily; the
    /// coefficients of like bodies then need no symmetry in x.
    pub(super) fn check(&self, grid: &Grid, is_steady: bool) -> Result<()> {
        require(self.scale > 0.0 && self.scale.is_finite(), "friction->influence->scale", self.scale, SCALE)?;
        for (name, c, m) in [("cx", self.cx, grid.mx), ("cy", self.cy, grid.my)] {
            if c < m {
                let rule = format!("the tables must reach the offsets of the grid: {m}");
                return invalid(format!("friction->influence->{name} is {c}; {rule}"));
            }
        }
        let expected = self.cx.checked_mul(self.cy).and_then(|n| n.checked_mul(4));
        let tables = || self.coefficients.iter().chain(self.cross.iter().flatten()).zip(SYMMETRIES);
        for (values, Symmetry { name, .. }) in tables() {
            if expected != Some(values.len()) {
                return invalid(format!("{name} has {} values; it must have 2 cx by 2 cy", values.len()));
            }
        }
        let at_0 = self.at(0, 0);
        // `check_symmetry` refuses a NaN, with the name of its table.
        if at_0[0] <= 0.0 || at_0[1] <= 0.0 {
            let rule = "a traction must displace its own element along";
            return Err(Error::NotPositiveDefinite(format!(
                "friction->influence at offset (0, 0) is {at_0:?}; {rule}"
            )));
        }
        let largest = at_0[0].max(at_0[1]);
        let in_x_too = !is_steady || self.cross.is_some();
        tables().try_for_each(|(values, symmetry)| self.check_symmetry(values, (symmetry, in_x_too), largest))?;
        self.check_largest()
    }

    /// Refuses an offset k if the mean of the coefficients at k and at -k exceeds the coefficient of an element on itself. The matrix of two elements
    /// at such an offset is indefinite.
    fn check_largest(&self) -> Result<()> {
        let [xx, yy, _] = self.at(0, 0);
        let last = (self.cx as i64 - 1, self.cy as i64 - 1);
        for (k, own) in [xx, yy, xx.sqrt() * yy.sqrt()].into_iter().enumerate() {
            if let Some((kx, ky)) = offset_beyond(own, last, |kx, ky| self.at(kx, ky)[k]) {
                let (name, value, own) = (SYMMETRIES[k].name, Number(self.at(kx, ky)[k]), Number(own));
                return Err(Error::NotPositiveDefinite(format!(
                    "{name} at offset ({kx}, {ky}) is {value}; the coefficients at (0, 0) allow {own}: no elastic body moves another element more than \
                     the one that is pulled. Offset (0, 0) is value [cy][cx] of the table"
                )));
            }
        }
        Ok(())
    }

    /// Refuses tables that suit no motion on the grid. Each solve makes the further checks that its own motion needs.
    pub fn check_for_any_motion(&self, grid: &Grid) -> Result<()> {
        if self.by_row {
            return self.check_rows(grid);
        }
        self.check(grid, true)
    }

    /// Refuses values of one component without the symmetry in y or, if `in_x_too`, in x.
    fn check_symmetry(&self, values: &[f64], (symmetry, in_x_too): (Symmetry, bool), largest: f64) -> Result<()> {
        let Symmetry { in_x, in_y, .. } = symmetry;
        let (cx, width) = (self.cx, 2 * self.cx);
        let row = |ky: i64| &values[(ky + self.cy as i64) as usize * width..][..width];
        let allowed = SYMMETRY * largest / self.scale;
        let differ = |a: f64, b: f64| !((a - b).abs() <= allowed);
        for ky in 0..self.cy as i64 {
            let (at_ky, at_minus_ky) = (row(ky), row(-ky));
            for kx in 0..cx as i64 {
                let (right, left) = (cx + kx as usize, cx - kx as usize);
                let at = [
                    ((kx, ky), at_ky[right]),
                    ((-kx, ky), at_ky[left]),
                    ((kx, -ky), at_minus_ky[right]),
                    ((-kx, -ky), at_minus_ky[left]),
                ];
                let values = at.map(|(_, value)| value);
                let signs = [1.0, in_x, in_y, in_x * in_y];
                let pair = match in_x_too {
                    true => (1..4).find(|&k| differ(signs[k] * values[k], values[0])).map(|k| (0, k)),
                    false => [(0, 2), (1, 3)].into_iter().find(|&(k, other)| differ(values[k], in_y * values[other])),
                };
                if let Some((k, other)) = pair {
                    return self.uneven_at(&at, (at[k], at[other]), (symmetry, in_x_too));
                }
            }
        }
        Ok(())
    }

    /// Refuses the four values at an offset and its mirror images, because one is not finite, or because the values `one` and `other` differ.
    fn uneven_at(
        &self,
        all: &[AtOffset; 4],
        (one, other): (AtOffset, AtOffset),
        (Symmetry { name, rule, .. }, in_x_too): (Symmetry, bool),
    ) -> Result<()> {
        if let Some(((x, y), at)) = all.iter().find(|(_, at)| !(self.scale * at).is_finite()) {
            let finite = "coefficients must be finite";
            return Err(Error::NotFinite(format!("{name} at offset ({x}, {y}) is {}; {finite}", Number(*at))));
        }
        let rule = if in_x_too { rule } else { IN_STEADY_ROLLING };
        let (((x0, y0), value), ((x, y), at)) = (one, other);
        let [value, at] = [value, at].map(Number);
        Err(Error::Unsupported(format!("{name} is {value} at offset ({x0}, {y0}) and {at} at ({x}, {y}); {rule}")))
    }
}

impl KeptInfluence {
    /// Copies the caller's tables. Their sizes have been checked.
    pub fn new(given: &TangentialInfluence<'_>) -> Result<KeptInfluence> {
        let copy = |values: &[f64]| copied(values, "the tangential influence coefficients");
        let TangentialTables { cx, cy, by_row, coefficients: [xx, yy, xy], cross, scale } = *given;
        let cross = match cross {
            Some([xz, yz]) => Some([copy(xz)?, copy(yz)?]),
            None => None,
        };
        Ok(TangentialTables { cx, cy, by_row, coefficients: [copy(xx)?, copy(yy)?, copy(xy)?], cross, scale })
    }

    /// The tables, borrowed from this copy.
    pub fn view(&self) -> TangentialInfluence<'_> {
        let TangentialTables { cx, cy, by_row, ref coefficients, ref cross, scale } = *self;
        let coefficients = coefficients.each_ref().map(|values| &values[..]);
        let cross = cross.as_ref().map(|tables| tables.each_ref().map(|values| &values[..]));
        TangentialTables { cx, cy, by_row, coefficients, cross, scale }
    }

    /// Whether these tables equal `other`, apart from row -cy and column -cx, which no product reads.
    pub fn is(&self, other: &TangentialInfluence<'_>) -> bool {
        let kept = self.view();
        let (cx, cy, width) = (self.cx, self.cy, 2 * self.cx);
        let rows = if self.by_row { 0..cy * cy } else { 1..2 * cy };
        let same = |kept: &[f64], other: &[f64]| {
            let read = |row: usize| row * width + 1..(row + 1) * width;
            kept.len() == other.len() && rows.clone().all(|row| kept[read(row)] == other[read(row)])
        };
        let cross = match (&kept.cross, &other.cross) {
            (Some(kept), Some(other)) => kept.iter().zip(other).all(|(kept, other)| same(kept, other)),
            (kept, other) => kept.is_none() && other.is_none(),
        };
        (cx, cy, self.scale, self.by_row) == (other.cx, other.cy, other.scale, other.by_row)
            && kept.coefficients.iter().zip(&other.coefficients).all(|(kept, other)| same(kept, other))
            && cross
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.coefficients.iter().chain(self.cross.iter().flatten()).map(|values| size_of_val(&values[..])).sum()
    }
}
