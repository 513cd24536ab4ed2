//! Stresses below contact patches that are coupled by factors. Each element belongs to one patch, as for the pressures.

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::scene::Patches;
use contact_normal::stress::{stress_at_points, subsurface_stress, Body, Loads, Tensor, Wanted};
use contact_normal::threads::Threads;

use crate::families::case::Random;

const WANTED: Wanted =
    Wanted { components: [true; 6], von_mises: true, maximum_shear: false, principal: false, directions: false };
const FACTORS: [f64; 9] = [1.0, 0.4, 0.0, 0.4, 1.0, 0.7, 0.0, 0.7, 1.0];

fn body() -> Body {
    Body { grid: Grid::new(14, 9, 1.0, 0.7).unwrap(), poisson_ratio: 0.3, periodic: false }
}

/// The patch of each element: three patches in oblique stripes, of which the second has two pieces, and elements of no patch.
fn patch(grid: &Grid) -> Vec<i32> {
    let of = |i: usize| [0, 1, 2, -1, 1][(i % grid.mx + i / grid.mx) / 5];
    (0..grid.len()).map(of).collect()
}

fn at(loads: &Loads<'_>, points: &[[f64; 3]]) -> Result<Vec<Tensor>, Error> {
    let grid = body().grid;
    let half = [0.5 * grid.mx as f64 * grid.dx, 0.5 * grid.my as f64 * grid.dy];
    let points: Vec<[f64; 3]> = points.iter().map(|[x, y, z]| [x - half[0], y - half[1], *z]).collect();
    let mut out = vec![[f64::NAN; 6]; points.len()];
    stress_at_points(&body(), loads, &points, &Threads::One, None, &mut out).map(|_| out)
}

fn at_depths(loads: &Loads<'_>, depths: &[f64]) -> Vec<Vec<Tensor>> {
    let mut found = Vec::new();
    let threads = Threads::new(2).unwrap();
    subsurface_stress(&body(), loads, depths, &WANTED, &threads, None, |_, depth| {
        let tensor = |i: usize| std::array::from_fn(|c| depth.stress[c][i]);
        found.push((0..body().grid.len()).map(tensor).collect());
    })
    .unwrap();
    found
}

/// By definition, the stress below an element or at a point is a sum over patches: the factor times the stress by the loads of that patch alone.
/// Below elements of no patch all loads have the factor 1. Loads on such elements have the factor 1 everywhere.
#[test]
fn each_patch_has_its_own_sum() {
    let (grid, mut random) = (body().grid, Random(7));
    let patch = patch(&grid);
    let loads: [Vec<f64>; 3] = std::array::from_fn(|_| (0..grid.len()).map(|_| random.next() - 0.3).collect());
    let patches = Some(Patches { count: 3, patch: &patch, factors: &FACTORS });
    let of = |loads: &[Vec<f64>; 3], patches, which: [bool; 3], ask: &mut dyn FnMut(&Loads<'_>)| {
        let [pressure, traction_x, traction_y] = [0, 1, 2].map(|k| which[k].then_some(&loads[k][..]));
        ask(&Loads { pressure, traction_x, traction_y, patches });
    };
    let depths = [0.0, 0.2, 1.5, 30.0];
    let centre = |i: usize, z: f64| [(i % 14) as f64 + 0.5, ((i / 14) as f64 + 0.5) * 0.7, z];
    for which in [[true, false, false], [true, true, true], [false, true, false]] {
        let mut expected = vec![vec![[0.0; 6]; grid.len()]; depths.len()];
        for b in -1..3 {
            let alone = loads.clone().map(|load| {
                let of_b = load.iter().zip(&patch).map(|(value, of)| if *of == b { *value } else { 0.0 });
                of_b.collect::<Vec<f64>>()
            });
            of(&alone, None, which, &mut |loads| {
                for (z, sums) in depths.iter().zip(&mut expected) {
                    let points: Vec<[f64; 3]> = (0..grid.len()).map(|i| centre(i, *z)).collect();
                    for (i, tensor) in at(loads, &points).unwrap().into_iter().enumerate() {
                        let factor = if patch[i].min(b) < 0 { 1.0 } else { FACTORS[(3 * patch[i] + b) as usize] };
                        sums[i].iter_mut().zip(tensor).for_each(|(sum, value)| *sum += factor * value);
                    }
                }
            });
        }
        of(&loads, patches, which, &mut |loads| {
            let by_points =
                depths.map(|z| at(loads, &(0..grid.len()).map(|i| centre(i, z)).collect::<Vec<_>>()).unwrap());
            for found in [at_depths(loads, &depths), by_points.to_vec()] {
                let pairs = found.iter().flatten().flatten().zip(expected.iter().flatten().flatten());
                // The round-off of sums of some hundred loads of about 1, by FFT.
                assert!(pairs.clone().all(|(a, b)| (a - b).abs() <= 1e-13), "{which:?}");
                assert!(pairs.count() == 4 * 6 * grid.len());
            }
        });
    }
}

#[test]
fn factors_of_one_are_no_patches_and_points_lie_below_one() {
    let (grid, mut random) = (body().grid, Random(8));
    let (patch, p): (_, Vec<f64>) = (patch(&grid), (0..grid.len()).map(|_| random.next()).collect());
    let plain = Loads::pressure(&p);
    let one = Loads { patches: Some(Patches { count: 3, patch: &patch, factors: &[1.0; 9] }), ..plain };
    assert_eq!(at_depths(&one, &[0.0, 1.0]), at_depths(&plain, &[0.0, 1.0]));
    let some = Loads { patches: Some(Patches { count: 3, patch: &patch, factors: &FACTORS }), ..plain };
    let aside = [[-0.5, 1.0, 1.0]];
    assert_eq!(at(&one, &aside), at(&plain, &aside));
    let refused = at(&some, &aside).unwrap_err();
    assert!(matches!(&refused, Error::InvalidArgument(text) if text.contains("patches")), "{refused}");
    assert!(at(&some, &[[0.0, 0.0, 1.0], [14.0, 6.3, 1.0]]).is_ok());
    let short = Loads { patches: Some(Patches { count: 3, patch: &patch[1..], factors: &FACTORS }), ..plain };
    assert!(matches!(at(&short, &[[0.5, 0.5, 1.0]]), Err(Error::InvalidArgument(_))));
    let periodic = Body { periodic: true, ..body() };
    let refused = subsurface_stress(&periodic, &some, &[1.0], &WANTED, &Threads::One, None, |_, _| {}).unwrap_err();
    assert!(matches!(refused, Error::Unsupported(_)), "{refused}");
}
