//! The tangent of a state: the derivatives y of the pressures and -g of the distances by the approach, and the stability of the state.
//!
//! ```text
//! in C  A y = 1,      outside  y = -s g,      g = 1 - A y: the rate at which the gap closes with the approach
//! ```
//!
//! The sum of y is dF/dapproach, per area of an element. An equilibrium under a prescribed force is stable only if this sum is positive. If the
//! equations outside are divided by -s, the system is symmetric, K y = 1. Then the sum is also `2 sum y - (y, K y)`, in which the error of y
//! enters squared:
//!
//! ```text
//! sum y + sum_C y g - sum_outside g (y + s g)
//! ```
//!
//! An equilibrium under a prescribed approach is stable if `lambda < 1` (module [`stability`](super::stability)). Let `g0 > 0` be the g for fixed
//! attraction; then `g = g0 + A~ s g`. Attraction moves the surfaces towards each other, so that no element of A~ is negative, at least for
//! half-spaces. Therefore `g > 0` everywhere implies `lambda < 1` (Collatz 1942). If g is clearly negative somewhere, lambda itself is computed.

use super::level::Level;
use super::newton::{stiffnesses, IN_MEMORY, MOST_DIRECTIONS};
use super::parts::{solve_in_parts, Effort, Solution};
use super::stability::stability;
use super::system::Linearised;
use crate::error::Result;
use crate::methods::fields;
use crate::progress::Monitor;

/// The relative tolerances of the linear system, and the largest number of search directions for each. The smaller tolerance serves cases that
/// the larger one does not decide.
const LOOSE_TOLERANCE: f64 = 1e-3;
const FIRM_TOLERANCE: f64 = 1e-5;
const DIRECTIONS: [usize; 2] = [MOST_DIRECTIONS, 3 * MOST_DIRECTIONS];
/// The number of elements up to which a test of stability is cheap.
pub const CHEAP: usize = 1024;
/// On larger grids, stability under a force is first computed roughly, with this relative tolerance and number of search directions, half as many
/// as otherwise. The result is accepted if the sum of y is more than BEYOND_DOUBT times the sum of |y| and no g is below -BEYOND_DOUBT.
const ROUGH: (f64, usize) = (0.03, 18);
const BEYOND_DOUBT: f64 = 0.3;
/// If the size of the sum of y is below this fraction of the sum of |y|, its sign is uncertain.
const NEAR_ZERO: f64 = 0.05;
/// No g may be below this bound in a stable state. Next to the contact area g is near 0, and a loose solve may make it slightly negative. At a
/// saddle the smallest g is about -1, and even smaller if lambda is near 1.
const CLOSING_BOUND: f64 = -0.05;

/// The results of a tangent.
#[derive(Clone, Copy, Debug)]
struct Tangent {
    /// dF/dapproach, per area of an element: the sum of y.
    stiffness: f64,
    /// The sum of |y|.
    all: f64,
    /// The smallest g of the elements outside C where the attraction has a slope.
    closing: f64,
    /// Whether the linear system is solved to the tolerance.
    is_solved: bool,
}

impl Tangent {
    /// Whether the sign of dF/dapproach is certain.
    fn is_stiffness_clear(&self) -> bool {
        self.is_solved && self.stiffness.abs() > NEAR_ZERO * self.all
    }

    /// Whether no g is below the bound and, under a force, the sign of dF/dapproach is certain.
    fn is_clear(&self, by_force: bool) -> bool {
        self.is_solved && self.closing > CLOSING_BOUND && (!by_force || self.is_stiffness_clear())
    }
}

