//! The range that is marked on the timeline, to be cut out.

use std::ops::RangeInclusive;

use kernel::time::Tick;

/// A range whose ends are marked one after the other, in any order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MarkedRange {
    /// First tick.
    pub from: Option<Tick>,
    /// Last tick.
    pub to: Option<Tick>,
}

impl MarkedRange {
    /// Marks the first tick; a last one before it no longer holds.
    pub fn mark_from(&mut self, tick: Tick) {
        self.from = Some(tick);
        self.to = self.to.filter(|to| *to >= tick);
    }

    /// Marks the last tick; a first one after it no longer holds.
    pub fn mark_to(&mut self, tick: Tick) {
        self.to = Some(tick);
        self.from = self.from.filter(|from| *from <= tick);
    }

    /// First to last tick, once both are marked.
    pub fn ticks(&self) -> Option<RangeInclusive<Tick>> {
        Some(self.from?..=self.to?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_marked_in_any_order() {
        let mut range = MarkedRange::default();
        range.mark_to(20);
        assert_eq!(range.ticks(), None);
        range.mark_from(10);
        assert_eq!(range.ticks(), Some(10..=20));
        range.mark_from(20);
        assert_eq!(range.ticks(), Some(20..=20));
    }

    #[test]
    fn an_end_that_contradicts_the_other_replaces_it() {
        let mut range = MarkedRange { from: Some(10), to: Some(20) };
        range.mark_from(21);
        assert_eq!((range.from, range.to), (Some(21), None));
        range.mark_to(5);
        assert_eq!((range.from, range.to), (None, Some(5)));
    }
}
