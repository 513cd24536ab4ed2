//! A small scene with any effects, for the tests of dumps.

use std::ptr::{null, null_mut};

use contact_normal::ffi::*;

pub const MX: usize = 6;
pub const MY: usize = 5;
const N: usize = MX * MY;
/// Tables have more offsets than the grid.
const CX: usize = 8;
const CY: usize = 7;

/// The structs and arrays of a call. The structs are boxed, because they point to each other.
pub struct Everything {
    pub scene: contact_normal_scene,
    pub options: contact_normal_options,
    pub friction: Box<contact_normal_friction>,
    pub h: Box<[f64]>,
    /// Whether a solve gets arrays for pressures and contact area.
    pub with_outputs: bool,
    _structs: Box<Structs>,
    _arrays: Vec<Box<[f64]>>,
    _patch: Box<[i32]>,
}

#[derive(Default)]
struct Structs {
    influence: contact_normal_influence,
    tangential: [contact_normal_influence; 5],
    layer: contact_normal_layer,
    limit: contact_normal_pressure_limit,
    period: contact_normal_period,
    patches: contact_normal_patches,
    row_tables: contact_normal_row_tables,
    tangential_rows: [contact_normal_row_tables; 3],
    coating: [contact_normal_coating; 2],
    cycle: contact_normal_cycle,
    adhesion: contact_normal_adhesion,
    visco: contact_normal_visco,
}

/// Coefficients of the half-space, `[2 CY][2 CX]`.
fn half_space() -> Vec<f64> {
    let mut table = vec![0.0; 4 * CX * CY];
    let (g, nu) = ([82000.0; 2], [0.28; 2]);
    // SAFETY: room for 2 cy by 2 cx values.
    let status = unsafe {
        contact_normal_influence_half_space(
            CX as i32,
            CY as i32,
            0.5,
            0.25,
            g.as_ptr(),
            nu.as_ptr(),
            table.as_mut_ptr(),
        )
    };
    assert_eq!(status, CONTACT_NORMAL_OK);
    table
}

