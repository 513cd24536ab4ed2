//! The unknowns of one grid, and their measures.

use super::law::Attraction;
use crate::contact::{largest, relative, CANCELLED, ROUND_OFF};
use crate::error::Result;
use crate::memory::unwritten;
use crate::methods::fgmres::Bordered;
use crate::methods::fields;
use crate::threads::Threads;

/// A number per element, as fields of one number.
pub type One = [f64; 1];

/// The name of this memory in messages.
pub const MEMORY: &str = "the adhesion problem";

/// Total pressures p with the approach as their border, u = A p, and the contact area.
#[derive(Default)]
pub struct Unknowns {
    /// p, and the approach.
    pub p: Bordered<1>,
    /// u = A p, updated from step to step.
    pub u: Vec<One>,
    /// C.
    pub contact: Vec<bool>,
}

impl Unknowns {
    /// p = 0 on n elements.
    pub fn new(n: usize, threads: &Threads) -> Result<Unknowns> {
        let mut unknowns = Unknowns::without_fields(n, threads)?;
        unwritten(&mut unknowns.p.field, n, [f64::NAN], MEMORY, threads)?;
        unwritten(&mut unknowns.u, n, [f64::NAN], MEMORY, threads)?;
        unknowns.unload(threads);
        Ok(unknowns)
    }

    /// Unknowns of n elements out of contact, without the fields of pressures and displacements.
    pub fn without_fields(n: usize, threads: &Threads) -> Result<Unknowns> {
        let mut unknowns = Unknowns::default();
        unwritten(&mut unknowns.contact, n, false, MEMORY, threads)?;
        unknowns.contact.fill(false);
        Ok(unknowns)
    }

    /// The approach.
    pub fn approach(&self) -> f64 {
        self.p.border[0]
    }

    /// Sets p = 0, without contact.
    pub fn unload(&mut self, threads: &Threads) {
        fields::fill(threads, &mut self.p.field, |_| [0.0]);
        fields::fill(threads, &mut self.u, |_| [0.0]);
        self.contact.fill(false);
    }

    /// Copies other unknowns.
    pub fn copy_from(&mut self, other: &Unknowns) -> Result<()> {
        self.copy_pressures(other, &Threads::One)?;
        self.copy_displacements(other)
    }

    /// Copies other unknowns; on large grids without u, which a product recomputes.
    pub fn keep(&mut self, other: &Unknowns, threads: &Threads) -> Result<()> {
        self.copy_pressures(other, threads)?;
        if is_small(other.u.len()) {
            self.copy_displacements(other)?;
        }
        Ok(())
    }

    /// Copies what was kept to other unknowns. Returns whether u was kept and is copied as well.
    pub fn put(&self, to: &mut Unknowns) -> bool {
        to.p.field.copy_from_slice(&self.p.field);
        to.contact.copy_from_slice(&self.contact);
        to.p.border = self.p.border;
        if !self.u.is_empty() {
            to.u.copy_from_slice(&self.u);
        }
        !self.u.is_empty()
    }

    fn copy_pressures(&mut self, other: &Unknowns, threads: &Threads) -> Result<()> {
        let n = other.u.len();
        unwritten(&mut self.p.field, n, [f64::NAN], MEMORY, threads)?;
        unwritten(&mut self.contact, n, false, MEMORY, threads)?;
        fields::fill(threads, &mut self.p.field, |i| other.p.field[i]);
        self.contact.copy_from_slice(&other.contact);
        self.p.border = other.p.border;
        Ok(())
    }

    fn copy_displacements(&mut self, other: &Unknowns) -> Result<()> {
        unwritten(&mut self.u, other.u.len(), [f64::NAN], MEMORY, &Threads::One)?;
        self.u.copy_from_slice(&other.u);
        Ok(())
    }

