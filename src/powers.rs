//! Powers of two: numbers are taken apart, so that nothing on the way to a result is beyond the range of numbers. A result that is a normal number
//! has the bits that it has without powers.

/// A number > 0 as one near 1 and a power of two.
pub(crate) fn apart(value: f64) -> (f64, i32) {
    let power = value.log2().floor() as i32;
    (times_power(value, -power), power)
}

/// Times a power of two, which may be beyond the range of numbers itself.
pub(crate) fn times_power(value: f64, power: i32) -> f64 {
    PowerOfTwo::new(power).times(value)
}

/// A number, and the power of two that it is multiplied by: products are of any size.
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

    /// f of two of them, which is as large as they are: their sum, or the root of their squares.
    pub(crate) fn with(self, other: Scaled, f: impl Fn(f64, f64) -> f64) -> Scaled {
        let power = [self, other].into_iter().filter(|one| one.0 != 0.0).map(|one| one.1).max().unwrap_or(0);
        Scaled(f(self.at(power), other.at(power)), power)
    }

    /// As a multiple of a power of two.
    pub(crate) fn at(self, power: i32) -> f64 {
        times_power(self.0, self.1 - power)
    }

    /// As a number, if it is one.
    pub(crate) fn value(self) -> f64 {
        self.at(0)
    }
}

/// A power of two as a product of three, each of which is a number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PowerOfTwo([f64; 3]);

/// Beyond, nothing is left of any number, or it is infinite.
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
