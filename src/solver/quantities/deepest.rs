//! The largest stress at and below the surface, over all depths.
//!
//! First the largest stresses at the surface and at a geometric series of depths are computed: from a quarter of the shorter side of an element to
//! the length of the loaded part. Then the vertex of a parabola through the best depth and its two neighbours gives the next depth (successive
//! parabolic interpolation; Brent 1973, chapter 5).

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
/// Most parabolas.
const PARABOLAS: usize = 8;
/// Relative change of the best depth at which the search ends.
const DEPTH_CHANGE: f64 = 1e-3;
/// Depths close to the surface whose largest stresses are followed from grid to grid, in [sides](Surface::side) of an element.
pub const CLOSE: [f64; 7] = [
    0.0,
    FIRST_DEPTH,
    FIRST_DEPTH * DEPTH_RATIO,
    FIRST_DEPTH * DEPTH_RATIO * DEPTH_RATIO,
    FIRST_DEPTH * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO,
    FIRST_DEPTH * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO,
    FIRST_DEPTH * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO * DEPTH_RATIO,
];

/// The largest stress over all depths, or at one depth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peak {
    /// The stress.
    pub value: f64,
    /// The depth of this stress.
    pub depth: f64,
    /// The depth in [sides](Surface::side) of an element.
    pub elements: f64,
    /// The largest stress at each depth of [`CLOSE`]; 0 if unknown.
    pub close: [f64; CLOSE.len()],
}

impl Peak {
    /// The larger of two peaks, with the larger of both stresses at each depth of [`CLOSE`].
    pub fn or(self, other: Peak) -> Peak {
        let larger = if other.value > self.value { other } else { self };
        let close = std::array::from_fn(|k| self.close[k].max(other.close[k]));
        Peak { close, ..larger }
    }

    /// Whether the peak is less than an element below the surface, where single pressures determine it.
    pub fn is_near(&self) -> bool {
        self.elements < 1.0
    }
}

/// Which stress is searched for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stress {
    /// The von Mises stress.
    VonMises,
    /// The maximum shear stress.
    Shear,
}

impl Stress {
    /// The outputs of a stress computation with this stress alone.
    fn wanted(self) -> Wanted {
        match self {
            Stress::VonMises => Wanted { von_mises: true, ..Wanted::default() },
            Stress::Shear => Wanted { maximum_shear: true, ..Wanted::default() },
        }
    }

    /// The largest value at one depth.
    fn largest(self, depth: &Depth, loads: &Loads<'_>) -> f64 {
        let values = if self == Stress::VonMises { &depth.von_mises } else { &depth.maximum_shear };
        let counts = loads.counted();
        let counted = values.iter().enumerate().filter(|(i, _)| counts(*i));
        counted.fold(0.0, |largest: f64, (_, value)| largest.max(*value))
    }
}

/// The loads on the surface of a body: pressures, and tractions in x and in y.
pub struct Surface<'a> {
    /// The loaded part of the grid, or the whole grid.
    grid: Grid,
    /// The length over which pressures change from element to element: the longer side of an element, or its side along a single line of elements.
    side: f64,
    /// Whether the loads repeat in both directions.
    periodic: bool,
    pressure: Vec<f64>,
    tractions: Option<[Vec<f64>; 2]>,
    patches: Option<Patches<'a>>,
}

impl<'a> Surface<'a> {
    /// The loads of a result on body 1: on the whole grid if the scene is periodic or has patches, else on the loaded part. None without loads.
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

    /// Whether two bodies of the same Poisson ratio have the same stresses: without tractions, which are opposite on body 2.
    pub fn is_the_same_for_both(&self) -> bool {
        self.tractions.is_none()
    }

    /// Finds the largest stress over all depths in a body of this Poisson ratio. None: `watch` cancelled.
    pub fn peak(
        &self,
        stress: Stress,
        poisson_ratio: f64,
        threads: &Threads,
        watch: ProgressCallback<'_>,
    ) -> Result<Option<Peak>> {
        let (short, first) = (self.grid.dx.min(self.grid.dy), FIRST_DEPTH * self.side);
        let extent = (self.grid.mx as f64 * self.grid.dx).max(self.grid.my as f64 * self.grid.dy);
        // Depths between the surface and the first positive depth of `CLOSE`, down to a quarter of the shorter side.
        let mut depths: Vec<f64> = std::iter::successors(Some(first / DEPTH_RATIO), |z| Some(z / DEPTH_RATIO))
            .take_while(|z| *z > FIRST_DEPTH * short)
            .collect();
        let between = depths.len();
        depths.push(0.0);
        depths.reverse();
        depths.extend(
            std::iter::successors(Some(first), |z| Some(z * DEPTH_RATIO)).take_while(|z| *z < DEPTH_RATIO * extent),
        );
        let mut largest_at = |depths: &[f64]| self.largest((stress, poisson_ratio), depths, threads, watch);
        let Some(mut known) = largest_at(&depths)? else { return Ok(None) };
        let at_close_depth = |k: usize| {
            let k = if k == 0 { 0 } else { between + k };
            known.get(k).or(known.last()).map_or(0.0, |peak| peak.value)
        };
        let close = std::array::from_fn(at_close_depth);
        // Whether the surface was the best depth before, so that the depth halfway to the next one has been tried.
        let mut is_at_surface = false;
        for _ in 0..PARABOLAS {
            let best = (0..known.len()).max_by(|a, b| known[*a].value.total_cmp(&known[*b].value)).unwrap_or(0);
            if best + 1 == known.len() || best == 0 && is_at_surface {
                break;
            }
            let z = match best {
                // A peak may lie between the surface and the next depth.
                0 => 0.5 * known[1].depth,
                best => vertex([known[best - 1], known[best], known[best + 1]]),
            };
            is_at_surface = best == 0;
            if (z - known[best].depth).abs() <= DEPTH_CHANGE * known[best].depth {
                break;
            }
            let place = if z < known[best].depth { best } else { best + 1 };
            let Some(next) = largest_at(&[z])? else { return Ok(None) };
            known.insert(place, next[0]);
        }
        let largest = known.iter().copied().fold(Peak::default(), Peak::or);
        Ok(Some(Peak { elements: largest.depth / self.side, close, ..largest }))
    }

    /// The largest stress at each of the depths. None: `watch` cancelled.
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

/// The depth of the vertex of the parabola through three points, of which the middle one has the largest stress. The depth keeps a margin of 2 % of
/// an interval from the outer two. If the vertex is undefined, the result is the depth of the middle point.
fn vertex([a, b, c]: [Peak; 3]) -> f64 {
    let (left, right) = (b.depth - a.depth, c.depth - b.depth);
    let (rise, fall) = ((b.value - a.value) / left, (b.value - c.value) / right);
    // The slopes of the parabola in the middle of both intervals are `rise` and `-fall`; between them the slope is linear in the depth.
    let z = 0.5 * (a.depth + b.depth) + 0.5 * (left + right) * rise / (rise + fall);
    let margin = 0.02;
    if z.is_finite() {
        z.clamp(a.depth + margin * left, c.depth - margin * right)
    } else {
        b.depth
    }
}
