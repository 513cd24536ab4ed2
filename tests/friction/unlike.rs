//! Unlike bodies: coupling coefficients compared with quadrature, the conditions of the normal and the tangential problem by direct sums, and
//! indentation with friction compared with Spence and with CONTACT.

use std::f64::consts::PI;

use contact_normal::friction::{cross, Compliance, Tangential};
use contact_normal::grid::Grid;
use contact_normal::influence::{HalfSpace, Kernel};
use contact_normal::scene::{Bodies, Friction, Load, Prescribed, Previous, Scene};
use contact_normal::solver::{solve, Options, Outcome, Solver};

use super::case::{distance, grid};
use super::coefficients::{panels, rule};

/// The integrals of `x/r^2` and `y/r^2` over an element: in y by the Gauss rule, on panels graded towards the singular point, and in x in closed
/// form, by the differences between both ends of `[ln(x^2 + y^2)]/2` and `[atan(x/y)]`.
fn by_quadrature(kx: f64, ky: f64, dx: f64, dy: f64) -> [f64; 2] {
    let (xp, xm) = ((kx + 0.5) * dx, (kx - 0.5) * dx);
    let panels = panels((ky - 0.5) * dy, (ky + 0.5) * dy);
    // Far from the element the round-off of the ends of panels exceeds that of the width, so that the sum of the weights is corrected to dy.
    let width: f64 = dy / panels.iter().map(|(from, to)| to - from).sum::<f64>();
    let mut sum = [0.0; 2];
    for (from, to) in panels {
        for (node, weight) in rule() {
            let (y, weight) = (0.5 * (from + to) + 0.5 * (to - from) * node, 0.5 * (to - from) * weight);
            let logarithm = 0.5 * (2.0 * kx * dx * dx / (xm * xm + y * y)).ln_1p();
            let angle = (y.abs() * dx).atan2(xp * xm + y * y).copysign(y);
            sum = [sum[0] + weight * logarithm, sum[1] + weight * angle];
        }
    }
    sum.map(|sum| width * sum)
}

#[test]
fn coupling_coefficients_are_those_of_quadrature() {
    let near: Vec<f64> =
        (0..14).map(f64::from).chain([0.3, 0.5, 1.5, 1.7, 1.99, 30.0, 130.0, 999.0, 16383.0, 16384.0]).collect();
    for aspect in [1e-3, 0.02, 0.3, 0.5, 1.0, 1.7, 40.0, 1e3] {
        for (&kx, &ky) in near.iter().flat_map(|kx| near.iter().map(move |ky| (kx, ky))) {
            let found = cross::integrals(kx, ky, aspect, 1.0);
            // Far along x the closed form in x loses digits: with x and y exchanged the smooth direction is integrated by the rule.
            let exact = if kx * aspect > ky {
                let [y, x] = by_quadrature(ky, kx, 1.0, aspect);
                [x, y]
            } else {
                by_quadrature(kx, ky, aspect, 1.0)
            };
            assert_eq!(cross::integrals(-kx, -ky, aspect, 1.0), [-found[0], -found[1]]);
            if (kx, ky) == (0.0, 0.0) {
                assert_eq!(found, [0.0; 2]);
                continue;
            }
            let error = (found[0] - exact[0]).hypot(found[1] - exact[1]) / exact[0].hypot(exact[1]);
            // As for the other coefficients (coefficients.rs), the closed form in the quadrature loses digits.
            assert!(error <= 1e-12, "{aspect} ({kx}, {ky}): {found:?} {exact:?} {error}");
        }
    }
}

/// A ball of radius 100 on m x m elements of 0.25.
pub fn ball(m: usize) -> (Grid, Vec<f64>) {
    let grid = grid(m, m, 0.25, 0.25);
    (grid, distance(&grid, |x, y| (x * x + y * y) / 200.0))
}

pub const RIGID_ON_SOFT: Bodies = Bodies { shear_modulus: [1.0, f64::INFINITY], poisson_ratio: [0.0, 0.0] };

/// The coefficients of a pair of bodies on m x m elements of 0.25, for all offsets.
pub struct Sums {
    m: usize,
    /// Of each offset: Azz, Axx, Axy, Ayy, Axz, Ayz.
    coefficients: Vec<[f64; 6]>,
}

