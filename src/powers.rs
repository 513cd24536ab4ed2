//! Powers of two: numbers are taken apart, so that nothing on the way to a result is beyond the range of numbers, and no bit changes.

/// A number > 0 as one near 1 and a power of two.
pub(crate) fn apart(value: f64) -> (f64, i32) {
    let power = value.log2().floor() as i32;
    (times_power(value, -power), power)
}

/// Times a power of two, which may be beyond the range of numbers itself.
pub(crate) fn times_power(value: f64, power: i32) -> f64 {
    PowerOfTwo::new(power).times(value)
}

/// The power of two of the largest of these numbers; 0 where all are 0.
pub(crate) fn largest_power(values: impl Iterator<Item = f64>) -> i32 {
    let most = values.map(f64::abs).fold(0.0, f64::max);
    if most > 0.0 {
        apart(most).1
    } else {
        0
    }
}

/// What numbers are multiplied by, in three parts: each of them is a number.
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
