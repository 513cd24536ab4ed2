//! Properties that every scene has, tested on random scenes: the contact conditions, monotonicity, least energy, symmetry, translation,
//! superposition. The scenes are the same each time.

#[allow(dead_code)] // only the certificate is used
use crate::families::{case, certificate};
#[allow(dead_code)]
use case::{centre, distance, Case};
use certificate::{assert_certified, assert_sound, recompute, run_with, Found};
use contact_normal::grid::Grid;
use contact_normal::scene::{Bodies, Load};
use contact_normal::solver::{Method, Options};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, rng_seed: RngSeed::Fixed(2026), failure_persistence: None, ..ProptestConfig::default() }
}

const TIGHT: f64 = 1e-9;

fn solved(case: &Case) -> Found {
    let found = run_with(case, &Options { tolerance: TIGHT, ..Options::default() }).expect("a solve");
    assert_certified(case, "AUTO", &found, TIGHT);
    found
}

fn largest(p: &[f64]) -> f64 {
    p.iter().copied().fold(0.0, f64::max)
}

/// A grid of up to 40 x 40 elements, with elements up to 100 times as long as wide.
fn grids() -> impl Strategy<Value = Grid> {
    (1..40usize, 1..40usize, -2.0..2.0f64, -6..6i32).prop_map(|(mx, my, aspect, size)| {
        let (size, ratio) = (10f64.powi(size), 10f64.powf(0.5 * aspect));
        Grid::new(mx, my, size * ratio, size / ratio).expect("a grid")
    })
}

fn bodies() -> impl Strategy<Value = Bodies> {
    let modulus = || (-6.0..12.0f64).prop_map(|exponent| 10f64.powf(exponent));
    (modulus(), prop_oneof![modulus(), Just(f64::INFINITY)], -0.9..=0.5f64, -0.9..=0.5f64)
        .prop_map(|(first, second, nu, mu)| Bodies { shear_modulus: [first, second], poisson_ratio: [nu, mu] })
}

/// A surface of balls, waves, noise and holes in any mixture, with a depth of 1.
#[derive(Clone, Debug)]
struct Surface {
    curvature: (f64, f64),
    waves: Vec<(f64, f64, f64, f64)>,
    noise: f64,
    holes: f64,
    seed: u64,
}

fn surfaces() -> impl Strategy<Value = Surface> {
    let wave = (-30.0..30.0f64, -30.0..30.0f64, 0.0..6.3f64, 0.0..0.2f64);
    let part = || prop_oneof![3 => Just(0.0), 1 => 0.0..0.5f64];
    ((0.0..8.0f64, 0.0..8.0f64), prop::collection::vec(wave, 0..4), part(), part(), any::<u64>())
        .prop_map(|(curvature, waves, noise, holes, seed)| Surface { curvature, waves, noise, holes, seed })
}

impl Surface {
    fn on(&self, grid: &Grid) -> Vec<f64> {
        let mut random = case::Random(self.seed);
        let (a, b) = (grid.mx as f64 * grid.dx, grid.my as f64 * grid.dy);
        let mut h = distance(grid, |x, y| {
            let (x, y) = (x / a, y / b);
            let waves: f64 = self.waves.iter().map(|w| w.3 * (w.0 * x + w.1 * y + w.2).cos()).sum();
            self.curvature.0 * x * x + self.curvature.1 * y * y + waves
        });
        for h in &mut h {
            *h += self.noise * random.next();
            if random.next() < self.holes {
                *h = f64::INFINITY;
            }
        }
        // At least one element has a surface.
        if h.iter().all(|h| h.is_infinite()) {
            h[0] = 0.0;
        }
        h
    }
}

/// A scene with an approach from slight to very large.
fn scenes() -> impl Strategy<Value = Case> {
    (grids(), surfaces(), bodies(), -3.0..1.0f64, -9..9i32).prop_map(|(grid, surface, bodies, depth, scale)| {
        let scale = 10f64.powi(scale);
        let h: Vec<f64> = surface.on(&grid).iter().map(|h| scale * h).collect();
        let lowest = h.iter().copied().fold(f64::INFINITY, f64::min);
        let load = Load::Approach(lowest + scale * 10f64.powf(depth));
        Case { bodies, ..Case::new("a random scene", grid, h, load) }
    })
}

/// The case with a larger load.
fn more(case: &Case, factor: f64) -> Case {
    let load = match case.load {
        Load::Approach(approach) => {
            let lowest = case.h.iter().copied().fold(f64::INFINITY, f64::min);
            Load::Approach(lowest + factor * (approach - lowest))
        }
        Load::Force(force) => Load::Force(factor * force),
    };
    Case { load, ..case.clone() }
}

