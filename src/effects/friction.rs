//! Effect: friction, `|q| <= g = mu p`: tangential tractions from the motion of the bodies, or from the tangential forces.
//!
//! See [`friction`](crate::friction) for the problem that is solved. The normal problem is the same with and without it where the bodies
//! are alike; it is solved first.

use std::f64::consts::PI;

use super::effect::{check_values, Effect};
use crate::error::{invalid, require, Error, Result};
use crate::grid::Grid;
use crate::scene::{Bodies, Plain};

/// mu, a number: the same everywhere or one per element, `[my][mx]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coefficient<'a> {
    /// The same everywhere.
    Uniform(f64),
    /// One per element.
    PerElement(&'a [f64]),
}

impl Coefficient<'_> {
    /// Of element i.
    pub fn at(&self, i: usize) -> f64 {
        match self {
            Coefficient::Uniform(mu) => *mu,
            Coefficient::PerElement(mu) => mu[i],
        }
    }
}

/// Steps of steady rolling, in elements.
const STEPS: std::ops::RangeInclusive<f64> = 0.1..=1e6;

/// Slips and tractions are smaller: their squares are numbers.
const LARGEST: f64 = 1e140;

/// Of angles and lengths.
const ROUND_OFF: f64 = 1e-14;

/// How the bodies move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Motion {
    /// Sideways and about the normal, without rolling; creepages are lengths, spin is an angle.
    #[default]
    Shift,
    /// A step of rolling, from the tractions before.
    TransientRolling,
    /// Rolling that does not change any more: the tractions before are those of now. Those that are given or kept are only where the
    /// iteration starts.
    SteadyRolling,
}

/// What is prescribed in a direction; the other one is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prescribed {
    /// The creepage: for a shift a length, for rolling a length per length rolled.
    Creepage(f64),
    /// The force on body 1.
    Force(f64),
}