impl Sums {
    pub fn new(m: usize, bodies: &Bodies) -> Sums {
        let compliance = Compliance::of(bodies);
        let (normal, tangential) =
            (HalfSpace::new(0.25, 0.25, bodies.compliance()), Tangential::new(0.25, 0.25, compliance));
        let last = m as i64 - 1;
        let at = |x: i64, y: i64| {
            let [xx, yy, xy] = tangential.at(x as f64, y as f64);
            let [xz, yz] =
                cross::integrals(x as f64, y as f64, 0.25, 0.25).map(|value| -compliance.unlike / PI * value);
            [normal.at(x, y), xx, xy, yy, xz, yz]
        };
        let coefficients = (-last..=last).flat_map(|y| (-last..=last).map(move |x| at(x, y))).collect();
        Sums { m, coefficients }
    }

    /// The displacements [ux, uy, uz] of element i: those by the tractions q, and those by the pressures p.
    pub fn displacements(&self, i: usize, q: &[[f64; 2]], p: &[f64]) -> [[f64; 3]; 2] {
        let m = self.m;
        let [mut by_tractions, mut by_pressures] = [[0.0; 3]; 2];
        for (j, ([qx, qy], p)) in q.iter().zip(p).enumerate() {
            let [zz, xx, xy, yy, xz, yz] =
                self.coefficients[(i / m + m - 1 - j / m) * (2 * m - 1) + (i % m + m - 1 - j % m)];
            let of_q = [xx * qx + xy * qy, xy * qx + yy * qy, -xz * qx - yz * qy];
            let of_p = [xz * p, yz * p, zz * p];
            by_tractions = [0, 1, 2].map(|k| by_tractions[k] + of_q[k]);
            by_pressures = [0, 1, 2].map(|k| by_pressures[k] + of_p[k]);
        }
        [by_tractions, by_pressures]
    }
}

#[test]
fn both_problems_of_unlike_bodies_meet_their_conditions() {
    let (grid, h) = ball(24);
    let bodies = [
        RIGID_ON_SOFT,
        Bodies { shear_modulus: [1.0, 1e9], poisson_ratio: [0.3; 2] },
        Bodies { shear_modulus: [1.0, 3.0], poisson_ratio: [0.1, 0.45] },
    ];
    // By definition 1/G = (1/G1 + 1/G2)/2 = 1/2, and K/G = ((1 - 2 nu1)/G1 - (1 - 2 nu2)/G2)/4 = 1/4.
    let compliance = Compliance::of(&RIGID_ON_SOFT);
    assert_eq!((compliance.shear, compliance.unlike), (0.5, 0.25));
    for bodies in bodies {
        let sums = Sums::new(24, &bodies);
        for mu in [0.3, 0.6, 0.9] {
            for tolerance in [1e-4, 1e-6] {
                let shift = [Prescribed::Creepage(-0.02 * mu), Prescribed::Creepage(0.0)];
                for (prescribed, load) in
                    [([Prescribed::Creepage(0.0); 2], Load::Force(0.2)), (shift, Load::Approach(0.05))]
                {
                    let friction = Friction { prescribed, ..Friction::new(mu) };
                    let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, load) };
                    let [normal, tangential] = residuals(&sums, &scene, tolerance);
                    // .1 % of the tolerance allows for the different round-off of direct sums and FFT products.
                    assert!(
                        normal.max(tangential) <= 1.001,
                        "{bodies:?} {mu} {tolerance:e} {load:?}: {normal} {tangential}"
                    );
                }
            }
        }
    }
}

