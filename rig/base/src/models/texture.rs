//! Pictures of base colours.

use std::io::Cursor;

use anyhow::{Context, anyhow, bail};

/// Sides of pictures are read up to this, pixels.
const MOST_SIDE: u32 = 8192;
/// What is kept of them: colours are those of vertices, which lie farther apart.
const KEPT_SIDE: u32 = 256;

/// A picture, small enough for colours at vertices.
pub(super) struct Texture {
    width: usize,
    height: usize,
    /// Red, green, blue (sRGB) and alpha, 0 to 1.
    texels: Vec<[f32; 4]>,
}

impl Texture {
    /// From the bytes of a PNG file.
    pub(super) fn decode(bytes: &[u8]) -> anyhow::Result<Self> {
        if bytes.starts_with(&[0xff, 0xd8]) {
            bail!("is a JPEG file, expected a PNG file");
        }
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::normalize_to_color8() | png::Transformations::ALPHA);
        let mut reader = decoder.read_info().context("is no PNG file")?;
        let (width, height) = (reader.info().width, reader.info().height);
        if width > MOST_SIDE || height > MOST_SIDE {
            bail!("has {width}x{height} pixels, expected at most {MOST_SIDE}x{MOST_SIDE}");
        }
        let length = reader.output_buffer_size().ok_or_else(|| anyhow!("is too large"))?;
        let mut samples = vec![0; length];
        let info = reader.next_frame(&mut samples).context("is a damaged PNG file")?;
        let channels = info.color_type.samples();
        Ok(Self::reduced([width, height], channels, &samples))
    }

    /// Means of squares of pixels.
    fn reduced([width, height]: [u32; 2], channels: usize, samples: &[u8]) -> Self {
        let step = width.max(height).div_ceil(KEPT_SIDE).max(1) as usize;
        let (wide, high) = (width as usize, height as usize);
        let (width, height) = (wide.div_ceil(step), high.div_ceil(step));
        let rgba = |x: usize, y: usize| {
            let pixel = samples.get((y * wide + x) * channels..).unwrap_or_default();
            let sample = |i: usize| f32::from(pixel.get(i).copied().unwrap_or(0)) / 255.0;
            match channels {
                1 | 2 => [sample(0), sample(0), sample(0), if channels == 2 { sample(1) } else { 1.0 }],
                _ => [sample(0), sample(1), sample(2), if channels == 4 { sample(3) } else { 1.0 }],
            }
        };
        let mean = |at: usize| {
            let (x, y) = (at % width * step, at / width * step);
            let around = (y..(y + step).min(high)).flat_map(|y| (x..(x + step).min(wide)).map(move |x| (x, y)));
            let (mut sum, mut count) = ([0.0; 4], 0.0);
            for pixel in around.map(|(x, y)| rgba(x, y)) {
                sum.iter_mut().zip(pixel).for_each(|(sum, sample)| *sum += sample);
                count += 1.0;
            }
            sum.map(|sum: f32| sum / count)
        };
        Self { width, height, texels: (0..width * height).map(mean).collect() }
    }

    /// The colour at coordinates of which the picture repeats, between four texels.
    pub(super) fn at(&self, [u, v]: [f32; 2]) -> [f32; 4] {
        let place = |share: f32, side: usize| {
            let share = if share.is_finite() { share.rem_euclid(1.0) } else { 0.0 };
            let at = (share * side as f32 - 0.5).rem_euclid(side as f32);
            let first = (at as usize).min(side - 1);
            (first, (first + 1) % side, at - first as f32)
        };
        let ((left, right, x), (top, bottom, y)) = (place(u, self.width), place(v, self.height));
        let texel = |x: usize, y: usize, i: usize| self.texels[y * self.width + x][i];
        core::array::from_fn(|i| {
            let row = |at: usize| texel(left, at, i) * (1.0 - x) + texel(right, at, i) * x;
            row(top) * (1.0 - y) + row(bottom) * y
        })
    }
}
