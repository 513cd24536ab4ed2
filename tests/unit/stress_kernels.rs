//! The kernels of subsurface stresses, near and far, compared with corner differences of the potentials in 256 bits.

use astro_float::{BigFloat, Consts, RoundingMode};

use super::{Asked, Kernels};
use crate::grid::Grid;
use crate::stress::Body;

/// The precision of the reference in bits: corner differences of third derivatives at offset 16384 and depth 1e6 cancel, for which 200 bits would
/// suffice.
const BITS: usize = 256;
const RM: RoundingMode = RoundingMode::ToEven;

/// Arithmetic with many digits.
#[derive(Clone)]
struct Big(BigFloat);

impl Big {
    fn of(x: f64) -> Big {
        Big(BigFloat::from_f64(x, BITS))
    }
    fn to_f64(&self) -> f64 {
        format!("{}", self.0).parse().unwrap()
    }
    fn sqrt(&self) -> Big {
        Big(self.0.sqrt(BITS, RM))
    }
    fn ln(&self, consts: &mut Consts) -> Big {
        Big(self.0.ln(BITS, RM, consts))
    }
    fn atan(&self, consts: &mut Consts) -> Big {
        Big(self.0.atan(BITS, RM, consts))
    }
}

macro_rules! arithmetic {
    ($($of:ident $name:ident $method:ident),*) => {$(
        impl std::ops::$of for &Big {
            type Output = Big;
            fn $name(self, other: &Big) -> Big {
                Big(self.0.$method(&other.0, BITS, RM))
            }
        }
    )*};
}
arithmetic!(Add add add, Sub sub sub, Mul mul mul, Div div div);

/// The antiderivatives at one corner: V_x, V_y, C_xx, C_yy, C_xy, W_xxy, W_xyy, V_xx, V_yy, V_xy, V_xz, V_yz, C_xxy, C_xyy.
fn corner(x: &Big, y: &Big, z: &Big, consts: &mut Consts) -> [Big; 14] {
    let (x2, y2, z2) = (x * x, y * y, z * z);
    let r = (&(&x2 + &y2) + &z2).sqrt();
    let (ry, rx, rz) = (&r + y, &r + x, &r + z);
    let zr = z * &r;
    let xy = x * y;
    let zero = Big::of(0.0);
    [
        ry.ln(consts),
        rx.ln(consts),
        (&xy / &(&(&x2 + &z2) + &zr)).atan(consts),
        (&xy / &(&(&y2 + &z2) + &zr)).atan(consts),
        rz.ln(consts),
        &zero - &(x / &rz),
        &zero - &(y / &rz),
        &(x / &r) / &ry,
        &(y / &r) / &rx,
        &Big::of(1.0) / &r,
        &(z / &r) / &ry,
        &(z / &r) / &rx,
        &(x / &r) / &rz,
        &(y / &r) / &rz,
    ]
}

/// The stresses at `(x, y, z)` by unit loads on an element `dx` by `dy`: the table of the module docs of `element`, in many digits.
fn reference([x, y, z]: [f64; 3], (dx, dy): (f64, f64), nu: f64, consts: &mut Consts) -> [[f64; 6]; 3] {
    let half = |x: f64, d: f64, sign: f64| &Big::of(x) + &(&Big::of(d) * &Big::of(0.5 * sign));
    let z = Big::of(z);
    let mut f: [Big; 14] = std::array::from_fn(|_| Big::of(0.0));
    for (i, j) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let values = corner(&half(x, dx, i), &half(y, dy, j), &z, consts);
        for (sum, value) in f.iter_mut().zip(&values) {
            *sum = if i * j > 0.0 { &*sum + value } else { &*sum - value };
        }
    }
    let [vx, vy, cxx, cyy, cxy, wxxy, wxyy, vxx, vyy, vxy, vxz, vyz, cxxy, cxyy] = &f;
    let zero = Big::of(0.0);
    let minus = |a: &Big| &zero - a;
    let vz = minus(&(cxx + cyy));
    let vzz = minus(&(vxx + vyy));
    let (cxxx, cyyy) = (minus(&(cxyy + vxz)), minus(&(cxxy + vyz)));
    let (wxxx, wyyy) = (minus(&(wxyy + vx)), minus(&(wxxy + vy)));
    let nu2 = Big::of(2.0 * nu);
    let (h, n2) = (&Big::of(1.0) - &nu2, &Big::of(2.0) + &nu2);
    // The difference of three terms: a - b - z c.
    let less = |a: &Big, b: &Big, c: &Big| (&(a - b) - &(&z * c)).to_f64() / (2.0 * std::f64::consts::PI);
    let normal = &nu2 * &vz;
    let pressure = [
        less(&normal, &(&h * cxx), vxx),
        less(&normal, &(&h * cyy), vyy),
        less(&vz, &zero, &vzz),
        less(&zero, &(&h * cxy), vxy),
        less(&zero, &zero, vxz),
        less(&zero, &zero, vyz),
    ];
    let traction = |vx: &Big, vy: &Big, wxxx: &Big, wxyy: &Big, wxxy: &Big, cxxx: &Big, cxyy: &Big, cxxy: &Big| {
        [
            less(&(&n2 * vx), &minus(&(&nu2 * wxxx)), cxxx),
            less(&(&nu2 * vx), &minus(&(&nu2 * wxyy)), cxyy),
            less(vy, &minus(&(&nu2 * wxxy)), cxxy),
        ]
    };
    let x = traction(vx, vy, &wxxx, wxyy, wxxy, &cxxx, cxyy, cxxy);
    let y = traction(vy, vx, &wyyy, wxxy, wxyy, &cyyy, cxxy, cxyy);
    let in_x = [x[0], x[1], less(&zero, &zero, vxz), x[2], less(&vz, &zero, vxx), less(&zero, &zero, vxy)];
    let in_y = [y[1], y[0], less(&zero, &zero, vyz), y[2], less(&zero, &zero, vxy), less(&vz, &zero, vyy)];
    [pressure, in_x, in_y]
}

