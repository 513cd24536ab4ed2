//! The fields of the iteration on one block of elements of C.

/// The number of fields of one component.
pub const FIELDS: usize = 23;

/// The x and y components of a field.
type Both<'a> = [&'a mut [f64]; 2];

/// The fields of one block, stored consecutively.
pub struct Fields<'a> {
    /// The traction bound g.
    pub bound: &'a mut [f64],
    /// The compliance of a layer between the bodies, less its least one.
    pub excess: &'a mut [f64],
    /// D on slip: the direction of the slip follows the traction around the circle as by a layer of compliance D (see
    /// [`tangent`](super::super::tangent)).
    pub curvature: &'a mut [f64],
    /// The slip w without the displacement u.
    pub slip: Both<'a>,
    pub q: Both<'a>,
    pub u: Both<'a>,
    /// The normal n of the circle on slip; 0 on stick.
    pub normal: Both<'a>,
    /// The projected residual `P(-s)`.
    pub projected: Both<'a>,
    /// The preconditioned residual, the input of a product, or that of the preconditioner.
    pub z: Both<'a>,
    /// The search direction t.
    pub direction: Both<'a>,
    /// The chord of t at the forecast length f.
    pub chord: Both<'a>,
    /// The product of A with the chord plus the deferred corrections over f.
    pub product: Both<'a>,
    /// The deferred corrections: the changes of q of which u does not contain the displacement.
    pub deferred: Both<'a>,
}

impl<'a> Fields<'a> {
    /// Cuts the values of a block, `[field][element]`, into its fields.
    pub fn of(values: &'a mut [f64]) -> Fields<'a> {
        let length = values.len() / FIELDS;
        let mut rest = values;
        let mut one = || {
            let (field, after) = std::mem::take(&mut rest).split_at_mut(length);
            rest = after;
            field
        };
        let [bound, excess, curvature] = [one(), one(), one()];
        let mut both = || [one(), one()];
        let [slip, q, u, normal, projected] = [both(), both(), both(), both(), both()];
        let [z, direction, chord, product, deferred] = [both(), both(), both(), both(), both()];
        Fields { bound, excess, curvature, slip, q, u, normal, projected, z, direction, chord, product, deferred }
    }
}
