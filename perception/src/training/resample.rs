//! Pooling and resizing along one axis as a constant matrix: fast where the network is trained and
//! where it runs, and the same numbers in both.

use super::network::Resample;
use crate::taps::Taps;

/// The `to` x `from` matrix, row by row, whose product with a line of `from` values gives `to`.
pub(super) fn matrix(how: Resample, from: usize, to: usize) -> Vec<f32> {
    let mut matrix = vec![0.0; to * from];
    let taps = Taps::new(from, to, false);
    for (i, row) in matrix.chunks_exact_mut(from).enumerate() {
        match how {
            Resample::Pool => pool_row(row, i, to),
            Resample::Bilinear => {
                row[taps.left[i]] += 1.0 - taps.weight[i];
                row[taps.right(i, from)] += taps.weight[i];
            }
        }
    }
    matrix
}

/// Bin `i` of `to` covers from `floor(i * from / to)` to `ceil((i + 1) * from / to)`.
fn pool_row(row: &mut [f32], i: usize, to: usize) {
    let bin = i * row.len() / to..((i + 1) * row.len()).div_ceil(to);
    let share = 1.0 / bin.len() as f32;
    row[bin].fill(share);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_weighted_means() {
        for how in [Resample::Pool, Resample::Bilinear] {
            for (from, to) in [(4, 6), (8, 1), (8, 3), (4, 32), (5, 5)] {
                for row in matrix(how, from, to).chunks_exact(from) {
                    assert!((row.iter().sum::<f32>() - 1.0).abs() < 1e-6 && row.iter().all(|w| *w >= 0.0));
                }
            }
        }
    }

    #[test]
    fn values_done_by_hand() {
        assert_eq!(matrix(Resample::Pool, 4, 3), [0.5, 0.5, 0., 0., 0., 0.5, 0.5, 0., 0., 0., 0.5, 0.5]);
        assert_eq!(matrix(Resample::Bilinear, 2, 4), [1., 0., 0.75, 0.25, 0.25, 0.75, 0., 1.]);
    }
}
