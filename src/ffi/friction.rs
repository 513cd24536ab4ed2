//! `contact_normal_friction`, and its translation to a [`Friction`].

use super::arguments::{optional, reserved, switch, unknown, GivenEffect, Regions};
use super::influence::{contact_normal_influence, contact_normal_row_tables};
use super::status::Refusal;
use super::structs::versioned;
use crate::friction::{EXTERIOR, PLASTIC, SLIP, STICK};
use crate::grid::Grid;
use crate::scene::{Branch, Each, Fall, Friction, FrictionLaw, Motion, PlasticLayer, Prescribed, Previous};

/// `motion`: the bodies slide along the surface and turn about the normal, without rolling.
pub const CONTACT_NORMAL_MOTION_SHIFT: i32 = 0;
/// `motion`: a step of rolling, which begins with the previous tractions.
pub const CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING: i32 = 1;
/// `motion`: rolling whose tractions no longer change. Previous tractions are only an initial guess.
pub const CONTACT_NORMAL_MOTION_STEADY_ROLLING: i32 = 2;

/// `prescribed`: the creepage of a direction is prescribed.
pub const CONTACT_NORMAL_PRESCRIBED_CREEPAGE: i32 = 0;
/// `prescribed`: the tangential force of a direction is prescribed, and the creepage is computed.
pub const CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE: i32 = 1;

/// `law`: the coefficient does not depend on the slip.
pub const CONTACT_NORMAL_FRICTION_LAW_COULOMB: i32 = 0;
/// `law`: both falling parts f(v) are `max(0, 1 - v/(2 h))`.
pub const CONTACT_NORMAL_FRICTION_LAW_LINEAR: i32 = 1;
/// `law`: the first falling part f(v) is `1/(1 + v/h)`, the second one `1/(1 + (v/h)^2)`.
pub const CONTACT_NORMAL_FRICTION_LAW_RATIONAL: i32 = 2;
/// `law`: both falling parts f(v) are `2^(-v/h)`.
pub const CONTACT_NORMAL_FRICTION_LAW_EXPONENTIAL: i32 = 3;
/// `friction->branch`: the solution near the initial guess. If the iteration finds none and no force is prescribed, it starts again from an iterate
/// of LOW.
pub const CONTACT_NORMAL_FRICTION_BRANCH_NEAR: i32 = 0;
/// `friction->branch`: the solution of an iteration that starts from the traction bounds without slip.
pub const CONTACT_NORMAL_FRICTION_BRANCH_LOW: i32 = 1;
/// `friction->branch`: the solution of an iteration that starts from the traction bounds of unlimited slip.
pub const CONTACT_NORMAL_FRICTION_BRANCH_HIGH: i32 = 2;

/// `fields->stick_slip`: the element is not in contact.
pub const CONTACT_NORMAL_STICK_SLIP_EXTERIOR: i32 = 0;
/// `fields->stick_slip`: the element sticks.
pub const CONTACT_NORMAL_STICK_SLIP_STICK: i32 = 1;
/// `fields->stick_slip`: the element slips.
pub const CONTACT_NORMAL_STICK_SLIP_SLIP: i32 = 2;

/// `fields->stick_slip`: the element slips because a plastic layer yields, at a traction below mu p.
pub const CONTACT_NORMAL_STICK_SLIP_PLASTIC: i32 = 3;

// The core writes its own constants to `stick_slip`.
const _: () = assert!(
    CONTACT_NORMAL_STICK_SLIP_EXTERIOR == EXTERIOR
        && CONTACT_NORMAL_STICK_SLIP_STICK == STICK
        && CONTACT_NORMAL_STICK_SLIP_SLIP == SLIP
        && CONTACT_NORMAL_STICK_SLIP_PLASTIC == PLASTIC
);

