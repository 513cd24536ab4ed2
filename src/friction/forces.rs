//! Given tangential forces: the largest forces that friction carries, and the missing part of forces.

use super::certificate::is_on_circle;
use super::plane::{add, length, plus, Vector};
use super::problem::Problem;
use super::scales::Scales;
use crate::bisection::bisect;
use crate::effects::{Friction, Prescribed};
use crate::error::{Error, Number, Result};
use crate::grid::Grid;
use crate::memory::sparse;
use crate::methods::fields;
use crate::sums::{in_blocks, ROUND_OFF};

/// The given forces of a scene, as sums of tractions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forces {
    /// Whether the force in x is given, and that in y.
    pub given: [bool; 2],
    /// The sum of the (weighted) tractions in each direction, `F/(dx dy)`; 0 in a direction with a given creepage.
    pub sum: Vector,
}

/// A given force and the greatest one that tractions within the bounds carry, both as sums of tractions.
struct Reach {
    /// The direction of the force, as a part of the message.
    direction: &'static str,
    /// What limits the force, as a part of the message.
    by: &'static str,
    wanted: f64,
    greatest: f64,
}

impl Reach {
    /// The message that refuses the force. `area` is that of an element.
    fn refusal(&self, area: f64) -> String {
        let Reach { direction, by, wanted, greatest } = self;
        format!(
            "the tangential force{direction} is {}; with {by} it must be less than {}",
            Number(wanted * area),
            Number(greatest * area)
        )
    }
}

impl Forces {
    /// No given forces.
    pub const NONE: Forces = Forces { given: [false; 2], sum: [0.0; 2] };

    /// Whether all given forces are 0.
    pub fn are_zero(&self) -> bool {
        self.only_given(self.sum) == [0.0; 2]
    }

    /// The given forces of a scene whose elements carry tractions of at most `bound(i)`. Refuses forces that no such tractions carry. If all bounds
    /// are 0, a given force of 0 counts as not given: its creepage is 0.
    pub fn of(friction: &Friction<'_>, grid: &Grid, bound: impl Fn(usize) -> f64) -> Result<Forces> {
        let mut refused = None;
        let forces = Forces::within(friction, grid, bound, |reach| {
            if refused.is_none() && !(reach.wanted < reach.greatest * (1.0 - ROUND_OFF)) {
                refused = Some(reach.refusal(grid.element_area()));
            }
        })?;
        refused.map_or(Ok(forces), |message| Err(Error::Infeasible(message)))
    }

    /// The largest factor by which all given forces can be multiplied so that tractions within the bounds still carry them.
    pub fn part(friction: &Friction<'_>, grid: &Grid, bound: impl Fn(usize) -> f64) -> Result<f64> {
        let mut part = f64::INFINITY;
        Forces::within(friction, grid, bound, |reach| part = part.min(reach.greatest / reach.wanted))?;
        Ok(part)
    }

    /// As [`Forces::of`], but refuses nothing. Calls `compare` with the given forces and the greatest ones that the bounds carry: first for each
    /// direction alone if there are weights, then for both directions together.
    fn within(
        friction: &Friction<'_>,
        grid: &Grid,
        bound: impl Fn(usize) -> f64,
        mut compare: impl FnMut(Reach),
    ) -> Result<Forces> {
        let area = grid.element_area();
        let mut forces = Forces::NONE;
        for (k, prescribed) in friction.prescribed.iter().enumerate() {
            if let Prescribed::Force(force) = *prescribed {
                (forces.given[k], forces.sum[k]) = (true, force / area);
            }
        }
        if !forces.any() {
            return Ok(forces);
        }
        for (k, weights) in friction.weights.iter().flatten().enumerate() {
            if !forces.given[k] {
                continue;
            }
            let greatest = in_blocks((0..grid.len()).map(|i| weights[i].abs() * bound(i)));
            if greatest == 0.0 && forces.sum[k] == 0.0 {
                forces.given[k] = false;
            } else {
                let (direction, by) = ([" in x", " in y"][k], "this friction and these weights");
                compare(Reach { direction, by, wanted: forces.sum[k].abs(), greatest });
            }
        }
        let wanted = forces.sum[0].hypot(forces.sum[1]);
        let direction = match forces.given {
            [false, false] => return Ok(Forces::NONE),
            _ if wanted > 0.0 => forces.sum.map(|sum| sum / wanted),
            [true, _] => [1.0, 0.0],
            _ => [0.0, 1.0],
        };
        let greatest = match friction.weights {
            Some(weights) if forces.given == [true; 2] && wanted > 0.0 => {
                reach(weights, direction, grid.len(), &bound)?
            }
            _ => {
                let weight =
                    |i: usize| friction.weights.map_or(1.0, |[x, y]| (x[i] * direction[0]).hypot(y[i] * direction[1]));
                in_blocks((0..grid.len()).map(|i| weight(i) * bound(i)))
            }
        };
        if greatest == 0.0 && forces.sum == [0.0; 2] {
            return Ok(Forces::NONE);
        }
        let by = if friction.weights.is_some() { "these weights and this direction" } else { "this friction" };
        compare(Reach { direction: "", by, wanted, greatest });
        Ok(forces)
    }

