//! Lines in plane strain: the part of the preconditioner that finds the forces on the pieces of C. A piece is a run of neighbours in contact.
//!
//! M treats the residual as 0 outside C. For a residual that is uniform over many pieces of C this is a poor approximation: its energy grows with the
//! number of pieces, and conjugate gradients take about 100 iterations. In plane strain the force on a piece displaces all others, so such residuals
//! matter. Here M gets residuals without the mean of each piece, and finds pressures without a force on each piece. The forces on the pieces follow
//! from the means. Let g_i be the pressure of a flat punch on piece i with the force 1:
//!
//! ```text
//! Q = 1 - sum over pieces of 1_i g_i^T
//! M' = Q^T M Q + sum over joints of (g_l - g_r)(g_l - g_r)^T/s + g g^T/(g, A g)
//! ```
//!
//! A *joint* combines two neighbouring punches l and r to one punch `g = a g_l + (1 - a) g_r`, where a minimises the energy `(g, A g)`. Then g_l -
//! g_r, with the energy s, is conjugate to g. Pieces within 4 elements are joined, then within 8, and so on; the last joint is a punch on all of C. A
//! punch is described by its centre and its energy. Two punches displace each other like forces at their centres. A piece of n elements displaces
//! itself like a force n/4 elements away (exact for a logarithm; Johnson, Contact Mechanics, section 2.7).
//!
//! On rough lines of 9600 elements with two periods and Hurst exponents of 0.3 and 0.8, conjugate gradients on the C of the solution take 24 to 52
//! iterations, and with M alone 32 to more than 400.

use crate::error::Result;
use crate::grid::Grid;
use crate::influence::Coefficients;
use crate::memory::{reserve, zeros};
use crate::operator::fft::Real;

/// Shorter lines are treated without punches.
const LEAST_ELEMENTS: usize = 64;
/// The energy of a piece of at most this many elements is computed from g; that of a longer piece is read from the kernel.
const SHORT_PIECE: usize = 8;
/// A joint has at least this energy, relative to the energy of one element. For elastic bodies the energies of joints are larger.
const LEAST_ENERGY: f64 = 1e-3;
/// The factor on the forces of the pieces, to which the least eigenvalues of M' A belong. With 1 conjugate gradients take up to 1.25 times as many
/// iterations, with 4 the same number.
const FORCES_FACTOR: f64 = 2.0;
const WHAT: &str = "the pieces of a line";

/// The influence coefficient at an offset of k elements along a line.
fn along(coefficients: &Coefficients, grid: &Grid, k: usize) -> f64 {
    if grid.my == 1 {
        coefficients.at(k as i64, 0)
    } else {
        coefficients.at(0, k as i64)
    }
}

/// A flat punch with the force 1, on a piece of C or on several joined pieces.
#[derive(Clone, Copy, Default)]
struct Punch {
    /// The centre, in elements.
    centre: f64,
    /// The energy (g, A g).
    energy: f64,
}

/// The joint of two punches, which are given by their numbers.
#[derive(Clone, Copy, Default)]
struct Joint {
    left: u32,
    right: u32,
    /// The part a of the left punch.
    part: f64,
    /// The energy s of g_l - g_r.
    energy: f64,
}

/// The pieces of C on a line, and their joints.
pub(super) struct Punches {
    /// Coefficients at offsets 0, 1, ...
    kernel: Vec<f64>,
    /// The line's period in elements, if it has one.
    period: Option<f64>,
    /// Whether a uniform pressure displaces nothing.
    is_mean_free: bool,
    /// The first element of each piece, and the element after its last.
    pieces: Vec<(u32, u32)>,
    /// For each element of C: g of its piece.
    weights: Vec<f64>,
    /// The punches on the pieces, then those of the joints in their order.
    punches: Vec<Punch>,
    joints: Vec<Joint>,
    /// For each punch: first its mean residual, later its force.
    values: Vec<f64>,
    /// The numbers of the punches that are not yet joined.
    open: Vec<u32>,
}

impl Punches {
    /// Whether a grid is a line in plane strain, whose kernel is a logarithm of the distance. A logarithm falls by the same amount over each doubling
    /// of the distance; the kernel 1/r of a line of short elements falls by half as much each time.
    pub(super) fn serve(coefficients: &Coefficients, grid: &Grid) -> bool {
        let n = grid.len();
        let fall = |k: usize| along(coefficients, grid, k) - along(coefficients, grid, 2 * k);
        let is_line = n == grid.mx.max(grid.my) && n >= LEAST_ELEMENTS;
        is_line && !coefficients.depends_on_place() && fall(n / 8) > 0.5 * fall(1)
    }

