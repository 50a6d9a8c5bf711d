//! Quincunx: half of a pixel is the sample in its middle, half those at its four corners (NVIDIA 2001, "HRAA: High-resolution
//! antialiasing"). Made on the processor, where it is the same for every adapter and costs a software renderer a fifth of
//! what a compute pass does. Bytes are mixed as their squares are, close to light.

/// Red, green, blue, and whether a corner was drawn.
const BYTES: usize = 4;

/// Floats from here on are whole: to add it rounds, and the last bits count.
const TO_WHOLE: f32 = 8_388_608.0;

/// Mixes a picture, row by row.
#[derive(Default)]
pub(crate) struct Quincunx {
    /// Squares of the corners above and below the row at hand.
    above: Vec<f32>,
    below: Vec<f32>,
    /// Sums of squares of each column of two pixels.
    columns: Vec<f32>,
    mixed: Vec<u8>,
}

fn square(byte: u8) -> f32 {
    f32::from(byte) * f32::from(byte)
}

#[inline]
fn corner(left: &[f32; BYTES], right: &[f32; BYTES], drawn: &[u8; BYTES]) -> [f32; BYTES] {
    if drawn[3] == 0 { core::array::from_fn(|i| 0.25 * (left[i] + right[i])) } else { drawn.map(square) }
}

impl Quincunx {
    /// Goes on to the corners below the next row: `drawn`, and where they were not drawn the mean of the pixels above and below
    /// them; beyond the edges these are as at them.
    pub(crate) fn corners(&mut self, pixels: [&[u8]; 2], drawn: &[u8]) {
        core::mem::swap(&mut self.above, &mut self.below);
        self.columns.clear();
        self.columns.extend(pixels[0].iter().zip(pixels[1]).map(|(a, b)| square(*a) + square(*b)));
        let (columns, drawn) = (self.columns.as_chunks::<BYTES>().0, drawn.as_chunks::<BYTES>().0);
        let n = columns.len();
        self.below.resize(BYTES * (n + 1), 0.0);
        let below = self.below.as_chunks_mut::<BYTES>().0;
        below[0] = corner(&columns[0], &columns[0], &drawn[0]);
        below[n] = corner(&columns[n - 1], &columns[n - 1], &drawn[n]);
        let pairs = columns[..n - 1].iter().zip(&columns[1..]).zip(&drawn[1..n]);
        for (below, ((left, right), drawn)) in below[1..n].iter_mut().zip(pairs) {
            *below = corner(left, right, drawn);
        }
    }

    /// The row of pixels between the last two rows of corners, four bytes each, from its middles.
    pub(crate) fn row(&mut self, middles: &[u8]) -> &[u8] {
        self.columns.clear();
        self.columns.extend(self.above.iter().zip(&self.below).map(|(a, b)| a + b));
        let right = self.columns.get(BYTES..).unwrap_or_default();
        self.mixed.clear();
        // Sums are quarters and small, and roots are correctly rounded: the same bits everywhere.
        let sums = middles.iter().zip(self.columns.iter().zip(right)).map(|(m, (l, r))| 4.0 * square(*m) + l + r);
        self.mixed.extend(sums.map(|sum| ((sum * 0.125).sqrt() + TO_WHOLE).to_bits() as u8));
        &self.mixed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(reds: &[u8]) -> Vec<u8> {
        reds.iter().flat_map(|red| [*red, 0, 255, 255]).collect()
    }

    #[test]
    fn half_of_a_pixel_is_its_middle_and_an_eighth_each_corner() {
        let mut quincunx = Quincunx::default();
        let middles = row(&[200, 40]);
        quincunx.corners([&middles; 2], &row(&[200, 200, 0]));
        quincunx.corners([&middles; 2], &row(&[200, 200, 255]));
        // sqrt((4 * 1600 + 2 * 40000 + 65025) / 8)
        assert_eq!(quincunx.row(&middles), row(&[200, 138]));
    }

    #[test]
    fn a_corner_that_was_not_drawn_is_the_mean_of_its_pixels() {
        let mut quincunx = Quincunx::default();
        let [upper, lower] = [row(&[100, 120]), row(&[140, 200])];
        let blank = [0; 12];
        quincunx.corners([&upper; 2], &blank);
        quincunx.corners([&upper, &lower], &blank);
        // 4 * 10000 + 10000 + (10000 + 14400) / 2 + (10000 + 19600) / 2 + (10000 + 14400 + 19600 + 40000) / 4
        assert_eq!(quincunx.row(&upper)[0], (98_000.0f32 / 8.0).sqrt().round() as u8);
    }
}
