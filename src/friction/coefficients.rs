//! Influence coefficients of tangential tractions: those of both bodies as half-spaces (`HalfSpace`), with the changes by a common coating
//! ([`Coat`]), or the caller's tables; and a layer between the bodies.
//!
//! Offsets are in elements and need not be whole: rolling needs displacements between centres.

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

/// Tangential coefficients for one element size.
#[derive(Clone, Debug)]
pub struct Tangential {
    half_space: HalfSpace,
    /// The common coating of both bodies, and the half-space of the substrates. `half_space` then has the coating's
    /// material.
    coat: Option<(Coat, HalfSpace)>,
    /// The caller's tables, in place of these.
    own: Option<Tables>,
    /// Tables per loaded row. The coefficients are their means over rows.
    rows: Option<RowTables>,
    /// The compliance of a layer between the bodies, which adds to the coefficient of an element on itself.
    layer: f64,
}

impl Tangential {
    /// Coefficients of elements `dx` by `dy`.
    pub fn new(dx: f64, dy: f64, compliance: Compliance) -> Tangential {
        Tangential::of_shape(dx, dy, compliance, Arc::new(Shape::new(dx, dy)))
    }

    fn of_shape(dx: f64, dy: f64, compliance: Compliance, shape: Arc<Shape>) -> Tangential {
        let half_space = HalfSpace::new(dx, dy, compliance, shape);
        Tangential { half_space, coat: None, own: None, rows: None, layer: 0.0 }
    }

    /// Coefficients of bodies with a common coating of the material `surface`, and the substrates below.
    pub fn of_coated(dx: f64, dy: f64, surface: Compliance, (coat, below): (Coat, Compliance)) -> Tangential {
        let plain = Tangential::new(dx, dy, surface);
        let below = HalfSpace::new(dx, dy, below, plain.half_space.shape.clone());
        Tangential { coat: Some((coat, below)), ..plain }
    }

    /// The caller's own coefficients, for elements `dx` by `dy`.
    pub fn of_tables(dx: f64, dy: f64, influence: &TangentialInfluence<'_>) -> Result<Tangential> {
        let no_bodies = Compliance { shear: 1.0, poisson: 0.0, unlike: 0.0 };
        let rows = if influence.by_row { Some(RowTables::new(influence)?) } else { None };
        let own = match &rows {
            Some(rows) => rows.mean()?,
            None => Tables::new(influence)?,
        };
        Ok(Tangential { own: Some(own), rows, ..Tangential::new(dx, dy, no_bodies) })
    }

    /// The coefficients for a range of rows of the grid, on which tables per loaded row depend.
    pub fn of_run(&self, first: usize, rows: usize) -> Tangential {
        Tangential { rows: self.rows.as_ref().map(|all| all.of_run(first, rows)), ..self.clone() }
    }

    /// The tables per loaded row.
    pub fn rows(&self) -> Option<&RowTables> {
        self.rows.as_ref()
    }

    /// The coefficients with a layer of this compliance between the bodies.
    pub fn with_layer(&self, layer: f64) -> Tangential {
        Tangential { layer, ..self.clone() }
    }

    /// The compliance of the layer.
    pub fn layer(&self) -> f64 {
        self.layer
    }

    /// Whether these are the caller's tables.
    pub fn is_own(&self) -> bool {
        self.own.is_some()
    }

