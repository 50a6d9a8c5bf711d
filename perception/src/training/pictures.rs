//! Batches: which frames, seen how.

use super::dataset::Frame;
use super::random::Random;
use crate::classes::IGNORE;
use crate::metadata::Normalisation;

/// How bytes become the network's input: the usual means and deviations of photographs.
pub(super) const NORMALISATION: Normalisation =
    Normalisation { mean: [0.485, 0.456, 0.406], std: [0.229, 0.224, 0.225] };

/// Bounds the weights of rare classes: they count four times as much as one with a third of all
/// pixels. IoU is highest where a class is predicted from a probability of `IoU / (1 + IoU)` on,
/// which for the small classes here is about a fifth. The form is that of Paszke et al. 2016 (ENet),
/// whose 1.02 makes it 15 times.
pub const CLASS_WEIGHT_OFFSET: f64 = 1.1;

/// Largest change of contrast, and of each colour's share, as a fraction.
const CONTRAST: f32 = 0.2;
/// Half of the pictures are windows enlarged up to so many times.
const LARGEST_ZOOM: f32 = 2.0;
/// Largest change of brightness, as a fraction of the range.
const BRIGHTNESS: f32 = 0.1;

/// Pictures as the network takes them, with their labels.
pub(super) struct Pictures {
    /// Row by row, red, green, blue, normalised.
    pub(super) values: Vec<f32>,
    /// Train ids of every pixel.
    pub(super) labels: Vec<u8>,
}

/// Frames flipped, enlarged and recoloured at random.
pub(super) fn augmented<'a>(
    frames: impl Iterator<Item = &'a Frame>,
    (width, height): (usize, usize),
    random: &mut Random,
) -> Pictures {
    let mut pictures = Pictures { values: Vec::new(), labels: Vec::new() };
    for frame in frames {
        let zoom = if random.unit() < 0.5 { 1.0 } else { 1.0 + (LARGEST_ZOOM - 1.0) * random.unit() };
        let mut columns = window(width, zoom, random);
        let rows = window(height, zoom, random);
        if random.unit() < 0.5 {
            columns.reverse();
        }
        let table = recoloured(random);
        for (row, column) in rows.iter().flat_map(|row| columns.iter().map(move |column| (row, column))) {
            pictures.values.extend((0..3).map(|c| {
                let value = |y: usize, x: usize| table[c][usize::from(frame.rgb[(y * width + x) * 3 + c])];
                row.mix(|y| column.mix(|x| value(y, x)))
            }));
            pictures.labels.push(frame.labels[row.nearest() * width + column.nearest()]);
        }
    }
    pictures
}

/// Where a line of an enlarged picture comes from: a line, the next one's share, and the next one.
#[derive(Clone, Copy)]
struct Source {
    low: usize,
    high: usize,
    share: f32,
}

impl Source {
    fn mix(self, value: impl Fn(usize) -> f32) -> f32 {
        let low = value(self.low);
        if self.share == 0.0 { low } else { low + self.share * (value(self.high) - low) }
    }

    fn nearest(self) -> usize {
        if self.share < 0.5 { self.low } else { self.high }
    }
}

/// A random window of a `zoom`th of an axis of `n` pixels, stretched over the whole.
fn window(n: usize, zoom: f32, random: &mut Random) -> Vec<Source> {
    let start = random.unit() * n as f32 * (1.0 - 1.0 / zoom);
    let source = |i: usize| {
        let place = (start + (i as f32 + 0.5) / zoom - 0.5).clamp(0.0, (n - 1) as f32);
        let low = place as usize;
        Source { low, high: (low + 1).min(n - 1), share: place - low as f32 }
    };
    (0..n).map(source).collect()
}

/// The input value of every byte of red, green and blue under a random light.
fn recoloured(random: &mut Random) -> [[f32; 256]; 3] {
    let contrast = 1.0 + CONTRAST * random.signed();
    let brightness = BRIGHTNESS * random.signed();
    let tint: [f32; 3] = std::array::from_fn(|_| 1.0 + CONTRAST / 2.0 * random.signed());
    let plain = NORMALISATION.table();
    std::array::from_fn(|c| {
        std::array::from_fn(|byte| {
            let fraction = (byte as f32 / 255.0 - 0.5) * contrast * tint[c] + 0.5 + brightness;
            plain[c][(fraction.clamp(0.0, 1.0) * 255.0).round() as usize]
        })
    })
}

/// How much a pixel of each class counts in the loss: `1 / ln(CLASS_WEIGHT_OFFSET + f)` with `f` the
/// class's share of the labelled pixels.
pub(super) fn class_weights<const N: usize>(frames: &[Frame]) -> [f32; N] {
    let mut counts = [0u64; N];
    for label in frames.iter().flat_map(|f| &f.labels).filter(|l| **l != IGNORE) {
        counts[usize::from(*label)] += 1;
    }
    let total = counts.iter().sum::<u64>().max(1);
    counts.map(|count| (1.0 / (CLASS_WEIGHT_OFFSET + count as f64 / total as f64).ln()) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_and_labels_move_together() {
        // The brighter a pixel, the higher its label: so it must be in any view of the picture.
        let (width, height) = (32, 16);
        let side = |i: usize| u8::from(i % width >= 11) + 2 * u8::from(i / width >= 5);
        let labels: Vec<u8> = (0..width * height).map(side).collect();
        let frame = Frame { rgb: labels.iter().flat_map(|l| [40 + 60 * l; 3]).collect(), labels };
        let mut starts = [0; 4];
        for seed in 0..40 {
            let pictures = augmented([&frame].into_iter(), (width, height), &mut Random::new(&[seed]));
            assert_eq!((pictures.values.len(), pictures.labels.len()), (3 * width * height, width * height));
            starts[usize::from(pictures.labels[0])] += 1;
            let mut reds = [(0.0, 0.0); 4];
            for (pixel, label) in pictures.values.chunks_exact(3).zip(&pictures.labels) {
                let (sum, count) = &mut reds[usize::from(*label)];
                (*sum, *count) = (*sum + pixel[0], *count + 1.0);
            }
            let means: Vec<f32> = reds.iter().filter(|(_, n)| *n > 0.0).map(|(sum, n)| sum / n).collect();
            assert!(means.is_sorted_by(|a, b| a < b), "seed {seed}: {means:?}");
        }
        assert!(starts[0] > 5 && starts[1] > 5, "{starts:?}");
    }

    #[test]
    fn a_window_covers_its_part_of_the_axis() {
        let mut random = Random::new(&[4]);
        let whole = window(8, 1.0, &mut random);
        assert!(whole.iter().enumerate().all(|(i, s)| s.low == i && s.share == 0.0));
        for _ in 0..50 {
            let half = window(8, 2.0, &mut random);
            let place = |s: &Source| s.low as f32 + s.share;
            assert!(half.windows(2).all(|w| place(&w[1]) - place(&w[0]) <= 0.5 + 1e-5));
            assert!(place(&half[7]) - place(&half[0]) > 2.9);
        }
    }

    #[test]
    fn rare_classes_count_more() {
        let frame = Frame { rgb: Vec::new(), labels: [vec![0; 99], vec![1], vec![IGNORE; 50]].concat() };
        let [common, rare, absent] = class_weights(&[frame]);
        assert!((common - 1.0 / 2.09f32.ln()).abs() < 1e-5);
        assert!(rare > 6.0 * common && absent > rare);
    }
}
