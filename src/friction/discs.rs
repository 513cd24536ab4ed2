//! The fields of projected gradients on discs, on C alone, and the passes over them.
//!
//! Tractions are in units of the smaller one of the bounds and what the rigid slip asks for, displacements in that times the unit of the coefficients: directions,
//! in single precision T, stay within its range. What adds up, q and u, is in double precision.

mod state;

use super::disc::{double, moved, slips, Units};
use super::places::Places;
use super::plane::{add, dot, onto_disc, plus, square, Pair, Vector};
use super::problem::Problem;
use super::tangent::project;
use super::vectors::over;
use crate::memory::keep;
use crate::methods::extension::Extension;
use crate::operator::fft::Real;
use crate::threads::Threads;

/// The fields of one solve.
#[derive(Default)]
pub struct Discs<T: Real> {
    /// g and w.
    bound: Vec<f64>,
    slip: Vec<Vector>,
    q: Vec<Vector>,
    u: Vec<Vector>,
    /// n, 0 where C sticks; D; `P(-s)`.
    normal: Vec<Vector>,
    curvature: Vec<T>,
    projected: Vec<Pair<T>>,
    /// What a layer is beyond its least compliance; none: it is uniform.
    excess: Vec<f64>,
    way: Way<T>,
    /// On the grid: what is multiplied, and what that gives.
    given: Vec<Pair<T>>,
    answer: Vec<Pair<T>>,
    extension: Option<Extension<T, 2>>,
    units: Units,
}

/// The way of a step.
#[derive(Default)]
struct Way<T> {
    /// z; t, its chord, and `A` of the chord and the deferred corrections.
    z: Vec<Pair<T>>,
    direction: Vec<Pair<T>>,
    chord: Vec<Pair<T>>,
    product: Vec<Pair<T>>,
    deferred: Vec<Pair<T>>,
}

/// Sums of squares over C: of what is left of the slip, of u, and of a step the deferred corrections and the ways that elements went.
#[derive(Clone, Copy)]
pub struct Sums {
    pub rest: f64,
    pub displaced: f64,
    pub deferred: f64,
    pub moved: f64,
}

impl<T: Real> Discs<T> {
    /// A length in the unit of displacements.
    pub fn scaled(&self, length: f64) -> f64 {
        length / self.units.displacement
    }

    /// A traction of these fields as the state has it.
    pub fn own_traction(&self, traction: f64) -> f64 {
        self.units.traction * traction
    }

    /// Predicts what slips; what the preconditioner is given is made ready.
    pub fn predict(&mut self, places: &Places, threads: &Threads) -> Sums {
        let Discs { bound, slip, q, u, normal, curvature, projected, excess, given, units, .. } = self;
        let predicted = places.cut(normal).zip(places.cut(curvature)).zip(places.cut(projected));
        let blocks = places.parts().zip(predicted).zip(places.cut_grid(given));
        let [rest, displaced] = over(threads, blocks, |_, ((part, ((normal, curvature), projected)), given)| {
            let mut sums = [0.0; 2];
            given.fill([T::zero(); 2]);
            for (j, place) in part.in_rows().enumerate() {
                let k = part.start + j;
                let seen = units.look(q[k], u[k], slip[k], bound[k]);
                (normal[j], curvature[j], projected[j]) =
                    (seen.normal, T::of(seen.curvature), seen.projected.map(T::of));
                given[place] = seen.projected.map(|r| T::of(units.mixing(seen.curvature + beyond(excess, k)) * r));
                sums = [sums[0] + seen.rest, sums[1] + square(u[k])];
            }
            sums
        });
        Sums { rest, displaced, deferred: 0.0, moved: 0.0 }
    }

