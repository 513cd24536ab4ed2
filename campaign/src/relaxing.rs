//! Viscoelastic bodies: solves a random path of loads on one handle, with random relaxation branches of the bodies, and checks each step.
//!
//! A body consists of springs and dashpots. Its displacement u follows from the instantaneous displacement w and one variable q_k for each branch:
//! `u = w + sum of r_k q_k`, `t_k dq_k/dt = u - q_k`, `r_k = G_k/G`. Here G_k is the modulus of a branch, t_k its time, and G the instantaneous
//! modulus. In a step the new q is linear in the old q, in the old w and in the new w. So displacements are `u = s A p + H`, where s is a number and
//! H the history of the earlier steps. Each step is thus an elastic scene with the distances h + H and s times the compliance, for which the rules of
//! every scene hold (`rules`).

use contact_normal::ffi::*;

use crate::call::{self, Outputs};
use crate::case::{self, Case};
use crate::coating::{Coating, Layer};
use crate::effects::{self, Definiteness, Effects};
use crate::grid::Load;
use crate::half_space::compliance;
use crate::init::initialised;
use crate::random::Random;
use crate::rules;
use crate::scales::Scales;
use crate::verdict::Verdict;

/// The error of the history of a step, relative to its largest value, in the library and here together. The times of branches may differ by a factor
/// of a thousand.
const ACCURACY: f64 = 1e-11;
/// The largest factor of earlier products, and of their round-off, in the history. The final compliance is up to twenty times the instantaneous one.
const GROWTH: f64 = 32.0;
/// The largest number of branches of a body.
const MOST_BRANCHES: usize = 3;
/// The number of terms of the exponential series, for matrices of norm 1/2.
const TERMS: u32 = 18;

/// A viscoelastic body.
#[derive(Clone)]
struct Body {
    /// The share of the body in the instantaneous compliance of both bodies.
    share: f64,
    /// The moduli G_k of the branches.
    modulus: Vec<f64>,
    /// The moduli of the branches relative to the instantaneous one, r_k.
    r: Vec<f64>,
    /// The times t_k of the branches.
    time: Vec<f64>,
    /// q after the last step, `[element][branch]`.
    q: Vec<Vec<f64>>,
    /// w after the last step, of each element.
    w: Vec<f64>,
}

/// The step of one element: the new q is `by_q` times the old q, plus `by_before` times the old w, plus `by_after` times the new w.
struct Map {
    by_q: Vec<Vec<f64>>,
    by_before: Vec<f64>,
    by_after: Vec<f64>,
}

