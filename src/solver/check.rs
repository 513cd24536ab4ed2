//! Checks before a solve: scenes that differ from the set-up, invalid guesses, units out of range.

use super::{Asked, Guess, InitialGuess, Method, Options, SetUp};
use crate::contact::Problem;
use crate::effects;
use crate::error::{invalid, Error, Result};
use crate::powers::LARGEST;
use crate::scene::{Load, Scene};

impl SetUp {
    /// Rejects a solve after a table could not be set.
    pub fn check_table(&self) -> Result<()> {
        if self.lacks_table {
            return invalid("influence could not be set the last time: set it again".into());
        }
        Ok(())
    }

    /// Rejects a scene or options that differ from the set-up, and unsupported combinations of effects. Distance and load were checked before.
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

    /// Rejects a scene whose grid, bodies or effects differ from the set-up. Its distance and its load are not checked.
    pub fn check_scene(&self, scene: &Scene<'_>, problem: &Problem) -> Result<()> {
        if let Some(difference) = scene.grid.differs(&problem.grid) {
            return invalid(difference);
        }
        effects::check_effects(scene)?;
        // With the caller's coefficients bodies are not used.
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

    /// Rejects options that differ from the set-up.
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

/// Rejects a guess that is missing, too short or not finite.
pub fn guess(Asked { scene, options, guess, .. }: Asked<'_>) -> Result<()> {
    let grid = &scene.grid;
    let fixed = options.is_fixed();
    let Some(guess) = guess else {
        return match options.initial_guess {
            _ if fixed => invalid("active_set is FIXED, but no contact area is given".into()),
            InitialGuess::Given => invalid("initial_guess is GIVEN, but no pressures and contact area are".into()),
            _ => Ok(()),
        };
    };
    if !fixed && options.initial_guess != InitialGuess::Given {
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
    let surface = |(inside, h): (&bool, &f64)| *inside && h.is_finite();
    if fixed && !guess.contact.iter().zip(scene.undeformed_distance).any(surface) {
        return invalid("active_set is FIXED, but the given contact area is empty, or has no surface".into());
    }
    if fixed {
        scene.check_area(Some(guess.contact))?;
    }
    match guess.pressure.iter().find(|p| !p.is_finite()) {
        Some(p) => Err(Error::NotFinite(format!("pressure, the initial guess, holds {p}; it must be finite"))),
        None => Ok(()),
    }
}

/// Rejects units in which pressures, displacements or their squares leave the range of double precision. `largest`: the largest absolute coefficient.
pub fn range(asked: Asked<'_>, problem: &Problem, largest: f64) -> Result<()> {
    let (Asked { scene, lowest, .. }, fixed) = (asked, asked.area());
    let influence = problem.self_influence();
    let h = scene.undeformed_distance;
    // The largest absolute value on the given contact area.
    let largest_on = |fixed: Guess<'_>, of: &dyn Fn(f64) -> f64| {
        let on_contact = h.iter().zip(fixed.contact).filter(|(h, inside)| **inside && h.is_finite());
        on_contact.fold(0.0, |largest: f64, (h, _)| largest.max(of(*h).abs()))
    };
    // With a prescribed force the approach is a mean of distances, which may have any offset.
    let (pressure, displacement, farthest) = match scene.load {
        Load::Approach(approach) => {
            let depth = match fixed {
                Some(fixed) => largest_on(fixed, &|h| h - approach),
                None if lowest.is_finite() => (approach - lowest).max(0.0),
                None => 0.0,
            };
            // A single element with two periods has the coefficient 0 and carries its limit. Without penetration there is no pressure.
            let limit = effects::limits(scene).filter(|_| influence == 0.0).map(|limit| limit.0.at(0));
            let pressure = if depth == 0.0 { 0.0 } else { limit.unwrap_or(depth / influence) };
            (pressure, depth, 0.0)
        }
        Load::Force(force) => {
            let pressure = force.abs() / scene.grid.element_area();
            let farthest = fixed.map_or(lowest.abs(), |fixed| largest_on(fixed, &|h| h));
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

/// Rejects units in which areas of elements and forces leave the range of double precision. The caller's coefficients do not bound the sizes of
/// elements.
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
