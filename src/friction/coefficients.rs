//! Influence coefficients of tangential tractions, from one of three sources: two half-spaces (`HalfSpace`), two half-spaces with the same coating
//! ([`Coat`]), or the caller's tables. A layer between the bodies adds to the coefficient of an element on itself.
//!
//! Offsets are in elements. They need not be whole, because rolling needs displacements between centres.

use std::f64::consts::PI;
use std::sync::Arc;

pub use super::compliance::Compliance;
use super::half_space::HalfSpace;
use super::plane::Vector;
use super::row_tables::RowTables;
use super::series::Shape;
pub use super::tables::Entry;
use super::tables::Tables;
use super::unit::unit_of;
use crate::effects::TangentialInfluence;
use crate::error::{invalid, Result};
use crate::grid::Grid;
use crate::influence::{Base, Coat};

/// The tangential influence coefficients of elements of one size.
#[derive(Clone, Debug)]
pub struct Tangential {
    /// The coefficients of half-spaces. With a coating they have the material of the coating.
    half_space: HalfSpace,
    /// The coating of both bodies, and the coefficients of half-spaces of the substrates' material.
    coat: Option<(Coat, HalfSpace)>,
    /// The caller's tables, in place of half-spaces and coating.
    tables: Option<Tables>,
    /// The caller's tables per loaded row. Then `tables` are their means over rows.
    rows: Option<RowTables>,
    /// The compliance of a layer between the bodies, which adds to the coefficient of an element on itself.
    layer: f64,
}

impl Tangential {
    /// The coefficients of half-spaces, for elements `dx` by `dy`.
    pub fn new(dx: f64, dy: f64, compliance: Compliance) -> Tangential {
        Tangential::of_shape(dx, dy, compliance, Arc::new(Shape::new(dx, dy)))
    }

    fn of_shape(dx: f64, dy: f64, compliance: Compliance, shape: Arc<Shape>) -> Tangential {
        let half_space = HalfSpace::new(dx, dy, compliance, shape);
        Tangential { half_space, coat: None, tables: None, rows: None, layer: 0.0 }
    }

    /// The coefficients of two bodies with the same coating. `surface` is the material of the coating, `below` that of the substrates.
    pub fn of_coated(dx: f64, dy: f64, surface: Compliance, (coat, below): (Coat, Compliance)) -> Tangential {
        let plain = Tangential::new(dx, dy, surface);
        let below = HalfSpace::new(dx, dy, below, plain.half_space.shape.clone());
        Tangential { coat: Some((coat, below)), ..plain }
    }

    /// The caller's coefficients, for elements `dx` by `dy`.
    pub fn of_tables(dx: f64, dy: f64, influence: &TangentialInfluence<'_>) -> Result<Tangential> {
        let no_bodies = Compliance { shear: 1.0, poisson: 0.0, unlike: 0.0 };
        let rows = if influence.by_row { Some(RowTables::new(influence)?) } else { None };
        let tables = match &rows {
            Some(rows) => rows.mean()?,
            None => Tables::new(influence)?,
        };
        Ok(Tangential { tables: Some(tables), rows, ..Tangential::new(dx, dy, no_bodies) })
    }

    /// The coefficients for a box of `rows` rows from the row `first` on. Tables per loaded row depend on these rows.
    pub fn of_run(&self, first: usize, rows: usize) -> Tangential {
        Tangential { rows: self.rows.as_ref().map(|all| all.of_run(first, rows)), ..self.clone() }
    }

    /// The tables per loaded row.
    pub fn rows(&self) -> Option<&RowTables> {
        self.rows.as_ref()
    }

    /// The same coefficients with a layer of this compliance between the bodies.
    pub fn with_layer(&self, layer: f64) -> Tangential {
        Tangential { layer, ..self.clone() }
    }

    /// The compliance of the layer.
    pub fn layer(&self) -> f64 {
        self.layer
    }

    /// Whether these are the caller's tables.
    pub fn is_own(&self) -> bool {
        self.tables.is_some()
    }

    /// Refuses tables of the caller that are too small for the offsets between the elements of a box and for a step of rolling of `by` elements.
    pub fn check_reach(&self, window: &Grid, by: (f64, f64)) -> Result<()> {
        let Some((cx, cy)) = self.tables.as_ref().map(Tables::reach) else { return Ok(()) };
        for (name, c, m, by) in [("cx", cx, window.mx, by.0), ("cy", cy, window.my, by.1)] {
            let needed = (m as f64 + by.abs()).round();
            if needed > c as f64 {
                let rule = format!("the contact area and a step of rolling ask for {needed}");
                let tables = if self.rows.is_some() { "row_tables" } else { "influence" };
                return invalid(format!("friction->{tables}->{name} is {c}; {rule}"));
            }
        }
        Ok(())
    }

    /// The coefficients for another element size. The caller's tables are coarsened in the directions in which elements are larger.
    pub fn for_element(&self, dx: f64, dy: f64) -> Result<Tangential> {
        let present = &self.half_space;
        let same_shape = dx / present.dx == dy / present.dy;
        let shape = if same_shape { present.shape.clone() } else { Arc::new(Shape::new(dx, dy)) };
        let (in_x, in_y) = (dx > present.dx, dy > present.dy);
        let rows = self.rows.as_ref().map(|rows| rows.coarsened(in_x, in_y)).transpose()?;
        let tables = match (&rows, &self.tables) {
            (Some(rows), _) => Some(rows.mean()?),
            (None, tables) => tables.as_ref().map(|tables| tables.coarsened(in_x, in_y)).transpose()?,
        };
        let resized = |below: &HalfSpace| HalfSpace::new(dx, dy, below.compliance, shape.clone());
        let coat = self.coat.as_ref().map(|(coat, below)| (coat.clone(), resized(below)));
        let plain = Tangential::of_shape(dx, dy, present.compliance, shape);
        Ok(Tangential { tables, rows, coat, layer: self.layer, ..plain })
    }

