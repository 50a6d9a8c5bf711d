//! Which frames are drawn: functions of the seed and of what the frames show.

use crate::dataset::provenance::FrameLine;

/// Frames in the order in which a seed draws them.
pub fn shuffled<'a>(frames: impl Iterator<Item = &'a FrameLine>, seed: u64) -> Vec<&'a FrameLine> {
    let mut drawn: Vec<&FrameLine> = frames.collect();
    drawn.sort_by_cached_key(|line| *blake3::hash(format!("mix {seed} {}", line.image).as_bytes()).as_bytes());
    drawn
}

/// Draws `count` items whose values sum up to `target` as closely as exchanging single ones gets.
/// Items come in the order of the draw; so do the indices that are returned.
///
/// The first ones are drawn from the richest items, of which there are as many as may be without their
/// mean falling short of the target's.
pub fn matching(values: &[u64], count: usize, target: u64) -> Vec<usize> {
    let mut chosen = vec![false; values.len()];
    let rich = rich(values, count, target);
    (0..values.len()).filter(|i| rich[*i]).take(count).for_each(|i| chosen[i] = true);
    let sum: i128 = values.iter().zip(&chosen).filter(|(_, c)| **c).map(|(v, _)| i128::from(*v)).sum();
    let mut missing = i128::from(target) - sum;
    while let Some((out, into)) = best_exchange(values, &chosen, missing) {
        (chosen[out], chosen[into]) = (false, true);
        missing -= i128::from(values[into]) - i128::from(values[out]);
    }
    (0..values.len()).filter(|i| chosen[*i]).collect()
}

/// The richest items, at least `count`, whose mean reaches that of the target.
fn rich(values: &[u64], count: usize, target: u64) -> Vec<bool> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by_key(|i| (std::cmp::Reverse(values[*i]), *i));
    let mut sum = 0;
    let reaches = order.iter().zip(1..).take_while(|(item, n)| {
        sum += u128::from(values[**item]);
        *n <= count || sum * count as u128 >= u128::from(target) * *n as u128
    });
    let kept = reaches.count();
    let mut rich = vec![false; values.len()];
    order[..kept].iter().for_each(|item| rich[*item] = true);
    rich
}

/// The exchange of a chosen item for another that leaves the least of what is missing; `None` when
/// none leaves less.
fn best_exchange(values: &[u64], chosen: &[bool], missing: i128) -> Option<(usize, usize)> {
    let mut rest: Vec<(i128, usize)> =
        (0..values.len()).filter(|i| !chosen[*i]).map(|i| (i128::from(values[i]), i)).collect();
    rest.sort_unstable();
    let candidates = (0..values.len()).filter(|i| chosen[*i]).flat_map(|out| {
        let wanted = i128::from(values[out]) + missing;
        let above = rest.partition_point(|(value, _)| *value < wanted);
        let near = above.saturating_sub(1)..(above + 1).min(rest.len());
        rest[near].iter().map(move |(value, into)| ((wanted - value).abs(), out, *into)).collect::<Vec<_>>()
    });
    candidates.min().filter(|(left, _, _)| *left < missing.abs()).map(|(_, out, into)| (out, into))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sum(values: &[u64], chosen: &[usize]) -> u64 {
        chosen.iter().map(|i| values[*i]).sum()
    }

    proptest! {
        #[test]
        fn so_many_are_drawn_and_no_exchange_comes_closer(
            values in prop::collection::vec(0u64..5000, 1..40),
            share in 0.0..1.0f64,
            mean in 0u64..6000,
        ) {
            let count = 1 + (share * (values.len() - 1) as f64) as usize;
            let target = mean * count as u64;
            let chosen = matching(&values, count, target);
            prop_assert_eq!(chosen.len(), count);
            prop_assert!(chosen.is_sorted_by(|a, b| a < b));
            let left = sum(&values, &chosen).abs_diff(target);
            for out in &chosen {
                for into in (0..values.len()).filter(|i| !chosen.contains(i)) {
                    let other = sum(&values, &chosen) - values[*out] + values[into];
                    prop_assert!(left <= other.abs_diff(target));
                }
            }
        }
    }

    #[test]
    fn what_can_be_matched_exactly_is() {
        let values: Vec<u64> = (0..400).map(|i| i * i % 977).collect();
        for target in [20_000, 40_000, 52_345] {
            assert_eq!(sum(&values, &matching(&values, 100, target)), target);
        }
        assert_eq!(
            sum(&values, &matching(&values, 3, u64::MAX)),
            976 + 975 + 970,
            "the richest, when they are too poor"
        );
    }

    #[test]
    fn rich_frames_are_drawn_and_not_only_the_richest() {
        // Half of the frames show nobody; the target is the mean of the other half.
        let frame = |i: u64| if i.is_multiple_of(2) { 0 } else { 1000 + i };
        let values: Vec<u64> = (0..1000).map(|i| frame(i * 617 % 1000)).collect();
        let chosen = matching(&values, 100, 100 * 1500);
        assert_eq!(sum(&values, &chosen), 150_000);
        let poor = chosen.iter().filter(|i| values[**i] == 0).count();
        let richest = chosen.iter().filter(|i| values[**i] > 1900).count();
        assert!(poor <= 1 && richest < 20, "{poor} {richest}");
    }
}
