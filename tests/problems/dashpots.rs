//! Viscoelastic bodies, integrated in small steps from the equations of their springs and dashpots. This reference certifies the steps of a path of
//! loads.

use contact_normal::scene::Visco;
use contact_normal::scene::{Branches, Load, Scene};
use contact_normal::solver::{InitialGuess, Options, Outcome, Solver};
use contact_normal::visco::Form;

use super::dense;

pub const MX: usize = 18;
pub const MY: usize = 14;
pub const SIDE: f64 = 0.08;

/// A body in terms of its dashpots, `t dq/dt = u - q`, integrated by a Runge-Kutta method in many small steps.
struct Dashpots {
    share: f64,
    r: Vec<f64>,
    t: Vec<f64>,
    /// The displacements of the dashpots, `[element][branch]`.
    q: Vec<Vec<f64>>,
    w: Vec<f64>,
}

const PARTS: usize = 300;

impl Dashpots {
    fn new(share: f64, g: f64, branches: &Branches<'_>) -> Dashpots {
        let r: Vec<f64> = branches.modulus.iter().map(|modulus| modulus / g).collect();
        Dashpots { share, q: vec![vec![0.0; r.len()]; MX * MY], t: branches.time.to_vec(), r, w: vec![0.0; MX * MY] }
    }

    fn u_of(&self, q: &[f64], w: f64) -> f64 {
        w + self.r.iter().zip(q).map(|(r, q)| r * q).sum::<f64>()
    }

    /// The dashpots' displacements q after a step of time dt, if the body's displacement at the part s of the step is `u(s, q)`.
    fn integrate(&self, q: &[f64], dt: f64, u: impl Fn(f64, &[f64]) -> f64) -> Vec<f64> {
        let (mut q, h) = (q.to_vec(), dt / PARTS as f64);
        let slope = |s: f64, q: &[f64]| -> Vec<f64> {
            let u = u(s, q);
            q.iter().zip(&self.t).map(|(q, t)| (u - q) / t).collect()
        };
        let on = |q: &[f64], k: &[f64], h: f64| -> Vec<f64> { q.iter().zip(k).map(|(q, k)| q + h * k).collect() };
        for part in 0..PARTS {
            let s = |more: f64| (part as f64 + more) / PARTS as f64;
            let k1 = slope(s(0.0), &q);
            let k2 = slope(s(0.5), &on(&q, &k1, 0.5 * h));
            let k3 = slope(s(0.5), &on(&q, &k2, 0.5 * h));
            let k4 = slope(s(1.0), &on(&q, &k3, h));
            for (k, q) in q.iter_mut().enumerate() {
                *q += h / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k]);
            }
        }
        q
    }

    /// Makes a step at whose end A p is `product`, and adds the displacement of the body to `displacement`.
    fn step(&mut self, dt: f64, form: Form, product: &[f64], displacement: &mut [f64]) {
        for (i, product) in product.iter().enumerate() {
            let (q, w0, w) = (&self.q[i], self.w[i], self.share * product);
            let after = match form {
                _ if dt == 0.0 => q.clone(),
                Form::Creep => self.integrate(q, dt, |s, q| self.u_of(q, w0 + s * (w - w0))),
                // The new q is linear in the new u = w + r.q.
                Form::Relaxation => {
                    let u0 = self.u_of(q, w0);
                    let with = |u: f64| self.integrate(q, dt, |s, _| u0 + s * (u - u0));
                    let (none, one) = (with(0.0), with(1.0));
                    let (of_none, of_one) = (self.u_of(&none, w), self.u_of(&one, w));
                    let u = of_none / (1.0 - (of_one - of_none));
                    none.iter().zip(&one).map(|(none, one)| none + u * (one - none)).collect()
                }
                Form::BackwardEuler => {
                    let part = |t: f64| dt / (t + dt);
                    let left: f64 = (0..q.len()).map(|k| self.r[k] * (1.0 - part(self.t[k])) * q[k]).sum();
                    let of_u: f64 = (0..q.len()).map(|k| self.r[k] * part(self.t[k])).sum();
                    let u = (w + left) / (1.0 - of_u);
                    (0..q.len()).map(|k| q[k] + part(self.t[k]) * (u - q[k])).collect()
                }
            };
            displacement[i] += self.u_of(&after, w);
            (self.q[i], self.w[i]) = (after, w);
        }
    }
}