    /// Converts the sums of tractions to the units of the iterations.
    pub fn in_units_of(&self, scales: &Scales) -> Forces {
        Forces { sum: self.sum.map(|sum| scales.traction(sum)), ..*self }
    }

    /// Whether any force is given.
    pub fn any(&self) -> bool {
        self.given[0] || self.given[1]
    }

    /// The forces times a factor.
    pub fn times(&self, part: f64) -> Forces {
        Forces { sum: [part * self.sum[0], part * self.sum[1]], ..*self }
    }

    /// v with the component of each direction without a given force set to 0.
    pub fn only_given(&self, v: Vector) -> Vector {
        [if self.given[0] { v[0] } else { 0.0 }, if self.given[1] { v[1] } else { 0.0 }]
    }

    /// The given forces less the sum of tractions that `sum` computes; 0 in directions without a given force. `sum` is called only if a force is
    /// given.
    pub fn less(&self, sum: impl FnOnce() -> Vector) -> Vector {
        if self.any() {
            self.only_given(plus(self.sum, -1.0, sum()))
        } else {
            [0.0; 2]
        }
    }

    /// The missing part of the given forces relative to the sum of g; 0 if no force is given. If no element slips, it is relative to the larger of
    /// the given forces and the sum of |q|: then tractions are linear in the forces, which may be far below the sum of g.
    pub fn missing(&self, problem: &Problem, q: &[Vector]) -> f64 {
        if !self.any() {
            return 0.0;
        }
        let terms = |i: usize| {
            let ([x, y], g) = (problem.weighted(i, q[i]), problem.bound[i]);
            [x, y, length([x, y]), f64::from(u8::from(g > 0.0 && is_on_circle(q[i], g)))]
        };
        let [x, y, carried, slips] = fields::sum(problem.threads(), q.len(), terms);
        let missing = length(self.less(|| [x, y]));
        match missing {
            0.0 => 0.0,
            _ if slips > 0.0 => missing / sum_of_bounds(problem),
            _ => missing / carried.max(length(self.only_given(self.sum))),
        }
    }
}

/// The greatest force in a direction t that n elements with the weights W carry, if their tractions are at most `bound(i)`. Its component across t is
/// 0.
///
/// ```text
/// the force, sum of W q, lies in the convex set  { F: F.d <= h(d) for all d },     h(d) = sum of g |W d|
/// greatest = min h(t + c n) over c                                                 n: the unit vector across t
/// ```
///
/// h is convex. Its slope along c rises from negative to positive values. Bisection finds the zero of the slope.
fn reach([x, y]: [&[f64]; 2], [tx, ty]: Vector, n: usize, bound: &impl Fn(usize) -> f64) -> Result<f64> {
    // g W of the elements with a bound, so that the passes below visit only these.
    let of = (0..n).map(|i| (i, bound(i))).filter(|(_, g)| *g > 0.0).map(|(i, g)| [g * x[i], g * y[i]]);
    let mut scaled: Vec<Vector> = sparse((0..n).filter(|i| bound(*i) > 0.0).count(), "the bounds of forces")?;
    scaled.extend(of);
    let direction = |c: f64| [tx - c * ty, ty + c * tx];
    let length = |[x, y]: Vector, d: Vector| (x * d[0]).hypot(y * d[1]);
    let sum = |of: &dyn Fn(Vector) -> f64| in_blocks(scaled.iter().map(|gw| of(*gw)));
    let h = |c: f64| sum(&|gw| length(gw, direction(c)));
    let slope = |c: f64| {
        let d = direction(c);
        sum(&|[x, y]| {
            let length = length([x, y], d);
            let slope_of_square = -x * x * d[0] * ty + y * y * d[1] * tx;
            if length > 0.0 {
                slope_of_square / length
            } else {
                0.0
            }
        })
    };
    // h(t + c n) >= |c| h(n) - h(t), which exceeds h(t) for larger c.
    let across = sum(&|gw| length(gw, [-ty, tx]));
    let largest = if across > 0.0 { 2.0 * h(0.0) / across } else { 0.0 };
    let (low, high) = bisect((-largest, largest), |_, _| false, |c| !(slope(c) > 0.0));
    Ok(h(0.0).min(h(low)).min(h(high)))
}

/// The sum of a field times the weights of creepages: the force, if the field are tractions. The field is 0 outside C.
pub fn sum_of(problem: &Problem, field: &[Vector]) -> Vector {
    fields::sum(problem.threads(), field.len(), |i| problem.weighted(i, field[i]))
}

/// The sum of g.
pub fn sum_of_bounds(problem: &Problem) -> f64 {
    fields::sum(problem.threads(), problem.bound.len(), |i| [problem.bound[i]])[0]
}

/// [`sum_of`] for the sum of two fields.
pub fn sum_of_both(problem: &Problem, v: &[Vector], w: &[Vector]) -> Vector {
    fields::sum(problem.threads(), v.len(), |i| problem.weighted(i, add(v[i], w[i])))
}
