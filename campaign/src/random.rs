//! Random numbers that a seed determines.

/// A sequence of random numbers, by the generator splitmix64.
#[derive(Clone)]
pub struct Random(u64);

impl Random {
    /// The sequence of a seed. The sequences of neighbouring seeds are independent.
    pub fn new(seed: u64) -> Random {
        Random(seed)
    }

    /// A separate sequence, determined by the state of this one and by `salt`. Numbers that are drawn from it do not change this sequence.
    pub fn beside(&self, salt: u64) -> Random {
        Random(self.0 ^ salt)
    }

    /// The next 64 random bits.
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in 0..1, uniformly distributed.
    pub fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in a..b, uniformly distributed.
    pub fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.uniform()
    }

    /// A number between a and b, whose logarithm is uniformly distributed.
    pub fn decades(&mut self, a: f64, b: f64) -> f64 {
        self.between(a.ln(), b.ln()).exp()
    }

    /// An integer in a..=b, uniformly distributed.
    pub fn integer(&mut self, a: usize, b: usize) -> usize {
        a + (self.next() % (b - a + 1) as u64) as usize
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.uniform() < probability
    }

    /// One item of a list, each with the same probability.
    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.integer(0, list.len() - 1)]
    }
}
