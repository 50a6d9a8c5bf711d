//! Rows to columns and back. Neighbouring values of a column differ little, so their differences are
//! mostly small numbers, and zstd finds them side by side.

use kernel::Controls;

/// Columns of one seat's controls: steer, throttle, brake and flags, each as [`planes`].
pub(crate) type ControlColumns = [Vec<u8>; 4];

/// The differences of a column of 16-bit values, zigzag so that small ones of either sign have a high
/// byte of 0; first all low bytes, then all high ones.
fn planes(values: impl Iterator<Item = u16>) -> Vec<u8> {
    let mut before = 0;
    let zigzag = values.map(|v| {
        let d = v.wrapping_sub(std::mem::replace(&mut before, v)) as i16;
        ((d << 1) ^ (d >> 15)) as u16
    });
    let (mut low, high): (Vec<u8>, Vec<u8>) = zigzag.map(|z| (z as u8, (z >> 8) as u8)).unzip();
    low.extend(high);
    low
}

fn unplanes(planes: &[u8]) -> impl Iterator<Item = u16> {
    let (low, high) = planes.split_at(planes.len() / 2);
    low.iter().zip(high).scan(0u16, |value, (l, h)| {
        let z = u16::from_le_bytes([*l, *h]);
        *value = value.wrapping_add((z >> 1) ^ (z & 1).wrapping_neg());
        Some(*value)
    })
}

/// Columns of controls.
pub(crate) fn split_controls<'a>(rows: impl Iterator<Item = &'a Controls> + Clone) -> ControlColumns {
    [
        planes(rows.clone().map(|c| c.steer as u16)),
        planes(rows.clone().map(|c| c.throttle)),
        planes(rows.clone().map(|c| c.brake)),
        planes(rows.map(|c| u16::from(c.flags))),
    ]
}

/// The controls of `ticks` ticks.
pub(crate) fn join_controls(columns: &ControlColumns, ticks: usize) -> Result<Vec<Controls>, String> {
    if let Some(column) = columns.iter().find(|c| c.len() != 2 * ticks) {
        return Err(format!("a column of {} bytes for {ticks} ticks, expected {}", column.len(), 2 * ticks));
    }
    let [steer, throttle, brake, flags] = columns;
    let rows = unplanes(steer).zip(unplanes(throttle)).zip(unplanes(brake)).zip(unplanes(flags));
    rows.map(|(((steer, throttle), brake), flags)| {
        let flags =
            u8::try_from(flags).map_err(|_| format!("flags {flags}, expected a sum of {}", Controls::ALL_FLAGS))?;
        Ok(Controls { steer: steer as i16, throttle, brake, flags })
    })
    .collect()
}

/// The difference of each value to the one before; the first to 0.
pub(crate) fn differences(values: impl Iterator<Item = u64>) -> Vec<i64> {
    let mut before = 0;
    values.map(|v| v.wrapping_sub(std::mem::replace(&mut before, v)) as i64).collect()
}

/// The values of [`differences`].
pub(crate) fn sums(differences: &[i64]) -> impl Iterator<Item = u64> {
    differences.iter().scan(0u64, |sum, d| {
        *sum = sum.wrapping_add(*d as u64);
        Some(*sum)
    })
}

/// Byte strings of one layout, such as snapshots of one scene: if all are equally long, their bytes
/// transposed, so that a value's bytes over time lie side by side, as differences; else one after
/// the other.
pub(crate) fn stack(rows: &[Vec<u8>]) -> Vec<u8> {
    let width = rows.first().map_or(0, Vec::len);
    if rows.iter().any(|r| r.len() != width) {
        return rows.concat();
    }
    let column = |at: usize| {
        let mut before = 0u8;
        rows.iter().map(move |r| r[at].wrapping_sub(std::mem::replace(&mut before, r[at])))
    };
    (0..width).flat_map(column).collect()
}

/// The rows of [`stack`], whose lengths must be known.
pub(crate) fn unstack(lengths: &[usize], stacked: &[u8]) -> Result<Vec<Vec<u8>>, String> {
    let total = lengths.iter().try_fold(0usize, |sum, n| sum.checked_add(*n));
    if total != Some(stacked.len()) {
        return Err(format!("{} bytes for rows of {lengths:?}", stacked.len()));
    }
    let width = lengths.first().copied().unwrap_or(0);
    let mut rows: Vec<Vec<u8>> = lengths.iter().map(|n| Vec::with_capacity(*n)).collect();
    if lengths.iter().any(|n| *n != width) {
        let mut rest = stacked.iter().copied();
        rows.iter_mut().zip(lengths).for_each(|(row, n)| row.extend(rest.by_ref().take(*n)));
        return Ok(rows);
    }
    for column in stacked.chunks_exact(lengths.len().max(1)) {
        let mut value = 0u8;
        for (row, d) in rows.iter_mut().zip(column) {
            value = value.wrapping_add(*d);
            row.push(value);
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn controls() -> impl Strategy<Value = Controls> {
        (any::<i16>(), any::<u16>(), any::<u16>(), 0..=Controls::ALL_FLAGS)
            .prop_map(|(steer, throttle, brake, flags)| Controls { steer, throttle, brake, flags })
    }

    proptest! {
        #[test]
        fn controls_come_back(rows in prop::collection::vec(controls(), 0..70)) {
            let columns = split_controls(rows.iter());
            prop_assert_eq!(join_controls(&columns, rows.len()), Ok(rows.clone()));
            prop_assert!(join_controls(&columns, rows.len() + 1).is_err());
        }

        #[test]
        fn numbers_come_back(values in prop::collection::vec(any::<u64>(), 0..70)) {
            prop_assert_eq!(sums(&differences(values.iter().copied())).collect::<Vec<_>>(), values);
        }

        #[test]
        fn stacks_come_back(rows in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..4), 0..5)) {
            let lengths: Vec<usize> = rows.iter().map(Vec::len).collect();
            prop_assert_eq!(unstack(&lengths, &stack(&rows)), Ok(rows));
        }

        #[test]
        fn foreign_bytes_are_no_panic(
            lengths in prop::collection::vec(any::<usize>(), 0..5),
            bytes in prop::collection::vec(any::<u8>(), 0..40),
            ticks in 0usize..10,
        ) {
            let _ = unstack(&lengths, &bytes);
            let _ = join_controls(&[bytes.clone(), bytes.clone(), bytes.clone(), bytes], ticks);
        }
    }

    #[test]
    fn small_differences_leave_the_high_plane_empty() {
        let values = [1000u16, 1001, 999, 1003, 1000];
        assert_eq!(planes(values.into_iter())[6..], [0, 0, 0, 0]);
    }

    #[test]
    fn unknown_flags_are_refused() {
        let mut columns = split_controls([Controls::default()].iter());
        columns[3] = planes([256].into_iter());
        assert!(join_controls(&columns, 1).is_err_and(|e| e.contains("flags 512") || e.contains("flags 256")));
    }
}
