//! The fields of a block of elements of C.

/// The number of fields.
pub const FIELDS: usize = 23;

/// A field of both components.
type Both<'a> = [&'a mut [f64]; 2];

/// The fields of one block, stored consecutively.
pub struct Fields<'a> {
    /// g.
    pub bound: &'a mut [f64],
    /// The compliance of a layer beyond its least one.
    pub excess: &'a mut [f64],
    /// D.
    pub curvature: &'a mut [f64],
    /// w.
    pub slip: Both<'a>,
    pub q: Both<'a>,
    pub u: Both<'a>,
    /// n, 0 on stick.
    pub normal: Both<'a>,
    /// `P(-s)`.
    pub projected: Both<'a>,
    /// The preconditioned residual, or the field to be multiplied.
    pub z: Both<'a>,
    /// t.
    pub direction: Both<'a>,
    /// The chord of t at the length of the forecast.
    pub chord: Both<'a>,
    /// A times the chord and the deferred corrections.
    pub product: Both<'a>,
    /// The deferred corrections.
    pub deferred: Both<'a>,
}

impl<'a> Fields<'a> {
    /// The fields in the values of a block.
    pub fn of(values: &'a mut [f64]) -> Fields<'a> {
        let length = values.len() / FIELDS;
        let mut rest = values;
        let mut one = || {
            let (field, behind) = std::mem::take(&mut rest).split_at_mut(length);
            rest = behind;
            field
        };
        let [bound, excess, curvature] = [one(), one(), one()];
        let mut both = || [one(), one()];
        let [slip, q, u, normal, projected] = [both(), both(), both(), both(), both()];
        let [z, direction, chord, product, deferred] = [both(), both(), both(), both(), both()];
        Fields { bound, excess, curvature, slip, q, u, normal, projected, z, direction, chord, product, deferred }
    }
}
