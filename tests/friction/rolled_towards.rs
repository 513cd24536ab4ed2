//! Influence coefficients of visco-elastic bodies belong to one rolling direction. Steps in another direction are refused, with a message that names
//! the direction.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, SQRT_2};

use contact_normal::error::Error;
use contact_normal::friction::rolling_tables;
use contact_normal::grid::Grid;
use contact_normal::influence::{RowTables, Table};
use contact_normal::scene::{Bodies, Friction, Load, Motion, Prescribed, Scene, TangentialInfluence};
use contact_normal::solver::{solve, solve_tangential, Options, Outcome, Solver};
use contact_normal::visco::{rolling_table, RollingBody, Series};

const M: usize = 9;
/// The tables have two offsets more than the grid, because a step of rolling needs coefficients beyond it.
const REACH: (usize, usize) = (M + 2, M + 2);
const WIDTH: usize = 2 * (M + 2);

fn body(relaxing: f64, compliance: f64) -> RollingBody {
    RollingBody { compliance, series: Series::new(1.0, &[relaxing], &[1.0]).expect("a series") }
}

/// The coefficients of pressures and of tractions, for bodies that relax and roll at a speed, or, if the speed is `None`, for bodies that do not
/// relax.
fn coefficients(speed: Option<f64>) -> (Vec<f64>, [Vec<f64>; 3]) {
    let relaxing = if speed.is_some() { 0.6 } else { 0.0 };
    let both = |compliance: f64| [body(relaxing, compliance), body(relaxing, compliance)];
    let speed = speed.unwrap_or(1.0);
    let normal = rolling_table(REACH, (1.0, 1.0), &both(0.35), speed).unwrap();
    (normal, rolling_tables(REACH, (1.0, 1.0), (&both(0.5), [0.3; 2]), speed).unwrap())
}

/// A table with x and y exchanged: that of bodies that roll along y.
fn turned(table: &[f64]) -> Vec<f64> {
    (0..table.len()).map(|k| table[k % WIDTH * WIDTH + k / WIDTH]).collect()
}

struct Case {
    grid: Grid,
    h: Vec<f64>,
    normal: Vec<f64>,
    own: [Vec<f64>; 3],
}

impl Case {
    fn new((normal, own): (Vec<f64>, [Vec<f64>; 3])) -> Case {
        let at = |k: usize| (k as f64 - 0.5 * (M as f64 - 1.0)).powi(2);
        let h = (0..M * M).map(|i| 0.02 * (at(i % M) + at(i / M))).collect();
        Case { grid: Grid::new(M, M, 1.0, 1.0).unwrap(), h, normal, own }
    }

    fn scene(&self, motion: Motion, step: (f64, f64)) -> Scene<'_> {
        let (cx, cy) = REACH;
        let influence = Some(Table::scaled(cx, cy, &self.normal, 1.0, &self.grid).unwrap());
        Scene { influence, ..self.scene_of_tractions(motion, step, false) }
    }

    /// A scene with tables for tractions but not for pressures.
    fn scene_of_tractions(&self, motion: Motion, (direction, distance): (f64, f64), by_row: bool) -> Scene<'_> {
        let coefficients = self.own.each_ref().map(|values| &values[..]);
        let (cx, cy) = (REACH.0, if by_row { M } else { REACH.1 });
        let friction = Friction {
            motion,
            prescribed: [Prescribed::Creepage(-1e-3), Prescribed::Creepage(5e-4)],
            rolling_direction: direction,
            rolling_distance: distance,
            influence: Some(TangentialInfluence { cx, cy, coefficients, cross: None, scale: 1.0, by_row }),
            ..Friction::new(0.3)
        };
        Scene {
            friction: Some(friction),
            ..Scene::new(self.grid, &self.h, Bodies::same(1.0, 0.3), Load::Approach(0.3))
        }
    }

    /// The errors of a solve, of a solve on a handle that was set up with a step along +x or -x, and of the tangential problem alone.
    fn refusals(&self, motion: Motion, step: (f64, f64), set_up: Motion, direction: f64) -> [Option<Error>; 3] {
        let (scene, options) = (self.scene(motion, step), Options::default());
        let mut handle = Solver::new(&self.scene(set_up, (direction, 1.0)), &options).unwrap();
        // The handle already has the coefficients, so that the scene does not contain them.
        let unnamed = Scene { influence: None, ..scene.clone() };
        let pressure = vec![1.0; M * M];
        [
            solve(&scene, &options).map(drop).err(),
            handle.solve(&unnamed, &options, None, None).map(drop).err(),
            solve_tangential(&scene, &pressure, &options, None).map(drop).err(),
        ]
    }
}

const STEPS: [(f64, f64); 6] =
    [(0.0, 1.0), (PI, 1.0), (FRAC_PI_2, 1.0), (-FRAC_PI_2, 2.0), (FRAC_PI_4, SQRT_2), (-3.0 * FRAC_PI_4, 2.0 * SQRT_2)];

