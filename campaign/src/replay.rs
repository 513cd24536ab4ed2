//! Makes a case from the dump of a call (`options->dump`), solves it and checks the result.

use contact_normal::ffi::dump::Dump;
use contact_normal::ffi::*;

use crate::call;
use crate::case::{Case, How};
use crate::coating::{Coating, Layer};
use crate::effects::{Definiteness, Effects, Patches, UserCoefficients, Values};
use crate::grid::{Grid, Load};
use crate::run::Run;
use crate::verdict::Verdict;
use crate::{rules, surface};

/// Solves the scene of a dump again, from the same initial guess, and checks the result.
pub fn run(dump: &Dump) -> Result<Run, String> {
    let case = case(dump)?;
    let found = call::solve(&case);
    let mut verdict: Verdict = rules::check(&case, &found);
    let again = call::solve(&case).bits() == found.bits();
    verdict.unless(again, "the same call twice has the same bits", String::new);
    Ok(Run { case, statuses: vec![found.status], beside: None, verdict, products: None, seconds: 0.0 })
}

/// The case of a dump. Scenes with friction are refused.
fn case(dump: &Dump) -> Result<Case, String> {
    let scene = dump.scene().ok_or("there is no scene")?;
    let read = Reader(dump);
    if !scene.friction.is_null() {
        return Err("the scene has friction: contact-normal-replay makes its call again, but no oracle reads it".into());
    }
    let size = |name: &str, m: i32| usize::try_from(m).ok().filter(|m| *m > 0).ok_or(format!("{name} is {m}"));
    let grid = Grid { mx: size("mx", scene.mx)?, my: size("my", scene.my)?, dx: scene.dx, dy: scene.dy };
    let h = read.doubles("undeformed_distance", scene.undeformed_distance, Some(grid.len()))?;
    let load = match scene.load {
        CONTACT_NORMAL_PRESCRIBED_FORCE => Load::Force(scene.force),
        _ => Load::Approach(scene.approach),
    };
    Ok(Case {
        seed: 0,
        grid,
        shear_modulus: scene.shear_modulus,
        poisson_ratio: scene.poisson_ratio,
        surface: format!("{} of a dump", dump.call()),
        surfaces: surface::any,
        h,
        h_rounding: 0.0,
        load,
        effects: read.effects(scene, &grid)?,
        how: read.how(&grid)?,
        through_handle: false,
        is_measured: true,
    })
}

/// Reads the arrays and structs of a dump.
struct Reader<'a>(&'a Dump);