/// The residuals of the normal and of the tangential problem, relative to the tolerance.
fn residuals(sums: &Sums, scene: &Scene<'_>, tolerance: f64) -> [f64; 2] {
    let (friction, h) = (scene.friction.as_ref().unwrap(), scene.undeformed_distance);
    let (solver, stop, report) = solve(scene, &Options { tolerance, ..Options::default() }).unwrap();
    assert_eq!(stop, Outcome::Converged);
    let (state, solution, mu) = (solver.state(), solver.friction().unwrap(), friction.coefficient.at(0));
    let shift = friction.prescribed.map(|given| match given {
        Prescribed::Creepage(shift) => shift,
        Prescribed::Force(_) => panic!("a motion is given"),
    });
    let (mut residual, mut distance, mut slips, mut rigid, mut moved, mut count) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    let (mut penetration, mut deepest) = (0.0_f64, 0.0_f64);
    for (i, h) in h.iter().enumerate() {
        let [by_q, by_p] = sums.displacements(i, &solution.traction, &state.p);
        // The displacement by tractions along the normal adds to the undeformed distance.
        let d = h - state.approach + by_q[2];
        let e = d + by_p[2];
        assert!((state.deformed_distance(i) - e).abs() <= 1e-12, "{i}: {} {e}", state.deformed_distance(i));
        if !(state.p[i] > 0.0) {
            penetration = penetration.max(-e);
            continue;
        }
        (residual, distance, deepest) = (residual + e * e, distance + d * d, deepest.max(d.abs()));
        let w = [by_p[0] + shift[0], by_p[1] + shift[1]];
        let s = [w[0] + by_q[0], w[1] + by_q[1]];
        let (q, g) = (solution.traction[i], mu * state.p[i]);
        let size = q[0].hypot(q[1]);
        assert!(size <= g);
        let along = if size >= g * (1.0 - 1e-7) { ((s[0] * q[0] + s[1] * q[1]) / size).min(0.0) } else { 0.0 };
        let rest = [s[0] - along * q[0] / size.max(1e-300), s[1] - along * q[1] / size.max(1e-300)];
        slips += rest[0] * rest[0] + rest[1] * rest[1];
        rigid += w[0] * w[0] + w[1] * w[1];
        moved += by_q[0] * by_q[0] + by_q[1] * by_q[1];
        count += 1.0;
        let difference = (solution.slip[i][0] - s[0]).abs() + (solution.slip[i][1] - s[1]).abs();
        assert!(difference <= 1e-12, "{i}: {:?} {s:?}", solution.slip[i]);
    }
    assert!(count > 100.0);
    assert!(penetration <= tolerance * deepest, "{penetration} {deepest}");
    let found = [(residual / distance).sqrt(), (slips / f64::max(rigid, moved)).sqrt()];
    let reported = [report.measures.certificate.residual, report.friction.unwrap().certificate.residual];
    for (found, reported) in found.iter().zip(reported) {
        // The reported residuals are those of the solution. Direct sums and FFT products differ by a round-off of 1e-12.
        assert!((found - reported).abs() <= 1e-10, "{found:e} {reported:e}");
    }
    found.map(|found| found / tolerance)
}

#[test]
fn reported_bytes_hold_what_couples_unlike_bodies() {
    let (grid, h) = ball(24);
    let bytes = |nu: f64| {
        let bodies = Bodies { shear_modulus: [1.0; 2], poisson_ratio: [0.3, nu] };
        let friction = Friction { prescribed: [Prescribed::Creepage(-0.001); 2], ..Friction::new(0.3) };
        let scene = Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Approach(0.05)) };
        solve(&scene, &Options::default()).unwrap().2.bytes
    };
    // Each element has 7 more numbers: two tangential displacements, the displacement along the normal by tractions, the distance that includes it,
    // previous pressures, and two fields of a product. Two odd kernels have transforms of a quarter of the waves of twice the sides: 2 numbers for
    // each element.
    let least = (24 * 24 * (7 + 2)) as u64 * 8;
    assert!(bytes(0.2) >= bytes(0.3) + least, "{} {} {least}", bytes(0.2), bytes(0.3));
}

#[test]
fn an_indentation_with_friction_is_similar_at_all_loads() {
    // Spence (1968, 1975): while the load grows, the stick area is a constant part of the contact area. Here for a rigid ball on a soft half-space.
    let parts = stick_areas(RIGID_ON_SOFT);
    for part in &parts[15..] {
        // In CONTACT's spence35, a ball in 35 steps, 225 of 921 elements stick. The tolerance is half an element of 0.25 on a radius of 3.2 to 4.8.
        assert!((part - (225.0_f64 / 921.0).sqrt()).abs() <= 0.04, "{parts:?}");
    }
    // With nu = 0.3 pressures cause smaller tangential displacements than with nu = 0: the stick area is larger, and again a constant part.
    let stiffer = stick_areas(Bodies { poisson_ratio: [0.3, 0.0], ..RIGID_ON_SOFT });
    let last = stiffer[23];
    for (part, with_nu_0) in stiffer[15..].iter().zip(&parts[15..]) {
        assert!((part - last).abs() <= 0.04 && *part > with_nu_0 + 0.04 && *part < 0.96, "{stiffer:?}");
    }
}

