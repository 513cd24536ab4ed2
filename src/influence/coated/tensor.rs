//! The two radial functions I and Q of the displacements by a traction, tabulated on the panels of [`Radial`] in `w = 4 + rho^2`.
//!
//! Let F and g be the radial functions of the responses L and T (`tractions.rs`). At the position (x, y) relative to the traction the kernel is
//!
//! ```text
//! xx = I + Q x^2,   yy = I + Q y^2,   xy = Q x y
//! I = (1 - nu1) g(L) + F(T) - g(T),   Q = ((1 - nu1) (F - 2 g)(L) - (F - 2 g)(T))/rho^2
//! ```
//!
//! Up to rho = 2 the panels hold I and Q with the layer as base, beyond with the substrate, as in [`Radial`]. With the other base, I has an
//! additional multiple of `1/rho`, and Q one of `1/rho^3`.

use super::base::Base;
use super::polynomial::{chebyshev, evaluate, node, powers};
use super::radial::{ends_of, panel_of, Radial, P};
use super::response::Response;
use super::shear::{Across, Along};

/// The functions I and Q of one layer of unit thickness.
#[derive(Debug)]
pub struct Tensor {
    /// The radial functions of the response L along the wave vector.
    pub along: Radial<Along>,
    /// The radial functions of the response T across the wave vector.
    pub across: Radial<Across>,
    /// `1 - nu1`.
    pub one_minus_nu: f64,
    /// The polynomials of I and Q on each panel.
    panels: Vec<[[f64; P]; 2]>,
}

impl Tensor {
    /// The functions of a layer whose shear modulus is `mu` times the substrate's, with the Poisson ratios of layer and substrate.
    pub fn new(mu: f64, nu: [f64; 2]) -> Tensor {
        let (along, across) = (Radial::new(Along::new(mu, nu)), Radial::new(Across::new(mu)));
        let count = along.panels().min(across.panels());
        let mut tensor = Tensor { along, across, one_minus_nu: 1.0 - nu[0], panels: Vec::new() };
        tensor.panels = (0..count).map(|panel| tensor.panel(panel)).collect();
        tensor
    }

    /// The polynomials of I and Q on a panel.
    fn panel(&self, panel: usize) -> [[f64; P]; 2] {
        let (low, high) = ends_of(panel);
        let values: [[f64; 2]; P] = std::array::from_fn(|i| {
            let rho2 = 0.5 * (low + high) + 0.5 * (high - low) * node(i, P) - 4.0;
            self.values(rho2.max(0.0), Base::at(low))
        });
        [0, 1].map(|k| powers(&chebyshev::<P>(&std::array::from_fn(|i| values[i][k]))))
    }

    /// I and Q at a square of rho, from the radial functions of L and T.
    fn values(&self, rho2: f64, base: Base) -> [f64; 2] {
        let of_along = [self.along.f_at_square(rho2, base), self.along.mean_at_square(rho2, base)];
        let of_across = [self.across.f_at_square(rho2, base), self.across.mean_at_square(rho2, base)];
        let directional = |[f, g]: [f64; 2]| f - 2.0 * g;
        let isotropic = self.one_minus_nu * of_along[1] + of_across[0] - of_across[1];
        [isotropic, (self.one_minus_nu * directional(of_along) - directional(of_across)) / rho2]
    }

    /// I and Q at the distance whose square is `rho2`, from the panels. `rho2` must be positive if the substrate is the base.
    pub fn at_square(&self, rho2: f64, base: Base) -> [f64; 2] {
        let w = 4.0 + rho2;
        let (panel, (low, high)) = panel_of(w);
        let Some([isotropic, directional]) = self.panels.get(panel) else { return self.values(rho2, base) };
        let x = (w - 0.5 * (low + high)) * (2.0 / (high - low));
        let value = [evaluate(isotropic, x), evaluate(directional, x)];
        let sign = Base::at(w).to(base);
        if sign == 0.0 {
            return value;
        }
        let (along, across) = (1.0 - self.along.transfer.substrate(), 1.0 - self.across.transfer.substrate());
        let more = sign / rho2.sqrt();
        [value[0] + more * self.one_minus_nu * along, value[1] + more * (across - self.one_minus_nu * along) / rho2]
    }
}
