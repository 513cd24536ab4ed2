//! The unknowns of one grid, and the residuals of the conditions that they must satisfy.

use super::law::Attraction;
use crate::contact::{largest, relative, CANCELLED, ROUND_OFF};
use crate::error::Result;
use crate::memory::unwritten;
use crate::methods::fgmres::Bordered;
use crate::methods::fields;
use crate::threads::Threads;

/// One component per element. Fields may have several components, and those of adhesion have one.
pub type One = [f64; 1];

/// The name of the memory of unknowns in messages.
pub const MEMORY: &str = "the adhesion problem";

/// An iterate: total pressures p with the approach, displacements u = A p, and the contact area.
#[derive(Default)]
pub struct Unknowns {
    /// p as the field, and the approach as the border.
    pub p: Bordered<1>,
    /// u = A p, updated from step to step. [`Level::refresh`](super::level::Level::refresh) computes u anew.
    pub u: Vec<One>,
    /// The contact area C.
    pub contact: Vec<bool>,
}

impl Unknowns {
    /// p = 0 on n elements, without contact, at the approach 0.
    pub fn new(n: usize, threads: &Threads) -> Result<Unknowns> {
        let mut unknowns = Unknowns::without_fields(n, threads)?;
        unwritten(&mut unknowns.p.field, n, [f64::NAN], MEMORY, threads)?;
        unwritten(&mut unknowns.u, n, [f64::NAN], MEMORY, threads)?;
        unknowns.unload(threads);
        Ok(unknowns)
    }

    /// Unknowns of n elements without contact, and without the fields of pressures and displacements.
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

    /// Sets p = 0 and u = 0, without contact. The approach stays.
    pub fn unload(&mut self, threads: &Threads) {
        fields::fill(threads, &mut self.p.field, |_| [0.0]);
        fields::fill(threads, &mut self.u, |_| [0.0]);
        self.contact.fill(false);
    }

    /// Copies all of `other`.
    pub fn copy_from(&mut self, other: &Unknowns) -> Result<()> {
        self.copy_pressures(other, &Threads::One)?;
        self.copy_displacements(other)
    }

    /// Copies `other`, on large grids without u, which a product can recompute.
    pub fn keep(&mut self, other: &Unknowns, threads: &Threads) -> Result<()> {
        self.copy_pressures(other, threads)?;
        if is_small(other.u.len()) {
            self.copy_displacements(other)?;
        }
        Ok(())
    }

    /// Copies what [`Unknowns::keep`] has stored to other unknowns. Returns whether this includes u.
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

    /// Extrapolates along the line from the unknowns `from` through these: adds `part` times the difference to p and u. The contact area and the
    /// approach stay.
    pub fn go_along(&mut self, from: &Unknowns, part: f64, threads: &Threads) {
        let on = |[to]: [f64; 1], [from]: [f64; 1]| [to + part * (to - from)];
        fields::map(threads, &mut self.p.field, |i, to| on(to, from.p.field[i]));
        fields::map(threads, &mut self.u, |i, to| on(to, from.u[i]));
    }

    /// Bytes of the arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.p.field[..]) + size_of_val(&self.u[..]) + self.contact.len()
    }
}

/// The largest number of elements of a small grid.
const SMALL: usize = 1 << 15;

/// Whether a grid of n elements is small. There memory is spent to save products.
pub fn is_small(n: usize) -> bool {
    n <= SMALL
}

/// The surfaces of one grid: undeformed distances, the law of attraction, and the work of adhesion of each element.
#[derive(Default)]
pub struct Surface {
    /// The undeformed distances h; `+infinity` where there is no surface.
    pub h: Vec<f64>,
    /// The law of attraction, with the range of this grid.
    pub attraction: Attraction,
    /// The work of adhesion w of each element; empty if w is uniform.
    pub works: Vec<f64>,
    /// The uniform w, or the largest one.
    pub work: f64,
}

/// The smallest scale of pressures, relative to w/range. Bodies that are apart under a law of finite range have no pressures that could be the
/// scale.
const LEAST_PRESSURE_SCALE: f64 = f64::EPSILON;

impl Surface {
    /// The work of adhesion w of element i.
    #[inline]
    pub fn work_at(&self, i: usize) -> f64 {
        self.works.get(i).copied().unwrap_or(self.work)
    }

