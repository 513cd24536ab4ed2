//! The library's passes over blocks of rows, compared with passes over the whole grid.

use super::fold;
use crate::error::Error;
use crate::grid::Grid;
use crate::rectangle::Rectangle;
use crate::scene::{Bodies, Load, Scene};
use crate::threads::Threads;

/// Grids of one element, one row, one column, rows longer than a block, many blocks, and so many elements that threads share them.
const SIZES: [(usize, usize); 7] = [(1, 1), (1500, 1), (1, 1500), (3000, 3), (40, 130), (257, 66), (200, 190)];

fn grids() -> impl Iterator<Item = (Grid, Threads)> {
    SIZES.into_iter().flat_map(|(mx, my)| {
        let grid = Grid::new(mx, my, 1.0, 1.0).expect("a grid");
        [1, 2, 3].map(|count| (grid, Threads::new(count).expect("threads")))
    })
}

#[test]
fn blocks_are_whole_rows_in_order_and_cover_the_grid() {
    for (grid, threads) in grids() {
        let join = |so_far: (usize, usize), block: (usize, usize)| {
            assert_eq!(so_far.1, block.0, "{grid:?}");
            assert_eq!(block.1 % grid.mx, 0, "{grid:?}");
            (0, block.1)
        };
        assert_eq!(fold(&grid, &threads, (0, 0), |block| (block.start, block.end), join), (0, grid.len()));
    }
}

#[test]
fn the_box_is_that_of_all_that_counts() {
    let mut seed = 1u64;
    let mut below = |n: usize| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as usize % n
    };
    for (grid, threads) in grids() {
        for count in [0, 1, 2, 5] {
            let mut values = vec![0u8; grid.len()];
            (0..count).for_each(|_| values[below(grid.len())] = 1);
            let found = Rectangle::around_values(&values, &grid, &threads, |row| row.contains(&1));
            let those = || (0..grid.len()).filter(|&i| values[i] == 1);
            let range = |of: &dyn Fn(usize) -> usize| Some(those().map(of).min()?..those().map(of).max()? + 1);
            let expected = range(&|i| i % grid.mx).zip(range(&|i| i / grid.mx)).map(|(x, y)| Rectangle { x, y });
            assert_eq!(found, expected, "{grid:?}, {count} elements");
        }
    }
}

#[test]
fn the_lowest_distance_is_found_and_what_is_no_distance_is_refused() {
    for (grid, threads) in grids() {
        for i in [0, grid.len() / 2, grid.len() - 1] {
            let lowest = |at_i: f64, elsewhere: f64| {
                let mut h = vec![elsewhere; grid.len()];
                h[i] = at_i;
                let scene = Scene::new(grid, &h, Bodies::same(1.0, 0.3), Load::Approach(1.0));
                scene.check_distance_and_load(&threads)
            };
            assert_eq!(lowest(-2.5, 3.0), Ok(-2.5));
            assert_eq!(lowest(f64::INFINITY, f64::INFINITY), Ok(f64::INFINITY));
            for none in [f64::NAN, f64::NEG_INFINITY] {
                let refusal = lowest(none, 3.0);
                let name = format!("element ({}, {})", i % grid.mx, i / grid.mx);
                let names = |error: &Error| matches!(error, Error::NotFinite(message) if message.contains(&name));
                assert!(refusal.as_ref().is_err_and(names), "{grid:?}: {refusal:?}");
            }
        }
    }
}