    /// Extrapolates from other unknowns through these: adds `part` times the difference. The contact area stays.
    pub fn go_along(&mut self, from: &Unknowns, part: f64, threads: &Threads) {
        let on = |[to]: [f64; 1], [from]: [f64; 1]| [to + part * (to - from)];
        fields::map(threads, &mut self.p.field, |i, to| on(to, from.p.field[i]));
        fields::map(threads, &mut self.u, |i, to| on(to, from.u[i]));
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.p.field[..]) + size_of_val(&self.u[..]) + self.contact.len()
    }
}

/// Most elements of a small grid.
const SMALL: usize = 1 << 15;

/// Whether a grid of n elements is small, so that memory is spent to save products.
pub fn is_small(n: usize) -> bool {
    n <= SMALL
}

/// The surfaces: h, the law and the work of adhesion of each element.
#[derive(Default)]
pub struct Surface {
    /// h; `+infinity` where there is no surface.
    pub h: Vec<f64>,
    /// The law, with the range of this grid.
    pub attraction: Attraction,
    /// w of each element; empty if w is uniform.
    pub works: Vec<f64>,
    /// The uniform or the largest w.
    pub work: f64,
}

/// Least scale of pressures, relative to w/range: bodies that are apart under a law of finite range have no pressures.
const LEAST_PRESSURE_SCALE: f64 = f64::EPSILON;

impl Surface {
    /// w of element i.
    #[inline]
    pub fn work_at(&self, i: usize) -> f64 {
        self.works.get(i).copied().unwrap_or(self.work)
    }

    /// sigma of element i at a distance.
    #[inline]
    pub fn traction(&self, i: usize, e: f64) -> f64 {
        self.attraction.traction(self.work_at(i), e)
    }

    /// e = h - approach + u of element i.
    #[inline]
    pub fn distance(&self, i: usize, unknowns: &Unknowns) -> f64 {
        self.h[i] - unknowns.p.border[0] + unknowns.u[i][0]
    }
}

/// The measures of the conditions, each relative to its own scale. If contact pressures and attraction cancel, as below a flat punch without a
/// load, total pressures are round-off: the scale of pressures is p, or [`CANCELLED`] times q if that is larger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// rms over C of e, relative to that of `h - approach`, or to the displacement of one element by itself under p or
    /// [`CANCELLED`] q, whichever is larger. 0 if both are the round-off of bodies that fit exactly. At least the size
    /// of `opening`, relative to the rms of `h - approach`.
    pub distance: f64,
    /// The largest -e outside C, a length; 0 if there is none.
    pub penetration: f64,
    /// The penetration relative to the scale of `distance`.
    pub violation: f64,
    /// `||p + sigma(e)||` outside C, relative to `||p||`, or to [`CANCELLED`] times `||q||` in C if that is larger.
    pub law: f64,
    /// The given force less the sum of p, relative to the sum of |p|, or to [`CANCELLED`] times the sum of q.
    pub force: f64,
    /// Elements in contact.
    pub count: usize,
    /// Elements that have entered or left the contact.
    pub changed: usize,
    /// The sum of p.
    pub pressures: f64,
    /// The mean of `h - approach` if all elements touch and a uniform pressure displaces nothing: e has this mean for any p. 0 otherwise.
    pub opening: f64,
}

impl Measured {
    /// Whether distances and law are met to a tolerance, whatever the force.
    pub fn is_state(&self, tolerance: f64) -> bool {
        largest([self.distance, self.law]) <= tolerance
    }

    /// The largest measure; infinite if one is NaN.
    pub fn worst(&self) -> f64 {
        largest([self.distance, self.violation, self.law, self.force])
    }

    /// The largest measure without the violation, which a single element can keep large: the size of the next Newton step.
    pub fn residual(&self) -> f64 {
        largest([self.distance, self.law, self.force])
    }
}

