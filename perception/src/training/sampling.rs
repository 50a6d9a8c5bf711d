//! Which frames an epoch shows, and what pictures are laid round: what is rare, more often.

use serde::{Deserialize, Serialize};

use super::dataset::Frame;
use super::random::Random;
use crate::classes::{IGNORE, PEDESTRIAN, TRAIN_CLASSES};

const CLASSES: usize = TRAIN_CLASSES.len();
/// A class is in a frame where it has so many pixels of the network's input.
const SEEN_PX: f32 = 16.0;

/// How what is rare is learned from more often. All 0: every frame once an epoch, and everybody counts, as networks
/// were trained before there was any of this.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sampling {
    /// A class that is in a share of the frames below this one is rare, and frames with it are drawn `sqrt(this /
    /// share)` times as often as others (repeat factor sampling, Gupta, Dollar, Girshick 2019: LVIS). An epoch has as
    /// many pictures as before. People count as seen where somebody is `tall_px` high.
    pub rare_below: f32,
    /// Share of the pictures that are a window round somebody of at least `tall_px`, or else round something of a
    /// rare class, where the frame has any.
    pub round_rare: f32,
    /// How high somebody is who is looked for, pixels of the network's input.
    pub tall_px: u32,
    /// People less high than this in a picture, in pixels of the network's input, count nowhere: neither in the loss
    /// nor on the validation split.
    pub least_px: u32,
}

impl Sampling {
    /// A sensible choice where people are to be seen.
    pub const PEOPLE: Self = Self { rare_below: 0.5, round_rare: 0.25, tall_px: 16, least_px: 8 };

    pub(super) fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Whether instance ids are needed.
    pub(super) fn knows_people(&self) -> bool {
        !self.is_none()
    }

    /// What is asked for and cannot be.
    pub(super) fn refused(&self) -> Option<String> {
        let shares = [("rare_below", self.rare_below), ("round_rare", self.round_rare)];
        let (name, value) = shares.into_iter().find(|(_, value)| !(0.0..=1.0).contains(value))?;
        Some(format!("{name} of {value}; expected 0 to 1"))
    }
}

/// How rare the classes of a split are.
#[derive(Clone, Debug)]
pub(super) struct Rarity {
    /// How often frames with a class are drawn, by train id; 1 of those that are not rare.
    classes: [f32; CLASSES],
    /// The same of every frame.
    frames: Vec<f32>,
}

impl Rarity {
    /// That of frames that have `scale` times as many pixels along a side as the network's input.
    pub(super) fn of(frames: &[Frame], scale: f32, sampling: &Sampling) -> Self {
        let seen: Vec<[bool; CLASSES]> = frames.iter().map(|frame| seen(frame, scale, sampling.tall_px)).collect();
        let classes = std::array::from_fn(|class| {
            let count = seen.iter().filter(|seen| seen[class]).count().max(1);
            (sampling.rare_below * frames.len() as f32 / count as f32).sqrt().max(1.0)
        });
        let most = |seen: &[bool; CLASSES]| {
            seen.iter().zip(classes).filter(|(seen, _)| **seen).fold(1.0, |most: f32, (_, often)| most.max(often))
        };
        let frames = seen.iter().map(most).collect();
        Self { classes, frames }
    }

    /// The frames of an epoch in their order. Where nothing is rare, each is there once; else as often as its factor
    /// asks for, to the next lower or higher whole number.
    pub(super) fn epoch(&self, random: &mut Random) -> Vec<usize> {
        let count = self.frames.len();
        let order = random.permutation(count);
        if self.frames.iter().all(|often| *often == 1.0) {
            return order;
        }
        // Systematic sampling: as many equally spaced marks on the line on which frames lie by their factors.
        let total: f64 = self.frames.iter().map(|often| f64::from(*often)).sum();
        let first = f64::from(random.unit());
        let (mut drawn, mut passed) = (Vec::with_capacity(count), 0.0);
        for (frame, often) in self.frames.iter().enumerate() {
            passed += f64::from(*often) * count as f64 / total;
            while drawn.len() < count && first + drawn.len() as f64 <= passed {
                drawn.push(frame);
            }
        }
        drawn.resize(count, count - 1);
        order.into_iter().map(|i| drawn[i]).collect()
    }

