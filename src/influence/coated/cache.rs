//! A cache of tables that depend on materials only, so that scenes with the same materials share them.

use std::sync::Arc;

use crate::threads::Shared;

/// The materials of a layer and its substrate: G1/G2, and the two Poisson ratios.
type Materials = [f64; 3];

/// The largest number of tables in the cache. Each table has about 20 kB.
const MOST: usize = 16;

/// Pairs of materials and their table, the latest last. A full cache drops the oldest one.
pub struct Cache<T>(Shared<Vec<(Materials, Arc<T>)>>);

impl<T> Cache<T> {
    /// An empty cache.
    pub const fn new() -> Cache<T> {
        Cache(Shared::new(Vec::new()))
    }

    /// Returns the table of these materials. It is computed if the cache does not have it.
    pub fn get(&self, materials: Materials, make: impl FnOnce() -> T) -> Arc<T> {
        let find = |known: &Vec<(Materials, Arc<T>)>| {
            known.iter().find(|(known_materials, _)| *known_materials == materials).map(|(_, table)| table.clone())
        };
        if let Some(table) = self.0.lock().and_then(|known| find(&known)) {
            return table;
        }
        let table = Arc::new(make());
        if let Some(mut known) = self.0.lock() {
            if known.len() == MOST {
                known.remove(0);
            }
            known.push((materials, table.clone()));
        }
        table
    }
}
