//! Orders of conditions that are balanced over pairs of people.

/// A row of Williams' square for so many conditions: over all rows (as many as conditions, or twice as many where these are
/// odd) each stands at each place equally often, and comes right after each other equally often (Williams 1949). Rows
/// count from 0 and begin anew after the last.
pub fn row(conditions: usize, row: usize) -> Vec<usize> {
    let n = conditions.max(1);
    let rows = if n.is_multiple_of(2) { n } else { 2 * n };
    let row = row % rows;
    let shifted = (0..conditions).map(|place| {
        let zigzag = if place % 2 == 1 { place.div_ceil(2) } else { (n - place / 2) % n };
        (zigzag + row % n) % n
    });
    let mut order: Vec<usize> = shifted.collect();
    if row >= n {
        order.reverse();
    }
    order
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn conditions_are_at_each_place_and_after_each_other_equally_often() {
        for n in 1..=9 {
            let rows: Vec<_> = (0..if n % 2 == 0 { n } else { 2 * n }).map(|index| row(n, index)).collect();
            let (mut at, mut after) = (BTreeMap::new(), BTreeMap::new());
            for order in &rows {
                order.iter().enumerate().for_each(|place| *at.entry(place).or_insert(0) += 1);
                order.windows(2).for_each(|pair| *after.entry((pair[0], pair[1])).or_insert(0) += 1);
            }
            let each = rows.len() / n;
            assert!(at.len() == n * n && at.values().all(|times| *times == each), "{n}: {rows:?}");
            let pairs = n * n - n;
            assert!(after.len() == pairs && after.values().all(|times| *times == each), "{n}: {rows:?}");
            assert_eq!(row(n, rows.len()), rows[0]);
        }
        assert_eq!(row(4, 0), [0, 1, 3, 2]);
    }
}
