//! Points on the edges of elements at the surface are refused, however their coordinates are rounded.

use contact_normal::error::Error;
use contact_normal::grid::Grid;
use contact_normal::stress::{stress_at_points, Body, Loads, Tensor};
use contact_normal::threads::Threads;

const M: usize = 40;

fn stress((dx, dy): (f64, f64), point: [f64; 3]) -> Result<Tensor, Error> {
    let body = Body { grid: Grid::new(M, M / 2, dx, dy).unwrap(), poisson_ratio: 0.3, periodic: false };
    let q: Vec<f64> = (0..body.grid.len()).map(|i| 1.0 + (i % 7) as f64).collect();
    // The test's coordinates begin at the outer corner of element (0, 0), those of the library in the middle of the grid.
    let point = [point[0] - 0.5 * M as f64 * dx, point[1] - 0.25 * M as f64 * dy, point[2]];
    let mut out = [[0.0; 6]];
    let loads = Loads { traction_x: Some(&q), ..Loads::pressure(&q) };
    stress_at_points(&body, &loads, &[point], &Threads::One, None, &mut out).map(|_| out[0])
}

fn assert_refused(sizes: (f64, f64), point: [f64; 3]) {
    match stress(sizes, point) {
        Err(Error::InvalidArgument(text)) => assert!(text.contains("edge"), "{text}"),
        other => panic!("{sizes:?} {point:?}: {other:?}"),
    }
}

/// The coordinate of the k-th edge, computed in several ways that a program may use.
fn edges(k: usize, d: f64) -> [f64; 7] {
    let (step, far) = (d, 1e3 * M as f64 * d / 7.0);
    let added = (0..k).fold(0.0, |sum, _| sum + step);
    let times = k as f64 * d;
    [
        times,
        added,
        (far + times) - far,
        k as f64 / (1.0 / d),
        M as f64 * d - (M - k) as f64 * d,
        times.next_up(),
        times.next_down().max(0.0),
    ]
}

#[test]
fn edges_and_corners_are_refused_to_within_rounding() {
    for sizes in [(0.1, 0.1), (1.0 / 3.0, 0.7), (7e-6, 1e-5), (1e6 / 7.0, 3e5), (2.0, 0.3)] {
        let (dx, dy) = sizes;
        for k in [0, 1, 2, 3, 6, 7, 17, 20, 29, 39, 40] {
            for x in edges(k, dx) {
                for z in [0.0, 1e-300, 1e-17 * dx] {
                    assert_refused(sizes, [x, 3.4 * dy, z]);
                    assert_refused(sizes, [x, edges(5, dy)[1], z]);
                }
                // Points within an element, below the surface, and outside the grid are accepted.
                for point in
                    [[x + 0.5 * dx, 3.4 * dy, 0.0], [x, 3.4 * dy, 1e-3 * dx], [x, -0.4 * dy, 0.0], [x, 40.3 * dy, 0.0]]
                {
                    let inside = k < 40 || point[0] <= x || point[2] > 0.0;
                    let found = stress(sizes, point);
                    assert!(
                        !inside || found.is_ok_and(|stress| stress.iter().all(|value| value.abs() < 1e3)),
                        "{point:?}"
                    );
                }
            }
        }
        for k in [0, 1, 3, 11, 19, 20] {
            edges(k, dy).into_iter().for_each(|y| assert_refused(sizes, [4.7 * dx, y, 0.0]));
        }
        // A point that is a millionth of an element off an edge is not on the edge.
        assert!(stress(sizes, [3.000001 * dx, 3.4 * dy, 0.0]).is_ok());
    }
}
