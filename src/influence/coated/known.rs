//! A cache of tables. Scenes with the same materials share them.

use std::sync::Arc;

use crate::threads::Shared;

/// A layer's materials: G1/G2 and both Poisson ratios.
type Materials = [f64; 3];

/// The most tables in the cache. Each has about 20 kB.
const MOST: usize = 16;

/// Tables with their materials, the latest last.
pub struct Known<T>(Shared<Vec<(Materials, Arc<T>)>>);

impl<T> Known<T> {
    /// An empty cache.
    pub const fn new() -> Known<T> {
        Known(Shared::new(Vec::new()))
    }

    /// The table of some materials, computed if the cache does not have it.
    pub fn get(&self, materials: Materials, make: impl FnOnce() -> T) -> Arc<T> {
        let find = |known: &Vec<(Materials, Arc<T>)>| {
            known.iter().find(|(of, _)| *of == materials).map(|(_, table)| table.clone())
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