/// The scalar product.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Body {
    /// A random body with this share and modulus at rest; `unit` is the unit of time.
    fn random(random: &mut Random, (share, g): (f64, f64), unit: f64, n: usize) -> Body {
        let count = if g.is_finite() && share > 0.0 { random.integer(0, MOST_BRANCHES) } else { 0 };
        // A body of one branch may be a fluid, whose final modulus is 0. The others have a final modulus.
        let total = if count == 1 && random.chance(0.3) { 1.0 } else { random.between(0.05, 0.95) };
        let parts: Vec<f64> = (0..count).map(|_| random.between(0.1, 1.0)).collect();
        let sum: f64 = parts.iter().sum();
        let r: Vec<f64> = parts.iter().map(|part| total * (part / sum)).collect();
        let modulus = r.iter().map(|r| r * g).collect();
        let time = (0..count).map(|_| unit * random.decades(0.03, 30.0)).collect();
        Body { share, modulus, r, time, q: vec![vec![0.0; count]; n], w: vec![0.0; n] }
    }

    /// q of one element after a step with the integration formula `form`. w changes from `before` to `after`.
    fn after(&self, form: i32, dt: f64, q: &[f64], (before, after): (f64, f64)) -> Vec<f64> {
        let n = q.len();
        let steps: Vec<f64> = self.time.iter().map(|t| dt / t).collect();
        let fades = |k: usize| (-steps[k]).exp();
        match form {
            CONTACT_NORMAL_FORM_RELAXATION => {
                let u = before + dot(&self.r, q);
                let mean = |k: usize| -(-steps[k]).exp_m1() / steps[k];
                let left: Vec<f64> = (0..n).map(|k| fades(k) * q[k] + (mean(k) - fades(k)) * u).collect();
                let of_end: Vec<f64> = (0..n).map(|k| 1.0 - mean(k)).collect();
                let end = (after + dot(&self.r, &left)) / (1.0 - dot(&self.r, &of_end));
                (0..n).map(|k| left[k] + of_end[k] * end).collect()
            }
            CONTACT_NORMAL_FORM_BACKWARD_EULER => {
                let part: Vec<f64> = steps.iter().map(|step| step / (1.0 + step)).collect();
                let left: Vec<f64> = (0..n).map(|k| (1.0 - part[k]) * q[k]).collect();
                let end = (after + dot(&self.r, &left)) / (1.0 - dot(&self.r, &part));
                (0..n).map(|k| left[k] + part[k] * end).collect()
            }
            // CREEP: the rates of q, w and the change of w in the step are linear.
            _ => {
                let mut state: Vec<f64> = q.iter().copied().chain([before, after - before]).collect();
                let mut rates = vec![vec![0.0; n + 2]; n + 2];
                for k in 0..n {
                    (0..n).for_each(|j| rates[k][j] = steps[k] * (self.r[j] - f64::from(u8::from(j == k))));
                    rates[k][n] = steps[k];
                }
                rates[n][n + 1] = 1.0;
                // The step is divided into parts, whose number is a power of two, so that the exponential series of each part converges fast.
                let norm = rates.iter().map(|row| row.iter().map(|value| value.abs()).sum()).fold(0.5, f64::max);
                let parts = 2f64.powi((2.0 * norm).log2().ceil() as i32);
                for _ in 0..parts as u64 {
                    let mut term = state.clone();
                    for k in 1..=TERMS {
                        term = rates.iter().map(|row| dot(row, &term) / parts / f64::from(k)).collect();
                        state.iter_mut().zip(&term).for_each(|(state, term)| *state += term);
                    }
                }
                state[..n].to_vec()
            }
        }
    }

    /// The step of an element as a linear map.
    fn map(&self, form: i32, dt: f64) -> Map {
        let n = self.r.len();
        let unit = |j: usize| (0..n).map(|k| f64::from(u8::from(k == j))).collect::<Vec<f64>>();
        if dt == 0.0 {
            return Map { by_q: (0..n).map(unit).collect(), by_before: vec![0.0; n], by_after: vec![0.0; n] };
        }
        let columns: Vec<Vec<f64>> = (0..n).map(|j| self.after(form, dt, &unit(j), (0.0, 0.0))).collect();
        let by_q = (0..n).map(|k| columns.iter().map(|column| column[k]).collect()).collect();
        let none = vec![0.0; n];
        Map {
            by_q,
            by_before: self.after(form, dt, &none, (1.0, 0.0)),
            by_after: self.after(form, dt, &none, (0.0, 1.0)),
        }
    }

    /// The number s of this body for the next step, and its part of the history H.
    fn compliance_and_history(&self, map: &Map) -> (f64, Vec<f64>) {
        let of_element = |q: &[f64], w: f64| {
            (0..q.len()).map(|k| self.r[k] * (dot(&map.by_q[k], q) + map.by_before[k] * w)).sum::<f64>()
        };
        (1.0 + dot(&self.r, &map.by_after), self.q.iter().zip(&self.w).map(|(q, w)| of_element(q, *w)).collect())
    }

    /// Ends a step: computes the new q and w of all elements from the products A p.
    fn end_step(&mut self, map: &Map, products: &[f64]) {
        for ((q, w), product) in self.q.iter_mut().zip(&mut self.w).zip(products) {
            let end = self.share * product;
            *q = (0..q.len()).map(|k| dot(&map.by_q[k], q) + map.by_before[k] * *w + map.by_after[k] * end).collect();
            *w = end;
        }
    }
}

/// The result of a case: the status of each step, and the verdict.
pub struct Run {
    pub case: Case,
    pub statuses: Vec<i32>,
    pub verdict: Verdict,
}

/// Removes the effects and options that the library does not solve with viscoelastic bodies in general: layers, coatings, and the caller's
/// coefficients. [`take_coefficients`] adds coatings or coefficients to scenes in which they are allowed.
fn suited(mut case: Case) -> Case {
    let effects = &mut case.effects;
    (effects.layer, effects.influence, effects.row_tables, effects.coating) = (None, None, None, None);
    effects.definiteness = Definiteness::PositiveDefinite;
    let how = &mut case.how;
    (how.cancel_at, how.fixed, how.given) = (None, None, None);
    (how.criterion, how.max_cycles) = (CONTACT_NORMAL_CRITERION_RESIDUAL, 1000);
    case
}