/// Effect: friction, `|q| <= mu p`. Tractions q act on body 1. The slip s is that of body 1 over body 2 in the step, a length. The creepages of a
/// shift are lengths, and its spin is an angle; those of rolling are divided by the length rolled. A negative creepage in x gives a positive force
/// in x. Rigid slips must be less than 1e140, and so must previous tractions, except in steady rolling. The rms of the rigid slips must be 0, or
/// between 1e-60 and 1e30 times the displacement of an element by a traction of mu p on itself (INVALID_ARGUMENT). See docs/friction.md.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_friction {
    /// Set by `contact_normal_friction_init`.
    pub struct_size: i64,
    /// The coefficient of friction mu of all elements, >= 0; default 0. Not read if there are `coefficients`.
    pub coefficient: f64,
    /// The coefficient of friction mu of each element, `[my][mx]`, or NULL (default).
    pub coefficients: *const f64,
    /// CONTACT_NORMAL_MOTION_...; default SHIFT.
    pub motion: i32,
    /// 1: the tractions before the step are those of this handle's last solve with friction, also if it stopped early or was cancelled (not in a
    /// batch). 0 (default): `previous_traction`.
    pub continues: i32,
    /// In x and in y: CONTACT_NORMAL_PRESCRIBED_CREEPAGE or _TANGENTIAL_FORCE; default CREEPAGE.
    pub prescribed: [i32; 2],
    /// The creepages in x and in y; default 0. Not read in a direction whose force is prescribed.
    pub creepage: [f64; 2],
    /// The spin about the normal; default 0.
    pub spin: f64,
    /// The axis of the spin and of the moment, relative to the middle of the grid, lengths; default 0.
    pub spin_centre: [f64; 2],
    /// The forces in x and in y, the sums of q dx dy; default 0. Not read in a direction whose creepage is prescribed.
    pub force: [f64; 2],
    /// The length rolled in the step, at most a million elements; default 0: dx.
    pub rolling_distance: f64,
    /// The direction of rolling: the angle from the x axis, in radians; default 0.
    pub rolling_direction: f64,
    /// In rolling, the slip due to spin is that at a point ahead of the element's centre, by this part of the length rolled; default 1/6.
    pub spin_offset: f64,
    /// The tractions before the step in x and in y, `[my][mx]` each, both or none; NULL (default): there are none, the bodies are at rest.
    pub previous_traction: [*const f64; 2],
    /// An additional rigid slip in x and in y, lengths per step, `[my][mx]` each, both or none; default NULL.
    pub rigid_slip: [*const f64; 2],
    /// Tangential influence coefficients of your own instead of the half-space's. xx: the displacement in x by a unit traction in x; yy: that in y
    /// by one in y; xy: that in x by one in y, and in y by one in x. All or none, default NULL; all with the same cx, cy and scale. xx and yy must
    /// be even in x and in y, and xy odd in both (UNSUPPORTED otherwise). In steady rolling of like bodies this is needed in y only: coefficients
    /// that are uneven in x belong to bodies that roll in one direction. Steps must have this direction, also if `scene->influence` is uneven in x
    /// (INVALID_ARGUMENT otherwise). Rolling needs steps of whole elements, and tables that reach across the contact area and a step. The tables
    /// belong to the set-up of a solver: later scenes may leave them out, and other tables are refused (INFLUENCE_CHANGED). With `scene->influence`
    /// or `scene->row_tables` the bodies are not read; otherwise they must be alike, or `influence_cross` must be given.
    pub influence: [*const contact_normal_influence; 3],
    /// With `influence`, for unlike bodies: xz and yz, the displacements in x and in y by a unit pressure, with the same cx, cy and scale, both or
    /// none, default NULL. xz must be odd in x and even in y, yz even in x and odd in y (UNSUPPORTED otherwise). Tractions then displace the surfaces
    /// along the normal by -(xz qx + yz qy), and the normal and the tangential problem are solved in turns.
    pub influence_cross: [*const contact_normal_influence; 2],
    /// 1: `report->tangential.sensitivities` gets the derivatives of the forces and the moment by creepages and spin; default 0.
    pub sensitivities: i32,
    /// Must be 0.
    pub reserved: i32,
    /// The initial guess of the tractions in x and in y, `[my][mx]` each, both or none; default NULL. The solution does not depend on it. The
    /// tractions of a similar step save most of the work. If the guess is far from the solution, the iteration starts without it.
    pub initial_traction: [*const f64; 2],
    /// The compliance of a thin elastic layer between the bodies, the tangential displacement per traction, >= 0. A third body of thickness h and
    /// shear modulus G has h/G. Default 0: no layer. Not read if there are `compliances`.
    pub compliance: f64,
    /// The compliance of each element, `[my][mx]`, or NULL (default).
    pub compliances: *const f64,
    /// The weights of the creepages in x and in y at each element, in [-1, 1], `[my][mx]` each, both or none; default NULL: 1. On a surface that is
    /// inclined within the contact area a weight is the cosine. Prescribed forces are the sums of q dx dy times the weight.
    pub creepage_weight: [*const f64; 2],
    /// Tangential influence coefficients of your own that differ from loaded row to loaded row, instead of `influence`. xx: the displacement in x by
    /// a unit traction in x; yy: that in y by one in y; xy: that in x by one in y. All or none, default NULL; all with the same cx, rows and scale.
    /// The operator must be symmetric (UNSUPPORTED otherwise): if the loaded and the displaced row are exchanged, xx at offset -k equals xx at offset
    /// k, and so does yy. The displacement in y by a unit traction in x is xy of the exchanged rows at -k. Rolling needs steps of whole elements
    /// along x; cx must reach across the contact area and a step. All else is as for `influence`; unlike bodies are refused.
    pub row_tables: [*const contact_normal_row_tables; 3],
    /// How mu falls with the slip velocity v: CONTACT_NORMAL_FRICTION_LAW_...; default COULOMB: mu is constant, and the members of laws are not read.
    /// mu(v) is the coefficient times `(kinetic + falling[0] f(v) + falling[1] f(v))/(kinetic + falling[0] + falling[1])`, so `coefficient` is mu at
    /// rest. Bodies must be alike, and `sensitivities` must be 0 (UNSUPPORTED otherwise). See docs/laws.md.
    pub law: i32,
    /// Must be 0.
    pub reserved_for_law: i32,
    /// The part of mu that remains at high slip velocity, >= 0; default 0. Only the ratios of `kinetic` and `falling` matter.
    pub kinetic: f64,
    /// The two parts of mu that fall, >= 0; default 0.
    pub falling: [f64; 2],
    /// The slip velocity h at which each falling part is a half of its value at rest; > 0 if the part is not 0.
    pub half_speed: [f64; 2],
    /// The speed of rolling, > 0. The duration of a step is the length rolled divided by this speed; v is the slip divided by the duration.
    pub speed: f64,
    /// The duration of a shift, > 0.
    pub time_step: f64,
    /// The distance of slip over which mu approaches mu(v), >= 0; default 0: mu is mu(v) at once.
    pub memory_distance: f64,
    /// Below this slip velocity mu approaches mu(v) as fast as at this velocity, >= 0; default 0.
    pub memory_speed: f64,
    /// For a plastic layer between the bodies: the traction at which fresh material yields, `|q| <= min(mu p, yield_limit + hardening * slip)`.
    /// Default 0: no layer yields.
    pub yield_limit: f64,
    /// The change of the yield limit per plastic slip, a traction per length; < 0: the layer softens. Default 0: ideal plasticity. If it is not 0,
    /// the rules for bodies and `sensitivities` are those of a `law`.
    pub hardening: f64,
    /// For a law with memory: mu of the particles of the interface before the step, `[my][mx]`. Default NULL: mu at rest or, with `continues`, the
    /// values of the handle. An array of zeros, which a step without a law writes, counts as NULL. In transient rolling these are the particles at
    /// the elements before the step. Steady rolling does not read it.
    pub previous_coefficient: *const f64,
    /// The yield limits of the same particles; default NULL: `yield_limit`. An array of zeros counts as NULL.
    pub previous_yield_limit: *const f64,
    /// The wanted solution, if a law, or a layer that hardens or softens, allows several: CONTACT_NORMAL_FRICTION_BRANCH_...; default NEAR. LOW and
    /// HIGH take several times as many products, and need prescribed creepages in both directions (UNSUPPORTED otherwise).
    pub branch: i32,
    /// Must be 0.
    pub reserved_for_branch: i32,
}

