//! Tangential influence coefficients of the caller's own, beside [`Friction`](super::Friction): what they must be.

use crate::error::{invalid, require, Error, Result};
use crate::grid::Grid;
use crate::memory::collected;

/// Tangential influence coefficients of the caller's own: three tables over offsets `-cx..cx-1` by `-cy..cy-1`, x fastest, laid out as the
/// table of the normal coefficients. Axx and Ayy must be even in both directions, Axy odd in both. Or `by_row`: see `tangential_rows.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentialInfluence<'a> {
    /// Elements of the grid that they were made for.
    pub cx: usize,
    /// And in y; of tables per loaded row the number of rows.
    pub cy: usize,
    /// Whether there is a table for each loaded row: `[cy][cy][2 cx]` of the loaded row, the row, and the offset in x.
    pub by_row: bool,
    /// Axx, Ayy, Axy: displacements in x by tractions in x, in y by those in y, and of one by the other; of tables per loaded row in x by
    /// tractions in y.
    pub coefficients: [&'a [f64]; 3],
    /// Of unlike bodies Axz and Ayz: displacements in x and in y by a unit pressure. Tractions displace along the normal by
    /// `-(Axz qx + Ayz qy)`.
    pub cross: Option<[&'a [f64]; 2]>,
    /// Every coefficient is multiplied by this, positive.
    pub scale: f64,
}

/// The sign of a component at a mirrored offset.
#[derive(Clone, Copy)]
struct Symmetry {
    name: &'static str,
    /// The sign that it takes where x, where y changes its own.
    in_x: f64,
    in_y: f64,
    rule: &'static str,
}

const OWN: &str = "xx and yy must be even in x and in y, xy odd in both";
/// The condition on a number that all tables are multiplied by.
pub(super) const SCALE: &str = "coefficients are scaled by a positive, finite number";

const CROSS: &str = "xz must be odd in x and even in y, yz even in x and odd in y";

/// Of the components xx, yy, xy, xz, yz.
const SYMMETRIES: [Symmetry; 5] = [
    Symmetry { name: "friction->influence[0] (xx)", in_x: 1.0, in_y: 1.0, rule: OWN },
    Symmetry { name: "friction->influence[1] (yy)", in_x: 1.0, in_y: 1.0, rule: OWN },
    Symmetry { name: "friction->influence[2] (xy)", in_x: -1.0, in_y: -1.0, rule: OWN },
    Symmetry { name: "friction->influence_cross[0] (xz)", in_x: -1.0, in_y: 1.0, rule: CROSS },
    Symmetry { name: "friction->influence_cross[1] (yz)", in_x: 1.0, in_y: -1.0, rule: CROSS },
];

/// Round-off allowed in even and odd tables, relative to the largest coefficient: tables in single precision pass.
pub(super) const SYMMETRY: f64 = 1e-7;

impl TangentialInfluence<'_> {
    /// The member of friction that they are given as.
    pub fn name(&self) -> &'static str {
        if self.by_row {
            "friction->row_tables"
        } else {
            "friction->influence"
        }
    }

    /// The coefficients at an offset of the tables.
    pub fn at(&self, kx: i64, ky: i64) -> [f64; 3] {
        let k = (ky + self.cy as i64) as usize * 2 * self.cx + (kx + self.cx as i64) as usize;
        self.coefficients.map(|values| self.scale * values[k])
    }

    /// Axz and Ayz at an offset of the tables; 0 without.
    pub fn cross_at(&self, kx: i64, ky: i64) -> [f64; 2] {
        let k = (ky + self.cy as i64) as usize * 2 * self.cx + (kx + self.cx as i64) as usize;
        self.cross.map_or([0.0; 2], |tables| tables.map(|values| self.scale * values[k]))
    }

    /// Refuses tables that do not reach the offsets of a grid, and what no coefficients of a half-space's kind are.
    pub(super) fn check(&self, grid: &Grid) -> Result<()> {
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
        let own = self.at(0, 0);
        if !(own[0] > 0.0 && own[1] > 0.0) {
            let rule = "a traction must displace its own element along";
            return Err(Error::NotPositiveDefinite(format!("friction->influence at offset (0, 0) is {own:?}; {rule}")));
        }
        let largest = own[0].max(own[1]);
        tables().try_for_each(|(values, symmetry)| self.check_symmetry(values, symmetry, largest))
    }

    /// Those of one component: each offset and its mirrors.
    fn check_symmetry(&self, values: &[f64], symmetry: Symmetry, largest: f64) -> Result<()> {
        let Symmetry { name, in_x, in_y, rule } = symmetry;
        let (cx, width) = (self.cx, 2 * self.cx);
        let row = |ky: i64| &values[(ky + self.cy as i64) as usize * width..][..width];
        let allowed = SYMMETRY * largest / self.scale;
        for ky in 0..self.cy as i64 {
            let (below, above) = (row(ky), row(-ky));
            for kx in 0..cx {
                let (right, left) = (cx + kx, cx - kx);
                let value = below[right];
                let mirrored = [value, in_x * below[left], in_y * above[right], in_x * in_y * above[left]];
                if mirrored.iter().all(|mirrored| (mirrored - value).abs() <= allowed) {
                    continue;
                }
                let x = kx as i64;
                let places = [(x, ky), (-x, ky), (x, -ky), (-x, -ky)];
                for ((x, y), at) in places.into_iter().zip([below[right], below[left], above[right], above[left]]) {
                    if !(self.scale * at).is_finite() {
                        let finite = "coefficients must be finite";
                        return Err(Error::NotFinite(format!("{name} at offset ({x}, {y}) is {at}; {finite}")));
                    }
                }
                let other = (1..4).find(|&k| !((mirrored[k] - value).abs() <= allowed)).unwrap_or(1);
                let ((x0, y0), (x, y)) = (places[0], places[other]);
                let at = [below[right], below[left], above[right], above[left]][other];
                return Err(Error::Unsupported(format!(
                    "{name} is {value} at offset ({x0}, {y0}) and {at} at ({x}, {y}); {rule}"
                )));
            }
        }
        Ok(())
    }
}

/// A copy of the caller's tables: those of a solver.
#[derive(Clone, Debug)]
pub struct KeptInfluence {
    cx: usize,
    cy: usize,
    by_row: bool,
    coefficients: [Vec<f64>; 3],
    cross: Option<[Vec<f64>; 2]>,
    scale: f64,
}

impl KeptInfluence {
    /// Of tables that have the sizes that they say.
    pub fn new(of: &TangentialInfluence<'_>) -> Result<KeptInfluence> {
        let copy = |values: &[f64]| collected(values.iter().copied(), "the tangential influence coefficients");
        let [xx, yy, xy] = of.coefficients;
        let cross = match of.cross {
            Some([xz, yz]) => Some([copy(xz)?, copy(yz)?]),
            None => None,
        };
        Ok(KeptInfluence {
            cx: of.cx,
            cy: of.cy,
            by_row: of.by_row,
            coefficients: [copy(xx)?, copy(yy)?, copy(xy)?],
            cross,
            scale: of.scale,
        })
    }

    /// The tables.
    pub fn view(&self) -> TangentialInfluence<'_> {
        TangentialInfluence {
            cx: self.cx,
            cy: self.cy,
            by_row: self.by_row,
            coefficients: self.coefficients.each_ref().map(|values| &values[..]),
            cross: self.cross.as_ref().map(|tables| tables.each_ref().map(|values| &values[..])),
            scale: self.scale,
        }
    }

    /// Whether these are the same, but for row -cy and column -cx, which nobody reads.
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
