//! Effect: viscoelastic bodies, and a step in time. See [`visco`](crate::visco) for the equations of a step.

use super::coupled::History;
use super::effect::{Effect, Value};
use super::memory::Memory;
use super::properties::{Continues, Properties, Stresses};
use super::visco_step::{Body, Step};
use crate::error::{invalid, not_negative, positive, require, Error, Number, Result};
use crate::grid::Grid;
use crate::scene::{Bodies, Load, Plain};
use crate::visco::{Form, Series, MOST_BRANCHES};

/// The branches of the Prony series of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Branches<'a> {
    /// The shear moduli `G_k` >= 0 of the branches. Their sum is at most the shear modulus of the body, which is the instantaneous one.
    pub modulus: &'a [f64],
    /// The relaxation times `t_k` > 0 of the branches.
    pub time: &'a [f64],
}

/// A step in time of viscoelastic bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Visco<'a> {
    /// The branches of body 1 and of body 2. For a coated body they are the branches of the coating.
    pub bodies: [Branches<'a>; 2],
    /// The duration of the step, >= 0. 0: the load jumps.
    pub time_step: f64,
    /// The quantity that is linear in time during the step. None: the displacement if the approach is prescribed, the pressures if the force is.
    pub form: Option<Form>,
    /// Whether the step begins at the end of the last step. Otherwise the bodies are at rest before the step.
    pub continues: bool,
}

const CONTINUES: Continues =
    Continues { member: "visco->continues", from: "step in time", instead: "begin each problem at rest" };

impl Visco<'_> {
    /// The effect's name in a scene.
    pub const NAME: &'static str = "visco";

    /// The names of the members that hold the number of branches, the moduli and the times of each body.
    pub(crate) const MEMBERS: [[&'static str; 3]; 2] = [
        ["visco->branches[0]", "visco->modulus[0]", "visco->time[0]"],
        ["visco->branches[1]", "visco->modulus[1]", "visco->time[1]"],
    ];

    /// Whether a body has branches.
    pub fn relaxes(&self) -> bool {
        self.bodies.iter().any(|branches| !branches.modulus.is_empty())
    }

    /// The Prony series of both bodies, whose instantaneous moduli are those at the surfaces.
    pub(crate) fn series(&self, at_surface: &Bodies) -> Result<[Series; 2]> {
        let of_body = |b: usize| {
            let (Branches { modulus, time }, g) = (self.bodies[b], at_surface.shear_modulus[b]);
            if g.is_infinite() && !modulus.is_empty() {
                return invalid(format!(
                    "{} is {}, but shear_modulus[{b}] is {g}: a rigid body has no branches",
                    Visco::MEMBERS[b][0],
                    modulus.len()
                ));
            }
            Series::new(g, modulus, time).map_or_else(
                || {
                    let sum: f64 = modulus.iter().sum();
                    invalid(format!(
                        "{} adds up to {}; it must be at most the modulus of the body at once, which is {}",
                        Visco::MEMBERS[b][1],
                        Number(sum),
                        Number(g)
                    ))
                },
                Ok,
            )
        };
        Ok([of_body(0)?, of_body(1)?])
    }

    /// The step of each elastic body. If both relax alike, one body stands for both.
    fn bodies(&self, at_surface: &Bodies, form: Form) -> Result<Vec<Body>> {
        let series = self.series(at_surface)?;
        let compliance = |b: usize| (1.0 - at_surface.poisson_ratio[b]) / (2.0 * at_surface.shear_modulus[b]);
        let first = compliance(0) / (compliance(0) + compliance(1));
        // The sum of both shares is exactly 1, so a jump from rest has the bits of the elastic scene.
        let shares = [first, 1.0 - first];
        let body = |b: usize, share: f64| Body::new(&series[b], share, (self.time_step, form));
        if series[0].is_like(&series[1]) {
            return Ok(vec![body(0, 1.0)]);
        }
        let elastic = (0..2).filter(|&b| compliance(b) > 0.0);
        Ok(elastic.map(|b| body(b, shares[b])).collect())
    }

    /// Called if an `effect` (a coating, or the caller's coefficients) replaces the coefficients of two half-spaces. Refuses bodies that relax
    /// differently, and a coating that relaxes on an elastic body.
    fn check_alike(&self, effect: &str, scene: &Plain<'_>, at_surface: &Bodies) -> Result<()> {
        let series = self.series(at_surface)?;
        let is_coated = |b: usize| {
            let constants = |bodies: &Bodies| (bodies.shear_modulus[b], bodies.poisson_ratio[b]);
            constants(&scene.bodies) != constants(at_surface)
        };
        for (b, series) in series.iter().enumerate() {
            if is_coated(b) && !series.is_empty() && scene.bodies.shear_modulus[b].is_finite() {
                return Err(Error::Unsupported(format!(
                    "visco is given, and body {} below its coating has the modulus {}; the layer relaxes, and the body does not: this version \
                     solves that on rigid bodies alone (+infinity)",
                    b + 1,
                    Number(scene.bodies.shear_modulus[b])
                )));
            }
        }
        let is_rigid = |b: usize| at_surface.shear_modulus[b].is_infinite();
        if series[0].is_like(&series[1]) || is_rigid(0) || is_rigid(1) {
            return Ok(());
        }
        Err(Error::Unsupported(format!(
            "visco and {effect} are both given, and both bodies give way, but do not relax alike; this version does not solve that"
        )))
    }
}

