//! The influence coefficients of one grid: the kernel, and an optional diagonal and coupling. The formula is in [`influence`](super).

use std::sync::Arc;

use super::kernel::Kernel;
use super::{Layer, Patches, RowTables};
use crate::error::Result;
use crate::grid::Grid;

/// The influence coefficients of one grid. Copies share the arrays.
#[derive(Clone, Debug)]
pub struct Coefficients {
    kernel: Arc<dyn Kernel>,
    diagonal: Option<Layer>,
    coupling: Option<Patches>,
}

impl<K: Kernel + 'static> From<K> for Coefficients {
    fn from(kernel: K) -> Coefficients {
        Coefficients::new(Arc::new(kernel))
    }
}

impl Coefficients {
    /// Coefficients of a kernel without a layer and without patches.
    pub fn new(kernel: Arc<dyn Kernel>) -> Coefficients {
        Coefficients { kernel, diagonal: None, coupling: None }
    }

    /// These coefficients with another kernel.
    pub fn with_kernel(self, kernel: Arc<dyn Kernel>) -> Coefficients {
        Coefficients { kernel, ..self }
    }

    /// These coefficients with a compliant layer in addition.
    pub fn with_layer(self, layer: Layer) -> Coefficients {
        Coefficients { diagonal: Some(layer), ..self }
    }

    /// These coefficients, multiplied by the factors between patches.
    pub fn with_patches(self, patches: Patches) -> Coefficients {
        Coefficients { coupling: Some(patches), ..self }
    }

    /// The kernel.
    pub fn kernel(&self) -> &dyn Kernel {
        &*self.kernel
    }

    /// Whether there is a layer.
    pub fn has_layer(&self) -> bool {
        self.diagonal.is_some()
    }

    /// Whether coefficients may change abruptly from one element to the next: a layer with a compliance per element, or patches.
    pub fn may_jump(&self) -> bool {
        self.diagonal().is_some() || self.patches().is_some()
    }

    /// The smallest compliance of the layer, which the coefficient at offset (0, 0) contains; 0 without a layer.
    fn least(&self) -> f64 {
        self.diagonal.as_ref().map_or(0.0, |layer| layer.least)
    }

    /// The compliance of the layer on element `i`; 0 without a layer.
    pub fn layer(&self, i: usize) -> f64 {
        self.least() + self.diagonal().map_or(0.0, |more| more[i])
    }

    /// The coefficient at offset `(kx, ky)`, with the smallest compliance of the layer and without the factors between patches. For row tables it
    /// is the mean over the rows.
    pub fn at(&self, kx: i64, ky: i64) -> f64 {
        let layer = if (kx, ky) == (0, 0) { self.least() } else { 0.0 };
        self.kernel.at(kx, ky) + layer
    }

    /// `A_IJ` of elements i and j of `grid`, with layer and patches.
    pub fn entry(&self, grid: &Grid, i: usize, j: usize) -> f64 {
        let place = |i: usize| ((i % grid.mx) as i64, (i / grid.mx) as i64);
        self.entry_of(self.kernel.between(place(j), place(i)), i, j)
    }

    /// `A_IJ` of elements i and j. `kernel` is the kernel's coefficient between them.
    pub fn entry_of(&self, kernel: f64, i: usize, j: usize) -> f64 {
        let coupled = self.coupling.as_ref().map_or(kernel, |patches| patches.between(i, j) * kernel);
        match i == j {
            true => coupled + self.layer(i),
            false => coupled,
        }
    }

