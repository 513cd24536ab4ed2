//! Tables of coefficients that are not even in x, for steady rolling of bodies that relax. Compared with the output of CONTACT (its example
//! visc_cylindr; eve70a/CONTACT), with direct sums, and with mirrored scenes.

use contact_normal::error::Error;
use contact_normal::friction::{rolling_tables, Compliance, Request, Solution, Solver, Tangential, EXTERIOR, SLIP};
use contact_normal::grid::Grid;
use contact_normal::influence::Table;
use contact_normal::scene::{
    Bodies, Fall, Friction, FrictionLaw, Load, Motion, Prescribed, Scene, TangentialInfluence,
};
use contact_normal::solver::{solve, Options, Outcome};
use contact_normal::threads::Threads;
use contact_normal::visco::{rolling_table, RollingBody, Series};

/// The integral of f from a to b by the double exponential rule, whose error is a few units of round-off even if the slope of f at the ends is
/// infinite.
fn integral(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (half, step) = (0.5 * (b - a), 0.125);
    let term = |k: i32| {
        let t = step * f64::from(k);
        let s = 0.5 * std::f64::consts::PI * t.sinh();
        let weight = 0.5 * std::f64::consts::PI * t.cosh() / s.cosh().powi(2);
        // The distance from the nearer end, 1 - tanh s, without cancellation.
        let from_end = (b - a) / (1.0 + (2.0 * s.abs()).exp());
        weight * f(if s < 0.0 { a + from_end } else { b - from_end })
    };
    half * step * (-26..=26).map(term).sum::<f64>()
}

/// The coefficient at offset x of a body that relaxes to half its modulus, for the elastic coefficient a: `a(x) + W(x)`. W is the mean of a over the
/// earlier offsets t > x of the material, with the weight `exp(-(t - x)/L)/L`. Lengths are in elements.
fn relaxed(a: impl Fn(f64) -> f64, x: f64, length: f64) -> f64 {
    let end = x + 40.0 * length;
    // The slope of a is infinite at the edges of the element, where panels begin. The other panels are as long as their distance from these edges,
    // and at most 2 L.
    let mut edges = vec![x, end];
    edges.extend([-0.5, 0.5]);
    edges.extend((-3..40).map(|k| 2f64.powi(k)).flat_map(|d| [-0.5 - d, 0.5 + d, 0.5 - d.min(0.5)]));
    edges.extend((1..20).map(|k| x + 2.0 * f64::from(k) * length));
    edges.retain(|at| *at >= x && *at <= end);
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    let panel = |ends: &[f64]| integral(ends[0], ends[1], |at| (-(at - x) / length).exp() * a(at)) / length;
    a(x) + edges.windows(2).map(panel).sum::<f64>()
}

/// The tables xx, yy and xy of two bodies that relax alike to half their modulus, over the offsets `-cx..cx` by `-cy..cy`. `length` is L in elements;
/// 0 means that the bodies have relaxed.
fn tables(tangential: &Tangential, (cx, cy): (usize, usize), length: f64) -> [Vec<f64>; 3] {
    [0, 1, 2].map(|component| {
        let at = |k: usize| {
            let (x, y) = ((k % (2 * cx)) as f64 - cx as f64, (k / (2 * cx)) as f64 - cy as f64);
            let a = |x: f64| tangential.at(x, y)[component];
            // The library does not read the first row and column. The coefficient xy is odd in y.
            let is_read = k % (2 * cx) > 0 && k / (2 * cx) > 0;
            match (component, length) {
                _ if !is_read => 0.0,
                (2, _) if y == 0.0 => 0.0,
                (_, 0.0) => 2.0 * a(x),
                (_, length) => relaxed(a, x, length),
            }
        };
        (0..4 * cx * cy).map(at).collect()
    })
}

fn influence(of: &[Vec<f64>; 3], (cx, cy): (usize, usize)) -> TangentialInfluence<'_> {
    let coefficients = of.each_ref().map(|values| &values[..]);
    TangentialInfluence { cx, cy, coefficients, cross: None, scale: 1.0, by_row: false }
}

