//! Batches: which frames, seen how.

use super::dataset::Frame;
use super::random::Random;
use crate::classes::IGNORE;
use crate::metadata::Normalisation;

/// How bytes become the network's input: the usual means and deviations of photographs.
pub(super) const NORMALISATION: Normalisation =
    Normalisation { mean: [0.485, 0.456, 0.406], std: [0.229, 0.224, 0.225] };

/// Bounds the weights of rare classes: they count six times as much as a third of all pixels. The
/// form is that of Paszke et al. 2016 (ENet), whose 1.02 makes it 15 times.
pub const CLASS_WEIGHT_OFFSET: f64 = 1.05;

/// Largest change of contrast, and of each colour's share, as a fraction.
const CONTRAST: f32 = 0.2;
/// Largest change of brightness, as a fraction of the range.
const BRIGHTNESS: f32 = 0.1;

/// Pictures as the network takes them, with their labels.
pub(super) struct Pictures {
    /// Row by row, red, green, blue, normalised.
    pub(super) values: Vec<f32>,
    /// Train ids of every pixel.
    pub(super) labels: Vec<u8>,
}

/// Frames flipped and recoloured at random.
pub(super) fn augmented<'a>(frames: impl Iterator<Item = &'a Frame>, width: usize, random: &mut Random) -> Pictures {
    let mut pictures = Pictures { values: Vec::new(), labels: Vec::new() };
    for frame in frames {
        let flip = random.unit() < 0.5;
        let table = recoloured(random);
        let pixels = frame.rgb.as_chunks::<3>().0.chunks_exact(width);
        for (pixels, labels) in pixels.zip(frame.labels.chunks_exact(width)) {
            let mut add = |x: usize| {
                pictures.values.extend((0..3).map(|c| table[c][usize::from(pixels[x][c])]));
                pictures.labels.push(labels[x]);
            };
            if flip { (0..width).rev().for_each(&mut add) } else { (0..width).for_each(&mut add) }
        }
    }
    pictures
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
    fn pictures_and_labels_are_flipped_together() {
        let frame = Frame { rgb: vec![10, 10, 10, 200, 200, 200], labels: vec![1, 2] };
        let mut seen = [false; 2];
        for seed in 0..20 {
            let pictures = augmented([&frame].into_iter(), 2, &mut Random::new(&[seed]));
            let flipped = pictures.labels == [2, 1];
            assert_eq!(flipped, pictures.values[0] > pictures.values[3]);
            assert_eq!(pictures.values.len(), 6);
            seen[usize::from(flipped)] = true;
        }
        assert_eq!(seen, [true; 2]);
    }

    #[test]
    fn rare_classes_count_more() {
        let frame = Frame { rgb: Vec::new(), labels: [vec![0; 99], vec![1], vec![IGNORE; 50]].concat() };
        let [common, rare, absent] = class_weights(&[frame]);
        assert!((common - 1.0 / 2.04f32.ln()).abs() < 1e-5);
        assert!(rare > 6.0 * common && absent > rare);
    }
}
