//! Checks before a solve: whether the scene and the options are those of the set-up, the initial guess, and the range of the units.

use super::{Asked, Guess, InitialGuess, Method, Options, SetUp};
use crate::contact::Problem;
use crate::effects;
use crate::error::{invalid, Error, Result};
use crate::powers::LARGEST;
use crate::scene::{Load, Scene};

impl SetUp {
    /// Refuses a solve if the last attempt to set a table of coefficients failed, because then there are none.
    pub fn check_table(&self) -> Result<()> {
        if self.lacks_table {
            return invalid("influence could not be set the last time: set it again".into());
        }
        Ok(())
    }

    /// Refuses a scene or options that differ from the set-up, and options that do not go with the scene's effects or coefficients. The distance and
    /// the size of the load are checked elsewhere.
    pub fn check(&self, scene: &Scene<'_>, options: &Options, problem: &Problem) -> Result<()> {
        self.check_options(options)?;
        scene.check_free_load(options.is_fixed())?;
        self.check_scene(scene, problem)?;
        if options.method == Method::ProjectedCg && !problem.symmetric {
            let message = "method is PROJECTED_CG, but the influence coefficients are not symmetric; AUTO chooses a method that works";
            return Err(Error::Unsupported(message.into()));
        }
        if let Some(name) = effects::without_given_area(scene).filter(|_| options.is_fixed()) {
            return Err(Error::Unsupported(format!(
                "active_set is FIXED, and {name} is given; this version does not solve them together"
            )));
        }
        let (method, effect) = match (options.method, self.without_multigrid) {
            (Method::Multigrid, Some(effect)) => ("MULTIGRID", effect),
            (Method::FullMultigrid, Some(effect)) => ("FULL_MULTIGRID", effect),
            _ => return Ok(()),
        };
        Err(Error::Unsupported(format!(
            "method is {method}, which does not solve scenes with {effect}; AUTO chooses a method that does"
        )))
    }

    /// Refuses a scene whose grid, bodies or effects differ from the set-up. The distance and the load are not checked.
    pub fn check_scene(&self, scene: &Scene<'_>, problem: &Problem) -> Result<()> {
        if let Some(difference) = scene.grid.differs(&problem.grid) {
            return invalid(difference);
        }
        effects::check_effects(scene)?;
        // With the caller's coefficients the elastic constants of the bodies are not used.
        if !problem.given {
            effects::check_bodies(scene)?;
        }
        self.check_table()?;
        self.named.check(scene)?;
        match problem.given && !problem.symmetric {
            true => effects::check_coefficients(scene, &problem.coefficients),
            false => Ok(()),
        }
    }

    /// Refuses invalid options, and those that differ from the set-up.
    pub fn check_options(&self, options: &Options) -> Result<()> {
        options.check()?;
        let (now, then) = (options.cycle, self.options.cycle);
        let numbers = [
            ("pre_sweeps", now.pre_sweeps, then.pre_sweeps),
            ("post_sweeps", now.post_sweeps, then.post_sweeps),
            ("coarsest", now.coarsest, then.coarsest),
            ("threads", options.threads, self.options.threads),
        ];
        if let Some((name, now, then)) = numbers.into_iter().find(|(_, now, then)| now != then) {
            return invalid(format!("{name} is {now}; this solver was set up for {then}"));
        }
        let others = [
            ("smoother", now.smoother != then.smoother),
            ("relaxation", now.relaxation() != then.relaxation()),
            ("precision", options.precision != self.options.precision),
        ];
        if let Some((name, _)) = others.into_iter().find(|(_, differs)| *differs) {
            return invalid(format!("{name} is not that of the set-up: set up another solver for it"));
        }
        Ok(())
    }
}

