//! `contact_normal_friction`.

use super::arguments::{optional, reserved, switch, unknown, GivenEffect, Regions};
use super::influence::{contact_normal_influence, contact_normal_row_tables};
use super::status::Refusal;
use super::structs::versioned;
use crate::friction::{EXTERIOR, PLASTIC, SLIP, STICK};
use crate::grid::Grid;
use crate::scene::{Branch, Each, Fall, Friction, FrictionLaw, Motion, PlasticLayer, Prescribed, Previous};

/// `motion`: sideways and about the normal, without rolling.
pub const CONTACT_NORMAL_MOTION_SHIFT: i32 = 0;
/// `motion`: a step of rolling, from the tractions before.
pub const CONTACT_NORMAL_MOTION_TRANSIENT_ROLLING: i32 = 1;
/// `motion`: rolling that does not change any more; the tractions before are only where the iteration starts.
pub const CONTACT_NORMAL_MOTION_STEADY_ROLLING: i32 = 2;

/// `prescribed`: the creepage of a direction is given.
pub const CONTACT_NORMAL_PRESCRIBED_CREEPAGE: i32 = 0;
/// `prescribed`: the tangential force of a direction is given, its creepage is found.
pub const CONTACT_NORMAL_PRESCRIBED_TANGENTIAL_FORCE: i32 = 1;

/// `law`: the coefficient does not depend on the slip.
pub const CONTACT_NORMAL_FRICTION_LAW_COULOMB: i32 = 0;
/// `law`: parts fall as `max(0, 1 - v/(2 h))`.
pub const CONTACT_NORMAL_FRICTION_LAW_LINEAR: i32 = 1;
/// `law`: the first part falls as `1/(1 + v/h)`, the second as `1/(1 + (v/h)^2)`.
pub const CONTACT_NORMAL_FRICTION_LAW_RATIONAL: i32 = 2;
/// `law`: parts fall as `2^(-v/h)`.
pub const CONTACT_NORMAL_FRICTION_LAW_EXPONENTIAL: i32 = 3;
/// `friction->branch`: the solution near the start of the iteration. If that finds none and no force is given, it begins again from turns of LOW.
pub const CONTACT_NORMAL_FRICTION_BRANCH_NEAR: i32 = 0;
/// `friction->branch`: that to which bounds without slip lead.
pub const CONTACT_NORMAL_FRICTION_BRANCH_LOW: i32 = 1;
/// `friction->branch`: that to which bounds of any speed lead.
pub const CONTACT_NORMAL_FRICTION_BRANCH_HIGH: i32 = 2;

/// `fields->stick_slip`: the element is not in contact.
pub const CONTACT_NORMAL_STICK_SLIP_EXTERIOR: i32 = 0;
/// `fields->stick_slip`: it sticks.
pub const CONTACT_NORMAL_STICK_SLIP_STICK: i32 = 1;
/// `fields->stick_slip`: it slips.
pub const CONTACT_NORMAL_STICK_SLIP_SLIP: i32 = 2;

/// `fields->stick_slip`: it slips within a layer that yields, below mu p.
pub const CONTACT_NORMAL_STICK_SLIP_PLASTIC: i32 = 3;

// The core has constants of its own, which it writes to `stick_slip`.
const _: () = assert!(
    CONTACT_NORMAL_STICK_SLIP_EXTERIOR == EXTERIOR
        && CONTACT_NORMAL_STICK_SLIP_STICK == STICK
        && CONTACT_NORMAL_STICK_SLIP_SLIP == SLIP
        && CONTACT_NORMAL_STICK_SLIP_PLASTIC == PLASTIC
);

