//! The tangent of a state: how pressures and distances change with the approach, and whether the state is stable.
//!
//! ```text
//! in C  A y = 1,      outside  y = -s g,      g = 1 - A y: how fast the gap closes as the approach grows
//! ```
//!
//! The sum of y is dF/dapproach. An equilibrium is stable under a force only where this is positive. With the outside divided by -s the system is a symmetric
//! one, K y = 1, so that the sum is `2 sum y - (y, K y)` as well, and what y leaves wrong enters it squared:
//!
//! ```text
//! sum y + sum_C y g - sum_outside g (y + s g)
//! ```
//!
//! Where the approach is given, it is stable if `lambda < 1` (module [`stability`](super::stability)). With `g0 > 0`, how the gap closes
//! while the attraction stands still, `g = g0 + A~ s g`. Attraction moves the surfaces towards each other: no element of A~ is negative, at least in
//! half-spaces. So `g > 0` everywhere means `lambda < 1` (Collatz 1942). Where g is clearly negative somewhere lambda itself is computed.

use super::level::Level;
use super::newton::{stiffnesses, IN_MEMORY};
use super::parts::{solve_in_parts, Effort, Solution};
use super::stability::stability;
use super::system::Linearised;
use crate::error::Result;
use crate::methods::fields;
use crate::progress::Monitor;

/// To what part of its right-hand side the linear system is solved, and where that does not decide.
const LOOSE: f64 = 1e-3;
const FIRM: f64 = 1e-5;
const DIRECTIONS: [usize; 2] = [30, 90];
/// A solve on a large grid keeps this number of directions: y and its product take the memory of two more.
const AT_ONCE: usize = IN_MEMORY - 2;
/// On grids of more elements than `ROUGHLY_FIRST` a force is asked roughly first, and answered where the sum of y is this part of the sum of |y|, and no g as far
/// below 0: that takes half as many directions.
const ROUGHLY_FIRST: usize = 1024;
const ROUGH: (f64, usize) = (0.03, 18);
const BEYOND_DOUBT: f64 = 0.3;
/// The sum of y is near 0 below this part of the sum of |y|.
const NEAR: f64 = 0.05;
/// g beside a contact area is next to 0, and what is loosely solved may be below. At a saddle it is of the order of -1, and more if lambda is near 1.
const CLOSING: f64 = -0.05;

/// The tangent.
#[derive(Clone, Copy, Debug)]
struct Tangent {
    /// dF/dapproach, per area of an element.
    stiffness: f64,
    /// The sum of |y|.
    all: f64,
    /// The least g where the attraction has a slope.
    closing: f64,
    /// Whether the linear system is solved as was asked for.
    is_solved: bool,
}

impl Tangent {
    fn is_stiffness_clear(&self) -> bool {
        self.is_solved && self.stiffness.abs() > NEAR * self.all
    }

    /// Whether what decides is beyond doubt.
    fn is_clear(&self, by_force: bool) -> bool {
        self.is_solved && self.closing > CLOSING && (!by_force || self.is_stiffness_clear())
    }
}

/// The tangent at the state of now.
fn tangent(level: &mut Level, (part, most): (f64, usize), monitor: &mut Monitor<'_>) -> Result<Tangent> {
    let (n, threads) = (level.now.u.len(), level.problem.threads.clone());
    let mut fields = std::mem::take(&mut level.fields);
    let mut stiffness = fields.take_of(n)?;
    stiffnesses(level, |_, e| e.max(0.0), &mut stiffness);
    let mut system = Linearised::new(level, &stiffness, false, &mut fields)?;
    let right = |system: &Linearised<'_>, i: usize| -system.column_at(i);
    let Solution { y, product, is_solved } =
        solve_in_parts(&mut system, right, Effort { part, most, at_once: AT_ONCE }, &mut fields)?;
    // y times a0, which single precision holds whatever the units are.
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

/// The tangent, solved again more firmly unless it is clear.
fn sure_tangent(level: &mut Level, is_clear: fn(&Tangent) -> bool, monitor: &mut Monitor<'_>) -> Result<Tangent> {
    let found = tangent(level, (LOOSE, DIRECTIONS[0]), monitor)?;
    if is_clear(&found) {
        return Ok(found);
    }
    tangent(level, (FIRM, DIRECTIONS[1]), monitor)
}

/// Whether all surfaces are in contact: no attraction changes.
pub fn is_all_in_contact(level: &Level) -> bool {
    level.now.contact.iter().zip(&level.surface.h).all(|(&inside, h)| inside || h.is_infinite())
}

/// Whether the approach stays where it is, whatever the force: all elements of two periods are in contact, and pressures that are the same everywhere
/// displace nothing.
pub fn is_locked(level: &Level) -> bool {
    level.problem.coefficients.is_mean_free() && level.now.contact.iter().all(|&inside| inside)
}

/// dF/dapproach per area of an element, at the state of now: infinite where the approach is locked.
pub fn stiffness_of_contact(level: &mut Level, monitor: &mut Monitor<'_>) -> Result<f64> {
    if is_locked(level) {
        return Ok(f64::INFINITY);
    }
    Ok(sure_tangent(level, Tangent::is_stiffness_clear, monitor)?.stiffness)
}

/// Whether the equilibrium of now is a least energy: at its force, or at its approach.
pub fn is_stable(level: &mut Level, by_force: bool, monitor: &mut Monitor<'_>) -> Result<bool> {
    if is_all_in_contact(level) {
        return Ok(true);
    }
    if by_force && level.now.u.len() > ROUGHLY_FIRST {
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
    Ok(found.closing > CLOSING || stability(level, monitor)? > 0.0)
}
