//! Numbers as a factor near 1 times a power of two, so that products and quotients of them cannot leave the range of double precision. If no result
//! of the plain formula leaves the range, the bits are the same.

/// Splits a number > 0 into a factor near 1 and the exponent of a power of two.
pub(crate) fn apart(value: f64) -> (f64, i32) {
    let power = value.log2().floor() as i32;
    (times_power(value, -power), power)
}

/// Returns `value * 2^power`, also if `2^power` itself is out of range.
pub(crate) fn times_power(value: f64, power: i32) -> f64 {
    PowerOfTwo::new(power).times(value)
}

/// The number `factor * 2^power`, as `Scaled(factor, power)`. It may be out of the range of double precision.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Scaled(pub f64, pub i32);

impl Scaled {
    /// A number in double precision.
    pub(crate) fn of(value: f64) -> Scaled {
        if value == 0.0 {
            return Scaled(0.0, 0);
        }
        let (near_one, power) = apart(value.abs());
        Scaled(near_one.copysign(value), power)
    }

    /// The product.
    pub(crate) fn times(self, other: Scaled) -> Scaled {
        Scaled(self.0 * other.0, self.1 + other.1)
    }

    /// The quotient.
    pub(crate) fn over(self, other: Scaled) -> Scaled {
        Scaled(self.0 / other.0, self.1 - other.1)
    }

    /// f of two numbers. f must be homogeneous of degree 1, as a sum is, or the root of a sum of squares.
    pub(crate) fn with(self, other: Scaled, f: impl Fn(f64, f64) -> f64) -> Scaled {
        let powers = [self, other].into_iter().filter(|Scaled(factor, _)| *factor != 0.0).map(|Scaled(_, power)| power);
        let power = powers.max().unwrap_or(0);
        Scaled(f(self.at(power), other.at(power)), power)
    }

    /// The number divided by `2^power`, in double precision.
    pub(crate) fn at(self, power: i32) -> f64 {
        times_power(self.0, self.1 - power)
    }

    /// The number in double precision; 0 or infinite if it is out of range.
    pub(crate) fn value(self) -> f64 {
        self.at(0)
    }
}

/// Terms such as e^-x are dropped for larger x, because e^-40 = 4e-18 is round-off relative to 1.
pub(crate) const FADED: f64 = 40.0;

/// Upper limit on lengths and tractions, so that sums of their squares are finite.
pub(crate) const LARGEST: f64 = 1e140;

/// A power of two as a product of three powers of two, each of which is in range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PowerOfTwo([f64; 3]);

/// Larger exponents have the same effect as this one: numbers are 2^-1074 to 2^1024, so 2^2200 times any of them is infinite, and 2^-2200 times any
/// of them is 0.
const MOST: i32 = 2200;

impl PowerOfTwo {
    /// The power of two with this exponent.
    pub(crate) fn new(power: i32) -> PowerOfTwo {
        let power = power.clamp(-MOST, MOST);
        let (third, rest) = (power / 3, power % 3);
        PowerOfTwo([third + rest, third, third].map(|power| 2f64.powi(power)))
    }

    /// Returns the value times this power of two.
    pub(crate) fn times(self, value: f64) -> f64 {
        let [first, second, third] = self.0;
        value * first * second * third
    }
}
