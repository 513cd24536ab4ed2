//! Tangential influence coefficients of the caller's own, beside [`Friction`]: what they must be.

use super::friction::{Friction, Motion};
use crate::error::{invalid, require, Error, Result};
use crate::grid::Grid;

/// Tangential influence coefficients of the caller's own: three tables over offsets `-cx..cx-1` by `-cy..cy-1`, x fastest, laid out as the
/// table of the normal coefficients. Axx and Ayy must be even in both directions, Axy odd in both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentialInfluence<'a> {
    /// Elements of the grid that they were made for.
    pub cx: usize,
    /// And in y.
    pub cy: usize,
    /// Axx, Ayy, Axy: displacements in x by tractions in x, in y by those in y, and of one by the other.
    pub coefficients: [&'a [f64]; 3],
    /// Of unlike bodies Axz and Ayz: displacements in x and in y by a unit pressure. Tractions displace along the normal by
    /// `-(Axz qx + Ayz qy)`.
    pub cross: Option<[&'a [f64]; 2]>,
    /// Every coefficient is multiplied by this, positive.
    pub scale: f64,
}

/// A step of rolling is of whole elements if it is so near.
const WHOLE: f64 = 1e-9;

/// The names of the tables.
const TABLES: [&str; 3] = ["friction->influence[0] (xx)", "friction->influence[1] (yy)", "friction->influence[2] (xy)"];

/// Those of unlike bodies.
const CROSS_TABLES: [&str; 2] = ["friction->influence_cross[0] (xz)", "friction->influence_cross[1] (yz)"];

/// Round-off allowed in even and odd tables, relative to the largest coefficient: tables in single precision pass.
const SYMMETRY: f64 = 1e-7;

impl TangentialInfluence<'_> {
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

    /// Refuses tables that do not reach offsets of `mx` by `my`, and what no coefficients of a half-space's kind are.
    fn check(&self, mx: usize, my: usize) -> Result<()> {
        let scale = "coefficients are scaled by a positive, finite number";
        require(self.scale > 0.0 && self.scale.is_finite(), "friction->influence->scale", self.scale, scale)?;
        for (name, c, m) in [("cx", self.cx, mx), ("cy", self.cy, my)] {
            if c < m {
                let rule = format!("the tables must reach the offsets of the grid, and of a step of rolling: {m}");
                return invalid(format!("friction->influence->{name} is {c}; {rule}"));
            }
        }
        let expected = self.cx.checked_mul(self.cy).and_then(|n| n.checked_mul(4));
        let cross = self.cross.iter().flatten();
        for (name, values) in TABLES.iter().zip(&self.coefficients).chain(CROSS_TABLES.iter().zip(cross)) {
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
        for ky in 0..self.cy as i64 {
            for kx in 0..self.cx as i64 {
                self.check_offset(kx, ky, largest)?;
            }
        }
        Ok(())
    }

    /// Those of one offset and of its mirrors.
    fn check_offset(&self, kx: i64, ky: i64, largest: f64) -> Result<()> {
        let all = |x: i64, y: i64| {
            let ([xx, yy, xy], [xz, yz]) = (self.at(x, y), self.cross_at(x, y));
            [xx, yy, xy, xz, yz]
        };
        let value = all(kx, ky);
        // Of each component the sign that it takes where x, where y changes its own.
        let signs = [(1.0, 1.0), (1.0, 1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0)];
        for (component, name) in TABLES.iter().chain(&CROSS_TABLES).enumerate() {
            let (in_x, in_y) = signs[component];
            for (x, y, sign) in [(kx, ky, 1.0), (-kx, ky, in_x), (kx, -ky, in_y), (-kx, -ky, in_x * in_y)] {
                let mirrored = all(x, y)[component];
                if !mirrored.is_finite() {
                    let rule = "coefficients must be finite";
                    return Err(Error::NotFinite(format!("{name} at offset ({x}, {y}) is {mirrored}; {rule}")));
                }
                if !((mirrored - sign * value[component]).abs() <= SYMMETRY * largest) {
                    let (at, rule) = match component {
                        0..3 => (value[component], "xx and yy must be even in x and in y, xy odd in both"),
                        _ => (value[component], "xz must be odd in x and even in y, yz even in x and odd in y"),
                    };
                    return Err(Error::Unsupported(format!(
                        "{name} is {at} at offset ({kx}, {ky}) and {mirrored} at ({x}, {y}); {rule}"
                    )));
                }
            }
        }
        Ok(())
    }
}

impl Friction<'_> {
    /// Refuses tables that do not suit the grid and the step: between whole offsets they say nothing.
    pub(super) fn check_influence(&self, grid: &Grid) -> Result<()> {
        let Some(influence) = &self.influence else { return Ok(()) };
        let (mut mx, mut my) = (grid.mx, grid.my);
        if self.motion != Motion::Shift {
            let (distance, (sine, cosine)) = (self.distance(grid), self.rolling_direction.sin_cos());
            let (x, y) = (distance * cosine / grid.dx, distance * sine / grid.dy);
            if (x - x.round()).abs().max((y - y.round()).abs()) > WHOLE {
                return Err(Error::Unsupported(format!(
                    "friction->influence is given, and a step of rolling goes ({x}, {y}) elements far; it must be whole elements"
                )));
            }
            (mx, my) = (mx.saturating_add(x.round().abs() as usize), my.saturating_add(y.round().abs() as usize));
        }
        influence.check(mx, my)
    }
}
