//! `contact_normal_scene`, and its translation to a [`Scene`].

use super::adhesion::contact_normal_adhesion;
use super::arguments::{self, add, Regions};
use super::coating::contact_normal_coating;
use super::effects::{
    contact_normal_layer, contact_normal_patches, contact_normal_period, contact_normal_pressure_limit,
};
use super::friction::contact_normal_friction;
use super::influence::{contact_normal_influence, contact_normal_row_tables};
use super::status::Refusal;
use super::structs::{self, versioned};
use super::visco::contact_normal_visco;
use crate::grid::Grid;
use crate::memory::copied;
use crate::scene::{Bodies, Coating, Load, Scene};

/// `load`: whichever of `approach` and `force` is set. It is refused if both are set, or none.
pub const CONTACT_NORMAL_PRESCRIBED_UNSET: i32 = 0;
/// `load`: the approach of the bodies is prescribed.
pub const CONTACT_NORMAL_PRESCRIBED_APPROACH: i32 = 1;
/// `load`: the normal force is prescribed, and the approach is computed.
pub const CONTACT_NORMAL_PRESCRIBED_FORCE: i32 = 2;

/// The scene to simulate: `e = h - approach + A p`, with e = 0 and p >= 0 in contact, e > 0 and p = 0 outside. Any consistent
/// system of units may be used.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_scene {
    /// Set by `contact_normal_scene_init`.
    pub struct_size: i64,
    /// Elements in x, >= 1; default 0: to be set.
    pub mx: i32,
    /// Elements in y, >= 1; default 0: to be set.
    pub my: i32,
    /// Element size in x, a positive length; default 0: to be set.
    pub dx: f64,
    /// Element size in y, a positive length; default 0: to be set.
    pub dy: f64,
    /// The undeformed distance h, the gap between the surfaces before they deform, `[my][mx]`, x fastest, a length. +infinity: there is no surface,
    /// and the element stays exterior. Default NULL: to be set.
    pub undeformed_distance: *const f64,
    /// The shear moduli G of both bodies, positive pressures; +infinity: rigid (one surface at most; both bodies if a coating covers one). Default 0:
    /// to be set.
    pub shear_modulus: [f64; 2],
    /// The Poisson ratios nu of both bodies, in (-1, 0.5]; default 0.
    pub poisson_ratio: [f64; 2],
    /// CONTACT_NORMAL_PRESCRIBED_APPROACH: only `approach` is read. _FORCE: only `force` is read. Default UNSET: the one that is set.
    pub load: i32,
    /// Always 0.
    pub reserved: i32,
    /// The prescribed approach (indentation, penetration), a length. Default NaN: not set.
    pub approach: f64,
    /// The prescribed force, the sum of p dx dy, >= 0; with active_set FIXED or with adhesion it may be negative. Default NaN: not set.
    pub force: f64,
    /// Effect, or NULL (default): influence coefficients of your own instead of the half-space's. The elastic constants are then not used.
    pub influence: *const contact_normal_influence,
    /// Effect, or NULL (default): a thin compliant layer between the bodies.
    pub layer: *const contact_normal_layer,
    /// Effect, or NULL (default): pressures do not exceed a limit.
    pub pressure_limit: *const contact_normal_pressure_limit,
    /// Effect, or NULL (default): the scene is periodic in x, in y or in both.
    pub period: *const contact_normal_period,
    /// Effect, or NULL (default): several contact patches, with factors on the influence of each patch on the others.
    pub patches: *const contact_normal_patches,
    /// Effect, or NULL (default): influence coefficients of your own, one table per loaded row. The elastic constants are then not used.
    pub row_tables: *const contact_normal_row_tables,
    /// Effect, or NULL (default): a coating on body 1 (`coating[0]`) and on body 2 (`coating[1]`). The elastic constants of the scene are then those
    /// of the body below the coating.
    pub coating: [*const contact_normal_coating; 2],
    /// Effect, or NULL (default): friction between the bodies.
    pub friction: *const contact_normal_friction,
    /// Effect, or NULL (default): attraction between the bodies.
    pub adhesion: *const contact_normal_adhesion,
    /// Effect, or NULL (default): viscoelastic bodies, and a step in time.
    pub visco: *const contact_normal_visco,
}

versioned! { contact_normal_scene, contact_normal_scene_init, 168, approach: f64::NAN, force: f64::NAN }

