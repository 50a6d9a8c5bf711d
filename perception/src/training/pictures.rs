//! Batches: which frames, seen how.

use super::dataset::{Frame, Split};
use super::light::Look;
use super::options::TrainOptions;
use super::people::without_small;
use super::random::Random;
use super::sampling::Rarity;
use super::view::{Place, View, window};
use crate::classes::IGNORE;

/// Bounds the weights of rare classes: they count four times as much as one with a third of all
/// pixels. IoU is highest where a class is predicted from a probability of `IoU / (1 + IoU)` on,
/// which for the small classes here is about a fifth. The form is that of Paszke et al. 2016 (ENet),
/// whose 1.02 makes it 15 times.
pub const CLASS_WEIGHT_OFFSET: f64 = 1.1;

/// Half of the pictures are windows enlarged up to so many times.
const LARGEST_ZOOM: f32 = 2.0;

/// Pictures as the network takes them, with their labels.
pub(super) struct Pictures {
    /// Row by row, red, green, blue, normalised.
    pub(super) values: Vec<f32>,
    /// Train ids of every pixel.
    pub(super) labels: Vec<u8>,
}

/// Frames of a split, given by their numbers, flipped, enlarged, recoloured and worsened at random.
pub(super) fn augmented(
    split: &Split,
    share: &[usize],
    (options, rarity): (&TrainOptions, &Rarity),
    random: &mut Random,
) -> Pictures {
    let mut pictures = Pictures { values: Vec::new(), labels: Vec::new() };
    for frame in share {
        pictures.add(&split.frames[*frame], (split.width, split.height), (options, rarity), random);
    }
    pictures
}

impl Pictures {
    fn add(
        &mut self,
        frame: &Frame,
        (from_width, from_height): (usize, usize),
        (options, rarity): (&TrainOptions, &Rarity),
        random: &mut Random,
    ) {
        let TrainOptions { width, height, looks, sampling, .. } = options;
        // Pixels of a picture that shows the whole frame over those of the frame.
        let whole = *width as f32 / from_width as f32;
        let is_round = sampling.round_rare > 0.0 && random.unit() < sampling.round_rare;
        let zoom = if !is_round && random.unit() < 0.5 { 1.0 } else { 1.0 + (LARGEST_ZOOM - 1.0) * random.unit() };
        let scale = zoom * whole;
        let middle = is_round.then(|| rarity.middle(frame, from_width, scale, sampling.tall_px, random)).flatten();
        let [across, down] = middle.map_or([Place::Random; 2], |(x, y)| [Place::Round(x), Place::Round(y)]);
        let mut columns = window((from_width, *width), zoom, across, random);
        let rows = window((from_height, *height), zoom, down, random);
        if random.unit() < 0.5 {
            columns.reverse();
        }
        let look = Look::draw(looks, random);
        let view = View { rows: &rows, columns: &columns, width: from_width };
        let start = self.values.len();
        view.picture(&frame.rgb, &look.table(random), &mut self.values);
        look.apply(&mut self.values[start..], *width, random);
        let labels = without_small(&frame.labels, &frame.people, scale, sampling.least_px);
        view.labels(labels.as_deref().unwrap_or(&frame.labels), &mut self.labels);
    }
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
    use super::super::light::Looks;
    use super::super::sampling::Sampling;
    use super::*;

    #[test]
    fn pictures_and_labels_move_together() {
        // The brighter a pixel, the higher its label: so it must be in any view of the picture.
        let (width, height) = (32, 16);
        let side = |i: usize| u8::from(i % width >= 11) + 2 * u8::from(i / width >= 5);
        let labels: Vec<u8> = (0..width * height).map(side).collect();
        let rgb = labels.iter().flat_map(|l| [40 + 60 * l; 3]).collect();
        let frames = vec![Frame { rgb, labels, people: Vec::new() }];
        let split = Split { frames, width, height, digest: blake3::hash(b"") };
        let options = TrainOptions { width, height, ..TrainOptions::default() };
        let rarity = Rarity::of(&split.frames, 1.0, &options.sampling);
        let mut starts = [0; 4];
        for seed in 0..40 {
            let pictures = augmented(&split, &[0], (&options, &rarity), &mut Random::new(&[seed]));
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

    /// Pictures of the options of before there were looks, sampling and larger frames, as they were made then.
    fn before(frame: &Frame, (width, height): (usize, usize), random: &mut Random) -> Pictures {
        let zoom = if random.unit() < 0.5 { 1.0 } else { 1.0 + (LARGEST_ZOOM - 1.0) * random.unit() };
        let mut window = |n: usize| -> Vec<(usize, usize, f32)> {
            let start = random.unit() * n as f32 * (1.0 - 1.0 / zoom);
            let source = |i: usize| {
                let place = (start + (i as f32 + 0.5) / zoom - 0.5).clamp(0.0, (n - 1) as f32);
                let low = place as usize;
                (low, (low + 1).min(n - 1), place - low as f32)
            };
            (0..n).map(source).collect()
        };
        let (mut columns, rows) = (window(width), window(height));
        if random.unit() < 0.5 {
            columns.reverse();
        }
        let table = Look::draw(&Default::default(), random).table(random);
        let mix = |(low, high, share): (usize, usize, f32), value: &dyn Fn(usize) -> f32| {
            if share == 0.0 { value(low) } else { value(low) + share * (value(high) - value(low)) }
        };
        let nearest = |(low, high, share): (usize, usize, f32)| if share < 0.5 { low } else { high };
        let mut pictures = Pictures { values: Vec::new(), labels: Vec::new() };
        for (row, column) in rows.iter().flat_map(|row| columns.iter().map(move |column| (*row, *column))) {
            pictures.values.extend((0..3).map(|c| {
                let value = |y: usize, x: usize| table[c][usize::from(frame.rgb[(y * width + x) * 3 + c])];
                mix(row, &|y| mix(column, &|x| value(y, x)))
            }));
            pictures.labels.push(frame.labels[nearest(row) * width + nearest(column)]);
        }
        pictures
    }

    #[test]
    fn options_of_before_give_the_pictures_of_before() {
        let (width, height) = (64, 32);
        let mut random = Random::new(&[1]);
        let mut bytes =
            |n: usize, below: u64| -> Vec<u8> { (0..n).map(|_| (random.next_u64() % below) as u8).collect() };
        let (rgb, labels) = (bytes(3 * width * height, 256), bytes(width * height, 16));
        let split =
            Split { frames: vec![Frame { rgb, labels, people: Vec::new() }], width, height, digest: blake3::hash(b"") };
        let options = TrainOptions { width, height, ..TrainOptions::default() };
        let rarity = Rarity::of(&split.frames, 1.0, &options.sampling);
        for seed in 0..20 {
            let (mut now, mut then) = (Random::new(&[seed]), Random::new(&[seed]));
            let pictures = augmented(&split, &[0, 0], (&options, &rarity), &mut now);
            let [first, second] = [0, 1].map(|_| before(&split.frames[0], (width, height), &mut then));
            let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&pictures.values), bits(&[first.values, second.values].concat()), "seed {seed}");
            assert_eq!(pictures.labels, [first.labels, second.labels].concat());
            assert_eq!(now.next_u64(), then.next_u64());
        }
    }

