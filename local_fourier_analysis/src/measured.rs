//! Convergence factors of actual cycles on a given contact area, from a random error.

use contact_normal::contact::Problem;
use contact_normal::grid::Grid;
use contact_normal::influence::Coefficients;
use contact_normal::methods::multigrid::{CycleShape, Multigrid};
use contact_normal::threads::Threads;

/// A random number, uniform between -1/2 and 1/2.
pub fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
}

/// The mean reduction of the residual per cycle over the last `of` of `cycles` cycles on A p = 0. By then the slowest parts of the error dominate.
pub fn factor(
    grid: &Grid,
    influence: &Coefficients,
    contact: &[bool],
    shape: CycleShape,
    (cycles, of): (usize, usize),
) -> f64 {
    let mut multigrid =
        Multigrid::new(&mut Problem::new(*grid, influence.clone(), &Threads::One).expect("memory"), shape)
            .expect("a valid grid");
    let mut seed = 1;
    let mut p: Vec<f64> = contact.iter().map(|&inside| if inside { random(&mut seed) } else { 0.0 }).collect();
    let mut residual = vec![0.0; p.len()];
    let mut reductions = Vec::new();
    let mut before = f64::NAN;
    for _ in 0..=cycles {
        multigrid.displace(0, &p, &mut residual);
        residual.iter_mut().zip(contact).for_each(|(r, &inside)| *r = if inside { -*r } else { 0.0 });
        let norm = residual.iter().map(|r| r * r).sum::<f64>().sqrt();
        reductions.push(norm / before);
        // The norm is 1 again: cycles are homogeneous.
        p.iter_mut().chain(&mut residual).for_each(|value| *value /= norm);
        before = 1.0;
        let correction = multigrid.cycle(0, &residual, contact);
        p.iter_mut().zip(correction).for_each(|(p, v)| *p += v);
    }
    let last = &reductions[reductions.len() - of..];
    (last.iter().map(|factor| factor.ln()).sum::<f64>() / of as f64).exp()
}
