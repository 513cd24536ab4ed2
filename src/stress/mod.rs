//! Stresses below the surface of a half-space, from the pressures and tractions on the elements of its surface.
//!
//! The stress tensor has six components, positive in tension. They are computed below the centres of the elements, at any depth `z >= 0`; the z
//! axis points into the body considered. The pressure p and the tractions `(qx, qy)` that act ON this body are constant on each element:
//!
//! ```text
//! stress_I(z) = sum over J of  K_p(I - J, z) p_J + K_x(I - J, z) qx_J + K_y(I - J, z) qy_J
//! szz = -p,  sxz = -qx,  syz = -qy    at z = 0
//! ```
//!
//! The kernels depend on the Poisson ratio, not on the shear modulus. There are two ways to compute them, which `kernels` combines:
//!
//! * near the loaded element a closed form (`element`);
//! * far from it, where the closed form suffers from cancellation, concentrated forces (`point_force`).
//!
//! At each depth the sums over elements are products by FFT (`product`). Each kernel is even or odd in x and in y, so that its symbol is real or
//! imaginary, and only one quadrant is tabulated. At arbitrary points the sums are computed directly (`points`).
//!
//! If contact patches are coupled by factors, each patch has its own loads and its own products (`loads`).
//!
//! For periodic loads the kernels are sums over waves (`periodic`).
//!
//! Each thread computes one depth at a time. The results of a depth are passed to the caller when they are complete, so that the memory does not
//! grow with the number of depths.

mod body;
mod depth;
mod element;
mod exponential;
mod kernels;
mod loads;
mod of_scene;
mod periodic;
mod point_force;
mod points;
mod product;
mod tensor;
mod waves;

pub use body::{side, Body, COMPONENTS};
pub use depth::{Depth, Maximum, Wanted};
pub use loads::{Loads, Part};
pub use of_scene::of_scene;
pub use periodic::MOST_SLENDER;
pub use points::stress_at_points;
pub use tensor::{principal, von_mises, Principal, Tensor};

use std::time::Instant;

use crate::error::{require, Error, Result};
use crate::progress::{Progress, ProgressCallback};
use crate::threads::Threads;
use depth::DepthMemory;
use periodic::Waves;
use product::Product;

/// Computes the wanted stresses at all `depths`. For each depth, in order, it calls `each(k, depth)` with the stresses at `depths[k]` and then
/// `progress`, for which a depth counts as a cycle. Both are called on the calling thread. Returns true if all depths are done, false if the
/// caller cancelled.
///
/// * `NotFinite`: a load or a depth is not finite.
/// * `InvalidArgument`: an array has another size than the grid, no load is given, a depth is negative, or the Poisson ratio is out of range.
/// * `Unsupported`: a period with patches, or a period with very slender elements and a depth of less than their longer side.
/// * `OutOfMemory`.
pub fn subsurface_stress(
    body: &Body,
    loads: &Loads<'_>,
    depths: &[f64],
    wanted: &Wanted,
    threads: &Threads,
    mut progress: Option<ProgressCallback<'_>>,
    mut each: impl FnMut(usize, &Depth),
) -> Result<bool> {
    let began = Instant::now();
    body.check()?;
    loads.check(&body.grid)?;
    let body = &body.of_square_elements();
    if body.periodic && loads.patches.is_some() {
        return Err(Error::Unsupported(
            "patches and a period are both given; stresses are not computed for both".into(),
        ));
    }
    for (k, &z) in depths.iter().enumerate() {
        require(z >= 0.0 && z.is_finite(), &format!("depths[{k}]"), z, "a depth must be finite and not negative")?;
        if body.periodic {
            Waves::check(body, z)?;
        }
    }
    let near = body.periodic && depths.iter().any(|&z| Waves::is_near(body.in_units(z)));
    let product = Product::new(body, loads, near)?;
    let at_once = threads.count().min(depths.len());
    let mut memory = Vec::new();
    for _ in 0..at_once {
        memory.push(DepthMemory::new(&product, wanted)?);
    }
    let mut done = 0;
    for round in depths.chunks(at_once.max(1)) {
        threads.for_each(&mut memory[..round.len()], |k, memory| memory.compute(&product, wanted, round[k]));
        for memory in &memory[..round.len()] {
            each(done, &memory.depth);
            done += 1;
            if let Some(told) = &mut progress {
                let seconds = began.elapsed().as_secs_f64();
                // After the last depth there is nothing to cancel.
                if told(&Progress::of_part(&body.grid, done as u64, seconds)) && done < depths.len() {
                    return Ok(false);
                }
            }
        }
    }
    Ok(true)
}
