//! What a view can show of a moment, and in which colours.

use perception::classes::{IGNORE, TRAIN_ID_OF_TAG};

/// What a view shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// The mask that was on the semantic driver's screen.
    Seen,
    /// The image.
    Rgb,
    /// The true classes.
    Truth,
    /// What the chosen checkpoint makes of the image.
    Prediction,
    /// Where that is wrong.
    Difference,
    /// Where the checkpoint is unsure.
    Confidence,
}

impl Layer {
    /// Every layer, in the order of the number keys.
    pub const ALL: [Self; 6] =
        [Self::Seen, Self::Rgb, Self::Truth, Self::Prediction, Self::Difference, Self::Confidence];

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Seen => "seen",
            Self::Rgb => "RGB",
            Self::Truth => "truth",
            Self::Prediction => "prediction",
            Self::Difference => "difference",
            Self::Confidence => "confidence",
        }
    }

    /// Whether its colours are those of classes.
    pub fn shows_classes(self) -> bool {
        matches!(self, Self::Seen | Self::Truth | Self::Prediction)
    }

    /// What its colours mean.
    pub fn legend(self) -> &'static str {
        match self {
            Self::Seen => "the mask on the semantic driver's screen",
            Self::Rgb => "the image",
            Self::Truth => "true classes",
            Self::Prediction => "predicted classes",
            Self::Difference => "red where wrong, black where not measured",
            Self::Confidence => "bright where unsure",
        }
    }
}

const WRONG: [u8; 3] = [255, 48, 48];
const NOT_MEASURED: [u8; 3] = [0, 0, 0];

/// Compares tag ids as the metrics do, in trained classes: right pixels in a dark shade of their
/// class, wrong ones red, those whose true class is not trained black. 3 bytes a pixel.
pub fn difference(truth: &[u8], prediction: &[u8]) -> Vec<u8> {
    let colour = |(truth, prediction): (&u8, &u8)| {
        let [class, predicted] = [truth, prediction].map(|tag| TRAIN_ID_OF_TAG[usize::from(*tag)]);
        match class {
            IGNORE => NOT_MEASURED,
            _ if class == predicted => render::tags::colour(*truth).map(|value| value / 3),
            _ => WRONG,
        }
    };
    truth.iter().zip(prediction).flat_map(colour).collect()
}

/// Colours of a doubt of 0, 1/4, 1/2, 3/4 and 1; their brightness rises.
const DOUBT: [[f32; 3]; 5] =
    [[0.0, 0.0, 0.0], [72.0, 18.0, 112.0], [188.0, 55.0, 84.0], [249.0, 142.0, 9.0], [252.0, 255.0, 200.0]];

/// The doubt, 1 less the confidence, as colours. 3 bytes a pixel.
pub fn doubt(confidence: &[f32]) -> Vec<u8> {
    confidence.iter().flat_map(|confidence| doubt_colour(1.0 - confidence)).collect()
}

fn doubt_colour(doubt: f32) -> [u8; 3] {
    let steps = (DOUBT.len() - 1) as f32;
    let place = doubt.clamp(0.0, 1.0) * steps;
    let below = (place as usize).min(DOUBT.len() - 2);
    let along = place - below as f32;
    std::array::from_fn(|c| (DOUBT[below][c] + (DOUBT[below + 1][c] - DOUBT[below][c]) * along + 0.5) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use perception::ConfusionMatrix;
    use proptest::prelude::*;

    #[test]
    fn a_wrong_pixel_is_red_and_an_unmeasured_one_black() {
        let (road, pedestrian, unlabelled) = (7, 4, 0);
        let colours = difference(&[road, pedestrian, unlabelled], &[road, road, pedestrian]);
        assert_eq!(colours[..3], render::tags::colour(road).map(|v| v / 3));
        assert_eq!((&colours[3..6], &colours[6..]), (&WRONG[..], &NOT_MEASURED[..]));
    }

    #[test]
    fn more_doubt_is_brighter() {
        let brightness = |doubt: f32| doubt_colour(doubt).iter().map(|v| u32::from(*v)).sum::<u32>();
        let shades: Vec<u32> = (0..=20).map(|i| brightness(i as f32 / 20.0)).collect();
        assert!(shades.is_sorted_by(|a, b| a < b), "{shades:?}");
        assert_eq!(doubt(&[1.0]), [0, 0, 0]);
        assert_eq!(doubt(&[f32::NAN]).len(), 3);
    }

    proptest! {
        #[test]
        fn as_many_pixels_are_red_as_the_metrics_count_wrong(pairs in prop::collection::vec((0u8..23, 0u8..23), 1..200)) {
            let (truth, prediction): (Vec<u8>, Vec<u8>) = pairs.into_iter().unzip();
            let mut matrix = ConfusionMatrix::default();
            matrix.add(&truth, &prediction);
            let scores = matrix.scores();
            let red = difference(&truth, &prediction).as_chunks().0.iter().filter(|pixel| **pixel == WRONG).count();
            let wrong = scores.pixels as f64 * (1.0 - scores.accuracy);
            prop_assert!(scores.pixels == 0 && red == 0 || (red as f64 - wrong).abs() < 1e-6);
        }
    }
}
