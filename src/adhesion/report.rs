//! The results of a solve with adhesion, and the ledger row of a grid.

use super::level::Level;
use super::unknowns::{energies, Measured};
use crate::contact::{largest, Certificate};
use crate::methods::fields;
use crate::progress::{DiscretisationError, Measures, Monitor};

/// The results of a solve with adhesion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// The repulsive force: the sum of contact pressures q dx dy.
    pub repulsive_force: f64,
    /// The adhesive force: the sum of -sigma dx dy, negative.
    pub adhesive_force: f64,
    /// The elastic energy: the sum of 1/2 p u dx dy.
    pub elastic_energy: f64,
    /// The adhesive energy: the sum of -W(e) dx dy, negative.
    pub adhesive_energy: f64,
    /// `||p + sigma(e)||` outside C, relative to `||p||`, or to 1e-3 of `||q||` in C if that is larger.
    pub law_residual: f64,
    /// The range rho of the attraction on the finest grid.
    pub range: f64,
    /// kappa, the largest stiffness of the attraction times an element's influence on itself. Above [`RESOLVED`] elements are too coarse.
    pub resolution: f64,
    /// The part of the sum of sigma that acts on the outermost elements of the grid, except in periodic directions.
    pub border_share: f64,
    /// dF/dapproach. `None`: it was not requested, or the solve failed or was cancelled.
    pub stiffness: Option<f64>,
    /// The stability margin `1 - lambda` (module `stability`): positive in a stable state, 0 at a snap. `None`: it was not requested, or the
    /// solve failed or was cancelled.
    pub stability: Option<f64>,
    /// Whether the bodies have snapped: the branch of the initial state could not be followed, and more than a quarter of the elements in contact
    /// has changed.
    pub jumped: bool,
    /// Whether the cycles were used up before a state under the prescribed pull was found. Then the state is that of the strongest pull found.
    pub is_short: bool,
}

/// The kappa up to which elements resolve the attraction.
pub const RESOLVED: f64 = 0.5;
/// The kappa above which a single element is unstable.
pub const UNSTABLE_KAPPA: f64 = 1.0;
/// The largest part of the attraction on the outermost elements if the grid is large enough.
pub const LARGEST_BORDER_SHARE: f64 = 1e-3;

impl Report {
    /// The report of the state of a grid, without what a request adds.
    pub(super) fn of(level: &Level, measured: &Measured) -> Report {
        let (surface, now, grid) = (&level.surface, &level.now, level.problem.grid);
        let threads = &level.problem.threads;
        let (in_x, in_y) = level.problem.coefficients.repeats(&grid);
        let is_border = |i: usize| grid.is_at_end(i, (in_x || grid.mx == 1, in_y || grid.my == 1));
        let [q, sigma, at_border] = fields::sum(threads, now.u.len(), |i| {
            let sigma = surface.traction(i, surface.distance(i, now));
            let q = if now.contact[i] { now.p.field[i][0] + sigma } else { 0.0 };
            [q, sigma, if is_border(i) { sigma } else { 0.0 }]
        });
        let [elastic, adhesive] = energies(surface, now, threads);
        let area = grid.element_area();
        Report {
            repulsive_force: area * q,
            adhesive_force: -area * sigma,
            elastic_energy: area * elastic,
            adhesive_energy: -area * adhesive,
            law_residual: measured.law,
            range: surface.attraction.range,
            resolution: surface.attraction.resolution(surface.work, level.self_influence()),
            border_share: if sigma > 0.0 { at_border / sigma } else { 0.0 },
            stiffness: None,
            stability: None,
            jumped: false,
            is_short: false,
        }
    }

    /// The bits of [`DiscretisationError`] that are set if elements are too coarse or the grid is too small.
    pub fn untrusted(&self) -> u32 {
        let all = DiscretisationError::FORCE | DiscretisationError::MAX_PRESSURE | DiscretisationError::PRESSURE;
        if self.resolution > RESOLVED || self.border_share > LARGEST_BORDER_SHARE {
            all
        } else {
            0
        }
    }

    /// A message with advice if elements are too coarse.
    pub fn advice(&self) -> Option<String> {
        (self.resolution > RESOLVED).then(|| {
            let factor = self.resolution / RESOLVED;
            format!(
                "the elements are {factor:.3} times too large for the range {:e} of the attraction (kappa is {:.3}): take elements so much \
                 smaller, or a range of at least {:e}",
                self.range, self.resolution, self.range * factor.sqrt()
            )
        })
    }
}

/// The contact pressure q = p + sigma of element i in C, 0 outside.
fn contact_pressure(level: &Level, i: usize) -> f64 {
    let (surface, now) = (&level.surface, &level.now);
    if now.contact[i] {
        now.p.field[i][0] + surface.traction(i, surface.distance(i, now))
    } else {
        0.0
    }
}

/// The results of a grid for the ledger, from its state and residuals.
pub fn measures(level: &Level, measured: &Measured) -> Measures {
    let (surface, now, grid) = (&level.surface, &level.now, level.problem.grid);
    let threads = &level.problem.threads;
    let a0 = level.self_influence();
    // Sums over the elements of |q e|, |p u| and a0 q^2.
    let [work, elastic, own] = fields::sum(threads, now.u.len(), |i| {
        let e = surface.distance(i, now).abs();
        let q = contact_pressure(level, i).abs();
        [if q > 0.0 { q * e } else { 0.0 }, (now.p.field[i][0] * now.u[i][0]).abs(), a0 * q * q]
    });
    let widen = |(least, most): (f64, f64), [p]: &[f64; 1]| (least.min(*p), most.max(*p));
    let (least, most) = now.p.field.iter().fold((f64::INFINITY, f64::NEG_INFINITY), widen);
    let area = grid.element_area();
    Measures {
        certificate: Certificate {
            // A missing force counts as 1 at most, even if all pressures are 0.
            residual: largest([measured.distance, measured.force.min(1.0)]),
            violation: measured.penetration,
            complementarity: if work == 0.0 { 0.0 } else { work / elastic.max(own) },
            min_pressure: least,
        },
        approach: now.approach(),
        force: measured.pressures * area,
        max_pressure: most,
        contact_count: measured.count,
        edge_count: (0..grid.len()).filter(|&i| now.contact[i] && grid.is_at_end(i, (false, false))).count(),
        contact_area: measured.count as f64 * area,
        corrected_area: -1.0,
    }
}

/// Writes the ledger row of a grid.
pub fn close_grid(level: &Level, measured: &Measured, monitor: &mut Monitor<'_>) {
    monitor.add_row(&level.problem.grid, measures(level, measured));
}