/// Asserts the contact conditions at the end of a step, to the tolerance of the solve and that of the integration. Returns the force.
fn assert_step(what: &str, h: &[f64], u: &[f64], solver: &Solver, limit: f64) -> f64 {
    let state = solver.state();
    let (mut residual, mut distance, mut violation, mut deepest) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    for i in 0..h.len() {
        let (p, e) = (state.p[i], h[i] - state.approach + u[i]);
        assert!(p >= 0.0 && p <= limit && (h[i].is_finite() || p == 0.0), "{what}: {p}");
        if p == limit {
            violation = violation.max(e);
        } else if p > 0.0 {
            (residual, distance) = (residual + e * e, distance + (h[i] - state.approach).powi(2));
            deepest = deepest.max((h[i] - state.approach).abs());
        } else {
            violation = violation.max(-e);
        }
        // The reported u equals the integrated one. With 300 parts the error of the integration is 1e-9 for a step of five relaxation times.
        assert!((state.u[i] - u[i]).abs() <= 1e-7 * (1e-3 + u[i].abs()), "{what}: {} for {}", state.u[i], u[i]);
    }
    assert!(residual.sqrt() <= 2e-6 * distance.sqrt(), "{what}: {residual:e} {distance:e}");
    assert!(violation <= 2e-6 * deepest + 1e-9, "{what}: {violation:e} {deepest:e}");
    state.p.iter().sum::<f64>() * SIDE * SIDE
}

/// Solves a path of loads step by step, and checks each step. `shares`: the shares of the bodies in the instantaneous compliance.
pub fn assert_path(what: &str, scene: &Scene<'_>, shares: [f64; 2], path: &[(f64, Load)], options: &Options) {
    let visco = scene.visco.expect("bodies that relax");
    let coated = |b: usize| scene.coating.and_then(|coating| coating.layers[b]).map(|layer| layer.shear_modulus);
    let mut bodies: Vec<Dashpots> = (0..2)
        .filter(|&b| shares[b] > 0.0)
        .map(|b| Dashpots::new(shares[b], coated(b).unwrap_or(scene.bodies.shear_modulus[b]), &visco.bodies[b]))
        .collect();
    let limit = scene.pressure_limit.map_or(f64::INFINITY, |limit| limit.0.at(0));
    let mut solver = Solver::new(scene, options).unwrap();
    let (mut time, mut carried) = (0.0, 0);
    for (k, (dt, load)) in path.iter().enumerate() {
        let visco = Visco { time_step: *dt, continues: k > 0, ..visco };
        let scene = Scene { visco: Some(visco), load: *load, ..scene.clone() };
        let initial_guess = if k % 2 == 1 { InitialGuess::Previous } else { InitialGuess::None };
        let (stop, report) = solver.solve(&scene, &Options { initial_guess, ..*options }, None, None).unwrap();
        let what = format!("{what}, step {k} by {:?}", options.method);
        assert_eq!(stop, Outcome::Converged, "{what}");
        let form = visco.form.unwrap_or(match load {
            Load::Approach(_) => Form::Relaxation,
            Load::Force(_) => Form::Creep,
        });
        let (mut product, mut u) = (vec![0.0; MX * MY], vec![0.0; MX * MY]);
        dense::apply(&scene.coefficients().unwrap(), &scene.grid, &solver.state().p, &mut product);
        bodies.iter_mut().for_each(|body| body.step(*dt, form, &product, &mut u));
        let force = assert_step(&what, scene.undeformed_distance, &u, &solver, limit);
        match load {
            Load::Force(prescribed) => assert!((force / prescribed - 1.0).abs() <= 1e-9, "{what}: {force}"),
            Load::Approach(approach) => {
                assert_eq!(solver.state().approach, *approach, "{what}");
                assert_eq!(report.measures.approach, *approach, "{what}");
            }
        }
        time += dt;
        let found = report.visco.expect("a report of the step");
        assert!((found.time - time).abs() <= 1e-12 && found.compliance >= 1.0, "{what}: {found:?}");
        carried += usize::from(force > 0.0);
    }
    assert!(carried + 3 >= path.len(), "{what}: {carried} steps with contact");
}
