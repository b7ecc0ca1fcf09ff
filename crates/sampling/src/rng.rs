//! Counter-based random numbers: the n-th number of a stream is a function of seed, stream and n alone.

/// 2^64 divided by the golden ratio, odd: steps that spread consecutive integers over all bits.
pub(crate) const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// A stream of random numbers that depends on nothing but its seed and its stream number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rng {
    keys: [u64; 2],
    counter: u64,
}

impl Rng {
    /// The start of stream `stream` (a receiver, a pixel) under `seed`.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Self {
        Self { keys: [hash(seed, stream, 1), hash(seed, stream, 2)], counter: 0 }
    }

    /// Uniform over all 64-bit integers.
    #[inline]
    pub fn next_u64(&mut self) -> u64 {
        let n = self.counter;
        self.counter = n.wrapping_add(1);
        // The second key comes between two mixes: streams whose counters overlap still give different numbers.
        mix(mix(self.keys[0].wrapping_add(n.wrapping_mul(GOLDEN))) ^ self.keys[1])
    }

    /// Uniform over all 32-bit integers.
    #[inline]
    pub fn next_u32(&mut self) -> u32 {
        (self.next_u64() >> 32) as u32
    }

    /// Uniform in `[0, 1)`, a multiple of 2^-24.
    #[inline]
    pub fn next_f32(&mut self) -> f32 {
        (self.next_u64() >> 40) as f32 * (1.0 / (1_u64 << 24) as f32)
    }

    /// Uniform in `[0, 1)`, a multiple of 2^-53.
    #[inline]
    pub fn next_f64(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// A point of the unit square.
    #[inline]
    pub fn next_square(&mut self) -> [f32; 2] {
        [self.next_f32(), self.next_f32()]
    }
}

/// Mixes a seed and two numbers into one, for seeds of parts of a computation.
#[inline]
#[must_use]
pub fn hash(seed: u64, a: u64, b: u64) -> u64 {
    let seeded = mix(seed.wrapping_add(GOLDEN));
    let with_a = mix(seeded ^ a.wrapping_mul(GOLDEN).wrapping_add(1));
    mix(with_a ^ b.wrapping_mul(GOLDEN).wrapping_add(2))
}

/// A bijection of 64-bit integers in which every input bit flips every output bit with probability near 1/2
/// (xor-shift-multiply with Stafford's thirteenth set of constants).
#[inline]
fn mix(mut v: u64) -> u64 {
    v = (v ^ (v >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    v = (v ^ (v >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    v ^ (v >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_do_not_depend_on_history() {
        let mut first = Rng::new(7, 3);
        let _ = first.next_u64();
        let second = first.next_u64();
        let mut again = Rng { counter: 1, ..Rng::new(7, 3) };
        assert_eq!(again.next_u64(), second, "the counter alone places the number");
    }

    #[test]
    fn golden_numbers_stay() {
        let mut rng = Rng::new(0, 0);
        let drawn = [rng.next_u64(), rng.next_u64(), rng.next_u64()];
        assert_eq!(drawn, GOLDEN_NUMBERS, "a change here changes every baked file");
    }

    /// From a second implementation with unbounded integers.
    const GOLDEN_NUMBERS: [u64; 3] = [12906561927352598825, 8023430836040283569, 16350183595436762453];
}
