//! Omissions: the named effects of a scene, and refinements that it has without naming them.

use crate::effects::replace_bodies;
use crate::scene::{Bodies, Coefficient, Each, Friction, Layer, Scene};
use crate::solver::numbered::numbered;

numbered! {
    /// An effect that is left out or replaced by a simpler one.
    Omission {
        /// The coatings: the bodies are of the substrate's material.
        Coating = 1: "coating",
        /// The period: the scene stands alone.
        Period: "period",
        /// The patches: all are fully coupled.
        Patches: "patches",
        /// The thin compliant layer.
        Layer: "layer",
        /// The limit of pressures.
        PressureLimit: "pressure_limit",
        /// Friction, with the effect of tractions on pressures of unlike bodies.
        Friction: "friction",
        /// The coupling of tractions and pressures of unlike bodies.
        Coupling: "coupling",
        /// The spin.
        Spin: "spin",
        /// The tangential compliance of a third body.
        FrictionCompliance: "friction_compliance",
        /// The coatings, replaced by a thin compliant layer: their limit for waves much longer than their thickness.
        CoatingAsLayer: "coating_as_layer",
        /// The attraction between the bodies.
        Adhesion: "adhesion",
        /// The law of friction: the coefficient is that at rest everywhere.
        FrictionLaw: "friction_law",
        /// The yield of a third body, which then carries all that friction does.
        FrictionLayer: "friction_layer",
        /// The relaxation of the bodies, which keep their instantaneous compliance.
        Visco: "visco",
    }
}

impl Omission {
    /// The omissions of a bill: each alone, then the pairs.
    pub fn left_out_of(scene: &Scene<'_>, pairs: bool) -> Vec<Vec<Omission>> {
        let all = Omission::of(scene);
        let mut left_out: Vec<Vec<Omission>> = all.iter().map(|one| vec![*one]).collect();
        for (k, one) in all.iter().enumerate().filter(|_| pairs) {
            let others = all[k + 1..].iter().filter(|other| one.goes_with(**other));
            left_out.extend(others.map(|other| vec![*one, *other]));
        }
        left_out
    }

    /// The omissions that a scene allows.
    pub fn of(scene: &Scene<'_>) -> Vec<Omission> {
        Omission::ALL.into_iter().filter(|omission| omission.is_in(scene)).collect()
    }

    fn is_in(self, scene: &Scene<'_>) -> bool {
        let friction = scene.friction.as_ref();
        match self {
            // Rigid bodies without coatings have no compliance, and coatings on them may be all that relaxes.
            Omission::Coating => may_lose_coating(scene),
            Omission::CoatingAsLayer => may_lose_coating(scene) && as_layer(scene).is_some(),
            Omission::Period => scene.period.is_some_and(|period| period.x || period.y),
            Omission::Patches => scene.patches.is_some(),
            Omission::Layer => scene.layer.is_some(),
            Omission::Adhesion => scene.attraction().is_some(),
            Omission::PressureLimit => scene.pressure_limit.is_some(),
            Omission::Friction => friction.is_some(),
            Omission::Coupling => friction.is_some() && !replace_bodies(scene) && scene.bodies.unlike() != 0.0,
            Omission::Spin => friction.is_some_and(|friction| friction.spin != 0.0),
            Omission::FrictionCompliance => {
                friction.is_some_and(|friction| friction.compliance != Coefficient::Uniform(0.0))
            }
            Omission::FrictionLaw => friction.is_some_and(|friction| friction.law.is_some()),
            Omission::FrictionLayer => friction.is_some_and(|friction| friction.layer.is_some()),
            Omission::Visco => relaxes(scene),
        }
    }

    /// Whether leaving out both differs from leaving out one of them.
    pub fn goes_with(self, other: Omission) -> bool {
        use Omission::{
            Coating, CoatingAsLayer, Coupling, Friction, FrictionCompliance, FrictionLaw, FrictionLayer, Layer, Spin,
        };
        let same = |a: Omission, b: Omission| {
            matches!((a, b), (Coating, CoatingAsLayer) | (Layer, CoatingAsLayer))
                || a == Friction && [Coupling, Spin, FrictionCompliance, FrictionLaw, FrictionLayer].contains(&b)
        };
        self != other && !same(self, other) && !same(other, self)
    }

    /// The scene without the effect.
    pub fn leave_out<'a>(self, scene: &Scene<'a>) -> Scene<'a> {
        let mut left = scene.clone();
        match self {
            Omission::Coating => left.coating = None,
            Omission::CoatingAsLayer => {
                left.layer = as_layer(scene);
                left.coating = None;
            }
            Omission::Period => left.period = None,
            // Elements in no patch still have no surface.
            Omission::Patches => left.patches = None,
            Omission::Layer => left.layer = None,
            Omission::Adhesion => left.adhesion = None,
            Omission::PressureLimit => left.pressure_limit = None,
            Omission::Friction => left.friction = None,
            Omission::Coupling => left.bodies = alike(&scene.bodies),
            Omission::Spin => left.friction = scene.friction.map(|friction| Friction { spin: 0.0, ..friction }),
            Omission::FrictionCompliance => {
                let without = |friction| Friction { compliance: Coefficient::Uniform(0.0), ..friction };
                left.friction = scene.friction.map(without);
            }
            Omission::FrictionLaw => left.friction = scene.friction.map(|friction| Friction { law: None, ..friction }),
            Omission::FrictionLayer => {
                left.friction = scene.friction.map(|friction| Friction { layer: None, ..friction });
            }
            Omission::Visco => left.visco = None,
        }
        left
    }
}

fn relaxes(scene: &Scene<'_>) -> bool {
    scene.visco.is_some_and(|visco| visco.relaxes())
}

fn may_lose_coating(scene: &Scene<'_>) -> bool {
    let plain = scene.plain();
    let is_left = scene.bodies.check().is_ok() && !relaxes(scene);
    is_left && scene.coating.is_some_and(|coating| (0..2).any(|body| coating.in_effect(body, &plain).is_some()))
}

/// Like bodies of the same compliance, normal and tangential: the means of 1/G and of nu/G.
fn alike(bodies: &Bodies) -> Bodies {
    let mean = |of: [f64; 2]| 0.5 * (of[0] + of[1]);
    let compliance = mean([0, 1].map(|b| 1.0 / bodies.shear_modulus[b]));
    let ratio = mean([0, 1].map(|b| bodies.poisson_ratio[b] / bodies.shear_modulus[b])) / compliance;
    Bodies::same(1.0 / compliance, ratio.min(0.5))
}

/// Wave number times thickness of a long wave. The error of a thin layer is of this order.
const LONG_WAVE: f64 = 1e-3;

/// The thin layer with the response of the coatings to long waves, together with the scene's layer. None if that layer differs between elements, or
/// if the coatings are stiffer than the bodies.
fn as_layer<'a>(scene: &Scene<'a>) -> Option<Layer<'a>> {
    let there = match scene.layer {
        None => 0.0,
        Some(Layer(Each::Uniform(compliance))) => compliance,
        Some(Layer(Each::PerElement(_))) => return None,
    };
    let (plain, coating) = (scene.plain(), scene.coating?);
    let thickest =
        (0..2).filter_map(|body| coating.in_effect(body, &plain)).map(|layer| layer.thickness).fold(0.0, f64::max);
    let wave_number = LONG_WAVE / thickest;
    // Half-spaces alone have the response 2/(E* k).
    let added = coating.compliance(&plain, wave_number).ok()? - 2.0 * scene.bodies.compliance() / wave_number;
    if added < 0.0 {
        return None;
    }
    Some(Layer(Each::Uniform(there + added)))
}
