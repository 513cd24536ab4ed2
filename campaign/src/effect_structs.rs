//! The structs of the C ABI that describe the effects of a case.

use std::ptr::null;

use contact_normal::ffi::*;

use crate::effects::{Effects, Values};
use crate::init::initialised;

/// One struct of the C ABI for each effect. The structs of effects that the scene does not have stay at their defaults.
pub struct EffectStructs {
    influence: contact_normal_influence,
    layer: contact_normal_layer,
    limit: contact_normal_pressure_limit,
    pub period: contact_normal_period,
    patches: contact_normal_patches,
    row_tables: contact_normal_row_tables,
    coating: [contact_normal_coating; 2],
}

/// A pointer to a struct if the scene has this effect, otherwise NULL.
fn pointer_if<T>(has_effect: bool, to: &T) -> *const T {
    if has_effect {
        to
    } else {
        null()
    }
}

/// The structs for these effects. They point to the arrays of `effects`.
pub fn effect_structs(effects: &Effects) -> Box<EffectStructs> {
    let mut structs = Box::new(EffectStructs {
        influence: initialised(contact_normal_influence_init),
        layer: initialised(contact_normal_layer_init),
        limit: initialised(contact_normal_pressure_limit_init),
        period: initialised(contact_normal_period_init),
        patches: initialised(contact_normal_patches_init),
        row_tables: initialised(contact_normal_row_tables_init),
        coating: [initialised(contact_normal_coating_init); 2],
    });
    for (coating, layer) in structs.coating.iter_mut().zip(effects.coating.iter().flat_map(|coating| coating.layers)) {
        if let Some(layer) = layer {
            (coating.thickness, coating.shear_modulus) = (layer.thickness, layer.shear_modulus);
            coating.poisson_ratio = layer.poisson_ratio;
        }
    }
    if let Some(table) = &effects.influence {
        (structs.influence.cx, structs.influence.cy) = (table.cx as i32, table.cy as i32);
        structs.influence.coefficients = table.values.as_ptr();
    }
    if let Some(tables) = &effects.row_tables {
        (structs.row_tables.cx, structs.row_tables.rows) = (tables.cx as i32, tables.cy as i32);
        structs.row_tables.coefficients = tables.values.as_ptr();
    }
    match &effects.layer {
        Some(Values::Uniform(value)) => structs.layer.compliance = *value,
        Some(Values::PerElement(values)) => structs.layer.compliances = values.as_ptr(),
        None => {}
    }
    match &effects.limit {
        Some(Values::Uniform(value)) => structs.limit.limit = *value,
        Some(Values::PerElement(values)) => structs.limit.limits = values.as_ptr(),
        None => {}
    }
    if let Some((x, y)) = effects.period {
        (structs.period.x, structs.period.y) = (i32::from(x), i32::from(y));
    }
    if let Some(patches) = &effects.patches {
        structs.patches.count = patches.count as i32;
        (structs.patches.patch, structs.patches.factors) = (patches.patch.as_ptr(), patches.factors.as_ptr());
    }
    structs
}

impl EffectStructs {
    /// Points the scene to the structs of its effects. The pointers of all other effects are NULL.
    pub fn point_from(&self, scene: &mut contact_normal_scene, effects: &Effects) {
        scene.influence = pointer_if(effects.influence.is_some(), &self.influence);
        scene.layer = pointer_if(effects.layer.is_some(), &self.layer);
        scene.pressure_limit = pointer_if(effects.limit.is_some(), &self.limit);
        scene.period = pointer_if(effects.period.is_some(), &self.period);
        scene.patches = pointer_if(effects.patches.is_some(), &self.patches);
        scene.row_tables = pointer_if(effects.row_tables.is_some(), &self.row_tables);
        for (b, coating) in self.coating.iter().enumerate() {
            let is_coated = effects.coating.as_ref().is_some_and(|effect| effect.layers[b].is_some());
            scene.coating[b] = pointer_if(is_coated, coating);
        }
    }
}