    /// Fills `out[k]` with the coefficient at offset `(kx + k, ky)`, as [`Kernel::fill_row`] does, with the smallest compliance of the layer.
    pub fn fill_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        self.kernel.fill_row(kx, ky, out);
        self.add_layer(kx, ky, out);
    }

    /// Fills `out[k]` with the symmetric part of the coefficients, as [`Kernel::fill_symmetric_row`] does, with the smallest compliance of the
    /// layer.
    pub fn fill_symmetric_row(&self, kx: i64, ky: i64, out: &mut [f64]) {
        self.kernel.fill_symmetric_row(kx, ky, out);
        self.add_layer(kx, ky, out);
    }

    fn add_layer(&self, kx: i64, ky: i64, row: &mut [f64]) {
        if ky == 0 && kx <= 0 && -kx < row.len() as i64 {
            row[-kx as usize] += self.least();
        }
    }

    /// Fills `out[k]` with the even part of the coefficients at offsets `(+-k, +-ky)`, with the typical compliance of the layer. Preconditioners
    /// use it. With two periods a uniform pressure gets the response of the mean layer, or without a layer at least about the response of the
    /// longest wave.
    pub fn fill_even_row(&self, ky: i64, out: &mut [f64]) {
        self.kernel.fill_even_row(ky, out);
        let constant = match &self.diagonal {
            Some(layer) => self.kernel.constant_for(layer.mean - layer.typical),
            None => self.kernel.constant_for_inverse(),
        };
        if constant != 0.0 {
            out.iter_mut().for_each(|value| *value += constant);
        }
        if let (Some(layer), 0) = (&self.diagonal, ky) {
            out[0] += layer.typical;
        }
    }

    /// The displacement by a pressure wave of amplitude 1, with the typical compliance of the layer. `None` if a preconditioner takes the
    /// coefficients instead (see [`Kernel::wave`]).
    pub fn wave(&self, grid: &Grid, kx: f64, ky: f64) -> Option<f64> {
        let layer = self.diagonal.as_ref().map_or(0.0, |layer| layer.typical);
        self.kernel.wave(grid, kx, ky).map(|value| value + layer)
    }

    /// A bound on the absolute values of the coefficients on `grid`: the kernel's largest one without a negative constant, plus the largest
    /// compliance of the layer.
    pub fn largest(&self, grid: &Grid) -> f64 {
        self.kernel.largest(grid) - self.kernel.constant().min(0.0) + self.diagonal.as_ref().map_or(0.0, Layer::largest)
    }

    /// Whether the kernel is even in both directions.
    pub fn is_even(&self, grid: &Grid) -> bool {
        self.kernel.is_even(grid)
    }

    /// Whether A is symmetric on `grid`, up to the round-off of a table.
    pub fn is_symmetric(&self, grid: &Grid) -> bool {
        self.kernel.is_symmetric(grid)
    }

    /// Whether A is circulant on `grid`, not only Toeplitz, in x and in y.
    pub fn repeats(&self, grid: &Grid) -> (bool, bool) {
        self.kernel.repeats(grid)
    }

    /// The diagonal of A beyond the coefficient at offset (0, 0): the compliance of the layer on each element less the smallest one. `None` if
    /// the layer is uniform.
    pub fn diagonal(&self) -> Option<&[f64]> {
        self.diagonal.as_ref().and_then(Layer::beyond_least)
    }

    /// The patches between which coefficients are multiplied by factors.
    pub fn patches(&self) -> Option<&Patches> {
        self.coupling.as_ref()
    }

    /// The tables of loaded rows, and the smallest compliance of the layer, which is part of the influence of each element on itself. `None` if
    /// the kernel is another one.
    pub fn row_tables(&self) -> Option<(&RowTables, f64)> {
        RowTables::of(&*self.kernel).map(|tables| (tables, self.least()))
    }

    /// Whether A depends on more than the offset, so that the operator of a part of the grid depends on where the part lies.
    pub fn depends_on_place(&self) -> bool {
        self.diagonal().is_some() || self.patches().is_some() || self.row_tables().is_some()
    }

    /// Whether a uniform pressure on the whole grid displaces nothing, so that A has no inverse.
    pub fn is_mean_free(&self) -> bool {
        self.diagonal.is_none() && self.kernel.is_mean_free()
    }

    /// The kernel's coefficient at offset (0, 0), without a negative constant: the constant is the same in all coefficients.
    fn kernel_on_itself(&self) -> f64 {
        self.kernel.at(0, 0) - self.kernel.constant().min(0.0)
    }

    /// An element's influence on itself, with the smallest compliance of the layer.
    pub fn self_influence(&self) -> f64 {
        self.kernel_on_itself() + self.least()
    }

    /// The coefficients for a prescribed force: those without the [constant](Kernel::constant) of the kernel. `None` if the constant is 0.
    pub fn without_constant(&self) -> Option<Coefficients> {
        self.kernel.without_constant().map(|kernel| self.clone().with_kernel(kernel))
    }

    /// The coefficients with each of the compliances for which a preconditioner is made, and the weights of the elements for each (see
    /// [`Layer::levels`]). The weights are empty if the layer is uniform or missing.
    pub fn levels(&self) -> Result<Vec<(Coefficients, Vec<f64>)>> {
        let Some(layer) = &self.diagonal else { return Ok(vec![(self.clone(), Vec::new())]) };
        let levels = layer.levels(self.kernel_on_itself())?.into_iter();
        Ok(levels.map(|(layer, weights)| (self.clone().with_layer(layer), weights)).collect())
    }

    /// An element's influence on itself with the typical compliance of the layer, relative to that without a layer.
    pub fn typical_compliance(&self) -> f64 {
        1.0 + self.diagonal.as_ref().map_or(0.0, |layer| layer.typical / self.kernel_on_itself())
    }

    /// The coefficients on a grid that is coarsened from `fine` to `coarse`.
    pub fn coarsen(&self, fine: &Grid, coarse: &Grid) -> Result<Coefficients> {
        Ok(Coefficients {
            kernel: self.kernel.coarsen(fine, coarse)?,
            diagonal: self.diagonal.as_ref().map(|layer| layer.coarsen(fine, coarse)).transpose()?,
            coupling: self.coupling.as_ref().map(|patches| patches.coarsen(fine, coarse)).transpose()?,
        })
    }

    /// Bytes of the stored coefficients; 0 for the half-space.
    pub fn bytes(&self) -> usize {
        let layer = self.diagonal().map_or(0, size_of_val);
        self.kernel.bytes() + layer + self.coupling.as_ref().map_or(0, Patches::bytes)
    }
}
