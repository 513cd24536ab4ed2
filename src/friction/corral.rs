//! The corral, a convex polygon in the plane of creepages that contains the wanted creepages c* of given forces F*. Each force F(c) that is computed
//! for other creepages c cuts off a part of the polygon.
//!
//! Forces fall as creepages grow, `(F(c) - F(c')).(c - c') <= 0`. So the wanted creepages lie in the half-plane `(F(c) - F*).(c* - c) >= 0`. A cut
//! through the centroid leaves at most 5/9 of the area (Gruenbaum 1960), so that the search ends.

use super::plane::{dot, plus, Vector};

/// Other creepages than the centre of the corral are good if their missing force is at most this part of an earlier one. One half is about what the
/// centre achieves.
pub const PROGRESS: f64 = 0.5;

/// The polygon. With one unknown creepage it is a rectangle, which is cut at right angles to that creepage.
pub struct Corral {
    /// The corners, counterclockwise.
    corners: Vec<Vector>,
    /// Whether the force in x is given, and that in y: then that creepage is unknown.
    given: [bool; 2],
}

impl Corral {
    /// The square of creepages from `-half` to `half`.
    pub fn new(half: f64, given: [bool; 2]) -> Corral {
        let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
        Corral { corners: corners.to_vec(), given }
    }

    /// Cuts the polygon along the line through `trial`, the creepages of a trial whose forces exceed the given ones by `excess`.
    pub fn cut(&mut self, trial: Vector, excess: Vector) {
        let side = |c: Vector| dot(excess, plus(c, -1.0, trial));
        let mut kept = Vec::with_capacity(self.corners.len() + 1);
        for (k, &from) in self.corners.iter().enumerate() {
            let to = self.corners[(k + 1) % self.corners.len()];
            let (side_from, side_to) = (side(from), side(to));
            if side_from >= 0.0 {
                kept.push(from);
            }
            if (side_from > 0.0 && side_to < 0.0) || (side_from < 0.0 && side_to > 0.0) {
                let part = side_from / (side_from - side_to);
                kept.push([0, 1].map(|k| from[k] + part * (to[k] - from[k])));
            }
        }
        // If no corner is left, by round-off, the polygon is as small as double precision resolves, and stays.
        if !kept.is_empty() {
            self.corners = kept;
        }
    }

    /// The centroid; the mean of the corners if the area is 0 by round-off.
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

    /// Whether the polygon contains c: c lies to the left of all edges, or on them.
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