/// The radius of the stick area relative to that of the contact, while the load on a ball grows through 24 contact radii from 0.2 to 4.8.
fn stick_areas(bodies: Bodies) -> Vec<f64> {
    let (grid, h) = ball(48);
    let scene =
        |force: f64, friction| Scene { friction: Some(friction), ..Scene::new(grid, &h, bodies, Load::Force(force)) };
    let mut solver = Solver::new(&scene(1.0, Friction::new(0.3)), &Options::default()).unwrap();
    let mut parts = Vec::new();
    for stage in 1..=24 {
        let radius = 0.2 * f64::from(stage);
        // E* = 2 G/(1 - nu).
        let force = 4.0 / 3.0 * 2.0 / (1.0 - bodies.poisson_ratio[0]) * radius.powi(3) / 100.0;
        let previous = if stage == 1 { Previous::None } else { Previous::Kept };
        let friction = Friction { previous, ..Friction::new(0.3) };
        let (stop, report) = solver.solve(&scene(force, friction), &Options::default(), None, None).unwrap();
        assert_eq!(stop, Outcome::Converged, "{stage}");
        let found = report.friction.unwrap();
        assert!(found.certificate.residual <= 1e-6);
        assert!((found.force[0].hypot(found.force[1])) <= 1e-6 * force, "{:?}", found.force);
        parts.push((found.certificate.stick_count as f64 / report.measures.contact_count as f64).sqrt());
    }
    parts
}

#[test]
fn contacts_spence35_is_met() {
    // CONTACT's example spence35 (Kalker 1990, figure 5.25): a rigid ball on a soft half-space with G = 0.5 and nu = 0, mu = .2986,
    // undeformed distance .004116 r^2, 45 x 45 elements of 0.2 whose middle is 1e-4 off; forces (k/45)^3, of which six digits are given.
    let (m, d) = (45, 0.2);
    let grid = Grid::new(m, m, d, d).unwrap();
    let place = |i: usize| -4.4999 + (i as f64 + 0.5) * d;
    let h: Vec<f64> = (0..grid.len()).map(|i| 0.004116 * (place(i % m).powi(2) + place(i / m).powi(2))).collect();
    let bodies = Bodies { shear_modulus: [0.5, 1e5], poisson_ratio: [0.0; 2] };
    let scene = |stage: u32| {
        let previous = if stage == 1 { Previous::None } else { Previous::Kept };
        let force = ((f64::from(stage) / 45.0).powi(3) * 1e6).round() / 1e6;
        Scene {
            friction: Some(Friction { previous, ..Friction::new(0.2986) }),
            ..Scene::new(grid, &h, bodies, Load::Force(force))
        }
    };
    let options = Options { tolerance: 1e-7, ..Options::default() };
    let mut solver = Solver::new(&scene(1), &options).unwrap();
    let mut met = 0;
    for stage in 1..=35 {
        let (stop, report) = solver.solve(&scene(stage), &options, None, None).unwrap();
        assert_eq!(stop, Outcome::Converged, "{stage}");
        let certificate = report.friction.unwrap().certificate;
        let found = (report.measures.contact_count, certificate.stick_count, certificate.slip_count);
        // The numbers of elements in contact, in stick and in slip that CONTACT printed.
        for (printed, counts) in [(6, (29, 5, 24)), (18, (241, 61, 180)), (35, (921, 225, 696))] {
            if stage == printed {
                assert_eq!(found, counts, "{stage}");
                met += 1;
            }
        }
        if stage == 35 {
            // The tolerance is half a unit of CONTACT's last printed digit.
            assert!((report.measures.max_pressure - 0.02392).abs() <= 5e-6, "{}", report.measures.max_pressure);
        }
    }
    assert_eq!(met, 3);
}
