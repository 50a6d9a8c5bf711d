//! Variety from numbers: the same variant always looks the same.

/// A stream of choices that a variant makes.
#[derive(Clone, Copy, Debug)]
pub struct Variety(u32);

impl Variety {
    /// The choices of a variant.
    pub fn of(variant: u32) -> Self {
        Self(variant.wrapping_mul(0x9e37_79b9) ^ 0x5bd1_e995)
    }

    /// The next 32 bits (finaliser of MurmurHash3 over a counter).
    pub fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        let mut h = self.0;
        h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
        h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
        h ^ (h >> 16)
    }

    /// A number in [lo, hi).
    pub fn between(&mut self, lo: f32, hi: f32) -> f32 {
        lo + (hi - lo) * (self.bits() >> 8) as f32 / 16_777_216.0
    }

    /// True once in `n` times.
    pub fn one_in(&mut self, n: u32) -> bool {
        self.bits().is_multiple_of(n)
    }

    /// One of some choices.
    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.bits() as usize % choices.len()]
    }

    /// One of some choices that come with shares of one another.
    pub fn weighted<T: Copy>(&mut self, choices: &[(T, u32)]) -> T {
        let mut at = self.bits() % choices.iter().map(|(_, share)| share).sum::<u32>();
        for &(choice, share) in choices {
            if at < share {
                return choice;
            }
            at -= share;
        }
        choices[0].0
    }

    /// A colour close to one of some colours.
    pub fn colour(&mut self, choices: &[[u8; 3]]) -> [u8; 3] {
        let factor = self.between(0.88, 1.1);
        self.pick(choices).map(|c| (f32::from(c) * factor).min(255.0) as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_variants_choose_differently() {
        let firsts: std::collections::BTreeSet<u32> = (0..1000).map(|v| Variety::of(v).bits()).collect();
        assert_eq!(firsts.len(), 1000);
    }

    #[test]
    fn numbers_stay_in_their_range() {
        let mut v = Variety::of(7);
        assert!((0..1000).map(|_| v.between(-2.0, 3.0)).all(|x| (-2.0..3.0).contains(&x)));
    }
}