/// Two cylinders that relax alike to half their modulus, on 99 x 1 elements, roll at 1000 mm/s under a tangential force of .6 mu N. The approach, the
/// creepage and the number of sticking elements are those that CONTACT printed.
#[test]
fn cylinders_that_relax_and_roll_are_those_of_contact() {
    let (mx, dx, dy, nu, g) = (99, 0.16, 1000.0, 0.4, 1143.0);
    let grid = Grid::new(mx, 1, dx, dy).unwrap();
    let h: Vec<f64> = (0..mx).map(|i| 0.01 * (-7.92 + i as f64 * dx).powi(2)).collect();
    let reach = (mx + 2, 1);
    for (creep, approach, creepage, sticks) in [
        (0.0, 2.50845, 1.378e-2, 51),
        (0.009, 2.36736, 1.365e-2, 37),
        (0.045, 2.06321, 1.152e-2, 36),
        (2.0, 1.45462, 9.932e-3, 35),
    ] {
        // The creep time is twice the relaxation time. A time of 0 becomes 1e-30: the bodies relax at once.
        let body = || RollingBody {
            compliance: (1.0 - nu) / (2.0 * g),
            series: Series::new(g, &[0.5 * g], &[f64::max(0.5 * creep, 1e-30)]).unwrap(),
        };
        let table = rolling_table((mx, 1), (dx, dy), &[body(), body()], 1000.0).unwrap();
        let tangential = Tangential::new(dx, dy, Compliance { shear: 1.0 / g, poisson: nu / g, unlike: 0.0 });
        let expected = tables(&tangential, reach, 1000.0 * creep / dx);
        let sheared = || RollingBody { compliance: 0.5 / g, ..body() };
        let own = rolling_tables(reach, (dx, dy), (&[sheared(), sheared()], [nu; 2]), 1000.0).unwrap();
        assert_near(&own, &expected, reach);
        let friction = Friction {
            motion: Motion::SteadyRolling,
            prescribed: [Prescribed::Force(-0.6 * 0.3 * 6e5), Prescribed::Creepage(0.0)],
            influence: Some(influence(&own, reach)),
            ..Friction::new(0.3)
        };
        let scene = Scene {
            influence: Some(Table::scaled(mx, 1, &table, 1.0, &grid).unwrap()),
            friction: Some(friction),
            ..Scene::new(grid, &h, Bodies::same(g, nu), Load::Force(6e5))
        };
        let (_, stop, report) = solve(&scene, &Options { tolerance: 1e-8, ..Options::default() }).unwrap();
        assert_eq!(stop, Outcome::Converged);
        let found = report.friction.unwrap();
        println!("{creep} {} {:?} {}", report.measures.approach, found.creepage, found.certificate.stick_count);
        // The tolerances are those of the printed digits. For the longest creep time CONTACT cuts off the tail of the displacements, an error of some
        // 1e-5.
        assert!((report.measures.approach - approach).abs() <= 4e-5, "{creep}: {}", report.measures.approach);
        assert!((found.creepage[0] / creepage - 1.0).abs() <= 5.1e-4, "{creep}: {:?}", found.creepage);
        assert_eq!(found.certificate.stick_count, sticks, "{creep}");
    }
}

/// Asserts that the entries that the library reads agree to 1e-10 of the largest one.
fn assert_near(found: &[Vec<f64>; 3], expected: &[Vec<f64>; 3], (cx, cy): (usize, usize)) {
    let largest = expected[0].iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    for k in (0..4 * cx * cy).filter(|k| k % (2 * cx) > 0 && k / (2 * cx) > 0) {
        for (found, expected) in found.iter().zip(expected) {
            let error = (found[k] - expected[k]).abs();
            assert!(error <= 1e-10 * largest, "{k}: {} {} of {largest}", found[k], expected[k]);
        }
    }
}

/// The library's tables equal those of the test's own quadrature. Rolling towards -x mirrors them. Unlike bodies are refused.
#[test]
fn tables_of_bodies_that_relax_are_those_of_quadrature() {
    let (reach, (dx, dy), nu, g) = ((9, 6), (0.5, 0.7), 0.3, 4.0);
    let tangential = Tangential::new(dx, dy, Compliance { shear: 1.0 / g, poisson: nu / g, unlike: 0.0 });
    for length in [0.05, 0.7, 3.0, 40.0] {
        // `part` of the modulus relaxes; if it is a half, the relaxation time is half the creep time.
        let body = |part: f64| RollingBody {
            compliance: 0.5 / g,
            series: Series::new(g, &[part * g], &[0.5 * length * dx / 10.0]).unwrap(),
        };
        let both = (&[body(0.5), body(0.5)], [nu; 2]);
        let found = rolling_tables(reach, (dx, dy), both, 10.0).unwrap();
        assert_near(&found, &tables(&tangential, reach, length), reach);
        let back = rolling_tables(reach, (dx, dy), both, -10.0).unwrap();
        let width = 2 * reach.0;
        for (component, (one, other)) in found.iter().zip(&back).enumerate() {
            for k in (0..one.len()).filter(|k| k % width > 0) {
                let mirror = k - k % width + width - k % width;
                let sign = if component == 2 { -1.0 } else { 1.0 };
                assert_eq!(other[k], sign * one[mirror], "{component} {k}");
            }
        }
        for (bodies, nu) in [([body(0.5), body(0.4)], [nu; 2]), ([body(0.5), body(0.5)], [nu, 0.2])] {
            let refused = rolling_tables(reach, (dx, dy), (&bodies, nu), 10.0).unwrap_err().to_string();
            assert!(refused.contains("unlike"), "{refused}");
        }
        // Two incompressible bodies never count as unlike, however they relax, because pressures do not displace their surfaces sideways.
        assert!(rolling_tables(reach, (dx, dy), (&[body(0.5), body(0.4)], [0.5; 2]), 10.0).is_ok());
    }
}