impl Everything {
    /// A scene with some effects. `effects`: names of effects as in the scene, and "tables" or "tangential_rows" for the caller's tables of friction.
    pub fn new(effects: &str) -> Everything {
        let names = |name: &str| effects.split(' ').any(|named| named == name);
        let h: Box<[f64]> =
            (0..N).map(|i| 0.01 * ((i % MX) as f64 - 2.5).powi(2) + 0.02 * ((i / MX) as f64 - 2.0).powi(2)).collect();
        let mut arrays: Vec<Box<[f64]>> = Vec::new();
        let mut array = |values: Vec<f64>| {
            arrays.push(values.into());
            arrays.last().map_or(null(), |values| values.as_ptr())
        };
        let mut each = |from: f64| array((0..N).map(|i| from * (1.0 + 0.1 * i as f64)).collect());
        let mut s = Box::<Structs>::default();
        (s.layer.compliances, s.limit.limits) = (each(1e-7), each(1000.0));
        (s.adhesion.works_of_adhesion, s.adhesion.range) = (each(1e-3), 0.01);
        (s.visco.branches, s.visco.time_step) = ([2, 3], 0.4);
        (s.visco.modulus, s.visco.time) = ([each(2e4), each(1e4)], [each(0.1), each(1.0)]);
        let mut friction = Box::<contact_normal_friction>::default();
        (friction.coefficients, friction.creepage) = (each(0.01), [0.001, 0.0005]);
        friction.previous_traction = [each(0.1), each(0.05)];
        friction.rigid_slip = [each(1e-6), each(2e-6)];
        friction.initial_traction = [each(0.2), each(0.1)];
        friction.compliances = each(1e-9);
        (friction.previous_coefficient, friction.previous_yield_limit) = (each(0.01), each(50.0));
        friction.creepage_weight = [each(0.1), each(0.09)];
        let table = half_space();
        let rows: Vec<f64> =
            (0..MY * MY).flat_map(|k| table[(CY + k % MY - k / MY) * 2 * CX..][..2 * CX].to_vec()).collect();
        let none = vec![0.0; rows.len()];
        for (to, values) in s.tangential_rows.iter_mut().zip([&rows, &rows, &none]) {
            (to.cx, to.rows, to.coefficients) = (CX as i32, MY as i32, array(values.clone()));
        }
        s.row_tables = s.tangential_rows[0];
        let zeros = vec![0.0; table.len()];
        let tables = [&table, &table, &zeros, &zeros, &zeros].map(|table| array(table.clone()));
        for (to, coefficients) in s.tangential.iter_mut().zip(tables) {
            *to = contact_normal_influence { cx: CX as i32, cy: CY as i32, coefficients, ..Default::default() };
        }
        s.influence = s.tangential[0];
        (s.period.x, s.period.y) = (1, 0);
        let patch: Box<[i32]> = (0..N).map(|i| (2 * (i % MX) / MX) as i32).collect();
        (s.patches.count, s.patches.patch, s.patches.factors) = (2, patch.as_ptr(), array(vec![1.0, 0.5, 0.5, 1.0]));
        for coating in &mut s.coating {
            (coating.thickness, coating.shear_modulus, coating.poisson_ratio) = (0.3, 40000.0, 0.3);
        }
        if names("tables") {
            friction.influence = [&raw const s.tangential[0], &raw const s.tangential[1], &raw const s.tangential[2]];
            friction.influence_cross = [&raw const s.tangential[3], &raw const s.tangential[4]];
        }
        if names("tangential_rows") {
            friction.row_tables = [0, 1, 2].map(|k: usize| &raw const s.tangential_rows[k]);
        }
        let mut scene = contact_normal_scene { mx: MX as i32, my: MY as i32, dx: 0.5, dy: 0.25, ..Default::default() };
        scene.undeformed_distance = h.as_ptr();
        (scene.shear_modulus, scene.poisson_ratio, scene.approach) = ([82000.0; 2], [0.28; 2], 0.03);
        // The pointer is NULL for an effect that is not in the list.
        fn of<T>(is_named: bool, effect: &T) -> *const T {
            if is_named {
                effect
            } else {
                null()
            }
        }
        scene.influence = of(names("influence"), &s.influence);
        scene.layer = of(names("layer"), &s.layer);
        scene.pressure_limit = of(names("pressure_limit"), &s.limit);
        scene.period = of(names("period"), &s.period);
        scene.patches = of(names("patches"), &s.patches);
        scene.row_tables = of(names("row_tables"), &s.row_tables);
        scene.coating = [of(names("coating"), &s.coating[0]), of(names("coating"), &s.coating[1])];
        scene.friction = of(names("friction"), &friction);
        scene.adhesion = of(names("adhesion"), &s.adhesion);
        scene.visco = of(names("visco"), &s.visco);
        let options = contact_normal_options { cycle: &s.cycle, ..Default::default() };
        Everything { scene, options, friction, h, with_outputs: false, _structs: s, _arrays: arrays, _patch: patch }
    }

    /// Solves, and returns the status and the report.
    pub fn solve(&self) -> (i32, contact_normal_report) {
        let mut report = contact_normal_report::default();
        let mut pressure: Vec<f64> = (0..N).map(|i| 100.0 * i as f64).collect();
        let mut contact: Vec<i32> = (0..N).map(|i| i32::from((8..23).contains(&i))).collect();
        let mut fields = contact_normal_fields::default();
        (fields.pressure, fields.contact) = (pressure.as_mut_ptr(), contact.as_mut_ptr());
        let fields = if self.with_outputs { &raw mut fields } else { null_mut() };
        // SAFETY: structs with the arrays that they declare.
        let status = unsafe { contact_normal_solve(&self.scene, &self.options, fields, &mut report) };
        (status, report)
    }
}
