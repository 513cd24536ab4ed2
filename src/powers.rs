//! Numbers split into a mantissa and a power of two, so that no intermediate result leaves the range of double precision. A normal result
//! has the same bits as without the split.

/// Splits a number > 0 into a factor near 1 and a power of two.
pub(crate) fn apart(value: f64) -> (f64, i32) {
    let power = value.log2().floor() as i32;
    (times_power(value, -power), power)
}

/// `value * 2^power`; the power of two itself may be out of range.
pub(crate) fn times_power(value: f64, power: i32) -> f64 {
    PowerOfTwo::new(power).times(value)
}

/// A number times a power of two. Its products can have any size.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Scaled(pub f64, pub i32);

impl Scaled {
    pub(crate) fn of(value: f64) -> Scaled {
        if value == 0.0 {
            return Scaled(0.0, 0);
        }
        let (near_one, power) = apart(value.abs());
        Scaled(near_one.copysign(value), power)
    }

    pub(crate) fn times(self, other: Scaled) -> Scaled {
        Scaled(self.0 * other.0, self.1 + other.1)
    }

    pub(crate) fn over(self, other: Scaled) -> Scaled {
        Scaled(self.0 / other.0, self.1 - other.1)
    }

    /// f of two numbers, homogeneous of degree 1: for example their sum, or the root of the sum of their squares.
    pub(crate) fn with(self, other: Scaled, f: impl Fn(f64, f64) -> f64) -> Scaled {
        let power = [self, other].into_iter().filter(|one| one.0 != 0.0).map(|one| one.1).max().unwrap_or(0);
        Scaled(f(self.at(power), other.at(power)), power)
    }

    /// The number over `2^power`.
    pub(crate) fn at(self, power: i32) -> f64 {
        times_power(self.0, self.1 - power)
    }

    /// The number in double precision, 0 or infinite if it is out of range.
    pub(crate) fn value(self) -> f64 {
        self.at(0)
    }
}

/// Terms like e^-x are dropped for x beyond this, because e^-40 = 4e-18 is round-off.
pub(crate) const FADED: f64 = 40.0;

/// Upper limit on lengths and tractions: sums of their squares are finite.
pub(crate) const LARGEST: f64 = 1e140;

/// A power of two as a product of three, each in range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PowerOfTwo([f64; 3]);

/// The largest power: numbers are 2^-1074 to 2^1024, so that 2^2200 times any of them is infinite, and 2^-2200 times any is 0.
const MOST: i32 = 2200;

impl PowerOfTwo {
    /// 2 to this power.
    pub(crate) fn new(power: i32) -> PowerOfTwo {
        let power = power.clamp(-MOST, MOST);
        let (third, rest) = (power / 3, power % 3);
        PowerOfTwo([third + rest, third, third].map(|power| 2f64.powi(power)))
    }

    /// This power of two times a value.
    pub(crate) fn times(self, value: f64) -> f64 {
        let [first, second, third] = self.0;
        value * first * second * third
    }
}
