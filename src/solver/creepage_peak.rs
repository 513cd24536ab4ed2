//! The search for the creepage of the largest force. The next creepage is the vertex of a parabola through the best three, or a golden section, in
//! the logarithm of the creepage (Brent 1973, chapter 5).

/// Position of a golden section in the longer of the two intervals next to the largest force, from that force: (3 - sqrt 5)/2.
const SECTION: f64 = 0.381_966_011_250_105_2;
/// If the intervals next to the largest force differ by more than this ratio, the longer one gets a golden section. If the force rises steeply on one
/// side, parabolas alone would never shorten the interval of that side.
const UNLIKE_INTERVALS: f64 = 3.0;
/// A vertex that is closer to the creepage of the largest force is replaced by a golden section. Relative to the sum of both intervals.
const LEAST_DISTANCE: f64 = 0.02;
/// The wanted force is out of reach if it exceeds the largest known one by more than this times the rise that the parabola predicts. The factor is
/// large because forces may rise steeply up to the largest, and decrease slowly from there.
const RISE: f64 = 10.0;
/// The test with [`RISE`] needs a sum of both intervals below this, in the logarithm of the creepage.
const NARROW: f64 = 0.3;
/// If the largest force lies below all creepages, the next one is this times the least.
const LOWER_CREEPAGE: f64 = 0.3;
/// Most creepages that [`Peak::next`] proposes.
const MOST_CREEPAGES: usize = 16;
/// Forces that differ from the one at the largest creepage by less than this, relative to mu N, are those of full slip, but for round-off.
const LEAST_EXCESS: f64 = 1e-6;

/// The creepages so far, and their forces.
#[derive(Default)]
pub struct Peak {
    /// In increasing order: a creepage, in any unit, and the excess of its force over the wanted one, relative to mu N.
    known: Vec<(f64, f64)>,
    /// The number of creepages that [`Peak::next`] has proposed.
    tried: usize,
}

impl Peak {
    /// Adds a creepage and the excess of its force; minus infinity if its turns did not converge.
    pub fn add(&mut self, creepage: f64, excess: f64) {
        let place = self.known.partition_point(|(known, _)| *known < creepage);
        self.known.insert(place, (creepage, excess));
    }

    /// The largest excess so far.
    pub fn largest(&self) -> Option<f64> {
        self.known.iter().map(|(_, excess)| *excess).reduce(f64::max)
    }

    /// The next creepage. None: the largest force is that of full slip, the wanted force is out of reach, [`MOST_CREEPAGES`] were proposed, or no
    /// force is known.
    pub fn next(&mut self) -> Option<f64> {
        let (largest, (_, last)) = (self.largest().filter(|largest| largest.is_finite())?, *self.known.last()?);
        let (best, (least, first)) =
            (self.known.iter().position(|(_, excess)| *excess == largest)?, *self.known.first()?);
        // If the least creepage has the largest force, or all forces are those of full slip, the largest force belongs to a lower creepage.
        let exceeds = largest - last >= LEAST_EXCESS;
        let is_below = best == 0 || !exceeds && first > last - LEAST_EXCESS;
        if self.tried == MOST_CREEPAGES || !(is_below || exceeds) {
            return None;
        }
        self.tried += 1;
        if is_below {
            return Some(LOWER_CREEPAGE * least);
        }
        let three = [self.known[best - 1], self.known[best], *self.known.get(best + 1)?];
        let [below, top, above] = three.map(|(creepage, _)| creepage.ln());
        let section = top + SECTION * if above - top > top - below { above - top } else { below - top };
        if (above - top).max(top - below) > UNLIKE_INTERVALS * (above - top).min(top - below) {
            return Some(section.exp());
        }
        let (vertex, rise) = parabola([below, top, above], three.map(|(_, excess)| excess));
        if above - below < NARROW && largest + RISE * rise < 0.0 {
            return None;
        }
        let is_apart = (vertex - top).abs() > LEAST_DISTANCE * (above - below);
        Some(if is_apart { vertex } else { section }.exp())
    }
}

/// The vertex of the parabola through three points, the second of which is the highest: its x, and its y less that of the second point. NaN if a y is
/// minus infinity.
fn parabola(x: [f64; 3], y: [f64; 3]) -> (f64, f64) {
    let (before, after) = (x[1] - x[0], x[2] - x[1]);
    let (up, down) = ((y[1] - y[0]) / before, (y[2] - y[1]) / after);
    let curvature = (down - up) / (before + after);
    let slope = up + curvature * before;
    (x[1] - 0.5 * slope / curvature, -0.25 * slope * slope / curvature)
}

#[cfg(test)]
#[path = "../../tests/unit/creepage_peak.rs"]
mod tests;
