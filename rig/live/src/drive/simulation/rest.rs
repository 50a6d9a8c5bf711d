//! A break between runs.

/// When a break ends.
#[derive(Default)]
pub struct Rest {
    until_us: Option<u64>,
    shown_s: Option<u32>,
}

impl Rest {
    /// Begins one of so many seconds; of none it is over at once.
    pub fn begin(&mut self, now_us: u64, seconds: u32) {
        self.until_us = (seconds > 0).then(|| now_us + 1_000_000 * u64::from(seconds));
    }

    /// Nobody rests any more.
    pub fn end(&mut self) {
        *self = Self::default();
    }

    /// Seconds that are left of it, begun ones whole.
    pub fn left_s(&self, now_us: u64) -> Option<u32> {
        let left_us = self.until_us?.checked_sub(now_us)?;
        Some(left_us.div_ceil(1_000_000) as u32).filter(|seconds| *seconds > 0)
    }

    /// Whether what is shown of it has changed.
    pub fn is_news(&mut self, now_us: u64) -> bool {
        let left_s = self.left_s(now_us);
        std::mem::replace(&mut self.shown_s, left_s) != left_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_break_is_counted_down_and_over() {
        let mut rest = Rest::default();
        assert!(rest.left_s(5).is_none() && !rest.is_news(5));
        rest.begin(1_000_000, 2);
        let left = [1_000_000, 1_000_001, 2_500_000, 3_000_000, 9_000_000].map(|now_us| rest.left_s(now_us));
        assert_eq!(left, [Some(2), Some(2), Some(1), None, None]);
        assert_eq!([1_000_000, 1_500_000, 2_500_000, 4_000_000].map(|us| rest.is_news(us)), [true, false, true, true]);
        rest.begin(0, 0);
        assert_eq!(rest.left_s(0), None);
    }
}