    /// What a picture is laid round: the middle of somebody who is `tall_px` high where the frame is enlarged `scale`
    /// times, else a pixel of a rare class, rarer ones first; column and row. `None` where there is nothing.
    pub(super) fn middle(
        &self,
        frame: &Frame,
        width: usize,
        scale: f32,
        tall_px: u32,
        random: &mut Random,
    ) -> Option<(u32, u32)> {
        let mut below = |n: usize| (random.next_u64() % n as u64) as usize;
        let tall: Vec<_> = frame.people.iter().filter(|p| p.height_px as f32 * scale >= tall_px as f32).collect();
        if !tall.is_empty() {
            return Some(tall[below(tall.len())].middle);
        }
        let counts = counts(frame);
        let rare = |class: &usize| *class != PEDESTRIAN && self.classes[*class] > 1.0 && counts[*class] > 0;
        let class = (0..CLASSES).filter(rare).max_by(|a, b| self.classes[*a].total_cmp(&self.classes[*b]))?;
        let nth = below(counts[class] as usize);
        let (at, _) = frame.labels.iter().enumerate().filter(|(_, label)| usize::from(**label) == class).nth(nth)?;
        Some(((at % width) as u32, (at / width) as u32))
    }
}

/// Which classes are in a frame.
fn seen(frame: &Frame, scale: f32, tall_px: u32) -> [bool; CLASSES] {
    let mut seen = counts(frame).map(|count| count as f32 >= SEEN_PX * scale * scale);
    seen[PEDESTRIAN] = frame.people.iter().any(|person| person.height_px as f32 >= tall_px as f32 * scale);
    seen
}

fn counts(frame: &Frame) -> [u32; CLASSES] {
    let mut counts = [0; CLASSES];
    frame.labels.iter().filter(|label| **label != IGNORE).for_each(|label| counts[usize::from(*label)] += 1);
    counts
}

#[cfg(test)]
mod tests {
    use super::super::people::Person;
    use super::*;

    const SIGN: u8 = 10;
    const WIDTH: usize = 16;

    fn frame(signs: usize, heights: &[u32]) -> Frame {
        let labels = (0..WIDTH * 8).map(|i| if i >= WIDTH * 8 - signs { SIGN } else { 5 }).collect();
        let person = |height_px: &u32| Person { height_px: *height_px, middle: (*height_px, 2), pixels: Vec::new() };
        Frame { rgb: Vec::new(), labels, people: heights.iter().map(person).collect() }
    }

    /// One frame in eight with signs, one in eight with somebody tall.
    fn frames() -> Vec<Frame> {
        (0..32).map(|i| frame(if i % 8 == 1 { 20 } else { 3 }, if i % 8 == 2 { &[20, 4] } else { &[4] })).collect()
    }

    #[test]
    fn rare_frames_are_drawn_as_often_as_their_factor_asks_for() {
        let rarity = Rarity::of(&frames(), 1.0, &Sampling::PEOPLE);
        let often: Vec<f32> = (0..4).map(|i| rarity.frames[i]).collect();
        assert_eq!(often, [1.0, 2.0, 2.0, 1.0], "sqrt(0.5 / 0.125) is 2");
        let mut drawn = [0; 32];
        let mut random = Random::new(&[1]);
        for _ in 0..200 {
            let order = rarity.epoch(&mut random);
            assert_eq!(order.len(), 32);
            order.iter().for_each(|frame| drawn[*frame] += 1);
        }
        // 32 * 2 / 40 and 32 * 1 / 40 times an epoch.
        let mean = |rare: bool| {
            let of = |i: &usize| (*i % 8 == 1 || *i % 8 == 2) == rare;
            let counts: Vec<u32> = (0..32).filter(of).map(|i| drawn[i]).collect();
            f64::from(counts.iter().sum::<u32>()) / counts.len() as f64 / 200.0
        };
        assert!((mean(true) - 1.6).abs() < 0.05 && (mean(false) - 0.8).abs() < 0.05, "{drawn:?}");
    }

    #[test]
    fn where_nothing_is_rare_the_order_is_that_of_before() {
        let rarity = Rarity::of(&frames(), 1.0, &Sampling::default());
        assert_eq!(rarity.epoch(&mut Random::new(&[5])), Random::new(&[5]).permutation(32));
    }

    #[test]
    fn larger_frames_must_show_more() {
        let large = Rarity::of(&frames(), 2.0, &Sampling::PEOPLE);
        assert!(large.frames.iter().all(|often| *often == 1.0), "20 px are 5 in half the size, 20 rows 10");
    }

    #[test]
    fn windows_are_laid_round_the_tall_first_and_else_round_what_is_rare() {
        let frames = frames();
        let rarity = Rarity::of(&frames, 1.0, &Sampling::PEOPLE);
        let mut random = Random::new(&[3]);
        let mut middle = |frame: &Frame, scale| rarity.middle(frame, WIDTH, scale, 16, &mut random);
        for _ in 0..20 {
            assert_eq!(middle(&frames[2], 1.0), Some((20, 2)));
            let (x, y) = middle(&frames[1], 1.0).unwrap();
            assert_eq!(frames[1].labels[y as usize * WIDTH + x as usize], SIGN);
            assert_eq!(middle(&frames[0], 4.0), Some((4, 2)), "enlarged, they are tall");
        }
        assert_eq!(middle(&frame(0, &[]), 1.0), None);
    }
}
