//! The passes of an iteration over one block, in SIMD vectors. [`shift`](super::super::shift) has the formulas. In the names of fields `n` is the
//! normal, `r` the projected residual, `p` the product, `t` the direction, `c` the chord, `l` the deferred corrections; `x` and `y` are components.

use pulp::{Simd, WithSimd};

use super::super::disc::{Disc, Units};
use super::super::pairs::{add, choose, dot, pass, plus, scaled, subtract};
use super::fields::Fields;
use crate::lanes::Lanes;

/// Predicts the elements in slip, and sets z to the input of the preconditioner. Returns the sums of squares of the residual slip and of u.
pub struct Predict<'a, 'b> {
    pub fields: &'a mut Fields<'b>,
    pub units: Units,
}

impl WithSimd for Predict<'_, '_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 2] {
        let disc = Disc::new(simd, &self.units);
        let Fields { bound, excess, slip: [wx, wy], q: [qx, qy], u: [ux, uy], .. } = self.fields;
        let Fields { curvature, normal: [nx, ny], projected: [rx, ry], z: [zx, zy], .. } = self.fields;
        pass(
            simd,
            [bound, excess, wx, wy, qx, qy, ux, uy],
            [curvature, nx, ny, rx, ry, zx, zy],
            #[inline(always)]
            |[g, excess, wx, wy, qx, qy, ux, uy], _| {
                let u = [ux, uy];
                let predicted = disc.predict([qx, qy], add([wx, wy], u), g);
                let [nx, ny] = predicted.normal;
                let [rx, ry] = predicted.projected;
                let [zx, zy] = scaled(disc.mixing(predicted.curvature + excess), predicted.projected);
                ([predicted.curvature, nx, ny, rx, ry, zx, zy], [predicted.rest, dot(u, u)])
            },
        )
    }
}

/// Computes the preconditioned residual z. On entry z is the output of the circulant. Returns the sum of `z.(A + D) t`, where t is the last
/// direction.
pub struct Precondition<'a, 'b> {
    pub fields: &'a mut Fields<'b>,
    pub units: Units,
}

impl WithSimd for Precondition<'_, '_> {
    type Output = [f64; 1];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 1] {
        let disc = Disc::new(simd, &self.units);
        let Fields { curvature, excess, normal: [nx, ny], projected: [rx, ry], .. } = self.fields;
        let Fields { product: [px, py], direction: [tx, ty], z: [zx, zy], .. } = self.fields;
        pass(
            simd,
            [curvature, excess, nx, ny, rx, ry, px, py, tx, ty],
            [zx, zy],
            #[inline(always)]
            |[curvature, excess, nx, ny, rx, ry, px, py, tx, ty], z| {
                let diagonal = curvature + excess;
                let mixing = disc.mixing(diagonal);
                let by_circulant = disc.project([nx, ny], scaled(mixing, z));
                let z = plus(by_circulant, disc.diagonal_inverse(mixing, diagonal), [rx, ry]);
                (z, [dot(z, plus([px, py], curvature, [tx, ty]))])
            },
        )
    }
}

/// Computes the direction t and its chord at the length f, the change of q by a step of this length over f. Sets z to the input of the product: the
/// chord plus the deferred corrections over f.
pub struct ChooseDirection<'a, 'b> {
    pub fields: &'a mut Fields<'b>,
    pub units: Units,
    pub beta: f64,
    pub f: f64,
}

impl WithSimd for ChooseDirection<'_, '_> {
    type Output = [f64; 0];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 0] {
        let disc = Disc::new(simd, &self.units);
        let (beta, f, inverse) =
            (Lanes::splat(simd, self.beta), Lanes::splat(simd, self.f), Lanes::splat(simd, 1.0 / self.f));
        let Fields { bound, q: [qx, qy], normal: [nx, ny], deferred: [lx, ly], .. } = self.fields;
        let Fields { direction: [tx, ty], chord: [cx, cy], z: [zx, zy], .. } = self.fields;
        pass(
            simd,
            [bound, qx, qy, nx, ny, lx, ly],
            [tx, ty, cx, cy, zx, zy],
            #[inline(always)]
            |[g, qx, qy, nx, ny, lx, ly], [tx, ty, _, _, zx, zy]| {
                let (q, n) = ([qx, qy], [nx, ny]);
                let t = disc.project(n, plus([zx, zy], beta, [tx, ty]));
                let moved = disc.moved((disc.slips(n), n), g, q, scaled(f, t));
                let chord = scaled(inverse, subtract(moved, q));
                let [zx, zy] = plus(chord, inverse, [lx, ly]);
                ([t[0], t[1], chord[0], chord[1], zx, zy], [])
            },
        )
    }
}

