//! Random bytes as numbers, and the contents of arrays before a call.

/// The number of elements for which arrays have room.
pub const ROOM: usize = 256;
/// The value of outputs before a call.
pub const SENTINEL: f64 = -12345.678;
pub const SENTINEL_CONTACT: i32 = -77;

/// The target of the bytes, in addition to a scene and options.
#[derive(Clone, Copy, PartialEq)]
pub enum Target {
    /// Effects that the bytes name, possibly with friction.
    Scene,
    /// A table of coefficients as well.
    Table,
    /// Friction in any case.
    Friction,
}

/// Bytes, read one value after the other, followed by zeros.
pub struct Bytes<'a> {
    data: &'a [u8],
}

impl Bytes<'_> {
    pub fn new(data: &[u8]) -> Bytes<'_> {
        Bytes { data }
    }

    pub fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.data.split_first() else { return 0 };
        self.data = rest;
        *first
    }

    pub fn word(&mut self) -> u64 {
        (0..8).fold(0, |word, _| word << 8 | u64::from(self.byte()))
    }

    /// A usual number, or any bits.
    pub fn number(&mut self) -> f64 {
        match self.byte() {
            0 => f64::from_bits(self.word()),
            1 => [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MAX, f64::MIN_POSITIVE, 5e-324]
                [usize::from(self.byte() % 8)],
            2 => f64::from(self.byte() as i8) * 10f64.powi(i32::from(self.byte() as i8)),
            _ => f64::from(self.byte()) / 100.0,
        }
    }

    /// Mostly `usual`, otherwise any number.
    pub fn sometimes(&mut self, usual: f64) -> f64 {
        if self.byte() % 16 == 1 {
            self.number()
        } else {
            usual
        }
    }

    /// Mostly below `limit`, now and then any integer.
    pub fn integer(&mut self, limit: u8) -> i32 {
        match self.byte() {
            255 => self.word() as i32,
            byte => i32::from(byte % limit),
        }
    }

    /// A size within the room, or one that no grid has.
    pub fn size(&mut self) -> i32 {
        match self.byte() {
            255 => [0, -1, i32::MIN, i32::MAX, 65536][usize::from(self.byte() % 5)],
            byte => 1 + i32::from(byte % 16),
        }
    }
}