/// Effect: friction, `|q| <= mu p`. Tractions q act on body 1; the slip s is that of body 1 over body 2: a length, that of the step.
/// Creepages and spin of a shift are lengths and an angle; of rolling they are divided by the length rolled. A negative creepage in x
/// gives a positive force in x. Rigid slips must be less than 1e140, and so must previous tractions, except in steady rolling. The rms of rigid
/// slips must lie between 1e-60 and 1e30 times what tractions of the size of mu p displace their own element by, or be 0
/// (INVALID_ARGUMENT). See docs/friction.md.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct contact_normal_friction {
    /// Set by `contact_normal_friction_init`.
    pub struct_size: i64,
    /// mu of all elements, >= 0; default 0. Not read if there are `coefficients`.
    pub coefficient: f64,
    /// mu of each element, `[my][mx]`, or NULL (default).
    pub coefficients: *const f64,
    /// CONTACT_NORMAL_MOTION_...; default SHIFT.
    pub motion: i32,
    /// 1: from the tractions that this handle found last, solves without friction aside (not in a batch); those of a
    /// solve that stopped early, or was cancelled, count. 0 (default): `previous_traction`.
    pub continues: i32,
    /// Of x and y: CONTACT_NORMAL_PRESCRIBED_CREEPAGE or _TANGENTIAL_FORCE; default CREEPAGE.
    pub prescribed: [i32; 2],
    /// In x and y; default 0. Not read where the force is prescribed.
    pub creepage: [f64; 2],
    /// About the normal; default 0.
    pub spin: f64,
    /// Where the spin turns about and the moment is taken, from the middle of the grid: lengths; default 0.
    pub spin_centre: [f64; 2],
    /// The sum of q dx dy in x and y; default 0. Not read where the creepage is prescribed.
    pub force: [f64; 2],
    /// The length rolled in the step, at most a million elements; default 0: dx.
    pub rolling_distance: f64,
    /// The direction of rolling: an angle from the x axis, in radians; default 0.
    pub rolling_direction: f64,
    /// In rolling with spin: the part of the step by which places are ahead; default 1/6.
    pub spin_offset: f64,
    /// The tractions before, in x and y, `[my][mx]` each, both or none; NULL (default): none, a start from rest.
    pub previous_traction: [*const f64; 2],
    /// A rigid slip in addition, in x and y, lengths of the step, `[my][mx]` each, both or none; default NULL.
    pub rigid_slip: [*const f64; 2],
    /// Own tangential influence coefficients xx, yy and xy instead of the half-space's: the displacement in x by a unit traction in x, in
    /// y by one in y, and in either by one in the other. All or none, default NULL; all with the same cx, cy and scale. xx and yy must be
    /// even in x and in y, and xy odd in both (UNSUPPORTED otherwise). In steady rolling of like bodies y alone counts: coefficients that
    /// are uneven in x are those of bodies that roll in one direction. Steps must then go in that direction, also where `scene->influence` is
    /// uneven in x (INVALID_ARGUMENT otherwise). Rolling needs steps of whole elements, and tables that reach across the contact area and a
    /// step. The tables belong to the set-up of a solver: later scenes may leave them out, and others are refused (INFLUENCE_CHANGED). With
    /// `scene->influence` or `scene->row_tables` the bodies are not read; otherwise they must be alike, or `influence_cross` must be given.
    pub influence: [*const contact_normal_influence; 3],
    /// With `influence`, of unlike bodies: xz and yz, the displacement difference in x and in y by a unit pressure; with the same cx, cy and
    /// scale, both or none, default NULL. xz must be odd in x and even in y, yz even in x and odd in y (UNSUPPORTED otherwise). Tractions
    /// then displace along the normal by -(xz qx + yz qy), and both problems are solved in turns.
    pub influence_cross: [*const contact_normal_influence; 2],
    /// 1: derivatives of forces and moment by creepages and spin, in `report->tangential.sensitivities`; default 0.
    pub sensitivities: i32,
    /// Must be 0.
    pub reserved: i32,
    /// Tractions in x and y to start the iteration from, `[my][mx]` each, both or none; default NULL. The solution does not depend on them:
    /// those of a step that differs little save most of the work. Where they are far from it, the iteration starts without them.
    pub initial_traction: [*const f64; 2],
    /// The compliance of a thin elastic layer between the bodies, a length per traction, >= 0: it displaces by that times the traction on
    /// it. Of a third body of thickness h and shear modulus G it is h/G. Default 0: none. Not read if there are `compliances`.
    pub compliance: f64,
    /// That of each element, `[my][mx]`, or NULL (default).
    pub compliances: *const f64,
    /// How much of a creepage in x, in y reaches each element, in [-1, 1], `[my][mx]` each, both or none; default NULL: 1. For surfaces that are
    /// inclined within the contact area: the cosine. The forces that are prescribed are the sums of these times q dx dy.
    pub creepage_weight: [*const f64; 2],
    /// Own tangential influence coefficients that differ per loaded row, instead of `influence`: xx, yy and xy, the displacement in x by a
    /// unit traction in x, in y by one in y, and in x by one in y. All or none, default NULL; all with the same cx, rows and scale. The
    /// operator must be symmetric (UNSUPPORTED otherwise): xx of the loaded row jy and the row iy at offset k is xx of jy and iy exchanged at
    /// -k, and so is yy. The displacement in y by a unit traction in x is xy of the rows exchanged at -k. Rolling needs steps of whole
    /// elements along x; cx must reach across the contact area and a step. Otherwise as `influence`; unlike bodies are refused.
    pub row_tables: [*const contact_normal_row_tables; 3],
    /// How mu falls with the slip velocity v: CONTACT_NORMAL_FRICTION_LAW_...; default COULOMB: not at all, and what goes with it is not
    /// read. mu(v) is the coefficient times `(kinetic + falling[0] f(v) + falling[1] f(v))/(kinetic + falling[0] + falling[1])`, so that
    /// `coefficient` is that at rest. Bodies must be alike, and `sensitivities` be 0 (UNSUPPORTED otherwise). See docs/laws.md.
    pub law: i32,
    /// Must be 0.
    pub reserved_for_law: i32,
    /// The part of mu that stays at high speed, >= 0; default 0. Only ratios of this and of `falling` count.
    pub kinetic: f64,
    /// The parts of mu that fall, two of them, >= 0; default 0.
    pub falling: [f64; 2],
    /// The slip velocity h of each part, at which half of it is left; > 0 where the part is.
    pub half_speed: [f64; 2],
    /// The speed of rolling, > 0: a step takes the length rolled divided by it, and v is the slip divided by that.
    pub speed: f64,
    /// The duration of a shift, > 0: a time.
    pub time_step: f64,
    /// The distance of slip over which mu follows, >= 0; default 0: at once.
    pub memory_distance: f64,
    /// The least slip velocity by which it follows, >= 0; default 0.
    pub memory_speed: f64,
    /// Of a layer between the bodies: the traction at which fresh material yields; `|q| <= min(mu p, yield_limit + hardening * slip)`. Default
    /// 0: it does not yield.
    pub yield_limit: f64,
    /// The change of the limit by a length of plastic slip, a traction per length; < 0: it softens. Default 0: ideal plastic. Otherwise
    /// bodies and `sensitivities` as with a `law`.
    pub hardening: f64,
    /// mu that particles of the interface had before the step, of a law with memory, `[my][mx]`; default NULL: that at rest, and with
    /// `continues` what the handle found. Zeros alone, which a step without a law writes, count as NULL. In transient rolling a particle comes from its
    /// old place; steady rolling does not read it.
    pub previous_coefficient: *const f64,
    /// Their yield limits; default NULL: `yield_limit`. Zeros alone count as NULL.
    pub previous_yield_limit: *const f64,
    /// Which solution, of a law or a layer that hardens or softens: CONTACT_NORMAL_FRICTION_BRANCH_...; default NEAR. Others take several times as many
    /// products, and creepages in both directions (UNSUPPORTED otherwise).
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
        let is_of_none = |values: &&[f64]| values.iter().all(|value| *value == 0.0);
        let [coefficients_before, yield_limits] =
            [coefficients_before, yield_limits].map(|values| values.filter(|values| !is_of_none(values)));
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