proptest! {
    #![proptest_config(config(150))]

    #[test]
    fn the_contact_conditions_hold(case in scenes()) {
        let found = solved(&case);
        let by_force = Case { load: Load::Force(found.report.measures.force), ..case };
        solved(&by_force);
    }

    #[test]
    fn more_approach_is_more_force_and_more_area(case in scenes(), factor in 1.01..3.0f64) {
        let (less, more) = (solved(&case), solved(&more(&case, factor)));
        prop_assert!(more.report.measures.force > less.report.measures.force);
        // Whether elements at the rim are in contact depends on the tolerance.
        let lost = (0..less.p.len()).filter(|&i| less.p[i] > 1e-5 * largest(&less.p) && !more.contact[i]).count();
        prop_assert!(more.report.measures.contact_count >= less.report.measures.contact_count || lost == 0);
    }

    #[test]
    fn no_iterate_has_less_energy_than_the_solution(case in scenes(), by_force in any::<bool>()) {
        let case = if by_force {
            Case { load: Load::Force(solved(&case).report.measures.force), ..case }
        } else {
            case
        };
        let exact = recompute(&case, &solved(&case)).energy;
        for method in [Method::ProjectedCg, Method::Norm, Method::FullMultigrid] {
            for max_cycles in 1..6 {
                let options = Options { method, max_cycles, tolerance: TIGHT, ..Options::default() };
                let found = run_with(&case, &options).expect("a solve");
                let measures = assert_sound(&case, "some cycles", &found);
                // The effect of tolerance and round-off: e may be this part of h - approach, and the energy is half its work.
                let slack = (2.0 * TIGHT + measures.round_off) * exact.abs();
                prop_assert!(measures.energy >= exact - slack, "{method:?}: {} below {exact}", measures.energy);
            }
        }
    }

    #[test]
    fn what_is_symmetric_stays_so(case in scenes()) {
        let Grid { mx, my, .. } = case.grid;
        let mirror = |i: usize| (my - 1 - i / mx) * mx + mx - 1 - i % mx;
        let h: Vec<f64> = (0..case.h.len()).map(|i| case.h[i].min(case.h[mirror(i)])).collect();
        let case = Case { h, ..case };
        let found = solved(&case);
        for i in 0..found.p.len() {
            // Two residuals of 1e-9, times the condition number of A (below 300 with elements 100 times as long as wide).
            prop_assert!((found.p[i] - found.p[mirror(i)]).abs() <= 1e-6 * largest(&found.p), "element {i}");
        }
    }
}

proptest! {
    #![proptest_config(config(40))]

    #[test]
    fn a_contact_may_be_anywhere_in_the_grid(
        bodies in bodies(), curvature in (0.05..0.5f64, 0.05..0.5f64), depth in 0.05..0.4f64, x in 0..50usize, y in 0..40usize,
    ) {
        let grid = Grid::new(80, 70, 0.1, 0.1).expect("a grid");
        // A ball on 30 x 30 elements, at (x, y); other elements have no surface.
        let ball = |x: usize, y: usize| {
            let inside = |i: usize, start: usize| (start..start + 30).contains(&i);
            let at = |i: usize, start: usize| 0.1 * (i as f64 - start as f64 - 14.5);
            let h = (0..grid.len()).map(|i| {
                let (ix, iy) = (i % 80, i / 80);
                let (dx, dy) = (at(ix, x), at(iy, y));
                let h = curvature.0 * dx * dx + curvature.1 * dy * dy;
                if inside(ix, x) && inside(iy, y) { h } else { f64::INFINITY }
            });
            Case { bodies, ..Case::new("a ball", grid, h.collect(), Load::Approach(depth)) }
        };
        let (here, there) = (solved(&ball(0, 0)), solved(&ball(x, y)));
        for i in (0..grid.len()).filter(|i| i % 80 < 30 && i / 80 < 30) {
            let moved = there.p[i + y * 80 + x];
            // Two residuals of 1e-9, times the condition number of A on these grids (below 100).
            prop_assert!((here.p[i] - moved).abs() <= 1e-7 * largest(&here.p), "element {i}: {} and {moved}", here.p[i]);
        }
    }

    #[test]
    fn bodies_far_apart_hardly_feel_each_other(first in 0.1..1.0f64, second in 0.1..1.0f64, depth in 0.05..0.3f64) {
        let grid = Grid::new(160, 20, 0.1, 0.1).expect("a grid");
        let spot = |x: f64, at: f64, curvature: f64| curvature * (x - at) * (x - at);
        let with = |one: f64, other: f64| {
            let h = (0..grid.len()).map(|i| {
                let (x, y) = centre(&grid, i);
                let (a, b) = (spot(x, -7.0, one), spot(x, 7.0, other));
                if x < 0.0 { a + one * y * y } else { b + other * y * y }
            });
            h.collect::<Vec<f64>>()
        };
        let far = 1e3;
        let force = |h: &[f64], depth: f64| {
            let case = Case::new("two balls", grid, h.to_vec(), Load::Approach(depth));
            solved(&case).report.measures.force
        };
        let alone = [force(&with(first, far), depth), force(&with(far, second), depth)];
        let both = force(&with(first, second), depth);
        // Each body is displaced by the other one: u = F/(pi E* distance). The contacts are at most 1 wide and 14 apart.
        let pressed = |other: f64| other / (std::f64::consts::PI * 12.0);
        let less = [
            force(&with(first, far), depth - pressed(alone[1])),
            force(&with(far, second), depth - pressed(alone[0])),
        ];
        // The sharp tip that stands for the other body carries a little, too.
        let tip = force(&with(far, far), depth);
        prop_assert!(both <= alone[0] + alone[1], "{both} of {alone:?}");
        prop_assert!(both >= less[0] + less[1] - 2.0 * tip, "{both} for at least {less:?}");
    }
}
