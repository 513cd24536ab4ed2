//! Transfer between a grid and the next coarser one (section 4.2 of the paper, figure 3).
//!
//! A coarse element covers up to 2 x 2 fine ones, its children: four by standard coarsening, fewer at the end of an odd
//! count or where one direction is left alone.

use crate::grid::Grid;

/// Restriction by the mean over all children. Defects in the exterior area are zero, and count.
pub fn restrict_mean(fine: &Grid, coarse: &Grid, from: impl Fn(usize) -> f64, to: &mut [f64]) {
    for (i, to) in to[..coarse.len()].iter_mut().enumerate() {
        *to = mean(coarse.children(fine, i).map(&from));
    }
}

/// Restriction of the undeformed distance: the mean over the children that have a surface, `+infinity` if none has.
pub fn restrict_distance(fine: &Grid, coarse: &Grid, h: impl Fn(usize) -> f64, to: &mut [f64]) {
    for (i, to) in to[..coarse.len()].iter_mut().enumerate() {
        let mean = mean(coarse.children(fine, i).map(&h).filter(|h| h.is_finite()));
        *to = if mean.is_nan() { f64::INFINITY } else { mean };
    }
}

/// The mean of values, NaN of none.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// Restriction of the contact area: in contact when at least half of the children are (2 of 4).
pub fn restrict_contact(fine: &Grid, coarse: &Grid, contact: &[bool], to: &mut [bool]) {
    for (i, to) in to[..coarse.len()].iter_mut().enumerate() {
        let (mut inside, mut count) = (0, 0);
        for child in coarse.children(fine, i) {
            inside += usize::from(contact[child]);
            count += 1;
        }
        *to = 2 * inside >= count;
    }
}

/// Piecewise constant interpolation: every child gets `combine(its value, the coarse value)`.
pub fn interpolate<A: Copy>(
    fine: &Grid,
    coarse: &Grid,
    from: impl Fn(usize) -> A,
    to: &mut [f64],
    combine: impl Fn(&mut f64, A),
) {
    for i in 0..coarse.len() {
        let value = from(i);
        coarse.children(fine, i).for_each(|child| combine(&mut to[child], value));
    }
}

/// Linear interpolation between the centres of the coarse elements, constant beyond the outermost: every fine element gets
/// `combine(its value, the interpolated value)`.
pub fn interpolate_linearly(
    fine: &Grid,
    coarse: &Grid,
    from: impl Fn(usize) -> f64,
    to: &mut [f64],
    combine: impl Fn(&mut f64, f64),
) {
    // The coarse element that holds fine element i, its neighbour on the side of i, and the neighbour's weight.
    let between = |i: usize, fine: usize, coarse: usize| {
        if coarse == fine {
            return (i, i, 0.0);
        }
        let neighbour = if i % 2 == 0 { (i / 2).saturating_sub(1) } else { (i / 2 + 1).min(coarse - 1) };
        (i / 2, neighbour, 0.25)
    };
    for (iy, row) in to.chunks_exact_mut(fine.mx).enumerate() {
        let (y, next_y, weight_y) = between(iy, fine.my, coarse.my);
        for (ix, to) in row.iter_mut().enumerate() {
            let (x, next_x, weight_x) = between(ix, fine.mx, coarse.mx);
            // No neighbour, or one whose value is not known (+infinity, beside a window): constant.
            let mix = |a: f64, b: f64, weight: f64| {
                let known = weight != 0.0 && b != f64::INFINITY;
                if known {
                    (1.0 - weight) * a + weight * b
                } else {
                    a
                }
            };
            let in_row = |y: usize| mix(from(coarse.index(x, y)), from(coarse.index(next_x, y)), weight_x);
            combine(to, mix(in_row(y), in_row(next_y), weight_y));
        }
    }
}