/// An ellipse on 15 x 9 elements, its pressures, and bodies that relax within some elements.
struct Small {
    grid: Grid,
    pressure: Vec<f64>,
    own: [Vec<f64>; 3],
}

const SMALL_REACH: (usize, usize) = (18, 11);

impl Small {
    fn new() -> Small {
        let grid = Grid::new(15, 9, 0.5, 0.7).unwrap();
        let at = |k: usize, m: usize| (k as f64 - 0.5 * (m as f64 - 1.0)) / (0.5 * m as f64);
        let inside = |i: usize| 1.0 - at(i % 15, 15).powi(2) - at(i / 15, 9).powi(2);
        let pressure = (0..grid.len()).map(|i| 100.0 * inside(i).max(0.0).sqrt()).collect();
        let tangential = Tangential::new(grid.dx, grid.dy, Compliance { shear: 1e-3, poisson: 3e-4, unlike: 0.0 });
        Small { grid, pressure, own: tables(&tangential, SMALL_REACH, 3.0) }
    }

    /// The scene mirrored at the plane of y and z: coordinates and components in x change their signs.
    fn mirrored(&self) -> Small {
        let (cx, _) = SMALL_REACH;
        let flip = |values: &[f64], sign: f64| -> Vec<f64> {
            let at = |k: usize| {
                if k % (2 * cx) == 0 {
                    0.0
                } else {
                    sign * values[k - k % (2 * cx) + 2 * cx - k % (2 * cx)]
                }
            };
            (0..values.len()).map(at).collect()
        };
        let own = [flip(&self.own[0], 1.0), flip(&self.own[1], 1.0), flip(&self.own[2], -1.0)];
        Small { grid: self.grid, pressure: self.pressure.clone(), own }
    }

    fn solved(&self, friction: &Friction<'_>) -> (Solution, [f64; 2]) {
        let friction = Friction { influence: Some(influence(&self.own, SMALL_REACH)), ..*friction };
        let own = friction.influence.as_ref().unwrap();
        let tangential = Tangential::of_tables(self.grid.dx, self.grid.dy, own).unwrap();
        let mut solver = Solver::new(self.grid, tangential, true, &Threads::One);
        let request = Request::new(&self.pressure, &friction, 1e-8);
        let (end, report) = solver.solve(&request, &mut |_, _| true).unwrap();
        assert_eq!(end, Outcome::Converged, "{report:?}");
        (solver.solution().unwrap().clone(), report.creepage)
    }

    /// The displacement by the tractions q at the place that lies `x` elements beyond element i along x.
    fn displacement(&self, q: &[[f64; 2]], i: usize, x: i64) -> [f64; 2] {
        let ((cx, cy), mx) = (SMALL_REACH, self.grid.mx);
        let (ix, iy) = ((i % mx) as i64 + x, (i / mx) as i64);
        q.iter().enumerate().fold([0.0; 2], |u, (j, q)| {
            let (kx, ky) = (ix - (j % mx) as i64, iy - (j / mx) as i64);
            let at = (ky + cy as i64) as usize * 2 * cx + (kx + cx as i64) as usize;
            let [xx, yy, xy] = self.own.each_ref().map(|values| values[at]);
            [u[0] + xx * q[0] + xy * q[1], u[1] + xy * q[0] + yy * q[1]]
        })
    }