/// The load that the constant `load` selects of `approach` and `force`. Refuses UNSET.
pub(super) fn load_of(load: i32, approach: f64, force: f64) -> Result<Load, Refusal> {
    match load {
        CONTACT_NORMAL_PRESCRIBED_APPROACH => Ok(Load::Approach(approach)),
        CONTACT_NORMAL_PRESCRIBED_FORCE => Ok(Load::Force(force)),
        other => arguments::unknown("load", other, "PRESCRIBED_APPROACH (1) or PRESCRIBED_FORCE (2)"),
    }
}

/// The load of a scene: the one that `load` selects or, if `load` is UNSET, the one that is set.
fn load_of_scene(scene: &contact_normal_scene) -> Result<Load, Refusal> {
    let (approach, force) = (scene.approach, scene.force);
    if scene.load != CONTACT_NORMAL_PRESCRIBED_UNSET {
        return load_of(scene.load, approach, force);
    }
    match (approach.is_nan(), force.is_nan()) {
        (false, true) => Ok(Load::Approach(approach)),
        (true, false) => Ok(Load::Force(force)),
        (true, true) => Err(Refusal::invalid(
            "the scene has no load: set scene->approach or scene->force (both are NaN)".to_owned(),
        )),
        (false, false) => {
            let rule = "leave one of them NaN, or set scene->load to PRESCRIBED_APPROACH (1) or PRESCRIBED_FORCE (2)";
            Err(Refusal::invalid(format!("the scene has two loads, approach {approach} and force {force}: {rule}")))
        }
    }
}

/// Copies of the caller's structs of a scene: the scene itself, and the effects to which it points. The arrays are not read yet.
pub(super) struct Named {
    scene: contact_normal_scene,
    grid: Grid,
    influence: Option<contact_normal_influence>,
    layer: Option<contact_normal_layer>,
    pressure_limit: Option<contact_normal_pressure_limit>,
    period: Option<contact_normal_period>,
    patches: Option<contact_normal_patches>,
    row_tables: Option<contact_normal_row_tables>,
    coating: [Option<contact_normal_coating>; 2],
    friction: Option<contact_normal_friction>,
    adhesion: Option<contact_normal_adhesion>,
    visco: Option<contact_normal_visco>,
}

impl Named {
    /// Reads the structs of a scene.
    pub unsafe fn read(scene: *const contact_normal_scene) -> Result<Named, Refusal> {
        // SAFETY (all): NULL or structs that declare their size, by the conventions of the ABI.
        unsafe {
            let scene = structs::read(scene, "scene")?;
            let (mx, my) = (arguments::count("mx", scene.mx)?, arguments::count("my", scene.my)?);
            Ok(Named {
                grid: Grid::new(mx, my, scene.dx, scene.dy)?,
                influence: structs::read_optional(scene.influence, "scene->influence")?,
                layer: structs::read_optional(scene.layer, "scene->layer")?,
                pressure_limit: structs::read_optional(scene.pressure_limit, "scene->pressure_limit")?,
                period: structs::read_optional(scene.period, "scene->period")?,
                patches: structs::read_optional(scene.patches, "scene->patches")?,
                row_tables: structs::read_optional(scene.row_tables, "scene->row_tables")?,
                coating: [
                    structs::read_optional(scene.coating[0], "scene->coating[0]")?,
                    structs::read_optional(scene.coating[1], "scene->coating[1]")?,
                ],
                friction: structs::read_optional(scene.friction, "scene->friction")?,
                adhesion: structs::read_optional(scene.adhesion, "scene->adhesion")?,
                visco: structs::read_optional(scene.visco, "scene->visco")?,
                scene,
            })
        }
    }

    /// For a call that does not use the load: if no load is set, sets an approach of 0.
    pub fn load_or_none(mut self) -> Named {
        let scene = &mut self.scene;
        if scene.load == CONTACT_NORMAL_PRESCRIBED_UNSET && scene.approach.is_nan() && scene.force.is_nan() {
            scene.approach = 0.0;
        }
        self
    }

    /// The number of elements of the grid.
    pub fn len(&self) -> usize {
        self.grid.len()
    }

    /// Adds the memory that a call reads of the scene at `address`.
    pub fn add_to(&self, regions: &mut Regions, address: *const contact_normal_scene) -> Result<(), Refusal> {
        regions.input("undeformed_distance", self.scene.undeformed_distance, self.grid.len())?;
        self.add_without_distance(regions, address)
    }