versioned! { contact_normal_friction, contact_normal_friction_init, 248, spin_offset: 1.0 / 6.0 }

impl contact_normal_friction {
    /// The caller's arrays must live as long as the result is used.
    pub(super) unsafe fn translate<'a>(&self, grid: &Grid) -> Result<Friction<'a>, Refusal> {
        let motion = self.motion()?;
        let pair = |name: &str, [x, y]: [*const f64; 2]| {
            // SAFETY (both): NULL or one value per element, by the conventions of the ABI.
            match unsafe { (optional(x, grid.len()), optional(y, grid.len())) } {
                (Some(x), Some(y)) => Ok(Some([x, y])),
                (None, None) => Ok(None),
                _ => Err(Refusal::null(&format!("one of scene->friction->{name}"))),
            }
        };
        let given = pair("previous_traction", self.previous_traction)?;
        let previous = match (switch("friction->continues", self.continues)?, given) {
            (false, Some(given)) => Previous::Given(given),
            (false, None) => Previous::None,
            (true, None) => Previous::Kept,
            (true, Some(_)) => {
                let message = "friction->continues is 1, and previous_traction is given; only one of them can be";
                return Err(Refusal::invalid(message.into()));
            }
        };
        reserved("friction->reserved", self.reserved)?;
        let sensitivities = switch("friction->sensitivities", self.sensitivities)?;
        reserved("friction->reserved_for_law", self.reserved_for_law)?;
        let n = grid.len();
        // SAFETY (all): as above.
        let (coefficients_before, yield_limits) =
            unsafe { (optional(self.previous_coefficient, n), optional(self.previous_yield_limit, n)) };
        // A step without a law or a layer writes zeros.
        let is_zero = |values: &&[f64]| values.iter().all(|value| *value == 0.0);
        let [coefficients_before, yield_limits] =
            [coefficients_before, yield_limits].map(|values| values.filter(|values| !is_zero(values)));
        let (coefficients, compliances) =
            unsafe { (optional(self.coefficients, grid.len()), optional(self.compliances, grid.len())) };
        Ok(Friction {
            coefficient: Each::of(coefficients, self.coefficient),
            motion,
            prescribed: [self.prescribed_in(0)?, self.prescribed_in(1)?],
            spin: self.spin,
            spin_centre: self.spin_centre,
            rolling_distance: self.rolling_distance,
            rolling_direction: self.rolling_direction,
            spin_offset: self.spin_offset,
            previous,
            initial: pair("initial_traction", self.initial_traction)?,
            rigid_slip: pair("rigid_slip", self.rigid_slip)?,
            weights: pair("creepage_weight", self.creepage_weight)?,
            compliance: Each::of(compliances, self.compliance),
            influence: self.own_influence()?,
            sensitivities,
            law: self.law()?,
            layer: self.layer(),
            coefficients_before,
            yield_limits,
            branch: self.branch()?,
        })
    }