    /// The rms residual of the conditions of steady rolling with a step of `by` elements along x, relative to the rms rigid slip.
    fn residual(&self, friction: &Friction<'_>, found: &Solution, (by, creepage): (i64, [f64; 2])) -> f64 {
        let moved = Friction { prescribed: creepage.map(Prescribed::Creepage), ..*friction };
        let (mut squares, mut rigid, mut slips) = (0.0, 0.0, 0);
        for i in 0..self.grid.len() {
            if found.stick_slip[i] == EXTERIOR {
                assert_eq!(found.traction[i], [0.0; 2]);
                continue;
            }
            let (w, q) = (moved.rigid_slip_at(&self.grid, i), found.traction[i]);
            let (here, there) = (self.displacement(&found.traction, i, 0), self.displacement(&found.traction, i, by));
            let s = [0, 1].map(|k| w[k] + here[k] - there[k]);
            let length = q[0].hypot(q[1]);
            let mut rest = s;
            if found.stick_slip[i] == SLIP {
                let outward = q.map(|q| q / length);
                let along = (s[0] * outward[0] + s[1] * outward[1]).min(0.0);
                rest = [0, 1].map(|k| s[k] - along * outward[k]);
                slips += 1;
            }
            for k in 0..2 {
                let difference = (s[k] - found.slip[i][k]).abs();
                assert!(difference <= 1e-11, "the slip of {i}: {s:?} {:?}", found.slip[i]);
            }
            squares += rest[0].powi(2) + rest[1].powi(2);
            rigid += w[0].powi(2) + w[1].powi(2);
        }
        assert!(slips > 0);
        (squares / rigid).sqrt()
    }
}

/// Steady rolling along x with given creepages and spin; mu = 0.3.
fn rolling(creepage: [f64; 2], spin: f64) -> Friction<'static> {
    Friction {
        motion: Motion::SteadyRolling,
        prescribed: creepage.map(Prescribed::Creepage),
        spin,
        ..Friction::new(0.3)
    }
}

#[test]
fn conditions_hold_by_direct_sums_and_bodies_seen_from_behind_are_the_same() {
    let small = Small::new();
    let mirrored = small.mirrored();
    let largest = small.own[0].iter().copied().fold(0.0, f64::max);
    // The tables are far from even in x.
    let (row, cx) = (SMALL_REACH.1 * 2 * SMALL_REACH.0, SMALL_REACH.0);
    assert!(small.own[0][row + cx - 1] - small.own[0][row + cx + 1] > 0.1 * largest);
    for (creepage, spin, steps) in [
        ([-4e-3, 0.0], 0.0, 1),
        ([-2e-3, 1e-3], 1e-3, 1),
        ([1e-3, -3e-3], -2e-3, 2),
        ([0.0, 0.0], 3e-3, 1),
        ([-0.1, 0.05], 0.0, 1),
    ] {
        let friction = Friction { rolling_distance: 0.5 * f64::from(steps), ..rolling(creepage, spin) };
        let (found, as_given) = small.solved(&friction);
        let residual = small.residual(&friction, &found, (i64::from(steps), as_given));
        // 1 % of the tolerance allows for the round-off of direct sums.
        assert!(residual <= 1.01e-8, "{creepage:?} {spin}: {residual:e}");
        // The mirrored bodies roll towards -x. Components in x and the spin change their signs, and places are mirrored.
        let back = Friction {
            prescribed: [Prescribed::Creepage(-creepage[0]), Prescribed::Creepage(creepage[1])],
            spin: -spin,
            rolling_direction: std::f64::consts::PI,
            ..friction
        };
        let (other, _) = mirrored.solved(&back);
        for i in 0..small.grid.len() {
            let [j, q] = [i - i % 15 + 14 - i % 15, i];
            let off = [found.traction[q][0] + other.traction[j][0], found.traction[q][1] - other.traction[j][1]];
            assert!(off[0].hypot(off[1]) <= 1e-5 * 30.0, "{creepage:?} {spin} {i}: {off:?}");
        }
    }
}

#[test]
fn forces_and_laws_are_solved_with_rolling_tables() {
    let small = Small::new();
    let (carried, friction) = (0.3 * small.pressure.iter().sum::<f64>() * 0.35, rolling([0.0; 2], 1e-3));
    let pulled =
        Friction { prescribed: [Prescribed::Force(-0.5 * carried), Prescribed::Force(0.2 * carried)], ..friction };
    let (found, creepage) = small.solved(&pulled);
    let sums = [0, 1].map(|k| found.traction.iter().map(|q| q[k]).sum::<f64>() * 0.35);
    assert!(
        (sums[0] + 0.5 * carried).abs() <= 1.01e-8 * carried && (sums[1] - 0.2 * carried).abs() <= 1.01e-8 * carried
    );
    // With prescribed forces the solver's residual is relative to the displacements, too, which are larger than the rigid slip; hence 1e-7 instead of
    // 1e-8.
    assert!(small.residual(&pulled, &found, (1, creepage)) <= 1e-7);
    let law = FrictionLaw::new(Fall::Exponential, (0.1, 0.2), 100.0, 1e4);
    let (falls, _) = small.solved(&Friction { law: Some(law), ..rolling([-0.01, 0.0], 0.0) });
    let slips = (0..small.grid.len()).filter(|&i| falls.stick_slip[i] == SLIP);
    let (mut off, mut count) = (0.0f64, 0);
    for i in slips {
        let s = falls.slip[i][0].hypot(falls.slip[i][1]);
        let mu = 0.1 + 0.2 * 0.5f64.powf(s * 1e4 / 0.5 / 100.0);
        let q = falls.traction[i][0].hypot(falls.traction[i][1]);
        (off, count) = (off.max((q - mu * small.pressure[i]).abs()), count + 1);
    }
    // The rms over all elements, relative to mu p, is below the tolerance, so that one element may have the square root of their number times as
    // much.
    assert!(count > 20 && off <= 1.01e-8 * 30.0 * (small.grid.len() as f64).sqrt(), "{count} {off:e}");
}