impl Reader<'_> {
    /// The array of `count` doubles at an address of the scene; `name` is for messages.
    fn doubles(&self, name: &str, at: *const f64, count: Option<usize>) -> Result<Vec<f64>, String> {
        let values = count.and_then(|count| self.0.doubles_at(at, count));
        values.ok_or_else(|| format!("{name} is not in the file, or shorter than the grid asks for"))
    }

    /// The array of `count` integers at an address of the scene; `name` is for messages.
    fn integers(&self, name: &str, at: *const i32, count: usize) -> Result<Vec<i32>, String> {
        self.0.integers_at(at, count).ok_or_else(|| format!("{name} is not in the file, or shorter than it should be"))
    }

    /// The value `one` for all elements or, if `each` is not NULL, an array with one value for each element.
    fn values(&self, name: &str, one: f64, each: *const f64, grid: &Grid) -> Result<Values, String> {
        if each.is_null() {
            return Ok(Values::Uniform(one));
        }
        Ok(Values::PerElement(self.doubles(name, each, Some(grid.len()))?))
    }

    /// The effects of the scene.
    fn effects(&self, scene: &contact_normal_scene, grid: &Grid) -> Result<Effects, String> {
        let mut effects = Effects::default();
        // SAFETY (all): NULL, or structs of the dump.
        let (influence, row_tables, layer, limit, period, patches) = unsafe {
            let (influence, row_tables) = (scene.influence.as_ref(), scene.row_tables.as_ref());
            let (layer, limit) = (scene.layer.as_ref(), scene.pressure_limit.as_ref());
            (influence, row_tables, layer, limit, scene.period.as_ref(), scene.patches.as_ref())
        };
        if let Some(layer) = layer {
            effects.layer = Some(self.values("layer", layer.compliance, layer.compliances, grid)?);
        }
        if let Some(limit) = limit {
            effects.limit = Some(self.values("pressure_limit", limit.limit, limit.limits, grid)?);
        }
        effects.period = period.map(|period| (period.x != 0, period.y != 0));
        if let Some(patches) = patches {
            let count = usize::try_from(patches.count).unwrap_or(0);
            let factors = self.doubles("patches->factors", patches.factors, count.checked_mul(count))?;
            let patch = self.integers("patches->patch", patches.patch, grid.len())?;
            effects.patches = Some(Patches { count, patch, factors });
        }
        if let Some(table) = influence {
            let (cx, cy) = (table.cx.max(0) as usize, table.cy.max(0) as usize);
            effects.influence =
                Some(self.user_coefficients("influence", table.coefficients, table.scale, (cx, cy, cx * cy * 4))?);
        }
        if let Some(tables) = row_tables {
            let (cx, rows) = (tables.cx.max(0) as usize, tables.rows.max(0) as usize);
            effects.row_tables = Some(self.user_coefficients(
                "row_tables",
                tables.coefficients,
                tables.scale,
                (cx, rows, rows * rows * cx * 2),
            )?);
        }
        if let Some(values) = self.0.doubles("handle.influence") {
            effects.influence = Some(UserCoefficients { cx: grid.mx, cy: grid.my, values });
        }
        if let Some(values) = self.0.doubles("handle.row_tables") {
            effects.row_tables = Some(UserCoefficients { cx: grid.mx, cy: grid.my, values });
        }
        // The campaign does not decide whether the coefficients of a dump are those of an elastic body. So failures of the solver are excused.
        if effects.influence.is_some() || effects.row_tables.is_some() {
            effects.definiteness = Definiteness::Unsymmetric;
        }
        effects.coating = coating(scene);
        Ok(effects)
    }

    /// The coefficients of a table, or of row tables, times their scale.
    fn user_coefficients(
        &self,
        name: &str,
        at: *const f64,
        scale: f64,
        (cx, cy, count): (usize, usize, usize),
    ) -> Result<UserCoefficients, String> {
        let values = self.doubles(name, at, Some(count))?;
        Ok(UserCoefficients { cx, cy, values: values.iter().map(|value| scale * value).collect() })
    }

    /// The options of the call.
    fn how(&self, grid: &Grid) -> Result<How, String> {
        let options = self.0.options().copied().unwrap_or_default();
        // SAFETY: NULL, or a struct of the dump.
        let cycle = unsafe { options.cycle.as_ref() }.copied().unwrap_or_default();
        let fields = self.0.fields().copied().unwrap_or_default();
        let given = match options.initial_guess {
            CONTACT_NORMAL_INITIAL_GUESS_GIVEN => {
                Some(self.doubles("fields->pressure", fields.pressure, Some(grid.len()))?)
            }
            CONTACT_NORMAL_INITIAL_GUESS_PREVIOUS => self.0.doubles("handle.pressure"),
            _ => None,
        };
        let fixed = match options.active_set {
            CONTACT_NORMAL_ACTIVE_SET_FIXED => Some(self.integers("fields->contact", fields.contact, grid.len())?),
            _ => None,
        };
        Ok(How {
            method: options.method,
            smoother: cycle.smoother,
            criterion: options.criterion,
            tolerance: options.tolerance,
            precision: options.precision,
            threads: options.threads,
            coarsest: cycle.coarsest,
            max_cycles: options.max_cycles,
            cancel_at: None,
            fixed,
            given,
        })
    }
}

/// The coating of a scene, if it has one.
fn coating(scene: &contact_normal_scene) -> Option<Coating> {
    // SAFETY: NULL, or structs of the dump.
    let layers = scene.coating.map(|layer| unsafe { layer.as_ref() });
    let layers = layers.map(|layer| {
        layer.map(|layer| Layer {
            thickness: layer.thickness,
            shear_modulus: layer.shear_modulus,
            poisson_ratio: layer.poisson_ratio,
        })
    });
    let (shear_modulus, poisson_ratio) = (scene.shear_modulus, scene.poisson_ratio);
    layers.iter().any(Option::is_some).then_some(Coating { layers, shear_modulus, poisson_ratio })
}
