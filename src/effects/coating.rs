//! Effect: a coating. It is a bonded elastic layer of finite thickness on one body or on both. [`Coated`] has the influence coefficients.

use std::f64::consts::PI;
use std::sync::Arc;

use super::properties::{Properties, Stresses, HALF_SPACE_ALONE};
use super::{Effect, Value};
use crate::error::{invalid, positive, require, Error, Number, Result};
use crate::grid::Grid;
use crate::influence::{radial, Coat, Coated, CoatedBody, CoatedPeriodic, Kernel};
use crate::scene::{Bodies, Plain};

/// The largest ratio of a coating's shear modulus to that of the substrate.
const STIFFEST: f64 = 1e4;
/// Below this ratio of the layer's shear modulus to the substrate's, the substrate counts as rigid. An almost incompressible layer on a rigid
/// substrate yields by shear only.
const RIGID_RATIO: f64 = 1e-4;
/// The smallest thickness of an almost incompressible layer on a rigid substrate, relative to the longer side of an element.
const THINNEST: f64 = 0.125;
/// Up to this thickness, relative to the shorter side of an element, a layer counts as none.
const LEAST_THICKNESS: f64 = 1e-100;

/// A bonded elastic layer on a body. The shear modulus and the Poisson ratio of the body are then those of the substrate, which may be rigid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoatingLayer {
    /// The thickness t, a length. 0: no coating.
    pub thickness: f64,
    /// The shear modulus G of the layer.
    pub shear_modulus: f64,
    /// The Poisson ratio nu of the layer, in (-1, 0.5].
    pub poisson_ratio: f64,
}

/// The coatings of body 1 and of body 2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coating {
    /// None: the body has no coating.
    pub layers: [Option<CoatingLayer>; 2],
}

/// The names in messages of the thickness, the shear modulus and the Poisson ratio of each coating.
const NAMES: [[&str; 3]; 2] = [
    ["coating[0]->thickness", "coating[0]->shear_modulus", "coating[0]->poisson_ratio"],
    ["coating[1]->thickness", "coating[1]->shear_modulus", "coating[1]->poisson_ratio"],
];

impl Coating {
    /// A coating of body 1 alone.
    pub fn of_body_1(thickness: f64, shear_modulus: f64, poisson_ratio: f64) -> Coating {
        Coating { layers: [Some(CoatingLayer { thickness, shear_modulus, poisson_ratio }), None] }
    }

    /// The coating of body `b`. None: the coating has no thickness, or its constants are those of the substrate.
    pub fn in_effect(&self, b: usize, scene: &Plain<'_>) -> Option<CoatingLayer> {
        let (modulus, ratio) = (scene.bodies.shear_modulus[b], scene.bodies.poisson_ratio[b]);
        let is_none = |layer: &CoatingLayer| {
            layer.thickness <= LEAST_THICKNESS * f64::min(scene.grid.dx, scene.grid.dy)
                || (layer.shear_modulus == modulus && layer.poisson_ratio == ratio)
        };
        self.layers[b].filter(|layer| !is_none(layer))
    }

    /// The compliance of body `b` with its coating.
    fn body(&self, b: usize, scene: &Plain<'_>) -> Result<CoatedBody> {
        let (modulus, ratio) = (scene.bodies.shear_modulus[b], scene.bodies.poisson_ratio[b]);
        let plain = CoatedBody { compliance: (1.0 - ratio) / (2.0 * PI * modulus), layer: None };
        let Some(layer) = self.in_effect(b, scene) else { return Ok(plain) };
        let CoatingLayer { thickness, shear_modulus, poisson_ratio } = layer;
        let mu = self.ratio(b, scene)?;
        let compliance = (1.0 - poisson_ratio) / (2.0 * PI * shear_modulus);
        Ok(CoatedBody { compliance, layer: Some((thickness, radial(mu, [poisson_ratio, ratio]))) })
    }