/// Takes C from the natural map q - e/a0 > 0, unless it `is_kept`, and measures. `round_off`: that of displacements per unit of pressure; `wanted`:
/// the sum of p if the force is given; `is_mean_free`: whether the approach is given and a uniform pressure displaces nothing.
pub fn measure(
    surface: &Surface,
    unknowns: &mut Unknowns,
    (self_influence, round_off): (f64, f64),
    (is_kept, wanted, is_mean_free): (bool, Option<f64>, bool),
    threads: &Threads,
) -> Measured {
    let Unknowns { p, u, contact } = unknowns;
    let (p, approach, u) = (&p.field, p.border[0], &*u);
    let [ee, dd, count, off, pp, pc, sum, all, qc, repulsion, changed, distances] =
        fields::over(threads, contact.chunks_mut(fields::BLOCK), |first, contact| {
            let mut sums = [0.0; 12];
            for (k, inside) in contact.iter_mut().enumerate() {
                let i = first + k;
                let ([p], e) = (p[i], surface.h[i] - approach + u[i][0]);
                let q = p + surface.traction(i, e);
                let was_inside = *inside;
                *inside = if is_kept { *inside } else { q - e / self_influence > 0.0 };
                sums[10] += f64::from(u8::from(was_inside != *inside));
                (sums[4], sums[6], sums[7]) = (sums[4] + p * p, sums[6] + p, sums[7] + p.abs());
                if *inside {
                    let d = surface.h[i] - approach;
                    (sums[0], sums[1], sums[2], sums[5]) =
                        (sums[0] + e * e, sums[1] + d * d, sums[2] + 1.0, sums[5] + p * p);
                    (sums[8], sums[9], sums[11]) = (sums[8] + q * q, sums[9] + q.abs(), sums[11] + d);
                } else {
                    sums[3] += q * q;
                }
            }
            sums
        });
    let outside = |i: usize| if unknowns.contact[i] { 0.0 } else { approach - surface.h[i] - u[i][0] };
    let penetration = fields::largest(threads, u.len(), outside);
    let n = f64::max(count, 1.0);
    let (part, nothing) = (CANCELLED * CANCELLED * qc, LEAST_PRESSURE_SCALE * surface.work / surface.attraction.range);
    let scale = (dd / n).sqrt().max(self_influence * (pc.max(part) / n).sqrt());
    let scale = if count > 0.0 { scale } else { scale.max(self_influence * (pp / u.len() as f64).sqrt()) };
    let noise = ROUND_OFF * approach.abs() + round_off * (pc.max(qc) / n).sqrt();
    let [of_e, of_d] = [ee, dd].map(|squares| (squares / n).sqrt());
    let fits = noise.is_finite() && of_d <= noise && of_e <= noise;
    let opening = if is_mean_free && count as usize == u.len() { distances / n } else { 0.0 };
    let opening = if opening.abs() <= ROUND_OFF * approach.abs() { 0.0 } else { opening };
    Measured {
        distance: if fits { 0.0 } else { relative(of_e, scale) }.max(relative(opening.abs(), of_d)),
        penetration,
        violation: if fits && penetration <= noise { 0.0 } else { relative(penetration, scale) },
        law: relative(off.sqrt(), pp.max(part).sqrt().max(nothing)),
        force: wanted.map_or(0.0, |wanted| relative((sum - wanted).abs(), all.max(CANCELLED * repulsion).max(nothing))),
        count: count as usize,
        changed: changed as usize,
        pressures: sum,
        opening,
    }
}

/// The elastic energy `1/2 sum p u`, and the remaining work of the attraction, `sum W(e)`, both per area of an element.
pub fn energies(surface: &Surface, unknowns: &Unknowns, threads: &Threads) -> [f64; 2] {
    fields::sum(threads, unknowns.u.len(), |i| {
        let e = surface.distance(i, unknowns);
        [0.5 * unknowns.p.field[i][0] * unknowns.u[i][0], surface.attraction.work_left(surface.work_at(i), e)]
    })
}
