//! Arithmetic with SIMD vectors, written as formulas. Each lane has the bits of the scalar formula, because no multiplication and addition are fused.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

use pulp::Simd;

/// One value in each lane of a SIMD vector.
#[derive(Clone, Copy)]
pub struct Lanes<S: Simd> {
    simd: S,
    values: S::f64s,
}

/// A condition in each lane of a SIMD vector.
#[derive(Clone, Copy)]
pub struct Holds<S: Simd> {
    simd: S,
    mask: S::m64s,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    pub fn new(simd: S, values: S::f64s) -> Lanes<S> {
        Lanes { simd, values }
    }

    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Lanes<S> {
        Lanes { simd, values: simd.splat_f64s(value) }
    }

    /// A vector with `value` in all lanes; only the kind of vector is taken from `self`.
    #[inline(always)]
    pub fn all(self, value: f64) -> Lanes<S> {
        Lanes::splat(self.simd, value)
    }

    /// A vector with `value(lane)` in each lane; only the kind of vector is taken from `self`.
    #[inline(always)]
    pub fn of_each(self, value: impl Fn(usize) -> f64) -> Lanes<S> {
        let mut vector = self;
        let values = pulp::bytemuck::cast_slice_mut::<S::f64s, f64>(std::slice::from_mut(&mut vector.values));
        values.iter_mut().enumerate().for_each(|(lane, to)| *to = value(lane));
        vector
    }

    /// The vector as the type of the machine.
    #[inline(always)]
    pub fn values(self) -> S::f64s {
        self.values
    }

    #[inline(always)]
    pub fn abs(self) -> Lanes<S> {
        Lanes { values: self.simd.abs_f64s(self.values), ..self }
    }

    #[inline(always)]
    pub fn sqrt(self) -> Lanes<S> {
        Lanes { values: self.simd.sqrt_f64s(self.values), ..self }
    }

    #[inline(always)]
    pub fn max(self, other: Lanes<S>) -> Lanes<S> {
        Lanes { values: self.simd.max_f64s(self.values, other.values), ..self }
    }

    #[inline(always)]
    pub fn is_below(self, other: Lanes<S>) -> Holds<S> {
        Holds { simd: self.simd, mask: self.simd.less_than_f64s(self.values, other.values) }
    }

    #[inline(always)]
    pub fn is_at_most(self, other: Lanes<S>) -> Holds<S> {
        Holds { simd: self.simd, mask: self.simd.less_than_or_equal_f64s(self.values, other.values) }
    }
}

impl<S: Simd> Holds<S> {
    /// A condition that holds in lanes with a 1, and not in lanes with a 0.
    #[inline(always)]
    pub fn of_ones(simd: S, ones: S::u64s) -> Holds<S> {
        Holds { simd, mask: simd.greater_than_u64s(ones, simd.splat_u64s(0)) }
    }

    /// A condition that holds in lanes with a 0, and not in lanes with a 1.
    #[inline(always)]
    pub fn of_zeros(simd: S, ones: S::u64s) -> Holds<S> {
        Holds { simd, mask: simd.greater_than_u64s(simd.splat_u64s(1), ones) }
    }

    /// Takes `yes` in lanes where the condition holds, and `no` in the others.
    #[inline(always)]
    pub fn choose(self, yes: Lanes<S>, no: Lanes<S>) -> Lanes<S> {
        Lanes { values: self.simd.select_f64s(self.mask, yes.values, no.values), ..yes }
    }

    /// Whether the condition holds in any lane.
    #[inline(always)]
    pub fn anywhere(self) -> bool {
        self.simd.first_true_m64s(self.mask) < size_of::<S::f64s>() / size_of::<f64>()
    }
}

/// Implements an operator between two vectors, and between a vector and a number.
macro_rules! operation {
    ($name:ident, $method:ident, $of_machine:ident) => {
        impl<S: Simd> $name for Lanes<S> {
            type Output = Lanes<S>;

            #[inline(always)]
            fn $method(self, other: Lanes<S>) -> Lanes<S> {
                Lanes { values: self.simd.$of_machine(self.values, other.values), ..self }
            }
        }

        impl<S: Simd> $name<Lanes<S>> for f64 {
            type Output = Lanes<S>;

            #[inline(always)]
            fn $method(self, other: Lanes<S>) -> Lanes<S> {
                Lanes::splat(other.simd, self).$method(other)
            }
        }

        impl<S: Simd> $name<f64> for Lanes<S> {
            type Output = Lanes<S>;

            #[inline(always)]
            fn $method(self, other: f64) -> Lanes<S> {
                self.$method(Lanes::splat(self.simd, other))
            }
        }
    };
}
operation!(Add, add, add_f64s);
operation!(Sub, sub, sub_f64s);
operation!(Mul, mul, mul_f64s);
operation!(Div, div, div_f64s);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Lanes<S>;

    #[inline(always)]
    fn neg(self) -> Lanes<S> {
        Lanes { values: self.simd.neg_f64s(self.values), ..self }
    }
}

/// Implements an operator between two conditions.
macro_rules! logic {
    ($name:ident, $method:ident, $of_machine:ident) => {
        impl<S: Simd> $name for Holds<S> {
            type Output = Holds<S>;

            #[inline(always)]
            fn $method(self, other: Holds<S>) -> Holds<S> {
                Holds { mask: self.simd.$of_machine(self.mask, other.mask), ..self }
            }
        }
    };
}
logic!(BitAnd, bitand, and_m64s);
logic!(BitOr, bitor, or_m64s);
