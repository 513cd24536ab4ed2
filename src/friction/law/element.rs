//! One element with a law or a plastic layer: its traction bound as a function of the slip and of its particle's state, and the slip that belongs to
//! a traction.

use crate::effects::{FrictionLaw, PlasticLayer};

/// The yield limit of a layer that softens does not fall below this times that of fresh material.
const LEAST_YIELD_LIMIT: f64 = 1e-3;
/// The coefficient of friction does not fall below this times that at rest.
const LEAST_COEFFICIENT: f64 = 1e-9;
/// The largest number of steps of the search for a slip.
const STEPS: u32 = 80;
/// The relative change of the slip below which the search ends.
const PRECISION: f64 = 1e-14;

/// The state of a particle of the interface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Particle {
    /// The coefficient of friction.
    pub coefficient: f64,
    /// The yield limit of the layer, a traction; 0 without a layer.
    pub yield_limit: f64,
}

/// The law of friction and the layer of a step. Slips and tractions are in the units of the iterations.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// How the coefficient falls; none for a constant one.
    pub fall: Option<FrictionLaw>,
    pub layer: Option<PlasticLayer>,
    /// The slip velocity of a slip of 1, in the caller's units.
    pub rate: f64,
    /// The duration of a step, in the caller's units.
    pub duration: f64,
}

/// What the bound of an element depends on, besides its slip and its particle.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// The pressure.
    pub pressure: f64,
    /// The coefficient of friction at rest.
    pub coefficient: f64,
}

/// The derivatives of a quantity by the slip, and by the coefficient and the yield limit of the particle before the step.
type Slope = [f64; 3];

/// The bound of an element and its particle after the step, at a given slip, with their derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub struct Response {
    pub bound: f64,
    /// The derivatives of the bound.
    pub slope: Slope,
    /// The particle after the step.
    pub particle: Particle,
    /// The derivatives of the particle's coefficient and of its yield limit.
    pub slopes: [Slope; 2],
    /// Whether the layer and not friction bounds the traction.
    pub yields: bool,
}

/// The response of an element at the slip at which the bound plus rho times the slip equals a given traction.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resolved {
    /// Whether the element slips. It sticks if its bound at rest carries the traction.
    pub slips: bool,
    pub response: Response,
    /// The derivatives of the bound, of the coefficient and of the yield limit: each by the traction, and by the coefficient and the yield limit of
    /// the particle before the step.
    pub linear: [Slope; 3],
}

impl Law {
    /// The coefficient of friction of an element at a slip, and its derivatives.
    fn coefficient(&self, slip: f64, coefficient: f64, before: Particle) -> (f64, Slope) {
        let (mut mu, mut of_mu) = (coefficient, [0.0; 3]);
        if let Some(law) = &self.fall {
            let v = slip * self.rate;
            let (value, slope) = law.at(v);
            let (steady, by_slip) = (coefficient * value, coefficient * slope * self.rate);
            let c = law.memory_distance;
            if c > 0.0 {
                // The part t of the coefficient that the particle keeps, and its derivative by the slip.
                let whole = c + self.duration * v.max(law.memory_speed);
                let t = c / whole;
                let t_by_slip =
                    if v > law.memory_speed { -c * self.duration / (whole * whole) * self.rate } else { 0.0 };
                mu = t * before.coefficient + (1.0 - t) * steady;
                of_mu = [(1.0 - t) * by_slip + t_by_slip * (before.coefficient - steady), t, 0.0];
            } else {
                (mu, of_mu) = (steady, [by_slip, 0.0, 0.0]);
            }
        }
        if mu < LEAST_COEFFICIENT * coefficient {
            (mu, of_mu) = (LEAST_COEFFICIENT * coefficient, [0.0; 3]);
        }
        (mu, of_mu)
    }

    /// The response of an element at a slip, from the state of its particle before the step.
    pub fn at(&self, slip: f64, place: Place, before: Particle) -> Response {
        let Place { pressure, coefficient } = place;
        let (mu, of_mu) = self.coefficient(slip, coefficient, before);
        let (cap, of_cap) = (pressure * mu, of_mu.map(|slope| pressure * slope));
        let limit = before.yield_limit;
        let unchanged_limit = [0.0, 0.0, 1.0];
        let by_friction = |yield_limit: f64, of_limit: Slope| Response {
            bound: cap,
            slope: of_cap,
            particle: Particle { coefficient: mu, yield_limit },
            slopes: [of_mu, of_limit],
            yields: false,
        };
        // A softening layer whose limit is below friction at rest yields at every slip, also where friction has fallen below that limit.
        let at_rest = || pressure * self.coefficient(0.0, coefficient, before).0;
        let yields_first = |layer: &PlasticLayer| limit < cap || layer.hardening < 0.0 && limit < at_rest();
        let Some(layer) = self.layer.filter(yields_first) else { return by_friction(limit, unchanged_limit) };
        let least = LEAST_YIELD_LIMIT * layer.yield_limit;
        let (hardened, of_hardened) = match limit + layer.hardening * slip {
            value if value < least.min(limit) => {
                (least.min(limit), if limit < least { unchanged_limit } else { [0.0; 3] })
            }
            value => (value, [layer.hardening, 0.0, 1.0]),
        };
        if hardened >= cap {
            // A layer that hardens does so up to friction. One that softens has softened by its slip before friction fell below it.
            let hardens = layer.hardening >= 0.0;
            return if hardens { by_friction(cap, of_cap) } else { by_friction(hardened, of_hardened) };
        }
        Response {
            bound: hardened,
            slope: of_hardened,
            particle: Particle { coefficient: mu, yield_limit: hardened },
            slopes: [of_mu, of_hardened],
            yields: true,
        }
    }

    /// Finds the slip at which the bound plus rho times the slip equals a traction. The slip is 0 if the bound at rest carries the traction.
    pub fn resolve(&self, traction: f64, rho: f64, place: Place, before: Particle) -> Resolved {
        let at_rest = self.at(0.0, place, before);
        let slips = traction > at_rest.bound;
        let response = if slips { self.slipping(traction, rho, (place, before), at_rest) } else { at_rest };
        let Response { slope, slopes, .. } = response;
        let by = |[slip, mu, limit]: Slope| {
            let of_slip = if slips { slip / (rho + slope[0]) } else { 0.0 };
            [of_slip, mu - of_slip * slope[1], limit - of_slip * slope[2]]
        };
        Resolved { slips, response, linear: [by(slope), by(slopes[0]), by(slopes[1])] }
    }

    /// The response at that slip, if it is not 0, by Newton's method within a bracket that shrinks.
    fn slipping(&self, traction: f64, rho: f64, (place, before): (Place, Particle), at_rest: Response) -> Response {
        let (mut low, mut high) = (0.0, traction / rho);
        let (mut slip, mut response) = (0.0, at_rest);
        for _ in 0..STEPS {
            let excess = response.bound + rho * slip - traction;
            if excess > 0.0 {
                high = slip;
            } else {
                low = slip;
            }
            let by_slip = response.slope[0] + rho;
            let mut next = if by_slip > 0.0 { slip - excess / by_slip } else { f64::NAN };
            if !(next >= low && next <= high) {
                next = 0.5 * (low + high);
            }
            let is_done = (next - slip).abs() <= PRECISION * next;
            slip = next;
            response = self.at(slip, place, before);
            if is_done {
                break;
            }
        }
        response
    }
}