    fn motion(&self) -> Result<Motion, Refusal> {
        match self.motion {
            CONTACT_NORMAL_MOTION_SHIFT => Ok(Motion::Shift),
            CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING => Ok(Motion::TransientRolling),
            CONTACT_NORMAL_MOTION_STEADY_ROLLING => Ok(Motion::SteadyRolling),
            other => unknown("friction->motion", other, "SHIFT 0, TRANSIENT_ROLLING 1 or STEADY_ROLLING 2"),
        }
    }

    fn law(&self) -> Result<Option<FrictionLaw>, Refusal> {
        let fall = match self.law {
            CONTACT_NORMAL_FRICTION_LAW_COULOMB => return Ok(None),
            CONTACT_NORMAL_FRICTION_LAW_LINEAR => Fall::Linear,
            CONTACT_NORMAL_FRICTION_LAW_RATIONAL => Fall::Rational,
            CONTACT_NORMAL_FRICTION_LAW_EXPONENTIAL => Fall::Exponential,
            other => {
                let known = "FRICTION_LAW_COULOMB 0, LINEAR 1, RATIONAL 2 or EXPONENTIAL 3";
                return unknown("friction->law", other, known);
            }
        };
        let Self { kinetic, falling, half_speed, speed, time_step, memory_distance, memory_speed, .. } = *self;
        Ok(Some(FrictionLaw { fall, kinetic, falling, half_speed, speed, time_step, memory_distance, memory_speed }))
    }

    fn branch(&self) -> Result<Branch, Refusal> {
        reserved("friction->reserved_for_branch", self.reserved_for_branch)?;
        match self.branch {
            CONTACT_NORMAL_FRICTION_BRANCH_NEAR => Ok(Branch::Near),
            CONTACT_NORMAL_FRICTION_BRANCH_LOW => Ok(Branch::Low),
            CONTACT_NORMAL_FRICTION_BRANCH_HIGH => Ok(Branch::High),
            other => unknown("friction->branch", other, "FRICTION_BRANCH_NEAR 0, LOW 1 or HIGH 2"),
        }
    }

    fn layer(&self) -> Option<PlasticLayer> {
        let Self { yield_limit, hardening, .. } = *self;
        (yield_limit != 0.0 || hardening != 0.0).then_some(PlasticLayer { yield_limit, hardening })
    }

    fn prescribed_in(&self, k: usize) -> Result<Prescribed, Refusal> {
        match self.prescribed[k] {
            CONTACT_NORMAL_PRESCRIBED_CREEPAGE => Ok(Prescribed::Creepage(self.creepage[k])),
            CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE => Ok(Prescribed::Force(self.force[k])),
            other => {
                let known = "PRESCRIBED_CREEPAGE 0 or PRESCRIBED_TANGENTIAL_FORCE 1";
                unknown(&format!("friction->prescribed[{k}]"), other, known)
            }
        }
    }
}

impl GivenEffect for contact_normal_friction {
    fn add_to(&self, regions: &mut Regions, grid: &Grid) -> Result<(), Refusal> {
        let n = grid.len();
        regions.input("friction->coefficients", self.coefficients, n)?;
        regions.input("friction->compliances", self.compliances, n)?;
        regions.input("friction->previous_coefficient", self.previous_coefficient, n)?;
        regions.input("friction->previous_yield_limit", self.previous_yield_limit, n)?;
        for k in 0..2 {
            regions.input("friction->previous_traction", self.previous_traction[k], n)?;
            regions.input("friction->rigid_slip", self.rigid_slip[k], n)?;
            regions.input("friction->initial_traction", self.initial_traction[k], n)?;
            regions.input("friction->creepage_weight", self.creepage_weight[k], n)?;
        }
        self.add_tables_to(regions)
    }
}