    /// Refuses own tables that do not reach the offsets between the elements of a box, and a step of rolling `by` elements.
    pub fn check_reach(&self, window: &Grid, by: (f64, f64)) -> Result<()> {
        let Some((cx, cy)) = self.own.as_ref().map(Tables::reach) else { return Ok(()) };
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

    /// The coefficients for another element size; own tables are coarsened for larger elements.
    pub fn for_element(&self, dx: f64, dy: f64) -> Result<Tangential> {
        let of = &self.half_space;
        let same_shape = dx / of.dx == dy / of.dy;
        let shape = if same_shape { of.shape.clone() } else { Arc::new(Shape::new(dx, dy)) };
        let (in_x, in_y) = (dx > of.dx, dy > of.dy);
        let rows = self.rows.as_ref().map(|rows| rows.coarsened(in_x, in_y)).transpose()?;
        let own = match (&rows, &self.own) {
            (Some(rows), _) => Some(rows.mean()?),
            (None, own) => own.as_ref().map(|own| own.coarsened(in_x, in_y)).transpose()?,
        };
        let below = |below: &HalfSpace| HalfSpace::new(dx, dy, below.compliance, shape.clone());
        let coat = self.coat.as_ref().map(|(coat, of)| (coat.clone(), below(of)));
        Ok(Tangential { own, rows, coat, layer: self.layer, ..Tangential::of_shape(dx, dy, of.compliance, shape) })
    }

    /// The coefficients with lengths in units of `length`, and the unit of displacements in which they are of order 1.
    pub fn in_units_of(&self, length: f64) -> (Tangential, f64) {
        let HalfSpace { dx, dy, compliance, .. } = self.half_space;
        let (stiff, unit) = match &self.own {
            Some(own) => (1.0, unit_of(own.at(0, 0)[0])),
            None => (unit_of(compliance.shear), length * unit_of(compliance.shear)),
        };
        let scaled = |of: Compliance| Compliance {
            shear: of.shear / stiff,
            poisson: of.poisson / stiff,
            unlike: of.unlike / stiff,
        };
        let shape = &self.half_space.shape;
        let (dx, dy) = (dx / length, dy / length);
        let coat = self.coat.as_ref().map(|(coat, below)| {
            (coat.in_units_of(length), HalfSpace::new(dx, dy, scaled(below.compliance), shape.clone()))
        });
        let own = self.own.as_ref().map(|own| own.in_units_of(unit));
        let rows = self.rows.as_ref().map(|rows| rows.in_units_of(unit));
        let plain = Tangential::of_shape(dx, dy, scaled(compliance), shape.clone());
        (Tangential { own, rows, coat, layer: self.layer / unit, ..plain }, unit)
    }

    /// The elastic constants of both bodies together.
    pub fn compliance(&self) -> Compliance {
        self.half_space.compliance
    }

    /// Whether the bodies are coated.
    pub fn is_coated(&self) -> bool {
        self.coat.is_some()
    }

    /// Whether Axy is 0, as for half-spaces with a Poisson ratio of 0.
    pub fn is_uncoupled(&self) -> bool {
        self.half_space.compliance.poisson == 0.0 && self.coat.is_none()
    }

    /// The factor of these coefficients over others, if they are a multiple.
    pub fn times(&self, other: &Tangential) -> Option<f64> {
        let is_plain = |of: &Tangential| of.layer == 0.0 && of.own.is_none() && of.coat.is_none();
        let (one, two) = (&self.half_space, &other.half_space);
        let is_multiple = [self, other].into_iter().all(is_plain)
            && one.compliance == two.compliance
            && Arc::ptr_eq(&one.shape, &two.shape);
        is_multiple.then_some(one.dx / two.dx)
    }

    /// The responses to traction waves, by the wave vector, if a coating is a membrane: its coefficients may decay over lengths beyond the grid.
    pub fn of_waves(&self) -> Option<impl Fn(Vector) -> Entry + Sync + Send + '_> {
        let (coat, _) = self.coat.as_ref().filter(|(coat, _)| coat.is_membrane())?;
        let HalfSpace { dx, dy, compliance, .. } = self.half_space;
        Some(move |[x, y]: Vector| {
            let (x, y) = (x / dx, y / dy);
            let k = x.hypot(y);
            let [along, across] = coat.of_wave(k).map(|of_wave| 2.0 * compliance.shear * of_wave / k);
            let (cos, sin) = (x / k, y / k);
            let mixed = |a: f64, b: f64| along * a * a + across * b * b + self.layer;
            [mixed(cos, sin), mixed(sin, cos), (along - across) * cos * sin]
        })
    }

    /// The coefficients at an offset in elements; for own tables at the nearest whole one.
    pub fn at(&self, x: f64, y: f64) -> Entry {
        let [xx, yy, xy] = self.of_bodies(x, y);
        // Between the centres tractions are interpolated.
        let layer = self.layer * (1.0 - x.abs()).max(0.0) * (1.0 - y.abs()).max(0.0);
        [xx + layer, yy + layer, xy]
    }

    /// Own tables that are uneven in x, for steady rolling.
    pub fn uneven(&self) -> Option<&Tables> {
        self.own.as_ref().filter(|own| own.is_uneven())
    }

    /// The coefficients without the layer.
    fn of_bodies(&self, x: f64, y: f64) -> Entry {
        if let Some(own) = &self.own {
            return own.at(x.round() as i64, y.round() as i64);
        }
        let Some((coat, below)) = &self.coat else { return self.half_space.at(x, y) };
        let HalfSpace { dx, dy, compliance, .. } = self.half_space;
        let (base, change) = coat.at((x, y), (dx, dy));
        let plain = if base == Base::Layer { &self.half_space } else { below };
        let ([xx, yy, xy], [more_xx, more_yy, more_xy]) =
            (plain.at(x, y), change.map(|change| compliance.shear / PI * change));
        [xx + more_xx, yy + more_yy, xy + more_xy]
    }

    /// The coefficients at the offsets `(0.., ky)`.
    pub fn fill_row(&self, ky: usize, out: &mut [Entry]) {
        if self.own.is_some() || self.coat.is_some() {
            out.iter_mut().enumerate().for_each(|(kx, entry)| *entry = self.at(kx as f64, ky as f64));
            return;
        }
        self.half_space.fill_row(ky, out);
        if let (0, Some(own)) = (ky, out.first_mut()) {
            (own[0], own[1]) = (own[0] + self.layer, own[1] + self.layer);
        }
    }
}
