//! Passes that copy real rows and their bins between memory and the lanes of vectors. [`lane_rows`](crate::fft::lane_rows) has the formulas and the
//! layout of bins.
//!
//! Values are transposed four columns at a time. Blocks of bins are far from each other in memory, so the next one is prefetched during the work on
//! each.

use pulp::Simd;

use crate::block::{parts, parts_mut, Block, BLOCK};
use crate::fft::lanes::{lane_count, Arithmetic, Parts};
use crate::fft::row_plan::RowPlan;
use crate::fft::stages::{inlined, Row};
use crate::real::{Complex, Scalar};

/// The number of lanes of the longest vector.
const MOST_LANES: usize = BLOCK;
/// The number of columns that are transposed together.
const FOUR: usize = 4;

/// Transposes four values of each row, which `values(row)` returns, to four vectors with one row in each lane.
#[inline(always)]
fn from_rows<T: Scalar, S: Simd>(simd: S, values: impl Fn(usize) -> [T; FOUR]) -> [T::Vector<S>; FOUR] {
    let (n, mut rows) = (lane_count::<T, S>(), [[T::zero(); FOUR]; MOST_LANES]);
    for (r, row) in rows.iter_mut().enumerate().take(n) {
        *row = values(r);
    }
    let v = T::vectors::<S>(&rows.as_flattened()[..FOUR * n]);
    T::from_rows(simd, [v[0], v[1], v[2], v[3]])
}

/// The reverse of [`from_rows`]: calls `write(row, values)` with the four values of each row.
#[inline(always)]
fn to_rows<T: Scalar, S: Simd>(simd: S, vectors: [T::Vector<S>; FOUR], mut write: impl FnMut(usize, [T; FOUR])) {
    let (n, mut rows) = (lane_count::<T, S>(), [[T::zero(); FOUR]; MOST_LANES]);
    T::vectors_mut::<S>(&mut rows.as_flattened_mut()[..FOUR * n]).copy_from_slice(&T::to_rows(simd, vectors));
    for (r, row) in rows.into_iter().enumerate().take(n) {
        write(r, row);
    }
}

/// The number of groups of four bins in a block. A row of a block has the real parts of all groups, then the imaginary parts.
const PER_BLOCK: usize = BLOCK / FOUR;

/// Loads rows of `width` values as complex numbers z, one row in each lane. z is zero beyond the width. Lanes without a row repeat the last one.
#[inline(always)]
pub(crate) fn load<T: Scalar, S: Simd>(a: Arithmetic<T, S>, rows: &[T], width: usize, z: &mut [Row<T, S>]) {
    let count = rows.len() / width;
    let row = |r: usize| &rows[r.min(count - 1) * width..][..width];
    let mut fours: [&[[T; FOUR]]; MOST_LANES] = [&[]; MOST_LANES];
    for (r, fours) in fours.iter_mut().enumerate() {
        *fours = pulp::as_arrays::<FOUR, _>(row(r)).0;
    }
    let (whole, rest) = (width / FOUR, width % FOUR);
    let x = z.as_flattened_mut();
    for c in 0..whole {
        let vectors = from_rows::<T, S>(
            a.simd,
            #[inline(always)]
            |r: usize| fours[r][c],
        );
        x[FOUR * c..][..FOUR].copy_from_slice(&vectors);
    }
    x[FOUR * whole..].fill(a.splat(T::zero()));
    if rest > 0 {
        let vectors = from_rows::<T, S>(
            a.simd,
            inlined(
                #[inline(always)]
                |r: usize| {
                    let mut four = [T::zero(); FOUR];
                    four[..rest].copy_from_slice(&row(r)[FOUR * whole..]);
                    four
                },
            ),
        );
        x[FOUR * whole..][..rest].copy_from_slice(&vectors[..rest]);
    }
}

/// Computes all bins X of the rows from Z, which is in the order of the stages, and stores them.
#[inline(always)]
pub(crate) fn store_bins<T: Scalar, S: Simd>(
    a: Arithmetic<T, S>,
    plan: &RowPlan<T>,
    z: &[Row<T, S>],
    bins: &mut Block<'_, T>,
) {
    let (h, half, zero) = (plan.length(), a.splat(T::of(0.5)), a.splat(T::zero()));
    let (row_of, twiddles) = (&plan.row_of[..h + 1], &plan.twiddles[..h + 1]);
    let value = inlined(
        #[inline(always)]
        |k: usize| {
            let ([re, im], [mirrored_re, mirrored_im]) = (z[row_of[k]], z[row_of[h - k]]);
            let sum = Parts { re: a.add_real(re, mirrored_re), im: a.add_real(im, mirrored_im) };
            let difference = Parts { re: a.sub_real(re, mirrored_re), im: a.sub_real(im, mirrored_im) };
            // The conjugate of `-i w_k (Z_k - Z*_(h-k))/2`, where `Z_k - Z*_(h-k) = difference.re + i sum.im`.
            let twiddled = a.twiddle(Parts { re: sum.im, im: difference.re }, conjugate(twiddles[k]));
            let mean = a.scale(Parts { re: sum.re, im: difference.im }, half);
            Parts { re: a.add_real(mean.re, twiddled.re), im: a.sub_real(mean.im, twiddled.im) }
        },
    );
    for block in 0..plan.blocks() {
        for at in 0..PER_BLOCK {
            bins.prefetch(block + 1, (at, PER_BLOCK));
            let fours = pulp::as_arrays_mut::<FOUR, _>(parts_mut(bins.row_mut(block))).0;
            let (mut re, mut im) = ([zero; FOUR], [zero; FOUR]);
            for i in 0..FOUR {
                let k = block * BLOCK + FOUR * at + i;
                if k <= h {
                    Parts { re: re[i], im: im[i] } = value(k);
                }
            }
            to_rows::<T, S>(
                a.simd,
                re,
                #[inline(always)]
                |r: usize, four| fours[2 * PER_BLOCK * r + at] = four,
            );
            to_rows::<T, S>(
                a.simd,
                im,
                #[inline(always)]
                |r: usize, four| fours[2 * PER_BLOCK * r + PER_BLOCK + at] = four,
            );
        }
    }
}

