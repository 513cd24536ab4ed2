//! The transforms of [`LaneRows`](crate::fft::lane_rows::LaneRows): of one group of rows to bins, and back.

use pulp::{Simd, WithSimd};

use crate::block::{Block, BLOCK};
use crate::fft::lane_passes::{load, load_bins, store, store_bins};
use crate::fft::lanes::{lane_count, Arithmetic};
use crate::fft::row_plan::RowPlan;
use crate::fft::stage_plan::Stages;
use crate::fft::stages::{backwards, end, forward, of_radix, rows_of};
use crate::real::{Complex, Scalar};

/// The number of lanes of this machine's vectors of T. None if vectors have more lanes than a block has columns.
pub struct LaneCount<T>(pub std::marker::PhantomData<T>);

impl<T: Scalar> WithSimd for LaneCount<T> {
    type Output = Option<usize>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        (S::F32_LANES <= BLOCK).then(lane_count::<T, S>)
    }
}

/// Whether `bins` has the size of all bins of one group of rows.
fn fits<T: Scalar, S: Simd>(plan: &RowPlan<T>, bins: &Block<'_, T>) -> bool {
    bins.rows() == plan.blocks() && bins.columns() == lane_count::<T, S>() * BLOCK
}

/// Transforms a group of rows to bins. A group has at most as many rows as a vector has lanes.
pub struct Forward<'a, 'b, T: Scalar> {
    pub plan: &'a RowPlan<T>,
    /// The rows, each of `width` values. They are padded with zeros to the length of the plan.
    pub rows: &'a [T],
    pub width: usize,
    /// The bins, `[block][row of the group][part][bin]`. There is always room for as many rows as a vector has lanes.
    pub bins: &'a mut Block<'b, T>,
    pub scratch: &'a mut [Complex<T>],
}

impl<T: Scalar> WithSimd for Forward<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Forward { plan, rows, width, bins, scratch } = self;
        assert!(fits::<T, S>(plan, bins) && width <= 2 * plan.length() && rows.len() >= width);
        let (a, h) = (Arithmetic::<T, S>::new(simd), plan.length());
        let z = &mut rows_of::<T, S>(scratch)[..h];
        load::<T, S>(a, rows, width, z);
        let first = &plan.stages.first;
        of_radix!(first.radix, forward, a, first, z);
        plan.stages.forward_after_first(a, z);
        store_bins::<T, S>(a, plan, z, bins);
    }
}

/// Transforms bins back to a group of rows.
pub struct Inverse<'a, 'b, T: Scalar> {
    pub plan: &'a RowPlan<T>,
    /// The bins of as many rows as a vector has lanes, `[block][row of the group][part][bin]`.
    pub bins: &'a Block<'b, T>,
    /// The rows. Only their first `width` values are computed, and only as many rows as this slice has.
    pub rows: &'a mut [T],
    pub width: usize,
    pub scratch: &'a mut [Complex<T>],
}

impl<T: Scalar> WithSimd for Inverse<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Inverse { plan, bins, rows, width, scratch } = self;
        assert!(fits::<T, S>(plan, bins) && width <= 2 * plan.length() && width > 0);
        let (a, h) = (Arithmetic::<T, S>::new(simd), plan.length());
        let z = &mut rows_of::<T, S>(scratch)[..h];
        load_bins::<T, S>(a, plan, bins, z);
        let Stages { middle, wide, part, last, first } = &plan.stages;
        let (wide, near) = middle.split_at(*wide);
        for z in z.chunks_exact_mut(*part) {
            of_radix!(*last, end, a, z);
            for stage in near.iter().rev() {
                of_radix!(stage.radix, backwards, a, stage, z);
            }
        }
        for stage in wide.iter().rev() {
            of_radix!(stage.radix, backwards, a, stage, z);
        }
        of_radix!(first.radix, backwards, a, first, z);
        store::<T, S>(a, z, rows, width);
    }
}
