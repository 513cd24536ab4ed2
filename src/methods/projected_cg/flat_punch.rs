//! Lines in plane strain: which elements enter C, and the pressure of a flat punch on C as the deflation direction.
//!
//! By approach the residual's mean over C is what the force lacks. What removes it is the pressure d of a flat punch on C, A d = const there. Joined
//! pieces (module `punches`) are near it; with two periods and much contact a punch displaces next to nothing, and the spread of what joined
//! pieces displace is many times the mean. So conjugate gradients without force go on from them until the mean is larger than the spread.

use super::preconditioner::Preconditioner;
use super::vectors::Iteration;
use crate::contact::State;
use crate::operator::fft::Real;
use crate::scene::Load;
use crate::sums::Sums;

/// The spread over C of what a flat punch displaces, relative to the mean.
const FLAT: f64 = 0.3;
/// Iterations at most.
const MOST: u64 = 40;
/// Elements enter from so many standard deviations of the residual on. Three lines of 9600 elements with two periods, by force from a uniform
/// pressure: 43, 66 and 48 products with 3, 58, 80 and 62 with 10; with 1 no end.
const ALLOWED: f64 = 3.0;

impl<T: Real> Iteration<T> {
    /// Whether the grid is a line in plane strain.
    pub(super) fn is_plane_strain(&self) -> bool {
        self.preconditioner.as_ref().is_some_and(Preconditioner::has_punches)
    }

    /// Before the first iteration: whether pieces of C move as flat punches. With two periods and much contact, by approach, they do not: a flat punch
    /// displaces next to nothing, and steps along it are far too long.
    pub(super) fn choose_punches(&mut self, state: &State, is_mean_free: bool) {
        let by_approach = matches!(state.load, Load::Approach(_));
        let is_nearly_full = is_mean_free && 2 * self.segments.count() > state.p.len();
        let Some(m) = &mut self.preconditioner else { return };
        if m.use_punches(!(by_approach && is_nearly_full)) {
            (self.counted, self.allowance) = (None, 0.0);
        }
        if self.is_plane_strain() {
            self.residual(state);
        }
    }

    /// Elements that penetrate by less than the mean and the spread of the residual, which z holds, stay outside: pieces move as flat punches, u beside
    /// C is as uncertain as the residual on it, and most elements that enter because of that leave at once.
    pub(super) fn find_allowance(&mut self) {
        let mut sums = Sums::new();
        sums.add([], [&self.z], |[], [r]| [r, r * r]);
        let (mean, spread) = mean_and_spread(sums.values(), self.segments.count());
        self.allowance = mean + ALLOWED * spread;
    }

    /// d becomes the pressure of a flat punch on C, of mean 1 there, and w = A d. t, q and z are overwritten. Returns the products that it takes.
    pub(super) fn press_flat(&mut self, state: &State) -> u64 {
        self.count_near(state);
        self.preconditioner.iter_mut().for_each(|m| m.press_flat(&mut self.deflation.d));
        self.operator.apply(&self.deflation.d, &mut self.deflation.w, &mut self.workspace);
        self.forget_directions(state.grid.mx);
        let (contact, mut tq) = (&state.contact, 0.0);
        for products in 1..=MOST {
            let w = &self.deflation.w;
            let sums = over(contact, |i| [w[i].to_double(), w[i].to_double().powi(2)]);
            let (mean, spread) = mean_and_spread(sums, self.segments.count());
            if spread <= FLAT * mean.abs() {
                return products;
            }
            for (i, z) in self.z.iter_mut().enumerate() {
                *z = if contact[i] { T::of(mean) - w[i] } else { T::zero() };
            }
            if let Some(m) = &mut self.preconditioner {
                m.apply(&mut self.z, (contact, true), &mut self.extension, &mut self.workspace);
            }
            let (z, q) = (&self.z, &self.q);
            let [zq, _] = over(contact, |i| [z[i].to_double() * q[i].to_double(), 0.0]);
            let beta = T::of(if tq > 0.0 { -zq / tq } else { 0.0 });
            for (i, t) in self.t.iter_mut().enumerate() {
                *t = if contact[i] { z[i] + beta * *t } else { T::zero() };
            }
            self.operator.apply(&self.t, &mut self.q, &mut self.workspace);
            let (t, q, w) = (&self.t, &self.q, &self.deflation.w);
            let [t_q, rt] = over(contact, |i| {
                let (t, q) = (t[i].to_double(), q[i].to_double());
                [t * q, (mean - w[i].to_double()) * t]
            });
            if !(t_q > 0.0) {
                return products + 1;
            }
            tq = t_q;
            let alpha = T::of(rt / tq);
            let Iteration { t, q, deflation, .. } = self;
            deflation.d.iter_mut().zip(t).for_each(|(d, t)| *d += alpha * *t);
            deflation.w.iter_mut().zip(q).for_each(|(w, q)| *w += alpha * *q);
        }
        MOST + 1
    }
}

/// Of sums of values and of their squares.
fn mean_and_spread([sum, squares]: [f64; 2], count: usize) -> (f64, f64) {
    let count = count.max(1) as f64;
    let mean = sum / count;
    (mean, (squares / count - mean * mean).max(0.0).sqrt())
}

/// Two sums over C.
fn over(contact: &[bool], terms: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
    let inside = contact.iter().enumerate().filter(|(_, inside)| **inside);
    inside.fold([0.0; 2], |[a, b], (i, _)| {
        let [x, y] = terms(i);
        [a + x, b + y]
    })
}
