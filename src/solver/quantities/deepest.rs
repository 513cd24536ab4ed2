//! The largest stresses below the surface, over all depths.
//!
//! The first values are those at the surface and at depths that grow by a ratio, from a quarter of the shorter side of an element to the length of
//! the loaded part.
//! Then a parabola through the best depth and its two neighbours gives the next depth (successive parabolic interpolation; Brent 1973, chapter 5).

use crate::contact::presses;
use crate::error::Result;
use crate::friction::Vector;
use crate::grid::Grid;
use crate::memory::collected;
use crate::progress::ProgressCallback;
use crate::rectangle::Rectangle;
use crate::scene::Patches;
use crate::stress::{side, subsurface_stress, Body, Depth, Loads, Wanted};
use crate::threads::Threads;

/// The ratio of successive depths.
const DEPTH_RATIO: f64 = 1.6;
/// The first depth, in sides of an element.
const FIRST_DEPTH: f64 = 0.25;
/// Most parabolas, and the relative change of depth at which they end.
const PARABOLAS: usize = 8;
const DEPTH_CHANGE: f64 = 1e-3;
/// Depths next to the surface, in [sides](Surface::side) of an element.
pub const CLOSE: [f64; 7] = [
    0.0,
    FIRST_DEPTH,
    FIRST_DEPTH * DEPTH_RATIO,
    FIRST_DEPTH * DEPTH_RATIO * DEPTH_RATIO,
    FIRST_DEPTH * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO,
    FIRST_DEPTH * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO,
    FIRST_DEPTH * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO,
];

/// A largest value, and its depth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peak {
    pub value: f64,
    pub depth: f64,
    /// The depth in [sides](Surface::side) of an element.
    pub elements: f64,
    /// The largest value at each depth of [`CLOSE`]; 0: not known.
    pub close: [f64; CLOSE.len()],
}

impl Peak {
    /// The larger of two peaks.
    pub fn or(self, other: Peak) -> Peak {
        let larger = if other.value > self.value { other } else { self };
        let close = std::array::from_fn(|k| self.close[k].max(other.close[k]));
        Peak { close, ..larger }
    }

    /// Whether it lies within an element of the surface, where single pressures determine it.
    pub fn is_near(&self) -> bool {
        self.elements < 1.0
    }
}

/// Which stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stress {
    VonMises,
    Shear,
}

impl Stress {
    fn wanted(self) -> Wanted {
        match self {
            Stress::VonMises => Wanted { von_mises: true, ..Wanted::default() },
            Stress::Shear => Wanted { maximum_shear: true, ..Wanted::default() },
        }
    }

    fn largest(self, depth: &Depth, loads: &Loads<'_>) -> f64 {
        let values = if self == Stress::VonMises { &depth.von_mises } else { &depth.maximum_shear };
        let counts = loads.counted();
        let counted = values.iter().enumerate().filter(|(i, _)| counts(*i));
        counted.fold(0.0, |largest: f64, (_, value)| largest.max(*value))
    }
}

/// The loads on a surface: pressures, and tractions in x and in y, on body 1.
pub struct Surface<'a> {
    grid: Grid,
    /// The longer side of an element, or that across a single line of them: pressures change from element to element over this length.
    side: f64,
    periodic: bool,
    pressure: Vec<f64>,
    tractions: Option<[Vec<f64>; 2]>,
    patches: Option<Patches<'a>>,
}

