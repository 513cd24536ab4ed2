//! Reads random bytes as numbers. Also has the values that outputs have before a call.

/// The number of elements for which arrays have room.
pub const ROOM: usize = 256;
/// The value of outputs of type double before a call.
pub const SENTINEL: f64 = -12345.678;
/// The value of integer outputs before a call.
pub const SENTINEL_CONTACT: i32 = -77;

/// What the bytes are made into, in addition to a scene and options.
#[derive(Clone, Copy, PartialEq)]
pub enum Target {
    /// Effects that the bytes select, possibly with friction.
    Scene,
    /// The same, and always a table of coefficients.
    Table,
    /// The same effects as for `Scene`, and always friction.
    Friction,
}

/// Reads bytes one after another. Beyond their end it reads zeros.
pub struct Bytes<'a> {
    data: &'a [u8],
}

impl Bytes<'_> {
    pub fn new(data: &[u8]) -> Bytes<'_> {
        Bytes { data }
    }

    /// The next byte.
    pub fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.data.split_first() else { return 0 };
        self.data = rest;
        *first
    }

    /// The next eight bytes as an integer.
    pub fn word(&mut self) -> u64 {
        (0..8).fold(0, |word, _| word << 8 | u64::from(self.byte()))
    }

    /// A floating-point number: mostly a usual one, sometimes an extreme one or one of arbitrary bits.
    pub fn number(&mut self) -> f64 {
        match self.byte() {
            0 => f64::from_bits(self.word()),
            1 => [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MAX, f64::MIN_POSITIVE, 5e-324]
                [usize::from(self.byte() % 8)],
            2 => f64::from(self.byte() as i8) * 10f64.powi(i32::from(self.byte() as i8)),
            _ => f64::from(self.byte()) / 100.0,
        }
    }

    /// Mostly the number `usual`, otherwise any number.
    pub fn sometimes(&mut self, usual: f64) -> f64 {
        if self.byte() % 16 == 1 {
            self.number()
        } else {
            usual
        }
    }

    /// Mostly an integer in 0..`limit`, sometimes any integer.
    pub fn integer(&mut self, limit: u8) -> i32 {
        match self.byte() {
            255 => self.word() as i32,
            byte => i32::from(byte % limit),
        }
    }

    /// A number of elements in one direction: from 1 to 16, or sometimes one that no grid can have.
    pub fn size(&mut self) -> i32 {
        match self.byte() {
            255 => [0, -1, i32::MIN, i32::MAX, 65536][usize::from(self.byte() % 5)],
            byte => 1 + i32::from(byte % 16),
        }
    }
}