/// The conjugate w*.
#[inline(always)]
fn conjugate<T: Scalar>(w: Complex<T>) -> Complex<T> {
    Complex::new(w.re, -w.im)
}

/// Computes Z from the bins X, for the inverse transform: in the order of the stages, with real and imaginary parts swapped. The bins k and h - k are
/// needed together, so bins are loaded from both ends, four at a time.
#[inline(always)]
pub(crate) fn load_bins<T: Scalar, S: Simd>(
    a: Arithmetic<T, S>,
    plan: &RowPlan<T>,
    bins: &Block<'_, T>,
    z: &mut [Row<T, S>],
) {
    let h = plan.length();
    let (row_of, twiddles) = (&plan.row_of[..h + 1], &plan.twiddles[..h + 1]);
    let four = inlined(
        #[inline(always)]
        |q: usize| {
            let (fours, at) = (pulp::as_arrays::<FOUR, _>(parts(bins.row(q / PER_BLOCK))).0, q % PER_BLOCK);
            let re = from_rows::<T, S>(
                a.simd,
                #[inline(always)]
                |r| fours[2 * PER_BLOCK * r + at],
            );
            let im = from_rows::<T, S>(
                a.simd,
                #[inline(always)]
                |r| fours[2 * PER_BLOCK * r + PER_BLOCK + at],
            );
            [[re[0], im[0]], [re[1], im[1]], [re[2], im[2]], [re[3], im[3]]]
        },
    );
    let (mut front, mut behind) = (four(0), four(h / FOUR));
    for k in 0..=h / 2 {
        let m = h - k;
        if k % FOUR == 0 {
            bins.prefetch(k / BLOCK + 1, (k / FOUR % PER_BLOCK, PER_BLOCK));
            front = four(k / FOUR);
        }
        if m % FOUR == FOUR - 1 {
            bins.prefetch((m / BLOCK).wrapping_sub(1), (m / FOUR % PER_BLOCK, PER_BLOCK));
            behind = four(m / FOUR);
        }
        let ([re, im], [mirrored_re, mirrored_im]) = (front[k % FOUR], behind[m % FOUR]);
        let sum = Parts { re: a.add_real(re, mirrored_re), im: a.add_real(im, mirrored_im) };
        let difference = Parts { re: a.sub_real(re, mirrored_re), im: a.sub_real(im, mirrored_im) };
        // `w*_k (X_k - X*_(h-k))`, where `X_k - X*_(h-k) = difference.re + i sum.im`. Z_k contains i times this value. Z_(h-k) follows with
        // `w_(h-k) = -w*_k`.
        let twiddled = a.twiddle(Parts { re: difference.re, im: sum.im }, conjugate(twiddles[k]));
        let twiddled = a.add(twiddled, twiddled);
        z[row_of[k]] = [a.add_real(twiddled.re, difference.im), a.sub_real(sum.re, twiddled.im)];
        z[row_of[m]] = [a.sub_real(twiddled.re, difference.im), a.add_real(sum.re, twiddled.im)];
    }
}

/// Stores the first `width` values of each row from z, whose real and imaginary parts are swapped.
#[inline(always)]
pub(crate) fn store<T: Scalar, S: Simd>(a: Arithmetic<T, S>, z: &[Row<T, S>], rows: &mut [T], width: usize) {
    let (whole, rest) = (width / FOUR, width % FOUR);
    let four = inlined(
        #[inline(always)]
        |c: usize| {
            let ([im, re], next) = (z[2 * c], z.get(2 * c + 1));
            let [next_im, next_re] = next.copied().unwrap_or([re, im]);
            [re, im, next_re, next_im]
        },
    );
    if rest > 0 {
        to_rows::<T, S>(
            a.simd,
            four(whole),
            #[inline(always)]
            |r, four| {
                if let Some(row) = rows.get_mut(r * width + FOUR * whole..(r + 1) * width) {
                    row.copy_from_slice(&four[..rest]);
                }
            },
        );
    }
    // Lanes without a row have an empty slice.
    let mut fours: [&mut [[T; FOUR]]; MOST_LANES] = Default::default();
    for (row, fours) in rows.chunks_exact_mut(width).zip(&mut fours) {
        *fours = pulp::as_arrays_mut::<FOUR, _>(row).0;
    }
    for c in 0..whole {
        to_rows::<T, S>(
            a.simd,
            four(c),
            #[inline(always)]
            |r, four| {
                if let Some(to) = fours[r].get_mut(c) {
                    *to = four;
                }
            },
        );
    }
}