/// Returns the sums of `t.(A + D) t` and of the product of t and the projected residual, with the chord in place of t on stick.
pub struct Energy<'a, 'b> {
    pub fields: &'a mut Fields<'b>,
    pub units: Units,
}

impl WithSimd for Energy<'_, '_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 2] {
        let disc = Disc::new(simd, &self.units);
        let Fields { curvature, normal: [nx, ny], projected: [rx, ry], .. } = self.fields;
        let Fields { direction: [tx, ty], chord: [cx, cy], product: [px, py], .. } = self.fields;
        pass(
            simd,
            [curvature, nx, ny, rx, ry, tx, ty, cx, cy, px, py],
            [],
            #[inline(always)]
            |[curvature, nx, ny, rx, ry, tx, ty, cx, cy, px, py], []| {
                let t = choose(disc.slips([nx, ny]), [tx, ty], [cx, cy]);
                let energy = dot(t, [px, py]) + curvature * dot(t, t);
                ([], [energy, dot([rx, ry], t)])
            },
        )
    }
}

/// Makes a step of this length: q moves along the curve, u along the product, whose chord has the length f. The difference becomes a deferred
/// correction. Predicts the elements in slip, and sets z to the input of the preconditioner. Returns the sums of squares of the residual slip, of u,
/// of the deferred corrections and of the change of q.
pub struct Step<'a, 'b> {
    pub fields: &'a mut Fields<'b>,
    pub units: Units,
    pub length: f64,
    pub f: f64,
}

impl WithSimd for Step<'_, '_> {
    type Output = [f64; 4];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 4] {
        let disc = Disc::new(simd, &self.units);
        // The product includes this share of the deferred corrections: length/f.
        let (length, still_deferred) =
            (Lanes::splat(simd, self.length), Lanes::splat(simd, 1.0 - self.length / self.f));
        let Fields { bound, excess, slip: [wx, wy], chord: [cx, cy], product: [px, py], .. } = self.fields;
        let Fields { q: [qx, qy], u: [ux, uy], normal: [nx, ny], direction: [tx, ty], .. } = self.fields;
        let Fields { curvature, projected: [rx, ry], deferred: [lx, ly], z: [zx, zy], .. } = self.fields;
        pass(
            simd,
            [bound, excess, wx, wy, cx, cy, px, py],
            [qx, qy, ux, uy, nx, ny, tx, ty, lx, ly, curvature, rx, ry, zx, zy],
            #[inline(always)]
            |[g, excess, wx, wy, cx, cy, px, py], [qx, qy, ux, uy, nx, ny, tx, ty, lx, ly, ..]| {
                let (q, n, chord) = ([qx, qy], [nx, ny], [cx, cy]);
                let slips = disc.slips(n);
                let t = choose(slips, [tx, ty], chord);
                let new = disc.moved((slips, n), g, q, scaled(length, t));
                let straight = plus(q, length, chord);
                let [lx, ly] = plus(subtract(new, straight), still_deferred, [lx, ly]);
                let change = subtract(new, q);
                let u = plus([ux, uy], length, [px, py]);
                let predicted = disc.predict(new, add([wx, wy], u), g);
                let z = scaled(disc.mixing(predicted.curvature + excess), predicted.projected);
                let (curvature, [nx, ny], [rx, ry]) = (predicted.curvature, predicted.normal, predicted.projected);
                let sums = [predicted.rest, dot(u, u), dot([lx, ly], [lx, ly]), dot(change, change)];
                ([new[0], new[1], u[0], u[1], nx, ny, t[0], t[1], lx, ly, curvature, rx, ry, z[0], z[1]], sums)
            },
        )
    }
}

/// Adds z, the product with the deferred corrections, to u.
pub struct AddProduct<'a, 'b> {
    pub fields: &'a mut Fields<'b>,
}

impl WithSimd for AddProduct<'_, '_> {
    type Output = [f64; 0];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 0] {
        let Fields { z: [zx, zy], u: [ux, uy], .. } = self.fields;
        pass(
            simd,
            [zx, zy],
            [ux, uy],
            #[inline(always)]
            |z, u| (add(u, z), []),
        )
    }
}