/// Computes the tangent at the current state, to the relative residual `part`, with at most `most` search directions.
fn tangent(level: &mut Level, (part, most): (f64, usize), monitor: &mut Monitor<'_>) -> Result<Tangent> {
    let (n, threads) = (level.now.u.len(), level.problem.threads.clone());
    let mut fields = std::mem::take(&mut level.fields);
    let mut stiffness = fields.take_of(n)?;
    stiffnesses(level, |_, e| e.max(0.0), &mut stiffness);
    let mut system = Linearised::new(level, &stiffness, false, &mut fields)?;
    let right = |system: &Linearised<'_>, i: usize| -system.column_at(i);
    // y and its product take the memory of two search directions.
    let effort = Effort { part, most, at_once: IN_MEMORY - 2 };
    let Solution { y, product, is_solved } = solve_in_parts(&mut system, right, effort, &mut fields)?;
    // The solution is a0 y, which is within the range of single precision in any units.
    let (contact, a0) = (&system.level.now.contact, system.level.self_influence());
    let [sum, all] = fields::sum(&threads, n, |i| {
        let (y, s, g) = (f64::from(y[i][0]), f64::from(stiffness[i][0]), 1.0 - f64::from(product[i][0]));
        let left = if contact[i] { y * g } else { -g * (y + s * g) };
        [y + left, y.abs()]
    });
    let opens = |i: usize| if stiffness[i][0] > 0.0 { f64::from(product[i][0]) - 1.0 } else { -1.0 };
    let opening = fields::largest(&threads, n, opens);
    fields.give_of(stiffness);
    [y, product].into_iter().for_each(|field| fields.give_of(field));
    level.fields = fields;
    level.count_products(monitor);
    Ok(Tangent { stiffness: sum / a0, all: all / a0, closing: -opening, is_solved })
}

/// Computes the tangent to the larger tolerance, and again to the smaller one if `is_clear` does not hold.
fn sure_tangent(level: &mut Level, is_clear: fn(&Tangent) -> bool, monitor: &mut Monitor<'_>) -> Result<Tangent> {
    let found = tangent(level, (LOOSE_TOLERANCE, DIRECTIONS[0]), monitor)?;
    if is_clear(&found) {
        return Ok(found);
    }
    tangent(level, (FIRM_TOLERANCE, DIRECTIONS[1]), monitor)
}

/// Whether all elements with a surface are in contact. Then no attraction changes.
pub fn is_all_in_contact(level: &Level) -> bool {
    level.now.contact.iter().zip(&level.surface.h).all(|(&inside, h)| inside || h.is_infinite())
}

/// Whether the approach is the same for any force: all elements are in contact, both directions are periodic, and a uniform pressure displaces
/// nothing.
pub fn is_locked(level: &Level) -> bool {
    level.problem.coefficients.is_mean_free() && level.now.contact.iter().all(|&inside| inside)
}

/// Computes dF/dapproach per area of an element at the current state. Infinite if the approach is locked.
pub fn stiffness_of_contact(level: &mut Level, monitor: &mut Monitor<'_>) -> Result<f64> {
    if is_locked(level) {
        return Ok(f64::INFINITY);
    }
    Ok(sure_tangent(level, Tangent::is_stiffness_clear, monitor)?.stiffness)
}

/// Whether the current equilibrium is a minimum of the energy: under its force if `by_force`, otherwise at its approach.
pub fn is_stable(level: &mut Level, by_force: bool, monitor: &mut Monitor<'_>) -> Result<bool> {
    if is_all_in_contact(level) {
        return Ok(true);
    }
    if by_force && level.now.u.len() > CHEAP {
        let found = tangent(level, ROUGH, monitor)?;
        if found.is_solved && found.stiffness > BEYOND_DOUBT * found.all && found.closing > -BEYOND_DOUBT {
            return Ok(true);
        }
    }
    let is_clear =
        if by_force { |found: &Tangent| found.is_clear(true) } else { |found: &Tangent| found.is_clear(false) };
    let found = sure_tangent(level, is_clear, monitor)?;
    if by_force && !(found.stiffness > 0.0) {
        return Ok(false);
    }
    Ok(found.closing > CLOSING_BOUND || stability(level, monitor)?.is_none_or(|found| found > 0.0))
}
