//! Calls of the library for scenes with adhesion, and their outputs.

use contact_normal::ffi::*;

use crate::adhesion_case::Case;
use crate::call::{bare_scene, last_error};
use crate::effect_structs::effect_structs;
use crate::effects::Values;
use crate::grid::Load;
use crate::init::initialised;

/// The outputs of a call.
#[derive(Clone)]
pub struct Found {
    pub status: i32,
    pub message: String,
    /// Total pressures: contact pressures minus attraction.
    pub p: Vec<f64>,
    /// Contact pressures.
    pub q: Vec<f64>,
    pub contact: Vec<i32>,
    /// Tractions in x and y.
    pub tractions: [Vec<f64>; 2],
    pub report: contact_normal_report,
}

impl Found {
    /// The bits of the results, which must be the same for equal calls.
    pub fn bits(&self) -> Vec<u64> {
        let fields = self.p.iter().chain(&self.q).chain(&self.tractions[0]).map(|value| value.to_bits());
        fields.chain([self.report.normal.approach.to_bits(), self.status as u64]).collect()
    }
}

/// The function of the library that is called.
pub enum Asked {
    /// `contact_normal_solve`.
    Solve,
    /// `contact_normal_pull_off`.
    PullOff,
    /// `contact_normal_solver_solve` with this handle, and whether it starts from the last result of the handle.
    Handle(*mut contact_normal_solver, bool),
}

/// Makes one call for a case with this load.
pub fn ask(case: &Case, load: Load, asked: &Asked) -> Found {
    let n = case.grid.len();
    let structs = effect_structs(&case.effects);
    let mut scene = bare_scene(&case.grid, &case.h, (case.shear_modulus, case.poisson_ratio), load);
    structs.point_from(&mut scene, &case.effects);
    let mut adhesion = initialised(contact_normal_adhesion_init);
    (adhesion.law, adhesion.start, adhesion.smear, adhesion.range) = (case.law, case.start, case.smear, case.range);
    match &case.work {
        Values::Uniform(work) => adhesion.work_of_adhesion = *work,
        Values::PerElement(works) => adhesion.works_of_adhesion = works.as_ptr(),
    }
    let mut friction = initialised(contact_normal_friction_init);
    if let Some((mu, strength, shift)) = case.friction {
        adhesion.shear_strength = strength;
        (friction.coefficient, friction.creepage[0]) = (mu, shift * case.range);
        scene.friction = &friction;
    }
    scene.adhesion = &adhesion;
    let mut options = initialised(contact_normal_options_init);
    if let Asked::Handle(_, true) = asked {
        options.initial_guess = CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS;
    }
    let mut found = Found {
        status: 0,
        message: String::new(),
        p: vec![0.0; n],
        q: vec![0.0; n],
        contact: vec![0; n],
        tractions: [vec![0.0; n], vec![0.0; n]],
        report: initialised(contact_normal_report_init),
    };
    let mut fields = initialised(contact_normal_fields_init);
    (fields.pressure, fields.contact) = (found.p.as_mut_ptr(), found.contact.as_mut_ptr());
    fields.contact_pressure = found.q.as_mut_ptr();
    if case.friction.is_some() {
        fields.traction = [found.tractions[0].as_mut_ptr(), found.tractions[1].as_mut_ptr()];
    }
    let report = &raw mut found.report;
    // SAFETY: structs with the arrays that they declare, and a handle that no one else uses.
    found.status = unsafe {
        match *asked {
            Asked::Solve => contact_normal_solve(&scene, &options, &mut fields, report),
            Asked::PullOff => contact_normal_pull_off(&scene, &options, &mut fields, report),
            Asked::Handle(handle, _) => contact_normal_solver_solve(handle, &scene, &options, &mut fields, report),
        }
    };
    if found.status != CONTACT_NORMAL_OK {
        found.message = last_error();
    }
    found
}