/// Refuses a guess that is missing, has not one value per element, or is not finite; and a prescribed contact area that is empty.
pub fn guess(Asked { scene, options, guess, .. }: Asked<'_>) -> Result<()> {
    let grid = &scene.grid;
    let is_fixed = options.is_fixed();
    let Some(guess) = guess else {
        return match options.initial_guess {
            _ if is_fixed => invalid("active_set is FIXED, but no contact area is given".into()),
            InitialGuess::Given => invalid("initial_guess is GIVEN, but no pressures and contact area are".into()),
            _ => Ok(()),
        };
    };
    if !is_fixed && options.initial_guess != InitialGuess::Given {
        return Ok(());
    }
    if guess.pressure.len() != grid.len() || guess.contact.len() != grid.len() {
        return invalid(format!(
            "the initial guess has {} pressures and {} contact elements; the grid has {} elements",
            guess.pressure.len(),
            guess.contact.len(),
            grid.len()
        ));
    }
    let has_surface = |(inside, h): (&bool, &f64)| *inside && h.is_finite();
    if is_fixed && !guess.contact.iter().zip(scene.undeformed_distance).any(has_surface) {
        return invalid("active_set is FIXED, but the given contact area is empty, or has no surface".into());
    }
    if is_fixed {
        scene.check_area(Some(guess.contact))?;
    }
    match guess.pressure.iter().find(|p| !p.is_finite()) {
        Some(p) => Err(Error::NotFinite(format!("pressure, the initial guess, holds {p}; it must be finite"))),
        None => Ok(()),
    }
}

/// Refuses units in which pressures, displacements or their squares leave the range of double precision. `largest` is the largest absolute influence
/// coefficient.
pub fn range(asked: Asked<'_>, problem: &Problem, largest: f64) -> Result<()> {
    let (Asked { scene, lowest, .. }, given_area) = (asked, asked.area());
    let influence = problem.self_influence();
    let h = scene.undeformed_distance;
    // The largest |of(h)| on the given contact area.
    let largest_on = |area: Guess<'_>, of: &dyn Fn(f64) -> f64| {
        let on_contact = h.iter().zip(area.contact).filter(|(h, inside)| **inside && h.is_finite());
        on_contact.fold(0.0, |largest: f64, (h, _)| largest.max(of(*h).abs()))
    };
    // Orders of the pressures, of the displacements, and, with a prescribed force, of the distances. The approach is then a mean of h + u, and all h
    // may have a large offset.
    let (pressure, displacement, farthest) = match scene.load {
        Load::Approach(approach) => {
            let depth = match given_area {
                Some(area) => largest_on(area, &|h| h - approach),
                None if lowest.is_finite() => (approach - lowest).max(0.0),
                None => 0.0,
            };
            // A single element with two periods has the coefficient 0; its pressure is at its limit. Without penetration there is no pressure.
            let limit = effects::limits(scene).filter(|_| influence == 0.0).map(|limit| limit.0.at(0));
            let pressure = if depth == 0.0 { 0.0 } else { limit.unwrap_or(depth / influence) };
            (pressure, depth, 0.0)
        }
        Load::Force(force) => {
            let pressure = force.abs() / scene.grid.element_area();
            let farthest = given_area.map_or(lowest.abs(), |area| largest_on(area, &|h| h));
            (pressure, pressure * influence, farthest)
        }
    };
    if pressure != 0.0 && farthest >= LARGEST {
        return invalid(format!(
                "the undeformed distances of the contact area are of order {farthest:e}; with a prescribed force they must lie \
                 below 1e140: choose other units"
            ));
    }
    let in_range = |value: f64| (1.0 / LARGEST..LARGEST).contains(&value);
    let loaded = pressure != 0.0 || displacement != 0.0;
    let displaces_nothing = problem.grid.len() == 1 && problem.coefficients.is_mean_free() && in_range(pressure);
    let coefficients = in_range(influence) && in_range(largest) && in_range(largest * pressure);
    if loaded && !displaces_nothing && !(in_range(pressure) && in_range(displacement) && coefficients) {
        return invalid(format!(
                "the scene has pressures of order {pressure:e}, displacements of order {displacement:e} and influence \
                 coefficients of order {influence:e} to {largest:e}; all must lie between 1e-140 and 1e140: choose other units"
            ));
    }
    areas(scene, pressure, loaded)
}

/// Refuses units in which the area of an element or the force leaves the range of double precision. [`range`] does not imply this: the caller's
/// coefficients do not depend on the sizes of elements.
fn areas(scene: &Scene<'_>, pressure: f64, loaded: bool) -> Result<()> {
    let area = scene.grid.element_area();
    let force = match scene.load {
        Load::Force(force) => force.abs(),
        Load::Approach(_) => area * pressure,
    };
    let in_range = |value: f64| (1e-290..1e290).contains(&value);
    if (loaded || force != 0.0) && !(in_range(area) && in_range(force)) {
        return invalid(format!(
            "elements have an area of order {area:e}, and the force is of order {force:e}; both must lie between 1e-290 and 1e290: choose other units"
        ));
    }
    Ok(())
}