/// Sometimes gives the scene layers on rigid bodies, or the caller's coefficients. They are allowed if one body is rigid, or if both bodies are
/// equal, because all displacements then relax alike. Returns the shear moduli and Poisson ratios at the surfaces.
fn take_coefficients(case: &mut Case, random: &mut Random) -> Option<([f64; 2], [f64; 2])> {
    let g = case.shear_modulus.into_iter().find(|g| g.is_finite()).filter(|_| random.chance(0.35))?;
    let (is_alone, nu, grid) = (random.chance(0.5), random.between(0.0, 0.5), case.grid);
    let modulus = [g, if is_alone { f64::INFINITY } else { g }];
    (case.shear_modulus, case.poisson_ratio) = (modulus, [nu; 2]);
    (case.effects.period, case.effects.patches) = (None, None);
    let c = compliance(case.shear_modulus, case.poisson_ratio);
    match random.integer(0, 2) {
        0 => {
            let thickness = grid.dx.max(grid.dy) * random.decades(0.5, 50.0);
            let layer = Layer { thickness, shear_modulus: g, poisson_ratio: nu };
            let layers = [Some(layer), (!is_alone).then_some(layer)];
            case.shear_modulus = [f64::INFINITY; 2];
            case.effects.coating = Some(Coating { layers, shear_modulus: case.shear_modulus, poisson_ratio: [nu; 2] });
        }
        1 => case.effects.influence = Some(effects::table(random, &grid, c, Definiteness::PositiveDefinite)),
        _ => case.effects.row_tables = Some(effects::row_tables(random, &grid, c, Definiteness::PositiveDefinite)),
    }
    case.load = case::load(random, &Scales::of(&case.h, &case.effects, &grid, c), &grid);
    Some((modulus, [nu; 2]))
}

/// Solves a path of two to six steps, and checks each.
pub fn run(seed: u64) -> Run {
    let random = &mut Random::new(seed ^ 0x5109_c0de);
    let mut case = suited(Case::new(seed));
    let alike = take_coefficients(&mut case, &mut random.beside(0xa11c));
    let (modulus, ratio) = alike.unwrap_or((case.shear_modulus, case.poisson_ratio));
    let scales = Scales::of(&case.h, &case.effects, &case.grid, compliance(modulus, ratio));
    let unit = random.decades(1e-6, 1e6);
    let compliance_of = |b: usize| (1.0 - ratio[b]) / modulus[b];
    let share = |b: usize| compliance_of(b) / (compliance_of(0) + compliance_of(1));
    let mut bodies = [0, 1].map(|b: usize| Body::random(random, (share(b), modulus[b]), unit, case.grid.len()));
    if alike.is_some() && modulus[1].is_finite() {
        bodies[1] = bodies[0].clone();
    }
    let mut visco = initialised(contact_normal_visco_init);
    for (b, body) in bodies.iter().enumerate() {
        visco.branches[b] = body.r.len() as i32;
        (visco.modulus[b], visco.time[b]) = (body.modulus.as_ptr(), body.time.as_ptr());
    }
    let (mut statuses, mut verdict, mut handle, mut rounding) = (Vec::new(), Verdict::default(), None, 0.0);
    for step in 0..random.integer(2, 6) {
        if step > 0 {
            case.load = case::load(random, &scales, &case.grid);
        }
        visco.time_step = if random.chance(0.15) { 0.0 } else { unit * random.decades(0.01, 10.0) };
        (visco.form, visco.continues) = (random.integer(0, 3) as i32, i32::from(step > 0));
        let form = match (visco.form, case.load) {
            (CONTACT_NORMAL_FORM_AUTO, Load::Approach(_)) => CONTACT_NORMAL_FORM_RELAXATION,
            (CONTACT_NORMAL_FORM_AUTO, Load::Force(_)) => CONTACT_NORMAL_FORM_CREEP,
            (form, _) => form,
        };
        let maps = bodies.each_ref().map(|body| body.map(form, visco.time_step));
        let [(s1, history1), (s2, history2)] = [0, 1].map(|b: usize| bodies[b].compliance_and_history(&maps[b]));
        let history: Vec<f64> = history1.iter().zip(&history2).map(|(a, b)| a + b).collect();
        let found = call::step(&mut handle, &case, &visco);
        statuses.push(found.status);
        let s = bodies[0].share * s1 + bodies[1].share * s2;
        let details = format!("step {step} of {:e}, form {form}, s {s}: {}: ", visco.time_step, case.describe());
        verdict.add(check(&case, (s, &history, rounding), &found).within(&details));
        if found.status < 0 || !verdict.failures.is_empty() {
            break;
        }
        let operator = case.operator();
        let products = operator.displace(&found.p);
        rounding += GROWTH * operator.rounding(&found.p);
        bodies.iter_mut().zip(&maps).for_each(|(body, map)| body.end_step(map, &products));
    }
    Run { case, statuses, verdict }
}

