//! Formulas of vectors, by those of one element, and sums, whatever the length of vectors is.

use pulp::WithSimd;

use super::super::lanes::{pass, LANES};
use super::super::plane::{onto_disc, plus, square, Vector};
use super::super::tangent;
use super::*;

const UNITS: Units = Units { traction: 1.0, displacement: 1.0, a0: 0.7, rho: 0.4 };
/// Round-off of some operations.
const ALLOWED: f64 = 16.0 * f64::EPSILON;

/// Elements that stick and slip, near their circles and far from them; the last ones are nowhere.
fn elements() -> Vec<(Vector, Vector, f64)> {
    let number = |k: usize| ((k * 7919 + 13) % 1013) as f64 / 506.0 - 1.0;
    let element = |k: usize| {
        let (g, length) = (0.5 + 0.4 * number(k), [0.3, 0.95, 1.0, 1.4][k % 4]);
        let q = [number(3 * k), number(5 * k + 1)];
        let to = g * length / square(q).sqrt();
        (q.map(|q| to * q), [number(11 * k), number(17 * k + 2)].map(|s| 0.6 * s), g)
    };
    let nowhere = ([0.0; 2], [0.0; 2], 0.0);
    (0..8 * LANES).map(element).chain(std::iter::repeat_n(nowhere, LANES)).collect()
}

/// By component.
fn split(values: impl Iterator<Item = Vector>) -> [Vec<f64>; 2] {
    values.map(|[x, y]| (x, y)).collect::<(Vec<f64>, Vec<f64>)>().into()
}

/// What all elements look like, and where they go: n, D, `P(-s)`, the rest, and the place after a way; and the sums of all these.
struct Look<'a> {
    elements: &'a [(Vector, Vector, f64)],
    way: f64,
}

impl WithSimd for Look<'_> {
    type Output = ([Vec<f64>; 8], [f64; 8]);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let (disc, elements) = (Disc::new(simd, &UNITS), self.elements);
        let ([qx, qy], [sx, sy]) = (split(elements.iter().map(|e| e.0)), split(elements.iter().map(|e| e.1)));
        let g: Vec<f64> = elements.iter().map(|e| e.2).collect();
        let mut out: [Vec<f64>; 8] = std::array::from_fn(|_| vec![f64::NAN; g.len()]);
        let way = disc.a.splat(self.way);
        let sums =
            pass(disc.a, [&qx, &qy, &sx, &sy, &g], out.each_mut().map(|out| &mut out[..]), |[qx, qy, sx, sy, g], _| {
                let seen = disc.look([qx, qy], [sx, sy], g);
                let n = seen.normal;
                let to = disc.moved((disc.slips(n), n), g, [qx, qy], disc.a.scale(way, [sx, sy]));
                let [rx, ry] = seen.projected;
                let values = [n[0], n[1], seen.curvature, rx, ry, seen.rest, to[0], to[1]];
                (values, values)
            });
        (out, sums)
    }
}

#[test]
fn vectors_of_elements_are_as_each() {
    let elements = elements();
    let ([nx, ny, curvature, rx, ry, rest, x, y], _) =
        pulp::Arch::new().dispatch(Look { elements: &elements, way: 0.3 });
    let [mut slip_count, mut near_count] = [0; 2];
    for (k, &(q, s, g)) in elements.iter().enumerate() {
        let seen = tangent::look((q, s), g, (UNITS.rho, 1.0 / UNITS.rho));
        let slips = seen.normal != [0.0; 2];
        let to = match slips {
            true => {
                let to = plus(seen.normal.map(|n| g * n), 0.3, s);
                to.map(|to| to * g / square(to).sqrt())
            }
            false => onto_disc(plus(q, 0.3, s), g),
        };
        let expected = [seen.normal, [seen.curvature, seen.rest], seen.projected, to];
        let found = [[nx[k], ny[k]], [curvature[k], rest[k]], [rx[k], ry[k]], [x[k], y[k]]];
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found - expected).abs() <= ALLOWED * expected.abs().max(1.0), "{k}: {found} {expected}");
        }
        slip_count += usize::from(slips);
        near_count += usize::from(slips && (square(q).sqrt() - g).abs() < 0.1 * g);
    }
    assert!(slip_count > 10 && near_count > 5 && slip_count < elements.len() - 10, "{slip_count} {near_count}");
}

#[test]
fn no_bit_depends_on_the_length_of_vectors() {
    let elements = elements();
    let by = |arch: pulp::Arch| arch.dispatch(Look { elements: &elements, way: 0.3 });
    let here = by(pulp::Arch::new());
    assert!(here.1.iter().all(|sum| sum.is_finite()));
    assert!(here == by(pulp::Arch::Scalar), "one element at a time");
    #[cfg(target_arch = "x86_64")]
    if let Some(avx2) = pulp::x86::V3::try_new() {
        assert!(here == by(pulp::Arch::V3(avx2)), "AVX2");
    }
}
