//! Random numbers that a seed determines.

/// splitmix64.
#[derive(Clone)]
pub struct Random(u64);

impl Random {
    /// The numbers of a seed. Those of neighbouring seeds are independent.
    pub fn new(seed: u64) -> Random {
        Random(seed)
    }

    /// A separate sequence, which does not change these numbers.
    pub fn beside(&self, salt: u64) -> Random {
        Random(self.0 ^ salt)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in 0..1.
    pub fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in a..b.
    pub fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.uniform()
    }

    /// Between a and b, uniform in the logarithm.
    pub fn decades(&mut self, a: f64, b: f64) -> f64 {
        self.between(a.ln(), b.ln()).exp()
    }

    /// An integer of a..=b.
    pub fn integer(&mut self, a: usize, b: usize) -> usize {
        a + (self.next() % (b - a + 1) as u64) as usize
    }

    /// True with this probability.
    pub fn chance(&mut self, part: f64) -> bool {
        self.uniform() < part
    }

    /// One of a list.
    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.integer(0, list.len() - 1)]
    }
}
