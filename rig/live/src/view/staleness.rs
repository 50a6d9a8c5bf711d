//! How old the mask on the semantic driver's screen was, along the timeline.

use kernel::time::Tick;
use replay::MaskShown;

use super::timeline::Timeline;

/// The greatest age of the mask on the screen in each of so many equal parts of a timeline, or of as
/// many as it has ticks, in ticks; 0 where there was none.
pub fn greatest_ages(masks: &[MaskShown], timeline: &Timeline, parts: usize) -> Vec<Tick> {
    let ticks = timeline.last - timeline.first + 1;
    let parts = ticks.min(parts as Tick);
    let part_of = |tick: Tick| (tick - timeline.first) * parts / ticks;
    let end_of = |part: Tick| timeline.first + ((part + 1) * ticks).div_ceil(parts) - 1;
    let mut ages = vec![0; parts as usize];
    for (i, mask) in masks.iter().enumerate() {
        let until = masks.get(i + 1).map_or(timeline.last, |next| next.tick_shown.saturating_sub(1));
        let (from, to) = (mask.tick_shown.max(timeline.first), until.min(timeline.last));
        if from > to || parts == 0 {
            continue;
        }
        for part in part_of(from)..=part_of(to) {
            let age = mask.age_at(to.min(end_of(part)));
            ages[part as usize] = age.max(ages[part as usize]);
        }
    }
    ages
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn masks(rows: &[(Tick, Tick)]) -> Vec<MaskShown> {
        let mask = |&(tick_shown, age): &(Tick, Tick)| MaskShown {
            tick_shown,
            tick_of_frame: tick_shown.saturating_sub(age),
            camera: 0,
            digest: tick_shown,
            times: None,
        };
        rows.iter().map(mask).collect()
    }

    /// Tick by tick.
    fn plainly(masks: &[MaskShown], timeline: &Timeline, parts: usize) -> Vec<Tick> {
        let parts = parts.min((timeline.last - timeline.first + 1) as usize);
        let mut ages = vec![0; parts];
        for tick in timeline.first..=timeline.last {
            let Some(mask) = masks.iter().rfind(|mask| mask.tick_shown <= tick) else { continue };
            let part = (tick - timeline.first) as usize * parts / (timeline.last - timeline.first + 1) as usize;
            ages[part] = ages[part].max(tick.saturating_sub(mask.tick_of_frame));
        }
        ages
    }

    #[test]
    fn a_mask_grows_old_until_the_next_comes() {
        let timeline = Timeline { first: 0, last: 9, marks: Vec::new() };
        let ages = greatest_ages(&masks(&[(2, 1), (5, 2)]), &timeline, 10);
        assert_eq!(ages, [0, 0, 1, 2, 3, 2, 3, 4, 5, 6]);
        assert_eq!(greatest_ages(&masks(&[(2, 1)]), &timeline, 0), [] as [Tick; 0]);
    }

    proptest! {
        #[test]
        fn it_is_what_one_finds_tick_by_tick(
            first in 0u64..50,
            ticks in 0u64..200,
            rows in prop::collection::btree_map(0u64..260, 0u64..30, 0..30),
            parts in 1usize..300,
        ) {
            let timeline = Timeline { first, last: first + ticks, marks: Vec::new() };
            let masks = masks(&rows.into_iter().collect::<Vec<_>>());
            prop_assert_eq!(greatest_ages(&masks, &timeline, parts), plainly(&masks, &timeline, parts));
        }
    }
}
