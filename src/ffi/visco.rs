//! `contact_normal_visco`, and the results of a step in time.

use super::arguments::{count, required, switch, unknown, GivenEffect, Regions};
use super::status::Refusal;
use super::structs::versioned;
use crate::grid::Grid;
use crate::scene::{Branches, Visco};
use crate::visco::{Form, Report, MOST_BRANCHES};

/// `form`: RELAXATION if the approach is prescribed, CREEP if the force is.
pub const CONTACT_NORMAL_FORM_AUTO: i32 = 0;
/// `form`: displacements are linear in time during the step; second order. Exact for a constant approach, if one body is rigid or both relax alike.
pub const CONTACT_NORMAL_FORM_RELAXATION: i32 = 1;
/// `form`: pressures are linear in time during the step; second order. Exact for constant pressures.
pub const CONTACT_NORMAL_FORM_CREEP: i32 = 2;
/// `form`: backward Euler, first order, for a comparison with programs that use it.
pub const CONTACT_NORMAL_FORM_BACKWARD_EULER: i32 = 3;

/// Effect: viscoelastic bodies, which relax, and a step in time of duration `time_step`. The `shear_modulus` of the scene is the instantaneous one.
/// It falls to `G(t) = G - sum of modulus (1 - exp(-t/time))` at a constant Poisson ratio. The branches of a coated body are those of the coating,
/// and the body below must be rigid. A solver handle keeps the history of the steps: the first step has `continues` 0, the others 1. `displacement`
/// and `deformed_distance` contain the displacements that earlier steps left. A step that stops early counts as a step. See docs/visco.md.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_visco {
    /// Set by `contact_normal_visco_init`.
    pub struct_size: i64,
    /// The number of branches of body 1 and of body 2: 0 (default: an elastic body) to 32.
    pub branches: [i32; 2],
    /// The moduli of the branches of each body, pressures >= 0 whose sum is at most the body's shear modulus. Default NULL: to be set if there are
    /// branches.
    pub modulus: [*const f64; 2],
    /// The relaxation times of the branches of each body, > 0. Default NULL: to be set if there are branches.
    pub time: [*const f64; 2],
    /// The duration of the step, >= 0; default 0: the load jumps, and the bodies respond instantaneously.
    pub time_step: f64,
    /// CONTACT_NORMAL_FORM_...; default AUTO.
    pub form: i32,
    /// 1: the step begins where the last step of the solver ended; 0 (default): the bodies are at rest before, at time 0.
    pub continues: i32,
}

versioned! { contact_normal_visco, contact_normal_visco_init, 64 }

impl contact_normal_visco {
    /// The caller's arrays must live as long as the result is used.
    pub(super) unsafe fn translate<'a>(&self) -> Result<Visco<'a>, Refusal> {
        let mut bodies = [Branches::default(); 2];
        for (b, body) in bodies.iter_mut().enumerate() {
            let [name, modulus, time] = Visco::MEMBERS[b];
            if self.branches[b] == 0 {
                continue;
            }
            let branches = count(name, self.branches[b])?;
            if branches > MOST_BRANCHES {
                return Err(Refusal::invalid(format!("{name} is {branches}; it must be at most {MOST_BRANCHES}")));
            }
            // SAFETY: NULL or as many values as branches, by the conventions of the ABI.
            let (modulus, time) =
                unsafe { (required(modulus, self.modulus[b], branches)?, required(time, self.time[b], branches)?) };
            *body = Branches { modulus, time };
        }
        let form = match self.form {
            CONTACT_NORMAL_FORM_AUTO => None,
            CONTACT_NORMAL_FORM_RELAXATION => Some(Form::Relaxation),
            CONTACT_NORMAL_FORM_CREEP => Some(Form::Creep),
            CONTACT_NORMAL_FORM_BACKWARD_EULER => Some(Form::BackwardEuler),
            other => return unknown("visco->form", other, "AUTO 0, RELAXATION 1, CREEP 2 or BACKWARD_EULER 3"),
        };
        let continues = switch("visco->continues", self.continues)?;
        Ok(Visco { bodies, time_step: self.time_step, form, continues })
    }

    /// The number of moduli and of times that are read of a body: none if `branches` is refused.
    fn values(&self, b: usize) -> usize {
        usize::try_from(self.branches[b]).ok().filter(|branches| *branches <= MOST_BRANCHES).unwrap_or(0)
    }
}

impl GivenEffect for contact_normal_visco {
    fn add_to(&self, regions: &mut Regions, _grid: &Grid) -> Result<(), Refusal> {
        for (b, [_, modulus, time]) in Visco::MEMBERS.into_iter().enumerate() {
            regions.input(modulus, self.modulus[b], self.values(b))?;
            regions.input(time, self.time[b], self.values(b))?;
        }
        Ok(())
    }
}

/// The results of a step in time: a group of `contact_normal_report`. Without bodies that relax all is 0.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct contact_normal_report_visco {
    /// The time since the bodies were at rest: the sum of the time steps.
    pub time: f64,
    /// An estimate of the error of this step: the difference of the displacements in contact between the form of the step and another form, rms,
    /// relative to the rms of h - approach.
    pub step_error: f64,
    /// An estimate of the error of the result: the sum of the errors of all steps since the bodies were at rest. 0 without contact.
    pub time_error: f64,
    /// The compliance of the bodies in the step, relative to the instantaneous one.
    pub compliance: f64,
    /// Room for later versions: 0.
    pub reserved: [f64; 4],
}

impl contact_normal_report_visco {
    pub(super) fn set(&mut self, found: &Report) {
        (self.time, self.compliance) = (found.time, found.compliance);
        (self.step_error, self.time_error) = (found.step_error, found.time_error);
    }
}
