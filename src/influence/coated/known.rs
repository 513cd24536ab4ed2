//! A cache of tables. Scenes with the same materials share them.

use std::sync::{Arc, Mutex, PoisonError};

/// A layer's materials: G1/G2 and both Poisson ratios.
type Materials = [f64; 3];

/// The most tables in the cache. Each has about 20 kB.
const MOST: usize = 16;

/// Tables with their materials, the latest last.
pub struct Known<T>(Mutex<Vec<(Materials, Arc<T>)>>);

impl<T> Known<T> {
    /// An empty cache.
    pub const fn new() -> Known<T> {
        Known(Mutex::new(Vec::new()))
    }

    /// The table of some materials, computed if the cache does not have it.
    pub fn get(&self, materials: Materials, make: impl FnOnce() -> T) -> Arc<T> {
        let known = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, table)) = known().iter().find(|(of, _)| *of == materials) {
            return table.clone();
        }
        let table = Arc::new(make());
        let mut known = known();
        if known.len() == MOST {
            known.remove(0);
        }
        known.push((materials, table.clone()));
        table
    }
}
