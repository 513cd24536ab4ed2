//! Transfer between a grid and the next coarser one (section 4.2 of the paper, figure 3).
//!
//! A coarse element covers up to 2 x 2 fine ones, its children: four by standard coarsening, fewer at the end of an odd
//! count or where one direction is left alone.

use crate::grid::Grid;

/// The indices of the children of coarse element `(ix, iy)`.
fn children(fine: &Grid, coarse: &Grid, ix: usize, iy: usize) -> impl Iterator<Item = usize> {
    let span = |fine: usize, coarse: usize, i: usize| {
        let factor = if coarse < fine { 2 } else { 1 };
        factor * i..(factor * (i + 1)).min(fine)
    };
    let (columns, mx) = (span(fine.mx, coarse.mx, ix), fine.mx);
    span(fine.my, coarse.my, iy).flat_map(move |y| columns.clone().map(move |x| y * mx + x))
}

/// Restriction of defects: the mean over the children. Defects in the exterior area are zero, and count.
pub fn restrict_defect(fine: &Grid, coarse: &Grid, defect: &[f64], to: &mut [f64]) {
    restrict_mean(fine, coarse, |i| defect[i], to);
}

/// Restriction by the mean over all children.
pub fn restrict_mean(fine: &Grid, coarse: &Grid, from: impl Fn(usize) -> f64, to: &mut [f64]) {
    for iy in 0..coarse.my {
        for ix in 0..coarse.mx {
            let (mut sum, mut count) = (0.0, 0.0);
            for i in children(fine, coarse, ix, iy) {
                sum += from(i);
                count += 1.0;
            }
            to[coarse.index(ix, iy)] = sum / count;
        }
    }
}

/// Restriction of the undeformed distance: the mean over the children that have a surface, `+infinity` if none has.
pub fn restrict_distance(fine: &Grid, coarse: &Grid, h: impl Fn(usize) -> f64, to: &mut [f64]) {
    for iy in 0..coarse.my {
        for ix in 0..coarse.mx {
            let (mut sum, mut count) = (0.0, 0.0);
            for h in children(fine, coarse, ix, iy).map(&h).filter(|h| h.is_finite()) {
                sum += h;
                count += 1.0;
            }
            to[coarse.index(ix, iy)] = if count > 0.0 { sum / count } else { f64::INFINITY };
        }
    }
}

/// Restriction of the contact area: in contact when at least half of the children are (2 of 4).
pub fn restrict_contact(fine: &Grid, coarse: &Grid, contact: &[bool], to: &mut [bool]) {
    for iy in 0..coarse.my {
        for ix in 0..coarse.mx {
            let (mut inside, mut count) = (0, 0);
            for i in children(fine, coarse, ix, iy) {
                inside += usize::from(contact[i]);
                count += 1;
            }
            to[coarse.index(ix, iy)] = 2 * inside >= count;
        }
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
    for iy in 0..coarse.my {
        for ix in 0..coarse.mx {
            let value = from(coarse.index(ix, iy));
            for i in children(fine, coarse, ix, iy) {
                combine(&mut to[i], value);
            }
        }
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
