//! The largest force between creepages that were looked through: parabolas through three of them, or sections of their logarithms (Brent 1973, chapter 5).

/// The part of the longer interval beside the largest force at which a section lies: (3 - sqrt 5)/2.
const SECTION: f64 = 0.381_966_011_250_105_2;
/// Of intervals whose lengths differ by more than that the longer one is cut: where a force rises steeply on one side, parabolas leave that side as it is.
const UNLIKE: f64 = 3.0;
/// A parabola's vertex closer to the largest force than that part of its interval brings nothing.
const CLOSE: f64 = 0.02;
/// The largest force exceeds those that are known by no more than so many times what a parabola says, over an interval of no more than that factor: forces may
/// rise steeply up to the largest, and fall slowly from there.
const RISE: f64 = 10.0;
const NARROW: f64 = 0.3;
/// A creepage below all others is this part of them.
const LESS: f64 = 0.3;
/// Creepages at most.
const MOST: usize = 16;
/// What lies above the last force by less than this is round-off of full slip.
const ABOVE: f64 = 1e-6;

/// Creepages, relative to some length, and by how much the forces there exceed the one that is wanted, relative to mu N.
#[derive(Default)]
pub struct Peak {
    looked: Vec<(f64, f64)>,
    tried: usize,
}

impl Peak {
    /// Adds a creepage and what it exceeds the force by; minus infinity where no force was found.
    pub fn add(&mut self, creepage: f64, excess: f64) {
        let at = self.looked.partition_point(|looked| looked.0 < creepage);
        self.looked.insert(at, (creepage, excess));
    }

    /// The largest so far.
    pub fn largest(&self) -> Option<f64> {
        self.looked.iter().map(|looked| looked.1).reduce(f64::max)
    }

    /// The next creepage. None: the largest force is that of full slip, or the one that is wanted is out of reach.
    pub fn next(&mut self) -> Option<f64> {
        let (largest, (_, last)) = (self.largest().filter(|largest| largest.is_finite())?, *self.looked.last()?);
        let (best, (least, first)) =
            (self.looked.iter().position(|looked| looked.1 == largest)?, *self.looked.first()?);
        // Where the least creepage carries most of all, or all carry what full slip does, the largest force lies below.
        let exceeds = largest - last >= ABOVE;
        let is_below = best == 0 || !exceeds && first > last - ABOVE;
        if self.tried == MOST || !(is_below || exceeds) {
            return None;
        }
        self.tried += 1;
        if is_below {
            return Some(LESS * least);
        }
        let known = [self.looked[best - 1], self.looked[best], *self.looked.get(best + 1)?];
        let [below, at, above] = known.map(|(creepage, _)| creepage.ln());
        let section = at + SECTION * if above - at > at - below { above - at } else { below - at };
        if (above - at).max(at - below) > UNLIKE * (above - at).min(at - below) {
            return Some(section.exp());
        }
        let (vertex, rise) = parabola([below, at, above], known.map(|known| known.1));
        if above - below < NARROW && largest + RISE * rise < 0.0 {
            return None;
        }
        let is_apart = (vertex - at).abs() > CLOSE * (above - below);
        Some(if is_apart { vertex } else { section }.exp())
    }
}

/// Where the parabola through three points, of which the second is the highest, has its vertex, and by how much that exceeds the second. NaN where one of
/// them is minus infinity.
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