/// The coefficients of pressures and of tractions belong to one direction. Steps in other directions are refused, and the message names the right
/// direction and a remedy.
#[test]
fn steps_that_go_another_way_than_the_bodies_roll_are_refused() {
    for (speed, direction, way) in [(1.5, 0.0, "towards +x"), (-1.5, PI, "towards -x")] {
        let case = Case::new(coefficients(Some(speed)));
        for step in STEPS {
            let refusals = case.refusals(Motion::SteadyRolling, step, Motion::SteadyRolling, direction);
            for (call, refusal) in refusals.into_iter().enumerate() {
                if step.0 == direction {
                    assert_eq!(refusal, None, "{speed} {step:?} {call}");
                    continue;
                }
                let Some(Error::InvalidArgument(message)) = refusal else {
                    panic!("{speed} {step:?} {call}: {refusal:?}")
                };
                for words in
                    ["friction->influence[0] (xx) is", way, "but the step goes", "contact_normal_influence_rolling"]
                {
                    assert!(message.contains(words), "{speed} {step:?} {call}: {message}");
                }
            }
        }
    }
}

/// Only the coefficients of pressures belong to a direction, those of tractions are even in x. The set-up of a handle for transient rolling is
/// checked, too. A shift has no direction.
#[test]
fn tables_of_pressures_alone_refuse_steps_another_way() {
    let (_, even) = coefficients(None);
    let ([ahead, _], turned_ahead) = ([1.5, -1.5].map(|speed| coefficients(Some(speed)).0), FRAC_PI_2);
    for (normal, fits, way) in [(ahead.clone(), 0.0, "towards +x"), (turned(&ahead), turned_ahead, "towards +y")] {
        let case = Case::new((normal, even.clone()));
        for motion in [Motion::SteadyRolling, Motion::TransientRolling] {
            for step in STEPS {
                let [one, handle, alone] = case.refusals(motion, step, Motion::Shift, 0.0);
                // The tangential problem with given pressures does not use the coefficients of pressures.
                assert_eq!(alone, None);
                for refusal in [one, handle] {
                    if step.0 == fits {
                        assert_eq!(refusal, None, "{way} {step:?}");
                        continue;
                    }
                    let Some(Error::InvalidArgument(message)) = refusal else { panic!("{way} {step:?}: {refusal:?}") };
                    assert!(message.starts_with("influence is") && message.contains(way), "{step:?}: {message}");
                }
            }
        }
        assert_eq!(case.refusals(Motion::Shift, (0.0, 1.0), Motion::Shift, 0.0), [None, None, None]);
    }
}

/// The factor of a row, for loads and for displacements.
fn of_row(row: usize) -> f64 {
    1.0 + 0.1 * (row as f64).sin()
}

/// Row tables `d_i A d_j` from a table of offsets A and the factors d of the rows.
fn per_row(table: &[f64]) -> Vec<f64> {
    let value = |k: usize| {
        let (jy, iy, kx) = (k / WIDTH / M, k / WIDTH % M, k % WIDTH);
        of_row(jy) * of_row(iy) * table[(iy + REACH.1 - jy) * WIDTH + kx]
    };
    (0..M * M * WIDTH).map(value).collect()
}

/// Row tables of pressures for bodies that relax need not be symmetric, and belong to one direction. The result meets the conditions of contact by
/// direct sums.
#[test]
fn row_tables_of_pressures_refuse_steps_another_way() {
    let (_, even) = coefficients(None);
    let case = Case::new((Vec::new(), even.map(|table| per_row(&table))));
    let (cx, _) = REACH;
    for (speed, fits, way) in [(1.5, 0.0, "towards +x"), (-1.5, PI, "towards -x")] {
        let normal = per_row(&coefficients(Some(speed)).0);
        for direction in [0.0, PI] {
            let mut scene = case.scene_of_tractions(Motion::SteadyRolling, (direction, 1.0), true);
            scene.row_tables = Some(RowTables::new(cx, M, &normal, &case.grid).unwrap());
            let options = Options { tolerance: 1e-8, ..Options::default() };
            let found = solve(&scene, &options);
            if direction != fits {
                let Err(Error::InvalidArgument(message)) = found else { panic!("{speed} {direction}") };
                let names = message.starts_with("row_tables of row 0 on itself is") && message.contains(way);
                assert!(names && message.contains("but the step goes"), "{message}");
                continue;
            }
            let (solver, end, report) = found.unwrap();
            assert_eq!(end, Outcome::Converged);
            assert!(report.friction.unwrap().certificate.residual <= 1e-8);
            let p = &solver.state().p;
            let displaced = |i: usize| {
                let of = |j: usize| normal[(j / M * M + i / M) * WIDTH + cx + i % M - j % M] * p[j];
                (0..M * M).map(of).sum::<f64>()
            };
            for (i, (p, h)) in p.iter().zip(&case.h).enumerate() {
                let e = h - 0.3 + displaced(i);
                // The residual of 1e-8 is an rms over some 40 elements relative to h - approach, which is at most .3. One element may have sqrt(40)
                // times the rms, about 7.
                let is_met = if *p > 0.0 { e.abs() <= 1e-8 * 0.3 * 7.0 } else { e >= -1e-8 };
                assert!(is_met, "{i}: {e:e} {p}");
            }
            let ahead: f64 = (0..M * M).map(|i| p[i] * (i as f64 % M as f64 - 4.0)).sum();
            assert!(ahead * speed > 0.0, "pressures lie ahead: {ahead}");
        }
    }
}

/// Coefficients that are even in x and y allow steps in any direction.
#[test]
fn even_tables_allow_steps_any_way() {
    let case = Case::new(coefficients(None));
    for step in STEPS {
        assert_eq!(case.refusals(Motion::SteadyRolling, step, Motion::SteadyRolling, 0.0), [None, None, None]);
    }
}
