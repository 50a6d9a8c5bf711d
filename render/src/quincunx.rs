//! Quincunx: half of a pixel is the sample in its middle, half those at its four corners (NVIDIA 2001, "HRAA: High-resolution
//! antialiasing"). Made on the processor, where it is the same for every adapter and costs a software renderer a fifth of
//! what a compute pass does.

/// Red, green, blue and one byte more.
const BYTES: usize = 4;

/// Floats from here on are whole: to add it rounds, and the last bits count.
const TO_WHOLE: f32 = 8_388_608.0;

/// Mixes rows of pixels.
#[derive(Default)]
pub(crate) struct Quincunx {
    /// Sums of squares of the corners above and below each other.
    columns: Vec<f32>,
    mixed: Vec<u8>,
}

impl Quincunx {
    /// One row of pixels, four bytes each, from its middles and the corners above and below it, of which there is one more.
    /// Bytes are mixed as their squares are, close to light.
    pub(crate) fn row(&mut self, middles: &[u8], above: &[u8], below: &[u8]) -> &[u8] {
        let square = |byte: &u8| f32::from(*byte) * f32::from(*byte);
        self.columns.clear();
        self.columns.extend(above.iter().zip(below).map(|(a, b)| square(a) + square(b)));
        let right = self.columns.get(BYTES..).unwrap_or_default();
        self.mixed.clear();
        // Sums are whole and small, and roots are correctly rounded: the same bits everywhere.
        let sums = middles.iter().zip(self.columns.iter().zip(right)).map(|(m, (l, r))| 4.0 * square(m) + l + r);
        self.mixed.extend(sums.map(|sum| ((sum * 0.125).sqrt() + TO_WHOLE).to_bits() as u8));
        &self.mixed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_a_pixel_is_its_middle_and_an_eighth_each_corner() {
        let pixel = |r: u8| [r, 0, 255, 255];
        let row = |reds: &[u8]| reds.iter().flat_map(|r| pixel(*r)).collect::<Vec<u8>>();
        let mut quincunx = Quincunx::default();
        let mixed = quincunx.row(&row(&[200, 40]), &row(&[200, 200, 0]), &row(&[200, 200, 255]));
        // sqrt((4 * 1600 + 2 * 40000 + 65025) / 8)
        assert_eq!(mixed, row(&[200, 138]));
        assert_eq!(quincunx.row(&row(&[9]), &row(&[9, 9]), &row(&[9, 9])), row(&[9]), "one row after another");
    }
}
