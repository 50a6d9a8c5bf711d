//! The 3x3 neighbourhoods of an image as rows of a matrix, so that the first convolution is a
//! product of matrices.

use crate::training::network::Size;

/// Rows of 9 times the channels, one for each position of a 3x3 convolution with stride 2 and
/// padding 1 over images of `size`, tap by tap.
pub(in crate::training) fn patches(images: &[f32], size: Size) -> Vec<f32> {
    let Size { rows, cols, channels } = size;
    let out = size.strided(2);
    let mut patches = vec![0.0; images.len() / (size.area() * channels) * out.area() * 9 * channels];
    let mut rest = patches.chunks_exact_mut(9 * channels);
    for image in images.chunks_exact(size.area() * channels) {
        for (row, col) in (0..out.rows).flat_map(|r| (0..out.cols).map(move |c| (2 * r, 2 * c))) {
            let Some(patch) = rest.next() else { return patches };
            // The padding is at the low side only where the image starts.
            for (tap_row, taps) in patch.chunks_exact_mut(3 * channels).enumerate() {
                let Some(y) = (row + tap_row).checked_sub(1).filter(|y| *y < rows) else { continue };
                let skipped = usize::from(col == 0);
                let end = (col + 2).min(cols);
                let start = col + skipped - 1;
                let from = &image[(y * cols + start) * channels..(y * cols + end) * channels];
                taps[skipped * channels..][..from.len()].copy_from_slice(from);
            }
        }
    }
    patches
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn borders_are_zero_and_the_rest_is_in_place() {
        let size = Size { rows: 4, cols: 4, channels: 1 };
        let image: Vec<f32> = (1..=16).map(|i| i as f32).collect();
        let rows = patches(&image, size);
        assert_eq!(rows[..9], [0., 0., 0., 0., 1., 2., 0., 5., 6.]);
        assert_eq!(rows[9..18], [0., 0., 0., 2., 3., 4., 6., 7., 8.]);
        assert_eq!(rows[27..], [6., 7., 8., 10., 11., 12., 14., 15., 16.]);
    }
}