    /// Refuses a layer that yields only by shear, and only under pressure waves that are shorter than the elements. Pressures that are constant on
    /// elements do not excite such waves.
    fn check_thickness(&self, b: usize, (scene, body): (&Plain<'_>, &CoatedBody)) -> Result<()> {
        let Some((t, radial)) = &body.layer else { return Ok(()) };
        let longer = f64::max(scene.grid.dx, scene.grid.dy);
        let (s, transfer) = (PI * t / longer, &radial.transfer);
        // A thin layer has a term of the substrate, one of the compression of the layer (proportional to s), and one of its shear (to s^3).
        let is_sheared = transfer.substrate + transfer.of_mean * s < 2.0 / 3.0 * s.powi(3) || transfer.of_mean == 0.0;
        if self.ratio(b, scene)? < RIGID_RATIO && *t < THINNEST * longer && is_sheared {
            let [thickness, dx, dy] = [*t, scene.grid.dx, scene.grid.dy].map(Number);
            return invalid(format!(
                "{} is {thickness} on elements {dx} x {dy}; a layer that is almost incompressible, on a body that is rigid beside it, must be at \
                 least {THINNEST} of the longer side: take smaller elements",
                NAMES[b][0]
            ));
        }
        Ok(())
    }

    /// The ratio of the layer's shear modulus to that of the body below: 0 on a rigid body. Refuses ratios above [`STIFFEST`].
    fn ratio(&self, b: usize, scene: &Plain<'_>) -> Result<f64> {
        let (modulus, below) = (self.layers[b].map_or(1.0, |layer| layer.shear_modulus), scene.bodies.shear_modulus[b]);
        match modulus / below {
            mu if mu <= STIFFEST => Ok(mu),
            _ => invalid(format!(
                "{} is {}, that of the body {}; their ratio must be at most {STIFFEST:e}",
                NAMES[b][1],
                Number(modulus),
                Number(below)
            )),
        }
    }

    /// The compliances of both bodies with their coatings. None: no coating is in effect.
    pub fn bodies(&self, scene: &Plain<'_>) -> Result<Option<[CoatedBody; 2]>> {
        let bodies = [self.body(0, scene)?, self.body(1, scene)?];
        Ok(bodies.iter().any(|body| body.layer.is_some()).then_some(bodies))
    }
}

impl Coating {
    /// The coating that both bodies have, for the influence coefficients of tractions. None: no coating is in effect.
    pub fn of_both(&self, scene: &Plain<'_>) -> Result<Option<Coat>> {
        let Some(layer) = self.in_effect(0, scene) else { return Ok(None) };
        let nu = [layer.poisson_ratio, scene.bodies.poisson_ratio[0]];
        Ok(Some(Coat::new(layer.thickness, self.ratio(0, scene)?, nu)))
    }

    /// A text that names the first difference between both bodies. None: their layers and substrates are the same.
    fn difference(&self, scene: &Plain<'_>) -> Option<String> {
        let (one, two) = match [0, 1].map(|b| self.in_effect(b, scene)) {
            [None, None] => return None,
            [Some(one), Some(two)] => (one, two),
            [one, _] => return Some(format!("coating[{}] is none", usize::from(one.is_some()))),
        };
        let Bodies { shear_modulus: g, poisson_ratio: nu } = scene.bodies;
        let pairs = [
            (NAMES[0][0], NAMES[1][0], [one.thickness, two.thickness]),
            (NAMES[0][1], NAMES[1][1], [one.shear_modulus, two.shear_modulus]),
            (NAMES[0][2], NAMES[1][2], [one.poisson_ratio, two.poisson_ratio]),
            ("shear_modulus[0]", "shear_modulus[1]", g),
            ("poisson_ratio[0]", "poisson_ratio[1]", nu),
        ];
        let differ = pairs.into_iter().find(|(_, _, [one, two])| one != two);
        differ.map(|(first, second, [one, two])| format!("{first} is {} and {second} {}", Number(one), Number(two)))
    }

    /// The elastic constants at the surfaces: those of the coating where there is one, otherwise those of the body.
    pub fn at_surface(&self, scene: &Plain<'_>) -> Bodies {
        let mut bodies = scene.bodies;
        for b in 0..2 {
            if let Some(layer) = self.in_effect(b, scene) {
                (bodies.shear_modulus[b], bodies.poisson_ratio[b]) = (layer.shear_modulus, layer.poisson_ratio);
            }
        }
        bodies
    }

    /// The displacement of both bodies together by a pressure wave of amplitude 1 and wave number k > 0. Refuses invalid constants.
    pub fn compliance(&self, scene: &Plain<'_>, k: f64) -> Result<f64> {
        self.check(&scene.grid)?;
        scene.bodies.check_each()?;
        self.at_surface(scene).check()?;
        Ok((self.body(0, scene)?.of_wave(k)) + self.body(1, scene)?.of_wave(k))
    }
}

impl Effect for Coating {
    fn name(&self) -> &'static str {
        "coating"
    }