    /// Sets up the punches of a line in plane strain, for coefficients times `factor`. None for other grids.
    pub(super) fn if_plane_strain(coefficients: &Coefficients, factor: f64, grid: &Grid) -> Result<Option<Punches>> {
        if !Punches::serve(coefficients, grid) {
            return Ok(None);
        }
        let n = grid.len();
        let (x, y) = coefficients.repeats(grid);
        let mut kernel = zeros(n, WHAT)?;
        kernel.iter_mut().enumerate().for_each(|(k, value)| *value = factor * along(coefficients, grid, k));
        let punches = Punches::new(kernel, (if grid.my == 1 { x } else { y }).then_some(n as f64))?;
        Ok(Some(Punches { is_mean_free: coefficients.is_mean_free(), ..punches }))
    }

    /// Punches from coefficients at offsets 0, 1, ... along the line, and its period in elements.
    fn new(kernel: Vec<f64>, period: Option<f64>) -> Result<Punches> {
        let n = kernel.len();
        let mut punches = Punches {
            kernel,
            period,
            is_mean_free: false,
            pieces: Vec::new(),
            weights: zeros(n, WHAT)?,
            punches: Vec::new(),
            joints: Vec::new(),
            values: Vec::new(),
            open: Vec::new(),
        };
        let most = n.div_ceil(2);
        reserve(&mut punches.pieces, most, WHAT)?;
        reserve(&mut punches.punches, 2 * most, WHAT)?;
        reserve(&mut punches.joints, most, WHAT)?;
        reserve(&mut punches.values, 2 * most, WHAT)?;
        reserve(&mut punches.open, most, WHAT)?;
        Ok(punches)
    }

    /// Whether a uniform pressure displaces nothing.
    pub(super) fn is_mean_free(&self) -> bool {
        self.is_mean_free
    }

    /// Finds the pieces of C and their joints.
    pub(super) fn find(&mut self, contact: &[bool]) {
        self.find_pieces(contact);
        self.punches.clear();
        self.joints.clear();
        self.open.clear();
        for k in 0..self.pieces.len() {
            let (start, end) = self.pieces[k];
            self.set_weights(start as usize, end as usize);
            let energy = self.energy(start as usize, end as usize);
            self.open.push(self.punches.len() as u32);
            self.punches.push(Punch { centre: 0.5 * f64::from(start + end), energy });
        }
        let mut within = 4.0;
        while self.open.len() > 1 {
            self.join_within(within);
            within *= 2.0;
        }
        self.values.resize(self.punches.len(), 0.0);
    }

    /// Finds the runs of neighbours in contact.
    fn find_pieces(&mut self, contact: &[bool]) {
        self.pieces.clear();
        let mut i = 0;
        while i < contact.len() {
            let length = contact[i..].iter().take_while(|inside| **inside).count();
            if length > 0 {
                self.pieces.push((i as u32, (i + length) as u32));
            }
            i += length + 1;
        }
    }

    /// Sets g on the elements of a piece: the pressure of a flat punch at the middle of each element, with the sum 1.
    fn set_weights(&mut self, start: usize, end: usize) {
        let weights = &mut self.weights[start..end];
        let (mut sum, length) = (0.0, (end - start) as f64);
        for (k, weight) in weights.iter_mut().enumerate() {
            let x = k as f64 + 0.5;
            *weight = 1.0 / (x * (length - x)).sqrt();
            sum += *weight;
        }
        weights.iter_mut().for_each(|weight| *weight /= sum);
    }

    /// The energy (g, A g) of a piece.
    fn energy(&self, start: usize, end: usize) -> f64 {
        let g = &self.weights[start..end];
        if g.len() > SHORT_PIECE {
            return self.at(0.25 * g.len() as f64);
        }
        let displaced = |i: usize| -> f64 { g.iter().enumerate().map(|(j, g)| g * self.kernel[i.abs_diff(j)]).sum() };
        g.iter().enumerate().map(|(i, g)| g * displaced(i)).sum()
    }

    /// The influence coefficient at a distance in elements, linearly interpolated.
    fn at(&self, distance: f64) -> f64 {
        let distance = self.period.map_or(distance, |period| distance.min(period - distance));
        let k = (distance as usize).min(self.kernel.len() - 2);
        self.kernel[k] + (distance - k as f64) * (self.kernel[k + 1] - self.kernel[k])
    }