    /// As [`add_to`](Self::add_to), for a call that does not read the undeformed distance of the scene.
    pub fn add_without_distance(
        &self,
        regions: &mut Regions,
        address: *const contact_normal_scene,
    ) -> Result<(), Refusal> {
        let (scene, grid) = (&self.scene, &self.grid);
        regions.input_struct(address, scene)?;
        add(regions, grid, scene.influence, &self.influence)?;
        add(regions, grid, scene.layer, &self.layer)?;
        add(regions, grid, scene.pressure_limit, &self.pressure_limit)?;
        add(regions, grid, scene.period, &self.period)?;
        add(regions, grid, scene.patches, &self.patches)?;
        add(regions, grid, scene.row_tables, &self.row_tables)?;
        add(regions, grid, scene.coating[0], &self.coating[0])?;
        add(regions, grid, scene.coating[1], &self.coating[1])?;
        add(regions, grid, scene.friction, &self.friction)?;
        add(regions, grid, scene.adhesion, &self.adhesion)?;
        add(regions, grid, scene.visco, &self.visco)
    }

    /// A copy of the undeformed distance.
    pub unsafe fn copy_of_distance(&self) -> Result<Vec<f64>, Refusal> {
        // SAFETY: by the caller.
        Ok(copied(unsafe { self.distance()? }, "undeformed distances")?)
    }

    /// The caller's undeformed distance.
    unsafe fn distance<'a>(&self) -> Result<&'a [f64], Refusal> {
        let name = "scene->undeformed_distance";
        // SAFETY: NULL or one value per element, by the conventions of the ABI.
        unsafe { arguments::required(name, self.scene.undeformed_distance, self.grid.len()) }
    }

    /// Translates the scene. The core checks its values. The caller's arrays must live as long as the result is used.
    pub unsafe fn translate<'a>(&self) -> Result<Scene<'a>, Refusal> {
        // SAFETY: by the caller.
        unsafe { self.with_distance(self.distance()?) }
    }

    /// As [`translate`](Self::translate), with another undeformed distance.
    pub unsafe fn with_distance<'a>(&self, undeformed_distance: &'a [f64]) -> Result<Scene<'a>, Refusal> {
        let load = load_of_scene(&self.scene)?;
        // SAFETY: by the caller.
        unsafe { self.with_load(undeformed_distance, load) }
    }

    /// As [`translate`](Self::translate), for given pressures: neither the undeformed distance nor the load is read.
    pub unsafe fn without_load<'a>(&self) -> Result<Scene<'a>, Refusal> {
        // SAFETY: by the caller.
        unsafe { self.with_load(&[], Load::Approach(0.0)) }
    }

    /// Whether the undeformed distance is given.
    pub fn has_distance(&self) -> bool {
        !self.scene.undeformed_distance.is_null()
    }

    /// As [`translate`](Self::translate), with another undeformed distance and another load.
    unsafe fn with_load<'a>(&self, undeformed_distance: &'a [f64], load: Load) -> Result<Scene<'a>, Refusal> {
        let (scene, grid) = (&self.scene, &self.grid);
        arguments::reserved("scene->reserved", scene.reserved)?;
        let bodies = Bodies { shear_modulus: scene.shear_modulus, poisson_ratio: scene.poisson_ratio };
        // SAFETY (all): NULL or arrays of as many values as each says, by the conventions of the ABI.
        unsafe {
            Ok(Scene {
                influence: self.influence.map(|influence| influence.translate(grid)).transpose()?,
                layer: self.layer.map(|layer| layer.translate(grid)),
                pressure_limit: self.pressure_limit.map(|limit| limit.translate(grid)),
                period: self.period.map(|period| period.translate()).transpose()?,
                patches: self.patches.map(|patches| patches.translate(grid)).transpose()?,
                row_tables: self.row_tables.map(|tables| tables.translate(grid)).transpose()?,
                coating: self.coating.iter().any(Option::is_some).then(|| Coating {
                    layers: self.coating.map(|coating| coating.map(|coating| coating.translate())),
                }),
                friction: self.friction.map(|friction| friction.translate(grid)).transpose()?,
                adhesion: self.adhesion.map(|adhesion| adhesion.translate(grid)).transpose()?,
                visco: self.visco.map(|visco| visco.translate()).transpose()?,
                ..Scene::new(*grid, undeformed_distance, bodies, load)
            })
        }
    }
}
