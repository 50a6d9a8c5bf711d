//! Random numbers that follow from a seed alone.

/// SplitMix64 (Steele, Lea, Flood 2014).
#[derive(Clone, Debug)]
pub(super) struct Random(u64);

impl Random {
    /// A sequence of its own for every list of keys.
    pub(super) fn new(keys: &[u64]) -> Self {
        let mut random = Self(0);
        for key in keys {
            random.0 = random.next_u64() ^ key;
        }
        random
    }

    pub(super) fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(super) fn unit(&mut self) -> f32 {
        (self.next_u64() >> 40) as f32 / (1u32 << 24) as f32
    }

    /// In [-1, 1).
    pub(super) fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }

    /// Standard normal (Box and Muller 1958).
    pub(super) fn normal(&mut self) -> f32 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (std::f32::consts::TAU * self.unit()).cos()
    }

    /// Nearly standard normal, and quick: the sum of four numbers of one draw (Irwin and Hall), within 3.5.
    pub(super) fn bell(&mut self) -> f32 {
        let bits = self.next_u64();
        let sum = (0..4).map(|i| (bits >> (16 * i) & 0xffff) as u32).sum::<u32>();
        (sum as f32 / 65535.0 - 2.0) * 3.0f32.sqrt()
    }

    /// The numbers below `n` in random order (Fisher and Yates).
    pub(super) fn permutation(&mut self, n: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..n).collect();
        for i in (1..n).rev() {
            order.swap(i, (self.next_u64() % (i as u64 + 1)) as usize);
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_give_sequences_of_their_own_with_the_right_moments() {
        assert_ne!(Random::new(&[1, 2]).next_u64(), Random::new(&[2, 1]).next_u64());
        let mut random = Random::new(&[7]);
        let n = 20_000;
        for draw in [Random::normal, Random::bell] {
            let draws: Vec<f32> = (0..n).map(|_| draw(&mut random)).collect();
            let mean = draws.iter().sum::<f32>() / n as f32;
            let variance = draws.iter().map(|x| x * x).sum::<f32>() / n as f32;
            assert!(mean.abs() < 0.03 && (variance - 1.0).abs() < 0.05, "{mean} {variance}");
        }
        let mut order = random.permutation(100);
        order.sort();
        assert_eq!(order, (0..100).collect::<Vec<_>>());
    }
}