    /// The coefficients with lengths in units of `length` and displacements in a unit in which coefficients are of order 1. Returns this unit, too.
    pub fn in_units_of(&self, length: f64) -> (Tangential, f64) {
        let HalfSpace { dx, dy, compliance, .. } = self.half_space;
        let (unit_compliance, unit) = match &self.tables {
            Some(tables) => (1.0, unit_of(tables.at(0, 0)[0])),
            None => (unit_of(compliance.shear), length * unit_of(compliance.shear)),
        };
        let scaled = |of: Compliance| Compliance {
            shear: of.shear / unit_compliance,
            poisson: of.poisson / unit_compliance,
            unlike: of.unlike / unit_compliance,
        };
        let shape = &self.half_space.shape;
        let (dx, dy) = (dx / length, dy / length);
        let coat = self.coat.as_ref().map(|(coat, below)| {
            (coat.in_units_of(length), HalfSpace::new(dx, dy, scaled(below.compliance), shape.clone()))
        });
        let tables = self.tables.as_ref().map(|tables| tables.in_units_of(unit));
        let rows = self.rows.as_ref().map(|rows| rows.in_units_of(unit));
        let plain = Tangential::of_shape(dx, dy, scaled(compliance), shape.clone());
        (Tangential { tables, rows, coat, layer: self.layer / unit, ..plain }, unit)
    }

    /// The combined elastic constants of the half-spaces, or of the coatings.
    pub fn compliance(&self) -> Compliance {
        self.half_space.compliance
    }

    /// Whether the bodies are coated.
    pub fn is_coated(&self) -> bool {
        self.coat.is_some()
    }

    /// Whether Axy is 0 at all offsets, as for half-spaces with a Poisson ratio of 0. Not to be called for the caller's tables.
    pub fn is_uncoupled(&self) -> bool {
        self.half_space.compliance.poisson == 0.0 && self.coat.is_none()
    }

    /// The ratio of these coefficients to others at the same offsets in elements, if it is the same at all offsets.
    pub fn times(&self, other: &Tangential) -> Option<f64> {
        let is_plain = |of: &Tangential| of.layer == 0.0 && of.tables.is_none() && of.coat.is_none();
        let (one, two) = (&self.half_space, &other.half_space);
        let is_multiple = [self, other].into_iter().all(is_plain)
            && one.compliance == two.compliance
            && Arc::ptr_eq(&one.shape, &two.shape);
        is_multiple.then_some(one.dx / two.dx)
    }

    /// If the coating is a membrane: the function that returns the responses xx, yy and xy to a wave of tractions, by its wave vector in radians per
    /// element. The influence coefficients of a membrane may decay over lengths beyond the grid.
    pub fn of_waves(&self) -> Option<impl Fn(Vector) -> Entry + Sync + Send + '_> {
        let (coat, _) = self.coat.as_ref().filter(|(coat, _)| coat.is_membrane())?;
        let HalfSpace { dx, dy, compliance, .. } = self.half_space;
        Some(move |[x, y]: Vector| {
            let (x, y) = (x / dx, y / dy);
            let k = x.hypot(y);
            // The displacements by tractions along the wave vector and across it.
            let [along, across] = coat.of_wave(k).map(|of_wave| 2.0 * compliance.shear * of_wave / k);
            let (cos, sin) = (x / k, y / k);
            let rotated = |a: f64, b: f64| along * a * a + across * b * b + self.layer;
            [rotated(cos, sin), rotated(sin, cos), (along - across) * cos * sin]
        })
    }

    /// The coefficients at an offset in elements. The caller's tables are read at the nearest whole offset.
    pub fn at(&self, x: f64, y: f64) -> Entry {
        let [xx, yy, xy] = self.of_bodies(x, y);
        // The layer displaces by the traction there, which is interpolated linearly between the centres.
        let layer = self.layer * (1.0 - x.abs()).max(0.0) * (1.0 - y.abs()).max(0.0);
        [xx + layer, yy + layer, xy]
    }

    /// The caller's tables, if they are uneven in x, which serves steady rolling only.
    pub fn uneven(&self) -> Option<&Tables> {
        self.tables.as_ref().filter(|tables| tables.is_uneven())
    }

    /// The coefficients without the layer.
    fn of_bodies(&self, x: f64, y: f64) -> Entry {
        if let Some(tables) = &self.tables {
            return tables.at(x.round() as i64, y.round() as i64);
        }
        let Some((coat, below)) = &self.coat else { return self.half_space.at(x, y) };
        let HalfSpace { dx, dy, compliance, .. } = self.half_space;
        let (base, change) = coat.at((x, y), (dx, dy));
        let plain = if base == Base::Layer { &self.half_space } else { below };
        let ([xx, yy, xy], [change_xx, change_yy, change_xy]) =
            (plain.at(x, y), change.map(|change| compliance.shear / PI * change));
        [xx + change_xx, yy + change_yy, xy + change_xy]
    }

    /// Writes the coefficients at the offsets `(0.., ky)`.
    pub fn fill_row(&self, ky: usize, out: &mut [Entry]) {
        if self.tables.is_some() || self.coat.is_some() {
            out.iter_mut().enumerate().for_each(|(kx, entry)| *entry = self.at(kx as f64, ky as f64));
            return;
        }
        self.half_space.fill_row(ky, out);
        if let (0, Some([xx, yy, _])) = (ky, out.first_mut()) {
            (*xx, *yy) = (*xx + self.layer, *yy + self.layer);
        }
    }
}