/// Where the tractions before this step come from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Previous<'a> {
    /// There are none: from rest.
    #[default]
    None,
    /// Tractions in x and y, `[my][mx]` each.
    Given([&'a [f64]; 2]),
    /// What this solver found last.
    Kept,
}

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
        require(self.scale > 0.0 && self.scale.is_finite(), "friction->influence_scale", self.scale, scale)?;
        for (name, c, m) in [("cx", self.cx, mx), ("cy", self.cy, my)] {
            if c < m {
                let rule = format!("the tables must reach the offsets of the grid, and of a step of rolling: {m}");
                return invalid(format!("friction->influence_{name} is {c}; {rule}"));
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

/// Friction between the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction<'a> {
    /// mu.
    pub coefficient: Coefficient<'a>,
    /// How the bodies move.
    pub motion: Motion,
    /// In x and in y. The slip is that of body 1 over body 2: a negative creepage gives a positive force.
    pub prescribed: [Prescribed; 2],
    /// phi, about the normal: for a shift an angle, for rolling an angle per length rolled.
    pub spin: f64,
    /// Where the spin turns about and the moment is taken, from the centre of the grid.
    pub spin_centre: [f64; 2],
    /// dq, a length: rolled in the step. 0: dx.
    pub rolling_distance: f64,
    /// chi, an angle from the x axis.
    pub rolling_direction: f64,
    /// The part of the step by which places are ahead in the slip by spin.
    pub spin_offset: f64,
    /// The tractions before.
    pub previous: Previous<'a>,
    /// A rigid slip of the caller's in addition, lengths per step, x and y.
    pub rigid_slip: Option<[&'a [f64]; 2]>,
    /// Tangential coefficients of the caller's own; none: those of the half-space.
    pub influence: Option<TangentialInfluence<'a>>,
    /// Whether the derivatives of the forces by the creepages and the spin are asked for.
    pub sensitivities: bool,
}

impl Friction<'_> {
    /// Of a coefficient; nothing moves.
    pub fn new(coefficient: f64) -> Friction<'static> {
        Friction {
            coefficient: Coefficient::Uniform(coefficient),
            motion: Motion::Shift,
            prescribed: [Prescribed::Creepage(0.0); 2],
            spin: 0.0,
            spin_centre: [0.0; 2],
            rolling_distance: 0.0,
            rolling_direction: 0.0,
            spin_offset: 1.0 / 6.0,
            previous: Previous::None,
            rigid_slip: None,
            influence: None,
            sensitivities: false,
        }
    }

    /// The length rolled in a step; of a shift 1, so that creepages are lengths.
    pub fn distance(&self, grid: &Grid) -> f64 {
        match self.motion {
            Motion::Shift => 1.0,
            _ if self.rolling_distance == 0.0 => grid.dx,
            _ => self.rolling_distance,
        }
    }

    /// How many elements a step of rolling goes in x and in y. Of whole numbers round-off is removed: coefficients are simpler there.
    pub fn elements_rolled(&self, grid: &Grid) -> (f64, f64) {
        let (distance, (sine, cosine)) = (self.distance(grid), self.rolling_direction.sin_cos());
        let clean = |value: f64| {
            if (value - value.round()).abs() <= ROUND_OFF * distance / grid.dx.min(grid.dy) {
                value.round()
            } else {
                value
            }
        };
        (clean(distance * cosine / grid.dx), clean(distance * sine / grid.dy))
    }

    /// The rigid slip of the step at element i; without creepages that are to be found.
    pub fn rigid_slip_at(&self, grid: &Grid, i: usize) -> [f64; 2] {
        let distance = self.distance(grid);
        let centre =
            |k: usize, m: usize, d: f64, spin_centre: f64| (k as f64 - 0.5 * (m as f64 - 1.0)) * d - spin_centre;
        let mut x = centre(i % grid.mx, grid.mx, grid.dx, self.spin_centre[0]);
        let mut y = centre(i / grid.mx, grid.my, grid.dy, self.spin_centre[1]);
        if self.motion != Motion::Shift {
            let ahead = self.spin_offset * distance;
            x += ahead * self.rolling_direction.cos();
            y += ahead * self.rolling_direction.sin();
        }
        let creepage = self.prescribed.map(|prescribed| match prescribed {
            Prescribed::Creepage(creepage) => creepage,
            Prescribed::Force(_) => 0.0,
        });
        let own = self.rigid_slip.map_or([0.0; 2], |own| [own[0][i], own[1][i]]);
        [distance * (creepage[0] - self.spin * y) + own[0], distance * (creepage[1] + self.spin * x) + own[1]]
    }

    /// How the rigid slip at element i changes with xi (0), eta (1) or phi (2).
    pub fn rigid_slip_by(&self, grid: &Grid, i: usize, creepage: usize) -> [f64; 2] {
        let mut unit = Friction { prescribed: [Prescribed::Creepage(0.0); 2], spin: 0.0, rigid_slip: None, ..*self };
        match creepage {
            2 => unit.spin = 1.0,
            k => unit.prescribed[k] = Prescribed::Creepage(1.0),
        }
        unit.rigid_slip_at(grid, i)
    }

    /// Refuses steps of steady rolling that elements do not resolve.
    fn check_step(&self, grid: &Grid) -> Result<()> {
        if self.motion != Motion::SteadyRolling {
            return Ok(());
        }
        let (x, y) = self.elements_rolled(grid);
        let longest = x.abs().max(y.abs());
        let rule =
            "a step of steady rolling must be at least a tenth of an element long, and at most a million elements";
        require(STEPS.contains(&longest), "friction->rolling_distance", self.distance(grid), rule)
    }

    /// Refuses tables that do not suit the grid and the step: between whole offsets they say nothing.
    fn check_influence(&self, grid: &Grid) -> Result<()> {
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

    /// Refuses lengths, slips and tractions whose squares leave the range of double precision.
    fn check_range(&self, grid: &Grid) -> Result<()> {
        let rule = "friction needs numbers below 1e140: choose other units";
        let small = |name: &str, value: f64| require(value.abs() < LARGEST, name, value, rule);
        // Slips by creepages and spin are largest in a corner.
        let corners = [0, grid.mx - 1, grid.len() - grid.mx, grid.len() - 1];
        for slip in corners.iter().flat_map(|&i| Friction { rigid_slip: None, ..*self }.rigid_slip_at(grid, i)) {
            small("the rigid slip by friction->creepage and spin", slip)?;
        }
        for own in self.rigid_slip.iter().flatten() {
            check_values("friction->rigid_slip", own, grid, small)?;
        }
        match (self.previous, self.motion) {
            // There they are only where the iteration starts.
            (_, Motion::SteadyRolling) => Ok(()),
            (Previous::Given(before), _) => {
                before.iter().try_for_each(|q| check_values("friction->previous_traction", q, grid, small))
            }
            _ => Ok(()),
        }
    }

    /// Refuses numbers that are none.
    fn check_numbers(&self) -> Result<()> {
        let finite = |name: &str, value: f64| require(value.is_finite(), name, value, "it must be finite");
        for (k, prescribed) in self.prescribed.iter().enumerate() {
            match prescribed {
                Prescribed::Creepage(creepage) => {
                    finite(["friction->creepage[0]", "friction->creepage[1]"][k], *creepage)?
                }
                Prescribed::Force(force) => finite(["friction->force[0]", "friction->force[1]"][k], *force)?,
            }
        }
        finite("friction->spin", self.spin)?;
        finite("friction->spin_centre[0]", self.spin_centre[0])?;
        finite("friction->spin_centre[1]", self.spin_centre[1])?;
        finite("friction->spin_offset", self.spin_offset)?;
        let (distance, direction) = (self.rolling_distance, self.rolling_direction);
        require(
            distance >= 0.0 && distance.is_finite(),
            "friction->rolling_distance",
            distance,
            "it must be positive and finite, or 0 for dx",
        )?;
        let turns = "an angle must lie in [-2 pi, 2 pi]";
        require(direction.abs() <= 2.0 * PI, "friction->rolling_direction", direction, turns)
    }
}

impl Effect for Friction<'_> {
    fn name(&self) -> &'static str {
        "friction"
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        self.check_numbers()?;
        let coefficient = |name: &str, mu: f64| match mu {
            mu if !mu.is_finite() => Err(Error::NotFinite(format!("{name} is {mu}; it must be finite"))),
            mu if mu >= LARGEST => invalid(format!("{name} is {mu}; it must be below {LARGEST:e}")),
            mu if mu < 0.0 => invalid(format!("{name} is {mu}; a coefficient of friction must not be negative")),
            _ => Ok(()),
        };
        match self.coefficient {
            Coefficient::Uniform(mu) => coefficient("friction->coefficient", mu)?,
            Coefficient::PerElement(mu) => check_values("friction->coefficients", mu, grid, coefficient)?,
        }
        self.check_step(grid)?;
        let finite = |name: &str, value: f64| match value.is_finite() {
            true => Ok(()),
            false => Err(Error::NotFinite(format!("{name} is {value}; it must be finite"))),
        };
        if let Previous::Given([x, y]) = self.previous {
            check_values("friction->previous_traction[0]", x, grid, finite)?;
            check_values("friction->previous_traction[1]", y, grid, finite)?;
        }
        if let Some([x, y]) = self.rigid_slip {
            check_values("friction->rigid_slip[0]", x, grid, finite)?;
            check_values("friction->rigid_slip[1]", y, grid, finite)?;
        }
        self.check_range(grid)?;
        self.check_influence(grid)
    }

    fn check_load(&self, scene: &Plain<'_>, others: &[Option<&dyn Effect>]) -> Result<()> {
        self.check(&scene.grid)?;
        let Bodies { shear_modulus: [g1, g2], poisson_ratio: [nu1, nu2] } = scene.bodies;
        let has_bodies = !others.iter().flatten().any(|other| other.replaces_bodies());
        let lacks_cross = self.influence.is_some_and(|influence| influence.cross.is_none());
        if lacks_cross && has_bodies && (1.0 - 2.0 * nu1) / g1 != (1.0 - 2.0 * nu2) / g2 {
            return Err(Error::Unsupported(
                "friction->influence has no coefficients of what couples the normal and the tangential problem of unlike bodies: \
                 influence_cross is not given"
                    .into(),
            ));
        }
        Ok(())
    }

    // Tangential coefficients of these are not known, unless they are given.
    fn excludes(&self) -> &'static [&'static str] {
        match self.influence {
            Some(_) => &["row_tables", "period", "patches", "coating"],
            None => &["influence", "row_tables", "period", "patches", "coating"],
        }
    }
}