/// Checks a step by the rules of its elastic scene, with s, H and the round-off of H.
fn check(case: &Case, (s, history, rounding): (f64, &[f64], f64), found: &Outputs) -> Verdict {
    let mut elastic = case.clone();
    elastic.shear_modulus = case.shear_modulus.map(|g| g / s);
    let Effects { coating, influence, row_tables, .. } = &mut elastic.effects;
    let layers = coating.iter_mut().flat_map(|coating| coating.layers.iter_mut().flatten());
    layers.for_each(|layer| layer.shear_modulus /= s);
    let coefficients = influence.iter_mut().chain(row_tables).flat_map(|table| table.values.iter_mut());
    coefficients.for_each(|value| *value *= s);
    elastic.h.iter_mut().zip(history).for_each(|(h, history)| *h += history);
    let largest = history.iter().fold(0.0, |most: f64, history| most.max(history.abs()));
    elastic.h_rounding = ACCURACY * largest + rounding;
    let u = found.u.iter().zip(history).map(|(u, history)| u - history).collect();
    let Outputs { status, message, p, e, contact, report, overrun, written, .. } = found;
    let (message, p, e, contact) = (message.clone(), p.clone(), e.clone(), contact.clone());
    let (status, report, overrun, written) = (*status, *report, *overrun, *written);
    rules::check(&elastic, &Outputs { status, message, p, u, e, contact, report, overrun, written })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares steps with constant displacements and with constant pressures with closed forms, for one branch and for two branches that equal one.
    /// Also checks a step of no duration, in which pressures jump.
    #[test]
    fn one_branch_relaxes_and_creeps_by_exponentials() {
        let body = |r: &[f64], time: &[f64]| Body {
            share: 1.0,
            modulus: r.to_vec(),
            r: r.to_vec(),
            time: time.to_vec(),
            q: vec![vec![0.0; r.len()]],
            w: vec![0.0],
        };
        let (r, t, dt): (f64, f64, f64) = (0.7, 3.0, 2.0);
        for parts in [vec![r], vec![0.3 * r, 0.7 * r]] {
            let times = vec![t; parts.len()];
            // If q = 0 and u stays 1, w decreases from 1 to 1 - r (1 - exp(-dt/t)).
            let fade = 1.0 - (-dt / t).exp();
            let held = body(&parts, &times).after(
                CONTACT_NORMAL_FORM_RELAXATION,
                dt,
                &vec![0.0; parts.len()],
                (1.0, 1.0 - r * fade),
            );
            assert!(held.iter().all(|q| (q - fade).abs() <= 1e-14), "{held:?}");
            let crept = body(&parts, &times).after(CONTACT_NORMAL_FORM_CREEP, dt, &vec![0.0; parts.len()], (1.0, 1.0));
            let expected = (1.0 - (-(1.0 - r) * dt / t).exp()) / (1.0 - r);
            assert!(crept.iter().all(|q| (q - expected).abs() <= 1e-13), "{crept:?} {expected}");
            let mut one = body(&parts, &times);
            let (s, history) = one.compliance_and_history(&one.map(CONTACT_NORMAL_FORM_CREEP, 0.0));
            assert!(s == 1.0 && history == [0.0]);
            let jump = one.map(CONTACT_NORMAL_FORM_CREEP, 0.0);
            one.end_step(&jump, &[1.0]);
            let (s, history) = one.compliance_and_history(&one.map(CONTACT_NORMAL_FORM_CREEP, dt));
            // With constant pressures, s + H is the displacement by creep.
            assert!((s + history[0] - (1.0 + r * expected)).abs() <= 1e-13, "{s} {history:?}");
        }
        let stiff = body(&[0.5, 0.4], &[1e-3, 1e3]).after(CONTACT_NORMAL_FORM_CREEP, 1.0, &[0.0, 0.0], (1.0, 1.0));
        // The fast branch follows the displacement, so its q is u. The slow branch adds little to u = w/(1 - 0.5) = 2.
        assert!((stiff[0] / 2.0 - 1.0).abs() < 2e-3, "{stiff:?}");
    }
}