    /// The attraction sigma of element i at the distance e.
    #[inline]
    pub fn traction(&self, i: usize, e: f64) -> f64 {
        self.attraction.traction(self.work_at(i), e)
    }

    /// The deformed distance e = h - approach + u of element i.
    #[inline]
    pub fn distance(&self, i: usize, unknowns: &Unknowns) -> f64 {
        self.h[i] - unknowns.p.border[0] + unknowns.u[i][0]
    }
}

/// The residuals of the conditions, each relative to its own scale, and related counts. If contact pressures and attraction cancel, as below a
/// flat punch without a load, the total pressures are round-off. Therefore the scale of pressures is that of p, or [`CANCELLED`] times that of q
/// if this is larger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// The rms over C of e. It should be 0. The scale is the larger of two lengths: the rms over C of `h - approach`, and the displacement of one
    /// element by itself under the rms over C of p (or [`CANCELLED`] q). The residual is 0 if e and `h - approach` are the round-off of bodies
    /// that fit exactly. It is at least the size of `opening`, relative to the rms of `h - approach`.
    pub distance: f64,
    /// The largest -e outside C, a length; 0 if no e there is negative.
    pub penetration: f64,
    /// `penetration`, relative to the scale of `distance`.
    pub violation: f64,
    /// `||p + sigma(e)||` outside C, relative to `||p||`, or to [`CANCELLED`] times `||q||` in C if that is larger.
    pub law: f64,
    /// The size of the missing force, as the difference of sums of p, relative to the sum of |p|, or to [`CANCELLED`] times the sum of |q| in C.
    /// 0 if the approach is given.
    pub force: f64,
    /// The number of elements in contact.
    pub count: usize,
    /// The number of elements that have entered or left the contact since the last call.
    pub changed: usize,
    /// The sum of p.
    pub pressures: f64,
    /// The mean of `h - approach`, if all elements are in contact, the approach is given, and a uniform pressure displaces nothing: e then has
    /// this mean for any p. 0 otherwise.
    pub opening: f64,
}

impl Measured {
    /// Whether `distance` and `law` are within a tolerance, so that this is a state of equilibrium, whatever the force.
    pub fn is_state(&self, tolerance: f64) -> bool {
        largest([self.distance, self.law]) <= tolerance
    }

    /// The largest residual; infinite if one is NaN.
    pub fn worst(&self) -> f64 {
        largest([self.distance, self.violation, self.law, self.force])
    }

    /// The largest residual except `violation`, which a single element can keep large. It indicates the size of the next Newton step.
    pub fn residual(&self) -> f64 {
        largest([self.distance, self.law, self.force])
    }
}

/// Updates C by the natural map q - e/a0 > 0, unless it `is_kept`, and computes the residuals.
///
/// * `self_influence`: a0; `round_off`: the round-off of displacements per unit of pressure.
/// * `wanted`: the sum of p, if the force is given.
/// * `is_mean_free`: whether the approach is given and a uniform pressure displaces nothing.
pub fn measure(
    surface: &Surface,
    unknowns: &mut Unknowns,
    (self_influence, round_off): (f64, f64),
    (is_kept, wanted, is_mean_free): (bool, Option<f64>, bool),
    threads: &Threads,
) -> Measured {
    let Unknowns { p, u, contact } = unknowns;
    let (p, approach, u) = (&p.field, p.border[0], &*u);
    // `ee`, `dd`, `pc`, `qc`: sums of squares over C of e, h - approach, p and q; `off`: of p + sigma outside; `pp`: of p everywhere. `sum`,
    // `all`: sums of p and |p|; `repulsion`, `distances`: sums over C of |q| and h - approach.
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

/// The elastic energy `1/2 sum p u`, and the remaining work of the attraction, `sum W(e)`. Both are divided by the area of an element.
pub fn energies(surface: &Surface, unknowns: &Unknowns, threads: &Threads) -> [f64; 2] {
    fields::sum(threads, unknowns.u.len(), |i| {
        let e = surface.distance(i, unknowns);
        [0.5 * unknowns.p.field[i][0] * unknowns.u[i][0], surface.attraction.work_left(surface.work_at(i), e)]
    })
}
