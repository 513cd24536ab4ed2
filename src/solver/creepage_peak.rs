//! The largest force between creepages that were looked through, by golden sections of their logarithms (Brent 1973, chapter 5).

/// The part of the longer interval beside the largest force at which the next creepage lies: (3 - sqrt 5)/2.
const SECTION: f64 = 0.381_966_011_250_105_2;
/// A creepage below all others is this part of them.
const LESS: f64 = 0.3;
/// Sections at most: the creepage of the largest force is known to a thousandth then, and the force to a millionth.
const SECTIONS: usize = 16;
/// What lies above the last force by less than this is round-off of full slip.
const ABOVE: f64 = 1e-6;

/// Creepages, relative to some length, and the forces there, relative to mu N.
#[derive(Default)]
pub struct Peak {
    looked: Vec<(f64, f64)>,
    sections: usize,
}

impl Peak {
    /// Adds a creepage and its force; minus infinity where none was found.
    pub fn add(&mut self, creepage: f64, force: f64) {
        let at = self.looked.partition_point(|looked| looked.0 < creepage);
        self.looked.insert(at, (creepage, force));
    }

    /// The largest force so far.
    pub fn largest(&self) -> Option<f64> {
        self.looked.iter().map(|looked| looked.1).reduce(f64::max)
    }

    /// The next creepage. None: the largest force is that of full slip, or it is known well enough.
    pub fn next(&mut self) -> Option<f64> {
        let (largest, (_, last)) = (self.largest()?, *self.looked.last()?);
        let (best, (least, first)) =
            (self.looked.iter().position(|looked| looked.1 == largest)?, *self.looked.first()?);
        // Where the least creepage carries most of all, or all carry what full slip does, the largest force lies below.
        let exceeds = largest - last >= ABOVE;
        let is_below = best == 0 || !exceeds && first > last - ABOVE;
        if self.sections == SECTIONS || !(is_below || exceeds) {
            return None;
        }
        self.sections += 1;
        if is_below {
            return Some(LESS * least);
        }
        let [below, at, above] =
            [self.looked[best - 1].0, self.looked[best].0, self.looked.get(best + 1)?.0].map(f64::ln);
        let step = if above - at > at - below { above - at } else { below - at };
        Some((at + SECTION * step).exp())
    }
}

#[cfg(test)]
#[path = "../../tests/unit/creepage_peak.rs"]
mod tests;