/// The elastic constants at the surfaces: those of the coatings where there are any, otherwise those of the bodies.
fn at_surface(scene: &Plain<'_>, others: &[Option<&dyn Effect>]) -> Bodies {
    others.iter().flatten().find_map(|other| other.at_surface(scene)).unwrap_or(scene.bodies)
}

impl Effect for Visco<'_> {
    fn name(&self) -> &'static str {
        Visco::NAME
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &["layer", "friction", "adhesion"],
            without_multigrid: None,
            with_given_area: true,
            one_grid: self.continues.then_some("what bodies remember is that of one grid"),
            own_coefficients: None,
            repeats: (false, false),
            limits: None,
            is_beside: false,
            continues: self.continues.then_some(CONTINUES),
        }
    }

    // Without branches the bodies are elastic. A scene has the effect also if its values are invalid, so that the scene refuses them.
    fn is_one(&self, scene: &Plain<'_>) -> bool {
        self.relaxes() || self.check(&scene.grid).is_err()
    }

    fn check(&self, _grid: &Grid) -> Result<()> {
        for (Branches { modulus, time }, [count, g, t]) in self.bodies.iter().zip(Visco::MEMBERS) {
            if modulus.len() > MOST_BRANCHES || modulus.len() != time.len() {
                let rule = format!("there are {MOST_BRANCHES} at most, each with a time");
                return invalid(format!("{count} is {} and {}; {rule}", modulus.len(), time.len()));
            }
            for (modulus, time) in modulus.iter().zip(*time) {
                not_negative(g, *modulus)?;
                positive(t, *time)?;
            }
        }
        let rule = "it must be 0, for a jump, or positive and finite";
        require(self.time_step >= 0.0 && self.time_step.is_finite(), "visco->time_step", self.time_step, rule)
    }

    fn check_load(&self, scene: &Plain<'_>, others: &[Option<&dyn Effect>]) -> Result<()> {
        self.check(&scene.grid)?;
        let at_surface = at_surface(scene, others);
        let is_other = |effect: &&&dyn Effect| {
            effect.at_surface(scene).is_some() || effect.properties().own_coefficients.is_some()
        };
        match others.iter().flatten().find(is_other) {
            Some(other) => self.check_alike(other.name(), scene, &at_surface),
            None => self.series(&at_surface).map(drop),
        }
    }

    // The set-up of a solver depends on the branches only. The time step, the form and `continues` may differ in each solve.
    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        for (branches, [_, modulus, time]) in self.bodies.iter().zip(Visco::MEMBERS) {
            tell(modulus, Value::Array(branches.modulus));
            tell(time, Value::Array(branches.time));
        }
    }

    fn gives_way(&self, _scene: &Plain<'_>) -> bool {
        false
    }

    // The stresses depend on the pressures and on the Poisson ratio, which does not change with time.
    fn stresses(&self, _b: usize, _scene: &Plain<'_>) -> Stresses<'_> {
        Stresses::Same
    }

    fn memory(
        &self,
        scene: &Plain<'_>,
        others: &[Option<&dyn Effect>],
        history: &mut History,
    ) -> Result<Option<Box<dyn Memory>>> {
        let at_surface = at_surface(scene, others);
        let form = self.form.unwrap_or(match scene.load {
            Load::Approach(_) => Form::Relaxation,
            Load::Force(_) => Form::Creep,
        });
        let other = if form == Form::Relaxation { Form::Creep } else { Form::Relaxation };
        let [bodies, compared] = [self.bodies(&at_surface, form)?, self.bodies(&at_surface, other)?];
        let step = Step { time_step: self.time_step, bodies, compared, continues: self.continues };
        for compliance in [step.compliance(), Step::compliance_of(&step.compared)] {
            if compliance.is_nan() {
                let why = "the times of the branches are too far apart to be solved together";
                return invalid(format!("visco->time_step is {}; {why}", Number(self.time_step)));
            }
            if !(compliance.is_normal() && (1.0 / compliance).is_normal()) {
                return invalid(format!(
                    "visco->time_step is {}, in which bodies that have no modulus in the end give way by {compliance:e} times what they do \
                     at once",
                    Number(self.time_step),
                ));
            }
        }
        history.fields(step.fields(), &scene.grid)?;
        Ok(Some(Box::new(step)))
    }
}
