//! Solves tangential problems with given pressures, and recomputes the conditions of friction by direct sums.

use contact_normal::friction::{Compliance, Report, Request, Solution, Solver, Tangential, Vector, SLIP, STICK};
use contact_normal::grid::Grid;
use contact_normal::scene::{Coefficient, Friction, Motion, Prescribed};
use contact_normal::solver::Outcome;
use contact_normal::threads::Threads;

use super::dense;

/// The undeformed distance between a ball of radius 50 and a plane, on m x m elements of side d.
pub fn ball(m: usize, d: f64) -> (Grid, Vec<f64>) {
    let centre = 0.5 * (m as f64 - 1.0);
    let h = (0..m * m)
        .map(|i| (((i % m) as f64 - centre).powi(2) + ((i / m) as f64 - centre).powi(2)) * d * d / 100.0)
        .collect();
    (Grid::new(m, m, d, d).unwrap(), h)
}

/// The tangential coefficients for `1/G = 1`.
pub fn tangential(grid: &Grid, nu: f64) -> Tangential {
    Tangential::new(grid.dx, grid.dy, Compliance { shear: 1.0, poisson: nu, unlike: 0.0 })
}

/// A solver for `1/G = 1`.
pub fn solver(grid: &Grid, nu: f64) -> Solver {
    Solver::new(*grid, tangential(grid, nu), true, &Threads::One)
}

/// Solves, and asserts that the result has converged to the tolerance.
pub fn run(solver: &mut Solver, g: &[f64], friction: &Friction<'_>, tolerance: f64) -> (Report, Solution) {
    let request = Request::new(g, friction, tolerance);
    let (end, report) = solver.solve(&request, &mut |_, _| true).unwrap();
    assert_eq!(end, Outcome::Converged, "{friction:?} {report:?}");
    assert!(report.certificate.residual <= tolerance, "{friction:?} {report:?}");
    (report, solver.solution().unwrap().clone())
}

fn length(v: Vector) -> f64 {
    v[0].hypot(v[1])
}

fn rms(values: impl Iterator<Item = f64>, count: usize) -> f64 {
    (values.map(|v| v * v).sum::<f64>() / count as f64).sqrt()
}

/// Adds the displacements of an elastic layer at places `by` elements from each centre. The tractions are interpolated between the centres.
fn add_layer(grid: &Grid, friction: &Friction<'_>, by: (f64, f64), q: &[Vector], u: &mut [Vector]) {
    for (i, u) in u.iter_mut().enumerate() {
        let (x, y) = ((i % grid.mx) as f64 + by.0, (i / grid.mx) as f64 + by.1);
        for (j, q) in q.iter().enumerate() {
            let hat = |distance: f64| (1.0 - distance.abs()).max(0.0);
            let weight = hat(x - (j % grid.mx) as f64) * hat(y - (j / grid.mx) as f64);
            if weight > 0.0 {
                (0..2).for_each(|k| u[k] += weight * friction.compliance.at(j) * q[k]);
            }
        }
    }
}

/// Recomputes the conditions of friction by direct sums. Asserts that `|q| <= mu p` to the last bit, and that the reported gap is right. Returns the
/// residual of the slip, relative as in the library. `before`: the previous tractions.
pub fn residual(
    (grid, nu): (&Grid, f64),
    g: &[f64],
    friction: &Friction<'_>,
    before: &[Vector],
    found: (&Report, &Solution),
) -> f64 {
    let tangential = tangential(grid, nu);
    let sums = |by: (f64, f64), q: &[Vector], u: &mut [Vector]| dense::apply(&tangential, grid, by, q, u);
    residual_by(sums, grid, g, friction, before, found)
}

/// [`residual`] with direct sums `sums(by, q, u)` of other coefficients, at places `by` elements from each centre.
pub fn residual_by(
    sums: impl Fn((f64, f64), &[Vector], &mut [Vector]),
    grid: &Grid,
    g: &[f64],
    friction: &Friction<'_>,
    before: &[Vector],
    (report, solution): (&Report, &Solution),
) -> f64 {
    let (n, q) = (grid.len(), &solution.traction);
    let (mut u, mut u_before) = (vec![[0.0; 2]; n], vec![[0.0; 2]; n]);
    sums((0.0, 0.0), q, &mut u);
    let distance = friction.distance(grid);
    let (sine, cosine) = friction.rolling_direction.sin_cos();
    let by = match friction.motion {
        Motion::Shift => (0.0, 0.0),
        _ => (distance * cosine / grid.dx, distance * sine / grid.dy),
    };
    let is_steady = friction.motion == Motion::SteadyRolling;
    let before = if is_steady { q } else { before };
    sums(by, before, &mut u_before);
    add_layer(grid, friction, (0.0, 0.0), q, &mut u);
    add_layer(grid, friction, by, before, &mut u_before);
    let (mut residuals, mut rigid, mut displaced, mut count) = (Vec::new(), Vec::new(), Vec::new(), 0);
    let (mut gap, mut work, mut rounding) = (0.0, 0.0, 0.0);
    for i in 0..n {
        let Coefficient::Uniform(mu) = friction.coefficient else { panic!("one coefficient") };
        let bound = mu * g[i];
        assert!(length(q[i]) <= bound, "element {i}: {:?} {bound}", q[i]);
        if !(bound > 0.0) {
            assert_eq!(q[i], [0.0; 2]);
            continue;
        }
        count += 1;
        let mut w = friction.rigid_slip_at(grid, i);
        // For a given force the creepage is unknown beforehand, and taken from the report.
        let weight = friction.weight_at(i);
        for (k, w) in w.iter_mut().enumerate() {
            if let Prescribed::Force(_) = friction.prescribed[k] {
                *w += distance * weight[k] * report.creepage[k];
            }
        }
        let s = [w[0] + u[i][0] - u_before[i][0], w[1] + u[i][1] - u_before[i][1]];
        let slips = length(q[i]) >= bound * (1.0 - 1e-7);
        assert_eq!(solution.stick_slip[i], if slips { SLIP } else { STICK });
        let mut rest = s;
        if slips {
            let outward = [q[i][0] / length(q[i]), q[i][1] / length(q[i])];
            let along = (s[0] * outward[0] + s[1] * outward[1]).min(0.0);
            rest = [s[0] - along * outward[0], s[1] - along * outward[1]];
        }
        gap += s[0] * q[i][0] + s[1] * q[i][1] + bound * length(s);
        work += bound * length(w);
        // The sums of the test and the library's products differ by the round-off of coefficients, transforms and sums, 1e-12 of their terms.
        rounding += 1e-12 * bound * (length(w) + length(u[i]) + length(u_before[i]));
        residuals.push(length(rest));
        rigid.push(length(w));
        displaced.push(length(if is_steady { [u[i][0] - u_before[i][0], u[i][1] - u_before[i][1]] } else { u[i] }));
    }
    let reported = report.certificate.gap * work;
    assert!(
        (reported - gap).abs() <= 1e-9 * gap + rounding,
        "gap {gap:e}, reported {reported:e}, rounding {rounding:e}"
    );
    let forces = friction.prescribed.iter().any(|prescribed| matches!(prescribed, Prescribed::Force(_)));
    let scale = match friction.motion {
        Motion::SteadyRolling if !forces => rms(rigid.into_iter(), count),
        Motion::Shift | Motion::SteadyRolling => rms(rigid.into_iter(), count).max(rms(displaced.into_iter(), count)),
        _ => rms(rigid.into_iter(), count),
    };
    rms(residuals.into_iter(), count) / scale
}