    /// A frame twice as large as the network's input with somebody of 40 rows and somebody of 10.
    fn crowd() -> Split {
        let (width, height) = (128, 64);
        let instance = |i: usize| match (i % width, i / width) {
            (100..108, 10..50) => 4000,
            (20..23, 30..40) => 4001,
            _ => 7,
        };
        let instances: Vec<u16> = (0..width * height).map(instance).collect();
        let labels: Vec<u8> = instances.iter().map(|id| if *id >= 4000 { 2 } else { 5 }).collect();
        let rgb = labels.iter().flat_map(|label| [if *label == 2 { 250 } else { 10 }; 3]).collect();
        let people = super::super::people::people(&instances, width);
        Split { frames: vec![Frame { rgb, labels, people }], width, height, digest: blake3::hash(b"") }
    }

    #[test]
    fn windows_are_laid_round_people_and_the_small_count_nowhere_in_them() {
        let split = crowd();
        let sampling = Sampling { rare_below: 0.0, round_rare: 1.0, tall_px: 16, least_px: 6 };
        let options = TrainOptions { width: 64, height: 32, sampling, ..TrainOptions::default() };
        let rarity = Rarity::of(&split.frames, 2.0, &sampling);
        let (mut seen, mut ignored) = (0, 0);
        for seed in 0..40 {
            let Pictures { values, labels } = augmented(&split, &[0], (&options, &rarity), &mut Random::new(&[seed]));
            assert_eq!((values.len(), labels.len()), (3 * 64 * 32, 64 * 32));
            seen += usize::from(labels.contains(&2));
            ignored += usize::from(labels.contains(&IGNORE));
            // Who counts is bright, and so is who does not.
            for (pixel, label) in values.as_chunks::<3>().0.iter().zip(&labels) {
                assert!(*label == 5 || pixel[0] > -1.5, "seed {seed}: {label} at {pixel:?}");
            }
        }
        // Ten rows are five in the whole, ten in the closest window, six from 1.2 times on.
        assert_eq!(seen, 40);
        assert!((1..20).contains(&ignored), "{ignored}");
    }

    #[test]
    fn looks_change_the_picture_and_leave_the_labels() {
        let split = crowd();
        let rarity = Rarity::of(&split.frames, 2.0, &Sampling::default());
        let of = |looks: Looks, seed: u64| {
            let options = TrainOptions { width: 64, height: 32, looks, ..TrainOptions::default() };
            augmented(&split, &[0], (&options, &rarity), &mut Random::new(&[seed]))
        };
        let mut differ = 0;
        for seed in 0..20 {
            let [plain, wide, again] = [Looks::default(), Looks::WIDE, Looks::WIDE].map(|looks| of(looks, seed));
            assert_eq!((&plain.labels, &wide.values), (&wide.labels, &again.values));
            differ += usize::from(plain.values != wide.values);
        }
        assert!(differ > 15, "{differ}");
    }

    #[test]
    fn rare_classes_count_more() {
        let frame =
            Frame { rgb: Vec::new(), labels: [vec![0; 99], vec![1], vec![IGNORE; 50]].concat(), people: Vec::new() };
        let [common, rare, absent] = class_weights(&[frame]);
        assert!((common - 1.0 / 2.09f32.ln()).abs() < 1e-5);
        assert!(rare > 6.0 * common && absent > rare);
    }
}