    /// z, the preconditioned residual: see [`Tangent::precondition`](super::tangent::Tangent::precondition). Returns `z.(A + D) t` of the last direction.
    pub fn precondition(&mut self, problem: &mut Problem) -> f64 {
        let (operators, given, answer) = (&mut problem.operators, &self.given, &mut self.answer);
        let compliance = operators.relative_compliance();
        match &mut self.extension {
            Some(extension) => {
                extension.between(given, answer, compliance, |r, z| operators.precondition_plain(r, z));
            }
            None => operators.precondition_plain(given, answer),
        }
        let Discs { normal, curvature, projected, excess, way, answer, units, .. } = self;
        let Way { z, direction, product, .. } = way;
        let places = &problem.places;
        let [along] = over(problem.threads(), places.parts().zip(places.cut(z)), |_, (part, z)| {
            let mut along = 0.0;
            for ((k, place), z) in (part.start..).zip(part.on_grid()).zip(z.iter_mut()) {
                let bend = curvature[k].to_double();
                let stiff = bend + beyond(excess, k);
                let mixing = units.mixing(stiff);
                let v = double(answer[place]).map(|v| mixing * v);
                let own = (1.0 - mixing) / (stiff + units.a0);
                let new = plus(project(normal[k], v), own, double(projected[k]));
                along += dot(new, plus(double(product[k]), bend, double(direction[k])));
                *z = new.map(T::of);
            }
            [along]
        });
        along
    }

    /// The direction t, its chord at the length f, and what is multiplied: the chord with the deferred corrections.
    pub fn choose_direction(&mut self, problem: &Problem, (beta, f): (f64, f64)) {
        let Discs { bound, q, normal, way, given, .. } = self;
        let Way { z, direction, chord, deferred, .. } = way;
        let (places, inverse) = (&problem.places, 1.0 / f);
        let blocks = places.parts().zip(places.cut(direction).zip(places.cut(chord))).zip(places.cut_grid(given));
        over(problem.threads(), blocks, |_, ((part, (direction, chord)), given)| {
            given.fill([T::zero(); 2]);
            for (j, place) in part.in_rows().enumerate() {
                let k = part.start + j;
                let t = project(normal[k], plus(double(z[k]), beta, double(direction[j])));
                let moved = moved(normal[k], bound[k], q[k], t, f);
                let along = [inverse * (moved[0] - q[k][0]), inverse * (moved[1] - q[k][1])];
                given[place] = plus(along, inverse, double(deferred[k])).map(T::of);
                (direction[j], chord[j]) = (t.map(T::of), along.map(T::of));
            }
            []
        });
    }

    /// Multiplies; returns `t.(A + D) t` and `t` times the projected residual, of the chord where C sticks.
    pub fn multiply(&mut self, problem: &mut Problem) -> [f64; 2] {
        problem.operators.multiply_plain(&self.given, &mut self.answer);
        let Discs { normal, curvature, projected, way, answer, .. } = self;
        let Way { direction, chord, product, .. } = way;
        let places = &problem.places;
        over(problem.threads(), places.parts().zip(places.cut(product)), |_, (part, product)| {
            let mut sums = [0.0; 2];
            for ((k, place), product) in (part.start..).zip(part.on_grid()).zip(product.iter_mut()) {
                *product = answer[place];
                let along = double(if slips(normal[k]) { direction[k] } else { chord[k] });
                let bend = curvature[k].to_double();
                sums[0] += dot(along, double(*product)) + bend * square(along);
                sums[1] += dot(double(projected[k]), along);
            }
            sums
        })
    }

