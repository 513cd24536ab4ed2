//! Transient rolling: the conditions of steps in any direction, recomputed by direct sums, and a sequence of steps that becomes steady.

use std::f64::consts::PI;

use contact_normal::friction::{Request, Vector};
use contact_normal::grid::Grid;
use contact_normal::scene::{Friction, Motion, Prescribed, Previous};

use super::dense;
use super::support::{residual, run, solver, tangential};

/// Hertz' pressures over an ellipse with semi-axes 1 and b, on m x m elements.
fn ellipse(m: usize, b: f64) -> (Grid, Vec<f64>) {
    let grid = Grid::new(m, m, 2.2 / m as f64, 2.2 * b / m as f64).unwrap();
    let centre = 0.5 * (m as f64 - 1.0);
    let bound = (0..grid.len())
        .map(|i| {
            let (x, y) = (((i % m) as f64 - centre) * grid.dx, ((i / m) as f64 - centre) * grid.dy / b);
            (1.0 - x * x - y * y).max(0.0).sqrt()
        })
        .collect();
    (grid, bound)
}

fn rolling(creepage: Vector, spin: f64) -> Friction<'static> {
    Friction {
        motion: Motion::TransientRolling,
        prescribed: creepage.map(Prescribed::Creepage),
        spin,
        ..Friction::new(1.0)
    }
}

#[test]
fn steps_in_any_direction_and_of_any_length_meet_the_conditions() {
    let (grid, g) = ellipse(20, 0.7);
    for (k, direction) in [0.0, 0.5 * PI, PI, 37.0 / 180.0 * PI].into_iter().enumerate() {
        for length in [0.3, 1.0, 3.0] {
            let mut solver = solver(&grid, 0.3);
            let shift =
                Friction { prescribed: [Prescribed::Creepage(-0.4), Prescribed::Creepage(0.1)], ..Friction::new(1.0) };
            let (_, mut before) = run(&mut solver, &g, &shift, 1e-7);
            let step = Friction {
                rolling_distance: length * grid.dx,
                rolling_direction: direction,
                previous: Previous::Kept,
                ..rolling([-0.3, 0.2 * k as f64], 0.3)
            };
            for _ in 0..4 {
                let (report, now) = run(&mut solver, &g, &step, 1e-6);
                let slip_residual = residual((&grid, 0.3), &g, &step, &before.traction, (&report, &now));
                // The tolerance, and round-off of the displacements, which are far larger than the slip: 2e-9 is ample.
                assert!(slip_residual <= 1.001e-6 + 1e-9, "{direction} {length}: {slip_residual}");
                before = now;
            }
        }
    }
}

/// A step of 3e5 by 3e5 elements: a table of the coefficients up to this offset would take 2 TB.
#[test]
fn a_long_step_of_whole_elements_takes_no_more_memory_than_a_short_one() {
    let (grid, g) = ellipse(20, 1.0);
    for motion in [Motion::TransientRolling, Motion::SteadyRolling] {
        let mut solver = solver(&grid, 0.3);
        let shift =
            Friction { prescribed: [Prescribed::Creepage(-0.4), Prescribed::Creepage(0.1)], ..Friction::new(1.0) };
        let (_, before) = run(&mut solver, &g, &shift, 1e-7);
        let distance = 3e5 * 2.0f64.sqrt() * grid.dx;
        let step = Friction {
            motion,
            rolling_distance: distance,
            rolling_direction: 0.25 * PI,
            previous: Previous::Kept,
            ..rolling([-0.4 / distance, 0.2 / distance], 0.0)
        };
        let by = step.elements_rolled(&grid);
        assert_eq!((by.0.fract(), by.0, by.1), (0.0, by.1, 3e5));
        let (report, now) = run(&mut solver, &g, &step, 1e-6);
        let slip_residual = residual((&grid, 0.3), &g, &step, &before.traction, (&report, &now));
        assert!(slip_residual <= 1.001e-6 + 1e-9, "{motion:?}: {slip_residual}");
        assert!(report.certificate.stick_count > 0 && report.certificate.slip_count > 0);
    }
}