impl<'a> Surface<'a> {
    /// The loads of a result: on the whole grid if it is periodic or has patches, else on the loaded part.
    pub fn of(
        (grid, periodic): (Grid, bool),
        pressure: &[f64],
        tractions: Option<&[Vector]>,
        patches: Option<Patches<'a>>,
        threads: &Threads,
    ) -> Result<Option<Surface<'a>>> {
        let loaded = Rectangle::around_values(pressure, &grid, threads, presses);
        let Some(loaded) = loaded else { return Ok(None) };
        let whole = periodic || patches.is_some();
        let part = if whole { Rectangle::full(&grid) } else { loaded };
        let cut = |value: &dyn Fn(usize) -> f64| {
            let (first, width) = (part.row(&grid, 0).start, part.x.len());
            let of_part = |k: usize| value(first + k / width * grid.mx + k % width);
            collected((0..part.count()).map(of_part), "loads of a largest stress")
        };
        let tractions = match tractions {
            Some(q) => Some([cut(&|i| q[i][0])?, cut(&|i| q[i][1])?]),
            None => None,
        };
        let (side, pressure) = (side(&grid), cut(&|i| pressure[i])?);
        let Body { grid, .. } = Body { grid: part.grid(&grid), poisson_ratio: 0.0, periodic }.of_square_elements();
        Ok(Some(Surface { grid, side, periodic, pressure, tractions, patches }))
    }

    /// The loads on body 2: opposite tractions.
    pub fn of_body_2(mut self) -> Surface<'a> {
        self.tractions.iter_mut().flatten().flatten().for_each(|q| *q = -*q);
        self
    }

    /// Whether bodies of the same Poisson ratio have the same stresses.
    pub fn is_the_same_for_both(&self) -> bool {
        self.tractions.is_none()
    }

    /// The largest stress over all depths, and its depth, in a body of this Poisson ratio. None: `watch` cancelled.
    pub fn peak(
        &self,
        stress: Stress,
        poisson_ratio: f64,
        threads: &Threads,
        watch: ProgressCallback<'_>,
    ) -> Result<Option<Peak>> {
        let (short, first) = (self.grid.dx.min(self.grid.dy), FIRST_DEPTH * self.side);
        let extent = (self.grid.mx as f64 * self.grid.dx).max(self.grid.my as f64 * self.grid.dy);
        // Between the shorter side and that of `CLOSE`.
        let mut depths: Vec<f64> = std::iter::successors(Some(first / DEPTH_RATIO), |z| Some(z / DEPTH_RATIO))
            .take_while(|z| *z > FIRST_DEPTH * short)
            .collect();
        let between = depths.len();
        depths.push(0.0);
        depths.reverse();
        depths.extend(
            std::iter::successors(Some(first), |z| Some(z * DEPTH_RATIO)).take_while(|z| *z < DEPTH_RATIO * extent),
        );
        let mut of = |depths: &[f64]| self.largest((stress, poisson_ratio), depths, threads, watch);
        let Some(mut known) = of(&depths)? else { return Ok(None) };
        let at = |k: usize| {
            let k = if k == 0 { 0 } else { between + k };
            known.get(k).or(known.last()).map_or(0.0, |peak| peak.value)
        };
        let close = std::array::from_fn(at);
        let mut is_close = false;
        for _ in 0..PARABOLAS {
            let best = (0..known.len()).max_by(|a, b| known[*a].value.total_cmp(&known[*b].value)).unwrap_or(0);
            if best + 1 == known.len() || best == 0 && is_close {
                break;
            }
            let z = match best {
                // A peak may lie between the surface and the first depth.
                0 => 0.5 * known[1].depth,
                best => vertex([known[best - 1], known[best], known[best + 1]]),
            };
            is_close = best == 0;
            if (z - known[best].depth).abs() <= DEPTH_CHANGE * known[best].depth {
                break;
            }
            let at = if z < known[best].depth { best } else { best + 1 };
            let Some(next) = of(&[z])? else { return Ok(None) };
            known.insert(at, next[0]);
        }
        let largest = known.iter().copied().fold(Peak::default(), Peak::or);
        Ok(Some(Peak { elements: largest.depth / self.side, close, ..largest }))
    }

    fn largest(
        &self,
        (stress, poisson_ratio): (Stress, f64),
        depths: &[f64],
        threads: &Threads,
        watch: ProgressCallback<'_>,
    ) -> Result<Option<Vec<Peak>>> {
        let body = Body { grid: self.grid, poisson_ratio, periodic: self.periodic };
        let [x, y] = match &self.tractions {
            Some([x, y]) => [Some(&x[..]), Some(&y[..])],
            None => [None, None],
        };
        let loads = Loads { pressure: Some(&self.pressure), traction_x: x, traction_y: y, patches: self.patches };
        let mut peaks = Vec::new();
        let each = |k: usize, depth: &Depth| {
            peaks.push(Peak { value: stress.largest(depth, &loads), depth: depths[k], ..Peak::default() });
        };
        let is_whole = subsurface_stress(&body, &loads, depths, &stress.wanted(), threads, Some(watch), each)?;
        Ok(is_whole.then_some(peaks))
    }
}

/// The depth of the vertex of the parabola through three points, of which the middle one is the highest. It keeps a margin of 2 % of an interval
/// from the outer two. If the vertex is undefined, the result is the depth of the middle.
fn vertex([a, b, c]: [Peak; 3]) -> f64 {
    let (left, right) = (b.depth - a.depth, c.depth - b.depth);
    let (rise, fall) = ((b.value - a.value) / left, (b.value - c.value) / right);
    // rise and -fall are the slopes at the middles of both parts; the slope is linear between them.
    let z = 0.5 * (a.depth + b.depth) + 0.5 * (left + right) * rise / (rise + fall);
    let margin = 0.02;
    if z.is_finite() {
        z.clamp(a.depth + margin * left, c.depth - margin * right)
    } else {
        b.depth
    }
}