    /// Joins neighbours whose centres are in the same window of `length` elements.
    fn join_within(&mut self, length: f64) {
        let window = |punch: Punch| (punch.centre / length) as usize;
        let mut kept = 0_usize;
        for k in 0..self.open.len() {
            let next = self.open[k];
            let last = kept.checked_sub(1).map(|last| self.open[last]);
            match last.filter(|last| window(self.punches[*last as usize]) == window(self.punches[next as usize])) {
                Some(last) => self.open[kept - 1] = self.join(last, next),
                None => {
                    self.open[kept] = next;
                    kept += 1;
                }
            }
        }
        self.open.truncate(kept);
    }

    /// Joins two punches to the one with the least energy. Returns its number.
    fn join(&mut self, left: u32, right: u32) -> u32 {
        let (l, r) = (self.punches[left as usize], self.punches[right as usize]);
        let mutual = self.at(r.centre - l.centre);
        let energy = (l.energy + r.energy - 2.0 * mutual).max(LEAST_ENERGY * self.kernel[0].abs());
        let part = ((r.energy - mutual) / energy).clamp(0.0, 1.0);
        let rest = 1.0 - part;
        let (centre, mixed) = (part * l.centre + rest * r.centre, 2.0 * part * rest * mutual);
        let joined = part * part * l.energy + rest * rest * r.energy + mixed;
        self.joints.push(Joint { left, right, part, energy });
        self.punches.push(Punch { centre, energy: joined });
        self.punches.len() as u32 - 1
    }

    /// Replaces z by Q z: stores the mean of z on each piece, weighted by g, and subtracts it.
    pub(super) fn take_means<T: Real>(&mut self, z: &mut [T]) {
        for (&(start, end), mean) in self.pieces.iter().zip(&mut self.values) {
            let piece = start as usize..end as usize;
            let (z, g) = (&mut z[piece.clone()], &self.weights[piece]);
            *mean = z.iter().zip(g).map(|(z, g)| z.to_double() * g).sum();
            z.iter_mut().for_each(|z| *z = *z - T::of(*mean));
        }
    }

    /// Replaces z by Q^T z, plus the pressures of the forces that follow from the means. `without_force`: the forces have the sum 0.
    pub(super) fn give_forces<T: Real>(&mut self, z: &mut [T], without_force: bool) {
        self.find_forces(without_force);
        for (&(start, end), force) in self.pieces.iter().zip(&self.values) {
            let piece = start as usize..end as usize;
            let (z, g) = (&mut z[piece.clone()], &self.weights[piece]);
            let missing = FORCES_FACTOR * force - z.iter().map(|z| z.to_double()).sum::<f64>();
            z.iter_mut().zip(g).for_each(|(z, g)| *z += T::of(missing * g));
        }
    }

    /// Computes the forces on the pieces from the means of the residual.
    fn find_forces(&mut self, without_force: bool) {
        let Punches { values, joints, punches, pieces, .. } = self;
        for (k, Joint { left, right, part, .. }) in joints.iter().enumerate() {
            values[pieces.len() + k] = part * values[*left as usize] + (1.0 - part) * values[*right as usize];
        }
        if let (Some(value), Some(all)) = (values.last_mut(), punches.last()) {
            let stiffness = all.energy.max(LEAST_ENERGY * self.kernel[0].abs()).recip();
            *value *= if without_force { 0.0 } else { stiffness };
        }
        self.distribute();
    }

    /// Distributes the force of the last joint to the pieces; the means shift forces between the two punches of each joint.
    fn distribute(&mut self) {
        let Punches { values, joints, pieces, .. } = self;
        for (k, Joint { left, right, part, energy }) in joints.iter().enumerate().rev() {
            let (force, left, right) = (values[pieces.len() + k], *left as usize, *right as usize);
            let moved = (values[left] - values[right]) / energy;
            (values[left], values[right]) = (part * force + moved, (1.0 - part) * force - moved);
        }
    }

    /// Sets d to the pressure of a flat punch on all of C, with the mean 1 on C. d is 0 outside C before.
    pub(super) fn press_flat<T: Real>(&mut self, d: &mut [T]) {
        self.values.fill(0.0);
        if let Some(value) = self.values.last_mut() {
            *value = self.pieces.iter().map(|(start, end)| f64::from(end - start)).sum();
        }
        self.distribute();
        for (&(start, end), force) in self.pieces.iter().zip(&self.values) {
            let piece = start as usize..end as usize;
            d[piece.clone()].iter_mut().zip(&self.weights[piece]).for_each(|(d, g)| *d = T::of(force * g));
        }
    }

    /// Bytes of the kernel, the weights and the lists.
    pub(super) fn bytes(&self) -> usize {
        let lists = size_of::<(u32, u32)>() + size_of::<u32>() + size_of::<Joint>() + 2 * size_of::<Punch>() + 16;
        self.kernel.len() * 16 + self.pieces.capacity() * lists
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/punches.rs"]
mod tests;
