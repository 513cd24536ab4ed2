//! A wheel on a rail: the shift of CONTACT's performance tests (data/friction/README.md).

use contact_normal::grid::Grid;
use contact_normal::scene::{Friction, Motion, Prescribed};

/// The grid and the undeformed distances of grid `k` of the data (1, 2, 4 or 8).
pub fn surface(k: usize) -> (Grid, Vec<f64>) {
    let text = include_str!("../../data/friction/wheel_rail_profile.txt");
    let rows = text.lines().filter(|line| !line.starts_with('#'));
    let profile: Vec<(f64, f64)> = rows
        .map(|line| {
            let mut values = line.split_whitespace().map(|value| value.parse().unwrap());
            (values.next().unwrap(), values.next().unwrap())
        })
        .collect();
    let (mx, my) = [(71, 81), (143, 163), (287, 323), (575, 647)][k.trailing_zeros() as usize];
    let d = 0.1 / k as f64;
    let grid = Grid::new(mx, my, d, d).unwrap();
    let across = |y: f64| {
        let after = profile.partition_point(|(at, _)| *at <= y);
        let ((y0, h0), (y1, h1)) = (profile[after - 1], profile[after]);
        h0 + (y - y0) / (y1 - y0) * (h1 - h0)
    };
    let h = (0..grid.len())
        .map(|i| {
            let x = -3.55 + ((i % mx) as f64 + 0.5) * d;
            let y = -6.15 + ((i / mx) as f64 + 0.5) * d;
            x * x / (2.0 * 483.931) + across(y)
        })
        .collect();
    (grid, h)
}

/// The origin of the data's coordinates, relative to the middle of the grid.
fn origin(grid: &Grid) -> [f64; 2] {
    [3.55 - 0.5 * grid.mx as f64 * grid.dx, 6.15 - 0.5 * grid.my as f64 * grid.dy]
}

/// The shift of the data, with its spin.
pub fn shift(grid: &Grid) -> Friction<'static> {
    Friction {
        prescribed: [Prescribed::Creepage(0.0005), Prescribed::Creepage(-0.0010)],
        spin: 0.0008,
        spin_centre: origin(grid),
        ..Friction::new(0.3)
    }
}

/// Steady rolling with given creepages: case c of the data.
pub fn rolling(grid: &Grid) -> Friction<'static> {
    Friction {
        motion: Motion::SteadyRolling,
        prescribed: [Prescribed::Creepage(0.0005), Prescribed::Creepage(0.0)],
        spin: 0.0003,
        spin_centre: origin(grid),
        ..Friction::new(0.3)
    }
}

/// Steady rolling with given forces: case f of the data. `carried` is mu N.
pub fn rolling_with_forces(grid: &Grid, carried: f64) -> Friction<'static> {
    let prescribed = [-0.573, -0.327].map(|part| Prescribed::Force(part * carried));
    Friction { prescribed, ..rolling(grid) }
}
