//! Omissions: what a bill leaves out of a scene. These are the effects of the scene, and parts of effects: the coupling by unlike bodies, the spin, a
//! friction law.

use std::mem::{replace, take};

use crate::effects::replace_bodies;
use crate::scene::{Bodies, Coefficient, Each, Layer, Scene};
use crate::solver::numbered::numbered;

numbered! {
    /// An effect, or a part of one, that is left out or replaced by a simpler one. The comment of a variant tells what is left out; and, after a
    /// colon, what remains.
    Omission {
        /// The coatings: the bodies have the substrate's material up to their surface.
        Coating = 1: "coating",
        /// The periodic repetition: the scene is alone on a half-space.
        Period: "period",
        /// The patches: pressures displace all elements as on a half-space.
        Patches: "patches",
        /// The thin compliant layer.
        Layer: "layer",
        /// The limit of pressures.
        PressureLimit: "pressure_limit",
        /// Friction, and with it the displacements along the normal by the tractions of unlike bodies.
        Friction: "friction",
        /// The coupling of tractions and pressures of unlike bodies: like bodies of the same compliances replace them.
        Coupling: "coupling",
        /// The spin.
        Spin: "spin",
        /// The tangential compliance of a third body.
        FrictionCompliance: "friction_compliance",
        /// The coatings: a thin compliant layer replaces them, which has their response to waves much longer than their thickness.
        CoatingAsLayer: "coating_as_layer",
        /// The attraction between the bodies.
        Adhesion: "adhesion",
        /// The law of friction: the coefficient is that at rest everywhere.
        FrictionLaw: "friction_law",
        /// The yield of a third body: friction alone bounds the tractions.
        FrictionLayer: "friction_layer",
        /// The relaxation of the bodies: they keep their instantaneous compliance.
        Visco: "visco",
    }
}

impl Omission {
    /// What a bill leaves out: each omission that the scene allows alone, then, if `pairs`, each two of them.
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
        Omission::ALL.into_iter().filter(|omission| omission.without(scene).0).collect()
    }

    /// Whether two omissions can be left out together, and this differs from leaving out one of them.
    pub fn goes_with(self, other: Omission) -> bool {
        use Omission::{
            Coating, CoatingAsLayer, Coupling, Friction, FrictionCompliance, FrictionLaw, FrictionLayer, Layer, Spin,
        };
        // Whether `a` includes `b`, or excludes it.
        let covers = |a: Omission, b: Omission| {
            matches!((a, b), (Coating, CoatingAsLayer) | (Layer, CoatingAsLayer))
                || a == Friction && [Coupling, Spin, FrictionCompliance, FrictionLaw, FrictionLayer].contains(&b)
        };
        self != other && !covers(self, other) && !covers(other, self)
    }

    /// The scene with this omission.
    pub fn leave_out<'a>(self, scene: &Scene<'a>) -> Scene<'a> {
        self.without(scene).1
    }

    /// Whether the scene allows this omission (it has the effect), and the scene with the omission.
    fn without<'a>(self, scene: &Scene<'a>) -> (bool, Scene<'a>) {
        let mut left = scene.clone();
        let none = Coefficient::Uniform(0.0);
        let is_allowed = match self {
            Omission::Coating => {
                left.coating = None;
                may_lose_coating(scene)
            }
            Omission::CoatingAsLayer => {
                (left.coating, left.layer) = (None, as_layer(scene));
                may_lose_coating(scene) && left.layer.is_some()
            }
            Omission::Period => left.period.take().is_some_and(|period| period.x || period.y),
            // Elements in no patch still have no surface.
            Omission::Patches => left.patches.take().is_some(),
            Omission::Layer => left.layer.take().is_some(),
            Omission::Adhesion => left.adhesion.take().is_some_and(|adhesion| adhesion.attracts()),
            Omission::PressureLimit => left.pressure_limit.take().is_some(),
            Omission::Friction => left.friction.take().is_some(),
            Omission::Coupling => {
                left.bodies = alike(&scene.bodies);
                scene.friction.is_some() && !replace_bodies(scene) && scene.bodies.unlike() != 0.0
            }
            Omission::Spin => left.friction.as_mut().is_some_and(|friction| take(&mut friction.spin) != 0.0),
            Omission::FrictionCompliance => {
                left.friction.as_mut().is_some_and(|friction| replace(&mut friction.compliance, none) != none)
            }
            Omission::FrictionLaw => left.friction.as_mut().is_some_and(|friction| friction.law.take().is_some()),
            Omission::FrictionLayer => left.friction.as_mut().is_some_and(|friction| friction.layer.take().is_some()),
            Omission::Visco => left.visco.take().is_some_and(|visco| visco.relaxes()),
        };
        (is_allowed, left)
    }
}

/// Whether the scene has coatings and stays valid without them. It does not if the bodies are rigid, as nothing is then elastic without coatings; nor
/// if bodies relax, as the relaxing part may be the coatings.
fn may_lose_coating(scene: &Scene<'_>) -> bool {
    let plain = scene.plain();
    let relaxes = scene.visco.is_some_and(|visco| visco.relaxes());
    let stays_valid = scene.bodies.check().is_ok() && !relaxes;
    stays_valid && scene.coating.is_some_and(|coating| (0..2).any(|body| coating.in_effect(body, &plain).is_some()))
}

/// Like bodies with the same normal and tangential compliance as `bodies`: with the means of 1/G and of nu/G of both.
fn alike(bodies: &Bodies) -> Bodies {
    let mean = |of: [f64; 2]| 0.5 * (of[0] + of[1]);
    let compliance = mean([0, 1].map(|b| 1.0 / bodies.shear_modulus[b]));
    let ratio = mean([0, 1].map(|b| bodies.poisson_ratio[b] / bodies.shear_modulus[b])) / compliance;
    Bodies::same(1.0 / compliance, ratio.min(0.5))
}

/// Wave number times thickness of the coatings, for the wave whose response the thin layer gets. The relative error of the limit of long waves is of
/// this order.
const LONG_WAVE: f64 = 1e-3;

/// The thin compliant layer that has the response of the coatings to long waves, plus the scene's own layer. None if the scene's layer differs
/// between elements, or if the coatings are stiffer than the bodies.
fn as_layer<'a>(scene: &Scene<'a>) -> Option<Layer<'a>> {
    let of_layer = match scene.layer {
        None => 0.0,
        Some(Layer(Each::Uniform(compliance))) => compliance,
        Some(Layer(Each::PerElement(_))) => return None,
    };
    let (plain, coating) = (scene.plain(), scene.coating?);
    let thickest =
        (0..2).filter_map(|body| coating.in_effect(body, &plain)).map(|layer| layer.thickness).fold(0.0, f64::max);
    let wave_number = LONG_WAVE / thickest;
    // Half-spaces alone have the response 2/(E* k).
    let of_coatings = coating.compliance(&plain, wave_number).ok()? - 2.0 * scene.bodies.compliance() / wave_number;
    if of_coatings < 0.0 {
        return None;
    }
    Some(Layer(Each::Uniform(of_layer + of_coatings)))
}