#[test]
fn previous_tractions_may_be_given_or_kept() {
    let (grid, g) = ellipse(24, 1.0);
    let shift = Friction { prescribed: [Prescribed::Creepage(-0.3), Prescribed::Creepage(0.0)], ..Friction::new(1.0) };
    let mut kept = solver(&grid, 0.3);
    let (_, first) = run(&mut kept, &g, &shift, 1e-8);
    let (x, y): (Vec<f64>, Vec<f64>) = first.traction.iter().map(|q| (q[0], q[1])).unzip();
    let step = rolling([-0.2, 0.1], 0.0);
    let (_, of_kept) = run(&mut kept, &g, &Friction { previous: Previous::Kept, ..step }, 1e-8);
    let given = Friction { previous: Previous::Given([&x, &y]), ..step };
    let (_, of_given) = run(&mut solver(&grid, 0.3), &g, &given, 1e-8);
    assert_eq!(of_kept.traction, of_given.traction);
    // A step from rest has other tractions. A new solver has no tractions from which a step could continue.
    let (_, from_rest) = run(&mut solver(&grid, 0.3), &g, &step, 1e-8);
    assert_ne!(of_kept.traction, from_rest.traction);
    let continued = Friction { previous: Previous::Kept, ..step };
    let nothing = Request { limit: 100, ..Request::new(&g, &continued, 1e-6) };
    assert!(solver(&grid, 0.3).solve(&nothing, &mut |_, _| true).is_err());
}

#[test]
fn a_shift_back_and_forth_remembers_where_it_was() {
    // Mindlin and Deresiewicz (1953): if a shift is taken back, tractions remain. If it is then repeated, the first tractions return, because nothing
    // has slipped farther.
    let (grid, g) = ellipse(32, 1.0);
    let to = |length: f64| Friction {
        prescribed: [Prescribed::Creepage(length), Prescribed::Creepage(0.0)],
        ..Friction::new(1.0)
    };
    let mut solver = solver(&grid, 0.0);
    let (first_report, first) = run(&mut solver, &g, &to(-0.8), 1e-8);
    let (back_report, _) = run(&mut solver, &g, &Friction { previous: Previous::Kept, ..to(0.8) }, 1e-8);
    let (again_report, again) = run(&mut solver, &g, &Friction { previous: Previous::Kept, ..to(-0.8) }, 1e-8);
    let carried: f64 = g.iter().sum::<f64>() * grid.element_area();
    // Unloading by d is loading with twice the bound by d, which is twice the force of d/2 with the plain bound: F(0) = F(-d) - 2 F(d/2).
    let (half, _) = run(&mut super::support::solver(&grid, 0.0), &g, &to(-0.4), 1e-8);
    let expected = first_report.force[0] - 2.0 * half.force[0];
    // Both sides have the same discretisation. The tolerances allow for a residual of 1e-8.
    assert!((back_report.force[0] - expected).abs() <= 1e-5 * carried, "{} {expected}", back_report.force[0]);
    assert!((again_report.force[0] - first_report.force[0]).abs() <= 1e-6 * carried);
    let apart = first.traction.iter().zip(&again.traction).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
    assert!(apart.fold(0.0, f64::max) <= 1e-4);
}

#[test]
fn rolling_becomes_steady() {
    let (grid, g) = ellipse(24, 1.0);
    let (creepage, spin, nu) = ([-0.3, 0.1], 0.1, 0.28);
    let mut solver = solver(&grid, nu);
    let shift = Friction { prescribed: [Prescribed::Creepage(-0.5), Prescribed::Creepage(0.1)], ..Friction::new(1.0) };
    let (_, mut last) = run(&mut solver, &g, &shift, 1e-7);
    let step = Friction { previous: Previous::Kept, ..rolling(creepage, spin) };
    let (mut changes, mut products) = (Vec::new(), 0.0);
    for _ in 0..120 {
        let (report, now) = run(&mut solver, &g, &step, 1e-7);
        let change = now.traction.iter().zip(&last.traction).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
        changes.push(change.fold(0.0, f64::max));
        products += report.products;
        last = now;
    }
    assert!(changes[119] <= 1e-5, "{}", changes[119]);
    assert!(products / 120.0 <= 20.0, "{}", products / 120.0);
    // The conditions of steady rolling by direct sums: the displacements one element ahead are those by the same tractions.
    let (mut here, mut there) = (vec![[0.0; 2]; grid.len()], vec![[0.0; 2]; grid.len()]);
    let tangential = tangential(&grid, nu);
    dense::apply(&tangential, &grid, (0.0, 0.0), &last.traction, &mut here);
    dense::apply(&tangential, &grid, (1.0, 0.0), &last.traction, &mut there);
    let (mut slip_residual, mut all) = (0.0, 0.0);
    for i in (0..grid.len()).filter(|&i| g[i] > 0.0) {
        let w = step.rigid_slip_at(&grid, i);
        let s = [w[0] + here[i][0] - there[i][0], w[1] + here[i][1] - there[i][1]];
        let q = last.traction[i];
        let power = s[0] * q[0] + s[1] * q[1] + g[i] * s[0].hypot(s[1]);
        (slip_residual, all) = (slip_residual + power, all + g[i] * w[0].hypot(w[1]));
    }
    assert!(slip_residual / all <= 1e-4, "gap {}", slip_residual / all);
}
