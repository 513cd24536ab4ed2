//! The two radial functions I and Q of the displacements by a traction, on the panels of [`Radial`] in `w = 4 + rho^2`.
//!
//! With F and g of L and of T (`tractions.rs`) the kernel is, in x and y from the traction,
//!
//! ```text
//! xx = I + Q x^2,   yy = I + Q y^2,   xy = Q x y
//! I = (1 - nu1) g(L) + F(T) - g(T),   Q = ((1 - nu1) (F - 2 g)(L) - (F - 2 g)(T))/rho^2
//! ```
//!
//! Up to rho = 2 the panels hold I and Q with the layer as base, beyond with the substrate, as in [`Radial`]. The other base adds a
//! multiple of `1/rho` to I and of `1/rho^3` to Q.

use super::polynomial::{chebyshev, evaluate, node, powers};
use super::radial::{ends_of, panel_of, Base, Radial, P};
use super::response::Response;
use super::shear::{Across, Along};

/// The functions of one layer of unit thickness.
#[derive(Debug)]
pub struct Tensor {
    pub along: Radial<Along>,
    pub across: Radial<Across>,
    /// `1 - nu1`.
    pub kept: f64,
    /// I and Q on each panel.
    panels: Vec<[[f64; P]; 2]>,
}

impl Tensor {
    /// The functions of a layer of `mu` times the substrate's shear modulus, with both Poisson ratios.
    pub fn new(mu: f64, nu: [f64; 2]) -> Tensor {
        let (along, across) = (Radial::new(Along::new(mu, nu)), Radial::new(Across::new(mu)));
        let count = along.panels().min(across.panels());
        let mut tensor = Tensor { along, across, kept: 1.0 - nu[0], panels: Vec::new() };
        tensor.panels = (0..count).map(|panel| tensor.panel(panel)).collect();
        tensor
    }

    fn panel(&self, panel: usize) -> [[f64; P]; 2] {
        let (low, high) = ends_of(panel);
        let values: [[f64; 2]; P] = std::array::from_fn(|i| {
            let rho2 = 0.5 * (low + high) + 0.5 * (high - low) * node(i, P) - 4.0;
            self.values(rho2.max(0.0), Base::at(low))
        });
        [0, 1].map(|k| powers(&chebyshev::<P>(&std::array::from_fn(|i| values[i][k]))))
    }

    /// I and Q, from the radial functions.
    fn values(&self, rho2: f64, base: Base) -> [f64; 2] {
        let of_along = [self.along.f_at_square(rho2, base), self.along.mean_at_square(rho2, base)];
        let of_across = [self.across.f_at_square(rho2, base), self.across.mean_at_square(rho2, base)];
        let turning = |[f, g]: [f64; 2]| f - 2.0 * g;
        let all = self.kept * of_along[1] + of_across[0] - of_across[1];
        [all, (self.kept * turning(of_along) - turning(of_across)) / rho2]
    }

    /// I and Q at a square of rho, which is positive where the substrate is the base.
    pub fn at_square(&self, rho2: f64, base: Base) -> [f64; 2] {
        let w = 4.0 + rho2;
        let (panel, (low, high)) = panel_of(w);
        let Some([all, turning]) = self.panels.get(panel) else { return self.values(rho2, base) };
        let x = (w - 0.5 * (low + high)) * (2.0 / (high - low));
        let value = [evaluate(all, x), evaluate(turning, x)];
        let sign = Base::at(w).to(base);
        if sign == 0.0 {
            return value;
        }
        let (along, across) = (1.0 - self.along.transfer.substrate(), 1.0 - self.across.transfer.substrate());
        let more = sign / rho2.sqrt();
        [value[0] + more * self.kept * along, value[1] + more * (across - self.kept * along) / rho2]
    }
}
