//! A convex polygon that contains the creepages of given forces. Each computed force cuts off a part.
//!
//! Forces F fall as creepages c grow, `(F(c) - F(c*)).(c - c*) <= 0`: from the force at c follows `(F(c) - F*).(c* - c) >= 0` for the wanted
//! force F* at c*. Cuts through the centroid leave at most 5/9 of the area (Gruenbaum 1960), so the search ends.

use super::plane::{dot, plus, Vector};

/// A trial is good if its missing force is at most this part of the last or least one. One half is about what the centre of the corral achieves,
/// which follows trials that are not good.
pub const PROGRESS: f64 = 0.5;

/// The polygon; with one unknown creepage a rectangle, whose cuts are parallel.
pub struct Corral {
    corners: Vec<Vector>,
    given: [bool; 2],
}

impl Corral {
    /// Creepages up to `half` in each direction with a given force.
    pub fn new(half: f64, given: [bool; 2]) -> Corral {
        let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
        Corral { corners: corners.to_vec(), given }
    }

    /// Cuts off the part that the `excess` of the forces at `at` excludes.
    pub fn cut(&mut self, at: Vector, excess: Vector) {
        let beyond = |c: Vector| dot(excess, plus(c, -1.0, at));
        let mut kept = Vec::with_capacity(self.corners.len() + 1);
        for (k, &from) in self.corners.iter().enumerate() {
            let to = self.corners[(k + 1) % self.corners.len()];
            let (here, there) = (beyond(from), beyond(to));
            if here >= 0.0 {
                kept.push(from);
            }
            if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                let part = here / (here - there);
                kept.push([0, 1].map(|k| from[k] + part * (to[k] - from[k])));
            }
        }
        // If round-off leaves nothing, the polygon is as small as double precision resolves.
        if !kept.is_empty() {
            self.corners = kept;
        }
    }

    /// The centroid.
    pub fn centre(&self) -> Vector {
        let first = self.corners[0];
        let (mut area, mut moment) = (0.0, [0.0; 2]);
        for pair in self.corners.windows(2) {
            let (a, b) = (plus(pair[0], -1.0, first), plus(pair[1], -1.0, first));
            let twice = a[0] * b[1] - a[1] * b[0];
            area += twice;
            moment = plus(plus(moment, twice / 3.0, a), twice / 3.0, b);
        }
        let centre = plus(first, 1.0 / area, moment);
        let is_inside = area > 0.0 && centre.iter().all(|value| value.is_finite());
        let mean = || {
            let sum = self.corners.iter().fold([0.0; 2], |sum, corner| plus(sum, 1.0, *corner));
            sum.map(|sum| sum / self.corners.len() as f64)
        };
        self.only_given(if is_inside { centre } else { mean() })
    }

    /// Whether a place lies inside: all edges turn the same way around it.
    pub fn holds(&self, c: Vector) -> bool {
        let sides = self.corners.iter().enumerate().map(|(k, from)| {
            let to = self.corners[(k + 1) % self.corners.len()];
            (to[0] - from[0]) * (c[1] - from[1]) - (to[1] - from[1]) * (c[0] - from[0])
        });
        let is_polygon = self.corners.len() > 2;
        is_polygon && c.iter().all(|value| value.is_finite()) && sides.into_iter().all(|side| side >= 0.0)
    }

    fn only_given(&self, c: Vector) -> Vector {
        [0, 1].map(|k| if self.given[k] { c[k] } else { 0.0 })
    }
}
