//! One element under a law: its bound as a function of the slip and of the particle's state, and the slip of a traction.

use crate::effects::{FrictionLaw, PlasticLayer};

/// Least yield limit by softening, relative to that of fresh material.
const LEAST_YIELD_LIMIT: f64 = 1e-3;
/// Least coefficient, relative to that at rest.
const LEAST_COEFFICIENT: f64 = 1e-9;
/// Most steps of the bracketed search for a slip, and its relative precision.
const STEPS: u32 = 80;
const PRECISION: f64 = 1e-14;

/// The state of a particle of the interface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Particle {
    /// The coefficient of friction.
    pub coefficient: f64,
    /// The yield limit, a traction.
    pub yield_limit: f64,
}

/// The law of a step in the units of the iterations.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    pub fall: Option<FrictionLaw>,
    pub layer: Option<PlasticLayer>,
    /// The slip velocity of a slip of 1, in the caller's units.
    pub rate: f64,
    /// The duration of a step, in the caller's units.
    pub duration: f64,
}

/// An element: its pressure, and its coefficient at rest.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub pressure: f64,
    pub coefficient: f64,
}

/// Derivatives by the slip, and by the coefficient and the yield limit of the particle before the step.
type Slope = [f64; 3];

/// The bound, and the particle afterwards, with their derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub struct Response {
    pub bound: f64,
    pub slope: Slope,
    pub particle: Particle,
    /// The derivatives of the particle's coefficient and yield limit.
    pub slopes: [Slope; 2],
    /// Whether the layer bounds the traction.
    pub yields: bool,
}

/// The response of an element to a traction that slip relieves.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resolved {
    pub slips: bool,
    pub response: Response,
    /// Derivatives of the bound, the coefficient and the yield limit by the traction and by the particle's state before the step.
    pub linear: [Slope; 3],
}

impl Law {
    /// The coefficient of friction at a slip, and its derivatives.
    fn coefficient(&self, slip: f64, coefficient: f64, had: Particle) -> (f64, Slope) {
        let (mut mu, mut of_mu) = (coefficient, [0.0; 3]);
        if let Some(law) = &self.fall {
            let v = slip * self.rate;
            let (value, slope) = law.at(v);
            let (steady, by_slip) = (coefficient * value, coefficient * slope * self.rate);
            let c = law.memory_distance;
            if c > 0.0 {
                let whole = c + self.duration * v.max(law.memory_speed);
                let kept = c / whole;
                let of_kept = if v > law.memory_speed { -c * self.duration / (whole * whole) * self.rate } else { 0.0 };
                mu = kept * had.coefficient + (1.0 - kept) * steady;
                of_mu = [(1.0 - kept) * by_slip + of_kept * (had.coefficient - steady), kept, 0.0];
            } else {
                (mu, of_mu) = (steady, [by_slip, 0.0, 0.0]);
            }
        }
        if mu < LEAST_COEFFICIENT * coefficient {
            (mu, of_mu) = (LEAST_COEFFICIENT * coefficient, [0.0; 3]);
        }
        (mu, of_mu)
    }

    /// The response at a slip, from the particle's state `had` before the step.
    pub fn at(&self, slip: f64, place: Place, had: Particle) -> Response {
        let Place { pressure, coefficient } = place;
        let (mu, of_mu) = self.coefficient(slip, coefficient, had);
        let (cap, of_cap) = (pressure * mu, of_mu.map(|slope| pressure * slope));
        let limit = had.yield_limit;
        let kept = [0.0, 0.0, 1.0];
        let by_friction = |yield_limit: f64, of_limit: Slope| Response {
            bound: cap,
            slope: of_cap,
            particle: Particle { coefficient: mu, yield_limit },
            slopes: [of_mu, of_limit],
            yields: false,
        };
        // A layer that softens goes on yielding where friction falls below the limit from which it has softened.
        let at_rest = || pressure * self.coefficient(0.0, coefficient, had).0;
        let yields_first = |layer: &PlasticLayer| limit < cap || layer.hardening < 0.0 && limit < at_rest();
        let Some(layer) = self.layer.filter(yields_first) else { return by_friction(limit, kept) };
        let least = LEAST_YIELD_LIMIT * layer.yield_limit;
        let (hardened, of_hardened) = match limit + layer.hardening * slip {
            value if value < least.min(limit) => (least.min(limit), if limit < least { kept } else { [0.0; 3] }),
            value => (value, [layer.hardening, 0.0, 1.0]),
        };
        if hardened >= cap {
            return by_friction(cap, of_cap);
        }
        Response {
            bound: hardened,
            slope: of_hardened,
            particle: Particle { coefficient: mu, yield_limit: hardened },
            slopes: [of_mu, of_hardened],
            yields: true,
        }
    }

    /// The slip at which the bound plus rho times the slip equals a traction, with derivatives; no slip if the bound at rest carries it.
    pub fn resolve(&self, traction: f64, rho: f64, place: Place, had: Particle) -> Resolved {
        let at_rest = self.at(0.0, place, had);
        let slips = traction > at_rest.bound;
        let response = if slips { self.slipping(traction, rho, (place, had), at_rest) } else { at_rest };
        let Response { slope, slopes, .. } = response;
        let by = |[slip, mu, limit]: Slope| {
            let of_slip = if slips { slip / (rho + slope[0]) } else { 0.0 };
            [of_slip, mu - of_slip * slope[1], limit - of_slip * slope[2]]
        };
        Resolved { slips, response, linear: [by(slope), by(slopes[0]), by(slopes[1])] }
    }

    /// The response on slip, by Newton's method in a bracket.
    fn slipping(&self, traction: f64, rho: f64, (place, had): (Place, Particle), at_rest: Response) -> Response {
        let (mut low, mut high) = (0.0, traction / rho);
        let (mut slip, mut found) = (0.0, at_rest);
        for _ in 0..STEPS {
            let excess = found.bound + rho * slip - traction;
            if excess > 0.0 {
                high = slip;
            } else {
                low = slip;
            }
            let by_slip = found.slope[0] + rho;
            let mut next = if by_slip > 0.0 { slip - excess / by_slip } else { f64::NAN };
            if !(next >= low && next <= high) {
                next = 0.5 * (low + high);
            }
            let is_done = (next - slip).abs() <= PRECISION * next;
            slip = next;
            found = self.at(slip, place, had);
            if is_done {
                break;
            }
        }
        found
    }
}