#[test]
fn only_steady_rolling_takes_rolling_tables_and_y_must_be_even() {
    let small = Small::new();
    let h = vec![0.0; small.grid.len()];
    let refused = |own: &[Vec<f64>; 3], motion: Motion| {
        let friction = Friction { motion, influence: Some(influence(own, SMALL_REACH)), ..rolling([-1e-3, 0.0], 0.0) };
        let scene = Scene {
            friction: Some(friction),
            ..Scene::new(small.grid, &h, Bodies::same(1e3, 0.3), Load::Approach(0.1))
        };
        solve(&scene, &Options::default()).map(drop)
    };
    assert!(refused(&small.own, Motion::SteadyRolling).is_ok());
    for motion in [Motion::Shift, Motion::TransientRolling] {
        let error = refused(&small.own, motion).expect_err("a refusal");
        let is_named =
            error.to_string().contains("friction->influence[0] (xx)") && error.to_string().contains("even in x");
        assert!(matches!(error, Error::Unsupported(_)) && is_named, "{error}");
    }
    let place = (SMALL_REACH.1 + 2) * 2 * SMALL_REACH.0 + SMALL_REACH.0 + 3;
    for (value, component, words) in [(0.7, 0, "even in y"), (0.7, 2, "xy odd in y"), (f64::NAN, 1, "finite")] {
        let mut own = small.own.clone();
        own[component][place] = value;
        let error = refused(&own, Motion::SteadyRolling).expect_err("a refusal");
        assert!(error.to_string().contains(words), "{error}");
    }
}

/// Tables of bodies that relax are for steady rolling only: a handle accepts those of another speed, and refuses a shift with them.
#[test]
fn a_handle_takes_the_tables_of_another_speed() {
    let (grid, reach) = (Grid::new(12, 8, 1.0, 1.0).unwrap(), (14, 9));
    let h: Vec<f64> =
        (0..grid.len()).map(|i| 0.01 * (((i % 12) as f64 - 5.5).powi(2) + ((i / 12) as f64 - 3.5).powi(2))).collect();
    let tangential = Tangential::new(1.0, 1.0, Compliance { shear: 1.0, poisson: 0.3, unlike: 0.0 });
    let [slow, fast] = [1.0, 4.0].map(|length| tables(&tangential, reach, length));
    let prescribed = [Prescribed::Creepage(-0.01), Prescribed::Creepage(0.002)];
    let scene = |of, motion| {
        let friction = Friction { motion, prescribed, influence: of, ..Friction::new(0.3) };
        Scene { friction: Some(friction), ..Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(0.1)) }
    };
    let rolling = |of| scene(Some(influence(of, reach)), Motion::SteadyRolling);
    let traction = |handle: &mut contact_normal::solver::Solver, scene: &Scene<'_>| {
        assert_eq!(handle.solve(scene, &Options::default(), None, None).unwrap().0, Outcome::Converged);
        handle.friction().unwrap().traction.clone()
    };
    let new = |of| contact_normal::solver::Solver::new(&rolling(of), &Options::default()).unwrap();
    let mut handle = new(&slow);
    let first = traction(&mut handle, &rolling(&slow));
    for of in [&fast, &slow] {
        let given = Friction { influence: Some(influence(of, reach)), ..Friction::new(0.0) };
        handle.set_tangential_influence(&given).expect("tables of relaxing bodies");
        let found = traction(&mut handle, &scene(None, Motion::SteadyRolling));
        assert!(found == traction(&mut new(of), &rolling(of)));
        assert_eq!(found == first, std::ptr::eq(of, &slow));
    }
    let refused = handle.solve(&scene(None, Motion::Shift), &Options::default(), None, None).err();
    assert!(refused.as_ref().is_some_and(|error| error.to_string().contains("must be even in x")), "{refused:?}");
}