/// The largest error of a kernel at these offsets, relative to the largest component of the stresses by all three loads there.
fn error(element: (f64, f64), nu: f64, z: f64, size: (usize, usize), offsets: &[(usize, usize)]) -> f64 {
    let grid = Grid::new(1, 1, element.0, element.1).unwrap();
    let body = Body { grid, poisson_ratio: nu, periodic: false };
    let asked = Asked { loaded: [true; 3], components: [true; 6], offsets: size };
    let mut kernels = Kernels::new(asked).unwrap();
    kernels.compute(&body, z / body.unit());
    let mut consts = Consts::new().unwrap();
    let mut worst: f64 = 0.0;
    for &(kx, ky) in offsets {
        let exact = reference([kx as f64 * element.0, ky as f64 * element.1, z], element, nu, &mut consts);
        let largest = exact.iter().flatten().fold(0.0, |l: f64, v| l.max(v.abs()));
        for (load, exact) in exact.iter().enumerate() {
            for (c, exact) in exact.iter().enumerate() {
                let found = kernels.table(load, c).unwrap()[ky * size.0 + kx];
                let error = (found - exact).abs() / largest;
                assert!(
                    error <= 1e-11,
                    "{element:?} nu {nu} z {z} ({kx}, {ky}) load {load} component {c}: {found} for {exact}"
                );
                worst = worst.max(error);
            }
        }
    }
    worst
}

const DEPTHS: [f64; 10] = [0.0, 1e-12, 0.01, 0.3, 1.0, 7.0, 12.1, 32.1, 1e4, 1e6];

#[test]
fn kernels_have_eleven_digits_near_and_far() {
    have_eleven_digits([((1.0, 1.0), 0.3), ((0.15, 0.1), 0.5)]);
}

#[test]
fn kernels_of_slender_elements_have_eleven_digits_near_and_far() {
    have_eleven_digits([((1.0, 8.0), 0.25), ((8.0, 1.0), 0.0)]);
}

fn have_eleven_digits(elements: [((f64, f64), f64); 2]) {
    let mut worst: f64 = 0.0;
    let some = [0, 1, 2, 5, 11, 12, 13, 31, 32, 33, 99];
    let square: Vec<_> = some.iter().flat_map(|&kx| some.iter().map(move |&ky| (kx, ky))).collect();
    let far = [32, 33, 250, 4097, 16384];
    let along: Vec<_> = far.iter().flat_map(|&k| (0..3).map(move |l| (k, l))).collect();
    let across: Vec<_> = along.iter().map(|&(k, l)| (l, k)).collect();
    for (element, nu) in elements {
        for z in DEPTHS {
            for (size, offsets) in [((100, 100), &square), ((16385, 3), &along), ((3, 16385), &across)] {
                worst = worst.max(error(element, nu, z, size, offsets));
            }
        }
    }
    println!("largest error of a kernel: {worst:e}");
}