    fn properties(&self) -> Properties<'_> {
        Properties {
            excludes: &["influence", "row_tables"],
            without_multigrid: None,
            with_given_area: true,
            one_grid: None,
            own_coefficients: None,
            repeats: (false, false),
            limits: None,
            is_beside: false,
            continues: None,
        }
    }

    fn check(&self, _grid: &Grid) -> Result<()> {
        for (layer, [t, g, nu]) in self.layers.iter().zip(NAMES) {
            let Some(layer) = layer else { continue };
            let (thickness, modulus, ratio) = (layer.thickness, layer.shear_modulus, layer.poisson_ratio);
            let holds = thickness >= 0.0 && thickness.is_finite();
            require(holds, t, thickness, "a thickness must be finite and not negative")?;
            positive(g, modulus)?;
            require(ratio > -1.0 && ratio <= 0.5, nu, ratio, "it must lie in (-1, 0.5]")?;
        }
        Ok(())
    }

    // `!(ratio >= 0.5)` is true for NaN, which `check` refuses.
    fn gives_way(&self, scene: &Plain<'_>) -> bool {
        (0..2).filter_map(|b| self.in_effect(b, scene)).any(|layer| !(layer.poisson_ratio >= 0.5))
    }

    // If the coated bodies differ, tractions displace their surfaces along the normal in a way for which the library has no coefficients.
    fn check_tractions(&self, scene: &Plain<'_>) -> Result<()> {
        // Invalid constants are refused elsewhere, with a better message.
        let is_checked = self.check(&scene.grid).is_ok() && scene.bodies.check_each().is_ok();
        match self.difference(scene).filter(|_| is_checked) {
            Some(difference) => Err(Error::Unsupported(format!(
                "friction and coating are both given, and {difference}; this version solves them together where both bodies are the same, \
                 with the same coating, or with tangential tables of your own (friction->influence)"
            ))),
            None => Ok(()),
        }
    }

    fn kernel(&self, scene: &Plain<'_>, others: &[Option<&dyn Effect>]) -> Result<Option<Arc<dyn Kernel>>> {
        let Some(bodies) = self.bodies(scene)? else { return Ok(None) };
        (0..2).try_for_each(|b| self.check_thickness(b, (scene, &bodies[b])))?;
        let repeats = others.iter().flatten().map(|other| other.properties().repeats).find(|(x, y)| *x || *y);
        Ok(Some(match repeats {
            None => Arc::new(Coated::new(bodies, &scene.grid)?),
            Some((true, true)) => Arc::new(CoatedPeriodic::new(bodies, &scene.grid)?),
            Some(_) => {
                return Err(Error::Unsupported(
                    "coating and a period in one direction are both given; this version does not solve them together"
                        .into(),
                ))
            }
        }))
    }

    fn values(&self, tell: &mut dyn FnMut(&'static str, Value<'_>)) {
        let layers = self.layers.map(|layer| layer.filter(|layer| layer.thickness > 0.0));
        if layers == [None, None] {
            return;
        }
        // Of a body without a coating the thickness 0 is recorded, so that a later scene cannot add a coating.
        for (layer, [t, g, nu]) in layers.into_iter().zip(NAMES) {
            tell(t, Value::Number(layer.map_or(0.0, |layer| layer.thickness)));
            if let Some(layer) = layer {
                tell(g, Value::Number(layer.shear_modulus));
                tell(nu, Value::Number(layer.poisson_ratio));
            }
        }
    }

    // A layer without thickness, or with the constants of the body below, is no coating.
    fn is_one(&self, scene: &Plain<'_>) -> bool {
        (0..2).any(|b| self.in_effect(b, scene).is_some()) || self.check(&scene.grid).is_err()
    }

    fn at_surface(&self, scene: &Plain<'_>) -> Option<Bodies> {
        Some(Coating::at_surface(self, scene))
    }

    fn stresses(&self, b: usize, scene: &Plain<'_>) -> Stresses<'_> {
        match self.in_effect(b, scene) {
            Some(_) => Stresses::Unknown(HALF_SPACE_ALONE),
            None => Stresses::Same,
        }
    }
}
