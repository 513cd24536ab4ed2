//! The search for the largest force over creepages: parabolas through three creepages, or golden sections in the logarithm of the creepage (Brent
//! 1973, chapter 5).

/// Place of a golden section in the longer of the intervals next to the largest force: (3 - sqrt 5)/2.
const SECTION: f64 = 0.381_966_011_250_105_2;
/// Ratio of the intervals next to the largest force above which the longer one is cut: if a force rises steeply on one side, parabolas would leave
/// that side unchanged.
const UNLIKE_INTERVALS: f64 = 3.0;
/// Least distance of a parabola's vertex from the largest force, as a part of its interval.
const LEAST_DISTANCE: f64 = 0.02;
/// Bound on the rise of the largest force above the known ones, over the parabola's prediction, for intervals narrower than [`NARROW`] in the
/// logarithm of the creepage: forces may rise steeply up to the largest, and fall slowly from there.
const RISE: f64 = 10.0;
const NARROW: f64 = 0.3;
/// Ratio of a creepage below all others to the least.
const LOWER_CREEPAGE: f64 = 0.3;
/// Most creepages.
const MOST_CREEPAGES: usize = 16;
/// Excess over the last force below which a force is round-off of full slip.
const LEAST_EXCESS: f64 = 1e-6;

/// Creepages, relative to a length, and the excess of their forces over the wanted one, relative to mu N.
#[derive(Default)]
pub struct Peak {
    looked: Vec<(f64, f64)>,
    tried: usize,
}

impl Peak {
    /// Adds a creepage and its excess; minus infinity if no force was found.
    pub fn add(&mut self, creepage: f64, excess: f64) {
        let at = self.looked.partition_point(|looked| looked.0 < creepage);
        self.looked.insert(at, (creepage, excess));
    }

    /// The largest excess so far.
    pub fn largest(&self) -> Option<f64> {
        self.looked.iter().map(|looked| looked.1).reduce(f64::max)
    }

    /// The next creepage. None: the largest force is that of full slip, the wanted force is out of reach, or [`MOST_CREEPAGES`] were tried.
    pub fn next(&mut self) -> Option<f64> {
        let (largest, (_, last)) = (self.largest().filter(|largest| largest.is_finite())?, *self.looked.last()?);
        let (best, (least, first)) =
            (self.looked.iter().position(|looked| looked.1 == largest)?, *self.looked.first()?);
        // If the least creepage has the largest force, or all forces are those of full slip, the largest force lies below.
        let exceeds = largest - last >= LEAST_EXCESS;
        let is_below = best == 0 || !exceeds && first > last - LEAST_EXCESS;
        if self.tried == MOST_CREEPAGES || !(is_below || exceeds) {
            return None;
        }
        self.tried += 1;
        if is_below {
            return Some(LOWER_CREEPAGE * least);
        }
        let known = [self.looked[best - 1], self.looked[best], *self.looked.get(best + 1)?];
        let [below, at, above] = known.map(|(creepage, _)| creepage.ln());
        let section = at + SECTION * if above - at > at - below { above - at } else { below - at };
        if (above - at).max(at - below) > UNLIKE_INTERVALS * (above - at).min(at - below) {
            return Some(section.exp());
        }
        let (vertex, rise) = parabola([below, at, above], known.map(|known| known.1));
        if above - below < NARROW && largest + RISE * rise < 0.0 {
            return None;
        }
        let is_apart = (vertex - at).abs() > LEAST_DISTANCE * (above - below);
        Some(if is_apart { vertex } else { section }.exp())
    }
}

/// The vertex of the parabola through three points, the second of which is the highest, and its excess over the second. NaN if one of them is minus
/// infinity.
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