    /// Goes so far along the chord at the length f, and predicts what slips there.
    pub fn go(&mut self, places: &Places, threads: &Threads, length: f64, f: f64) -> Sums {
        let Discs { bound, slip, q, u, normal, curvature, projected, excess, way, given, units, .. } = self;
        let Way { direction, chord, product, deferred, .. } = way;
        let left = 1.0 - length / f;
        let states = places.cut(q).zip(places.cut(u)).zip(places.cut(direction).zip(places.cut(deferred)));
        let predicted = places.cut(normal).zip(places.cut(curvature)).zip(places.cut(projected));
        let blocks = places.parts().zip(states).zip(predicted).zip(places.cut_grid(given));
        let work = |_: usize, block: &mut _| {
            let (((part, ((q, u), (direction, deferred))), ((normal, curvature), projected)), given): &mut Block<
                '_,
                T,
            > = block;
            let mut sums = [0.0; 4];
            given.fill([T::zero(); 2]);
            for (j, place) in part.in_rows().enumerate() {
                let k = part.start + j;
                let (g, n) = (bound[k], normal[j]);
                let straight = plus(q[j], length, double(chord[k]));
                let new = match slips(n) {
                    true => moved(n, g, q[j], double(direction[j]), length),
                    false => onto_disc(straight, g),
                };
                let late = plus([new[0] - straight[0], new[1] - straight[1]], left, double(deferred[j]));
                deferred[j] = late.map(T::of);
                let way = [new[0] - q[j][0], new[1] - q[j][1]];
                (sums[2], sums[3]) = (sums[2] + square(late), sums[3] + square(way));
                u[j] = plus(u[j], length, double(product[k]));
                if !slips(n) {
                    direction[j] = chord[k];
                }
                q[j] = new;
                let seen = units.look(new, u[j], slip[k], g);
                (normal[j], curvature[j], projected[j]) =
                    (seen.normal, T::of(seen.curvature), seen.projected.map(T::of));
                given[place] = seen.projected.map(|r| T::of(units.mixing(seen.curvature + beyond(excess, k)) * r));
                (sums[0], sums[1]) = (sums[0] + seen.rest, sums[1] + square(u[j]));
            }
            sums
        };
        let [rest, displaced, deferred, moved] = over(threads, blocks, work);
        Sums { rest, displaced, deferred, moved }
    }

    /// Multiplies the deferred corrections: none is left.
    pub fn correct(&mut self, problem: &mut Problem) {
        let (places, threads) = (&problem.places, problem.operators.threads.clone());
        let Discs { u, way: Way { deferred, .. }, given, answer, .. } = self;
        let blocks = places.parts().zip(places.cut(deferred)).zip(places.cut_grid(given));
        over(&threads, blocks, |_, ((part, deferred), given)| {
            given.fill([T::zero(); 2]);
            for (place, deferred) in part.in_rows().zip(deferred.iter_mut()) {
                given[place] = std::mem::replace(deferred, [T::zero(); 2]);
            }
            []
        });
        problem.operators.multiply_plain(given, answer);
        over(&threads, places.parts().zip(places.cut(u)), |_, (part, u)| {
            for (i, u) in part.on_grid().zip(u.iter_mut()) {
                *u = add(*u, double(answer[i]));
            }
            []
        });
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let in_double = size_of::<f64>() + 4 * size_of::<Vector>();
        self.bound.capacity() * in_double
            + self.excess.capacity() * size_of::<f64>()
            + (13 * self.curvature.capacity() + 2 * 2 * self.given.capacity()) * size_of::<T>()
            + self.extension.as_ref().map_or(0, Extension::bytes)
    }
}

/// What a layer is at the k-th element of C beyond its least compliance.
#[inline]
fn beyond(excess: &[f64], k: usize) -> f64 {
    excess.get(k).copied().unwrap_or(0.0)
}

/// Of one block what moves, its prediction, and its part of what is multiplied.
type Block<'a, T> = (
    ((super::places::Part<'a>, States<'a, T>), ((&'a mut [Vector], &'a mut [T]), &'a mut [Pair<T>])),
    &'a mut [Pair<T>],
);
type States<'a, T> = ((&'a mut [Vector], &'a mut [Vector]), (&'a mut [Pair<T>], &'a mut [Pair<T>]));

impl<T: Real> Drop for Discs<T> {
    fn drop(&mut self) {
        let Discs { bound, slip, q, u, normal, curvature, projected, excess, given, answer, .. } = self;
        let Way { z, direction, chord, product, deferred } = &mut self.way;
        keep([bound, excess]);
        keep([curvature]);
        keep([slip, q, u, normal]);
        keep([projected, given, answer, z, direction, chord, product, deferred]);
    }
}
