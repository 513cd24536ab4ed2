//! The stability margin of a state, which is 0 where the bodies snap. At a fixed contact area C, a change v of the attraction outside (O) moves
//! the surfaces there by `A~ v`, `A~ = A_OO - A_OC A_CC^-1 A_CO`, which changes the attraction by `s A~ v`. At a given approach the state is
//! stable if
//!
//! ```text
//! lambda = the largest eigenvalue of  sqrt(s) A~ sqrt(s)  < 1
//! ```
//!
//! lambda is computed by Lanczos' iteration. Each step of it solves a linear system on the contact area. The stability margin is `1 - lambda`.

use super::level::Level;
use super::newton::stiffnesses;
use super::parts::{solve_in_parts, Effort, Solution};
use super::system::{Linearised, Short};
use super::unknowns::One;
use crate::bisection::bisect;
use crate::error::Result;
use crate::methods::fields::{self, Fields};
use crate::progress::Monitor;
use crate::threads::Threads;

/// The largest number of steps of Lanczos' iteration, and the change of lambda at which it ends.
const MOST_STEPS: usize = 20;
const LAMBDA_CHANGE: f64 = 1e-4;
/// The accuracy and the cost of each linear system. The error of lambda, a Rayleigh quotient, is the square of the relative residual. On large
/// grids a system keeps few search directions, because the vectors of Lanczos' iteration need memory as well.
const INNER: Effort = Effort { part: 1e-3, most: 60, at_once: 8 };

/// Computes the stability margin `1 - lambda` of the current state. `None`: the caller cancelled.
pub fn stability(level: &mut Level, monitor: &mut Monitor<'_>) -> Result<Option<f64>> {
    let (n, threads) = (level.now.u.len(), level.problem.threads.clone());
    level.clear_fields(0);
    let mut fields = std::mem::take(&mut level.fields);
    let mut roots = fields.take_of(n)?;
    stiffnesses(level, |_, e| e.max(0.0), &mut roots);
    fields::map(&threads, &mut roots, |_, s: Short| s.map(f32::sqrt));
    let lambda = largest_eigenvalue((level, monitor), &roots, &threads, &mut fields)?;
    fields.give_of(roots);
    level.fields = fields;
    level.clear_fields(0);
    level.count_products(monitor);
    Ok(lambda.map(|lambda| 1.0 - lambda))
}

/// Computes lambda by Lanczos' iteration. `roots`: the square roots of s a0. `None`: the caller cancelled.
fn largest_eigenvalue(
    (level, monitor): (&mut Level, &mut Monitor<'_>),
    roots: &[Short],
    threads: &Threads,
    fields: &mut Fields<1>,
) -> Result<Option<f64>> {
    let n = roots.len();
    let norm = fields::dot(threads, roots, roots).sqrt();
    if !(norm > 0.0) {
        return Ok(Some(0.0));
    }
    let (mut v, mut before) = (fields.take(n)?, fields.take(n)?);
    fields::fill(threads, &mut v, |i| [f64::from(roots[i][0]) / norm]);
    fields::fill(threads, &mut before, |_| [0.0]);
    let (mut diagonal, mut beside) = (Vec::with_capacity(MOST_STEPS), Vec::with_capacity(MOST_STEPS));
    let (mut lambda, mut last) = (0.0, 0.0);
    for _ in 0..MOST_STEPS {
        let mut w = apply(level, roots, &v, fields)?;
        let along = fields::dot(threads, &w, &v);
        fields::add_all(threads, &mut w, &[(-along, &v), (-last, &before)]);
        diagonal.push(along);
        let found = largest_of_tridiagonal(&diagonal, &beside);
        last = fields::dot(threads, &w, &w).sqrt();
        let is_last = (found - lambda).abs() <= LAMBDA_CHANGE || !(last > LAMBDA_CHANGE * found);
        lambda = found;
        std::mem::swap(&mut before, &mut v);
        std::mem::swap(&mut v, &mut w);
        fields.give(w);
        if is_last || !monitor.uncounted_done(&level.problem.grid, monitor.count.residual) {
            break;
        }
        beside.push(last);
        fields::scale(threads, &mut v, 1.0 / last);
    }
    [v, before].into_iter().for_each(|field| fields.give(field));
    Ok(Some(lambda).filter(|_| !monitor.is_cancelled()))
}

/// Computes `sqrt(s) A~ sqrt(s) v`.
fn apply(level: &mut Level, roots: &[Short], v: &[One], fields: &mut Fields<1>) -> Result<Vec<One>> {
    let (n, threads) = (roots.len(), level.problem.threads.clone());
    let none = fields.zeros(n, &threads)?;
    // The system with a slope of 0, that is, at a constant attraction: outside C, dp = sqrt(s) v; in C the distances do not change.
    let mut system = Linearised::new(level, &none, false, fields)?;
    let right = |_: &Linearised<'_>, i: usize| f64::from(roots[i][0]) * v[i][0];
    let Solution { y, product, .. } = solve_in_parts(&mut system, right, INNER, fields)?;
    let mut w = fields.take(n)?;
    fields::fill(&threads, &mut w, |i| [f64::from(roots[i][0]) * f64::from(product[i][0])]);
    [y, product, none].into_iter().for_each(|field| fields.give_of(field));
    Ok(w)
}

/// The largest eigenvalue of a symmetric tridiagonal matrix, by bisection with Sturm's test whether an eigenvalue exceeds a number.
fn largest_of_tridiagonal(diagonal: &[f64], beside: &[f64]) -> f64 {
    let reach = |i: usize| {
        let next = |k: Option<usize>| k.and_then(|k| beside.get(k)).map_or(0.0, |b| b.abs());
        next(i.checked_sub(1)) + next(Some(i))
    };
    let bounds = diagonal.iter().enumerate().map(|(i, a)| (a - reach(i), a + reach(i)));
    let ends = bounds.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (a, b)| (low.min(a), high.max(b)));
    let has_above = |middle: f64| {
        let mut pivot = 1.0;
        diagonal.iter().enumerate().any(|(i, a)| {
            let b = i.checked_sub(1).map_or(0.0, |k| beside[k]);
            pivot = a - middle - b * b / pivot;
            pivot > 0.0
        })
    };
    let (low, high) = bisect(ends, |_, _| false, has_above);
    0.5 * (low + high)
}
